"""Both cameras of a state, and what follows from them alone."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from geometry.arrays import Array
from geometry.camera import Camera, parallel_rig
from geometry.epipolar import fundamental
from sims.triangulation import corners
from sims.triangulation.params import TriangulationParams

PICTURE_WIDTH = 0.4
"""Metres that a picture is wide where it stands in the scene."""
BODY_ROOM, PICTURE_ROOM, LARGEST = 0.25, 0.43, 1.4
"""Metres of baseline that a camera and its picture need; they are drawn as large as there is room, within a limit."""


@dataclass(frozen=True, eq=False)
class Rig:
    """Both cameras, their F, the corners of each picture in its camera's axes where it stands in the scene, and the
    pixels of the little world's corners."""

    left: Camera
    right: Camera
    F: Array
    corners_left: Array
    corners_right: Array
    size: float
    world: Array


def rig(p: TriangulationParams) -> Rig:
    """The cameras of a state."""
    return _rig(p.baseline, p.focal, p.cx, p.cy, p.doffs, p.width, p.height)


@lru_cache(maxsize=256)
def _rig(baseline: float, focal: float, cx: float, cy: float, doffs: float, width: int, height: int) -> Rig:
    left, right = parallel_rig(baseline, focal, (cx, cy), doffs=doffs)
    size, reach = (min(baseline / room, LARGEST) for room in (BODY_ROOM, PICTURE_ROOM))
    depth = PICTURE_WIDTH * reach * focal / width
    at_left, at_right = (Camera(each.K, np.eye(4)).frustum_corners(width, height, depth) for each in (left, right))
    return Rig(left, right, fundamental(left, right), at_left, at_right, size, corners.seen(left, right))
