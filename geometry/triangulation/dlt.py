"""The direct linear transformation: the point for which the projection equations, made linear, err least."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ..arrays import Components, components, cross, dot, square_root
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
    pixels = np.concatenate([left.normalized(pairs[..., :2]), right.normalized(pairs[..., 2:])], axis=-1)
    P = np.stack([left.T_camera_world, right.T_camera_world])
    equations = pixels[..., None] * P[[0, 0, 1, 1], 2] - P[:, :2].reshape(4, 4)
    X = np.linalg.svd(equations)[2][..., 3, :]
    with np.errstate(all="ignore"):
        point = components(X[..., :3] / X[..., 3:])
        parallax = _parallax(left.center.tolist(), between.tolist(), point)
        return Triangulation(*conclude((left, right), point, parallax, True, defined))


def _parallax(center: Components, between: Components, point: Components) -> Any:
    sight = [x - c for x, c in zip(point, center, strict=True)]
    # Crossed with the other line of sight, that of a distant point would lose its parallax to rounding.
    normal = cross(sight, between)
    return np.arctan2(square_root(dot(normal, normal)), dot(sight, sight) - dot(sight, between))
