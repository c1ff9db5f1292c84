"""The nearest points of each point: a k-d tree over points that are kept in the order of a coarse grid.

Points that are near in space are then near in memory, for the tree and for whoever gathers neighbours.
"""

from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from ..arrays import Array
from ..errors import GeometryError
from .points import Indices, as_cloud, columns, measured
from .voxels import cell_keys, sort_keys

_PER_CELL = 64


class Neighbours:
    """Points (N, 3) in an order of their own: `ordered[i]` is `points[order[i]]`."""

    def __init__(self, points: npt.ArrayLike) -> None:
        cloud = as_cloud("points", points)
        self.order = spatial_order(cloud)
        self.ordered = cloud.take(self.order, axis=0)  # three times as quick as cloud[order]

    def __len__(self) -> int:
        return len(self.ordered)

    @cached_property
    def xyz(self) -> Array:
        """The ordered points' columns (3, N)."""
        return columns(self.ordered)

    @cached_property
    def tree(self) -> Any:
        """SciPy's k-d tree of the ordered points."""
        return cKDTree(self.ordered, leafsize=16, balanced_tree=False, compact_nodes=False)

    def nearest(self, rows: slice | Indices, count: int) -> tuple[Array, Indices]:
        """Return distances and places in `ordered`, both (n, count), of the nearest points of some ordered rows.

        The first is the point itself, or one in the same place.
        """
        distances, places = self.tree.query(self.ordered[rows], count)
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
    if len(cloud) < 2:
        return np.arange(len(cloud))
    xyz, low, high = measured(cloud)
    size = float((high - low).max()) / max(1.0, np.sqrt(len(cloud) / _PER_CELL))
    if not size > 0.0:
        return np.arange(len(cloud))
    keys, cells = cell_keys(xyz, low, size, low, high)
    bits = len(keys).bit_length()
    return sort_keys(keys, bits) if cells < 2 ** (63 - bits) else np.argsort(keys, kind="stable")
