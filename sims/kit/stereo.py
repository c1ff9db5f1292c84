"""Two cameras as plain numbers, and a stereo pair of somebody's: what of it is state, and where its cameras stand."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Annotated

import numpy as np

from geometry import quaternion
from geometry.arrays import Array
from geometry.camera import R_WORLD_LEVEL, Camera
from geometry.rotations import axis_angle_to_matrix
from sims.kit.fields import Vector
from sims.kit.frame import inside
from sims.kit.types import Pixel, Place, Quaternion

Size = tuple[int, int]
"""Width and height of a picture in pixels."""
Own = tuple[float, float, float, float, float, float, float, float, float, float, float, float, float, float]
"""Both calibrations: fx, fy, cx, cy of the left and the right camera, the rotation vector in degrees, and T."""
SMALLEST, LARGEST = 16, 8192
"""Pixels that a picture has, across and down."""
SHORTEST, CLOSEST = 1.0, 1e-9
"""Pixels of focal length, and length of T, that somebody's pair has at least."""
FARTHEST = 1e6
"""How far from zero any number of it may be."""
OwnPair = Annotated[Own | None, Vector(-FARTHEST, FARTHEST, step=0.01, title="Own stereo pair", hidden=True)]
OwnSizes = Annotated[
    tuple[int, int, int, int] | None,
    Vector(SMALLEST, LARGEST, step=1, unit="px", title="Sizes of your pictures", hidden=True),
]
MIDDLE: Place = (0.0, 0.0, 1.0)
"""Where the middle of that pair's baseline is in the scene."""


@dataclass(frozen=True)
class Eye:
    """One camera: its K as fx, fy, cx, cy, its centre, its axes in the world by rows, and the size of its pictures."""

    lens: tuple[float, float, float, float]
    center: Place
    R: tuple[float, ...]
    size: Size

    @property
    def last(self) -> Pixel:
        """The pixel at the lower right."""
        return self.size[0] - 1.0, self.size[1] - 1.0

    def shows(self, u: float, v: float) -> bool:
        """Whether a pixel is within its picture's edges."""
        return inside(u, v, *self.size)

    def within(self, u: float, v: float) -> Pixel:
        """The nearest pixel of its picture."""
        return min(max(u, 0.0), self.last[0]), min(max(v, 0.0), self.last[1])


@lru_cache(maxsize=256)
def camera(eye: Eye) -> Camera:
    """The same with all that `geometry` knows of a camera."""
    R = np.reshape(eye.R, (3, 3)).T
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, -R @ eye.center
    return Camera.from_intrinsics(*eye.lens, T_camera_world=T)


@lru_cache(maxsize=256)
def orientation(R: tuple[float, ...]) -> Quaternion:
    """A camera's axes in the world as a quaternion."""
    w, x, y, z = quaternion.from_matrix(np.reshape(R, (3, 3))).tolist()
    return w, x, y, z


def usable(own: Own | None) -> Own | None:
    """Somebody's pair, if it has focal lengths and a baseline."""
    if own is None or min(own[:2] + own[4:6]) < SHORTEST or length(own) < CLOSEST:
        return None
    return own


def length(own: Own) -> float:
    """How long T is, in its unit."""
    return math.hypot(*own[11:])


def turned(own: Own) -> float:
    """Degrees by which the right camera is turned against the left one."""
    return math.hypot(*own[8:11])


def sizes(own: Own, said: tuple[int, int, int, int] | None) -> tuple[Size, Size]:
    """Pixels of the left and of the right picture: as they were said, or twice as far as the principal points are."""
    if said is not None:
        return said[:2], said[2:]
    a, b, c, d = (min(max(round(2.0 * own[k] + 1.0), SMALLEST), LARGEST) for k in (2, 3, 6, 7))
    return (a, b), (c, d)


@lru_cache(maxsize=256)
def stand(own: Own, sizes: tuple[Size, Size], baseline: float) -> tuple[Eye, Eye]:
    """Somebody's cameras at their true pose to each other, but for the length of the baseline, which is in metres.

    Both are turned half as much as the right one is against the left one, to opposite sides from a level camera.
    """
    turn = np.radians(own[8:11])
    angle = float(np.linalg.norm(turn))
    half = axis_angle_to_matrix(turn, 0.5 * angle) if angle else np.eye(3)  # x_right = half half x_left + T
    to_right = -R_WORLD_LEVEL @ half.T @ own[11:]
    to_right *= 0.5 * baseline / float(np.linalg.norm(to_right))
    return (
        _eye((own[0], own[1], own[2], own[3]), MIDDLE - to_right, R_WORLD_LEVEL @ half, sizes[0]),
        _eye((own[4], own[5], own[6], own[7]), MIDDLE + to_right, R_WORLD_LEVEL @ half.T, sizes[1]),
    )


def _eye(lens: tuple[float, float, float, float], center: Array, R: Array, size: Size) -> Eye:
    x, y, z = center.tolist()
    return Eye(lens, (x, y, z), tuple(R.ravel().tolist()), size)
