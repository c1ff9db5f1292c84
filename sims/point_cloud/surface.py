"""The surface that points lie on: an alpha shape of means of cells, few enough that it doesn't take long."""

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

MESHED = 8_000
"""Points of a surface, at most: an alpha shape takes its time."""
FINEST = 90.0
"""Cells of a surface along the cloud's longest side, at most."""
ENOUGH = 3
"""Measured points that a cell must have for a surface, where cells have many."""
FAR = 3.0
"""Standard deviations farther from its neighbours than is usual, from which on a point is left out of a surface."""


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
