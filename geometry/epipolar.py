"""Epipolar geometry of two cameras: the fundamental matrix, p_right^T F p_left = 0, and its lines."""

import numpy as np
import numpy.typing as npt

from . import se3
from .arrays import Array, norm
from .camera import Camera
from .errors import GeometryError, as_array
from .rotations import skew

_NO_BASELINE = 1e-14  # of the centres' distance from the origin: rounding alone sets them that far apart


def baseline(left: Camera, right: Camera) -> Array:
    """Return the vector (3,) from the left camera's centre to the right one's, in the world, in metres.

    Raises GeometryError where the centres coincide: two such views have no epipolar geometry and no depth.
    """
    between = right.center - left.center
    scale = max(np.abs(left.center).max(), np.abs(right.center).max())
    if np.abs(between).max() <= _NO_BASELINE * scale:
        raise GeometryError("right", right.center.tolist(), "a camera whose centre isn't the left one's")
    return between


def essential(left: Camera, right: Camera) -> Array:
    """Return E = [t]ₓ R (3, 3) at unit baseline, where (R, t) is T_right_left; not otherwise normalised.

    Raises GeometryError at zero baseline.
    Source: Hartley and Zisserman 2004, sec. 9.6.
    """
    length = norm(baseline(left, right))
    T_right_left = se3.compose(right.T_camera_world, se3.inverse(left.T_camera_world))
    return skew(T_right_left[:3, 3] / length) @ T_right_left[:3, :3]


def fundamental(left: Camera, right: Camera) -> Array:
    """Return F (3, 3) with p_right^T F p_left = 0 for homogeneous pixels, of Frobenius norm 1.

    The entry of largest magnitude is positive (the first by rows, of several). Raises GeometryError at zero baseline.
    Source: Hartley and Zisserman 2004, eq. 9.12.
    """
    return normalize(right.K_inverse.T @ essential(left, right) @ left.K_inverse)


def normalize(matrix: Array) -> Array:
    """Return a (3, 3) matrix that is defined up to scale at Frobenius norm 1, its largest entry positive."""
    flat = matrix.ravel()
    magnitude = np.abs(flat)
    first = np.argmax(magnitude >= (1.0 - 1e-9) * magnitude.max())  # ties mustn't be decided by rounding
    return np.asarray(matrix * (np.sign(flat[first]) / norm(flat)))


def epipolar_line_right(F: npt.ArrayLike, pixels_left: npt.ArrayLike) -> Array:
    """Return the lines (..., 3) in the right image on which the matches of left pixels (..., 2) lie.

    (a, b, c) with au + bv + c = 0 and a² + b² = 1, so that au + bv + c is the distance in pixels.
    The line of an epipole doesn't exist: NaN.
    Source: Hartley and Zisserman 2004, sec. 9.2.4.
    """
    return _line(as_array("F", F, 3, 3), as_array("pixels_left", pixels_left, 2))


def epipolar_line_left(F: npt.ArrayLike, pixels_right: npt.ArrayLike) -> Array:
    """Return the lines (..., 3) in the left image on which the matches of right pixels (..., 2) lie.

    As `epipolar_line_right`, with F transposed.
    """
    return _line(as_array("F", F, 3, 3).T, as_array("pixels_right", pixels_right, 2))


def _line(F: Array, pixels: Array) -> Array:
    line = se3.to_homogeneous(pixels) @ F.T
    length = norm(line[..., :2])[..., None]
    return np.asarray(line / np.where(length > 0.0, length, np.nan))
