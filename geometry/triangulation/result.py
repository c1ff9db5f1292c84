"""What a triangulation answers: the point, whether there is one and why not, and how well the rays fix it."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from ..arrays import Array, Components, Mask, cross, dot, norm, stack
from ..camera import Camera
from ..errors import as_array

PARALLEL = 1e-12  # radians; rounding alone turns a ray by a thousandth of it
FARTHEST_PIXEL = 1e9


class Status(IntEnum):
    """Why there is a point, or none."""

    FOUND = 0
    PARALLEL = 1  # the rays meet at infinity
    BEHIND = 2  # the lines of sight meet behind a camera
    UNDEFINED = 3  # a pixel isn't finite, or is beyond 1e9


@dataclass(frozen=True, eq=False)
class Triangulation:
    """The `point` (..., 3) in metres in the world, NaN where there is none; the `status` (...) says why.

    `parallax` (...) is the angle in radians at which the lines of sight meet: the smaller, the less sure the depth.
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


def pixel_pairs(uv_left: npt.ArrayLike, uv_right: npt.ArrayLike) -> tuple[Array, Mask]:
    """Return pairs of pixels as (..., 4), and a mask (...) of the defined ones; the others are set to zero."""
    left, right = as_array("uv_left", uv_left, 2), as_array("uv_right", uv_right, 2)
    if left.shape != right.shape:
        left, right = np.broadcast_arrays(left, right)
    pairs = np.concatenate([left, right], axis=-1)
    defined = (np.abs(pairs) <= FARTHEST_PIXEL).all(axis=-1)
    return (pairs if defined.all() else np.where(defined[..., None], pairs, 0.0)), defined


def conclude(
    cameras: tuple[Camera, Camera], between: Array, point: Components, ahead: Mask | bool, defined: Mask
) -> tuple[Array, npt.NDArray[np.int_], Array]:
    """Return the fields of a Triangulation from a point's components, not finite where the rays are parallel.

    `between` (3,) is the baseline, `ahead` (...) what the method itself knows of being in front.
    """
    sight = [x - c for x, c in zip(point, cameras[0].center.tolist(), strict=True)]
    base = between.tolist()
    # Crossed with the baseline: crossed with the other line of sight, a distant point would lose its parallax.
    sine, cosine = dot(*(2 * (cross(sight, base),))) ** 0.5, dot(sight, sight) - dot(sight, base)
    parallax = np.arctan2(sine, cosine)
    finite = np.isfinite(point[0] + point[1] + point[2]) & (parallax > PARALLEL)
    for camera in cameras:
        ahead = ahead & (dot(camera.R[2].tolist(), point) + float(camera.t[2]) > 0.0)
    status = np.where(finite, np.where(ahead, Status.FOUND, Status.BEHIND), Status.PARALLEL)
    status = np.where(defined, status, Status.UNDEFINED)
    found = (status == Status.FOUND)[..., None]
    return (
        np.where(found, stack(*point), np.nan),
        status,
        np.where(defined, np.where(finite, parallax, 0.0), np.nan),
    )


def reprojection_errors(
    left: Camera, right: Camera, point: npt.ArrayLike, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike
) -> Array:
    """Return the distances (..., 2) in pixels, left and right, from points (..., 3) to their measured pixels (..., 2).

    NaN where a point has no pixel.
    """
    measured = ((left, as_array("uv_left", uv_left, 2)), (right, as_array("uv_right", uv_right, 2)))
    return stack(*(norm(camera.project(point)[0] - pixels) for camera, pixels in measured))
