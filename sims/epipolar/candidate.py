"""A free pixel of the right picture, q′: can it be the partner of p?"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from geometry.arrays import Array
from geometry.epipolar import epipolar_residual
from geometry.triangulation import Status, triangulate_midpoint
from sims.epipolar.eye import eyes
from sims.epipolar.params import EpipolarParams, Pixel, Place
from sims.epipolar.rig import Pair, existing, right_line
from sims.kit.scale import Scale
from sims.kit.sim import Step
from sims.kit.stereo import camera
from sims.kit.types import Segment

ON_LINE = 0.5
"""Pixels up to which q′ counts as being on the line."""
AWAY, FARTHEST = 60.0, 80.0
"""Pixels that it is moved off the line to begin with, and to which its control goes."""
FAR, LEAST, BEYOND = 9.0, 1.0, 1.15
"""Metres that its ray is drawn where it meets nothing, and at least; how far it goes on where it does, as a part."""
FREED = 0.9
Verdict = Literal["off the line", "a point", "at infinity", "behind a camera", "no line"]
ON_THE_LINE: Mapping[Status, Verdict] = {
    Status.FOUND: "a point", Status.PARALLEL: "at infinity",
    Status.BEHIND: "behind a camera", Status.UNDEFINED: "no line",
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Candidate:
    """What q′ and p have to do with each other; what doesn't exist is None."""

    pixel: Pixel
    verdict: Verdict
    """Whether a point in space has p and q′ as its pixels, or why none has."""
    ray: Segment
    """From the right camera on, in the world."""
    residual: float | None = None
    """q′ᵀ F p."""
    distance: float | None = None
    """From the line of p, in pixels; positive on the side to which the line's (a, b) points."""
    foot: Pixel | None = None
    """The pixel of the line that is nearest."""
    gap: float | None = None
    """Metres between the rays of p and q′ where they are nearest to each other, if that is before both cameras."""
    nearest: Segment | None = None
    """Where that is, on the left ray and on the right one."""


def candidate(p: EpipolarParams, both: Pair, left: Array, line: Array | None) -> Candidate | None:
    """How q′ and the pixel p agree whose line in the right picture is given; None where nobody tries one."""
    if (pixel := p.candidate) is None:
        return None
    start, along = both.right.pixel_ray(pixel)
    if both.F is None or line is None:
        return Candidate(pixel, "no line", (_place(start), _place(start + FAR * along)))
    a, b, c = line.tolist()
    distance = a * pixel[0] + b * pixel[1] + c
    found = triangulate_midpoint(both.left, both.right, left, np.array(pixel))
    one, other = map(_place, found.closest)
    length = min(max(BEYOND * math.dist(other, start), LEAST), FAR) if found.valid else FAR
    return Candidate(
        pixel,
        "off the line" if abs(distance) > ON_LINE else ON_THE_LINE[Status(int(found.status))],
        (_place(start), _place(start + length * along)),
        residual=float(epipolar_residual(both.F, left, np.array(pixel))),
        distance=distance,
        foot=(pixel[0] - distance * a, pixel[1] - distance * b),
        gap=float(found.gap) if found.valid else None,
        nearest=(one, other) if found.valid else None,
    )


def hold(p: EpipolarParams, place: tuple[float, ...]) -> Mapping[str, Any]:
    """A handle: q′ is put to where the picture shows a pixel."""
    right = eyes(p)[1]
    return {"candidate": right.within(*Scale.of(*right.size).pixel(place))}


def hold_off(p: EpipolarParams, place: tuple[float, ...]) -> Mapping[str, Any]:
    """A handle: q′ is put to a distance from the line, beside the same pixel of it."""
    line = right_line(p)
    if p.candidate is None or line is None:
        return {}
    (u, v), (a, b, c) = p.candidate, line.tolist()
    further = place[0] - (a * u + b * v + c)
    return {"candidate": eyes(p)[1].within(u + further * a, v + further * b)}


def free(p: EpipolarParams) -> Iterator[Step]:
    """An action: q′ leaves p′ and its line, to the side where there is more room."""
    right = eyes(p)[1]
    pixel = existing(camera(right).project(p.point)[0])
    line = right_line(p)
    center = 0.5 * right.size[0], 0.5 * right.size[1]
    u, v = center if pixel is None else right.within(*pixel)
    a, b = (0.0, 1.0) if line is None else line.tolist()[:2]
    side = -1.0 if a * (u - center[0]) + b * (v - center[1]) > 0.0 else 1.0
    yield Step({"candidate": (u, v), "trail": None}, 0.0)
    yield Step(
        {"candidate": right.within(u + side * AWAY * a, v + side * AWAY * b)}, FREED,
        words="q′ leaves the line of p: the rays of p and q′ no longer meet.",
    )  # fmt: skip


def _place(at: Array) -> Place:
    x, y, z = at.tolist()
    return x, y, z
