"""The mathematics of a state."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from geometry import euler, quaternion
from geometry.arrays import Array
from geometry.rotations import axis_rotation, matrix_to_axis_angle, rotation_angle
from sims.euler_angles.params import EulerParams
from sims.kit.types import Quaternion

# In which direction each turn is seen: the nose for turns about z and y, the left wing for turns about x.
SEEN = {"z": "x", "y": "x", "x": "y"}
RADII = (1.62, 1.38, 1.5)
"""Metres of the three turns' arcs: the innermost is outside the wings."""
SAME = 0.005
"""Degrees within which two angles are one."""
ROUNDED = 1e-9
"""Degrees beyond a bound that come of the arithmetic: an angle that is truly beyond it isn’t kept, however little."""


@dataclass(frozen=True)
class Turn:
    """One turn as it is drawn: in the frame before it."""

    name: str
    applied: float
    """Degrees applied so far."""
    wxyz: Quaternion
    """The frame after it, in the frame before it."""
    seen: Quaternion
    """Frame of its arc, in the frame before it: z along the axis of the turn, x where the arc starts."""
    current: bool


@dataclass(frozen=True)
class Left:
    """What is left at lock: only first + `sign` · third angle counts; `angle` is that, in degrees within ±180."""

    sign: int
    angle: float


@dataclass(frozen=True)
class Target:
    """An orientation that is to be reached, and by how many degrees the aircraft, as it is drawn, is off it."""

    wxyz: Quaternion
    angle: float


@dataclass(frozen=True)
class EulerSolution:
    """R is the whole rotation; `R_progress` the part that is applied, which the aircraft shows.

    `recovered`: the angles read back from R. `arcs` (3, 3, 3): for each turn of the whole rotation its arc's frame in
    the world, with columns from the middle to the arc's start, a quarter turn on, and the axis; `ends` (3, 3): where
    the arcs end, in rows.
    """

    R: Array
    factors: tuple[dict[str, Any], ...]
    quaternion: Array
    axis_angle: dict[str, Any]
    lock_distance: float
    locked: bool
    left: Left | None
    R_progress: Array
    recovered: dict[str, float]
    turns: tuple[Turn, ...]
    arcs: tuple[Array, ...]
    ends: Array
    target: Target | None

    def set_otherwise(self, p: EulerParams) -> bool:
        """Whether the angles that were set are another triple than the one that is read back."""
        pairs = zip(p.angles, self.recovered.values(), strict=True)
        return not self.locked and any(abs(math.remainder(a - b, 360.0)) > SAME for a, b in pairs)


def solve(p: EulerParams) -> EulerSolution:
    """All the mathematics of a state."""
    radians = [math.radians(a) for a in p.angles]
    product = euler.factors(radians, p.order, p.frame)
    R = product[0].R @ product[1].R @ product[2].R
    axis, angle = matrix_to_axis_angle(R)
    distance = math.degrees(float(euler.lock_distance(radians[1], p.order)))
    recovered, locked = euler.matrix_to_euler(R, p.order, p.frame)
    part = [min(max(p.progress - k, 0.0), 1.0) for k in range(3)]
    applied = [a * f for a, f in zip(radians, part, strict=True)]
    arcs = arc_frames(p)
    ends = [
        radius * (arc[:, 0] * math.cos(a) + arc[:, 1] * math.sin(a))
        for radius, arc, a in zip(RADII, arcs, radians, strict=True)
    ]
    part_made = R if p.progress >= 3.0 else euler.euler_to_matrix(applied, p.order, p.frame)
    return EulerSolution(
        R=R,
        factors=tuple({"axis": f.axis, "angle": math.degrees(float(f.angle)), "R": f.R} for f in product),
        quaternion=quaternion.from_matrix(R),
        axis_angle={"axis": axis, "angle": math.degrees(float(angle))},
        lock_distance=distance,
        locked=bool(locked),
        left=_left(p, radians[1]) if locked else None,
        R_progress=part_made,
        recovered={n: math.degrees(float(a)) for n, a in zip(p.names, recovered, strict=True)},
        turns=_turns(p, applied),
        arcs=arcs,
        ends=np.array(ends),
        target=_target(p, part_made) if p.show_target else None,
    )


def _target(p: EulerParams, R: Array) -> Target:
    aim = euler.euler_to_matrix([math.radians(a) for a in p.target], "zyx", "intrinsic")
    return Target(_floats(quaternion.from_matrix(aim)), math.degrees(float(rotation_angle(R.T @ aim))))


def arc_frames(p: EulerParams) -> tuple[Array, ...]:
    """The frame of each turn's arc in the world, as in `EulerSolution`."""
    first, second, _ = (axis_rotation(axis, math.radians(a)) for axis, a in zip(p.order, p.angles, strict=True))
    if p.frame == "intrinsic":
        befores = (first, first @ second)
        later = [before @ _ARCS[axis] for before, axis in zip(befores, p.order[1:], strict=True)]
    else:
        befores = (first, second @ first)
        later = [_seen_from(before, axis) for before, axis in zip(befores, p.order[1:], strict=True)]
    return _ARCS[p.order[0]], *later


def triple_of(p: EulerParams, R: Array) -> dict[str, float]:
    """The angles of a rotation in a state's order and frame, in degrees, by the names of their parameters.

    Of the two triples the one within the bounds of the parameters, or, where both are, nearer to the present angles.
    """
    found, _ = euler.matrix_to_euler(R, p.order, p.frame)
    triples = [np.degrees(found).tolist(), np.degrees(euler.other_triple(found, p.order)).tolist()]
    bounds = [p.bounds(name) for name in p.names]

    def beyond(triple: list[float]) -> tuple[bool, float]:
        out = any(not low - ROUNDED <= a <= high + ROUNDED for a, (low, high) in zip(triple, bounds, strict=True))
        away = sum(abs(math.remainder(a - b, 360.0)) for a, b in zip(triple, p.angles, strict=True))
        return out, away

    best = min(triples, key=beyond)
    kept = [min(max(a, low), high) for a, (low, high) in zip(best, bounds, strict=True)]
    return dict(zip(p.names, kept, strict=True))


def _left(p: EulerParams, middle: float) -> Left:
    sign = euler.lock_sign(middle, p.order, p.frame)
    first, _, third = p.angles
    return Left(sign, math.remainder(first + sign * third, 360.0))


def _turns(p: EulerParams, applied: list[float]) -> tuple[Turn, ...]:
    turns = []
    before: Any = (1.0, 0.0, 0.0, 0.0)
    for k, (axis, angle) in enumerate(zip(p.order, applied, strict=True)):
        turn = quaternion.axis_quaternion(axis, angle)
        seen = ARC_FRAMES[axis]
        if p.frame == "extrinsic" and k:
            # About an axis of the world: seen from the frame before, turn and arc are turned back.
            back = quaternion.conjugate(before)
            in_world = quaternion.multiply(turn, before)
            turn = _floats(quaternion.multiply(back, in_world))
            arc = quaternion.from_matrix(_seen_from(quaternion.to_matrix(before), axis))
            seen = _floats(quaternion.multiply(back, arc))
            before = in_world
        else:
            before = quaternion.multiply(before, turn) if p.frame == "extrinsic" else before
        current = k < p.progress < k + 1
        turns.append(Turn(p.turns[k].short, math.degrees(angle), turn, seen, current))
    return tuple(turns)


def _seen_from(body: Array, axis: str) -> Array:
    """Frame in the world of an arc about a world axis, from where the nose (or wing) of a body then points."""
    normal = np.eye(3)["xyz".index(axis)]
    flat = [v - normal * (normal @ v) for v in (body[:, "xyz".index(SEEN[axis])], body[:, 1], body[:, 2])]
    start = next(v for v in flat if v @ v > 0.01)
    start = start / math.sqrt(start @ start)
    return np.column_stack([start, np.cross(normal, start), normal])


def _floats(q: Array) -> Quaternion:
    w, x, y, z = q.tolist()
    return w, x, y, z


_ARCS = {axis: _seen_from(np.eye(3), axis) for axis in "xyz"}
ARC_FRAMES = {axis: _floats(quaternion.from_matrix(frame)) for axis, frame in _ARCS.items()}
