"""Depth along the left ray: P slides along it, p stays where it is, and p′ runs along its line."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from geometry.arrays import Array
from sims.epipolar.eye import eyes
from sims.epipolar.params import EpipolarParams, Pixel, Place
from sims.epipolar.rig import Pair
from sims.kit.params import by_hand
from sims.kit.sim import Step
from sims.kit.stereo import camera
from sims.kit.types import Segment

LEAST = 1e-6
"""Metres of depth below which P is at the left camera, and on no ray, or behind it."""
NEAREST, FARTHEST = 0.5, 10.0
"""Metres of depth between which P slides."""
SWEPT = (1.5, 7.0)
"""Metres of depth that a sweep goes through, where both cameras see them."""
AHEAD, BEFORE = 0.5, 0.02
"""Metres before the right camera that a sweep keeps; and where the right picture's part of a trail ends."""
DECIMALS = 12
"""Where P slides, in metres: a link is without the last digits of a product, and p stays within 1e-9 pixels."""
COMING, SWEEPING, BACK = 0.8, 2.6, 0.9
"""Seconds of a sweep's legs."""


@dataclass(frozen=True, eq=False)
class Trail:
    """A piece of the ray of p, from one depth to another in metres, and how the right picture shows it."""

    near: float
    far: float
    ends: Segment
    """In the world."""
    steps: Array
    """Places (n, 3) on it at each whole metre of depth."""
    pixels: tuple[Pixel, Pixel] | None
    """Its ends in the right picture, as far as it is before the right camera."""
    step_pixels: Array
    """Its steps there (n, 2): NaN behind the right camera."""


def trail(p: EpipolarParams, both: Pair, depth: float) -> Trail | None:
    """The piece of the ray along which P has slid, with the depth at which it is now; None where there is none."""
    if p.trail is None or depth < LEAST:
        return None
    near, far = min(*p.trail, depth), max(*p.trail, depth)
    start, along = both.left.center, _direction(p, depth)
    seen = _before(both, start, along, near, far)
    whole = range(math.ceil(near), math.floor(far) + 1)
    places = start + np.array([near, far, *(seen or (near, far)), *whole])[:, None] * along
    pixels, _ = both.right.project(places[2:])
    (a, b), (u, v) = places[:2].tolist(), pixels[:2].tolist()
    ends = (u[0], u[1]), (v[0], v[1])
    return Trail(near, far, ((a[0], a[1], a[2]), (b[0], b[1], b[2])), places[4:], ends if seen else None, pixels[2:])


def depth_of(p: EpipolarParams) -> float:
    """Metres that P is before the left camera, along its axis."""
    return float(camera(eyes(p)[0]).project(p.point)[1])


def reached(p: EpipolarParams, depth: float) -> tuple[float, Place]:
    """The nearest depth to a wanted one at which P may be on its left ray, and where it is then."""
    along = _direction(p, depth_of(p))
    depth = min(max(depth, NEAREST), *_limits(p, along))
    return depth, _place(np.array(eyes(p)[0].center) + depth * along)


def hold(p: EpipolarParams, place: tuple[float, ...]) -> Mapping[str, Any]:
    """A handle: slides P to a depth, and leaves a trail."""
    now = depth_of(p)
    if now < LEAST:
        return {}
    depth, point = reached(p, place[0])
    passed = *(p.trail or (now,)), now, depth
    return by_hand({"point": point, "trail": (min(passed), max(passed))}, DECIMALS)


def sweep(p: EpipolarParams) -> Iterator[Step]:
    """An action: P slides along its ray from near to far and comes back."""
    if depth_of(p) < LEAST:
        return
    (near, start), (far, end) = (reached(p, depth) for depth in _swept(p))
    yield Step(
        {"candidate": None, "trail": None, "point": start}, COMING,
        words="P comes nearer along the ray of p: in the left picture nothing moves.",
    )  # fmt: skip
    yield Step({"trail": (near, near)}, 0.0)
    yield Step(
        {"point": end, "trail": (near, far)}, SWEEPING,
        words="P slides away along one ray: p stays, and p′ runs along its line, in ever shorter steps.",
    )  # fmt: skip
    yield Step({"point": p.point}, BACK, words="So from p alone, P may be at any depth, and p′ anywhere on this line.")


def _swept(p: EpipolarParams) -> tuple[float, float]:
    """Depths of a sweep: those of `SWEPT` at which P may be, before the right camera too."""
    now = depth_of(p)
    along = _direction(p, now)
    near, far = SWEPT
    left, right = eyes(p)[0], camera(eyes(p)[1])
    first, step = float(right.R[2] @ left.center + right.t[2]), float(right.R[2] @ along)
    if step > 0.0:
        near = max(near, (AHEAD - first) / step)
    return min(near, now), max(far, now)


def _direction(p: EpipolarParams, depth: float) -> Array:
    """Along the ray of p in the world, one metre deeper."""
    return np.asarray((np.array(p.point) - eyes(p)[0].center) / depth)


def _limits(p: EpipolarParams, along: Array) -> list[float]:
    """Depths at which the ray leaves the places where P may be."""
    kind = EpipolarParams.numeric["point"]
    bounds = kind.ranges(p.point, kind.bounds)
    found = [
        ((high if step > 0.0 else low) - start) / step
        for start, step, (low, high) in zip(eyes(p)[0].center, along.tolist(), bounds, strict=True)
        if step
    ]
    return [FARTHEST, *found]


def _before(both: Pair, start: Array, along: Array, near: float, far: float) -> tuple[float, float] | None:
    """Which of the depths from near to far on a ray are before the right camera."""
    first, step = float(both.right.R[2] @ start + both.right.t[2]), float(both.right.R[2] @ along)
    if step:
        edge = (BEFORE - first) / step
        near, far = (max(near, edge), far) if step > 0.0 else (near, min(far, edge))
    return (near, far) if near <= far and first + near * step >= 0.5 * BEFORE else None


def _place(at: Array) -> Place:
    x, y, z = at.tolist()
    return x, y, z
