"""Where numbers and letters stand in a picture, so that they cover neither points nor lines nor each other."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from sims.epipolar.params import Pixel

SIZE = 26.0
"""Height of the letters' line, in pixels of the picture."""
WIDE, HIGH = 0.62 * SIZE, 0.74 * SIZE
"""Size of one figure."""
DOT = 9.0
"""Radius of a point, with some room."""
WAYS = ((1, -1), (-1, -1), (1, 1), (-1, 1), (0, -1), (1, 0), (-1, 0), (0, 1))
"""From a point to its number: those that are tried first come first."""
Way = tuple[int, int]
CORNERS: tuple[Way, ...] = ((1, -1), (-1, -1), (1, 1), (-1, 1))
COVERED, CROSSED, OUTSIDE = 10.0, 1.0, 100.0
"""How bad it is to cover a point or number, to stand on a line, and to be cut off."""


@dataclass(frozen=True)
class Box:
    """A number as a rectangle round its middle."""

    u: float
    v: float
    half: float
    """Half its width; its height is that of a figure."""

    def covers(self, at: Pixel, radius: float) -> bool:
        """Whether it reaches into a disc."""
        du = max(abs(at[0] - self.u) - self.half, 0.0)
        dv = max(abs(at[1] - self.v) - 0.5 * HIGH, 0.0)
        return du * du + dv * dv < radius * radius

    def meets(self, other: Box) -> bool:
        """Whether two numbers overlap."""
        return abs(self.u - other.u) < self.half + other.half and abs(self.v - other.v) < HIGH

    def crossed(self, line: Sequence[float]) -> bool:
        """Whether a line (a, b, c) goes through it."""
        a, b, c = line
        return abs(a * self.u + b * self.v + c) < abs(a) * self.half + 0.5 * abs(b) * HIGH


def placed(points: Sequence[tuple[str, Pixel]], lines: Sequence[Sequence[float]], size: Pixel) -> list[Box]:
    """Rectangles of the numbers of points in a picture of that size, one after the other where least is in the way."""
    found: list[Box] = []
    spots = [at for _, at in points]
    for text, at in points:
        best, least = None, math.inf
        for rank, (right, down) in enumerate(WAYS):
            box = _beside(text, at, right, down)
            cost = _cost(box, spots, found, lines, size) + 0.01 * rank
            if cost < least:
                best, least = box, cost
            if cost < CROSSED:
                break
        assert best is not None
        found.append(best)
    return found


def way(at: Pixel, spots: Sequence[Pixel], taken: Sequence[Box], lines: Sequence[Sequence[float]], size: Pixel) -> Way:
    """To which corner of a held point its letter goes, for there least is in the way."""
    costs = [(_cost(_letter(at, *each), spots, taken, lines, size), k) for k, each in enumerate(CORNERS)]
    return CORNERS[min(costs)[1]]


def _letter(at: Pixel, right: int, down: int) -> Box:
    return Box(at[0] + right * 32.0, at[1] + down * 27.0, WIDE)


def _beside(text: str, at: Pixel, right: int, down: int) -> Box:
    half = 0.5 * WIDE * len(text)
    reach = DOT * (0.75 if right and down else 1.0) + 1.0
    return Box(at[0] + right * (reach + half), at[1] + down * (reach + 0.5 * HIGH), half)


def _cost(
    box: Box, spots: Sequence[Pixel], others: Sequence[Box], lines: Sequence[Sequence[float]], size: Pixel
) -> float:
    right, bottom = size[0] - 1.0, size[1] - 1.0
    inside = box.half <= box.u <= right - box.half and 0.5 * HIGH <= box.v <= bottom - 0.5 * HIGH
    covered = sum(box.covers(at, DOT) for at in spots) + sum(map(box.meets, others))
    return COVERED * covered + CROSSED * sum(map(box.crossed, lines)) + (0.0 if inside else OUTSIDE)
