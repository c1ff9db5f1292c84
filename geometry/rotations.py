"""Rotation matrices: about a coordinate axis, about any axis, their angle, and the test of what is one."""

import math

import numpy as np
import numpy.typing as npt

from .arrays import Array, Mask, Matrix3, components, cos_sin, cross, each, norm, stack_matrix
from .errors import GeometryError, as_angle, as_array, as_finite_array

AXES = ("x", "y", "z")
SMALLEST = 1e-300  # next to zero, where floats lose their precision
SMALLEST_SINE = 1e-9  # of the angle between directions that have an axis across both
TOLERANCE = 1e-6  # what rotations read from float32 or from printed matrices still meet

_NEXT = {"x": (0, 1, 2), "y": (1, 2, 0), "z": (2, 0, 1)}


def axis_rotation(axis: str, angle: float | Array) -> Array:
    """Return the rotation about a coordinate axis.

    axis is "x", "y" or "z"; angle (...) in radians, right-handed. Result (..., 3, 3).
    Raises GeometryError for another axis or an angle that isn't finite; such an angle in a batch gives NaN.
    Source: Siciliano et al. 2009, "Robotics", sec. 2.2.1.
    """
    if axis not in _NEXT:
        raise GeometryError("axis", axis, ", ".join(AXES))
    i, j, k = _NEXT[axis]
    angle = as_angle("angle", angle)
    cos, sin = cos_sin(angle)
    R = np.zeros((3, 3) if isinstance(angle, float) else (3, 3, *angle.shape))
    R[i, i] = 1.0
    R[j, j] = R[k, k] = cos
    R[k, j] = sin
    R[j, k] = -sin
    if R.ndim == 2:
        return R
    R[:, :, np.isnan(cos)] = np.nan
    return np.moveaxis(R, (0, 1), (-2, -1))


def orbit(axis: npt.ArrayLike, point: npt.ArrayLike, angles: npt.ArrayLike) -> Array:
    """Return where a point (3,) comes when it is turned about an axis (3,) by angles (n,) in radians: (n, 3).

    The axis has any length but zero, for which GeometryError is raised.
    Source: Rodrigues' formula.
    """
    n, p = as_finite_array("axis", unit(as_array("axis", axis, 3), "axis")), as_finite_array("point", point, 3)
    turned = as_finite_array("angles", angles)[..., None]
    along = n * n.dot(p)
    return np.asarray(along + np.cos(turned) * (p - along) + np.sin(turned) * np.array(cross(n.tolist(), p.tolist())))


def skew(vector: npt.ArrayLike) -> Array:
    """Return the matrix (..., 3, 3) of the cross product with (..., 3): ``skew(a) @ b`` is a × b."""
    x, y, z = components(as_array("vector", vector, 3))
    return stack_matrix(0.0, -z, y, z, 0.0, -x, -y, x, 0.0)


def unit(vector: npt.ArrayLike, argument: str = "vector") -> Array:
    """Return vectors (..., n) at length one; a zero one raises GeometryError, in a batch it gives NaN."""
    v = as_array(argument, vector)
    if v.ndim == 1:
        length = math.hypot(*v.tolist())
        if not SMALLEST < length < math.inf:
            raise GeometryError(argument, v.tolist(), "a finite vector that isn't zero")
        return v / length
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        scale = np.abs(v).max(axis=-1, keepdims=True)
        scaled = v / np.where(scale > SMALLEST, scale, np.nan)
        return scaled / norm(scaled)[..., None]


def axis_angle_to_matrix(axis: npt.ArrayLike, angle: float | Array) -> Array:
    """Return the rotation about an axis by an angle.

    axis (..., 3) of any length but zero; angle (...) in radians, right-handed. Result (..., 3, 3).
    Raises GeometryError for a zero axis or an angle that isn't finite; in a batch they give NaN.
    Source: Rodrigues' formula, Murray, Li and Sastry 1994, eq. 2.14.
    """
    x, y, z = components(unit(as_array("axis", axis, 3), "axis"))
    angle = as_angle("angle", angle)
    cos, sin = cos_sin(angle)
    half = cos_sin(0.5 * angle)[1]
    versine = 2.0 * half * half  # 1 - cos without its cancellation at small angles
    xy, yz, zx = versine * x * y, versine * y * z, versine * z * x
    return stack_matrix(
        *(cos + versine * x * x, xy - sin * z, zx + sin * y),
        *(xy + sin * z, cos + versine * y * y, yz - sin * x),
        *(zx - sin * y, yz + sin * x, cos + versine * z * z),
    )


def shortest_turn(start: npt.ArrayLike, end: npt.ArrayLike) -> Array:
    """The rotation by the smallest angle that takes one direction to another: (3,), (3,), of any length but zero.

    Opposite directions have no such turn, for any axis across them would do: those stay where they are. Raises
    GeometryError for a zero vector.
    """
    first, last = unit(start, "start"), unit(end, "end")
    axis = np.cross(first, last)
    sine = math.sqrt(axis @ axis)
    if sine < SMALLEST_SINE:
        return np.eye(3)
    return axis_angle_to_matrix(axis / sine, math.atan2(sine, float(first @ last)))


def matrix_to_axis_angle(R: npt.ArrayLike) -> tuple[Array, Array]:
    """Return the unit axis (..., 3) and the angle (...) in [0, π] radians of rotations (..., 3, 3).

    Accurate at every angle. The identity has the axis z; a half turn, the axis whose first component that
    isn't zero is positive. Raises GeometryError if R isn't a rotation; in a batch it gives NaN.
    Source: Murray, Li and Sastry 1994, eqs. 2.17 and 2.18; beyond π/2 the axis is from the symmetric part,
    (R + Rᵀ)/2 = cos θ I + (1 − cos θ) nnᵀ.
    """
    found = each(_axis_angle, as_rotation("R", R), core=2, width=4)
    return found[..., :3], found[..., 3]


def _axis_angle(r: Matrix3) -> tuple[float, ...]:
    vee = (r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1])
    sine, cosine = 0.5 * math.hypot(*vee), 0.5 * (r[0][0] + r[1][1] + r[2][2] - 1.0)
    angle = math.atan2(sine, cosine)
    if sine <= SMALLEST and cosine > 0.0:
        return 0.0, 0.0, 1.0, angle
    if cosine >= 0.0 or math.isnan(cosine):
        return *(component / (2.0 * sine) for component in vee), angle
    i = max(range(3), key=lambda m: r[m][m])
    axis = [0.5 * (r[i][m] + r[m][i]) - (cosine if m == i else 0.0) for m in range(3)]
    along = sum(a * b for a, b in zip(axis, vee, strict=True)) or next(a for a in axis if a != 0.0)
    length = math.copysign(math.hypot(*axis), along)
    return *(component / length for component in axis), angle


def rotation_angle(R: npt.ArrayLike) -> Array:
    """Return the angle (...) in [0, π] radians of rotations (..., 3, 3), accurate near 0 and near π.

    ``rotation_angle(A.T @ B)`` is the distance between two rotations.
    Raises GeometryError if R isn't a rotation; in a batch it gives NaN.
    """
    return matrix_to_axis_angle(R)[1]


def is_rotation(R: npt.ArrayLike, tolerance: float = TOLERANCE) -> Mask:
    """Return a mask (...) of the matrices (..., 3, 3) that are rotations, each entry within the tolerance."""
    matrices = as_array("R", R, 3, 3)
    return each(lambda r: (_is_rotation(r, tolerance),), matrices, core=2, width=1)[..., 0].astype(bool)


def _is_rotation(r: Matrix3, tolerance: float = TOLERANCE) -> bool:
    (a, b, c), (d, e, f), (g, h, i) = r
    return (
        abs(a * a + b * b + c * c - 1.0) <= tolerance
        and abs(d * d + e * e + f * f - 1.0) <= tolerance
        and abs(a * d + b * e + c * f) <= tolerance
        and abs(b * f - c * e - g) <= tolerance
        and abs(c * d - a * f - h) <= tolerance
        and abs(a * e - b * d - i) <= tolerance
    )


def as_rotation(argument: str, value: npt.ArrayLike) -> Array:
    """Return rotations (..., 3, 3): one that isn't raises GeometryError, in a batch it becomes NaN."""
    R = as_array(argument, value, 3, 3)
    if R.ndim == 2:
        if not _is_rotation(R.tolist()):
            raise GeometryError(argument, R.tolist(), "a rotation: RᵀR = I and det R = 1")
        return R
    return np.where(is_rotation(R)[..., None, None], R, np.nan)


def nearest_rotation(M: npt.ArrayLike) -> Array:
    """Return the rotation nearest to one matrix (3, 3) in the Frobenius norm.

    Raises GeometryError where several are equally near: the two smaller singular values cancel.
    Source: Higham 1989, "Matrix nearness problems and applications"; the sign as in Umeyama 1991.
    """
    matrix = as_finite_array("M", M, 3, 3)
    U, sigma, Vt = np.linalg.svd(matrix)
    sign = np.sign(np.linalg.det(U) * np.linalg.det(Vt))
    if sigma.ndim != 1 or sigma[1] + sign * sigma[2] <= 1e-12 * sigma[0]:
        raise GeometryError("M", matrix.tolist(), "one matrix with a single nearest rotation")
    return np.asarray((U * [1.0, 1.0, sign]) @ Vt)
