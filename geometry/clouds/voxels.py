"""Voxel grid: one point for each cell that has any, the mean of those in it."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..arrays import Array
from ..errors import GeometryError, as_finite_array, as_number
from .points import Indices, as_cloud, columns, extent

_DENSE = 16
"""Cells of the whole grid, per point, up to which a table of all cells is quicker than sorting."""
_MOST = 2.0**52
"""Cells along an axis, from which on a coordinate no longer tells which cell it is in."""


@dataclass(frozen=True, eq=False)
class Voxels:
    """A cloud on a grid of cubic cells of edge `size`: M cells have points.

    `points` (M, 3) are the means, in the order of the cells (x, then y, then z), `counts` (M,) says of how many,
    `labels` (N,) in which cell each point is. `origin` (3,) is a corner of the grid.
    """

    points: Array
    counts: Indices
    labels: Indices
    size: float
    origin: Array

    def mean(self, values: npt.ArrayLike) -> Array:
        """Return the means (M, ...) in each cell of what belongs to the points, (N, ...): colours, intensities."""
        array = np.asarray(values, dtype=np.float64)
        if array.shape[:1] != self.labels.shape:
            raise GeometryError("values", f"an array of shape {array.shape}", f"{len(self.labels)} rows")
        flat = columns(array.reshape(len(array), int(np.prod(array.shape[1:]))))
        means = _means(self.labels, self.counts, flat)
        return means.reshape(len(self.counts), *array.shape[1:])


def voxels(points: npt.ArrayLike, size: float, *, origin: npt.ArrayLike | None = None) -> Voxels:
    """Average points (N, 3) over the cells of a grid with edge `size` in metres.

    The grid starts at `origin`, or half a cell below the least coordinates, as Open3D's does. A point on a face
    belongs to the cell above it. No points give no cells.
    Raises GeometryError if the size isn't positive or is too small for float64, or a point isn't finite.
    """
    cloud, size = as_cloud("points", points), as_number("size", size, above=0.0)
    if not len(cloud):
        nothing = np.empty(0, np.intp)
        return Voxels(np.empty((0, 3)), nothing, nothing, size, np.zeros(3))
    xyz = columns(cloud)
    low, high = extent(xyz)
    start = low - 0.5 * size if origin is None else as_finite_array("origin", origin, 3)
    if np.abs([low - start, high - start]).max() / size > _MOST:
        raise GeometryError("size", size, "larger, for points so far from the grid's origin")
    xyz -= start[:, None]
    labels, counts = _labels(xyz, size)
    return Voxels(_means(labels, counts, xyz) + start, counts, labels, size, start)


def _means(labels: Indices, counts: Indices, rows: Array) -> Array:
    means = np.empty((len(counts), len(rows)))
    for column, row in enumerate(rows):
        means[:, column] = np.bincount(labels, weights=row, minlength=len(counts))
    means /= counts[:, None]
    return means


def _labels(xyz: Array, size: float) -> tuple[Indices, Indices]:
    """Number of each point's cell among those that have points, and how many points each of them has."""
    keys, cells = cell_keys(xyz, size)
    if cells <= _DENSE * len(keys) + 4096:
        return _by_table(keys, cells)
    bits = len(keys).bit_length()
    if cells < 2 ** (63 - bits):
        return _by_sorting(keys, bits)
    _, labels, counts = np.unique(keys, return_inverse=True, return_counts=True)
    return labels, counts


def cell_keys(xyz: Array, size: float) -> tuple[Indices, int]:
    """One number for each point's cell, in the cells' order, and how many numbers there may be."""
    keys, cells = np.zeros(xyz.shape[1], np.int64), 1
    for row in xyz:
        index = np.floor(row / size)
        index -= index.min()
        length = int(index.max()) + 1
        axis = index.astype(np.int64)
        if cells * length >= 2**62:
            cells, keys = _ranks(keys)
            length, axis = _ranks(axis)
        keys *= length
        keys += axis
        cells *= length
    return keys, cells


def _ranks(values: Indices) -> tuple[int, Indices]:
    different, ranks = np.unique(values, return_inverse=True)
    return len(different), ranks


def _by_table(keys: Indices, cells: int) -> tuple[Indices, Indices]:
    counts = np.bincount(keys, minlength=cells)
    filled = np.flatnonzero(counts)
    number = np.empty(cells, np.intp)
    number[filled] = np.arange(len(filled))
    return number[keys], counts[filled]


def _by_sorting(keys: Indices, bits: int) -> tuple[Indices, Indices]:
    """Key and index share one integer: sorting integers is far quicker than finding the order of the keys."""
    order = sort_keys(keys, bits)
    ordered = keys[order]
    first = np.empty(len(keys), bool)
    first[0], first[1:] = True, ordered[1:] != ordered[:-1]
    labels = np.empty(len(keys), np.intp)
    labels[order] = np.cumsum(first) - 1
    starts = np.flatnonzero(first)
    return labels, np.diff(starts, append=len(keys))


def sort_keys(keys: Indices, bits: int) -> Indices:
    """Order of keys below 2^(63 − bits), of which there are fewer than 2^bits; equal ones in their own order."""
    packed = keys << bits
    packed |= np.arange(len(keys))
    packed.sort()
    packed &= (1 << bits) - 1
    return packed
