"""The mathematics of a state."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from geometry import quaternion
from geometry.affine_camera import AffineCamera, weak_perspective
from geometry.arrays import Array
from geometry.camera import Camera, pan_tilt_roll
from geometry.distortion import Distortion
from geometry.projection import decompose, vanishing_points
from sims.camera.frustum import Frustum, frustum
from sims.camera.lens import Lens, pictured
from sims.camera.params import COEFFICIENTS, CameraParams
from sims.kit.frame import inside
from sims.kit.sim import DRAWN
from sims.kit.types import Pixel, Place
from sims.kit.world import DIRECTIONS, MIDDLE, NAMES, PLACES, POINTS, SUBJECT, Role
from sims.kit.world_drawing import Sight


@dataclass(frozen=True)
class NamedPoint:
    """A named point: in the world, in the camera's axes, and in the picture, as far as it has a pixel."""

    name: str
    world: Place
    camera: list[float]
    depth: float
    pixel: Pixel | None
    in_image: bool
    straight: Pixel | None
    """Its pixel without distortion."""


@dataclass(frozen=True)
class Subject:
    """The house's middle; `height`: pixels from its ground to its ridge."""

    world: Place
    depth: float
    pixel: Pixel | None
    height: float | None


@dataclass(frozen=True)
class Decomposed:
    """What P alone tells."""

    K: Array
    R: Array
    center: Array


@dataclass(frozen=True)
class VanishingPoint:
    """Where parallels of one direction of the street meet in the picture."""

    name: str
    role: Role
    homogeneous: list[float] | None
    pixel: Pixel | None
    in_image: bool
    straight: Pixel | None
    """Its pixel without distortion."""


@dataclass(frozen=True)
class CameraSolution:
    """What doesn't exist is None. `center`, `look` and `world` are in the world, the rest in the camera's axes."""

    K: Array
    R: Array
    t: Array
    P: Array | None
    center: Array
    orientation: Array
    """Quaternion of the camera in the world."""
    fov_x: float
    fov_y: float
    points: Sequence[NamedPoint]
    mean_depth: float | None
    """Mean of the named points in front of the camera."""
    scale_depth: float | None
    """The one depth by which weak perspective divides."""
    scale: float | None
    """Pixels of a metre across, in a picture without perspective."""
    distorted: bool
    """Whether the lens bends the picture; pixels of points are those of the bent one."""
    subject: Subject
    decomposed: Decomposed | None
    """None of an affine P, which has no centre."""
    vanishing: Sequence[VanishingPoint]
    """For each direction of the street."""
    frustum: Frustum | None
    reach: float
    """How far the optical axis is drawn; `look`, at its end, is where the grip stands that turns the camera."""
    look: Array
    grip: Array
    """Where the grip stands that moves the camera: above it, where nothing hides it."""
    seen: Sight | None = field(metadata=DRAWN)
    """The picture, as it is shown: `sims.camera.lens`."""
    straight: Sight | None = field(metadata=DRAWN)
    """The same without distortion; None where there is none."""

    def point(self, name: str) -> NamedPoint:
        """One of `points`."""
        return self.points[NAMES.index(name)]


LEAST_DEPTH = 0.05
"""Metres of depth below which weak perspective has no sensible scale."""
LIFT = 0.6
"""Metres by which the grip that moves the camera stands above it."""
BEYOND = 0.5
"""Metres by which the grip that turns the camera stands farther away than the picture."""
PICTURE_WIDTH = 1.2
"""Metres that the picture is wide where it stands in the scene; how far in front follows from the focal length."""
DIRECTION_VECTORS: Array = np.array([way for _, way in DIRECTIONS.values()])
FOLLOWED: Array = np.concatenate([POINTS, [MIDDLE, *SUBJECT]])
"""Named points, and of the subject middle, ground and ridge."""
CameraModel = Camera | AffineCamera


def camera_of(p: CameraParams) -> Camera:
    """The camera of a state, with perspective."""
    R = pan_tilt_roll(math.radians(p.pan), math.radians(p.tilt), math.radians(p.roll))
    T = np.eye(4)
    T[:3, :3] = R.T
    T[:3, 3] = -np.array(p.position).dot(R)
    return Camera.from_intrinsics(p.fx, p.fy, p.cx, p.cy, p.skew, T_camera_world=T)


def lens_of(p: CameraParams, camera: Camera) -> Lens | None:
    """What bends the picture, if anything does."""
    if p.projection != "perspective":
        return None
    distortion = Distortion(*(getattr(p, name) for name in COEFFICIENTS))
    return Lens(camera, distortion) if distortion else None


def solve(p: CameraParams) -> CameraSolution:
    """All the mathematics of a state."""
    camera = camera_of(p)
    axes = camera.to_camera(FOLLOWED)
    in_camera, depth = axes[: len(POINTS)], axes.item(len(POINTS), 2)
    front = in_camera[:, 2] > 0.0
    mean = float(in_camera[front, 2].mean()) if front.any() else None
    model = _camera_model(p, camera, mean, POINTS[front])
    lens = lens_of(p, camera)
    pixels = np.full((len(FOLLOWED), 2), np.nan) if model is None else model.project(FOLLOWED)[0]
    shown = pixels if lens is None else lens.bend_points(pixels)
    points = _points(p, in_camera, pixels[: len(POINTS)], shown[: len(POINTS)])
    vanishing = () if model is None else _vanishing(p, model.P, lens)
    unit = model.depth if isinstance(model, AffineCamera) else None
    straight = None if model is None else pictured(p, model, lens)
    picture_depth = PICTURE_WIDTH * p.fx / p.width
    return CameraSolution(
        K=camera.K,
        R=camera.R,
        t=camera.t,
        P=None if model is None else model.P,
        center=np.array(p.position),
        orientation=quaternion.from_matrix(camera.R.T),
        **dict(zip(("fov_x", "fov_y"), map(math.degrees, camera.fov(p.width, p.height)), strict=True)),
        points=points,
        mean_depth=mean,
        scale_depth=unit if p.projection == "weak" else None,
        scale=None if unit is None else p.fx / unit,
        distorted=lens is not None,
        subject=_subject(shown[len(POINTS) :], depth),
        decomposed=_decomposed(camera) if model is camera else None,
        vanishing=vanishing,
        frustum=None
        if straight is None
        else frustum(p, camera, unit, picture_depth, in_camera, points, vanishing, straight),
        reach=picture_depth + BEYOND,
        look=np.array(p.position) + (picture_depth + BEYOND) * camera.R[2],
        grip=np.add(p.position, (0.0, 0.0, LIFT)),
        seen=straight if straight is None or lens is None else straight.bent(lens.scaled(p).bend),
        straight=None if lens is None else straight,
    )


def _camera_model(p: CameraParams, camera: Camera, mean: float | None, front: Array) -> CameraModel | None:
    """What makes the picture; nothing where weak perspective has no depth to divide by."""
    if p.projection == "perspective":
        return camera
    if p.projection == "orthographic":
        return AffineCamera(camera, p.fx / p.ortho_scale)
    return weak_perspective(camera, front) if mean is not None and mean >= LEAST_DEPTH else None


def _points(p: CameraParams, in_camera: Array, straight: Array, shown: Array) -> tuple[NamedPoint, ...]:
    rows = zip(NAMES, in_camera.tolist(), straight.tolist(), shown.tolist(), strict=True)
    return tuple(
        NamedPoint(name, PLACES[name], axes, axes[2], _existing(u, v), inside(u, v, p.width, p.height), _existing(a, b))
        for name, axes, (a, b), (u, v) in rows
    )


def _existing(u: float, v: float) -> Pixel | None:
    return (u, v) if u == u else None


def _subject(pixels: Array, depth: float) -> Subject:
    (u, v), ground, ridge = pixels.tolist()
    height = math.dist(ground, ridge)
    return Subject(MIDDLE, depth, _existing(u, v), height if height == height else None)


def _decomposed(camera: Camera) -> Decomposed:
    parts = decompose(camera.P)
    return Decomposed(parts.K, parts.R, parts.center)


def _vanishing(p: CameraParams, P: Array, lens: Lens | None) -> tuple[VanishingPoint, ...]:
    homogeneous, pixels = vanishing_points(P, DIRECTION_VECTORS)
    shown = pixels if lens is None else lens.bend_points(pixels)
    rows = zip(DIRECTIONS.items(), homogeneous.tolist(), pixels.tolist(), shown.tolist(), strict=True)
    return tuple(
        VanishingPoint(
            name, role, place if place[0] == place[0] else None,
            _existing(u, v), inside(u, v, p.width, p.height), _existing(a, b),
        )
        for (name, (role, _)), place, (a, b), (u, v) in rows
    )  # fmt: skip
