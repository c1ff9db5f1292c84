"""The two cameras of a state as plain numbers: the sim's own level ones, or a stereo pair of somebody's."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from geometry import quaternion
from geometry.arrays import Array
from geometry.camera import R_WORLD_LEVEL, Camera
from geometry.rotations import axis_angle_to_matrix, axis_rotation
from sims.epipolar.params import CENTER, EpipolarParams, Own, Pixel, Size
from sims.kit.frame import HEIGHT, WIDTH, inside
from sims.kit.types import Place, Quaternion

BASELINE = 1.2
"""Metres that the baseline of somebody's pair has in the scene, in whatever unit their T is: it has no part in F."""
MIDDLE: Place = (0.0, 0.0, 1.0)
"""Where the middle of that baseline is."""


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


def eyes(p: EpipolarParams) -> tuple[Eye, Eye]:
    """The left and the right camera."""
    if p.pair is not None:
        return _pair(p.pair, p.sizes)
    return level(p.left, p.left_pan, p.focal), level(p.right, p.right_pan, p.focal)


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


@lru_cache(maxsize=256)
def level(center: Place, pan: float, focal: float) -> Eye:
    """A level camera at a place in metres, turned by degrees about the vertical."""
    R = axis_rotation("z", math.radians(pan)) @ R_WORLD_LEVEL
    return Eye((focal, focal, *CENTER), center, tuple(R.ravel().tolist()), (WIDTH, HEIGHT))


@lru_cache(maxsize=64)
def _pair(own: Own, sizes: tuple[Size, Size]) -> tuple[Eye, Eye]:
    """Somebody's cameras at their true pose to each other, but for the length of the baseline.

    Both are turned half as much as the right one is against the left one, to opposite sides from a level camera.
    """
    turn = np.radians(own[8:11])
    angle = float(np.linalg.norm(turn))
    half = axis_angle_to_matrix(turn, 0.5 * angle) if angle else np.eye(3)  # x_right = half half x_left + T
    to_right = -R_WORLD_LEVEL @ half.T @ own[11:]
    to_right *= 0.5 * BASELINE / float(np.linalg.norm(to_right))
    return (
        _eye((own[0], own[1], own[2], own[3]), MIDDLE - to_right, R_WORLD_LEVEL @ half, sizes[0]),
        _eye((own[4], own[5], own[6], own[7]), MIDDLE + to_right, R_WORLD_LEVEL @ half.T, sizes[1]),
    )


def _eye(lens: tuple[float, float, float, float], center: Array, R: Array, size: Size) -> Eye:
    x, y, z = center.tolist()
    return Eye(lens, (x, y, z), tuple(R.ravel().tolist()), size)
