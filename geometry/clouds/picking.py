"""Picking: the point of a cloud that a ray points at."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..arrays import Array, norm
from ..errors import GeometryError, as_array, as_finite_array, as_number
from .points import Indices

_ROWS = 16384  # at once, so that they stay in the cache, and their memory is used again
_DEPTH = 4.0
"""Cone widths behind the nearest point, up to which points count as the same surface."""


@dataclass(frozen=True)
class Pick:
    """A point's index, its distance along the ray and its distance from the ray, in metres."""

    index: int
    along: float
    off: float


def pick(points: npt.ArrayLike, origin: npt.ArrayLike, direction: npt.ArrayLike, *, cone: float = 0.01) -> Pick | None:
    """Return the point (of N, 3) that a ray from `origin` (3,) along `direction` (3,) points at, or None.

    Only points in front count whose distance from the ray is at most `cone` times their distance along it. Of
    these the nearest surface counts, so that nothing is picked through a gap between points, and on it the point
    whose direction is nearest to the ray's.
    A point that isn't finite is never picked.
    Raises GeometryError if the direction is zero or isn't finite, or the origin isn't.
    """
    cloud, start = as_array("points", points, 3), as_finite_array("origin", origin, 3)
    ray, cone = as_finite_array("direction", direction, 3), as_number("cone", cone, above=0.0)
    length = float(norm(ray))
    if length == 0.0 or cloud.ndim != 2:
        wrong = ("direction", direction, "a vector with a direction")
        raise GeometryError(*(wrong if cloud.ndim == 2 else ("points", cloud, "shape (N, 3)")))
    frame = _frame(ray / length)
    found = [_inside(cloud, rows, frame, start, cone) for rows in range(0, len(cloud), _ROWS)]
    if not any(len(index) for index, _, _ in found):
        return None
    index, along, off = (np.concatenate(part) for part in zip(*found, strict=True))
    front = along <= along.min() * (1.0 + _DEPTH * cone)
    best = int(np.argmin(np.where(front, off / along**2, np.inf)))
    return Pick(int(index[best]), float(along[best]), float(np.sqrt(off[best])))


@np.errstate(invalid="ignore", over="ignore")
def _inside(cloud: Array, first: int, frame: Array, start: Array, cone: float) -> tuple[Indices, Array, Array]:
    """Those of some rows that are in the cone, how far along the ray, and the square of how far from it."""
    across = frame @ cloud[first : first + _ROWS].T
    across -= (frame @ start)[:, None]
    along, right, off = across
    off *= off
    right *= right
    off += right
    inside = np.flatnonzero((along > 0.0) & (off <= (cone * along) ** 2))
    return inside + first, along[inside], off[inside]


def _frame(ray: Array) -> Array:
    """The ray's direction and two across it, as rows."""
    least = np.zeros(3)
    least[np.argmin(np.abs(ray))] = 1.0
    right = np.cross(ray, least)
    right /= norm(right)
    return np.stack([ray, right, np.cross(ray, right)])
