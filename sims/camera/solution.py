"""Parameters of the sim, and the mathematics of a state."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from geometry import quaternion
from geometry.affine_camera import AffineCamera, weak_perspective
from geometry.arrays import Array
from geometry.camera import Camera, pan_tilt_roll
from geometry.projection import clip_segments, decompose, frame_planes, vanishing_points
from sims.camera.params import CameraParams, Pixel
from sims.camera.world import DIRECTIONS, MIDDLE, NAMES, PLACES, POINTS, SUBJECT, WIRES, Place, Role
from sims.kit.frame import HEIGHT, WIDTH, inside


@dataclass(frozen=True)
class NamedPoint:
    """A named point: in the world, in the camera's axes, and in the picture, as far as it has a pixel."""

    name: str
    world: Place
    camera: list[float]
    depth: float
    pixel: Pixel | None
    in_image: bool


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
    mean_depth: float
    scale_depth: float | None
    """The one depth by which a picture without perspective divides."""
    subject: Subject
    decomposed: Decomposed | None
    """None of an affine P, which has no centre."""
    vanishing: Sequence[VanishingPoint]
    """For each direction of the street."""
    wires: Array
    """Edges (n, 2, 2) in the picture, in pixels, cut off at its frame and at the camera's plane."""
    shown: npt.NDArray[np.intp]
    """Numbers (n,) of those edges in the world."""
    frustum: Frustum | None
    reach: float
    """How far the optical axis is drawn; `look`, at its end, is where the grip stands that turns the camera."""
    look: Array
    grip: Array
    """Where the grip stands that moves the camera: above it, where nothing hides it."""

    def point(self, name: str) -> NamedPoint:
        """One of `points`."""
        return self.points[NAMES.index(name)]


@dataclass(frozen=True)
class Frustum:
    """What the picture can show of space, and the picture as it stands there; all in the camera's axes, in metres."""

    depth: float
    """How far the picture is away."""
    corners: Array
    """Corners of the picture (4, 3): top left, top right, bottom right, bottom left."""
    back: Array
    """Where the lines of sight through them come from (4, 3): the centre, or the camera's plane."""
    far: Array | None
    """Without perspective: where sizes are true (4, 3)."""
    wires: Array
    """Edges (n, 2, 3) of the picture."""
    dots: Array
    """Named points (m, 3) in the picture."""
    rays: Array
    """Lines of sight (m, 2, 3) from the camera to those points."""
    chosen: Array | None
    """Line of sight (3, 3) of the selected point: where it comes from, its place in the picture, the point."""
    meet: Array
    """Vanishing points (3, 3) in the picture; the centre for those that aren't in it."""


PICTURE_WIDTH = 1.2
"""Metres that the picture is wide where it stands in the scene; how far in front follows from the focal length."""
NEAREST = 1e-6
"""Metres of depth from which on the picture shows edges."""
LEAST_DEPTH = 0.05
"""Metres of depth below which a picture without perspective has no sensible scale."""
LIFT = 0.6
"""Metres by which the grip that moves the camera stands above it."""
BEYOND = 0.5
"""Metres by which the grip that turns the camera stands farther away than the picture."""
DIRECTION_VECTORS: Array = np.array([way for _, way in DIRECTIONS.values()])
FOLLOWED: Array = np.concatenate([POINTS, [MIDDLE, *SUBJECT]])
"""Named points, and of the subject middle, ground and ridge."""
CORNERS: Array = np.array([(-0.5, -0.5), (WIDTH - 0.5, -0.5), (WIDTH - 0.5, HEIGHT - 0.5), (-0.5, HEIGHT - 0.5)])
CameraModel = Camera | AffineCamera


def camera_of(p: CameraParams) -> Camera:
    """The camera of a state, with perspective."""
    R = pan_tilt_roll(math.radians(p.pan), math.radians(p.tilt), math.radians(p.roll))
    T = np.eye(4)
    T[:3, :3] = R.T
    T[:3, 3] = -np.array(p.position).dot(R)
    return Camera.from_intrinsics(p.fx, p.fy, p.cx, p.cy, p.skew, T_camera_world=T)


def solve(p: CameraParams) -> CameraSolution:
    """All the mathematics of a state."""
    camera = camera_of(p)
    axes = camera.to_camera(FOLLOWED)
    in_camera, depth = axes[: len(POINTS)], axes.item(len(POINTS), 2)
    mean = float(in_camera[:, 2].sum()) / len(POINTS)
    model, scale = _camera_model(p, camera, {"weak": mean, "orthographic": depth}.get(p.projection))
    pixels, wires, shown = _pictured(model, camera)
    points = _points(in_camera, pixels[: len(POINTS)])
    vanishing = () if model is None else _vanishing(model.P)
    finite = model is camera
    picture_depth = PICTURE_WIDTH * p.fx / WIDTH
    return CameraSolution(
        K=camera.K,
        R=camera.R,
        t=camera.t,
        P=None if model is None else model.P,
        center=np.array(p.position),
        orientation=quaternion.from_matrix(camera.R.T),
        **dict(zip(("fov_x", "fov_y"), map(math.degrees, camera.fov(WIDTH, HEIGHT)), strict=True)),
        points=points,
        mean_depth=mean,
        scale_depth=scale,
        subject=_subject(pixels[len(POINTS) :], depth),
        decomposed=_decomposed(camera) if finite else None,
        vanishing=vanishing,
        wires=wires,
        shown=shown,
        frustum=None
        if model is None
        else _frustum(p, camera, scale, picture_depth, points, in_camera, wires, vanishing),
        reach=picture_depth + BEYOND,
        look=np.array(p.position) + (picture_depth + BEYOND) * camera.R[2],
        grip=np.add(p.position, (0.0, 0.0, LIFT)),
    )


def _camera_model(p: CameraParams, camera: Camera, scale: float | None) -> tuple[CameraModel | None, float | None]:
    """What makes the picture, and the one depth by which it divides; neither where that depth makes no sense."""
    if p.projection == "perspective":
        return camera, None
    if scale is None or scale < LEAST_DEPTH:
        return None, None
    return weak_perspective(camera, POINTS) if p.projection == "weak" else AffineCamera(camera, scale), scale


def _points(in_camera: Array, pixels: Array) -> tuple[NamedPoint, ...]:
    rows = zip(NAMES, in_camera.tolist(), pixels.tolist(), strict=True)
    return tuple(
        NamedPoint(name, PLACES[name], axes, axes[2], _existing(u, v), inside(u, v, WIDTH, HEIGHT))
        for name, axes, (u, v) in rows
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


def _vanishing(P: Array) -> tuple[VanishingPoint, ...]:
    homogeneous, pixels = vanishing_points(P, DIRECTION_VECTORS)
    rows = zip(DIRECTIONS.items(), homogeneous.tolist(), pixels.tolist(), strict=True)
    return tuple(
        VanishingPoint(
            name, role, place if place[0] == place[0] else None, _existing(u, v), inside(u, v, WIDTH, HEIGHT)
        )
        for (name, (role, _)), place, (u, v) in rows
    )


def _pictured(model: CameraModel | None, camera: Camera) -> tuple[Array, Array, npt.NDArray[np.intp]]:
    """Pixels of what is followed (n, 2), edges in the picture (m, 2, 2), and their numbers in the world (m,)."""
    if model is None:
        return np.full((len(FOLLOWED), 2), np.nan), np.empty((0, 2, 2)), np.empty(0, int)
    plane = np.append(camera.R[2], camera.t[2] - NEAREST)
    parts, exists = clip_segments(WIRES, np.vstack([frame_planes(model.P, WIDTH, HEIGHT), plane]))
    pixels, _ = model.project(np.concatenate([FOLLOWED, parts[exists].reshape(-1, 3)]))
    return pixels[: len(FOLLOWED)], pixels[len(FOLLOWED) :].reshape(-1, 2, 2), np.flatnonzero(exists)


def _frustum(
    p: CameraParams, camera: Camera, scale: float | None, depth: float,
    points: Sequence[NamedPoint], in_camera: Array, wires: Array, vanishing: Sequence[VanishingPoint],
) -> Frustum:  # fmt: skip
    """The picture stands at `depth`; there a pixel is as far from the axis as its line of sight is."""
    seen = [k for k, point in enumerate(points) if point.in_image]
    chosen = points[NAMES.index(p.selected)]
    meets = [v.pixel if v.pixel and v.in_image else (math.nan, math.nan) for v in vanishing]
    pixels = [pixel for k in seen if (pixel := points[k].pixel)]
    flat = np.concatenate([CORNERS, np.reshape(pixels, (-1, 2)), meets, [chosen.pixel or (math.nan, math.nan)]])
    placed = _placed(camera, np.concatenate([flat, wires.reshape(-1, 2)]), scale or depth, depth)
    corners, dots, rest = placed[:4], placed[4 : 4 + len(seen)], placed[4 + len(seen) :]
    targets, meet = in_camera[seen], rest[:3]
    meet[np.isnan(meet[:, 0])] = 0.0
    starts = np.zeros_like(targets) if scale is None else targets * (1.0, 1.0, 0.0)
    return Frustum(
        depth=depth,
        corners=corners,
        back=np.zeros((4, 3)) if scale is None else corners * (1.0, 1.0, 0.0),
        far=None if scale is None else corners * (1.0, 1.0, scale / depth),
        wires=rest[4:].reshape(-1, 2, 3),
        dots=dots,
        rays=np.stack([starts, targets], axis=1),
        chosen=_sight(rest[3], np.array(chosen.camera), scale) if chosen.pixel else None,
        meet=meet,
    )


def _placed(camera: Camera, pixels: Array, unit: float, depth: float) -> Array:
    """Pixels (n, 2) on the picture as it stands in the scene (n, 3)."""
    placed = np.empty((len(pixels), 3))
    inverse = unit * camera.K_inverse[:2]
    placed[:, :2] = pixels @ inverse[:, :2].T + inverse[:, 2]
    placed[:, 2] = depth
    return placed


def _sight(dot: Array, point: Array, scale: float | None) -> Array:
    start = np.zeros(3) if scale is None else point * (1.0, 1.0, 0.0)
    return np.stack([start, dot, point])
