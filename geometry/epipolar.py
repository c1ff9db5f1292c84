"""Epipolar geometry of two cameras: the fundamental matrix, p_right^T F p_left = 0, and its lines."""

import math

import numpy as np
import numpy.typing as npt

from .arrays import Array, Components, components, if_positive, norm, square_root, stack
from .camera import Camera
from .errors import GeometryError, as_array
from .rotations import skew

_ROUNDING = 1e-14  # what arithmetic alone may leave of what ought to be zero, as part of its terms


def baseline(left: Camera, right: Camera) -> Array:
    """Return the vector (3,) from the left camera's centre to the right one's, in the world, in metres.

    Raises GeometryError where the centres coincide: two such views have no epipolar geometry and no depth.
    """
    start, end = left.center, right.center
    between = end - start
    if math.hypot(*between.tolist()) <= _ROUNDING * math.hypot(*start.tolist(), *end.tolist()):
        raise GeometryError("right", end.tolist(), "a camera whose centre isn't the left one's")
    return between


def essential(left: Camera, right: Camera) -> Array:
    """Return E = [t]ₓ R (3, 3) for a baseline of one, where (R, t) is T_right_left.

    Raises GeometryError at zero baseline.
    Source: Hartley and Zisserman 2004, sec. 9.6.
    """
    between = baseline(left, right)
    t = right.R.dot(between / -math.hypot(*between.tolist()))
    return np.asarray(skew(t).dot(right.R.dot(left.R.T)))


def fundamental(left: Camera, right: Camera) -> Array:
    """Return F (3, 3) with p_right^T F p_left = 0 for homogeneous pixels, of Frobenius norm 1.

    Its entry of largest magnitude is positive: of several, the first by rows.
    Raises GeometryError at zero baseline.
    Source: Hartley and Zisserman 2004, sec. 9.2.2.
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

    (a, b, c) with a u + b v + c = 0 and a² + b² = 1, so that a u + b v + c is a distance in pixels.
    An epipole has no line: NaN.
    Source: Hartley and Zisserman 2004, sec. 9.2.
    """
    return _lines(as_array("F", F, 3, 3).tolist(), components(as_array("pixels_left", pixels_left, 2)))


def epipolar_line_left(F: npt.ArrayLike, pixels_right: npt.ArrayLike) -> Array:
    """Return the lines (..., 3) in the left image on which the matches of right pixels (..., 2) lie.

    Everything else is as in `epipolar_line_right`.
    """
    return _lines(as_array("F", F, 3, 3).T.tolist(), components(as_array("pixels_right", pixels_right, 2)))


@np.errstate(invalid="ignore")
def _lines(F: list[list[float]], pixel: Components) -> Array:
    u, v = pixel
    a, b, c = (row[0] * u + row[1] * v + row[2] for row in F)
    size = sum(abs(row[0] * u) + abs(row[1] * v) + abs(row[2]) for row in F[:2])
    length = square_root(a * a + b * b)
    length = length + 0.0 * if_positive(length - _ROUNDING * size)  # NaN where nothing but rounding is left
    return stack(a / length, b / length, c / length)
