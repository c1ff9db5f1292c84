"""Euler angles: all twelve orders, intrinsic (about the turned axes) and extrinsic (about the fixed axes).

Angles are the first, second and third turn in the order as written, in radians.
Intrinsic "zyx" is R = Rz(first) Ry(second) Rx(third); extrinsic "zyx" is the reverse product.
"""

import math
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .arrays import Array, Mask, Matrix3, components, each, product
from .errors import as_angle, as_array, as_choice, as_number
from .rotations import AXES, as_rotation, axis_rotation

ORDERS = ("zyx", "xyz", "zxz", "xzy", "yxz", "yzx", "zxy", "xyx", "xzx", "yxy", "yzy", "zyz")
FRAMES = ("intrinsic", "extrinsic")
LOCKED = 1e-13  # radians from lock; dropping an angle there moves R by less than 1e-12


class Factor(NamedTuple):
    """One turn of an Euler sequence: axis letter, angle (...) in radians, rotation matrix (..., 3, 3)."""

    axis: str
    angle: float | Array
    R: Array


def is_proper(order: str) -> bool:
    """Return whether the order repeats its first axis (proper Euler, as zxz) or not (Tait–Bryan, as zyx)."""
    return as_choice("order", order, ORDERS)[0] == order[2]


def factors(angles: npt.ArrayLike, order: str, frame: str) -> tuple[Factor, Factor, Factor]:
    """Return the three turns in the order of multiplication: their product, left to right, is the rotation.

    angles (..., 3) in radians.
    Raises GeometryError for an unknown order or frame, or an angle that isn't finite: NaN in a batch.
    """
    a, b, c = [Factor(axis, angle, axis_rotation(axis, angle)) for axis, angle in _turns(angles, order, frame)]
    return a, b, c


def _turns(angles: npt.ArrayLike, order: str, frame: str) -> list[tuple[str, Any]]:
    as_choice("order", order, ORDERS)
    as_choice("frame", frame, FRAMES)
    turns = list(zip(order, components(as_array("angles", angles, 3)), strict=True))
    return turns if frame == "intrinsic" else turns[::-1]


def euler_to_matrix(angles: npt.ArrayLike, order: str, frame: str) -> Array:
    """Return the rotation (..., 3, 3) of Euler angles (..., 3) in radians.

    Raises GeometryError as `factors` does.
    Source: Siciliano et al. 2009, "Robotics", sec. 2.4.
    """
    a, b, c = [axis_rotation(axis, angle) for axis, angle in _turns(angles, order, frame)]
    return product(product(a, b), c)


def matrix_to_euler(R: npt.ArrayLike, order: str, frame: str) -> tuple[Array, Mask]:
    """Return Euler angles (..., 3) in radians of rotations (..., 3, 3), and a mask (...) of those at lock.

    The angles rebuild R to 1e-12 at every distance from lock. The first and the third lie in [−π, π], the
    second in [−π/2, π/2] for Tait–Bryan orders and in [0, π] for proper ones. At lock only the sum or the
    difference of first and third is determined: the third, as written and in both frames, is then zero.
    Raises GeometryError for an unknown order or frame, or if R isn't a rotation; in a batch it gives NaN.
    Source: Shoemake 1994, "Euler angle conversion", Graphics Gems IV, but with the third angle taken from the
    remainder after the first turn: near lock it makes good what the first one lost.
    """
    as_choice("order", order, ORDERS)
    extrinsic = as_choice("frame", frame, FRAMES) == "extrinsic"
    sequence = order[::-1] if extrinsic else order  # extrinsic abc is intrinsic cba with the angles reversed
    found = each(lambda r: _chain(r, sequence, extrinsic), as_rotation("R", R), core=2, width=4)
    angles = found[..., 2::-1] if extrinsic else found[..., :3]
    return angles, found[..., 3] > 0.0


def _chain(r: Matrix3, sequence: str, drop_first: bool) -> tuple[float, float, float, float]:
    i, j, last = (AXES.index(axis) for axis in sequence)
    k = 3 - i - j
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    toward_j, toward_k, along = r[j][last], r[k][last], r[i][last]  # R e_last: where the third axis ends
    slant = math.hypot(toward_j, toward_k)
    if last == k:
        first, second = math.atan2(-sign * toward_j, toward_k), math.atan2(sign * along, slant)
    else:
        first, second = math.atan2(toward_j, -sign * toward_k), math.atan2(slant, along)
    if slant <= LOCKED:
        if not drop_first:
            return math.atan2(sign * r[k][j], r[j][j]), second, 0.0, 1.0
        first = 0.0
    cos, sin = math.cos(first), sign * math.sin(first)
    row = [cos * r[j][m] + sin * r[k][m] for m in range(3)]  # row j of the remainder after the first turn
    third = math.atan2(sign * row[i] if last == k else -sign * row[k], row[j])
    return first, second, third, float(slant <= LOCKED)


@np.errstate(invalid="ignore")
def lock_distance(middle: float | Array, order: str) -> Array:
    """Return how far, in radians, the middle angle (...) is from the nearest one that locks.

    Tait–Bryan orders lock at ±π/2, proper Euler orders at 0 and π, and so on every half turn.
    Raises GeometryError for an unknown order, or an angle that isn't finite: NaN in a batch.
    """
    from_zero = as_angle("middle", middle) - (0.0 if is_proper(order) else 0.5 * math.pi)
    return np.asarray(np.abs(from_zero - math.pi * np.rint(from_zero / math.pi)))


def lock_sign(middle: float, order: str, frame: str) -> int:
    """Return the sign s, 1 or −1, with which, at lock, a rotation depends on first + s · third angle alone.

    middle in radians, near the lock that is meant; angles as written, in both frames.
    Raises GeometryError for an unknown order or frame, or an angle that isn't finite.
    Source: with R = A(a) B(b) C(c), B turns the axis of C to s times that of A, so that R = A(a + s c) B(b).
    """
    angle = as_number("middle", middle)
    if is_proper(order):
        end, cyclic = math.cos(angle), True
    else:
        end, cyclic = math.sin(angle), (AXES.index(order[2]) - AXES.index(order[1])) % 3 == 1
    extrinsic = as_choice("frame", frame, FRAMES) == "extrinsic"
    flipped = (end < 0.0) ^ (not cyclic) ^ (extrinsic and not is_proper(order))
    return -1 if flipped else 1


def other_triple(angles: npt.ArrayLike, order: str) -> Array:
    """Return the other Euler angles (..., 3) in radians that give the same rotation, first and third within ±π.

    Raises GeometryError for an unknown order, or an angle that isn't finite: NaN in a batch.
    Source: Shoemake 1994, as above: half a turn first and last, and the middle one mirrored at the order's lock.
    """
    half_turn = 0.0 if is_proper(order) else math.pi
    a, b, c = np.moveaxis(np.asarray(as_array("angles", angles, 3)), -1, 0)
    return np.stack([_within(a + math.pi), _within(half_turn - b), _within(c + math.pi)], axis=-1)


def _within(angle: Array) -> Array:
    return np.asarray(angle - 2.0 * math.pi * np.rint(angle / (2.0 * math.pi)))
