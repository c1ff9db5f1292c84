"""What a cloud is worth keeping for: its thinned points, their normals and colours, each made once.

Every result is kept under what it follows from, so that a change of the point size or of the colours computes
nothing again. The newest few are kept: a slider that is dragged leaves many behind.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from geometry import clouds
from geometry.arrays import Array
from geometry.clouds import Indices
from sims.kit.progress import begins, goes_on
from sims.point_cloud import colors
from sims.point_cloud.cloud import Cloud, Colors

BINS = 48
LOCAL = ("normals", "variation")
"""Colours that follow from each point's neighbours."""
SHADED = ("height", "rgb")
"""Colours that may be darker without saying something else: of the others brightness is part of what they say."""
TO_LIGHT = np.array([-0.36, -0.48, 0.8])
DARKEST = 0.45
"""How bright what faces away from the light is."""
LIT = 20_000
"""Cells of a cloud whose brightness is found, at most."""


def parts(cloud: Cloud) -> Iterator[Indices]:
    """Rows of each scan, for scans that aren't registered yet; else all rows at once."""
    if not cloud.apart or cloud.scan is None:
        yield np.arange(len(cloud))
    else:
        yield from (np.flatnonzero(cloud.scan == number) for number in (0, 1))


@lru_cache(maxsize=16)
def thinned(cloud: Cloud, size: float) -> Cloud:
    """The cloud with one point, the mean, for each cell of edge `size` in metres; itself for size 0."""
    if size == 0.0:
        return cloud
    begins("Downsampling")
    thin = [
        _thinned(cloud if len(rows) == len(cloud) else cloud.only(rows), cells)
        for rows, cells in zip(parts(cloud), cells_of(cloud, size), strict=True)
    ]
    return thin[0] if len(thin) == 1 else thin[0].followed_by(thin[1])


@lru_cache(maxsize=4)
def cells_of(cloud: Cloud, size: float) -> list[clouds.Voxels]:
    """The cells of edge `size` in metres, of each scan by itself."""
    return [clouds.voxels(cloud.points[rows], size) for rows in parts(cloud)]


def _thinned(cloud: Cloud, cells: clouds.Voxels) -> Cloud:
    return cloud.only(cells.first).with_means(
        points=cells.points,
        colors=None if cloud.colors is None else np.rint(cells.mean(cloud.colors)).astype(np.uint8),
        intensity=None if cloud.intensity is None else cells.mean(cloud.intensity),
        normals=None if cloud.normals is None else _of_length_one(cells.mean(cloud.normals)),
        counts=cells.counts,
    )


def _of_length_one(vectors: Array) -> Array:
    """The same directions (N, 3); zero where there is none."""
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    directions: Array = np.divide(vectors, lengths, out=np.zeros_like(vectors), where=lengths > 1e-9)
    return directions


@dataclass(frozen=True, eq=False)
class Local:
    """Unit normals (N, 3), the file's own or by each point's neighbours to the sensor, and surface variation (N,).

    Where they are on a line, or too few, there is no normal and no variation: zero and NaN.
    """

    normals: Array
    variation: Array


@lru_cache(maxsize=16)
def local(cloud: Cloud, neighbors: int) -> Local:
    """Normals and surface variation of a cloud, of each scan by itself."""
    begins("Estimating normals")
    vectors, variation = np.zeros_like(cloud.points), np.full(len(cloud), np.nan)
    before = 0

    def progress(done: float) -> None:
        goes_on((before + done * len(rows)) / len(cloud))

    for rows in parts(cloud):
        sensor = cloud.sensor if cloud.sensor is None or cloud.sensor.ndim == 1 else cloud.sensor[rows]
        if len(rows) >= 3:
            found = clouds.normals(cloud.points[rows], neighbors, sensor=sensor, progress=progress)
            vectors[rows] = np.nan_to_num(found.normals, nan=0.0)
            variation[rows] = np.where(found.defined, found.variation, np.nan)
        before += len(rows)
    if cloud.normals is not None:
        vectors = np.where(cloud.normals.any(axis=1, keepdims=True), cloud.normals, vectors)
    return Local(vectors, variation)


def normals(cloud: Cloud, neighbors: int) -> Array:
    """Unit normals (N, 3); zero where there is none."""
    return local(cloud, neighbors).normals


@lru_cache(maxsize=32)
def around(cloud: Cloud, row: int, neighbors: int) -> clouds.Neighbourhood:
    """The nearest points of one of a cloud, of its own scan; `rows` are those of the whole cloud."""
    rows = next(rows for rows in parts(cloud) if rows[0] <= row <= rows[-1])
    found = clouds.neighbourhood(cloud.points[rows], row - int(rows[0]), neighbors)
    return replace(found, rows=rows[found.rows])


@lru_cache(maxsize=8)
def _light(cloud: Cloud) -> Array:
    """How bright (N,) each point of a cloud is in a light from above, by the direction of the surface about it.

    All points of a cell have one brightness: normals of so few are found in a tenth of the time.
    """
    low, high = clouds.bounds(cloud.points)
    size = float((high - low).max()) / 250.0 or 1.0
    while len(coarse := thinned(cloud, size)) > LIT:
        size *= 1.05 * math.sqrt(len(coarse) / LIT)
    bright = DARKEST + (1.0 - DARKEST) * (0.5 + 0.5 * normals(coarse, 16) @ TO_LIGHT)
    found, before = np.empty(len(cloud)), 0
    for rows, cells in zip(parts(cloud), cells_of(cloud, size), strict=True):
        found[rows] = bright[before + cells.labels]
        before += len(cells.points)
    return found


@lru_cache(maxsize=16)
def light(cloud: Cloud, thin: Cloud, size: float) -> Array:
    """The same of its points thinned to cells of edge `size`: the mean brightness, without new normals."""
    each = _light(cloud) if len(cloud) else np.empty(0)
    if thin is cloud:
        return each
    cells = zip(parts(cloud), cells_of(cloud, size), strict=True)
    return np.concatenate([grid.mean(each[rows]) for rows, grid in cells])


@lru_cache(maxsize=32)
def spacing(cloud: Cloud) -> float:
    """Median distance to the nearest point, in metres; 1 where all points are in one place."""
    return (clouds.spacing(cloud.points) if len(cloud) > 1 else 0.0) or 1.0


@dataclass(frozen=True, eq=False)
class Tally:
    """How many points have a value in each of some equal bins from `low` to `high`, and those bins' colours."""

    kind: str
    low: float
    high: float
    counts: Indices
    paint: Colors


@lru_cache(maxsize=32)
def tally(cloud: Cloud, thin: Cloud, kind: str, neighbors: int) -> Tally | None:
    """What the colour bar says of height, intensity, surface variation or measured colour; None of directions."""
    if kind == "normals":
        return None
    if kind == "rgb" and cloud.colors is not None:
        return _brightness(cloud.colors)
    low, high = span(cloud, thin, kind, neighbors)
    values = measured(cloud, thin, kind, neighbors)
    counts, _ = np.histogram(np.clip(values[np.isfinite(values)], low, high), BINS, (low, high))
    return Tally(kind, low, high, counts, colors.ramp(kind)[np.linspace(0, 255, BINS).astype(int)])


def _brightness(measured: Colors) -> Tally:
    """How many points are how bright, and the mean colour of those."""
    level = np.minimum(measured.max(axis=1).astype(np.intp) * BINS // 256, BINS - 1)
    counts = np.bincount(level, minlength=BINS)
    means = np.stack([np.bincount(level, c, BINS) for c in measured.T.astype(float)], axis=1)
    return Tally("rgb", 0.0, 1.0, counts, np.rint(means / np.maximum(counts, 1)[:, None]).astype(np.uint8))


@lru_cache(maxsize=32)
def span(cloud: Cloud, thin: Cloud, kind: str, neighbors: int) -> tuple[float, float]:
    """What the colours of a value go from and to: but for the farthest half per cent at each end."""
    values = measured(cloud, thin, kind, neighbors)
    values = values[np.isfinite(values)]
    if not len(values):
        return 0.0, 1.0
    low, high = np.percentile(values, (0.5, 99.5)).tolist()
    if kind == "variation":
        return 0.0, high or 1.0 / 3.0
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def measured(cloud: Cloud, thin: Cloud, kind: str, neighbors: int) -> Array:
    """Heights or intensities of the whole cloud, or the variation of its thinned points, which is NaN for some."""
    return local(thin, neighbors).variation if kind == "variation" else _own(cloud, kind)


def _own(cloud: Cloud, kind: str) -> Array:
    return cloud.points[:, 2] if kind == "height" or cloud.intensity is None else cloud.intensity


def colored_by(cloud: Cloud, color: str) -> str:
    """What the colours can say: height, where what was asked for wasn't measured."""
    missing = (color == "rgb" and cloud.colors is None) or (color == "intensity" and cloud.intensity is None)
    return "height" if missing else color


@dataclass(frozen=True)
class Look:
    """What the colours of points follow from: `neighbors` is 0 where they don't matter, and so is `voxel`.

    `voxel` is the edge of the cells that they were thinned to.
    """

    color: str = ""
    neighbors: int = 0
    shaded: bool = False
    voxel: float = 0.0


@lru_cache(maxsize=16)
def painted(cloud: Cloud, thin: Cloud, look: Look) -> Colors:
    """Colours (N, 3) of the thinned points, as they are sent; the spans are those of the whole cloud."""
    kind = colored_by(cloud, look.color)
    if kind == "normals":
        return colors.of_directions(normals(thin, look.neighbors))
    bright = light(cloud, thin, look.voxel) if look.shaded and kind in SHADED else None
    if kind == "rgb" and thin.colors is not None:
        return colors.of_rgb(colors.darkened(thin.colors, bright))
    values, ends = measured(thin, thin, kind, look.neighbors), span(cloud, thin, kind, look.neighbors)
    return colors.of_values(values, ends, kind, bright)
