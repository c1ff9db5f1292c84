"""Surface normals by principal components of each point's nearest neighbours."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..arrays import Array, Mask
from ..errors import GeometryError, as_finite_array, as_number
from .eigen import least_eigenvectors
from .neighbourhoods import covariances
from .neighbours import Neighbours
from .points import Indices, Progress, as_cloud, in_chunks, silent


@dataclass(frozen=True, eq=False)
class Normals:
    """Unit normals (N, 3) of a cloud, and how flat it is round each point.

    `eigenvalues` (N, 3), rising, are variances in m² of the neighbours along their principal directions, the first
    one along the normal. Where the neighbours are on a line, or in one place, there is no normal: NaN, and False
    in `defined` (N,).
    """

    normals: Array
    eigenvalues: Array
    defined: Mask

    @property
    def variation(self) -> Array:
        """Surface variation (N,): 0 on a plane, at most 1/3. Source: Pauly, Gross and Kobbelt 2002, eq. 3."""
        total = self.eigenvalues.sum(axis=1)
        return np.asarray(self.eigenvalues[:, 0] / np.where(total > 0.0, total, 1.0))


def normals(
    points: npt.ArrayLike | Neighbours,
    neighbors: int = 16,
    *,
    sensor: npt.ArrayLike | None = None,
    progress: Progress = silent,
) -> Normals:
    """Estimate the normals of points (N, 3) from their nearest neighbours, themselves included.

    They point to the sensor, one position (3,) or one for each point (N, 3); without one they point up.
    Raises GeometryError if a point isn't finite or there are to be fewer than three neighbours.
    Source: Hoppe et al. 1992, sec. 3.2.
    """
    near = points if isinstance(points, Neighbours) else Neighbours(points)
    count = min(int(as_number("neighbors", neighbors, least=3)), len(near))
    seen_from = None if sensor is None else np.broadcast_to(as_finite_array("sensor", sensor, 3), (len(near), 3))
    found = Normals(np.empty((len(near), 3)), np.empty((len(near), 3)), np.empty(len(near), bool))

    def work(rows: slice) -> None:
        values, vectors, defined = least_eigenvectors(list(covariances(near, rows, count)))
        place = near.order[rows]
        orient(vectors, near.ordered[rows], None if seen_from is None else seen_from[place])
        found.eigenvalues[place], found.normals[place], found.defined[place] = values, vectors, defined

    in_chunks(work, len(near), progress)
    return found


@dataclass(frozen=True, eq=False)
class Neighbourhood:
    """The nearest points of one, and the plane through their mean that they are nearest to.

    `rows` (k,) of the cloud, the nearest first, which is the point itself. `eigenvalues` (3,), rising, are their
    variances in m² along the `axes` (3, 3), by rows, from their mean `center` (3,): the first axis is the plane's
    normal, whichever way.
    """

    rows: Indices
    center: Array
    eigenvalues: Array
    axes: Array

    @property
    def flat(self) -> bool:
        """Whether there is one plane: the points aren't on a line, or in one place."""
        return bool(self.eigenvalues[1] - self.eigenvalues[0] > 1e-12 * self.eigenvalues[2])


def neighbourhood(points: npt.ArrayLike, index: int, neighbors: int = 16) -> Neighbourhood:
    """Look at the nearest points of one of points (N, 3), itself included: what `normals` sums up of each.

    Raises GeometryError if a point isn't finite, there is none of that index, or there are to be no neighbours.
    Source: Hoppe et al. 1992, sec. 3.2.
    """
    cloud = as_cloud("points", points)
    if not 0 <= index < len(cloud):
        raise GeometryError("index", index, f"from 0 to {len(cloud) - 1}")
    count = min(int(as_number("neighbors", neighbors, least=1)), len(cloud))
    offsets = cloud - cloud[index]
    squares = np.vecdot(offsets, offsets)
    squares[index] = -1.0  # before its copies
    rows = np.argpartition(squares, count - 1)[:count]
    rows = rows[np.argsort(squares[rows], kind="stable")]
    mean = offsets[rows].mean(axis=0)
    near = offsets[rows] - mean
    values, vectors = np.linalg.eigh(near.T @ near / count)
    return Neighbourhood(rows, cloud[index] + mean, np.maximum(values, 0.0), vectors.T)


def orient(vectors: Array, points: Array, sensor: npt.ArrayLike | None = None) -> None:
    """Turn normals (N, 3), in place, towards the sensor that saw the points; up without one."""
    if sensor is None:
        away = vectors[:, 2] < 0.0
    else:
        to_sensor = as_finite_array("sensor", sensor, 3) - points
        away = np.vecdot(vectors, to_sensor) < 0.0
    np.negative(vectors, out=vectors, where=away[:, None])
