"""Outliers: points that are farther from their neighbours than is usual in the cloud."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..arrays import Array, Mask
from ..errors import as_number
from .neighbours import Neighbours
from .points import Progress, in_chunks, silent


@dataclass(frozen=True, eq=False)
class Outliers:
    """Which points (N,) are kept, each one's mean distance to its neighbours (N,), and the most that is allowed."""

    keep: Mask
    distance: Array
    threshold: float


def outliers(
    points: npt.ArrayLike | Neighbours, neighbors: int = 16, deviations: float = 2.0, *, progress: Progress = silent
) -> Outliers:
    """Find the points (N, 3) whose mean distance to their nearest neighbours is unusual.

    The most allowed is the mean over the cloud plus a number of standard deviations. Of `neighbors` nearest points the
    first is the point itself, as in Open3D, but its distance of zero isn't in the mean: of 16 the other 15 are.
    Which points are kept is the same. A point alone isn't an outlier.
    Raises GeometryError if a point isn't finite, or there are to be fewer than two neighbours.
    Source: Rusu et al. 2008, "Towards 3D point cloud based object maps", sec. 4.1.
    """
    near = points if isinstance(points, Neighbours) else Neighbours(points)
    count = min(int(as_number("neighbors", neighbors, least=2)), len(near))
    allowed = as_number("deviations", deviations, least=0.0)
    ordered = np.empty(len(near))

    def work(rows: slice) -> None:
        ordered[rows] = near.nearest(rows, count)[0].sum(axis=1) / max(count - 1, 1)

    in_chunks(work, len(near), progress)
    distance = near.unordered(ordered)
    spread = float(distance.std(ddof=1)) if len(near) > 1 else 0.0
    threshold = float(distance.mean()) + allowed * spread if len(near) else 0.0
    # points at equal distances have no outliers, whatever the mean's last digit is
    return Outliers(distance <= threshold * (1.0 + 1e-12), distance, threshold)
