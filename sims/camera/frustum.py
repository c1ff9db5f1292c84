"""What the picture can show of space, and the picture as it stands there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from geometry.arrays import Array
from geometry.camera import Camera
from sims.camera.lens import scaled
from sims.camera.params import CameraParams
from sims.kit.types import Pixel
from sims.kit.world import NAMES
from sims.kit.world_drawing import Sight

BOX = 9.0
"""Metres in front of the camera where the box ends that an orthographic picture shows."""
NOWHERE = (math.nan, math.nan)


class Imaged(Protocol):
    """What may be in the picture; `straight` is its pixel without distortion."""

    @property
    def in_image(self) -> bool: ...

    @property
    def pixel(self) -> Pixel | None: ...

    @property
    def straight(self) -> Pixel | None: ...


@dataclass(frozen=True)
class Frustum:
    """All in the camera's axes, in metres. The picture is the one without distortion: lines of sight are straight."""

    depth: float
    """How far the picture is away."""
    corners: Array
    """Corners of the picture (4, 3): top left, top right, bottom right, bottom left."""
    back: Array
    """Where the lines of sight through them come from (4, 3): the centre, or the camera's plane."""
    far: Array | None
    """Without perspective: where the picture's box ends, and for weak perspective where sizes are true (4, 3)."""
    wires: Array
    """Edges (n, 2, 3) of the faces in the picture."""
    dots: Array
    """Named points (m, 3) in the picture."""
    rays: Array
    """Lines of sight (m, 2, 3) from the camera to those points."""
    chosen: Array | None
    """Line of sight (3, 3) of the selected point: where it comes from, its place in the picture, the point."""
    meet: Array
    """Vanishing points (3, 3) in the picture; the centre for those that aren't in it."""


def frustum(
    p: CameraParams, camera: Camera, unit: float | None, depth: float, in_camera: Array,
    points: Sequence[Imaged], vanishing: Sequence[Imaged], sight: Sight,
) -> Frustum:  # fmt: skip
    """The picture stands at `depth`; there a pixel is as far from the axis as its line of sight is.

    `unit`: the depth by which an affine camera divides; None with perspective. `in_camera`: the named points (n, 3).
    """
    display = scaled(p, camera)
    right, bottom = p.width - 0.5, p.height - 0.5
    meets = [v.straight if v.straight and v.in_image else NOWHERE for v in vanishing]
    flat = np.array([(-0.5, -0.5), (right, -0.5), (right, bottom), (-0.5, bottom), *meets])
    placed = _placed(camera, flat, unit or depth, depth)
    corners, meet = placed[:4], placed[4:]
    meet[np.isnan(meet[:, 0])] = 0.0
    targets = in_camera[[k for k, point in enumerate(points) if point.in_image]]
    starts = np.zeros_like(targets) if unit is None else targets * (1.0, 1.0, 0.0)
    number = NAMES.index(p.selected)
    chosen = in_camera[number]
    return Frustum(
        depth=depth,
        corners=corners,
        back=np.zeros((4, 3)) if unit is None else corners * (1.0, 1.0, 0.0),
        far=None if unit is None else corners * (1.0, 1.0, (unit if p.projection == "weak" else BOX) / depth),
        wires=_placed(display, sight.outlines().reshape(-1, 2), unit or depth, depth).reshape(-1, 2, 3),
        dots=_seen(targets, unit, depth),
        rays=np.stack([starts, targets], axis=1),
        chosen=None if points[number].pixel is None else _sight(chosen, unit, depth),
        meet=meet,
    )


def _placed(camera: Camera, pixels: Array, unit: float, depth: float) -> Array:
    """Pixels (n, 2) on the picture as it stands in the scene (n, 3)."""
    placed = np.empty((len(pixels), 3))
    inverse = unit * camera.K_inverse[:2]
    placed[:, :2] = pixels @ inverse[:, :2].T + inverse[:, 2]
    placed[:, 2] = depth
    return placed


def _seen(points: Array, unit: float | None, depth: float) -> Array:
    """Where the lines of sight of points (n, 3) go through the picture."""
    if unit is not None:
        return np.asarray(points * (1.0, 1.0, 0.0) + (0.0, 0.0, depth))
    return np.asarray(points * (depth / points[:, 2:]))


def _sight(point: Array, unit: float | None, depth: float) -> Array:
    start = np.zeros(3) if unit is None else point * (1.0, 1.0, 0.0)
    return np.stack([start, _seen(point[None], unit, depth)[0], point])
