"""The nearest points of each point: a k-d tree over points that are kept in the order of a coarse grid.

Points that are near in space are then near in memory, for the tree and for whoever gathers neighbours.

A k-d tree can't part points in one place: of thousands there, each would look at all. Of those the tree has only as
many copies as anybody asks for: which of them is found is all the same.
"""

from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from ..arrays import Array, Mask
from ..errors import GeometryError
from .points import Indices, as_cloud, columns, measured
from .voxels import cell_keys, sort_keys

_PER_CELL = 64
_COPIES = 256
"""Points in one place that the tree has, at most, for who asks for no more neighbours."""
_CROWDED = 512
"""Points of a cell, from which on it is looked whether they are in one place."""
_ODD = 0x9E3779B97F4A7C1, 0x2545F4914F6CDD1D, 0x14057B7EF767814F  # multipliers that spread the coordinates' bits


class Neighbours:
    """Points (N, 3) in an order of their own: `ordered[i]` is `points[order[i]]`."""

    def __init__(self, points: npt.ArrayLike) -> None:
        cloud = as_cloud("points", points)
        self.order, cells = _by_cells(cloud)
        self.ordered = cloud.take(self.order, axis=0)  # three times as quick as cloud[order]
        self._left = _without_copies(self.ordered, cells)

    def __len__(self) -> int:
        return len(self.ordered)

    @cached_property
    def xyz(self) -> Array:
        """The ordered points' columns (3, N)."""
        return columns(self.ordered)

    @cached_property
    def _all(self) -> Any:
        return _tree(self.ordered)

    @cached_property
    def _few(self) -> Any:
        assert self._left is not None
        return _tree(self.ordered.take(self._left[:-1], axis=0))

    def query(self, points: Array, count: int, **how: Any) -> tuple[Array, Indices]:
        """Return distances and places in `ordered` of the nearest points of points (n, 3), as SciPy's k-d tree does.

        Where there is none, the place is the number of points.
        """
        if self._left is None or count > _COPIES:
            distances, places = self._all.query(points, count, **how)
            return distances, places
        distances, places = self._few.query(points, count, **how)
        return distances, self._left.take(places)

    def nearest(self, rows: slice | Indices, count: int) -> tuple[Array, Indices]:
        """Return distances and places in `ordered`, both (n, count), of the nearest points of some ordered rows.

        The first is the point itself, or one in the same place.
        """
        distances, places = self.query(self.ordered[rows], count)
        return distances.reshape(-1, count), places.reshape(-1, count)

    def unordered(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Return rows that belong to the ordered points in the order of the given ones."""
        result = np.empty_like(values)
        result[self.order] = values
        return result


def spacing(points: npt.ArrayLike) -> float:
    """Return the median distance of points (N, 3) from their nearest neighbours, in metres.

    Raises GeometryError if there are fewer than two points.
    """
    near = Neighbours(points)
    if len(near) < 2:
        raise GeometryError("points", f"{len(near)} points", "at least two")
    sample = slice(None, None, max(1, len(near) // 20_000))
    return float(np.median(near.nearest(sample, 2)[0][:, 1]))


def spatial_order(cloud: Array) -> Indices:
    """Return an order of points (N, 3) by the cells of a grid, of some tens of points on surfaces."""
    return _by_cells(cloud)[0]


def _by_cells(cloud: Array) -> tuple[Indices, Indices]:
    """The order, and the key of the cell of each point so ordered."""
    if len(cloud) < 2:
        return np.arange(len(cloud)), np.zeros(len(cloud), np.intp)
    xyz, low, high = measured(cloud)
    size = float((high - low).max()) / max(1.0, np.sqrt(len(cloud) / _PER_CELL))
    if not size > 0.0:
        return np.arange(len(cloud)), np.zeros(len(cloud), np.intp)
    keys, cells = cell_keys(xyz, low, size, low, high)
    bits = len(keys).bit_length()
    order = sort_keys(keys, bits) if cells < 2 ** (63 - bits) else np.argsort(keys, kind="stable")
    return order, keys.take(order)


def _without_copies(ordered: Array, cells: Indices) -> Indices | None:
    """Rows of ordered points but for copies beyond `_COPIES`, and their number N behind them; None if all stay."""
    if not (cells[_CROWDED:] == cells[:-_CROWDED]).any():
        return None
    counts = _runs(cells[1:] != cells[:-1])
    rows = np.flatnonzero(np.repeat(counts > _CROWDED, counts))
    points = ordered.take(rows, axis=0)
    x, y, z = points.view(np.int64).T
    marks = np.sort(x * _ODD[0] + y * _ODD[1] + z * _ODD[2])  # equal for equal points: a quick look comes first
    if not (marks[_COPIES:] == marks[:-_COPIES]).any():
        return None
    order = np.lexsort(points.T)
    points = points.take(order, axis=0)
    counts = _runs((points[1:] != points[:-1]).any(axis=1))
    copy = np.arange(len(points)) - np.repeat(np.cumsum(counts) - counts, counts)
    left = np.ones(len(ordered) + 1, bool)
    left[rows[order[copy >= _COPIES]]] = False
    return np.flatnonzero(left)


def _runs(changes: Mask) -> Indices:
    """Lengths of runs, from where among N − 1 places between things one differs from the next."""
    return np.diff(np.flatnonzero(np.concatenate([[True], changes, [True]])))


def _tree(points: Array) -> Any:
    return cKDTree(points, leafsize=16, balanced_tree=False, compact_nodes=False)
