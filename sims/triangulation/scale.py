"""Pictures of any size, drawn as wide as all pictures are."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

from geometry.arrays import Array
from geometry.camera import Camera
from sims.kit.frame import WIDTH
from sims.triangulation.holding import Pixel
from sims.triangulation.params import TriangulationParams


@dataclass(frozen=True)
class Scale:
    """How large a camera's pixels are drawn. Coordinates of both run from -½: integers are the middles of pixels."""

    factor: float
    height: int
    width: int = WIDTH

    @staticmethod
    def of(p: TriangulationParams) -> Scale:
        """That of a state's pictures."""
        return _scale(p.width, p.height)

    def at(self, pixel: Pixel) -> Pixel:
        """Where a pixel is drawn."""
        k, shift = self.factor, 0.5 * (self.factor - 1.0)
        return k * pixel[0] + shift, k * pixel[1] + shift

    def pixel(self, place: Sequence[float]) -> Pixel:
        """The pixel that is drawn at a place."""
        k, shift = self.factor, 0.5 * (self.factor - 1.0)
        return (place[0] - shift) / k, (place[1] - shift) / k

    def camera(self, camera: Camera) -> Camera:
        """One whose pixels are where this draws those of another."""
        (f, _, cx), (_, _, cy), _ = camera.K.tolist()
        at = self.at((cx, cy))
        return Camera.from_intrinsics(self.factor * f, self.factor * f, *at, T_camera_world=camera.T_camera_world)

    def line(self, line: Array) -> tuple[float, float, float]:
        """Where the line a u + b v + c = 0 of the pixels is drawn."""
        a, b, c = line.tolist()
        return a, b, self.factor * c - 0.5 * (self.factor - 1.0) * (a + b)


@lru_cache(maxsize=8)
def _scale(width: int, height: int) -> Scale:
    factor = WIDTH / width
    return Scale(factor, math.ceil(factor * height - 1e-9))
