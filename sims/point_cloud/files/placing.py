"""Where points are: those far from all others, and an origin near to the rest."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from geometry.arrays import Array

FAR = 10_000.0
"""Metres from the origin, from which on coordinates as the browser has them (float32) would lose millimetres."""
GAP = 10.0
"""How many times as far from the middle as the next nearer point a stray is."""
STRAYS = 0.01
"""Share of the points that may be strays; more are part of what was measured."""
DUST, SMALLEST = 1e-9, 1e-15
"""A share of a cloud's size, and metres: what is smaller is nothing."""
LEAST = 10
"""Points, from which on there is a rest that some are far from."""


def strays(points: Array) -> npt.NDArray[np.bool_]:
    """Which of the points (N, 3) are no part of the cloud: a few, with a wide gap between them and all others.

    Points at exactly 0, 0, 0 are what scanners write for nothing: beyond such a gap there may be many.
    """
    none = np.zeros(len(points), bool)
    if len(points) < LEAST:
        return none
    zero = ~points.any(axis=1)
    some = points if zero.mean() > 0.5 or not zero.any() else points[~zero]
    middle = np.median(some, axis=0)
    distance = np.linalg.norm(points - middle, axis=1)
    nearer = np.sort(distance if some is points else distance[~zero])
    first = max(len(nearer) - max(int(STRAYS * len(nearer)), 1), 1)
    jumps = np.flatnonzero((nearer[first:] > GAP * nearer[first - 1 : -1]) & (nearer[first - 1 : -1] > 0.0))
    reach = float(nearer[first + jumps[0] - 1] if len(jumps) else nearer[-1])
    far: npt.NDArray[np.bool_] = distance > reach
    if some is not points and not (distance[zero] > GAP * reach).all():
        far &= ~zero
    return np.asarray(far)


def origin_of(points: Array) -> Array | None:
    """What to take from coordinates (N, 3) where the browser would else lose millimetres; None from near ones."""
    away = np.abs(points).max(axis=0) >= FAR
    return np.where(away, 100.0 * np.round(np.median(points, axis=0) / 100.0), 0.0) if away.any() else None


def without_dust(points: Array) -> Array:
    """Points (N, 3) whose coordinates are zero where they are nothing beside the cloud's size.

    No browser shows a billionth of it. But points so near to each other that the squares of their distances are zero
    would all be each other's nearest ones, and whoever looks for neighbours would look at all of them.
    """
    least = max(SMALLEST, DUST * float(np.abs(points).max(initial=0.0)))
    return np.where(np.abs(points) < least, 0.0, points)


def chosen(count: int, most: int) -> npt.NDArray[np.intp]:
    """Rows of at most `most` of so many points, at random: a regular stride would lose one of two scanners in turn."""
    return np.sort(np.random.default_rng(count).choice(count, most, replace=False, shuffle=False))
