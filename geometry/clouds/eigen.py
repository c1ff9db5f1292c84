"""Eigenvalues of many symmetric 3×3 matrices, and the eigenvector of the least one, in closed form."""

import math

import numpy as np

from ..arrays import Array, Components, Mask, cross, dot, stack

_CLOSE = 3e-4
"""Gap to the next eigenvalue, as part of the largest, below which LAPACK's iteration takes over: the formula loses
digits as one over the gap."""
_NOTHING = 1e-300


def least_eigenvectors(C: Components) -> tuple[Array, Array, Mask]:
    """Return eigenvalues (N, 3), rising, unit eigenvectors (N, 3) of the least, and where those are defined.

    The matrices come as six arrays (N,): xx, xy, xz, yy, yz, zz. An eigenvector isn't defined, and NaN, where the
    two least eigenvalues agree to rounding: points on a line, or all in one place. The two larger eigenvalues, if
    they are nearly equal, are off by up to 1e-8 of their size; the least by up to 1e-12 of the largest.
    Source: Smith 1961, "Eigenvalues of a symmetric 3 × 3 matrix"; the vector is the longest cross product of two
    rows of C − λI. Near a double root both lose digits, and LAPACK does the row.
    """
    with np.errstate(all="ignore"):
        values = _eigenvalues(C)
        low, middle, high = values
        vector, length = _normal_of_rows(C, low)
        vectors = stack(*vector) / length[:, None]
    close = (middle - low < _CLOSE * high) | ~(length > _NOTHING)
    rows = np.flatnonzero(close)
    result = stack(*values)
    if len(rows):
        result[rows], vectors[rows] = _by_lapack([c[rows] for c in C])
    defined = result[:, 1] - result[:, 0] > 1e-12 * result[:, 2]
    vectors[~defined] = np.nan
    return result, vectors, defined


def _eigenvalues(C: Components) -> tuple[Array, Array, Array]:
    xx, xy, xz, yy, yz, zz = C
    mean = (xx + yy + zz) / 3.0
    a, b, c = xx - mean, yy - mean, zz - mean
    off = xy * xy + xz * xz + yz * yz
    p = np.sqrt((a * a + b * b + c * c + 2.0 * off) / 6.0)
    half_determinant = 0.5 * (a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz))
    angle = np.arccos(np.clip(half_determinant / np.maximum(p * p * p, _NOTHING), -1.0, 1.0)) / 3.0
    high = mean + 2.0 * p * np.cos(angle)
    low = mean + 2.0 * p * np.cos(angle + 2.0 * math.pi / 3.0)
    return np.maximum(low, 0.0), 3.0 * mean - high - low, high


def _normal_of_rows(C: Components, value: Array) -> tuple[list[Array], Array]:
    """What is perpendicular to the rows of C − λI: their longest cross product, and its length."""
    xx, xy, xz, yy, yz, zz = C
    rows = (xx - value, xy, xz), (xy, yy - value, yz), (xz, yz, zz - value)
    products = [cross(rows[i], rows[j]) for i, j in ((0, 1), (0, 2), (1, 2))]
    squares = [dot(v, v) for v in products]
    best, square = list(products[0]), squares[0]
    for other, length in zip(products[1:], squares[1:], strict=True):
        longer = length > square
        best = [np.where(longer, new, old) for new, old in zip(other, best, strict=True)]
        square = np.where(longer, length, square)
    return best, np.sqrt(square)


def _by_lapack(C: Components) -> tuple[Array, Array]:
    xx, xy, xz, yy, yz, zz = C
    values, vectors = np.linalg.eigh(np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz], axis=-1).reshape(-1, 3, 3))
    return np.maximum(values, 0.0), vectors[:, :, 0]
