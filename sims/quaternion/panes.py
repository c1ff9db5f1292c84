"""The picture of the quaternion ball: quaternions as points by stereographic projection, seen as the scene is at first.

A turn by θ about n is at tan(θ/4) n: no turn in the middle, half turns on the unit sphere. −q, which turns the
same, is on the other side of the middle at the inverse distance.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from geometry.arrays import Array
from sims.kit.palette import AXES
from sims.kit.pane import Pane, Picture
from sims.kit.readout import figure
from sims.kit.sim import View
from sims.quaternion.params import QuaternionParams
from sims.quaternion.solution import QuaternionSolution

VIEW = View((3.3, -3.0, 2.0), (0.0, 0.0, 0.1), 1.9)
"""Radii of the scene, and of the ball."""
WIDTH, HEIGHT = 480, 340
RADIUS = 66.0
"""Pixels of the unit ball."""
TITLE = "Quaternion ball"
EDGE = 16.0
"""Pixels from the frame at which an arrow points to what is beyond."""
FAR = 8.0
"""Distance from the middle beyond which no path is drawn."""
DASH = {"x": "", "y": "9 4", "z": "4 4"}
Pixel = tuple[float, float]
MIDDLE: Pixel = 0.5 * WIDTH, 0.5 * HEIGHT


def _screen() -> Array:
    """Rows: what is to the right, and what is down, in the first view of the scene."""
    forward = np.subtract(VIEW.look_at, VIEW.position)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    down = np.cross(forward, right)
    return np.array([v / math.sqrt(v @ v) for v in (right, down)])


SCREEN = _screen()


def panes(p: QuaternionParams, s: QuaternionSolution) -> list[Pane]:
    """The ball with q, −q and the path from start to target."""
    picture = BALL.copy()
    picture.curve(places(s.ball_path), "ink", width=3)
    _mark(picture, s.ball_minus_q, -s.n, "−q", hollow=True)
    _mark(picture, s.ball_q, s.n, "q")
    if s.ball_start is not None:
        _name(picture, s.ball_start, "s", "ghost")
    if s.ball_target is not None:
        _name(picture, s.ball_target, "q s", "ink")
    if s.ball_now is not None and not s.at_target and not s.at_start:
        picture.dot(pixel(s.ball_now), "ink", 5)
    return [picture.pane(_note(s), wide=True)]


def _note(s: QuaternionSolution) -> str:
    if s.ball_q is None:
        return "q is at infinity, −q in the middle"
    return f"q at tan θ/4 = {figure(math.sqrt(s.ball_q @ s.ball_q), 2)}"


def pixel(place: Sequence[float] | Array) -> Pixel:
    """Where a place in the ball is in the picture."""
    x, y = (SCREEN @ place).tolist()
    return MIDDLE[0] + RADIUS * x, MIDDLE[1] + RADIUS * y


def places(path: Array) -> Array:
    """A path in the ball as pixels (n, 2), as far as it is near."""
    near = path[np.abs(path).max(axis=1) < FAR]  # not a number isn't near either
    return np.asarray(MIDDLE + RADIUS * near @ SCREEN.T)


def _sphere() -> Picture:
    """What is the same in every state: the unit ball and its axes."""
    picture = Picture("ball", TITLE, WIDTH, HEIGHT)
    picture.dot(MIDDLE, "ghost", RADIUS, hollow=True)
    angles = np.linspace(0.0, 2.0 * math.pi, 33)
    circle = np.column_stack([0.0 * angles, np.cos(angles), np.sin(angles)])
    for k, axis in enumerate(AXES):
        picture.curve(places(np.roll(circle, k, axis=1)), "ghost", width=0.8)
        tip = np.eye(3)[k]
        picture.line(MIDDLE, pixel(tip), axis, width=1.5, dash=DASH[axis])
        x, y = pixel(1.2 * tip)
        picture.text((x, y + 6), axis.upper(), axis, anchor="middle", size=18)
    return picture


BALL = _sphere()


def _mark(picture: Picture, place: Array | None, direction: Array, name: str, *, hollow: bool = False) -> None:
    """A quaternion, or an arrow in its direction where it is outside of the picture."""
    at = None if place is None else pixel(place)
    inside = at is not None and EDGE < at[0] < WIDTH - EDGE and EDGE < at[1] < HEIGHT - EDGE
    if at is not None and inside:
        picture.line(MIDDLE, at, "held", width=1.5, dash="5 4" if hollow else "")
        picture.dot(at, "held", 8, hollow=hollow)
    elif (at := _edge(direction)) is not None:
        picture.arrow(MIDDLE, at, "held", width=1.5)
        x, y = at
        _beside(picture, x, y - 14 if y > MIDDLE[1] else y + 30, f"{name}, farther")
    if at is not None and inside:
        _beside(picture, at[0], at[1] + 6, name)


def _beside(picture: Picture, x: float, y: float, words: str) -> None:
    """Words at the right of a place, or at its left where there is no room."""
    left = x > WIDTH - 130
    picture.text((x - 14 if left else x + 14, y), words, "held", anchor="end" if left else "start", size=24)


def _name(picture: Picture, place: Array, name: str, role: str) -> None:
    x, y = pixel(place)
    picture.dot((x, y), role, 5)
    picture.text((x - 10, y - 8), name, role, anchor="end", size=20)


def _edge(direction: Array) -> Pixel | None:
    """Where a ray from the middle comes to the picture's edge; nowhere if it goes towards the viewer."""
    x, y = (SCREEN @ direction).tolist()
    reach = min((0.5 * size - EDGE) / max(abs(v), 1e-9) for v, size in ((x, WIDTH), (y, HEIGHT)))
    return (MIDDLE[0] + reach * x, MIDDLE[1] + reach * y) if max(abs(x), abs(y)) > 1e-6 else None
