"""Both cameras of a state, parallel or as somebody calibrated them, and what follows from them alone."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from geometry.arrays import Array
from geometry.camera import R_WORLD_LEVEL, Camera, parallel_rig
from geometry.epipolar import fundamental
from sims.kit import stereo
from sims.kit.stereo import Own, Size
from sims.kit.types import Place, Quaternion
from sims.triangulation import corners

if TYPE_CHECKING:
    from sims.triangulation.params import TriangulationParams

PICTURE_WIDTH = 0.4
"""Metres that a picture is wide where it stands in the scene."""
BODY_ROOM, PICTURE_ROOM, LARGEST = 0.25, 0.43, 1.4
"""Metres of baseline that a camera and its picture need; they are drawn as large as there is room, within a limit."""
DEEPEST = 2.5
"""Widths of a picture that it stands before its camera at most: through longer lenses it is drawn smaller."""
LEVEL = stereo.orientation(tuple(R_WORLD_LEVEL.ravel().tolist()))


@dataclass(frozen=True, eq=False)
class Standing:
    """One camera as it stands in the scene: its pose, and the corners of its picture in its own axes."""

    wxyz: Quaternion
    center: Place
    corners: Array


@dataclass(frozen=True, eq=False)
class Rig:
    """Both cameras with the sizes of their pictures, their F, how they stand and how large they are drawn, and the
    pixels of the little world's corners."""

    left: Camera
    right: Camera
    sizes: tuple[Size, Size]
    F: Array
    standing: tuple[Standing, Standing]
    size: float
    world: Array


def rig(p: TriangulationParams) -> Rig:
    """The cameras of a state."""
    if p.pair is not None:
        return turned(p.pair, p.sizes, p.baseline)
    return _parallel(p.baseline, p.focal, p.cx, p.cy, p.doffs, p.width, p.height)


@lru_cache(maxsize=256)
def _parallel(baseline: float, focal: float, cx: float, cy: float, doffs: float, width: int, height: int) -> Rig:
    cameras, half = parallel_rig(baseline, focal, (cx, cy), doffs=doffs), 0.5 * baseline
    return _rig(cameras, ((width, height),) * 2, (LEVEL, LEVEL), ((-half, 0.0, 1.0), (half, 0.0, 1.0)), baseline)


@lru_cache(maxsize=256)
def turned(own: Own, sizes: tuple[Size, Size], baseline: float) -> Rig:
    """Somebody's pair, with a baseline in metres."""
    eyes = left, right = stereo.stand(own, sizes, baseline)
    wxyz = stereo.orientation(left.R), stereo.orientation(right.R)
    return _rig((stereo.camera(left), stereo.camera(right)), sizes, wxyz, (eyes[0].center, eyes[1].center), baseline)


def _rig(
    cameras: tuple[Camera, Camera], sizes: tuple[Size, Size], wxyz: tuple[Quaternion, Quaternion],
    centers: tuple[Place, Place], baseline: float,
) -> Rig:  # fmt: skip
    size, reach = (min(baseline / room, LARGEST) for room in (BODY_ROOM, PICTURE_ROOM))
    left, right = (
        Standing(turn, center, _corners(camera, *of, PICTURE_WIDTH * reach))
        for camera, of, turn, center in zip(cameras, sizes, wxyz, centers, strict=True)
    )
    return Rig(*cameras, sizes, fundamental(*cameras), (left, right), size, corners.seen(*cameras))


def _corners(camera: Camera, width: int, height: int, wide: float) -> Array:
    depth = wide * min(camera.K.item(0, 0) / width, DEEPEST)
    return Camera(camera.K, np.eye(4)).frustum_corners(width, height, depth)
