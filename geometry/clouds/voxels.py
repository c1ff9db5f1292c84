"""Voxel grid: one point for each cell that has any, the mean of those in it."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from ..arrays import Array
from ..errors import GeometryError, as_array, as_finite_array, as_number
from .points import MANY, Indices, as_cloud, columns, in_chunks, measured

_DENSE = 16
"""Cells of the whole grid, per point, up to which a table of all cells is quicker than sorting."""
_MOST = 2.0**52
"""Cells along an axis, from which on a coordinate no longer tells which cell it is in."""


@dataclass(frozen=True, eq=False)
class Voxels:
    """A cloud on a grid of cubic cells of edge `size`: M cells have points.

    `points` (M, 3) are the means, in the order of the cells (x, then y, then z), `counts` (M,) says of how many
    points. `origin` (3,) is a corner of the grid.
    """

    points: Array
    counts: Indices
    size: float
    origin: Array
    _keys: Indices
    _number: Indices | None = None

    @cached_property
    def labels(self) -> Indices:
        """Number (N,) of each point's cell: made when it is asked for."""
        return self._keys if self._number is None else self._number[self._keys]

    @cached_property
    def first(self) -> Indices:
        """Row (M,) of each cell's first point."""
        first = np.empty(len(self.counts), np.intp)
        first[self.labels[::-1]] = np.arange(len(self.labels) - 1, -1, -1)  # of several the last one stays
        return first

    def mean(self, values: npt.ArrayLike) -> Array:
        """Return the means (M, ...) in each cell of what belongs to the points, (N, ...): colours, intensities."""
        array = np.asarray(values, dtype=np.float64)
        if array.shape[:1] != self.labels.shape:
            raise GeometryError("values", f"an array of shape {array.shape}", f"{len(self.labels)} rows")
        flat = columns(array.reshape(len(array), int(np.prod(array.shape[1:]))))
        means = _means(self.labels, self.counts, slice(None), flat)
        return means.reshape(len(self.counts), *array.shape[1:])


def voxels(points: npt.ArrayLike, size: float, *, origin: npt.ArrayLike | None = None) -> Voxels:
    """Average points (N, 3) over the cells of a grid with edge `size` in metres.

    The grid starts at `origin`, or half a cell below the least coordinates, as Open3D's does. A point on a face
    belongs to the cell above it. No points give no cells.
    Raises GeometryError if the size isn't positive or is too small for float64, or a point isn't finite.
    """
    cloud, size = as_array("points", points, 3), as_number("size", size, above=0.0)
    if not cloud.size or cloud.ndim != 2:
        return _no_voxels(as_cloud("points", cloud), size)
    xyz, low, high = measured(cloud)
    if not np.isfinite([low, high]).all():
        as_cloud("points", cloud)
    start = low - 0.5 * size if origin is None else as_finite_array("origin", origin, 3)
    if np.abs([low - start, high - start]).max() > _MOST * size:
        raise GeometryError("size", size, "larger, for points so far from the grid's origin")
    keys, cells = cell_keys(xyz, start, size, low, high)
    if cells <= _DENSE * len(keys) + 4096:
        counts = np.bincount(keys, minlength=cells)
        filled = np.flatnonzero(counts)
        means = _means(keys, counts, filled, xyz) + start
        return Voxels(means, counts[filled], size, start, keys, _numbers(filled, cells))
    labels, counts = _by_sorting(keys, cells)
    return Voxels(_means(labels, counts, slice(None), xyz) + start, counts, size, start, labels)


def _no_voxels(cloud: Array, size: float) -> Voxels:
    nothing = np.empty(0, np.intp)
    return Voxels(cloud, nothing, size, np.zeros(3), nothing)


def _means(labels: Indices, counts: Indices, filled: Indices | slice, rows: Array) -> Array:
    number = counts[filled]
    means = np.empty((len(number), len(rows)))

    def work(some: slice) -> None:
        for column in range(some.start, some.stop):
            sums = np.bincount(labels, weights=rows[column], minlength=len(counts))
            means[:, column] = sums[filled] / number

    in_chunks(work, len(rows), size=1 if len(labels) > MANY else len(rows))
    return means


def _numbers(filled: Indices, cells: int) -> Indices:
    """For each cell of the whole grid its place among the filled ones."""
    number = np.empty(cells, np.intp)
    number[filled] = np.arange(len(filled))
    return number


def cell_keys(xyz: Array, start: Array, size: float, low: Array, high: Array) -> tuple[Indices, int]:
    """One number for each point's cell, in the cells' order, and how many numbers there may be.

    The columns (3, N) are moved, in place, to the grid's start (3,). `low` and `high` (3,) are the least and greatest
    coordinates that they had.
    """
    first, last = np.floor((low - start) / size), np.floor((high - start) / size)
    lengths = [int(length) for length in (last - first + 1.0).tolist()]
    cells = math.prod(lengths)
    if cells >= _MOST:
        xyz -= start[:, None]
        return _long_keys(xyz, size)
    keys = np.empty(xyz.shape[1], np.int64)

    def work(rows: slice) -> None:
        xyz[:, rows] -= start[:, None]
        number, *others = _cells(xyz[:, rows], size, first)
        for length, other in zip(lengths[1:], others, strict=True):
            number *= length
            number += other
        keys[rows] = number

    in_chunks(work, len(keys), size=32_768)
    return keys, cells


def _cells(xyz: Array, size: float, first: Array) -> Array:
    """Cells' numbers along the axes: whole numbers below 2^53, which float64 holds and is quicker with."""
    cells = xyz / size
    np.floor(cells, out=cells)
    cells -= first[:, None]
    return cells


def _long_keys(xyz: Array, size: float) -> tuple[Indices, int]:
    """The same for grids with more cells than a number has digits: cells that nobody is in aren't counted."""
    keys, cells = np.zeros(xyz.shape[1], np.int64), 1
    for row in xyz:
        length, axis = _ranks(np.floor(row / size))
        if cells * length >= 2**62:
            cells, keys = _ranks(keys)
        keys = keys * length + axis
        cells *= length
    return keys, cells


def _ranks(values: Indices | Array) -> tuple[int, Indices]:
    different, ranks = np.unique(values, return_inverse=True)
    return len(different), ranks


def _by_sorting(keys: Indices, cells: int) -> tuple[Indices, Indices]:
    """Number of each point's cell among those that have points, and how many points each of them has."""
    bits = len(keys).bit_length()
    if cells >= 2 ** (63 - bits):
        _, labels, counts = np.unique(keys, return_inverse=True, return_counts=True)
        return labels, counts
    order = sort_keys(keys, bits)
    ordered = keys[order]
    first = np.empty(len(keys), bool)
    first[0], first[1:] = True, ordered[1:] != ordered[:-1]
    labels = np.empty(len(keys), np.intp)
    labels[order] = np.cumsum(first) - 1
    starts = np.flatnonzero(first)
    return labels, np.diff(starts, append=len(keys))


def sort_keys(keys: Indices, bits: int) -> Indices:
    """Order of keys below 2^(63 − bits), of which there are fewer than 2^bits; equal ones in their own order.

    Key and index share one integer: sorting integers is far quicker than finding the order of the keys.
    """
    packed = keys << bits
    packed |= np.arange(len(keys))
    packed.sort()
    packed &= (1 << bits) - 1
    return packed
