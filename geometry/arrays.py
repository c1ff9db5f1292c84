"""The array types of the package, and the helpers that let one formula serve one vector and a batch."""

import math
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Matrix3: TypeAlias = list[list[float]]


def components(vectors: Array) -> list[Any]:
    """Split (..., n) vectors into n floats (one vector) or n arrays (a batch).

    Float arithmetic on one vector is ten times as fast as array arithmetic, and the formula reads the same.
    """
    return vectors.tolist() if vectors.ndim == 1 else list(np.moveaxis(vectors, -1, 0))


def stack(*parts: Any) -> Array:
    """Join n floats, or n arrays that broadcast together, into (..., n): the inverse of `components`."""
    if set(map(type, parts)) == {float}:
        return np.array(parts)
    return np.stack(np.broadcast_arrays(*parts), axis=-1)


def stack_matrix(*nine: Any) -> Array:
    """Join the nine entries of 3×3 matrices, by rows, into (..., 3, 3)."""
    flat = stack(*nine)
    return flat.reshape(*flat.shape[:-1], 3, 3)


def product(A: Array, B: Array) -> Array:
    """Matrix product of (..., n, n) matrices; for two single ones twice as fast as `@`."""
    return A.dot(B) if A.ndim == B.ndim == 2 else A @ B


def cross(a: Array, b: Array) -> Array:
    """Cross product of (..., 3) vectors; ten times as fast as `np.cross` for one pair."""
    ax, ay, az = components(a)
    bx, by, bz = components(b)
    return stack(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)


def dot(a: Array, b: Array) -> Array:
    """Dot product of (..., n) vectors, of shape (...)."""
    return np.asarray(np.vecdot(a, b))


def norm(vectors: Array) -> Array:
    """Length of (..., n) vectors, of shape (...)."""
    return np.asarray(np.sqrt(np.vecdot(vectors, vectors)))


def square_root(value: float | Array) -> Any:
    """Square root, by `math` for one number and by NumPy for an array; NaN below zero."""
    if isinstance(value, float):
        return math.sqrt(value) if value >= 0.0 else math.nan
    return np.sqrt(value)


def quotient(numerator: float | Array, denominator: float | Array) -> Any:
    """Quotient of two numbers or two arrays: zero where the numerator is zero, NaN where only the denominator is."""
    if isinstance(numerator, float) and isinstance(denominator, float):
        return numerator / denominator if denominator else math.nan * numerator if numerator else 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(numerator == 0.0, 0.0, numerator / np.where(denominator == 0.0, np.nan, denominator))


def cos_sin(angle: float | Array) -> tuple[Any, Any]:
    """Cosine and sine, by `math` for one angle and by NumPy for an array."""
    if isinstance(angle, float):
        return math.cos(angle), math.sin(angle)
    with np.errstate(invalid="ignore"):
        return np.cos(angle), np.sin(angle)


def each(function: Callable[[Any], Sequence[float]], array: Array, core: int, width: int) -> Array:
    """Apply a function of nested lists of floats to each item, the last `core` dimensions; (..., width) results.

    For formulas that branch: simpler than masked array arithmetic, and quicker up to thousands of items.
    """
    if array.ndim == core:
        return np.array(function(array.tolist()))
    batch, item = array.shape[:-core], array.shape[-core:]
    results = [function(one) for one in array.reshape(-1, *item).tolist()]
    return np.array(results, dtype=np.float64).reshape(*batch, width)
