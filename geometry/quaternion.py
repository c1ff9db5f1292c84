"""Hamilton's quaternions (w, x, y, z). Any but zero stands for a rotation: its length has no effect."""

import math

import numpy as np
import numpy.typing as npt

from .arrays import Array, Matrix3, components, cos_sin, each, stack, stack_matrix
from .errors import GeometryError, as_angle, as_array, as_number
from .rotations import AXES, SMALLEST, as_rotation, unit


def axis_quaternion(axis: str, angle: float) -> tuple[float, float, float, float]:
    """Return the quaternion of a turn about "x", "y" or "z" by an angle in radians, as four floats.

    The quickest way to a pose. Raises GeometryError for another axis or an angle that isn't finite.
    """
    half = 0.5 * as_number("angle", angle)
    w, s = math.cos(half), math.sin(half)
    match axis:
        case "x":
            return w, s, 0.0, 0.0
        case "y":
            return w, 0.0, s, 0.0
        case "z":
            return w, 0.0, 0.0, s
    raise GeometryError("axis", axis, ", ".join(AXES))


def normalize(q: npt.ArrayLike) -> Array:
    """Return quaternions (..., 4) at length one; a zero one raises GeometryError, in a batch it gives NaN."""
    return unit(as_array("q", q, 4), "q")


def from_axis_angle(axis: npt.ArrayLike, angle: float | Array) -> Array:
    """Return the unit quaternion (..., 4) of a turn about an axis (..., 3) by an angle (...) in radians.

    q = (cos θ/2, sin θ/2 · n), so turning on by 2π gives −q. The axis has any length but zero.
    Raises GeometryError for a zero axis or an angle that isn't finite; in a batch they give NaN.
    Source: Siciliano et al. 2009, "Robotics", sec. 2.6.
    """
    x, y, z = components(unit(as_array("axis", axis, 3), "axis"))
    w, s = cos_sin(0.5 * as_angle("angle", angle))
    return stack(w, s * x, s * y, s * z)


def to_axis_angle(q: npt.ArrayLike) -> tuple[Array, Array]:
    """Return the unit axis (..., 3) and the angle (...) in [0, 2π] radians of quaternions (..., 4).

    The angle keeps the sign of q: above π for w < 0. Without rotation, q = (±1, 0, 0, 0), the axis is z.
    Raises GeometryError for a zero quaternion; in a batch it gives NaN.
    """
    found = each(_axis_angle, normalize(q), core=1, width=4)
    return found[..., :3], found[..., 3]


def _axis_angle(q: list[float]) -> tuple[float, float, float, float]:
    w, x, y, z = q
    length = math.hypot(x, y, z)
    angle = 2.0 * math.atan2(length, w)
    return (0.0, 0.0, 1.0, angle) if length <= SMALLEST else (x / length, y / length, z / length, angle)


def from_matrix(R: npt.ArrayLike) -> Array:
    """Return the unit quaternion (..., 4) of rotations (..., 3, 3), accurate at every angle.

    Of q and −q, the one whose first component that isn't zero is positive.
    Raises GeometryError if R isn't a rotation; in a batch it gives NaN.
    Source: Shepperd 1978, "Quaternion from rotation matrix".
    """
    return each(_shepperd, as_rotation("R", R), core=2, width=4)


def _shepperd(r: Matrix3) -> tuple[float, ...]:
    (a, b, c), (d, e, f), (g, h, i) = r
    squares = (1.0 + a + e + i, 1.0 + a - e - i, 1.0 - a + e - i, 1.0 - a - e + i)
    largest = squares.index(max(squares))
    # A row of 4 q qᵀ; the row of the largest component has nothing to cancel.
    row = (
        (squares[0], h - f, c - g, d - b),
        (h - f, squares[1], b + d, c + g),
        (c - g, b + d, squares[2], f + h),
        (d - b, c + g, f + h, squares[3]),
    )[largest]
    length = math.copysign(math.hypot(*row), next(component for component in row if component != 0.0))
    return tuple(component / length for component in row)


def to_matrix(q: npt.ArrayLike) -> Array:
    """Return the rotation (..., 3, 3) of quaternions (..., 4).

    Raises GeometryError for a zero quaternion; in a batch it gives NaN.
    Source: Siciliano et al. 2009, "Robotics", sec. 2.6.
    """
    w, x, y, z = components(normalize(q))
    return stack_matrix(
        *(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        *(2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        *(2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )


@np.errstate(invalid="ignore")
def multiply(p: npt.ArrayLike, q: npt.ArrayLike) -> Array:
    """Return the Hamilton product p q of quaternions (..., 4): the rotation q followed by p.

    Source: Kuipers 1999, "Quaternions and Rotation Sequences", ch. 5.
    """
    pw, px, py, pz = components(as_array("p", p, 4))
    qw, qx, qy, qz = components(as_array("q", q, 4))
    return stack(
        pw * qw - px * qx - py * qy - pz * qz,
        pw * qx + px * qw + py * qz - pz * qy,
        pw * qy - px * qz + py * qw + pz * qx,
        pw * qz + px * qy - py * qx + pz * qw,
    )


def conjugate(q: npt.ArrayLike) -> Array:
    """Return q* = (w, −x, −y, −z) of quaternions (..., 4): for unit quaternions the inverse."""
    return as_array("q", q, 4) * (1.0, -1.0, -1.0, -1.0)


@np.errstate(invalid="ignore")
def rotate(q: npt.ArrayLike, points: npt.ArrayLike) -> Array:
    """Return points (..., 3) turned by quaternions (..., 4): the vector part of q p q*, for q at length one.

    Multiplied out it is p + w t + v × t with t = 2 v × p, where v is the vector part of q.
    Raises GeometryError for a zero quaternion; in a batch it gives NaN.
    Source: Kuipers 1999, "Quaternions and Rotation Sequences", ch. 5.
    """
    w, x, y, z = components(normalize(q))
    px, py, pz = components(as_array("points", points, 3))
    tx, ty, tz = 2.0 * (y * pz - z * py), 2.0 * (z * px - x * pz), 2.0 * (x * py - y * px)
    return stack(
        px + w * tx + y * tz - z * ty,
        py + w * ty + z * tx - x * tz,
        pz + w * tz + x * ty - y * tx,
    )
