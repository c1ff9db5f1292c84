"""Ways between two orientations: SLERP, NLERP and Euler angles. Quaternions (w, x, y, z), t from 0 to 1.

SLERP and NLERP take the same arc, a turn about one axis, and differ in how fast they go along it. Of the two arcs,
to end and to −end, the short one turns by at most π, the long one by the rest of 2π, about the opposite axis.

Ties: where both arcs turn by π (within 1e-12), the short way goes to end as given and the long way to −end. Where
start and end are one rotation, the long way is a whole turn, about the world's z.
"""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from .arrays import Array, components, cos_sin, norm, stack
from .errors import GeometryError, as_angle, as_array, as_finite_array
from .euler import matrix_to_euler
from .quaternion import conjugate, from_axis_angle, multiply, normalize, to_axis_angle, to_matrix

TIE = 1e-12  # radians and quaternion components; rounding mustn't choose between two equal ways


def slerp(start: npt.ArrayLike, end: npt.ArrayLike, t: float | Array, *, long_way: bool = False) -> Array:
    """Return the unit quaternions (..., 4) at t (...) on the arc from start (..., 4) to end, at constant speed.

    Accurate at every distance of start and end. At t = 0 it is start, and at t = 1 end or −end, whichever the way
    leads to, to the last bit; beyond, the turn goes on. The result doesn't jump to −q along the way.
    Raises GeometryError for a zero quaternion or a t that isn't finite; in a batch they give NaN.
    Source: Shoemake 1985, "Animating rotation with quaternion curves", as (end start*)ᵗ start.
    """
    t = as_angle("t", t)
    first, last = _arc(start, end, long_way)
    axis, angle = to_axis_angle(multiply(last, conjugate(first)))
    return _along(first, last, axis, t * angle, t)


def nlerp(start: npt.ArrayLike, end: npt.ArrayLike, t: float | Array, *, long_way: bool = False) -> Array:
    """Return the unit quaternions (..., 4) at t (...) on the chord from start (..., 4) to end, put at length one.

    The same arc as `slerp`, faster in the middle. Where the chord runs through zero, at the middle of a whole turn,
    it is what it tends to: half of that turn. Ends, errors and ties are as in `slerp`.
    Source: the chord (1 − t) start + t end, seen from zero, on both sides of its middle.
    """
    t = as_angle("t", t)
    first, last = _arc(start, end, long_way)
    axis, angle = to_axis_angle(multiply(last, conjugate(first)))
    return _along(first, last, axis, nlerp_angle(angle, t), t)


def nlerp_angle(angle: float | Array, t: float | Array) -> Any:
    """Return how far `nlerp` has turned at t (...), of a turn by an angle (...) in [0, 2π] radians."""
    cos, sin = cos_sin(0.25 * angle)
    return 0.5 * angle + 2.0 * np.arctan2((2.0 * t - 1.0) * sin, cos)


def turn_between(start: npt.ArrayLike, end: npt.ArrayLike, *, long_way: bool = False) -> tuple[Array, Array]:
    """Return the axis (..., 3) and angle (...) in [0, 2π] radians of the turn that `slerp` and `nlerp` make.

    Of start (..., 4) and end, by their ties; without a turn the axis is z.
    Raises GeometryError for a zero quaternion; in a batch it gives NaN.
    """
    first, last = _arc(start, end, long_way)
    return to_axis_angle(multiply(last, conjugate(first)))


def _arc(start: npt.ArrayLike, end: npt.ArrayLike, long_way: bool) -> tuple[Array, Array]:
    first, last = normalize(start), normalize(end)
    flip = (np.vecdot(first, last) < -TIE) != long_way
    if isinstance(flip, np.bool):
        return first, -last if flip else last
    return first, np.where(flip[..., None], -last, last)


def _along(first: Array, last: Array, axis: Array, turned: Any, t: float | Array) -> Array:
    q = multiply(from_axis_angle(axis, turned), first)
    if isinstance(t, float) and t not in (0.0, 1.0):
        return q
    moment = np.asarray(t)[..., None]
    return np.where(moment == 0.0, first, np.where(moment == 1.0, last, q))


def turned_by(start: npt.ArrayLike, axis: npt.ArrayLike, angles: npt.ArrayLike) -> Array:
    """Return the unit quaternions (n, 4) to which turns about an axis (3,) by angles (n,) lead from start (4,).

    What `slerp` gives for many moments, in a fraction of its time. Angles are in radians.
    Raises GeometryError for a zero quaternion or axis, or an angle that isn't finite.
    """
    first = normalize(start)
    aside = multiply(from_axis_angle(axis, math.pi), first)
    half = 0.5 * as_finite_array("angles", angles)[..., None]
    return np.asarray(np.cos(half) * first + np.sin(half) * aside)


def euler_interpolation(start: npt.ArrayLike, end: npt.ArrayLike, t: float | Array) -> Array:
    """Return the unit quaternions (..., 4) at t (...) on the way that the Euler angles of start and end take.

    Intrinsic zyx: yaw, pitch and roll each go the short way, at constant speed. It isn't a turn about one axis, and
    at gimbal lock it depends on the choice of a zero roll. At t = 0 it is start to rounding; it doesn't jump to −q.
    Raises GeometryError for a zero quaternion or a t that isn't finite; in a batch they give NaN.
    """
    t = as_angle("t", t)
    first = normalize(start)
    angles, _ = matrix_to_euler(to_matrix(first), "zyx", "intrinsic")
    goal, _ = matrix_to_euler(to_matrix(end), "zyx", "intrinsic")
    q = _from_yaw_pitch_roll(interpolate_angles(angles, goal, t))
    same = np.vecdot(_from_yaw_pitch_roll(angles), first) >= 0.0
    return np.where(same[..., None], q, -q)


def interpolate_angles(start: npt.ArrayLike, end: npt.ArrayLike, t: float | Array) -> Array:
    """Return the angles (..., n) at t (...) from start (..., n) to end, each the short way round, in radians.

    An angle that has half a turn to go (within 1e-12) goes up. At t = 1 it is end, give or take whole turns.
    Raises GeometryError for a t that isn't finite; in a batch it gives NaN.
    """
    first, last = as_array("start", start), as_array("end", end)
    ahead = np.remainder(last - first, 2.0 * math.pi)
    turn = np.where(ahead > math.pi + TIE, ahead - 2.0 * math.pi, ahead)
    return np.asarray(first + np.asarray(as_angle("t", t))[..., None] * turn)


def _from_yaw_pitch_roll(angles: Array) -> Array:
    yaw, pitch, roll = components(angles)
    (cy, sy), (cp, sp), (cr, sr) = (cos_sin(0.5 * angle) for angle in (yaw, pitch, roll))
    return stack(
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )


def angular_speed(path: npt.ArrayLike, t: npt.ArrayLike) -> Array:
    """Return the mean angular speed (..., n − 1), in radians per unit of t, between samples of a path (..., n, 4).

    t (n,) grows from each of the two or more samples to the next. Quaternions q and −q are one sample.
    Raises GeometryError if it doesn't grow so; a zero quaternion gives NaN.
    """
    q, times = normalize(path), as_finite_array("t", t)
    if times.ndim != 1 or q.ndim < 2 or q.shape[-2] != times.size or times.size < 2 or (np.diff(times) <= 0.0).any():
        raise GeometryError("t", times.tolist(), "growing numbers, one for each of two or more samples")
    step = multiply(q[..., 1:, :], conjugate(q[..., :-1, :]))
    return np.asarray(2.0 * np.arctan2(norm(step[..., 1:]), np.abs(step[..., 0])) / np.diff(times))
