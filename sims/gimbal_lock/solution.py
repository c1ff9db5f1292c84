"""The mathematics of a state."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from geometry import euler, gimbal, quaternion
from geometry.arrays import Array
from geometry.rotations import matrix_to_axis_angle
from sims.gimbal_lock.params import NEAR, GimbalParams
from sims.gimbal_lock.rings import RINGS
from sims.kit.types import Quaternion


@dataclass(frozen=True)
class Reduced:
    """At lock: the one combination of yaw and roll that counts, yaw − `end` · roll, in degrees, and R from it."""

    end: int
    angle: float
    R: Array


@dataclass(frozen=True)
class Ghost:
    """The marked orientation: how far, in degrees, the aircraft must turn to it, about which axis of the world."""

    wxyz: Quaternion
    angle: float
    axis: Array
    rates: Array
    """Ring rates that turn the aircraft towards it by 1°/s, or come nearest to that; outer, middle, inner."""


@dataclass(frozen=True)
class GimbalSolution:
    """Columns of `axes`: outer, middle, inner ring axis in the world. What doesn't exist is None.

    `rings`: poses of the rings, each in the frame of the one outside it; `grips`: the place in the world (3, 3) where
    each is held, in rows. `reach`: the frame of the ellipsoid of
    reachable angular velocities, whose half-axes are the singular values; `weakest_axis` is the last of its axes, and
    `rates` the ring rates that turn about it at 1°/s, or, at lock, come nearest to that.
    """

    R: Array
    axis_angle: dict[str, Any]
    axes: Array
    singular_values: Array
    dof: int
    lost_axis: Array | None
    conditioning: float
    weakest_axis: Array
    rates: Array
    reduced: Reduced | None
    ghost: Ghost | None
    rings: tuple[Quaternion, Quaternion, Quaternion]
    grips: Array
    reach: Quaternion

    @property
    def near(self) -> bool:
        """Whether a turn about the weakest axis is hard, but not impossible."""
        return self.dof == 3 and self.singular_values.item(2) < NEAR

    @property
    def effort(self) -> float:
        """The fastest of the `rates`; infinite at lock, where none are enough."""
        return float(max(map(abs, self.rates.tolist()))) if self.dof == 3 else math.inf

    @property
    def glow(self) -> tuple[float, ...]:
        """How brightly each way to turn is lit: its singular value, 1 at most, and 0 for one that is lost."""
        return tuple(min(v, 1.0) if k < self.dof else 0.0 for k, v in enumerate(self.singular_values.tolist()))


def solve(p: GimbalParams) -> GimbalSolution:
    """All the mathematics of a state."""
    yaw, pitch, roll = map(math.radians, p.angles)
    R = euler.euler_to_matrix((yaw, pitch, roll), "zyx", "intrinsic")
    directions, lengths = gimbal.ellipsoid(yaw, pitch)
    weakest = directions[:, 2]
    lock = gimbal.at_lock(yaw, pitch, roll)
    axes = gimbal.ring_axes(yaw, pitch)
    axis, angle = matrix_to_axis_angle(R)
    return GimbalSolution(
        R=R,
        axis_angle={"axis": axis, "angle": math.degrees(float(angle))},
        axes=axes,
        singular_values=lengths,
        dof=int(gimbal.degrees_of_freedom(lengths)),
        lost_axis=gimbal.lost_axis(yaw, pitch),
        conditioning=float(gimbal.conditioning(pitch)),
        weakest_axis=weakest,
        rates=gimbal.ring_rates(yaw, pitch, weakest),
        reduced=None if lock is None else Reduced(lock.end, math.degrees(lock.angle), lock.R),
        ghost=_ghost(p, R) if p.show_ghost else None,
        rings=(
            quaternion.axis_quaternion("z", yaw),
            quaternion.axis_quaternion("y", pitch),
            quaternion.axis_quaternion("x", roll),
        ),
        grips=_grips(axes, R),
        reach=_floats(quaternion.from_matrix(directions)),
    )


def _grips(axes: Array, R: Array) -> Array:
    """Where the rings are held: outer and middle are spanned by two of the rings' axes, the inner one turns as R."""
    outer, middle, inner = axes.T
    directions = (_REST[0] @ (inner, middle, outer), _REST[1] @ (inner, middle, outer), R @ _REST[2])
    return np.array([ring.radius * each for ring, each in zip(RINGS, directions, strict=True)])


_REST = np.array([ring.held for ring in RINGS])


def _ghost(p: GimbalParams, R: Array) -> Ghost:
    marked = euler.euler_to_matrix([math.radians(a) for a in p.ghost], "zyx", "intrinsic")
    axis, angle = matrix_to_axis_angle(marked @ R.T)
    rates = gimbal.ring_rates(math.radians(p.yaw), math.radians(p.pitch), axis)
    return Ghost(_floats(quaternion.from_matrix(marked)), math.degrees(float(angle)), axis, rates)


def _floats(q: Array) -> Quaternion:
    w, x, y, z = q.tolist()
    return w, x, y, z
