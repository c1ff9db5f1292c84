"""The left and the right picture, and the plot of depth uncertainty against depth."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Literal

from sims.kit.pane import Pane, Picture
from sims.kit.readout import quantity
from sims.kit.scale import Scale
from sims.kit.types import Pixel
from sims.kit.world_drawing import draw_in_picture
from sims.triangulation.corners import WORLD
from sims.triangulation.depth_plot import plot
from sims.triangulation.params import NAMES, Method, TriangulationParams
from sims.triangulation.rig import Rig, rig
from sims.triangulation.solution import TriangulationSolution

Side = Literal["left", "right"]
MAGNIFICATIONS = (1, 2, 5, 10, 20, 50, 100)
LONG_ENOUGH, SHORTEST = 36.0, 3.0
"""How long the arrow of an error should be, and the least that is drawn, where a picture is 640 wide."""


def panes(p: TriangulationParams, s: TriangulationSolution) -> Sequence[Pane]:
    """Both pictures and the plot."""
    chosen = s.by_method[p.method]
    left, right = (Scale.of(*size) for size in p.sizes)
    times = magnification(
        left.factor * (chosen.reprojection_left or 0.0), right.factor * (chosen.reprojection_right or 0.0)
    )
    return _picture(p, s, "left", left, times), _picture(p, s, "right", right, times), plot(p, s)


def magnification(left: float | None, right: float | None) -> int:
    """How many times longer than the errors their arrows are, so that the longer one can be seen.

    Both are in pixels of a picture that is 640 wide.
    """
    longest = max(left or 0.0, right or 0.0)
    if MAGNIFICATIONS[-1] * longest < SHORTEST:
        return 1
    return next((m for m in MAGNIFICATIONS if m * longest >= LONG_ENOUGH), MAGNIFICATIONS[-1])


def _picture(p: TriangulationParams, s: TriangulationSolution, side: Side, scale: Scale, times: int) -> Pane:
    left = side == "left"
    other: Side = "right" if left else "left"
    held, measured = (p.left_uv, s.measured_left) if left else (p.right_uv, s.measured_right)
    picture = _world(side, rig(p), scale).copy()
    if (line := s.line_left if left else s.line_right) is not None:
        picture.homogeneous_line(scale.lines(line).tolist(), other, dash="7 5", link=other)
    if p.noise > 0.0:
        _measured(picture, scale.at(measured), side)
    if s.true_point is not None:
        picture.point("true", scale.at(held), "True point", "held", quiet=True)
    for name, result in s.by_method.items():
        if (at := result.pixel_left if left else result.pixel_right) is not None:
            _reprojected(picture, name, scale.at(at), chosen=name == p.method)
    chosen = s.by_method[p.method]
    found = chosen.pixel_left if left else chosen.pixel_right
    error = chosen.reprojection_left if left else chosen.reprojection_right
    if found is not None and error is not None:
        _error(picture, scale.at(measured), scale.at(found), times)
    u, v = held
    picture.handle(
        f"{side}_uv", scale.at(held), f"{side.capitalize()} point", side[0].upper(), where=f"{u:.1f}, {v:.1f} pixels",
        link=side,
    )  # fmt: skip
    return replace(picture.pane(_error_in_words(error, times)), title=side.capitalize())


@lru_cache(maxsize=128)
def _world(side: Side, cameras: Rig, scale: Scale) -> Picture:
    """What a camera sees of the little world."""
    picture = Picture(side, f"{side.capitalize()} picture", scale.width, scale.height)
    draw_in_picture(picture, scale.camera(cameras.left if side == "left" else cameras.right), WORLD)
    return picture


def _measured(picture: Picture, measured: Pixel, side: Side) -> None:
    """The held point with its noise."""
    if picture.shows(measured):
        picture.cross(measured, side, link=side)
    else:
        picture.outside((*measured, 1.0), side, "", link=side, title=f"{side.capitalize()} point with noise")


def _reprojected(picture: Picture, name: Method, at: Pixel, *, chosen: bool) -> None:
    """Where the point of a method is seen; if it isn't the result, only while it is highlighted."""
    words = f"The {NAMES[name]} point, seen from here"
    if picture.shows(at):
        picture.point(name, at, words, quiet=not chosen)
    elif chosen:
        picture.outside((*at, 1.0), "ink", "", link=name, title=words)


def _error(picture: Picture, measured: Pixel, found: Pixel, times: int) -> None:
    """A ring round where the result is seen, and the way there from what was measured."""
    picture.dot(found, "ink", 10, hollow=True)
    if times * math.dist(measured, found) >= SHORTEST:
        tip = [m + times * (f - m) for m, f in zip(measured, found, strict=True)]
        picture.arrow(measured, tip, "ink", width=2.5)


def _error_in_words(error: float | None, times: int) -> str:
    if error is None:
        return "no point"
    drawn = f" ×{times}" if times > 1 else ""
    return f"error {quantity(error, 'px', 2)}{drawn}"
