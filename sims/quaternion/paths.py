"""Paths from one orientation to another: where the nose goes on the unit sphere, and when it is where."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
import numpy.typing as npt

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
OUTWARD, INWARD = np.array([[1.0], [1.09]]), np.array([[0.91], [1.0]])
"""Radii between which a mark is drawn: SLERP's and NLERP's, on one arc, are on its two sides."""
EVERY = np.arange(len(FINE) - 1)
PIECES = np.column_stack([EVERY, EVERY + 1])
DASHES: dict[Name, npt.NDArray[np.intp]] = {"slerp": PIECES, "nlerp": PIECES[EVERY % 5 < 3], "euler": PIECES[::2]}
"""From which points of a path to which its pieces are drawn."""


@dataclass(frozen=True)
class NosePath:
    """One interpolation's path on the unit sphere, points (61, 3), and its marks at equal times, (13, 2, 3)."""

    path: Array
    marks: Array
    drawn: Array
    """Pieces (n, 2, 3) of the path, in its dash, and then the marks."""


@dataclass(frozen=True)
class NosePaths:
    """The one turn that SLERP and NLERP make (unit axis, radians), and the path of each interpolation."""

    axis: Array
    angle: float
    by_name: Mapping[Name, NosePath]


@lru_cache(maxsize=64)
def paths(start: bytes, target: bytes, long_way: bool) -> NosePaths:
    """The paths between two unit quaternions, which are given as the bytes of their arrays."""
    first, last = np.frombuffer(start), np.frombuffer(target)
    R = quaternion.to_matrix(first)
    axis, angle = turn_between(first, last, long_way=long_way)
    arc = orbit(axis, R[:, 0], FINE * angle)
    uneven = orbit(axis, R[:, 0], nlerp_angle(angle, MARKS))
    own = euler_path(R, quaternion.to_matrix(last))
    by_name: dict[Name, NosePath] = {
        "slerp": _path("slerp", arc, arc[::5], OUTWARD),
        "nlerp": _path("nlerp", arc, uneven, INWARD),
        "euler": _path("euler", own, own[::5], OUTWARD),
    }
    return NosePaths(axis, float(angle), by_name)


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
    whole = paths(start, target, long_way)
    return to_ball(turned_by(first, whole.axis, COARSE * whole.angle))[0]


def _path(name: Name, path: Array, places: Array, radii: Array) -> NosePath:
    marks = places[:, None] * radii
    return NosePath(path, marks, np.concatenate([path[DASHES[name]], marks]))
