"""Quaternion algebra taken apart: the terms of a product, the steps of q p q*, quaternions as points of a ball."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .arrays import Array, Mask, components, dot, ratio, stack
from .errors import as_array, as_finite_array
from .quaternion import conjugate, multiply, normalize

# Component i of the product p q is the sum over j of SIGNS[i][j] p[j] q[PARTNERS[i][j]]: i² = j² = k² = ijk = −1.
SIGNS = ((1.0, -1.0, -1.0, -1.0), (1.0, 1.0, 1.0, -1.0), (1.0, -1.0, 1.0, 1.0), (1.0, 1.0, -1.0, 1.0))
PARTNERS = ((0, 1, 2, 3), (1, 0, 3, 2), (2, 3, 0, 1), (3, 2, 1, 0))


class Sandwich(NamedTuple):
    """The steps of q p q*, quaternions (..., 4): `q` at length one, `p` = (0, point), `q_p` = q p, `q_conjugate`
    = q*, and `rotated` = q p q* = (0, turned point)."""

    q: Array
    p: Array
    q_p: Array
    q_conjugate: Array
    rotated: Array


def product_terms(p: npt.ArrayLike, q: npt.ArrayLike) -> Array:
    """Return the signed terms (..., 4, 4) of the Hamilton product p q of quaternions (..., 4).

    Row i holds the four terms of component i in the order w, x, y, z of p's factor; its sum is that component.
    Source: Kuipers 1999, "Quaternions and Rotation Sequences", ch. 5.
    """
    left, right = as_array("p", p, 4), as_array("q", q, 4)
    return np.asarray(SIGNS * left[..., None, :] * right[..., PARTNERS])


def sandwich(q: npt.ArrayLike, points: npt.ArrayLike) -> Sandwich:
    """Return the steps of q p q* for quaternions (..., 4), put at length one, and points (..., 3).

    Raises GeometryError for a zero quaternion; in a batch it gives NaN.
    Source: Kuipers 1999, "Quaternions and Rotation Sequences", ch. 5.
    """
    unit_q = normalize(q)
    x, y, z = components(as_array("points", points, 3))
    pure = stack(0.0 * x, x, y, z)
    half, star = multiply(unit_q, pure), conjugate(unit_q)
    return Sandwich(unit_q, pure, half, star, multiply(half, star))


def to_ball(q: npt.ArrayLike) -> tuple[Array, Mask]:
    """Return quaternions (..., 4) as points (..., 3) by stereographic projection from −1, and a mask (...).

    A turn by θ about the unit axis n is at tan(θ/4) n: in the unit ball for θ ≤ π, where w ≥ 0; −q is outside of
    it, on the opposite side, at the inverse distance. −1 itself is at infinity: NaN and False.
    Raises GeometryError for a zero quaternion; in a batch it gives NaN and False.
    Source: Schaub and Junkins 1996, "Stereographic orientation parameters".
    """
    w, x, y, z = components(normalize(q))
    beyond = ratio(1.0 - w, dot((x, y, z), (x, y, z)))  # 1 / (1 + w) without its cancellation near w = −1
    if isinstance(w, float):
        scale = 1.0 / (1.0 + w) if w >= 0.0 else beyond
    else:
        scale = np.where(w >= 0.0, 1.0 / np.maximum(1.0 + w, 1.0), beyond)
    scale = scale + 0.0 * scale  # NaN where it is beyond all numbers
    return stack(scale * x, scale * y, scale * z), np.asarray(scale == scale)


def from_ball(points: npt.ArrayLike) -> Array:
    """Return the unit quaternions (..., 4) that `to_ball` puts at points (..., 3).

    A point at distance r in the direction n is the turn by 4 atan r about n; beyond r = 1 it has w < 0.
    Raises GeometryError for what isn't finite.
    Source: Schaub and Junkins 1996, "Stereographic orientation parameters".
    """
    x, y, z = components(as_finite_array("points", points, 3))
    square = x * x + y * y + z * z
    scale = 2.0 / (1.0 + square)
    return stack(scale - 1.0, scale * x, scale * y, scale * z)
