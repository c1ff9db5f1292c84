"""What a triangulation answers: the point, whether there is one and why not, and how well the rays determine it."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from ..arrays import Array, Mask, cross, dot, norm
from ..camera import Camera
from ..errors import as_array

PARALLEL = 1e-12  # radians; rounding alone turns rays by more than a thousandth of it
FARTHEST_PIXEL = 1e9


class Status(IntEnum):
    """Why there is a point, or none."""

    FOUND = 0
    PARALLEL = 1  # the rays meet at infinity
    BEHIND = 2  # the lines of sight meet behind a camera
    UNDEFINED = 3  # a pixel isn't finite, or is beyond 1e9


@dataclass(frozen=True, eq=False)
class Triangulation:
    """Triangulated points: `point` (..., 3) in metres in the world, NaN where there is none, and `status` (...) says why.

    `parallax` (...) is the angle in radians between the rays at the point: the smaller, the less sure the depth.
    """

    point: Array
    status: npt.NDArray[np.int_]
    parallax: Array

    @property
    def valid(self) -> Mask:
        """Whether there is a point, (...)."""
        return np.asarray(self.status == Status.FOUND)

    @property
    def in_front(self) -> Mask:
        """Whether the rays meet in front of both cameras, (...), be it at infinity."""
        return np.asarray((self.status == Status.FOUND) | (self.status == Status.PARALLEL))


def pixel_pairs(uv_left: npt.ArrayLike, uv_right: npt.ArrayLike) -> tuple[Array, Array, Mask]:
    """Return pixels (..., 2) of equal shape, and which pairs are defined, (...); the others are set to zero."""
    left, right = np.broadcast_arrays(as_array("uv_left", uv_left, 2), as_array("uv_right", uv_right, 2))
    defined = ((np.abs(left) <= FARTHEST_PIXEL) & (np.abs(right) <= FARTHEST_PIXEL)).all(axis=-1)
    if defined.all():
        return left, right, defined
    return np.where(defined[..., None], left, 0.0), np.where(defined[..., None], right, 0.0), defined


def conclude(
    left: Camera, right: Camera, between: Array, points: Array, ahead: Mask, defined: Mask
) -> tuple[Array, npt.NDArray[np.int_], Array]:
    """Return the fields of a Triangulation from points (..., 3), infinite or NaN where the rays are parallel.

    `ahead` (...) is what the method itself knows of being in front; `defined` (...) is from `pixel_pairs`.
    """
    finite = np.isfinite(points).all(axis=-1)
    sight = np.where(finite[..., None], points, 0.0) - left.center
    # The cross product with the other line of sight would lose the parallax of distant points.
    parallax = np.arctan2(norm(cross(sight, between)), dot(sight, sight - between))
    infinite = ~finite | (parallax <= PARALLEL)
    depths = [points @ camera.R[2] + camera.t[2] for camera in (left, right)]
    ahead = ahead & (depths[0] > 0.0) & (depths[1] > 0.0)
    status = np.where(infinite, Status.PARALLEL, np.where(ahead, Status.FOUND, Status.BEHIND))
    status = np.where(defined, status, Status.UNDEFINED)
    point = np.where((status == Status.FOUND)[..., None], points, np.nan)
    return point, status, np.where(defined, np.where(finite, parallax, 0.0), np.nan)


def reprojection_errors(
    left: Camera, right: Camera, point: npt.ArrayLike, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike
) -> Array:
    """Return the distances (..., 2) in pixels from where points (..., 3) project to where they were measured.

    Left, then right; NaN where a point has no pixel.
    """
    errors = [left.project(point)[0] - uv_left, right.project(point)[0] - uv_right]
    return np.stack([norm(error) for error in errors], axis=-1)
