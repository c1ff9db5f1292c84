"""The left and the right picture, and the plot of depth uncertainty against depth."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Literal

import numpy as np

from geometry.triangulation import depth_sigma
from sims.kit.frame import HEIGHT, WIDTH
from sims.kit.pane import Pane, Picture
from sims.kit.plot import Plot, room
from sims.kit.readout import quantity
from sims.triangulation.params import NAMES, Method, Pixel, TriangulationParams
from sims.triangulation.solution import TriangulationSolution

Side = Literal["left", "right"]
MAGNIFICATIONS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
LONG_ENOUGH = 75.0
"""Pixels that the arrow of an error should be long."""
SEEN_ERROR = 5e-4
NO_DEPTH = 4.0
"""Metres for which the plot has room when there is no point."""


def panes(p: TriangulationParams, s: TriangulationSolution) -> Sequence[Pane]:
    """Both pictures and the plot."""
    chosen = s.by_method[p.method]
    times = magnification(chosen.reprojection_left, chosen.reprojection_right)
    return _picture(p, s, "left", times), _picture(p, s, "right", times), _plot(p, s)


def magnification(left: float | None, right: float | None) -> int:
    """How many times longer than the errors their arrows are, so that the longer one can be seen."""
    longest = max(left or 0.0, right or 0.0)
    if longest < SEEN_ERROR:
        return 1
    return next((m for m in MAGNIFICATIONS if m * longest >= LONG_ENOUGH), MAGNIFICATIONS[-1])


def _picture(p: TriangulationParams, s: TriangulationSolution, side: Side, times: int) -> Pane:
    left = side == "left"
    other: Side = "right" if left else "left"
    held, measured = (p.left_uv, s.measured_left) if left else (p.right_uv, s.measured_right)
    seen = {
        name: (result.pixel_left, result.reprojection_left) if left else (result.pixel_right, result.reprojection_right)
        for name, result in s.by_method.items()
    }
    picture = Picture(side, f"{side.capitalize()} picture", WIDTH, HEIGHT)
    picture.homogeneous_line((s.line_left if left else s.line_right).tolist(), other, dash="7 5", link=other)
    if p.noise > 0.0:
        _measured(picture, measured, side)
    if s.true_point is not None:
        picture.point("true", held, "True point", "held", quiet=True)
    for name, (at, _) in seen.items():
        if at is not None:
            _reprojected(picture, name, at, chosen=name == p.method)
    found, error = seen[p.method]
    if found is not None and error is not None:
        _error(picture, measured, found, error, times)
    picture.handle(f"{side}_uv", held, f"{side.capitalize()} point", side[0].upper(), link=side)
    return picture.pane(_error_in_words(error, times))


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


def _error(picture: Picture, measured: Pixel, found: Pixel, error: float, times: int) -> None:
    """A ring round where the result is seen, and the way there from what was measured."""
    picture.dot(found, "ink", 10, hollow=True)
    if error >= SEEN_ERROR:
        tip = [m + times * (f - m) for m, f in zip(measured, found, strict=True)]
        picture.arrow(measured, tip, "ink", width=2.5)


def _error_in_words(error: float | None, times: int) -> str:
    if error is None:
        return "no point"
    drawn = f", arrow ×{times}" if times > 1 else ""
    return f"error {quantity(error, 'px', 2)}{drawn}"


def _plot(p: TriangulationParams, s: TriangulationSolution) -> Pane:
    depth, sigma = s.depth, s.depth_sigma
    noise = f"at {quantity(s.sigma_px, 'px', 2)} noise"
    if depth is None or sigma is None or s.vague:
        least = float(depth_sigma(NO_DEPTH, p.baseline, p.focal, s.sigma_px))
        return _curves(p.baseline, p.focal, s.sigma_px, room(NO_DEPTH, 1.5), room(least, 1.8)).pane(noise)
    plot = _curves(p.baseline, p.focal, s.sigma_px, room(depth, 1.5), room(sigma, 1.8))
    return plot.pane(f"{quantity(depth, 'm', 2)} ± {quantity(sigma, 'm')} {noise}", (depth, sigma))


@lru_cache(maxsize=128)
def _curves(baseline: float, focal: float, sigma: float, x_max: float, y_max: float) -> Plot:
    """Half and twice the baseline are ghosts."""
    plot = Plot("plot", "Depth", x="depth Z (m)", y="σ of Z (m)", x_max=x_max, y_max=y_max)
    for words, times in (("½ b", 0.5), ("2 b", 2.0), ("b", 1.0)):
        end = min(x_max, math.sqrt(y_max / float(depth_sigma(1.0, times * baseline, focal, sigma))))
        depths = np.linspace(0.0, end, 25)[1:]
        sigmas = depth_sigma(depths, times * baseline, focal, sigma)
        plot.curve([(0.0, 0.0), *zip(depths.tolist(), sigmas.tolist(), strict=True)], words, ghost=times != 1.0)
    return plot
