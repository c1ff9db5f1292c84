"""What a cloud is worth keeping for: its thinned points, their normals and colours, each made once.

Every result is kept under what it follows from, so that a change of the point size or of the colours computes
nothing again. The newest few are kept: a slider that is dragged leaves many behind.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import numpy as np

from geometry import clouds
from geometry.arrays import Array
from geometry.clouds import Indices
from sims.kit.progress import goes_on
from sims.point_cloud import colors
from sims.point_cloud.cloud import Cloud, Colors


def parts(cloud: Cloud) -> Iterator[Indices]:
    """Rows of each scan, for scans that aren't registered yet; else all rows at once."""
    if cloud.truth is None or cloud.scan is None:
        yield np.arange(len(cloud))
    else:
        yield from (np.flatnonzero(cloud.scan == number) for number in (0, 1))


@lru_cache(maxsize=16)
def thinned(cloud: Cloud, size: float) -> Cloud:
    """The cloud with one point, the mean, for each cell of edge `size` in metres; itself for size 0."""
    if size == 0.0:
        return cloud
    thin = [_thinned(cloud if len(rows) == len(cloud) else cloud.only(rows), size) for rows in parts(cloud)]
    return thin[0] if len(thin) == 1 else thin[0].followed_by(thin[1])


def _thinned(cloud: Cloud, size: float) -> Cloud:
    cells = clouds.voxels(cloud.points, size)
    first = np.empty(len(cells.counts), np.intp)
    first[cells.labels[::-1]] = np.arange(len(cloud) - 1, -1, -1)  # of several values for a cell the last one stays
    return cloud.only(first).with_means(
        points=cells.points,
        colors=None if cloud.colors is None else np.rint(cells.mean(cloud.colors)).astype(np.uint8),
        intensity=None if cloud.intensity is None else cells.mean(cloud.intensity),
    )


@lru_cache(maxsize=16)
def normals(cloud: Cloud, neighbors: int) -> Array:
    """Unit normals (N, 3) to the sensor; zero where there is none."""
    found = np.empty_like(cloud.points)
    for rows in parts(cloud):
        sensor = cloud.sensor if cloud.sensor is None or cloud.sensor.ndim == 1 else cloud.sensor[rows]
        here = cloud.points[rows]
        if len(here) >= 3:
            found[rows] = clouds.normals(here, neighbors, sensor=sensor, progress=goes_on).normals
        else:
            found[rows] = np.nan
    return np.nan_to_num(found, nan=0.0)


@lru_cache(maxsize=32)
def spacing(cloud: Cloud) -> float:
    """Median distance to the nearest point, in metres; 1 where all points are in one place."""
    return (clouds.spacing(cloud.points) if len(cloud) > 1 else 0.0) or 1.0


@lru_cache(maxsize=32)
def span(cloud: Cloud, kind: str) -> tuple[float, float]:
    """What the colours of height or intensity go from and to: but for the farthest half per cent at each end."""
    if not len(cloud):
        return 0.0, 1.0
    values = measured(cloud, kind)
    low, high = np.percentile(values, (0.5, 99.5)).tolist()
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def measured(cloud: Cloud, kind: str) -> Array:
    """Heights or intensities (N,)."""
    return cloud.points[:, 2] if kind == "height" or cloud.intensity is None else cloud.intensity


def colored_by(cloud: Cloud, color: str) -> str:
    """What the colours can say: height, where what was asked for wasn't measured."""
    missing = (color == "rgb" and cloud.colors is None) or (color == "intensity" and cloud.intensity is None)
    return "height" if missing else color


@lru_cache(maxsize=16)
def painted(cloud: Cloud, thin: Cloud, color: str, neighbors: int) -> Colors:
    """Colours (N, 3) of the thinned points, as they are sent; the spans are those of the whole cloud."""
    kind = colored_by(cloud, color)
    if kind == "normals":
        return colors.of_directions(normals(thin, neighbors))
    if kind == "rgb" and thin.colors is not None:
        return colors.of_rgb(thin.colors)
    return colors.of_values(measured(thin, kind), span(cloud, kind), kind)
