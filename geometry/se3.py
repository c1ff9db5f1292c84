"""Rigid transforms as 4×4 matrices: ``T_a_b`` maps coordinates in b to coordinates in a."""

from functools import reduce

import numpy as np
import numpy.typing as npt

from .arrays import Array, Mask, product
from .errors import as_array
from .rotations import as_rotation


def transform(R: npt.ArrayLike, t: npt.ArrayLike) -> Array:
    """Return the transforms (..., 4, 4) of rotations (..., 3, 3) and translations (..., 3).

    Raises GeometryError if R isn't a rotation; in a batch it gives NaN.
    """
    R, t = as_rotation("R", R), as_array("t", t, 3)
    T = np.zeros((4, 4) if R.ndim == 2 and t.ndim == 1 else (*np.broadcast_shapes(R.shape[:-2], t.shape[:-1]), 4, 4))
    T[..., :3, :3] = R
    T[..., :3, 3] = t
    T[..., 3, 3] = 1.0
    return T


def rotation(T: npt.ArrayLike) -> Array:
    """Return the rotation (..., 3, 3) of transforms (..., 4, 4)."""
    return as_array("T", T, 4, 4)[..., :3, :3]


def translation(T: npt.ArrayLike) -> Array:
    """Return the translation (..., 3) of transforms (..., 4, 4): in T_a_b, the origin of b in a."""
    return as_array("T", T, 4, 4)[..., :3, 3]


def compose(T_a_b: npt.ArrayLike, *others: npt.ArrayLike) -> Array:
    """Return the product of transforms (..., 4, 4), left to right: ``compose(T_a_b, T_b_c)`` is T_a_c."""
    return reduce(product, [as_array("T", T, 4, 4) for T in (T_a_b, *others)])


def inverse(T_a_b: npt.ArrayLike) -> Array:
    """Return T_b_a (..., 4, 4), by the transpose: (Rᵀ, −Rᵀt).

    Source: Murray, Li and Sastry 1994, sec. 2.3.
    """
    T = as_array("T_a_b", T_a_b, 4, 4)
    Rt = T[..., :3, :3].swapaxes(-1, -2)
    result = T.copy()
    result[..., :3, :3] = Rt
    result[..., :3, 3] = -(Rt @ T[..., :3, 3, None])[..., 0]
    return result


@np.errstate(invalid="ignore")
def apply(T_a_b: npt.ArrayLike, points: npt.ArrayLike) -> Array:
    """Return points (..., 3) given in b, in a; the batch dimensions of transforms and points broadcast."""
    T, p = as_array("T_a_b", T_a_b, 4, 4), as_array("points", points, 3)
    if T.ndim == 2:
        return np.asarray(p @ T[:3, :3].T + T[:3, 3])
    return np.asarray((T[..., :3, :3] @ p[..., None])[..., 0] + T[..., :3, 3])


def to_homogeneous(points: npt.ArrayLike) -> Array:
    """Return points (..., n) with a last coordinate w = 1, (..., n + 1)."""
    p = as_array("points", points)
    return np.concatenate([p, np.ones_like(p[..., :1])], axis=-1)


def from_homogeneous(points: npt.ArrayLike) -> tuple[Array, Mask]:
    """Return homogeneous points (..., n + 1) as points (..., n), and a mask (...) of the finite ones.

    A point at infinity (w = 0) is NaN and False; so is one with a component that isn't finite.
    Source: Hartley and Zisserman 2004, sec. 2.2.1.
    """
    p = as_array("points", points)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        divided = p[..., :-1] / p[..., -1:]
    finite = np.isfinite(divided).all(axis=-1) & np.isfinite(p[..., -1])
    return np.where(finite[..., None], divided, np.nan), finite
