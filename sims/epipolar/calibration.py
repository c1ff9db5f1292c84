"""Two calibrated cameras from a text as OpenCV, Kalibr or ROS write it."""

from __future__ import annotations

import math
import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from geometry.arrays import Array
from geometry.rotations import is_rotation, matrix_to_axis_angle, nearest_rotation
from sims.epipolar.params import EpipolarParams

EXAMPLE = """\
K1: [458.654, 0, 367.215, 0, 457.296, 248.375, 0, 0, 1]
K2: [457.587, 0, 379.999, 0, 456.134, 255.238, 0, 0, 1]
R: [0.999997, 0.002312, 0.000376, -0.002317, 0.999898, 0.014090, -0.000343, -0.014091, 0.999901]
T: [-0.110074, 0.000399, -0.000853]"""
"""The cameras of a flying robot. Source: Burri et al. 2016, "The EuRoC micro aerial vehicle datasets"."""
OPENCV = (("K1", "K2"), ("M1", "M2"), ("cameraMatrix1", "cameraMatrix2"), ("K_left", "K_right"))
"""What people call both camera matrices; R and T have these names."""
KALIBR = "T_cn_cnm1"
ABOUT_A_MATRIX = {"rows", "cols", "dt", "type_id"}
"""Keys that stand between a matrix's name and its `data`."""
ROTATION = 1e-4
"""By how much the entries of a matrix may differ from those of a rotation: files have a few digits."""
KEY = re.compile(r"""^[\s\-"']*([A-Za-z_]\w*)["']?\s*[:=]""", re.MULTILINE)
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
Entries = Mapping[str, Sequence[list[float]]]


def read(text: str) -> list[float]:
    """The pair as `EpipolarParams.own` has it. Raises ValueError in words."""
    entries = _entries(text)
    for left, right in OPENCV:
        if left in entries and right in entries:
            R, T = _matrix(entries, "R", (3, 3)), _matrix(entries, "T", (3, 1))
            return _own(_matrix(entries, left, (3, 3)), _matrix(entries, right, (3, 3)), R, T)
    if KALIBR in entries:
        return _kalibr(entries)
    if len(entries.get("projection_matrix", ())) > 1:
        return _ros(entries)
    raise ValueError(
        "No pair was found: there should be K1, K2, R and T, or Kalibr’s cam0 and cam1, or both cameras’ ROS files."
    )


def changes(p: EpipolarParams, own: Sequence[float]) -> dict[str, Any]:
    """The state with that pair."""
    return {"own": tuple(own)}


def _entries(text: str) -> Entries:
    """The numbers that stand after each key, for each time that it stands there."""
    found, owner = defaultdict(list), ""
    for key, following in pairwise([*KEY.finditer(text), None]):
        assert key is not None
        if key[1] in ABOUT_A_MATRIX:
            continue
        owner = owner if key[1] == "data" else key[1]
        value = text[key.end() : following.start() if following else len(text)]
        if numbers := [float(number) for number in NUMBER.findall(value)]:
            found[owner].append(numbers)
    return found


def _matrix(entries: Entries, name: str, shape: tuple[int, int], k: int = 0) -> Array:
    numbers = entries[name][k] if k < len(entries.get(name, ())) else []
    if len(numbers) != math.prod(shape) or not all(map(math.isfinite, numbers)):
        raise ValueError(f"“{name}” should have {math.prod(shape)} numbers for each camera or pair.")
    return np.array(numbers).reshape(shape)


def _kalibr(entries: Entries) -> list[float]:
    first, second = (_matrix(entries, "intrinsics", (4, 1), k)[:, 0] for k in (0, 1))
    left, right = (np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]]) for fx, fy, cx, cy in (first, second))
    T = _matrix(entries, KALIBR, (4, 4))
    return _own(left, right, T[:3, :3], T[:3, 3:])


def _ros(entries: Entries) -> list[float]:
    """From both rectifications: x_rectified = R x, and between the rectified cameras there is a shift alone."""
    first, second = (_matrix(entries, "projection_matrix", (3, 4), k) for k in (0, 1))
    order = (0, 1) if abs(first[0, 3]) <= abs(second[0, 3]) else (1, 0)
    last = (first, second)[order[1]]
    left, right = (_matrix(entries, "rectification_matrix", (3, 3), k) for k in order)
    K_left, K_right = (_matrix(entries, "camera_matrix", (3, 3), k) for k in order)
    shift = np.linalg.solve(last[:, :3], last[:, 3:])
    return _own(K_left, K_right, right.T @ left, right.T @ shift)


def _own(left: Array, right: Array, R: Array, T: Array) -> list[float]:
    for K in (left, right):
        if min(K[0, 0], K[1, 1]) <= 0.0 or abs(K[0, 1]) > 1e-6 * K[0, 0] or not np.allclose(K[2], (0.0, 0.0, 1.0)):
            raise ValueError("A camera matrix should be (fx, 0, cx; 0, fy, cy; 0, 0, 1), with fx and fy above 0.")
    if not is_rotation(R, ROTATION):
        raise ValueError("R should be a rotation: its rows have length 1, and are at right angles.")
    if not T.any():
        raise ValueError("T is zero: without a baseline there is no F.")
    axis, angle = matrix_to_axis_angle(nearest_rotation(R))
    lenses = [float(K[at]) for K in (left, right) for at in ((0, 0), (1, 1), (0, 2), (1, 2))]
    return [*lenses, *np.degrees(axis * angle).tolist(), *T[:, 0].tolist()]
