"""Corners of the little world as the rig sees them: what somebody who matches pixels may have meant."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from geometry.arrays import Array
from geometry.camera import Camera
from sims.kit.frame import WIDTH
from sims.kit.stereo import Size
from sims.kit.types import Pixel
from sims.kit.world import BODIES, Paint

WORLD = (-0.42, 3.653, 0.0)
"""Metres by which the little world is moved: the point of the defaults is straight above the second post."""
THINGS: dict[Paint, str] = {
    "wall": "the house", "roof": "the roof", "post": "a post", "cube-left": "the left cube",
    "cube-right": "the right cube", "cube-far": "the far cube",
}  # fmt: skip
NEAR = 6.0
"""Pixels of a picture of 640 within which both image points are on a corner."""
ALIKE = 0.15
"""Part of the depth within which the result is then there too: beyond, it only lies in the corner's direction."""


def _corners() -> dict[tuple[float, ...], str]:
    """What each corner is of, by its place; what two things share is the first one's."""
    found: dict[tuple[float, ...], str] = {}
    for body in BODIES:
        for face in body.faces if body.paint in THINGS else ():
            for place in face:
                found.setdefault(tuple(np.add(place, WORLD).tolist()), THINGS[body.paint])
    return found


_FOUND = _corners()
PLACES: Array = np.array(list(_FOUND))
OF = list(_FOUND.values())


@dataclass(frozen=True)
class Matched:
    """A corner on which both image points are, what it is of, and how many metres the result is away from it."""

    place: Array
    of: str
    apart: float


def seen(left: Camera, right: Camera) -> Array:
    """Pixels (n, 4) of the corners, left and right; those behind a camera are nowhere (infinite)."""
    pixels = np.concatenate([camera.project(PLACES)[0] for camera in (left, right)], axis=1)
    return np.where(np.isfinite(pixels), pixels, np.inf)


def matched(
    pixels: Array, left: Pixel, right: Pixel, sizes: tuple[Size, Size], point: Array | None, depth: float
) -> Matched | None:
    """The corner of those `seen` that is next to both image points, for a result that exists, and is so far away."""
    if point is None:
        return None
    scale = [WIDTH / sizes[0][0]] * 2 + [WIDTH / sizes[1][0]] * 2
    off = (np.abs(pixels - (*left, *right)) * scale).max(axis=1)
    k = int(off.argmin())
    if off.item(k) > NEAR:
        return None
    apart = math.dist(PLACES[k].tolist(), point.tolist())
    return Matched(PLACES[k], OF[k], apart) if apart <= ALIKE * depth else None
