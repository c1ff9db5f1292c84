"""The direct linear transformation: the point for which the projection equations, made linear, err least."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ..arrays import Array, Components, components, cross, dot, square_root, stack
from ..camera import Camera
from ..epipolar import baseline
from .result import Triangulation, conclude, pixel_pairs


def triangulate_dlt(left: Camera, right: Camera, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike) -> Triangulation:
    """Triangulate pixels (..., 2) by the least singular vector of the equations of `dlt_equations`.

    The same as triangulatePoints of OpenCV. What is least there isn't an error in pixels, and changes with the choice
    of the world frame.
    Raises GeometryError at zero baseline.
    Source: Hartley and Zisserman 2004, sec. 12.2.
    """
    between = baseline(left, right)
    pairs, defined = pixel_pairs(uv_left, uv_right)
    with np.errstate(all="ignore"):
        X = np.linalg.svd(_matrix(left, right, pairs))[2][..., 3, :]
        point = components(X[..., :3] / X[..., 3:])
        parallax = _parallax(left.center.tolist(), between.tolist(), point)
        return Triangulation(*conclude((left, right), point, parallax, True, defined))


def dlt_equations(left: Camera, right: Camera, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike) -> Array:
    """Return A (..., 4, 4) of the equations A X = 0 of a point X, homogeneous in the world, from pixels (..., 2).

    Two rows for the left pixel, then two for the right: x (p₃·X) − p₁·X and y (p₃·X) − p₂·X, in normalised image
    coordinates and with P = [R | t]. NaN for pixels that aren't defined.
    Source: Hartley and Zisserman 2004, sec. 12.2.
    """
    pairs, defined = pixel_pairs(uv_left, uv_right)
    return np.where(defined[..., None, None], _matrix(left, right, pairs), np.nan)


def _matrix(left: Camera, right: Camera, pairs: Array) -> Array:
    rows = [*_equations(left, pairs[..., :2]), *_equations(right, pairs[..., 2:])]
    return stack(*rows).reshape(*pairs.shape[:-1], 4, 4)


def _equations(camera: Camera, pixels: Array) -> list[Any]:
    """Return the eight entries, by rows, of the two equations of a camera."""
    x, y = components(camera.normalized(pixels))
    p1, p2, p3, _ = camera.T_camera_world.tolist()
    return [z * c - a for z, row in ((x, p1), (y, p2)) for a, c in zip(row, p3, strict=True)]


def _parallax(center: Components, between: Components, point: Components) -> Any:
    sight = [x - c for x, c in zip(point, center, strict=True)]
    # Crossed with the other line of sight, that of a distant point would lose its parallax to rounding.
    normal = cross(sight, between)
    return np.arctan2(square_root(dot(normal, normal)), dot(sight, sight) - dot(sight, between))
