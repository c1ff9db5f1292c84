"""What every process starts from: points as rows, and the work cut into chunks that several threads share."""

from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from itertools import islice
from multiprocessing import cpu_count
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from ..arrays import Array
from ..errors import GeometryError, as_array

Indices: TypeAlias = npt.NDArray[np.intp]
Progress: TypeAlias = Callable[[float], None]
"""Is told how much of the work is done, 0 to 1, from the caller's thread; what it raises ends the work."""

THREADS = min(4, cpu_count())
CHUNK = 8192  # rows: a chunk's arrays stay in the cache
MANY = 131_072  # rows, for which it is worth to start threads for light work


def silent(done: float) -> None:
    """Progress that nobody watches."""


def as_cloud(argument: str, points: npt.ArrayLike) -> Array:
    """Return points as finite, contiguous float64 (N, 3), or raise GeometryError."""
    array = np.ascontiguousarray(as_array(argument, points, 3))
    if array.ndim != 2:
        raise GeometryError(argument, f"an array of shape {array.shape}", "shape (N, 3)")
    finite = np.isfinite(array)
    if not finite.all():
        bad = len(array) - int(finite.all(axis=1).sum())
        raise GeometryError(argument, f"{bad} of {len(array)} points with NaN or infinity", "finite coordinates")
    return array


def columns(array: Array) -> Array:
    """Return a copy of (N, n) as contiguous (n, N): arithmetic on strided columns is several times as slow."""
    return array.T.copy(order="C")


def squares(xyz: Array) -> Array:
    """Return the squared lengths (...) of vectors in columns (3, ...)."""
    x, y, z = xyz
    return np.asarray(x * x + y * y + z * z)


def bounds(points: npt.ArrayLike) -> tuple[Array, Array]:
    """Return the least and the greatest coordinates (3,) of points (N, 3), in metres.

    Raises GeometryError if there is no point, or one isn't finite.
    """
    cloud = as_cloud("points", points)
    if not len(cloud):
        raise GeometryError("points", "no points", "at least one")
    return measured(cloud)[1:]


def measured(cloud: Array) -> tuple[Array, Array, Array]:
    """Return points' `columns` (3, N), and their least and greatest coordinates (3,): of one point at least."""
    xyz, ends = np.empty((3, len(cloud))), list[tuple[Array, Array]]()

    def work(rows: slice) -> None:
        xyz[:, rows] = cloud[rows].T
        ends.append((xyz[:, rows].min(axis=1), xyz[:, rows].max(axis=1)))

    in_chunks(work, len(cloud), size=MANY)
    return xyz, np.min([low for low, _ in ends], axis=0), np.max([high for _, high in ends], axis=0)


def in_chunks(work: Callable[[slice], None], length: int, progress: Progress = silent, size: int = CHUNK) -> None:
    """Do the work for each chunk of rows, several at a time: NumPy and SciPy release Python's lock meanwhile."""
    slices = (slice(start, min(start + size, length)) for start in range(0, length, size))
    if length <= size:
        for rows in slices:
            work(rows)
        progress(1.0)
        return
    with _pool() as pool:
        waiting = [(rows, pool.submit(work, rows)) for rows in islice(slices, 2 * THREADS)]
        while waiting:
            rows, first = waiting.pop(0)
            first.result()
            progress(rows.stop / length)
            waiting += _next(pool, work, slices)


def _next(
    pool: ThreadPoolExecutor, work: Callable[[slice], None], slices: Iterator[slice]
) -> list[tuple[slice, Future[None]]]:
    return [(rows, pool.submit(work, rows)) for rows in islice(slices, 1)]


@contextmanager
def _pool() -> Iterator[ThreadPoolExecutor]:
    pool = ThreadPoolExecutor(THREADS)
    try:
        yield pool
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
