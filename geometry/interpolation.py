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

from .arrays import Array, stack
from .errors import GeometryError, as_angle, as_array
from .euler import euler_to_matrix, matrix_to_euler
from .quaternion import conjugate, from_axis_angle, from_matrix, multiply, normalize, to_axis_angle, to_matrix

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
    Source: Shoemake 1985, sec. 3.3; the chord (1 − t) start + t end in coordinates along start and across it.
    """
    t = as_angle("t", t)
    first, last = _arc(start, end, long_way)
    axis, angle = to_axis_angle(multiply(last, conjugate(first)))
    half = 0.5 * angle
    turned = 2.0 * np.arctan2(t * np.sin(half), 1.0 - t * (2.0 * np.sin(0.5 * half) ** 2))
    return _along(first, last, axis, turned, t)


def _arc(start: npt.ArrayLike, end: npt.ArrayLike, long_way: bool) -> tuple[Array, Array]:
    first, last = normalize(start), normalize(end)
    flip = (np.vecdot(first, last) < -TIE) != long_way
    if isinstance(flip, np.bool):
        return first, -last if flip else last
    return first, np.where(flip[..., None], -last, last)


def _along(first: Array, last: Array, axis: Array, turned: Any, t: float | Array) -> Array:
    q = multiply(from_axis_angle(axis, turned), first)
    if isinstance(t, float):
        return np.where(t == 1.0, last, q) if q.ndim > 1 else last if t == 1.0 else q
    return np.where((t == 1.0)[..., None], last, q)
