"""Both cameras, what follows from them alone, and how they see the points that stay where they are."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from geometry import GeometryError, quaternion
from geometry.arrays import Array
from geometry.camera import R_WORLD_LEVEL, Camera
from geometry.epipolar import epipolar_line_left, epipolar_line_right, epipole_pixel, epipoles, essential, normalize
from geometry.rotations import axis_rotation
from sims.epipolar.drawing import Segments, chords, distance, drawn_size, spots
from sims.epipolar.params import CENTER, OTHERS, EpipolarParams, Pixel, Place
from sims.kit.types import Quaternion

RANK_TOLERANCE = 1e-12


@dataclass(frozen=True, eq=False)
class Pair:
    """Both cameras and their epipolar geometry: None where there is no baseline."""

    left: Camera
    right: Camera
    wxyz: tuple[Quaternion, Quaternion]
    """Orientations of the left and the right camera, in the world."""
    F: Array | None = None
    E: Array | None = None
    rank: int | None = None
    singular_values: Array | None = None
    epipole_left: Array | None = None
    epipole_right: Array | None = None
    epipole_left_pixel: Pixel | None = None
    epipole_right_pixel: Pixel | None = None


@dataclass(frozen=True, eq=False)
class Views:
    """The points that are seen, first the one that is held: pixels (n, 2), NaN behind the camera, and lines (n, 3)."""

    pixels_left: Array
    pixels_right: Array
    lines_left: Array | None
    lines_right: Array | None


# ---- the cameras
@lru_cache(maxsize=256)
def camera(center: Place, pan: float, focal: float) -> Camera:
    """A level camera at a place in metres, turned by degrees about the vertical."""
    R = (axis_rotation("z", math.radians(pan)) @ R_WORLD_LEVEL).T
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, -R @ center
    return Camera.from_intrinsics(focal, focal, *CENTER, T_camera_world=T)


@lru_cache(maxsize=256)
def _orientation(pan: float) -> Quaternion:
    """The axes of a level camera that is turned by degrees about the vertical, in the world."""
    turned = axis_rotation("z", math.radians(pan)) @ R_WORLD_LEVEL
    w, x, y, z = quaternion.from_matrix(turned).tolist()
    return w, x, y, z


@lru_cache(maxsize=256)
def pair(left: Place, right: Place, left_pan: float, right_pan: float, focal: float) -> Pair:
    """Both cameras, and their epipolar geometry if they have any."""
    first, second = camera(left, left_pan, focal), camera(right, right_pan, focal)
    return related(first, second, (_orientation(left_pan), _orientation(right_pan)))


def related(first: Camera, second: Camera, turned: tuple[Quaternion, Quaternion]) -> Pair:
    """Two cameras with their orientations, and their epipolar geometry if they have any."""
    try:
        E = normalize(essential(first, second))
    except GeometryError:  # both at one place
        return Pair(first, second, turned)
    F = normalize(second.K_inverse.T @ E @ first.K_inverse)
    values = np.asarray(np.linalg.svd(F, compute_uv=False), dtype=np.float64)
    ends = epipoles(F)
    return Pair(
        first, second, turned, F, E, int((values > RANK_TOLERANCE * values[0]).sum()), values, *ends,
        *(existing(epipole_pixel(end)) for end in ends),
    )  # fmt: skip


@lru_cache(maxsize=256)
def views(left: Place, right: Place, left_pan: float, right_pan: float, focal: float, count: int) -> Views:
    """The first of the points that stay where they are."""
    both = pair(left, right, left_pan, right_pan, focal)
    u, v = (c.project(OTHERS[:count])[0] for c in (both.left, both.right))
    if both.F is None:
        return Views(u, v, None, None)
    return Views(u, v, epipolar_line_left(both.F, v), epipolar_line_right(both.F, u))


@lru_cache(maxsize=256)
def other_drawings(
    left: Place, right: Place, left_pan: float, right_pan: float, focal: float, count: int, lines: bool
) -> tuple[tuple[Array, Segments], ...]:
    """What lies on the left and the right picture in the scene of the points that stay where they are."""
    seen = views(left, right, left_pan, right_pan, focal, count)
    near = distance(focal, drawn_size(math.dist(left, right)))
    sides = (seen.pixels_left, seen.lines_left), (seen.pixels_right, seen.lines_right)
    return tuple(
        (spots(pixels, focal, near), chords(all_lines, focal, near) if lines and all_lines is not None else ())
        for pixels, all_lines in sides
    )


def right_line(p: EpipolarParams) -> Array | None:
    """The line of p in the right picture; None where there is none."""
    both = pair(p.left, p.right, p.left_pan, p.right_pan, p.focal)
    left, _ = both.left.project(p.point)
    return None if both.F is None else existing_line(epipolar_line_right(both.F, left))


def existing(pixel: Array) -> Pixel | None:
    """A pixel, or None where it isn't finite."""
    u, v = pixel.tolist()
    return (u, v) if math.isfinite(u + v) else None


def existing_line(line: Array) -> Array | None:
    """A line, or None where there is none."""
    return line if math.isfinite(line.item(0)) else None
