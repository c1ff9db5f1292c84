"""Three nested rings, R = Rz(yaw) Ry(pitch) Rx(roll): which angular velocities they reach, and which is lost.

The outer ring turns about the world's Z, the middle one about the outer ring's y, the inner one about the middle
ring's x. Their axes in the world are the columns of the Jacobian from ring rates to angular velocity. Its singular
values, and the left singular vectors, are in closed form, because only outer and inner ring aren't always
perpendicular: the cosine of the angle between them is −sin θ.
"""

import math
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .arrays import Array, cos_sin, square_root, stack, stack_matrix
from .errors import as_angle, as_array, as_number

RANK = 1e-6  # of the largest singular value: one that isn't above it counts as zero


class Ellipsoid(NamedTuple):
    """Angular velocities that unit ring rates reach.

    `directions` (..., 3, 3): its axes in the world, right-handed, in columns; `lengths` (..., 3): half of each axis,
    descending, in radians per second for rates of one.
    """

    directions: Array
    lengths: Array


class AtLock(NamedTuple):
    """R at lock: `end` is 1 or −1, the sign of sin θ; `angle`, in (−π, π] radians, is ψ − φ at 1 and ψ + φ at −1."""

    end: int
    angle: float
    R: Array


def ring_axes(yaw: float | Array, pitch: float | Array) -> Array:
    """Return the rings' axes (..., 3, 3) in the world as columns: outer, middle, inner.

    yaw, the outer ring, and pitch, the middle one, (...) in radians; the inner ring turns about its own axis.
    Raises GeometryError for an angle that isn't finite; in a batch it gives NaN.
    Source: Diebel 2006, "Representing Attitude": the rates of the sequence yaw, pitch, roll.
    """
    (cos, sin), (c, s) = cos_sin(as_angle("yaw", yaw)), cos_sin(as_angle("pitch", pitch))
    zero, one = 0.0 * (cos + c), 1.0 + 0.0 * (cos + c)
    return stack_matrix(zero, -sin, c * cos, zero, cos, c * sin, one, zero, zero - s)


def singular_values(pitch: float | Array) -> Array:
    """Return the singular values (..., 3) of the ring axes, descending: √(1 + |sin θ|), 1, √(1 − |sin θ|).

    pitch (...) in radians. The last one is taken as |cos θ| / √(1 + |sin θ|), which is accurate at lock.
    Raises GeometryError for an angle that isn't finite; in a batch it gives NaN.
    Source: the Gram matrix of the axes; Golub and Van Loan 2013, "Matrix Computations", sec. 2.4.
    """
    cos, sin = cos_sin(as_angle("pitch", pitch))
    largest = square_root(1.0 + abs(sin))
    return stack(largest, 1.0 + 0.0 * cos, abs(cos) / largest)


def degrees_of_freedom(values: npt.ArrayLike) -> npt.NDArray[np.int_]:
    """Return how many of the singular values (..., n), descending, are above 1e-6 of the largest, (...)."""
    ordered = as_array("values", values)
    return np.asarray((ordered > RANK * ordered[..., :1]).sum(axis=-1))


def conditioning(pitch: float | Array) -> float | Array:
    """Return |det| of the ring axes (...): |cos θ|, one for perpendicular rings and zero at lock."""
    return abs(cos_sin(as_angle("pitch", pitch))[0])  # type: ignore[no-any-return]


def ellipsoid(yaw: float | Array, pitch: float | Array) -> Ellipsoid:
    """Return the ellipsoid of reachable angular velocities: left singular vectors and singular values.

    yaw and pitch (...) in radians. At lock it is flat, and the last direction is the lost axis; at pitch zero it
    is a ball. Directions are continuous in yaw and pitch, except where sin θ changes its sign.
    Raises GeometryError for an angle that isn't finite; in a batch it gives NaN.
    Source: Yoshikawa 1985, "Manipulability of robotic mechanisms".
    """
    (cos, sin), (c, s) = cos_sin(as_angle("yaw", yaw)), cos_sin(as_angle("pitch", pitch))
    # The sum and the difference of outer and inner axis, without the factor that vanishes at lock.
    longer = square_root(0.5 + 0.5 * abs(s))
    shorter = 0.5 * _sign(s) * c / longer
    level = 0.0 * sin
    directions = stack_matrix(
        *(shorter * cos, -sin, longer * cos),
        *(shorter * sin, cos, longer * sin),
        *(level - longer, level, level + shorter),
    )
    return Ellipsoid(directions, singular_values(pitch))


def _sign(sine: Any) -> Any:
    return math.copysign(1.0, sine + 0.0) if isinstance(sine, float) else np.where(sine < 0.0, -1.0, 1.0)


def lost_axis(yaw: float | Array, pitch: float | Array) -> Array | None:
    """Return the unit axis (..., 3), in the world, about which no ring turns; None where none is lost.

    yaw and pitch (...) in radians; in a batch, NaN where none is lost. At lock it is the left singular vector of
    the singular value that counts as zero: level, where the middle ring's x would point at pitch zero.
    Raises GeometryError for an angle that isn't finite; in a batch it gives NaN.
    """
    directions, lengths = ellipsoid(yaw, pitch)
    lost = degrees_of_freedom(lengths) == 2
    if lost.ndim == 0 and directions.ndim == 2:
        return directions[:, 2].copy() if lost else None
    return np.where(lost[..., None], directions[..., 2], np.nan)


def ring_rates(yaw: float | Array, pitch: float | Array, velocity: npt.ArrayLike) -> Array:
    """Return the ring rates (..., 3), outer, middle, inner, that come nearest to an angular velocity (..., 3).

    yaw and pitch (...) in radians, velocity in the world; rates in its unit. Where the rings can't give it, these are
    the least-squares rates, and of those the slowest: what lies along a lost axis has no effect on them.
    A velocity that isn't finite gives NaN. Raises GeometryError for an angle that isn't; in a batch it gives NaN.
    Source: Golub and Van Loan 2013, "Matrix Computations", sec. 5.5: the pseudoinverse of the ring axes.
    """
    wanted = as_array("velocity", velocity, 3)
    wanted = np.where(np.isfinite(wanted).all(axis=-1, keepdims=True), wanted, np.nan)
    directions, lengths = ellipsoid(yaw, pitch)
    kept = lengths > RANK * lengths[..., :1]
    along = np.vecmat(wanted, directions)
    along = np.where(kept | np.isnan(along), along / np.where(kept, lengths, 1.0) ** 2, 0.0)
    return np.asarray(np.vecmat(np.matvec(directions, along), ring_axes(yaw, pitch)))


def at_lock(yaw: float, pitch: float, roll: float) -> AtLock | None:
    """Return the one combination of yaw and roll that R has at lock, and R in its reduced form; None elsewhere.

    Angles in radians. With the pitch taken as the lock itself, R differs from that of the three angles by 2e-6 at
    most: where two singular values are left, by `degrees_of_freedom`.
    Raises GeometryError for an angle that isn't finite.
    Source: the product of the three turns at θ = ±π/2.
    """
    yaw, pitch, roll = as_number("yaw", yaw), as_number("pitch", pitch), as_number("roll", roll)
    if degrees_of_freedom(singular_values(pitch)) != 2:
        return None
    end = 1 if math.sin(pitch) > 0.0 else -1
    cos, sin = cos_sin(yaw - end * roll)
    R = stack_matrix(0.0, -sin, end * cos, 0.0, cos, end * sin, -float(end), 0.0, 0.0)
    return AtLock(end, math.atan2(sin, cos), R)
