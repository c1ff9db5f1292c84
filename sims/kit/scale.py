"""Pictures of any size, drawn as wide as all pictures are."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from geometry.arrays import Array
from geometry.camera import Camera
from sims.kit.frame import WIDTH
from sims.kit.types import Pixel


@dataclass(frozen=True)
class Scale:
    """How large a camera's pixels are drawn. Coordinates of both run from -½: integers are the middles of pixels."""

    factor: float
    height: int
    width: int = WIDTH

    @staticmethod
    def of(width: int, height: int) -> Scale:
        """That of pictures of so many pixels."""
        return _scale(width, height)

    @property
    def _shift(self) -> float:
        return 0.5 * (self.factor - 1.0)

    def at(self, pixel: Sequence[float]) -> Pixel:
        """Where a pixel is drawn."""
        return self.factor * pixel[0] + self._shift, self.factor * pixel[1] + self._shift

    def pixel(self, place: Sequence[float]) -> Pixel:
        """The pixel that is drawn at a place."""
        return (place[0] - self._shift) / self.factor, (place[1] - self._shift) / self.factor

    def pixels(self, pixels: Array) -> Array:
        """Where pixels (n, 2) are drawn."""
        return self.factor * pixels + self._shift

    def homogeneous(self, pixel: Array) -> Array:
        """The same of a homogeneous one (3,), which may be at infinity."""
        u, v, w = pixel.tolist()
        return np.array([self.factor * u + self._shift * w, self.factor * v + self._shift * w, w])

    def lines(self, lines: Array) -> Array:
        """Where the lines (..., 3), a u + b v + c = 0, of the pixels are drawn."""
        a, b, c = lines[..., 0], lines[..., 1], lines[..., 2]
        return np.stack([a, b, self.factor * c - self._shift * (a + b)], axis=-1)

    def camera(self, camera: Camera) -> Camera:
        """One whose pixels are where this draws those of another."""
        if self.factor == 1.0:
            return camera
        (fx, skew, cx), (_, fy, cy), _ = camera.K.tolist()
        k, at = self.factor, self.at((cx, cy))
        return Camera.from_intrinsics(k * fx, k * fy, *at, k * skew, T_camera_world=camera.T_camera_world)


@lru_cache(maxsize=8)
def _scale(width: int, height: int) -> Scale:
    factor = WIDTH / width
    return Scale(factor, math.ceil(factor * height - 1e-9))
