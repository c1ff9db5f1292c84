"""Paths from one orientation to another: where the nose goes on the unit sphere, and when it is where."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np

from geometry import quaternion
from geometry.arrays import Array
from geometry.euler import matrix_to_euler
from geometry.hamilton import to_ball
from geometry.interpolation import euler_interpolation, interpolate_angles, nlerp_angle, turn_between, turned_by
from geometry.rotations import orbit

Name = Literal["slerp", "nlerp", "euler"]
MARKS = np.linspace(0.0, 1.0, 13)
"""Times of the marks."""
FINE = np.linspace(0.0, 1.0, 61)
"""Times of the points of a path; every fifth is that of a mark."""
COARSE = FINE[::2]
RADII = np.array([[1.0], [1.16]])
"""Between which a mark is drawn."""


@dataclass(frozen=True)
class NosePath:
    """One interpolation's path on the unit sphere, points (61, 3), and its marks at equal times, (13, 2, 3)."""

    path: Array
    marks: Array
    drawn: Array
    """Pieces (n, 2, 3) of the path, and then the marks."""


@lru_cache(maxsize=64)
def paths(start: bytes, target: bytes, long_way: bool) -> Mapping[Name, NosePath]:
    """The path of each interpolation between two unit quaternions, which are given as the bytes of their arrays."""
    first, last = np.frombuffer(start), np.frombuffer(target)
    R = quaternion.to_matrix(first)
    axis, angle = turn_between(first, last, long_way=long_way)
    arc = orbit(axis, R[:, 0], FINE * angle)
    own = euler_path(R, quaternion.to_matrix(last))
    return {
        "slerp": _path(arc, arc[::5]),
        "nlerp": _path(arc, orbit(axis, R[:, 0], nlerp_angle(angle, MARKS))),
        "euler": _path(own, own[::5]),
    }


def euler_path(first: Array, last: Array) -> Array:
    """Where the nose goes while yaw, pitch and roll go from one rotation's to another's; roll doesn't move it."""
    begin, end = (matrix_to_euler(R, "zyx", "intrinsic")[0] for R in (first, last))
    yaw, pitch, _ = interpolate_angles(begin, end, FINE).T
    level = np.cos(pitch)
    return np.array([np.cos(yaw) * level, np.sin(yaw) * level, -np.sin(pitch)]).T


@lru_cache(maxsize=64)
def ball_path(start: bytes, target: bytes, long_way: bool, euler: bool) -> Array:
    """The path from start to target in the stereographic ball, (31, 3); SLERP and NLERP take the same one."""
    first, last = np.frombuffer(start), np.frombuffer(target)
    if euler:
        return to_ball(euler_interpolation(first, last, COARSE))[0]
    axis, angle = turn_between(first, last, long_way=long_way)
    return to_ball(turned_by(first, axis, COARSE * float(angle)))[0]


def _path(path: Array, places: Array) -> NosePath:
    marks = places[:, None] * RADII
    return NosePath(path, marks, np.concatenate([np.stack([path[:-1], path[1:]], axis=1), marks]))
