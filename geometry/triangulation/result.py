"""What a triangulation answers: the point, whether there is one and why not, and how well the rays fix it."""

import math
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np
import numpy.typing as npt

from ..arrays import Array, Components, Mask, dot, norm, stack
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


_FOUND, _PARALLEL, _BEHIND, _UNDEFINED = map(int, Status)


@dataclass(frozen=True, eq=False)
class Triangulation:
    """The `point` (..., 3) in metres in the world, NaN where there is none; the `status` (...) says why.

    `parallax` (...) is the angle between the lines of sight in radians: the smaller, the less sure the depth.
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
    """Return pairs of pixels as (..., 4), and a mask (...) of the defined ones; the others become zero."""
    left, right = as_array("uv_left", uv_left, 2), as_array("uv_right", uv_right, 2)
    if left.ndim == right.ndim == 1:
        pair = [*left.tolist(), *right.tolist()]
        one = all(abs(v) <= FARTHEST_PIXEL for v in pair)
        return np.array(pair if one else [0.0] * 4), np.asarray(one)
    if left.shape != right.shape:
        left, right = np.broadcast_arrays(left, right)
    pairs = np.concatenate([left, right], axis=-1)
    defined = (np.abs(pairs) <= FARTHEST_PIXEL).all(axis=-1)
    return (pairs if defined.all() else np.where(defined[..., None], pairs, 0.0)), defined


def conclude(
    cameras: tuple[Camera, Camera], point: Components, parallax: Any, ahead: Any, defined: Mask
) -> tuple[Array, npt.NDArray[np.int_], Array]:
    """Return the fields of a Triangulation from a point's components and the parallax of its lines of sight.

    `ahead` is whether the method found it ahead on both rays; its depths are checked here in any case.
    """
    for camera in cameras:
        ahead = ahead & (dot(camera.R[2].tolist(), point) + camera.t.item(2) > 0.0)
    if isinstance(parallax, float):
        return _conclude_one(point, parallax, bool(ahead), bool(defined))
    finite = np.isfinite(point[0] + point[1] + point[2]) & (parallax > PARALLEL)
    found = finite & ahead & defined
    status = np.where(defined, np.where(finite, np.where(ahead, _FOUND, _BEHIND), _PARALLEL), _UNDEFINED)
    parallax = np.where(defined, np.where(finite, parallax, 0.0), np.nan)
    return np.where(found[..., None], stack(*point), np.nan), status, parallax


def _conclude_one(
    point: Components, parallax: float, ahead: bool, defined: bool
) -> tuple[Array, npt.NDArray[np.int_], Array]:
    """As `conclude`, for one pair: a tenth of the time."""
    finite = math.isfinite(sum(point)) and parallax > PARALLEL
    status = _UNDEFINED if not defined else _PARALLEL if not finite else _FOUND if ahead else _BEHIND
    found = np.array(point if status == _FOUND else [math.nan] * 3)
    angle = math.nan if not defined else parallax if finite else 0.0
    return found, np.asarray(status), np.asarray(angle)


def reprojection_errors(
    left: Camera, right: Camera, point: npt.ArrayLike, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike
) -> Array:
    """Return the distances (..., 2) in pixels of points (..., 3) from pixels (..., 2), left and right.

    Between the measured pixel and the one to which the point projects; NaN where it has none.
    """
    measured = ((left, as_array("uv_left", uv_left, 2)), (right, as_array("uv_right", uv_right, 2)))
    return stack(*(norm(camera.project(point)[0] - pixels) for camera, pixels in measured))
