"""Registration: where the second scan begins, the steps of ICP from there, and what is shown of one."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from geometry import clouds, rotations, se3
from geometry.arrays import Array
from sims.kit.progress import begins, goes_on
from sims.kit.sim import DRAWN
from sims.kit.types import Place
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.derived import normals, parts, spacing

MOST_STEPS = 40
"""Last step of a registration, at most."""
PAIRED = 12_000
"""Points of the second scan, about, that take part in a registration."""


@dataclass(frozen=True, eq=False)
class Registered:
    """ICP at one of its steps: `T` (4, 4) brings the second scan onto the first.

    Of `second_points` points of the second scan `source_points` take part, of which `pairs` have a partner within
    `reach` metres: wide at first and narrow later, by iteration in `reaches`. `error` is Σ‖R pᵢ + t − qᵢ‖² in m² over
    the pairs, `rmse` in metres, by iteration as well. `off` is how far in metres a corner of the box is at most from
    its true place, null where that isn't known. `unobservable` are directions of motion (rotation times lever,
    translation) that the pairs don't fix.
    """

    step: int
    steps: int
    T: Array
    error: float
    fitness: float
    rmse: float | None
    pairs: int
    converged: bool
    off: float | None
    unobservable: Array
    errors: list[float]
    fitnesses: list[float]
    rmses: list[float]
    reach: float
    reaches: list[float]
    source_points: int
    second_points: int
    links: Array = field(metadata=DRAWN)


@dataclass(frozen=True, eq=False)
class Course:
    """All steps of a registration, and which points of the second scan took part."""

    steps: tuple[clouds.Step, ...]
    source: Array
    target: Array
    converged: bool
    unobservable: Array
    reaches: tuple[float, ...]
    """Greatest distance of a pair, at each step."""
    second_points: int


@lru_cache(maxsize=8)
def pivot(cloud: Cloud) -> Array:
    """The middle (3,) of the second scan, in its own frame, about which it is turned."""
    rows = list(parts(cloud))[-1]
    return np.asarray(cloud.points[rows].mean(axis=0)) if len(rows) else np.zeros(3)


@lru_cache(maxsize=8)
def hold(cloud: Cloud) -> Array:
    """Where the second scan is held (3,), in its own frame: above its middle."""
    rows = list(parts(cloud))[-1]
    return np.array([*pivot(cloud)[:2], cloud.points[rows, 2].max() if len(rows) else 0.0])


def displaced(cloud: Cloud, shift: Place, turn: float) -> Array:
    """Where the second scan begins (4, 4): turned about the upright through its middle, in degrees, then shifted."""
    if not any(shift) and not turn:
        return np.eye(4)
    R, middle = rotations.axis_rotation("z", math.radians(turn)), pivot(cloud)
    return se3.transform(R, middle + np.array(shift) - R @ middle)


@lru_cache(maxsize=8)
def course(
    cloud: Cloud, thin: Cloud, method: str, neighbors: int, distance: float, shift: Place, turn: float
) -> Course | None:
    """ICP of the second scan to the first: pairs within a wide reach, then within a narrow one. None for one scan.

    It begins where the second scan is `displaced`.
    """
    rows = list(parts(thin))
    if len(rows) < 2 or min(map(len, rows)) < 10:
        return None
    target = clouds.Target(thin.points[rows[0]], normals(thin, neighbors)[rows[0]])
    source = thin.points[rows[1]][:: max(1, len(rows[1]) // PAIRED)]
    reaches = (distance,) if distance else (18.0 * spacing(cloud), 3.0 * max(spacing(cloud), spacing(thin)))
    begins("Registering the scans")
    steps: list[clouds.Step] = []
    within: list[float] = []
    converged = False
    for reach in reaches:
        start = steps[-1].T_target_source if steps else displaced(cloud, shift, turn)
        left = MOST_STEPS + 1 - len(steps)
        for k, step in enumerate(clouds.icp(source, target, reach, method=method, start=start, most=left)):
            goes_on(len(steps) / MOST_STEPS)
            if k or not steps:
                steps.append(step)
                within.append(reach)
            converged = 0 < k < left  # without a step there were too few pairs
    steps = steps[: MOST_STEPS + 1]
    known = clouds.certainty(target, source, steps[-1], method)
    unobservable = np.empty((0, 6)) if known is None else known.unobservable()
    return Course(
        tuple(steps), source, target.points, converged and len(within) <= MOST_STEPS, unobservable,
        tuple(within[: len(steps)]), len(rows[1]),
    )  # fmt: skip


def registered(cloud: Cloud, course: Course, number: int) -> Registered:
    """The state at a step; beyond the last one, the last."""
    number = min(number, len(course.steps) - 1)
    step = course.steps[number]
    paired = np.flatnonzero(step.target >= 0)
    shown = paired[:: max(1, len(paired) // 300)]
    links = np.stack([se3.apply(step.T_target_source, course.source[shown]), course.target[step.target[shown]]], axis=1)
    return Registered(
        step=number, steps=len(course.steps) - 1, T=step.T_target_source, error=step.error, fitness=step.fitness,
        rmse=_or_none(step.rmse), pairs=len(paired), converged=course.converged, off=_off(cloud, step.T_target_source),
        unobservable=course.unobservable, errors=[s.error for s in course.steps],
        fitnesses=[s.fitness for s in course.steps],
        rmses=[s.rmse if math.isfinite(s.rmse) else 0.0 for s in course.steps], reach=course.reaches[number],
        reaches=list(course.reaches), source_points=len(course.source), second_points=course.second_points,
        links=links,
    )  # fmt: skip


def _or_none(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _off(cloud: Cloud, T: Array) -> float | None:
    if cloud.truth is None:
        return None
    low, high = clouds.bounds(cloud.points)
    corners = np.array(np.meshgrid(*np.stack([low, high], axis=1))).reshape(3, -1).T
    return float(np.linalg.norm(se3.apply(T, corners) - se3.apply(cloud.truth, corners), axis=1).max())
