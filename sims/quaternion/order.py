"""Two turns in both orders."""

from __future__ import annotations

import math
from dataclasses import dataclass

from geometry import quaternion
from geometry.arrays import Array
from geometry.rotations import unit
from sims.kit.types import Vector

ALIKE = 1e-6
"""Degrees within which two ends are one."""


@dataclass(frozen=True)
class Orders:
    """Two turns A and B about axes that stay in the world, one after the other, in both orders. Quaternions."""

    a_first: Array
    """B ⊗ A: first A, then B."""
    b_first: Array
    """A ⊗ B: first B, then A."""
    left: Array
    """Where the object is at t that begins with A: half of t is for each turn."""
    right: Array
    """Where the one is that begins with B."""
    axes: tuple[Array, Array]
    """Of A and of B, unit."""
    apart: float
    """Degrees of the turn that leads from the one end to the other."""

    @property
    def alike(self) -> bool:
        """Both orders end the same."""
        return self.apart < ALIKE


def both_orders(axis_a: Vector, angle_a: float, axis_b: Vector, angle_b: float, start: Array, t: float) -> Orders:
    """Turns by angles in degrees, made from a start (4,) on; t from 0 to 1."""
    first, second = min(2.0 * t, 1.0), max(2.0 * t - 1.0, 0.0)

    def turned(by_a: float, by_b: float) -> tuple[Array, Array]:
        a = quaternion.from_axis_angle(axis_a, by_a * math.radians(angle_a))
        b = quaternion.from_axis_angle(axis_b, by_b * math.radians(angle_b))
        return quaternion.multiply(b, a), quaternion.multiply(a, b)

    a_first, b_first = turned(1.0, 1.0)
    left, right = turned(first, second)[0], turned(second, first)[1]
    return Orders(
        a_first,
        b_first,
        quaternion.multiply(left, start),
        quaternion.multiply(right, start),
        (unit(axis_a), unit(axis_b)),
        _apart(a_first, b_first),
    )


def _apart(p: Array, q: Array) -> float:
    """Degrees of the smallest turn between two orientations."""
    angle = math.degrees(quaternion.to_axis_angle(quaternion.multiply(p, quaternion.conjugate(q)))[1])
    return min(angle, 360.0 - angle)
