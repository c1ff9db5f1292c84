"""Where things are in the scene: what lies on a camera's picture, in that camera's axes, and the epipolar plane."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from geometry.arrays import Array
from geometry.camera import Camera
from sims.epipolar.params import Pixel, Place
from sims.kit.frame import across
from sims.kit.stereo import Eye, orientation

PICTURE_WIDTH = 0.9
"""Metres that a picture is wide where it stands in the scene, when there is room."""
DEEPEST = 2.2
"""Metres that it stands before its camera at most: through long lenses it is smaller."""
ROOM, LEAST = 1.1, 0.3
"""Metres of baseline from which on there is room; how small cameras may become, as a part of their full size."""
REACH = 4.0
"""Metres beyond which an epipole isn't drawn on the plane of its picture."""
BESIDE, BEYOND = 0.35, 1.1
"""How far the plane goes beyond what it holds, along the baseline as part of it, and beyond the point."""
NARROWEST = 1.5
"""Metres that the plane is wide at least: of a point near the baseline it would be a thin strip."""
Segment = tuple[Place, Place]
Segments = tuple[Segment, ...]


@dataclass(frozen=True, eq=False)
class CameraDrawing:
    """One camera: its pose, and in its own axes (x right, y down, z forward, metres) what lies on its picture."""

    wxyz: tuple[float, ...]
    center: Place
    up: tuple[float, ...]
    """The world's Z."""
    size: float
    corners: Array
    pixel: Place | None
    others: Array
    line: Segment | None
    stretch: Segment | None
    """The rest of the line, from the picture to the epipole."""
    all_lines: Segments
    """Lines of the other points."""
    picked_line: Segment | None
    epipole: Place | None


@dataclass(frozen=True, eq=False)
class Drawing:
    """Both cameras; in the world the corners (4, 3) of the piece of the epipolar plane that is shown, and a ray."""

    left: CameraDrawing
    right: CameraDrawing
    plane: Array | None
    picked_ray: Segment | None


def drawn_size(baseline: float) -> float:
    """How large cameras are drawn, so that two of them have room; in steps, so that bodies needn't change each time."""
    return max(round(20.0 * min(baseline / ROOM, 1.0)) / 20.0, LEAST)


def distance(eye: Eye, size: float) -> float:
    """Metres from a centre to its picture in the scene."""
    return size * min(PICTURE_WIDTH * eye.lens[0] / eye.size[0], DEEPEST)


@lru_cache(maxsize=256)
def corners(eye: Eye, size: float) -> Array:
    """Corners of a picture, (4, 3), in its camera's axes."""
    upright = Camera.from_intrinsics(*eye.lens, T_camera_world=np.eye(4))
    return upright.frustum_corners(*eye.size, distance(eye, size))


def on_picture(u: float, v: float, eye: Eye, near: float) -> Place:
    """A pixel as a place on the picture in the scene."""
    fx, fy, cx, cy = eye.lens
    return (u - cx) / fx * near, (v - cy) / fy * near, near


def chord(line: Sequence[float], eye: Eye, near: float) -> Segment | None:
    """What a picture holds of a line."""
    ends = across(line, *eye.size)
    if ends is None:
        return None
    (a, b), (c, d) = ends
    return on_picture(a, b, eye, near), on_picture(c, d, eye, near)


def chords(lines: Array, eye: Eye, near: float) -> Segments:
    """What a picture holds of lines (n, 3)."""
    found = [chord(line, eye, near) for line in lines.tolist()]
    return tuple(piece for piece in found if piece is not None)


def camera_drawing(
    eye: Eye, size: float, *, pixel: Pixel | None, line: Array | None, picked: Array | None, epipole: Array | None,
    others: Array, all_lines: Segments,
) -> CameraDrawing:  # fmt: skip
    """What one camera shows: of the held point its pixel and its line, of the other points what is drawn already."""
    near = distance(eye, size)
    piece, chosen = (None if l is None else chord(l.tolist(), eye, near) for l in (line, picked))
    end = None if epipole is None else _epipole(epipole.tolist(), eye, near)
    return CameraDrawing(
        wxyz=orientation(eye.R),
        center=eye.center,
        up=eye.R[6:],
        size=size,
        corners=corners(eye, size),
        pixel=None if pixel is None or not eye.shows(*pixel) else on_picture(*pixel, eye, near),
        others=others,
        line=piece,
        stretch=None if piece is None or end is None else _stretch(piece, end, eye, near),
        all_lines=all_lines,
        picked_line=chosen,
        epipole=end,
    )


def spots(pixels: Array, eye: Eye, near: float) -> Array:
    """Those pixels (n, 2) that are in the picture, as places on it."""
    inside = (np.abs(pixels - np.array(eye.last) / 2.0) <= np.array(eye.size) / 2.0).all(axis=1)
    flat = (pixels[inside] - eye.lens[2:]) * (near / np.array(eye.lens[:2]))
    return np.column_stack([flat, np.full(len(flat), near)])


def _epipole(epipole: Sequence[float], eye: Eye, near: float) -> Place | None:
    u, v, w = epipole
    fx, fy, cx, cy = eye.lens
    x, y = (u - w * cx) * near / fx, (v - w * cy) * near / fy
    if math.hypot(x, y, w * near) > REACH * abs(w):
        return None
    return x / w, y / w, near


def _stretch(piece: Segment, end: Place, eye: Eye, near: float) -> Segment | None:
    fx, fy, cx, cy = eye.lens
    if eye.shows(end[0] * fx / near + cx, end[1] * fy / near + cy):
        return None
    return min(piece, key=lambda at: math.dist(at, end)), end


def plane(left: Place, right: Place, point: Place) -> Array:
    """A piece of the epipolar plane: a parallelogram with the baseline and the point in it, which leans at most 45°."""
    a, b, x = np.array((left, right, point))
    baseline = math.dist(left, right)
    along = (b - a) / baseline
    foot = float(along @ (x - a))
    across = x - a - foot * along
    away = math.hypot(*across.tolist())
    lean = min(max(foot - 0.5 * baseline, -away), away)
    side = (across + lean * along) / away
    spare = max(0.5 * (NARROWEST - away), 0.0)
    first, last = (end(mid, foot - lean) for end, mid in ((min, 0.0), (max, baseline)))
    first, last = first - BESIDE * baseline, last + BESIDE * baseline
    near, far = a - spare * side, a + (BEYOND * away + spare) * side
    return np.array([near + first * along, near + last * along, far + last * along, far + first * along])
