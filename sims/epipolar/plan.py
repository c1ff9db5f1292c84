"""The plan: the scene from above, X to the right and Y up, in which cameras and the 3D point can be moved."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

from sims.epipolar.drawing import CameraDrawing, distance
from sims.epipolar.eye import eyes
from sims.epipolar.params import OTHERS, EpipolarParams, Pixel, Side, title
from sims.epipolar.solution import EpipolarSolution
from sims.kit.pane import Pane, Picture
from sims.kit.readout import figure
from sims.kit.stereo import Eye

WIDTH, HEIGHT = 640, 340
SCALE = 33.0
"""Pixels a metre."""
ORIGIN: Pixel = (320.0, 290.0)


def at(x: float, y: float) -> Pixel:
    """Where a place is on the plan."""
    return ORIGIN[0] + SCALE * x, ORIGIN[1] - SCALE * y


def hold(name: str) -> Callable[[EpipolarParams, tuple[float, ...]], Mapping[str, Any]]:
    """A handle of the plan: sets X and Y, and leaves the height."""

    def run(p: EpipolarParams, place: tuple[float, ...]) -> Mapping[str, Any]:
        x, y = (place[0] - ORIGIN[0]) / SCALE, (ORIGIN[1] - place[1]) / SCALE
        return {name: (x, y, getattr(p, name)[2])}

    return run


def plan(p: EpipolarParams, s: EpipolarSolution) -> Pane:
    """The finished plan."""
    picture = _others(p.points - 1, p.selected).copy()
    left, right = eyes(p)
    _camera(picture, p, "left", left, s.drawn.left)
    _camera(picture, p, "right", right, s.drawn.right)
    picture.line(at(*left.center[:2]), at(*right.center[:2]), "ink", width=2.5)
    cameras = ("left", left.center, "Left camera"), ("right", right.center, "Right camera")
    held = *cameras, ("point", p.point, title(1))
    for (name, place, words), letter, link in zip(held, "LRP", ("", "", "1"), strict=True):
        spot = at(*place[:2])
        if name != "point" and p.pair is not None:  # they stand as they were calibrated
            picture.text((spot[0] + 12.0, spot[1] + 26.0), letter)
        elif 0.0 <= spot[0] < WIDTH and 0.0 <= spot[1] < HEIGHT:
            where = f"X {figure(place[0], 2)}, Y {figure(place[1], 2)} metres"
            picture.handle(f"plan_{name}", spot, words, letter, where=where, link=link)
    return picture.pane("grid of 1\u2009m", wide=True)


@lru_cache(maxsize=1)
def _grid() -> Picture:
    picture = Picture("plan", "From above", WIDTH, HEIGHT)
    for k in range(-10, 11):
        picture.line(at(k, -10), at(k, 10), "ghost", width=0.3)
        picture.line(at(-10, k), at(10, k), "ghost", width=0.3)
    return picture


@lru_cache(maxsize=64)
def _others(count: int, selected: int) -> Picture:
    """The grid with the first of the points that stay where they are."""
    picture = _grid().copy()
    for k, (x, y, _) in enumerate(OTHERS[:count].tolist(), start=2):
        chosen = k == selected
        if picture.shows(at(x, y)):
            picture.point(f"{k}", at(x, y), title(k), chosen=chosen, label=f"{k}" if chosen else "")
    return picture


def _camera(picture: Picture, p: EpipolarParams, side: Side, eye: Eye, drawn: CameraDrawing) -> None:
    """What the camera sees, its picture, the ray to the point, and its epipole where the baseline meets the picture."""
    R, near, (x, y, _) = eye.R, distance(eye, drawn.size), eye.center

    def seen(right: float, forward: float, down: float = 0.0) -> Pixel:
        return at(x + R[0] * right + R[1] * down + R[2] * forward, y + R[3] * right + R[4] * down + R[5] * forward)

    left, edge = (drawn.corners.item(k, 0) / near for k in (0, 1))
    picture.line(seen(0, 0), seen(9 * left, 9), side, width=0.8)
    picture.line(seen(0, 0), seen(9 * edge, 9), side, width=0.8)
    picture.line(seen(left * near, near), seen(edge * near, near), side, width=3)
    picture.line(seen(0, 0), at(*p.point[:2]), side, width=2)
    if drawn.epipole is not None:
        right, down, _ = drawn.epipole
        end = seen(right, near, down)
        picture.line(seen(edge * near if right > 0 else left * near, near), end, side, width=1, dash="4 4")
        picture.line(seen(0, 0), end, "ink", width=1)
        picture.dot(end, "ink", 5)
