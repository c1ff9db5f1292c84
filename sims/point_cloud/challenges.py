"""What is to be reached with a cloud."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from geometry import clouds
from geometry.arrays import Array
from geometry.clouds import Indices
from sims.kit.challenge import Challenge, Progress, nearer
from sims.kit.readout import quantity
from sims.point_cloud.datasets import dataset
from sims.point_cloud.derived import cells_of
from sims.point_cloud.params import CloudParams
from sims.point_cloud.solution import CloudSolution

FEW, SAME = 0.05, 0.01
"""Share of the points that may be left, and of a side of the box by which it may be off."""
POSTS = ((5.0, 1.6), (5.0, 2.1))
"""Where on the street two thin posts stand close together: x and y in metres."""
ABOUT, LOW, HIGH = 0.15, 0.3, 2.5
"""How far from a post's middle its points are at most, and between which heights nothing else is beside it."""
NEAR, FAR = 0.005, 0.7
"""Metres that a corner may be off in a registration, and from which on nearness counts."""


def _few(p: CloudParams, s: CloudSolution) -> Progress:
    if p.dataset != "statue":
        return Progress(0.0, "Choose the statue first.")
    size = _statue()
    off, share = float(np.abs(s.dimensions / size - 1.0).max()), s.points_out / s.points_in
    if off > SAME:
        return Progress(0.1, f"The box is off by {_percent(off)}: it may be by {_percent(SAME, 0)}")
    left, far = (max(math.log(each / FEW), 0.0) for each in (share, 1.0))
    done = f"{_percent(share)} of the points, and the box is off by {_percent(off)} at most"
    return nearer(left, far, 0.0, f"{_percent(share)} of the points: below {_percent(FEW, 0)} are wanted", done)


def _percent(part: float, digits: int = 1) -> str:
    return quantity(100.0 * part, "%", digits)


@cache
def _statue() -> Array:
    """Dimensions (3,) of the statue's box as it was measured."""
    low, high = clouds.bounds(dataset("statue").points)
    return high - low


def _one_post(p: CloudParams, _: CloudSolution) -> Progress:
    if p.dataset != "street" or p.voxel_size == 0.0:
        return Progress(0.0, "Choose the street, and cells of some size.")
    cells, (one, other) = cells_of(dataset("street"), p.voxel_size)[0], _posts()
    if np.intersect1d(cells.labels[one], cells.labels[other]).size:
        return Progress(1.0, "Here one point stands for a piece of both posts")
    low, high = (float(dataset("street").points[rows, 1].max()) for rows in (one, other))
    gap = float(dataset("street").points[other, 1].min()) - low
    if p.voxel_size < gap:
        words = f"A cell of {quantity(p.voxel_size, 'm', 2)} is smaller than the gap of {quantity(gap, 'm', 2)}"
        return Progress(0.5 * p.voxel_size / gap, words)
    wall = float(cells.origin[1]) + p.voxel_size * math.ceil((low - float(cells.origin[1])) / p.voxel_size)
    inside = min(abs(wall - low), abs(high - wall))
    words = f"A wall between two cells still parts the posts: move it by {quantity(inside, 'm', 2)}"
    return Progress(0.5 + 0.49 * max(1.0 - inside / gap, 0.0), words)


@cache
def _posts() -> tuple[Indices, Indices]:
    """Rows of the street's points on the one post and on the other."""
    x, y, z = dataset("street").points.T
    between = (z > LOW) & (z < HIGH)
    one, other = (np.flatnonzero(between & (np.hypot(x - a, y - b) < ABOUT)) for a, b in POSTS)
    return one, other


def _registered(p: CloudParams, s: CloudSolution) -> Progress:
    if p.dataset != "two-scans" or s.registration is None or s.registration.off is None:
        return Progress(0.0, "Choose the two scans, and the process that registers them.")
    left, far = (max(math.log(each / NEAR), 0.0) for each in (s.registration.off, FAR))
    words = f"A corner is still {quantity(1000.0 * s.registration.off, 'mm', 1)} from where it belongs"
    return nearer(left, far, 0.0, words, f"Every corner is within {quantity(1000.0 * NEAR, 'mm', 0)} of its place")


CHALLENGES: tuple[Challenge[CloudParams, CloudSolution], ...] = (
    Challenge(
        id="same-box", title="Few points, the same box",
        goal="Show fewer than 5 % of the statue’s points in a box whose sides are within 1 % of what they were.",
        near=_few, solves={"dataset": "statue", "voxel_size": 0.04},
        misses=(
            {"dataset": "statue", "voxel_size": 0.03},
            {"dataset": "statue", "voxel_size": 0.04, "process": "outliers"},
        ),
    ),
    Challenge(
        id="one-post", title="Two posts become one",
        goal="Find a voxel size at which two posts of the street share a cell.",
        near=_one_post, solves={"dataset": "street", "voxel_size": 0.68},
        misses=({"dataset": "street", "voxel_size": 0.3}, {"dataset": "street", "voxel_size": 1.0}),
    ),
    Challenge(
        id="register", title="Within 5 mm",
        goal="Register the two scans so that no corner is farther than 5 mm from where it belongs.",
        near=_registered, solves={"dataset": "two-scans", "process": "register", "step": 8},
        misses=(
            {"dataset": "two-scans", "process": "register", "step": 2},
            {"dataset": "two-scans", "process": "register", "step": 40, "method": "point"},
        ),
    ),
)  # fmt: skip
