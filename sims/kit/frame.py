"""The frame of a picture: what is inside, where a line enters and leaves it, and where what is outside is marked.

It runs from -0.5 to width - 0.5 and height - 0.5: pixel centres are integers.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

Point = Sequence[float]
WIDTH, HEIGHT = 640, 480
"""Pixels of the pictures that the cameras of the sims take."""
INSET = 14.0
"""Pixels from the picture's edge at which what lies outside is marked."""


def inside(x: float, y: float, width: float, height: float) -> bool:
    """Whether a place is in a picture of so many pixels; one that doesn't exist (NaN) isn't."""
    return -0.5 <= x <= width - 0.5 and -0.5 <= y <= height - 0.5


def across(line: Point, width: float, height: float) -> tuple[Point, Point] | None:
    """Where a x + b y + c = 0 enters and leaves the picture; None if it misses it."""
    a, b, c = (float(v) for v in line)
    left, top, right, bottom = -0.5, -0.5, width - 0.5, height - 0.5
    found = []
    if abs(b) > 1e-12:
        found += [(x, -(a * x + c) / b) for x in (left, right)]
    if abs(a) > 1e-12:
        found += [(-(b * y + c) / a, y) for y in (top, bottom)]
    eps = 1e-6 * (width + height)
    inside = [p for p in found if left - eps <= p[0] <= right + eps and top - eps <= p[1] <= bottom + eps]
    if len(inside) < 2:
        return None
    far = max(inside[1:], key=lambda p: abs(p[0] - inside[0][0]) + abs(p[1] - inside[0][1]))
    return inside[0], far


def border(point: Point, width: float, height: float) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """Where at the picture's border a homogeneous point outside is marked, and the unit direction in which it lies.

    The mark is on the way from the picture's middle to the point (x / w, y / w); a point at infinity (w = 0) lies
    in the direction (x, y). None for a point in the very middle, which has no direction.
    """
    x, y, w = (float(v) for v in point)
    middle_x, middle_y = 0.5 * width - 0.5, 0.5 * height - 0.5
    sign = -1.0 if w < 0.0 else 1.0
    dx, dy = sign * (x - middle_x * w), sign * (y - middle_y * w)
    length = math.hypot(dx, dy)
    if not length:
        return None
    dx, dy = dx / length, dy / length
    reach = min(
        (0.5 * width - INSET) / abs(dx) if dx else math.inf,
        (0.5 * height - INSET) / abs(dy) if dy else math.inf,
    )
    return (middle_x + reach * dx, middle_y + reach * dy), (dx, dy)
