"""The array types of the package, and the helpers that let one formula serve one item and a batch.

A vector taken apart is a sequence of components: floats for one vector, arrays for a batch. Arithmetic on
floats is some ten times as fast as on small arrays, and the formula reads the same.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Matrix3: TypeAlias = list[list[float]]
Components: TypeAlias = Sequence[Any]


def components(vectors: Array) -> list[Any]:
    """Split (..., n) vectors into n floats (one vector) or n arrays (a batch)."""
    return vectors.tolist() if vectors.ndim == 1 else list(np.moveaxis(vectors, -1, 0))


def stack(*parts: Any) -> Array:
    """Join n floats, or n arrays that broadcast together, into (..., n): the inverse of `components`."""
    if set(map(type, parts)) == {float}:
        return np.array(parts)
    if len(set(map(np.shape, parts))) > 1:
        parts = np.broadcast_arrays(*parts)
    return np.stack(parts, axis=-1)


def stack_matrix(*nine: Any) -> Array:
    """Join the nine entries of 3×3 matrices, by rows, into (..., 3, 3)."""
    flat = stack(*nine)
    return flat.reshape(*flat.shape[:-1], 3, 3)


def cross(a: Components, b: Components) -> tuple[Any, Any, Any]:
    """Cross product of two vectors of three components."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def dot(a: Components, b: Components) -> Any:
    """Dot product of two vectors of three components."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def ratio(numerator: Any, denominator: Any) -> Any:
    """Quotient of floats or of arrays, NaN where the denominator is zero."""
    if isinstance(denominator, float):
        return numerator / (denominator or math.nan)
    return numerator / np.where(denominator == 0.0, np.nan, denominator)


def square_root(value: Any) -> Any:
    """Square root of a float or an array, NaN below zero."""
    if isinstance(value, float):
        return math.sqrt(value) if value >= 0.0 else math.nan
    return np.sqrt(value)


def everywhere(condition: Any) -> bool:
    """Whether a condition on floats, or on arrays, holds throughout."""
    return condition if isinstance(condition, bool) else bool(condition.all())


def if_positive(value: Any) -> Any:
    """Return a float or an array where it is above zero, NaN elsewhere."""
    if isinstance(value, float):
        return value if value > 0.0 else math.nan
    return np.where(value > 0.0, value, np.nan)


def cos_sin(angle: float | Array) -> tuple[Any, Any]:
    """Cosine and sine, by `math` for one angle and by NumPy for an array."""
    if isinstance(angle, float):
        return math.cos(angle), math.sin(angle)
    with np.errstate(invalid="ignore"):
        return np.cos(angle), np.sin(angle)


def norm(vectors: Array) -> Array:
    """Length of (..., n) vectors, of shape (...)."""
    return np.asarray(np.sqrt(np.vecdot(vectors, vectors)))


def product(A: Array, B: Array) -> Array:
    """Matrix product of (..., n, n) matrices; of two single ones, in half the time of `@`."""
    return A.dot(B) if A.ndim == B.ndim == 2 else A @ B


def each(function: Callable[[Any], Sequence[float]], array: Array, core: int, width: int) -> Array:
    """Apply a function of nested lists of floats to each item, the last `core` dimensions, to (..., width).

    For formulas that branch: simpler than masked array arithmetic, and quicker up to thousands of items.
    """
    if array.ndim == core:
        return np.array(function(array.tolist()))
    batch, item = array.shape[:-core], array.shape[-core:]
    results = [function(one) for one in array.reshape(-1, *item).tolist()]
    return np.array(results, dtype=np.float64).reshape(*batch, width)
