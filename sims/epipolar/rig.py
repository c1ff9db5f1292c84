"""What follows from both cameras alone, and how they see the points that stay where they are."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from geometry import GeometryError
from geometry.arrays import Array
from geometry.camera import Camera
from geometry.epipolar import epipolar_line_left, epipolar_line_right, epipole_pixel, epipoles, essential, normalize
from sims.epipolar.drawing import Segments, chords, distance, drawn_size, spots
from sims.epipolar.eye import eyes
from sims.epipolar.params import OTHERS, EpipolarParams, Pixel
from sims.kit.stereo import Eye, camera

RANK_TOLERANCE = 1e-12


@dataclass(frozen=True, eq=False)
class Pair:
    """Both cameras and their epipolar geometry: None where there is no baseline."""

    left: Camera
    right: Camera
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


@lru_cache(maxsize=256)
def pair(left: Eye, right: Eye) -> Pair:
    """Both cameras, and their epipolar geometry if they have any."""
    first, second = camera(left), camera(right)
    try:
        E = normalize(essential(first, second))
    except GeometryError:  # both at one place
        return Pair(first, second)
    F = normalize(second.K_inverse.T @ E @ first.K_inverse)
    values = np.asarray(np.linalg.svd(F, compute_uv=False), dtype=np.float64)
    ends = epipoles(F)
    return Pair(
        first, second, F, E, int((values > RANK_TOLERANCE * values[0]).sum()), values, *ends,
        *(existing(epipole_pixel(end)) for end in ends),
    )  # fmt: skip


@lru_cache(maxsize=256)
def views(left: Eye, right: Eye, count: int) -> Views:
    """The first of the points that stay where they are."""
    both = pair(left, right)
    u, v = (c.project(OTHERS[:count])[0] for c in (both.left, both.right))
    if both.F is None:
        return Views(u, v, None, None)
    return Views(u, v, epipolar_line_left(both.F, v), epipolar_line_right(both.F, u))


@lru_cache(maxsize=256)
def other_drawings(left: Eye, right: Eye, count: int, lines: bool) -> tuple[tuple[Array, Segments], ...]:
    """What lies on the left and the right picture in the scene of the points that stay where they are."""
    seen, size = views(left, right, count), drawn_size(math.dist(left.center, right.center))
    sides = (left, seen.pixels_left, seen.lines_left), (right, seen.pixels_right, seen.lines_right)
    return tuple(
        (
            spots(pixels, eye, distance(eye, size)),
            chords(all_lines, eye, distance(eye, size)) if lines and all_lines is not None else (),
        )
        for eye, pixels, all_lines in sides
    )


def right_line(p: EpipolarParams) -> Array | None:
    """The line of p in the right picture; None where there is none."""
    both = pair(*eyes(p))
    left, _ = both.left.project(p.point)
    return None if both.F is None else existing_line(epipolar_line_right(both.F, left))


def existing(pixel: Array) -> Pixel | None:
    """A pixel, or None where it isn't finite."""
    u, v = pixel.tolist()
    return (u, v) if math.isfinite(u + v) else None


def existing_line(line: Array) -> Array | None:
    """A line, or None where there is none."""
    return line if math.isfinite(line.item(0)) else None
