"""The picture that is shown: 640 units wide whatever the camera's pixels are, and bent where the lens bends it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from geometry.affine_camera import AffineCamera
from geometry.arrays import Array, norm
from geometry.camera import Camera
from geometry.distortion import Distortion
from sims.camera.params import CameraParams
from sims.kit.scale import Scale
from sims.kit.types import Pixel
from sims.kit.world_drawing import Box, Sight, frame, see

BORDER = 16
"""Places on each side of the frame at which is looked how far the picture sees through the lens."""
WIDEST = 8.0
"""Times the focal length: the farthest from the optical axis that a straight picture goes."""


@dataclass(frozen=True)
class Lens:
    """What moves the pixels of a camera without distortion to those of one that has it."""

    camera: Camera
    distortion: Distortion

    def bend(self, pixels: Array) -> Array:
        """Where pixels (n, 2) go, (n, 2). What is too far out for the coefficients stays at the edge of their reach."""
        flat = self.camera.normalized(pixels)
        far = norm(flat) / self.distortion.reach
        return self._pixels(self.distortion.apply(flat / np.maximum(far, 1.0)[:, None]))

    @np.errstate(invalid="ignore")
    def bend_points(self, pixels: Array) -> Array:
        """The same, but NaN for what is too far out."""
        far = norm(self.camera.normalized(pixels)) > self.distortion.reach
        return np.where(far[:, None], np.nan, self.bend(pixels))

    def straighten(self, pixels: Array) -> Array:
        """The inverse of `bend`, NaN where there is none."""
        return self._pixels(self.distortion.undo(self.camera.normalized(pixels)))

    def scaled(self, p: CameraParams) -> Lens:
        """The same for the picture that is shown."""
        return Lens(scaled(p, self.camera), self.distortion)

    def _pixels(self, flat: Array) -> Array:
        K = self.camera.K
        return np.asarray(flat @ K[:2, :2].T + K[:2, 2])


def scale(p: CameraParams) -> Scale:
    """How large the picture's pixels are drawn."""
    return Scale.of(p.width, p.height)


def shown(p: CameraParams, pixel: Pixel) -> Pixel:
    """Where a pixel is in the picture that is shown."""
    return scale(p).at(pixel)


def pixel_at(p: CameraParams, place: tuple[float, ...]) -> Pixel:
    """The inverse of `shown`."""
    return scale(p).pixel(place)


def size(p: CameraParams) -> tuple[int, int]:
    """Units of the picture that is shown, across and down."""
    return scale(p).width, scale(p).height


def scaled(p: CameraParams, camera: Camera) -> Camera:
    """A camera whose pixels are the units of the picture that is shown."""
    return scale(p).camera(camera)


def pictured(p: CameraParams, model: Camera | AffineCamera, lens: Lens | None) -> Sight:
    """What the picture shows of the world before the lens bends it."""
    if isinstance(model, AffineCamera):
        return see(AffineCamera(scaled(p, model.perspective), model.depth), frame(*size(p)))
    camera = scaled(p, model)
    if lens is None:
        return see(camera, frame(*size(p)))
    return see(camera, _box(tuple(camera.K.ravel().tolist()), lens.distortion, size(p)))


def _border(width: int, height: int) -> Array:
    left, top, right, bottom = frame(width, height)
    u, v = np.linspace(left, right, BORDER), np.linspace(top, bottom, BORDER)
    sides = [np.column_stack([u, np.full(BORDER, w)]) for w in (top, bottom)]
    return np.concatenate([*sides, *(np.column_stack([np.full(BORDER, w), v]) for w in (left, right))])


@lru_cache(maxsize=64)
def _box(K: tuple[float, ...], distortion: Distortion, size: tuple[int, int]) -> Box:
    """Round all of the straight picture that the lens of a camera with K, by rows, shows within the frame."""
    lens = Lens(Camera(np.reshape(K, (3, 3)), np.eye(4)), distortion)
    seen = lens.straighten(_border(*size))
    if np.isnan(seen).any():  # the lens shows less than the frame has room for
        fx, skew, cx, _, fy, cy, *_ = K
        reach = min(distortion.reach, WIDEST)
        return cx - (fx + abs(skew)) * reach, cy - fy * reach, cx + (fx + abs(skew)) * reach, cy + fy * reach
    return (*np.min(seen, axis=0).tolist(), *np.max(seen, axis=0).tolist())
