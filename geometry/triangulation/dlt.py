"""The direct linear transformation: the point for which the projection equations, made linear, err least."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ..arrays import Array, Components, components, cross, dot, square_root, stack
from ..camera import Camera
from ..epipolar import baseline
from .result import Triangulation, conclude, pixel_pairs


def triangulate_dlt(left: Camera, right: Camera, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike) -> Triangulation:
    """Triangulate pixels (..., 2) by the least singular vector of the equations x (p₃·X) − p₁·X = 0.

    In normalised image coordinates, with P = [R | t] in the world as it is: the same as triangulatePoints of
    OpenCV. What is least there isn't an error in pixels, and changes with the choice of the world frame.
    Raises GeometryError at zero baseline.
    Source: Hartley and Zisserman 2004, sec. 12.2.
    """
    between = baseline(left, right)
    pairs, defined = pixel_pairs(uv_left, uv_right)
    with np.errstate(all="ignore"):
        rows = [*_equations(left, pairs[..., :2]), *_equations(right, pairs[..., 2:])]
        X = np.linalg.svd(stack(*rows).reshape(*defined.shape, 4, 4))[2][..., 3, :]
        point = components(X[..., :3] / X[..., 3:])
        parallax = _parallax(left.center.tolist(), between.tolist(), point)
        return Triangulation(*conclude((left, right), point, parallax, True, defined))


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
