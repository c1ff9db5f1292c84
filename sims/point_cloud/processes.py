"""The processes, on points that are thinned already; each result is kept for the steps that show it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from geometry import GeometryError, clouds
from geometry.arrays import Array
from geometry.clouds import Indices
from sims.kit.progress import begins, goes_on
from sims.kit.sim import DRAWN
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.derived import spacing

UP = np.array([0.0, 0.0, 1.0])
STEEPEST = math.radians(20.0)
LEAST_GROUND = 0.2
"""Share of the points that must be on the ground before clusters are looked for without it."""
LEAST_CLUSTER = 30
LAST = 2
"""Last step of every other process: nothing, found, done."""


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
