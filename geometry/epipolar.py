"""Epipolar geometry of two cameras: the fundamental matrix, p_right^T F p_left = 0, and its lines."""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from .arrays import Array, Components, components, if_positive, norm, square_root, stack
from .camera import Camera
from .errors import GeometryError, as_array, as_finite_array
from .rotations import skew

_ROUNDING = 1e-14  # what arithmetic alone may leave of what ought to be zero, as part of its terms
_INFINITE = 1e-13  # the same for the third entry of an epipole: 1e13 pixels away


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


def epipoles(F: npt.ArrayLike) -> tuple[Array, Array]:
    """Return the left and the right epipole, homogeneous pixels (3,) of unit norm with F e_left = 0 = F^T e_right.

    Their entry of largest magnitude is positive. An epipole is the other camera's centre, as seen in the image, and
    may be at infinity: then its third entry is zero.
    Raises GeometryError unless F (3, 3) is finite and of rank 2.
    Source: Hartley and Zisserman 2004, sec. 9.2.4.
    """
    F = as_finite_array("F", F, 3, 3)
    rows, columns = _balance(F), _balance(F.T)  # pixels and ones differ a thousandfold: balanced, little is lost
    U, singular, Vt = np.linalg.svd(rows[:, None] * F * columns)
    if not singular[1] > _ROUNDING * singular[0] or singular[2] > 1e-6 * singular[0]:
        raise GeometryError("F", F.tolist(), "a matrix of rank 2")
    return _homogeneous(columns * Vt[2]), _homogeneous(rows * U[:, 2])


def epipole_pixel(epipole: npt.ArrayLike) -> Array:
    """Return a homogeneous pixel (3,) of unit norm as a pixel (2,): NaN where it is at infinity."""
    u, v, w = as_array("epipole", epipole, 3).tolist()
    return np.array([u / w, v / w]) if abs(w) > _INFINITE else np.full(2, math.nan)


def _balance(matrix: Array) -> Array:
    """A factor (3,) for each row, which then has length one; a zero row keeps its own."""
    lengths = norm(matrix)
    return np.asarray(1.0 / np.where(lengths > _ROUNDING * lengths.max(), lengths, 1.0))


def _homogeneous(vector: Array) -> Array:
    tip = np.abs(vector).argmax()
    return np.asarray(vector * (np.sign(vector[tip]) / norm(vector)))


def epipolar_residual(F: npt.ArrayLike, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike) -> Array:
    """Return p_right^T F p_left (...) of pixels (..., 2): zero for matches; its unit depends on the scale of F."""
    _, residual = _constraint(F, uv_left, uv_right)
    return np.asarray(residual)


def sampson_distance(F: npt.ArrayLike, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike) -> Array:
    """Return how far, in pixels (...), pairs of pixels (..., 2) are from satisfying the epipolar constraint.

    The root of the sum of both squared corrections, to first order; OpenCV's sampsonDistance is its square. NaN where
    both pixels are epipoles.
    Source: Hartley and Zisserman 2004, eq. 11.9.
    """
    lines, residual = _constraint(F, uv_left, uv_right)
    gradient = sum(entry * entry for entry, _ in lines)
    rounding = _ROUNDING * sum(terms for _, terms in lines)
    return np.asarray(abs(residual) / if_positive(square_root(gradient) - rounding))


def _constraint(F: npt.ArrayLike, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike) -> tuple[Components, Any]:
    """The first two entries of F p_left and of F^T p_right, each with the size of its terms; and p_right^T F p_left."""
    rows = as_array("F", F, 3, 3)
    (u, v), (x, y) = components(as_array("uv_left", uv_left, 2)), components(as_array("uv_right", uv_right, 2))
    right, left = _products(rows.tolist(), u, v), _products(rows.T.tolist(), x, y)
    return [*right[:2], *left[:2]], x * right[0][0] + y * right[1][0] + right[2][0]


@np.errstate(invalid="ignore")
def _products(rows: list[list[float]], u: Any, v: Any) -> list[tuple[Any, Any]]:
    """A matrix times (u, v, 1), and of each entry the sum of its terms' magnitudes."""
    return [(a * u + b * v + c, abs(a * u) + abs(b * v) + abs(c)) for a, b, c in rows]


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
    (a, a_terms), (b, b_terms), (c, _) = _products(F, *pixel)
    size = a_terms + b_terms
    length = square_root(a * a + b * b)
    length = length + 0.0 * if_positive(length - _ROUNDING * size)  # NaN where nothing but rounding is left
    return stack(a / length, b / length, c / length)
