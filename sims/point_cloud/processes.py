"""The processes, on points that are thinned already; each result is kept for the steps that show it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from geometry import GeometryError, clouds, se3
from geometry.arrays import Array
from geometry.clouds import Indices
from sims.kit.progress import begins, goes_on
from sims.kit.sim import DRAWN
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.derived import normals, parts, spacing

UP = np.array([0.0, 0.0, 1.0])
STEEPEST = math.radians(20.0)
LEAST_GROUND = 0.2
"""Share of the points that must be on the ground before clusters are looked for without it."""
LEAST_CLUSTER = 30
MOST_STEPS = 40
"""Last step of a registration, at most."""
LAST = 2
"""Last step of every other process: nothing, found, done."""
PAIRED = 12_000
"""Points of the second scan, about, that take part in a registration."""
MESHED = 8_000
"""Points of a surface, at most: an alpha shape takes its time."""
FINEST = 90.0
"""Cells of a surface along the cloud's longest side, at most."""
ENOUGH = 3
"""Measured points that a cell must have for a surface, where cells have many."""
FAR = 3.0
"""Standard deviations farther from its neighbours than is usual, from which on a point is left out of a surface."""


@dataclass(frozen=True, eq=False)
class Ground:
    """The plane n·p + offset = 0 that most points are near to."""

    normal: Array
    offset: float
    inliers: int
    rms: float
    distance: float
    on: Indices = field(metadata=DRAWN)


@dataclass(frozen=True, eq=False)
class Clusters:
    """Sizes in points, the largest first, of groups without a gap wider than `distance` in metres."""

    sizes: list[int]
    distance: float
    without_ground: bool
    unclustered: int
    labels: Indices = field(metadata=DRAWN)


@dataclass(frozen=True, eq=False)
class Outliers:
    """How many points are farther than `threshold` from their neighbours, in the mean."""

    removed: int
    threshold: float
    off: Indices = field(metadata=DRAWN)


@dataclass(frozen=True, eq=False)
class Registered:
    """ICP at one of its steps: `T` (4, 4) brings the second scan onto the first.

    `error` is Σ‖R pᵢ + t − qᵢ‖² in m² over the pairs, `rmse` in metres, by iteration as well. `off` is how far in
    metres a corner of the box is at most from its true place, null where that isn't known. `unobservable` are
    directions of motion (rotation times lever, translation) that the pairs don't fix.
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
    links: Array = field(metadata=DRAWN)


@dataclass(frozen=True, eq=False)
class Surface:
    """An alpha shape on `points` means of cells: triangles, area in m², and the volume in m³ that it encloses.

    Through a gap that the ball passes it comes inside, and nothing is enclosed.
    """

    triangles: int
    area: float
    volume: float
    radius: float
    cell: float
    points: int
    vertices: Array = field(metadata=DRAWN)
    faces: Indices = field(metadata=DRAWN)


@lru_cache(maxsize=16)
def ground(cloud: Cloud, thin: Cloud, distance: float) -> Ground | None:
    """The ground, within 20° of level; None where no plane is, or there are too few points."""
    distance = distance or 2.0 * spacing(cloud)
    begins("Looking for the ground")
    try:
        plane = clouds.ransac_plane(thin.points, distance, up=UP, tilt=STEEPEST)
    except GeometryError:
        return None
    on = np.flatnonzero(plane.inliers)
    return Ground(plane.normal, plane.offset, len(on), plane.rms, distance, on)


@lru_cache(maxsize=16)
def clusters(cloud: Cloud, thin: Cloud, distance: float, voxel: float) -> Clusters:
    """Clusters of what stands on the ground, where there is ground."""
    below = ground(cloud, thin, 0.0)
    above = np.arange(len(thin))
    if below is not None and below.inliers >= LEAST_GROUND * len(thin):
        above = np.delete(above, below.on)
    distance = distance or max(8.0 * spacing(cloud), 2.0 * voxel)
    least = LEAST_CLUSTER if voxel == 0.0 else 5
    begins("Growing clusters")
    found = clouds.clusters(thin.points[above], distance, least=least, progress=goes_on)
    labels = np.full(len(thin), -2, np.intp)
    labels[above] = found.labels
    alone = int(np.count_nonzero(labels == -1))
    return Clusters(found.sizes.tolist(), distance, len(above) < len(thin), alone, labels)


@lru_cache(maxsize=16)
def outliers(thin: Cloud, neighbors: int, deviations: float) -> Outliers:
    """Points that are unusually far from their neighbours."""
    begins("Looking for outliers")
    found = clouds.outliers(thin.points, neighbors, deviations, progress=goes_on)
    off = np.flatnonzero(~found.keep)
    return Outliers(len(off), found.threshold, off)


@dataclass(frozen=True, eq=False)
class Course:
    """All steps of a registration, and which points of the second scan took part."""

    steps: tuple[clouds.Step, ...]
    source: Array
    target: Array
    converged: bool
    unobservable: Array
    reach: float


@lru_cache(maxsize=8)
def course(cloud: Cloud, thin: Cloud, method: str, neighbors: int, distance: float) -> Course | None:
    """ICP of the second scan to the first: pairs within a wide reach, then within a narrow one. None for one scan."""
    rows = list(parts(thin))
    if len(rows) < 2 or min(map(len, rows)) < 10:
        return None
    target = clouds.Target(thin.points[rows[0]], normals(thin, neighbors)[rows[0]])
    source = thin.points[rows[1]][:: max(1, len(rows[1]) // PAIRED)]
    reaches = (distance,) if distance else (18.0 * spacing(cloud), 3.0 * max(spacing(cloud), spacing(thin)))
    begins("Registering the scans")
    steps: list[clouds.Step] = []
    converged = False
    for reach in reaches:
        start = steps[-1].T_target_source if steps else np.eye(4)
        left = MOST_STEPS + 1 - len(steps)
        for k, step in enumerate(clouds.icp(source, target, reach, method=method, start=start, most=left)):
            goes_on(len(steps) / MOST_STEPS)
            if k or not steps:
                steps.append(step)
            converged = k < left
    steps = steps[: MOST_STEPS + 1]
    known = clouds.certainty(target, source, steps[-1], method)
    unobservable = np.empty((0, 6)) if known is None else known.unobservable()
    return Course(
        tuple(steps), source, target.points, converged and len(steps) <= MOST_STEPS, unobservable, reaches[-1]
    )


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
        rmses=[s.rmse if math.isfinite(s.rmse) else 0.0 for s in course.steps], reach=course.reach, links=links,
    )  # fmt: skip


def _or_none(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _off(cloud: Cloud, T: Array) -> float | None:
    if cloud.truth is None:
        return None
    low, high = clouds.bounds(cloud.points)
    corners = np.array(np.meshgrid(*np.stack([low, high], axis=1))).reshape(3, -1).T
    return float(np.linalg.norm(se3.apply(T, corners) - se3.apply(cloud.truth, corners), axis=1).max())


def _meshed(points: Array, counts: Indices, cell: float) -> tuple[Array, Indices]:
    """Means of the cells that points (N, 3) are in, and how many measured points are in each."""
    cells = clouds.voxels(points, cell)
    within = np.bincount(cells.labels, counts, len(cells.points))
    return cells.mean(points * counts[:, None]) * (cells.counts / within)[:, None], within.astype(np.intp)


def _sure(points: Array, counts: Indices) -> Array:
    """Those of the means that others are near to, and enough measured points: a lone one among many is likelier noise.

    Where a cloud is so thin that most cells have one point, one is enough.
    """
    usual = float((counts * counts).sum() / counts.sum())  # in the cell of a measured point, not of a thrown-off one
    points = points[counts >= min(ENOUGH, 0.25 * usual)]
    return points[clouds.outliers(points, 16, FAR).keep] if len(points) > 1 else points


def _for_mesh(thin: Cloud, voxel: float) -> tuple[Array, float]:
    """Points (N, 3) that a surface is made on, and the edge of their cells in metres; 0 if all are in one place."""
    low, high = clouds.bounds(thin.points)
    cell = float((high - low).max()) / FINEST
    points, counts = thin.points, thin.measured
    if voxel > 0.5 * cell:  # another grid of about the same cells would leave gaps
        cell = voxel
    elif cell > 0.0:
        points, counts = _meshed(thin.points, thin.measured, cell)
    while len(points) > MESHED:
        cell *= 1.05 * math.sqrt(len(points) / MESHED)
        points, counts = _meshed(thin.points, thin.measured, cell)
    return _sure(points, counts), cell


def _ring(points: Array) -> float:
    """How far, in metres, the eight points round one are at most, in the median: of a full grid its diagonal."""
    near = clouds.Neighbours(points)
    return float(np.median(near.nearest(slice(None), min(9, len(near)))[0][:, -1])) if len(near) > 1 else 0.0


@lru_cache(maxsize=8)
def surface(thin: Cloud, voxel: float, distance: float) -> Surface | None:
    """The alpha shape of one point a cell, with cells large enough that it doesn't take long; None if all is flat."""
    if not len(thin):
        return None
    begins("Rolling a ball over the points")
    points, cell = _for_mesh(thin, voxel)
    goes_on()
    radius = distance or max(1.5 * cell, _ring(points)) or 1.0
    try:
        shape = clouds.alpha_shape(points, radius)
    except GeometryError:
        return None
    return Surface(
        len(shape.triangles), shape.area, shape.volume, radius, cell, len(points), shape.points, shape.triangles
    )
