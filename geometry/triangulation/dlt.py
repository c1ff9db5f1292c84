"""The direct linear transformation: the point for which the projection equations, as linear ones, err least."""

import numpy as np
import numpy.typing as npt

from ..arrays import Array
from ..camera import Camera
from ..epipolar import baseline
from .result import Triangulation, conclude, pixel_pairs


def triangulate_dlt(
    left: Camera, right: Camera, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike
) -> Triangulation:
    """Triangulate pixels (..., 2) by the singular vector of the projection equations x (p₃·X) − p₁·X = 0.

    In normalised image coordinates, with P = [R | t] in the world as it is, so that OpenCV's triangulatePoints
    gives the same. What is least isn't an error in pixels, and depends on the choice of the world frame.
    Raises GeometryError at zero baseline.
    Source: Hartley and Zisserman 2004, sec. 12.2.
    """
    between = baseline(left, right)
    pixels_left, pixels_right, defined = pixel_pairs(uv_left, uv_right)
    A = np.concatenate([_equations(left, pixels_left), _equations(right, pixels_right)], axis=-2)
    X = np.linalg.svd(A)[2][..., 3, :]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        points = X[..., :3] / X[..., 3:]
        return Triangulation(*conclude(left, right, between, points, np.asarray(True), defined))


def _equations(camera: Camera, pixels: Array) -> Array:
    P = camera.T_camera_world[:3]
    return camera.normalized(pixels)[..., None] * P[2] - P[:2]
