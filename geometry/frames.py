"""Conventions for coordinate axes, their handedness, and how one point reads in each of them.

A basis is a matrix whose columns are the axes x, y and z in the world: X right, Y forward, Z up.
"""

import math

import numpy as np
import numpy.typing as npt

from .arrays import Array, Mask
from .errors import GeometryError, as_array, as_choice, as_finite_array
from .rotations import TOLERANCE, unit
from .se3 import from_homogeneous

DIRECTIONS = {
    "right": (1.0, 0.0, 0.0),
    "left": (-1.0, 0.0, 0.0),
    "forward": (0.0, 1.0, 0.0),
    "back": (0.0, -1.0, 0.0),
    "up": (0.0, 0.0, 1.0),
    "down": (0.0, 0.0, -1.0),
}
CONVENTIONS = {
    "opengl": ("right", "up", "back"),
    "directx": ("right", "up", "forward"),
    "ros": ("forward", "left", "up"),
    "camera": ("right", "down", "forward"),
    "aviation": ("forward", "right", "down"),
    "enu": ("right", "forward", "up"),
    "unreal": ("forward", "right", "up"),
}
HANDEDNESS = ("right", "left")

_FLAT = 1e-12  # |det| for axes of length one: rounding alone gives coplanar axes that much
_OPPOSITE = {"right": "left", "forward": "back", "up": "down"}
_OPPOSITE |= {there: here for here, there in _OPPOSITE.items()}


def axis_directions(convention: str, handed: str | None = None) -> tuple[str, str, str]:
    """Return where x, y and z of a convention point: "right", "left", "forward", "back", "up" or "down".

    handed is "right" or "left", or None for the convention's own; in the other one z is the opposite.
    Raises GeometryError for an unknown convention or handedness.
    """
    x, y, z = CONVENTIONS[as_choice("convention", convention, tuple(CONVENTIONS))]
    if handed is None or as_choice("handed", handed, HANDEDNESS) == handedness(_columns(x, y, z)):
        return x, y, z
    return x, y, _OPPOSITE[z]


def basis(convention: str, handed: str | None = None) -> Array:
    """Return the axes (3, 3) of a convention as columns in the world: exact, of entries 0 and ±1.

    handed is "right" or "left", or None for the convention's own; the other one mirrors z.
    Raises GeometryError for an unknown convention or handedness.
    """
    return _columns(*axis_directions(convention, handed))


def _columns(*directions: str) -> Array:
    return np.array(list(zip(*(DIRECTIONS[direction] for direction in directions), strict=True)))


def handedness(axes: npt.ArrayLike) -> str:
    """Return "right" or "left": the sign of the determinant of axes (3, 3) in columns.

    They needn't be perpendicular or of length one.
    Raises GeometryError if they lie in one plane, and have no handedness.
    """
    matrix = as_finite_array("axes", axes, 3, 3)
    if matrix.ndim != 2:
        raise GeometryError("axes", f"an array of shape {matrix.shape}", "one matrix, of shape (3, 3)")
    (a, b, c), (d, e, f), (g, h, i) = matrix.tolist()
    determinant = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    if abs(determinant) <= _FLAT * math.hypot(a, d, g) * math.hypot(b, e, h) * math.hypot(c, f, i):
        raise GeometryError("axes", matrix.tolist(), "three axes that don't lie in one plane")
    return "right" if determinant > 0.0 else "left"


def change_of_basis(
    basis_from: npt.ArrayLike, basis_to: npt.ArrayLike, origin: npt.ArrayLike = (0.0, 0.0, 0.0)
) -> Array:
    """Return the matrices (..., 4, 4) that take coordinates in one basis (..., 3, 3) to those in another.

    origin (..., 3) is where the other frame begins, in coordinates of the first; by default they begin together.
    The determinant is 1, a rigid motion, between bases of one handedness and −1, improper, between others.
    Raises GeometryError if a basis isn't three perpendicular axes of length one; in a batch it gives NaN.
    Source: M = basis_to⁻¹ basis_from, the inverse by the transpose; a point p becomes M (p − origin).
    """
    source, target = _orthonormal("basis_from", basis_from), _orthonormal("basis_to", basis_to)
    o = as_array("origin", origin, 3)
    M = target.swapaxes(-1, -2) @ source + 0.0  # no −0
    T = np.zeros((*np.broadcast_shapes(M.shape[:-2], o.shape[:-1]), 4, 4))
    T[..., :3, :3] = M
    T[..., :3, 3] = 0.0 - np.matvec(M, o)
    T[..., 3, 3] = 1.0
    return T


def coordinates(points_world: npt.ArrayLike, axes: npt.ArrayLike) -> Array:
    """Return the coordinates (..., 3), in a basis (..., 3, 3), of points (..., 3) given in the world.

    The batch dimensions broadcast: one point and seven bases give its seven readings. The inverse of `to_world`.
    Raises GeometryError if the basis isn't three perpendicular axes of length one; in a batch it gives NaN.
    """
    return np.asarray(np.vecmat(as_array("points_world", points_world, 3), _orthonormal("axes", axes)) + 0.0)


def to_world(points: npt.ArrayLike, axes: npt.ArrayLike) -> Array:
    """Return points (..., 3), whose coordinates are given in a basis (..., 3, 3), in the world.

    Everything else is as in `coordinates`.
    """
    return np.asarray(np.matvec(_orthonormal("axes", axes), as_array("points", points, 3)) + 0.0)


def _orthonormal(argument: str, value: npt.ArrayLike) -> Array:
    axes = as_array(argument, value, 3, 3)
    with np.errstate(invalid="ignore", over="ignore"):
        error = np.abs(axes.swapaxes(-1, -2) @ axes - np.eye(3))
    sound: Mask = np.asarray((error <= TOLERANCE).all(axis=(-2, -1)))
    if axes.ndim == 2 and not sound:
        raise GeometryError(argument, axes.tolist(), "perpendicular axes of length one, in columns")
    return axes if sound.all() else np.where(sound[..., None, None], axes, np.nan)


def point_or_direction(points: npt.ArrayLike) -> tuple[Array, Mask]:
    """Return what homogeneous points (..., 4) are, (..., 3), and a mask (...) of the finite ones.

    (x, y, z, w) is the point (x, y, z) / w. At w = 0, or where that quotient is too large for a float, it is at
    infinity, and False: its row is then the unit direction in which it lies.
    Raises GeometryError for (0, 0, 0, 0) or numbers that aren't finite; in a batch they give NaN and False.
    Source: Hartley and Zisserman 2004, sec. 3.1.
    """
    homogeneous = as_array("points", points, 4)
    if homogeneous.ndim == 1 and not (np.isfinite(homogeneous).all() and homogeneous.any()):
        raise GeometryError("points", homogeneous.tolist(), "finite numbers, not all of them zero")
    cartesian, finite = from_homogeneous(homogeneous)
    if finite.all():
        return cartesian, finite
    if homogeneous.ndim == 1:
        toward = np.copysign(1.0, homogeneous[3]) if homogeneous[3] else 1.0
        return unit(homogeneous[:3]) * toward, finite
    w = homogeneous[..., 3:]
    toward = np.where(np.isfinite(homogeneous).all(axis=-1, keepdims=True), np.where(w < 0.0, -1.0, 1.0), np.nan)
    return np.where(finite[..., None], cartesian, toward * unit(homogeneous[..., :3])), finite
