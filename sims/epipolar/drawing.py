"""Where things are in the scene: what lies on a camera's picture, in that camera's axes, and the epipolar plane."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from geometry.arrays import Array
from geometry.camera import Camera
from sims.epipolar.params import CENTER, Pixel, Place
from sims.kit.frame import HEIGHT, WIDTH, across, inside

PICTURE_WIDTH = 0.9
"""Metres that a picture is wide where it stands in the scene, when there is room."""
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


def distance(focal: float, size: float) -> float:
    """Metres from a centre to its picture in the scene."""
    return PICTURE_WIDTH * size * focal / WIDTH


@lru_cache(maxsize=256)
def corners(focal: float, size: float) -> Array:
    """Corners of a picture, (4, 3), in its camera's axes."""
    upright = Camera.from_intrinsics(focal, focal, *CENTER, T_camera_world=np.eye(4))
    return upright.frustum_corners(WIDTH, HEIGHT, distance(focal, size))


def on_picture(u: float, v: float, focal: float, near: float) -> Place:
    """A pixel as a place on the picture in the scene."""
    return (u - CENTER[0]) / focal * near, (v - CENTER[1]) / focal * near, near


def chord(line: Sequence[float], focal: float, near: float) -> Segment | None:
    """What a picture holds of a line."""
    ends = across(line, WIDTH, HEIGHT)
    if ends is None:
        return None
    (a, b), (c, d) = ends
    return on_picture(a, b, focal, near), on_picture(c, d, focal, near)


def chords(lines: Array, focal: float, near: float) -> Segments:
    """What a picture holds of lines (n, 3)."""
    found = [chord(line, focal, near) for line in lines.tolist()]
    return tuple(piece for piece in found if piece is not None)


def camera_drawing(
    center: Place, wxyz: tuple[float, ...], focal: float, size: float, *, pixel: Pixel | None, line: Array | None,
    picked: Array | None, epipole: Array | None, others: Array, all_lines: Segments,
) -> CameraDrawing:  # fmt: skip
    """What one camera shows: of the held point its pixel and its line, of the other points what is drawn already."""
    near = distance(focal, size)
    piece, chosen = (None if l is None else chord(l.tolist(), focal, near) for l in (line, picked))
    end = None if epipole is None else _epipole(epipole.tolist(), focal, near)
    return CameraDrawing(
        wxyz=wxyz,
        center=center,
        size=size,
        corners=corners(focal, size),
        pixel=None if pixel is None or not in_picture(*pixel) else on_picture(*pixel, focal, near),
        others=others,
        line=piece,
        stretch=None if piece is None or end is None else _stretch(piece, end, focal, near),
        all_lines=all_lines,
        picked_line=chosen,
        epipole=end,
    )


def in_picture(u: float, v: float) -> bool:
    """Whether a pixel is within a picture's edges."""
    return inside(u, v, WIDTH, HEIGHT)


def spots(pixels: Array, focal: float, near: float) -> Array:
    """Those pixels (n, 2) that are in the picture, as places on it."""
    inside = (np.abs(pixels - np.array([WIDTH - 1, HEIGHT - 1]) / 2.0) <= np.array([WIDTH, HEIGHT]) / 2.0).all(axis=1)
    flat = (pixels[inside] - CENTER) * (near / focal)
    return np.column_stack([flat, np.full(len(flat), near)])


def _epipole(epipole: Sequence[float], focal: float, near: float) -> Place | None:
    u, v, w = epipole
    x, y = (u - w * CENTER[0]) * near / focal, (v - w * CENTER[1]) * near / focal
    if math.hypot(x, y, w * near) > REACH * abs(w):
        return None
    return x / w, y / w, near


def _stretch(piece: Segment, end: Place, focal: float, near: float) -> Segment | None:
    u, v = (at * focal / near + c for at, c in zip(end, CENTER, strict=False))
    if in_picture(u, v):
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
