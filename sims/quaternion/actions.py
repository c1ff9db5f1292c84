"""What buttons and handles do to a state."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from geometry import quaternion
from geometry.arrays import Array
from sims.kit.params import LONGEST_VALUE
from sims.kit.pull import LEAST, pulled
from sims.kit.sim import Step
from sims.kit.spelling import spell
from sims.quaternion import ball, dial
from sims.quaternion.params import MOST_TURNS, REACH, TWICE, WHOLE, QuaternionParams, Triple
from sims.quaternion.solution import solve

DIGITS = 12
"""Decimals of the start to which all turns are taken back."""
SECONDS = 1.2
AFTER: dict[str, Any] = {"angle": 0.0, "t": 1.0}
"""With the turn made, the object stays where it is: there is no angle to go."""


def hold_tip(p: QuaternionParams, place: tuple[float, ...]) -> dict[str, Any]:
    """The axis towards a place in the world; at the origin it stays."""
    length = math.hypot(*place)
    return {} if length < 0.05 else {"axis": _rounded(v / length for v in place)}


def hold_axis(p: QuaternionParams, held: tuple[float, ...]) -> dict[str, Any]:
    """A spot of the axis, in the frame that turns with it, was pulled to a place in the world."""
    R = pulled(quaternion.to_matrix(solve(p).axis_frame), held)
    return {} if R is None else {"axis": _rounded(R[:, 2].tolist())}


def hold_angle(p: QuaternionParams, place: tuple[float, ...]) -> dict[str, Any]:
    """The angle at which its arc ends where it is led to."""
    x, y, _ = (quaternion.to_matrix(solve(p).axis_frame).T @ place).tolist()
    return {} if math.hypot(x, y) < LEAST else dial.turned_to(p, x, y)


def hold_object(p: QuaternionParams, held: tuple[float, ...]) -> dict[str, Any]:
    """A spot of the object, in its own frame, was pulled to a place in the world: the one turn from start to there."""
    s = solve(p)
    R = pulled(s.interpolated.R, held)
    if R is None:
        return {}
    q = quaternion.multiply(quaternion.from_matrix(R), quaternion.conjugate(s.start))
    return {"t": 1.0, **ball.turn_of(p, q if q @ s.q >= 0.0 else -q)}


def hold_point(p: QuaternionParams, place: tuple[float, ...]) -> dict[str, Any]:
    """p at a place in the world."""
    return {"point": _rounded(min(max(v, -REACH), REACH) for v in place)}


def hold_t(p: QuaternionParams, place: tuple[float, ...]) -> dict[str, Any]:
    """t where the mark of the plot goes."""
    return {"t": round(min(max(place[0], 0.0), 1.0), 2)}


def _rounded(place: Any) -> Triple:
    x, y, z = (round(v, 3) + 0.0 for v in place)
    return x, y, z


def undo(p: QuaternionParams) -> dict[str, Any]:
    """The last turn is taken back, and is the present one again."""
    if not p.turns:
        return {}
    start = quaternion.normalize(p.start)
    for *axis, angle in reversed(p.turns):
        start = _turned(start, axis, -angle)
    start = np.round(start, DIGITS) + 0.0  # where the first turn began, without the rounding of all of them
    *before, (*axis, angle) = p.turns
    for *other, part in before:
        start = _turned(start, other, part)
    return {
        "start": tuple(start.tolist()), "axis": tuple(axis), "angle": angle, "history": p.history[:-4], "t": 1.0,
    }  # fmt: skip


def _turned(start: Array, axis: Any, angle: float) -> Array:
    """A start at length one after a turn; within the bounds of the parameter."""
    total = quaternion.multiply(quaternion.from_axis_angle(axis, math.radians(angle)), start)
    return np.clip(total, -1.0, 1.0) + 0.0


def play(p: QuaternionParams) -> Iterator[Step]:
    """What is shown happens: the turn, two turns in both orders, or three ways from start to target."""
    yield from {"turn": _rounds, "order": _both, "path": _ways}.get(p.topic, _turn)(p)


def _rounds(p: QuaternionParams) -> Iterator[Step]:
    once = "Once round: the object is where it was, and q, which goes half as far, has become −q."
    yield Step({"angle": 0.0, "t": 1.0}, 0.0, words=once)
    yield Step({"angle": WHOLE}, SECONDS, words=once)
    twice = "Round again: only now is q what it was."
    yield Step({"angle": WHOLE}, 0.3, words=once)
    yield Step({"angle": TWICE}, SECONDS, words=twice)
    yield Step({"angle": p.angle}, 0.0, words=twice)


def _turn(p: QuaternionParams) -> Iterator[Step]:
    yield Step({"angle": 0.0, "t": 1.0}, 0.0)
    yield Step({"angle": 0.0}, 0.25)
    yield Step({"angle": p.angle}, SECONDS, words="The object turns about n; on its dial q goes half as far.")


def _ways(p: QuaternionParams) -> Iterator[Step]:
    yield Step({"t": 0.0}, 0.0)
    yield Step({"t": 0.0}, 0.25)
    yield Step(
        {"t": 1.0}, 2.0 * SECONDS, even=True, words="All three take the same time: watch who is ahead on the way."
    )


def _both(p: QuaternionParams) -> Iterator[Step]:
    yield Step({"t": 0.0}, 0.0)
    yield Step({"t": 0.0}, 0.25, words="Both begin alike.")
    yield Step({"t": 0.5}, SECONDS, words="The left one turns by A first, the right one by B.")
    yield Step({"t": 1.0}, SECONDS, words="Then the other turn: the left one by B, the right one by A.")


def apply(p: QuaternionParams) -> Iterator[Step]:
    """The object makes the turn; where it comes to is the start of the next one. No angle, no turn."""
    if p.angle == 0.0:
        return
    if p.topic in ("order", "path"):
        yield Step({"show": "turn"}, 0.0)
    yield from _turn(p)
    yield Step({**_made(p), **AFTER}, 0.0)


def _made(p: QuaternionParams) -> dict[str, Any]:
    """The turn as part of the start, start = q ⊗ start, and of the list."""
    made = [*p.turns, (*p.axis, p.angle)][-MOST_TURNS:]
    while len(spell(sum(made, ()))) > LONGEST_VALUE:  # what doesn't fit in a link can't be kept
        made = made[1:]
    start = _turned(quaternion.normalize(p.start), p.axis, p.angle)
    return {"start": tuple(start.tolist()), "history": sum(made, ())}
