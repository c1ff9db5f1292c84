"""The picture of the quaternion ball: quaternions as points by stereographic projection, seen as the scene is at first.

A turn by θ about n is at tan(θ/4) n: no turn in the middle, half turns on the unit sphere. −q, which turns the
same, is on the other side of the middle at the inverse distance.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from geometry import quaternion
from geometry.arrays import Array
from geometry.hamilton import from_ball, to_ball
from sims.kit.palette import AXES
from sims.kit.pane import Pane, Picture
from sims.kit.readout import figure
from sims.kit.view import View
from sims.quaternion.params import TWICE, WHOLE, QuaternionParams
from sims.quaternion.solution import QuaternionSolution

VIEW = View((3.3, -3.0, 2.0), (0.0, 0.0, 0.1), 1.9)
"""How the scene and the ball are looked at."""
WIDTH, HEIGHT = 480, 430
RADIUS = 158.0
"""Pixels of the unit ball."""
EDGE = 16.0
"""Pixels from the frame at which an arrow points to what is beyond."""
FAR = 8.0
"""Distance from the middle beyond which no path is drawn."""
MIDDLE_OF_ALL = 1e-3
"""Distance from the middle within which a turn has no axis."""
DASH = {"x": "", "y": "9 4", "z": "4 4"}
Pixel = tuple[float, float]
MIDDLE: Pixel = 0.5 * WIDTH, 0.5 * HEIGHT


def _frame() -> Array:
    """Rows: what is to the right, what is down, and what is away from who looks, in the first view of the scene."""
    forward = np.subtract(VIEW.look_at, VIEW.position)
    right = np.cross(forward, (0.0, 0.0, 1.0))
    return np.array([v / math.sqrt(v @ v) for v in (right, np.cross(forward, right), forward)])


FRAME = _frame()
SCREEN = FRAME[:2]


def ball(p: QuaternionParams, s: QuaternionSolution) -> Pane:
    """The ball with q and −q, which can be held, and the path from start to target."""
    picture = SPHERE.copy()
    picture.curve(places(s.ball_path), "ink", width=2)
    if s.ball_start is not None:
        _name(picture, s.ball_start, "start", "ghost")
    if s.ball_target is not None:
        _name(picture, s.ball_target, "target", "ink")
    if s.ball_now is not None and not s.at_target and not s.at_start:
        picture.dot(pixel(s.ball_now), "ink", 5)
    outward = s.n if p.angle <= WHOLE else -s.n
    _mark(picture, "minus_q", "−q", s.ball_minus_q, -outward)
    _mark(picture, "q", "q", s.ball_q, outward)
    return picture.pane(_note(s), large=True)


def _note(s: QuaternionSolution) -> str:
    if s.ball_q is None:
        return "q at infinity, −q in the middle"
    far = math.sqrt(s.ball_q @ s.ball_q)
    return f"q at tan θ/4 = {figure(far, 2)}" if far < 100.0 else "q over 100 times as far out as the sphere"


def pixel(place: Sequence[float] | Array) -> Pixel:
    """Where a place in the ball is in the picture."""
    x, y = (SCREEN @ place).tolist()
    return MIDDLE[0] + RADIUS * x, MIDDLE[1] + RADIUS * y


def places(path: Array) -> Array:
    """A path in the ball as pixels (n, 2), as far as it is near."""
    near = path[np.abs(path).max(axis=1) < FAR]  # not a number isn't near either
    return np.asarray(MIDDLE + RADIUS * near @ SCREEN.T)


def _sphere() -> Picture:
    """What is the same in every state: the unit ball, its axes, and what is where."""
    picture = Picture("ball", "Quaternion ball", WIDTH, HEIGHT)
    picture.dot(MIDDLE, "ghost", RADIUS, hollow=True)
    angles = np.linspace(0.0, 2.0 * math.pi, 65)
    circle = np.column_stack([0.0 * angles, np.cos(angles), np.sin(angles)])
    for k, axis in enumerate(AXES):
        picture.curve(places(np.roll(circle, k, axis=1)), "ghost", width=0.8)
        tip = np.eye(3)[k]
        picture.line(MIDDLE, pixel(tip), axis, width=1.5, dash=DASH[axis])
        x, y = pixel(1.12 * tip)
        picture.text((x, y + 6), axis.upper(), axis, anchor="middle", size=18)
    picture.dot(MIDDLE, "ghost", 4)
    picture.text((MIDDLE[0] - 12, MIDDLE[1] + 22), "no turn", "ghost", anchor="end", size=19)
    rim = MIDDLE[0] + 0.72 * RADIUS, MIDDLE[1] + 0.72 * RADIUS
    picture.text((rim[0] + 6, rim[1] + 18), "half turns", "ghost", size=19)
    picture.text((EDGE, HEIGHT - EDGE), "outside: over half a turn", "ghost", size=19)
    return picture


SPHERE = _sphere()


def _mark(picture: Picture, name: str, words: str, place: Array | None, direction: Array) -> None:
    """A quaternion that can be held, or an arrow towards it where it is outside of the picture."""
    found = None if place is None else pixel(place)
    if place is not None and found is not None and EDGE < found[0] < WIDTH - EDGE and EDGE < found[1] < HEIGHT - EDGE:
        foot = pixel((*place[:2].tolist(), 0.0))
        picture.line(MIDDLE, foot, "ghost", width=1.2, dash="3 3")
        picture.line(foot, found, "ghost", width=1.2, dash="3 3")
        picture.line(MIDDLE, found, "held", width=2, dash="5 4" if name != "q" else "")
        far = figure(math.sqrt(place @ place), 2)
        picture.handle(name, found, words, words, where=f"{far} from the middle", link="axis angle")
        return
    if (edge := _edge(direction)) is not None:
        picture.arrow(MIDDLE, edge, "held", width=1.5)
        x, y = edge
        _beside(picture, x, y - 14 if y > MIDDLE[1] else y + 30, f"{words}, farther")


def _beside(picture: Picture, x: float, y: float, words: str) -> None:
    """Words at the right of a place, or at its left where there is no room."""
    left = x > WIDTH - 150
    picture.text((x - 14 if left else x + 14, y), words, "held", anchor="end" if left else "start", size=22)


def _name(picture: Picture, place: Array, name: str, role: str) -> None:
    x, y = pixel(place)
    picture.dot((x, y), role, 5)
    picture.text((x - 10, y - 8), name, role, anchor="end", size=18)


def _edge(direction: Array) -> Pixel | None:
    """Where a ray from the middle comes to the picture's edge; nowhere if it goes towards the viewer."""
    x, y = (SCREEN @ direction).tolist()
    reach = min((0.5 * size - EDGE) / max(abs(v), 1e-9) for v, size in ((x, WIDTH), (y, HEIGHT)))
    return (MIDDLE[0] + reach * x, MIDDLE[1] + reach * y) if max(abs(x), abs(y)) > 1e-6 else None


# ---- what a hand does


def hold_q(p: QuaternionParams, to: tuple[float, float]) -> dict[str, Any]:
    """q led to a pixel: in the plane of the picture, as near to who looks as it is."""
    return turn_of(p, from_ball(_led(_placed(p, 1.0), to)))


def hold_minus_q(p: QuaternionParams, to: tuple[float, float]) -> dict[str, Any]:
    """The same for −q: q goes with it, on the other side."""
    return turn_of(p, -from_ball(_led(_placed(p, -1.0), to)))


def _placed(p: QuaternionParams, sign: float) -> Array:
    """Where q or −q is; the middle for one at infinity, which no hand can have held."""
    place, finite = to_ball(sign * quaternion.from_axis_angle(p.axis, math.radians(p.angle)))
    return place if finite else np.zeros(3)


def _led(place: Array, to: tuple[float, float]) -> Array:
    x, y = ((v - m) / RADIUS for v, m in zip(to, MIDDLE, strict=True))
    return np.array([x, y, FRAME[2] @ place]) @ FRAME


def turn_of(p: QuaternionParams, q: Array) -> dict[str, Any]:
    """The axis and angle of a quaternion: in the second round on the side where the axis is."""
    n, radians = quaternion.to_axis_angle(q)
    angle = math.degrees(radians)
    if math.sqrt(q[1:] @ q[1:]) < MIDDLE_OF_ALL:
        return {"angle": WHOLE if q[0] < 0.0 else TWICE if p.angle > WHOLE else 0.0}
    if p.angle > WHOLE and n @ p.axis < 0.0:
        n, angle = -n, TWICE - angle
    x, y, z = (round(v, 3) + 0.0 for v in n.tolist())
    return {"axis": (x, y, z), "angle": round(angle, 1)}
