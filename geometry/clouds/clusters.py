"""Euclidean clusters: points that are linked by steps no longer than a distance."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from ..arrays import Array
from ..errors import GeometryError, as_number
from .neighbours import Neighbours
from .points import Indices, Progress, as_cloud, measured, silent

_PAIRS = 1 << 20  # of points, compared at once
_MANY = 1 << 14  # pairs of points in two cells, from which on a tree is quicker


@dataclass(frozen=True, eq=False)
class Clusters:
    """`labels` (N,): the cluster of each point, the largest first, −1 if it is too small. `sizes` (K,) in points."""

    labels: Indices
    sizes: Indices


def clusters(points: npt.ArrayLike, distance: float, *, least: int = 1, progress: Progress = silent) -> Clusters:
    """Split points (N, 3) into clusters: within one, steps of at most a distance in metres lead from point to point.

    Clusters of fewer than `least` points are left out.
    Raises GeometryError if the distance isn't positive or is too small for float64, or a point isn't finite.
    Source: Rusu 2009, "Semantic 3D object maps", sec. 6.2. Points in one cell of a grid whose diagonal is the
    distance are together without a look; only cells that are near, and not together yet, are compared by points.
    """
    cloud, distance = as_cloud("points", points), as_number("distance", distance, above=0.0)
    if not len(cloud):
        return Clusters(np.empty(0, np.intp), np.empty(0, np.intp))
    grid = _Grid(cloud, distance)
    progress(0.3)
    one, other = grid.join_by_one_point()
    progress(0.6)
    grid.join_by_all_points(one, other, progress)
    progress(1.0)
    return _by_size(grid.labels(), as_number("least", least, least=1))


def _by_size(labels: Indices, least: float) -> Clusters:
    sizes = np.bincount(labels)
    order = np.argsort(-sizes, kind="stable")
    kept = order[sizes[order] >= least]
    number = np.full(len(sizes), -1, np.intp)
    number[kept] = np.arange(len(kept))
    return Clusters(number[labels], sizes[kept])


class _Grid:
    """Points sorted by cell, cells known by whole coordinates, and which cells are in one cluster so far."""

    def __init__(self, cloud: Array, distance: float) -> None:
        xyz, low, high = measured(cloud)
        edge = distance / math.sqrt(3.0) * (1.0 - 1e-9)
        if float((high - low).max()) > 2.0**50 * edge:
            raise GeometryError("distance", distance, "larger, for points so far apart")
        cells = np.floor((xyz - low[:, None]) / edge).astype(np.int64)
        self.order = np.lexsort(cells[::-1])
        self.points = cloud.take(self.order, axis=0)
        ordered = cells.take(self.order, axis=1)
        first = np.ones(len(cloud), bool)
        first[1:] = (ordered[:, 1:] != ordered[:, :-1]).any(axis=0)
        self.starts = np.flatnonzero(first)
        self.counts = np.diff(self.starts, append=len(cloud))
        self.cell_of_point = np.cumsum(first) - 1
        self.key = _Keys(ordered.take(self.starts, axis=1))
        self.group = np.arange(len(self.starts))
        self.limit = distance

    def labels(self) -> Indices:
        labels = np.empty(len(self.order), np.intp)
        labels[self.order] = self.group[self.cell_of_point]
        return labels

    def join_by_one_point(self) -> tuple[Indices, Indices]:
        """Join near cells whose first points are near; return the pairs of near cells that may yet be joined."""
        near: list[tuple[Indices, Indices]] = []
        unsure: list[tuple[Indices, Indices]] = []
        heads = self.points.take(self.starts, axis=0)
        for a, b in self.key.near_pairs():
            linked = self._within(heads.take(a, axis=0), heads.take(b, axis=0))
            near.append((a[linked], b[linked]))
            rest = ~linked & (self.counts[a] * self.counts[b] > 1)
            unsure.append((a[rest], b[rest]))
        self._join(*_joined(near))
        return self._apart(*_joined(unsure))

    def join_by_all_points(self, a: Indices, b: Indices, progress: Progress) -> None:
        """Compare the points of pairs of cells, few products first, each time leaving out what is joined."""
        products = self.counts[a] * self.counts[b]
        order = np.argsort(products, kind="stable")
        a, b, products = a[order], b[order], products[order]
        few = int(np.searchsorted(products, _MANY))
        ends = np.cumsum(products[:few])
        first = 0
        while first < few:
            behind = int(ends[first - 1]) if first else 0
            last = max(int(np.searchsorted(ends, behind + _PAIRS)), first + 1)
            self._join_part(*self._apart(a[first:last], b[first:last]))
            first = last
            progress(0.6 + 0.2 * first / few)
        for done, (one, other) in enumerate(zip(a[few:].tolist(), b[few:].tolist(), strict=True)):
            if self.group[one] != self.group[other] and self._meet(one, other):
                self._join(np.array([one]), np.array([other]))
            progress(0.8 + 0.2 * done / (len(a) - few))

    def _apart(self, a: Indices, b: Indices) -> tuple[Indices, Indices]:
        different = self.group[a] != self.group[b]
        return a[different], b[different]

    def _within(self, p: Array, q: Array) -> npt.NDArray[np.bool_]:
        offset = p - q
        return np.asarray(np.sqrt(np.vecdot(offset, offset)) <= self.limit)

    def _join_part(self, a: Indices, b: Indices) -> None:
        products = self.counts[a] * self.counts[b]
        pair = np.repeat(np.arange(len(a)), products)
        rank = np.arange(len(pair)) - np.repeat(np.cumsum(products) - products, products)
        i, j = np.divmod(rank, self.counts[b][pair])
        near = self._within(self.points[self.starts[a][pair] + i], self.points[self.starts[b][pair] + j])
        linked = np.unique(pair[near])
        self._join(a[linked], b[linked])

    def _meet(self, one: int, other: int) -> bool:
        p, q = (self.points[self.starts[c] : self.starts[c] + self.counts[c]] for c in (one, other))
        nearest, _ = Neighbours(p).query(q, 1, distance_upper_bound=np.nextafter(self.limit, math.inf))
        return bool(nearest.min() <= self.limit)

    def _join(self, a: Indices, b: Indices) -> None:
        if not len(a):
            return
        count = int(self.group.max()) + 1
        links = coo_array((np.ones(len(a), bool), (self.group[a], self.group[b])), shape=(count, count))
        self.group = connected_components(links, directed=False)[1].astype(np.intp)[self.group]


def _joined(pairs: list[tuple[Indices, Indices]]) -> tuple[Indices, Indices]:
    return np.concatenate([a for a, _ in pairs]), np.concatenate([b for _, b in pairs])


class _Keys:
    """Cells, columns (3, M), that are sorted by x, y and z, found again as neighbours of each other."""

    def __init__(self, cells: Indices) -> None:
        x, y, z = (_bridged(column) for column in cells)
        self.across, self.high = int(y.max()) + 5, int(z.max()) + 5
        self.keys = ((x + 2) * self.across + y + 2) * self.high + z + 2

    def near_pairs(self) -> Iterator[tuple[Indices, Indices]]:
        """Yield pairs of cells whose coordinates differ by two at most, each pair once."""
        for x, y in product(range(3), range(-2, 3)):
            if (x, y) >= (0, 0):
                lowest = -2 if (x, y) > (0, 0) else 1
                yield from self._above(self.keys + (x * self.across + y) * self.high, lowest)

    def _above(self, keys: Indices, lowest: int) -> Iterator[tuple[Indices, Indices]]:
        """Cells from `lowest` to two above or below the keys: one after the other from where the lowest would be."""
        place = np.searchsorted(self.keys, keys + lowest)
        for ahead in range(3 - lowest):
            last = np.searchsorted(place, len(self.keys) - ahead)
            found = np.flatnonzero(self.keys.take(place[:last] + ahead) <= keys[:last] + 2)
            yield found, place.take(found) + ahead


def _bridged(column: Indices) -> Indices:
    """Coordinates moved together so that gaps are 3 at most, which no two near cells are apart: they fit a key."""
    axis, ranks = np.unique(column, return_inverse=True)
    return np.concatenate([[0], np.cumsum(np.minimum(np.diff(axis), 3))])[ranks]
