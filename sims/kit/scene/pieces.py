"""Lines as the straight pieces that they are drawn with."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

Dash = tuple[float, float] | None
"""Metres on and off; None for a line without gaps."""
ARC_PIECES = 48


def arc_pieces(radius: float, angle: float, start: float, dash: Dash) -> npt.NDArray[np.float64]:
    """An arc in the xy plane as pieces (n, 2, 3); dashes (metres along it) keep their length."""
    length = abs(angle) * radius
    count = ARC_PIECES if dash is None else max(int(length / sum(dash)) + 1, 1)
    step = angle / count if dash is None else math.copysign(sum(dash) / radius, angle)
    ends = np.empty((count, 2))
    ends[:, 0] = start + step * np.arange(count)
    ends[:, 1] = ends[:, 0] + (step if dash is None else math.copysign(dash[0] / radius, angle))
    if dash is not None:
        np.clip(ends, min(start, start + angle), max(start, start + angle), out=ends)
    pieces = np.zeros((count, 2, 3))
    pieces[..., 0] = radius * np.cos(ends)
    pieces[..., 1] = radius * np.sin(ends)
    return pieces


def dashes(points: npt.NDArray[np.float64], dash: Dash) -> npt.NDArray[np.float64]:
    """A polyline (n, 3) as pieces (m, 2, 3): its segments, or dashes of (on, off) metres along it."""
    if dash is None or len(points) < 2:
        return np.stack([points[:-1], points[1:]], axis=1)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    on, off = dash
    starts = np.arange(0.0, max(along[-1], 1e-9), on + off)[:400]
    ends = np.minimum(starts + on, along[-1])
    sample = [np.column_stack([np.interp(s, along, points[:, k]) for k in range(3)]) for s in (starts, ends)]
    return np.stack(sample, axis=1)
