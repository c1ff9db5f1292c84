"""The mathematics of a state."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from geometry import euler, quaternion
from geometry.arrays import Array
from geometry.rotations import matrix_to_axis_angle
from sims.euler_angles.params import EulerParams
from sims.kit.types import Quaternion

SHORT = {"yaw": "α", "pitch": "β", "roll": "γ"}
# In which direction each turn is seen: the nose for turns about z and y, the left wing for turns about x.
SEEN = {"z": "x", "y": "x", "x": "y"}


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
class EulerSolution:
    """R is the whole rotation; `R_progress` the part that is applied, which the aircraft shows."""

    R: Array
    factors: tuple[dict[str, Any], ...]
    quaternion: Array
    axis_angle: dict[str, Any]
    lock_distance: float
    locked: bool
    R_progress: Array
    recovered: dict[str, float]
    turns: tuple[Turn, ...]


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
    return EulerSolution(
        R=R,
        factors=tuple({"axis": f.axis, "angle": math.degrees(float(f.angle)), "R": f.R} for f in product),
        quaternion=quaternion.from_matrix(R),
        axis_angle={"axis": axis, "angle": math.degrees(float(angle))},
        lock_distance=distance,
        locked=bool(locked),
        R_progress=R if p.progress >= 3.0 else euler.euler_to_matrix(applied, p.order, p.frame),
        recovered={n: math.degrees(float(a)) for n, a in zip(p.names, recovered, strict=True)},
        turns=_turns(p, applied),
    )


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
            seen = _floats(quaternion.multiply(back, _seen_from(before, axis)))
            before = in_world
        else:
            before = quaternion.multiply(before, turn) if p.frame == "extrinsic" else before
        current = k < p.progress < k + 1
        name = SHORT[p.names[k]] if p.proper else p.names[k]
        turns.append(Turn(name, math.degrees(angle), turn, seen, current))
    return tuple(turns)


def _seen_from(before: Array, axis: str) -> Array:
    """Frame (a quaternion in the world) of an arc about a world axis, from where the nose (or wing) now points."""
    body = quaternion.to_matrix(before)
    normal = np.eye(3)["xyz".index(axis)]
    flat = [v - normal * (normal @ v) for v in (body[:, "xyz".index(SEEN[axis])], body[:, 1], body[:, 2])]
    start = next(v for v in flat if v @ v > 0.01)
    start = start / math.sqrt(start @ start)
    return quaternion.from_matrix(np.column_stack([start, np.cross(normal, start), normal]))


def _floats(q: Array) -> Quaternion:
    w, x, y, z = q.tolist()
    return w, x, y, z


def _arc_frame(axis: str) -> Quaternion:
    normal, start = np.eye(3)["xyz".index(axis)], np.eye(3)["xyz".index(SEEN[axis])]
    return _floats(quaternion.from_matrix(np.column_stack([start, np.cross(normal, start), normal])))


ARC_FRAMES = {axis: _arc_frame(axis) for axis in "xyz"}
