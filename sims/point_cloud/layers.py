"""What is drawn of a state: two layers of points, lines and a mesh, each the same array as long as it is the same."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from geometry import clouds
from geometry.arrays import Array
from geometry.clouds import Indices
from sims.kit.palette import LIGHT, rgb
from sims.kit.view import View
from sims.point_cloud import colors, processes
from sims.point_cloud.cloud import Cloud, Colors
from sims.point_cloud.derived import Look, Tally, cells_of, normals, painted, parts
from sims.point_cloud.surface import Surface

MOST_ARROWS = 1_200
"""Normals that are drawn: one in each cell of a grid that is as fine as that allows."""
GHOSTS = 20_000
"""Points of the original that are drawn behind what it was thinned to, at most."""
ARROW = 0.8
"""Their length, of how far they are apart."""
FEW = 0.05
"""Share of the mean number of points in a cell: with fewer, they are likelier outliers."""
MARKS = {"ground": rgb("#c46a1a"), "outliers": rgb(LIGHT.warn), "fixed": rgb(LIGHT.left), "moves": rgb(LIGHT.right)}
Floats = npt.NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Layer:
    """Points that are drawn alike: rows of the thinned cloud, their places, and the colours to send."""

    rows: Indices
    points: Floats
    colors: Colors


@dataclass(frozen=True, eq=False)
class Drawn:
    """The points as they are (`base`), and those that a process marks (`marked`), drawn larger, in `T` (4, 4)."""

    base: Layer
    marked: Layer
    T: Array
    base_normals: Array
    marked_normals: Array
    arrow: float
    """How long the normals are drawn, in metres."""
    ground: Array | None
    """Corners (4, 3) of the piece of the plane that is drawn."""
    mesh: Surface | None
    names: list[tuple[str, Array]]
    """Words at places: the largest clusters."""
    view: View
    """The view of the whole cloud."""
    cloud: Cloud
    """All of it, before anything was done."""
    tally: Tally | None
    """What the colour bar says."""
    ghost: Floats | None
    """Points as they were measured, beside what they were thinned to."""
    cells: Cells | None
    """About the selected point of a thinned cloud."""
    grip: Array | None
    """Where the second scan is held, before it is registered."""


NOTHING = np.empty(0, np.intp)
NO_ARROWS = np.empty((0, 2, 3))


@lru_cache(maxsize=16)
def layer(cloud: Cloud, thin: Cloud, look: Look, kind: str, mark: str, result: object) -> Layer:
    """One of the two layers; `kind` says which points, `mark` their colour, where it isn't that of the state."""
    rows = _rows(thin, kind, result)
    if mark == "clusters" and isinstance(result, processes.Clusters):
        paint = colors.of_clusters(result.labels[rows])
    elif mark:
        paint = colors.shaded(
            MARKS.get(mark, colors.GREY), None if thin.colors is None else thin.colors[rows], len(rows)
        )
    else:
        paint = painted(cloud, thin, look)[rows]
    return Layer(rows, _places(thin)[rows], paint)


@lru_cache(maxsize=16)
def _places(thin: Cloud) -> Floats:
    return thin.points.astype(np.float32)


def _rows(thin: Cloud, kind: str, result: object) -> Indices:
    """Rows of the thinned cloud that a layer has."""
    everything = np.arange(len(thin))
    if kind == "all":
        return everything
    if isinstance(result, processes.Ground):
        return result.on if kind == "marked" else np.delete(everything, result.on)
    if isinstance(result, processes.Outliers):
        return result.off if kind == "marked" else np.delete(everything, result.off)
    if isinstance(result, processes.Clusters):
        chosen = {"above": result.labels > -2, "marked": result.labels >= 0, "rest": result.labels == -1}[kind]
        return np.flatnonzero(chosen)
    if kind in ("first", "second"):
        return list(parts(thin))[kind == "second"]
    return NOTHING


def nothing(cloud: Cloud, thin: Cloud) -> Layer:
    """A layer without points."""
    return layer(cloud, thin, Look(), "nothing", "ground", None)


@lru_cache(maxsize=8)
def ghost(cloud: Cloud) -> Floats:
    """Some of a cloud's points as they were measured, evenly chosen: few enough to be sent and drawn beside others."""
    rows = np.linspace(0, len(cloud) - 1, min(GHOSTS, len(cloud))).astype(np.intp)
    return cloud.points[rows].astype(np.float32)


@dataclass(frozen=True, eq=False)
class Cells:
    """The edges (12, 2, 3) of a chosen point's cell, those (n, 2, 3) of cells near it, and the points in them."""

    own: Array
    near: Array
    points: Floats


@lru_cache(maxsize=8)
def cells(cloud: Cloud, thin: Cloud, row: int, size: float) -> Cells:
    """The cells about a thinned point, two in each direction, and what was measured in them."""
    grids = zip(parts(cloud), parts(thin), cells_of(cloud, size), strict=True)
    rows, thinned, grid = next(each for each in grids if row <= each[1][-1])
    number = row - int(thinned[0])
    places = np.floor((thin.points[thinned] - grid.origin) / size)
    away = np.abs(places - places[number]).max(axis=1)
    near = np.flatnonzero((away <= 2) & (away > 0))
    edges = [boxed(low, low + size) for low in grid.origin + size * places[[number, *near]]]
    measured = np.isin(grid.labels, [number, *near])
    return Cells(edges[0], np.concatenate([NO_ARROWS, *edges[1:]]), cloud.points[rows[measured]].astype(np.float32))


def boxed(low: Array, high: Array) -> Array:
    """The twelve edges (12, 2, 3) of a box."""
    corners = np.array([[(low, high)[k >> axis & 1][axis] for axis in range(3)] for k in range(8)])
    pairs = [(k, k | 1 << axis) for k in range(8) for axis in range(3) if not k >> axis & 1]
    return np.asarray(corners[np.array(pairs)])


@lru_cache(maxsize=16)
def arrows(thin: Cloud, neighbors: int, voxel: float, points: Layer) -> Array:
    """Tails and tips (n, 2, 3): from some of a layer's points, evenly chosen, along their normals."""
    chosen, _ = _spread(thin, voxel)
    rows = np.intersect1d(chosen, points.rows)
    vectors = normals(thin, neighbors)[rows]
    start = thin.points[rows]
    return np.stack([start, start + arrow_length(thin, voxel) * vectors], axis=1)[vectors.any(axis=1)]


def arrow_length(thin: Cloud, voxel: float) -> float:
    """So short, in metres, that no arrow reaches the next."""
    return ARROW * _spread(thin, voxel)[1]


@lru_cache(maxsize=16)
def _spread(thin: Cloud, voxel: float) -> tuple[Indices, float]:
    """Rows of points that are about so many metres apart: few enough to draw something at each."""
    if not len(thin):
        return NOTHING, 1.0
    low, high = clouds.bounds(thin.points)
    cell = max(voxel, float((high - low).max()) / 100.0, 1e-3)
    while len(rows := _one_a_cell(thin, cell)) > MOST_ARROWS:
        cell *= 1.1 * math.sqrt(len(rows) / MOST_ARROWS)
    return rows, cell


def _one_a_cell(thin: Cloud, cell: float) -> Indices:
    """The first point in each cell, of each scan by itself; none where there are far fewer than elsewhere."""
    chosen = []
    for rows in parts(thin):
        cells = clouds.voxels(thin.points[rows], cell)
        chosen.append(rows[cells.first[cells.counts >= FEW * len(rows) / max(len(cells.counts), 1)]])
    return np.concatenate(chosen)


def patch(found: processes.Ground, low: Array, high: Array) -> Array:
    """Corners (4, 3) of the ground plane over the box from `low` to `high`."""
    a, b, c = found.normal.tolist()
    corners = [(low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1])]
    return np.array([(x, y, -(a * x + b * y + found.offset) / c) for x, y in corners])


def plane_of(near: clouds.Neighbourhood) -> Array:
    """Corners (4, 3) of a piece of the plane through some neighbours: of evenly spread ones it has about their size."""
    _, along, across = near.axes * (2.0 * np.sqrt(near.eigenvalues))[:, None]
    corners = [-along - across, along - across, along + across, across - along]
    return np.asarray(near.center + np.array(corners))


@lru_cache(maxsize=16)
def whole(cloud: Cloud) -> View:
    """A view of all of a cloud that somebody uploaded."""
    if not len(cloud):
        return View((4.0, -5.0, 4.0), (0.0, 0.0, 0.0), 3.0)
    low, high = clouds.bounds(cloud.points)
    middle = 0.5 * (low + high)
    radius = max(0.5 * float(np.linalg.norm(high - low)), 1e-3)
    x, y, z = (middle + radius * np.array([1.2, -1.8, 1.3])).tolist()
    return View((x, y, z), (float(middle[0]), float(middle[1]), float(middle[2])), radius)


@lru_cache(maxsize=16)
def extent(points: Layer) -> tuple[Array, Array]:
    """Least and greatest coordinates of a layer that has points."""
    return clouds.bounds(points.points)


def cluster_names(found: processes.Clusters, thin: Cloud, most: int) -> list[tuple[str, Array]]:
    """Numbers of the largest clusters, above the highest point of each."""
    names = []
    for number, size in enumerate(found.sizes[:most]):
        here = thin.points[found.labels == number]
        top = np.array([*here[:, :2].mean(axis=0), here[:, 2].max()])
        names.append((f"{number + 1}: {size:,} points".replace(",", "\u2009"), top))
    return names
