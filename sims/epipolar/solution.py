"""The mathematics of a state: both cameras, F and what follows from it, and where all of it is drawn."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np

from geometry import GeometryError, quaternion
from geometry.arrays import Array
from geometry.camera import R_WORLD_LEVEL, Camera
from geometry.eight_point import FEWEST, eight_point
from geometry.epipolar import (
    epipolar_line_left,
    epipolar_line_right,
    epipolar_residual,
    epipole_pixel,
    epipoles,
    essential,
    fundamental,
    normalize,
    sampson_distance,
)
from geometry.rotations import axis_rotation
from geometry.triangulation import pixel_noise
from sims.epipolar.drawn import Drawn, Segment, Segments, chords, distance, drawn_size, eye_drawn, plane, spots
from sims.epipolar.model import CENTER, OTHERS, EpipolarParams, Pixel, Place, Side, read_pick
from sims.kit.stage import Quaternion

RANK_TOLERANCE = 1e-12
EXACT = 1e-9
"""Angle, in radians, below which the 3D point counts as being on the baseline."""
FAR = 9.0
"""Metres that the ray of a picked pixel is drawn."""


@dataclass(frozen=True, eq=False)
class Pair:
    """Both cameras and their epipolar geometry: None where there is no baseline."""

    left: Camera
    right: Camera
    wxyz: tuple[Quaternion, Quaternion]
    """Of the left and the right camera, in the world."""
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


@dataclass(frozen=True, eq=False)
class Picked:
    """The pixel that the learner chose, its line in the other picture, and a piece of its ray in the world."""

    side: Side
    pixel: Pixel
    line: Array | None
    ray: Segment


@dataclass(frozen=True, eq=False)
class Estimate:
    """F from the pixels of the points with noise, and how far pixels are from each F: root mean square, in pixels."""

    status: Literal["few", "ambiguous", "found"]
    seen: int
    measured_left: Array
    measured_right: Array
    conditioning: float | None = None
    F: Array | None = None
    singular_values: Array | None = None
    line_right: Array | None = None
    line_left: Array | None = None
    noisy_rms: float | None = None
    exact_rms: float | None = None
    noisy_rms_true: float | None = None
    difference: float | None = None
    """Frobenius norm of the difference of Kᵀ F K from E, both of norm 1: in pixels F's entries don't compare."""


@dataclass(frozen=True, eq=False)
class EpipolarSolution:
    """What doesn't exist is None. Pixels and lines without a number are those of the 3D point."""

    K: Array
    P_left: Array
    P_right: Array
    F: Array | None
    E: Array | None
    rank: int | None
    singular_values: Array | None
    epipole_left: Array | None
    epipole_right: Array | None
    epipole_left_pixel: Pixel | None
    epipole_right_pixel: Pixel | None
    pixel_left: Pixel | None
    pixel_right: Pixel | None
    line_left: Array | None
    line_right: Array | None
    residual: float | None
    sampson: float | None
    baseline: float
    points: Array
    pixels_left: Array
    pixels_right: Array
    lines_left: Array | None
    lines_right: Array | None
    depth_left: float
    depth_right: float
    on_baseline: bool
    picked: Picked | None
    estimate: Estimate
    drawn: Drawn


def solve(p: EpipolarParams) -> EpipolarSolution:
    """All the mathematics of a state."""
    rig = p.left, p.right, p.left_pan, p.right_pan, p.focal
    both, others = pair(*rig), views(*rig, p.points - 1)
    (left, depth_left), (right, depth_right) = (camera.project(p.point) for camera in (both.left, both.right))
    pixel_left, pixel_right = existing(left), existing(right)
    aligned = both.F is not None and _aligned(p)
    lines: tuple[Array | None, Array | None] = None, None
    if both.F is not None and not aligned:
        lines = _line(epipolar_line_left(both.F, right)), _line(epipolar_line_right(both.F, left))
    match = None if both.F is None or pixel_left is None or pixel_right is None else (both.F, left, right)
    together = _with_first(left, right, *lines, others)
    picked = None if p.pick is None else _picked(both, p.pick)
    return EpipolarSolution(
        K=both.left.K,
        P_left=both.left.P,
        P_right=both.right.P,
        F=both.F,
        E=both.E,
        rank=both.rank,
        singular_values=both.singular_values,
        epipole_left=both.epipole_left,
        epipole_right=both.epipole_right,
        epipole_left_pixel=both.epipole_left_pixel,
        epipole_right_pixel=both.epipole_right_pixel,
        pixel_left=pixel_left,
        pixel_right=pixel_right,
        line_left=lines[0],
        line_right=lines[1],
        residual=None if match is None else float(epipolar_residual(*match)),
        sampson=None if match is None else _number(sampson_distance(*match)),
        baseline=math.dist(p.left, p.right),
        points=world_points(p.point, p.points),
        pixels_left=together.pixels_left,
        pixels_right=together.pixels_right,
        lines_left=together.lines_left,
        lines_right=together.lines_right,
        depth_left=float(depth_left),
        depth_right=float(depth_right),
        on_baseline=aligned,
        picked=picked,
        estimate=_estimate(p, both, together),
        drawn=_drawn(p, both, (pixel_left, pixel_right), lines, picked, aligned),
    )


def _drawn(
    p: EpipolarParams, both: Pair, pixels: tuple[Pixel | None, Pixel | None], lines: tuple[Array | None, Array | None],
    picked: Picked | None, aligned: bool,
) -> Drawn:  # fmt: skip
    size = drawn_size(math.dist(p.left, p.right))
    still = other_drawings(p.left, p.right, p.left_pan, p.right_pan, p.focal, p.points - 1, p.show_all_lines)
    eyes = [
        eye_drawn(
            center, wxyz, p.focal, size, pixel=pixel, line=line, epipole=epipole, others=others, all_lines=chords,
            picked=picked.line if picked is not None and picked.side != side else None,
        )
        for side, center, wxyz, pixel, line, epipole, (others, chords) in zip(
            ("left", "right"), (p.left, p.right), both.wxyz, pixels, lines,
            (both.epipole_left, both.epipole_right), still, strict=True,
        )
    ]  # fmt: skip
    sheet = None if both.F is None or aligned else plane(p.left, p.right, p.point)
    return Drawn(eyes[0], eyes[1], sheet, None if picked is None else picked.ray)


# ---- the cameras


@lru_cache(maxsize=256)
def camera(center: Place, pan: float, focal: float) -> Camera:
    """A level camera at a place in metres, turned by degrees about the vertical."""
    R = (axis_rotation("z", math.radians(pan)) @ R_WORLD_LEVEL).T
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, -R @ center
    return Camera.from_intrinsics(focal, focal, *CENTER, T_camera_world=T)


def _orientation(camera: Camera) -> Quaternion:
    w, x, y, z = quaternion.from_matrix(camera.R.T).tolist()
    return w, x, y, z


@lru_cache(maxsize=256)
def pair(left: Place, right: Place, left_pan: float, right_pan: float, focal: float) -> Pair:
    """Both cameras, and their epipolar geometry if they have any."""
    first, second = camera(left, left_pan, focal), camera(right, right_pan, focal)
    turned = _orientation(first), _orientation(second)
    try:
        F, E = fundamental(first, second), normalize(essential(first, second))
    except GeometryError:  # both at one place
        return Pair(first, second, turned)
    values: Array = np.linalg.svd(F, compute_uv=False)
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


def _with_first(left: Array, right: Array, line_left: Array | None, line_right: Array | None, others: Views) -> Views:
    """The point that is held, and the others."""

    def joined(first: Array | None, rest: Array | None) -> Array | None:
        if rest is None:
            return None
        return np.concatenate([NO_LINE if first is None else first[None], rest])

    return Views(
        np.concatenate([left[None], others.pixels_left]),
        np.concatenate([right[None], others.pixels_right]),
        joined(line_left, others.lines_left),
        joined(line_right, others.lines_right),
    )


NO_LINE: Array = np.full((1, 3), math.nan)


def world_points(point: Place, count: int) -> Array:
    """The points that are shown, (count, 3)."""
    return np.concatenate([[point], OTHERS[: count - 1]])


def _aligned(p: EpipolarParams) -> bool:
    """Whether the point is on the line through both centres: then there is no single epipolar plane."""
    (ax, ay, az), (bx, by, bz) = ([a - b for a, b in zip(end, p.left, strict=True)] for end in (p.point, p.right))
    crossed = math.hypot(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)
    return crossed <= EXACT * math.hypot(ax, ay, az) * math.hypot(bx, by, bz)


def _picked(both: Pair, pick: str) -> Picked:
    side, pixel = read_pick(pick)
    eye = both.left if side == "left" else both.right
    line = None
    if both.F is not None:
        line = _line((epipolar_line_right if side == "left" else epipolar_line_left)(both.F, pixel))
    start, along = eye.pixel_ray(pixel)
    (x, y, z), (a, b, c) = start.tolist(), (start + FAR * along).tolist()
    return Picked(side, pixel, line, ((x, y, z), (a, b, c)))


# ---- F from the points


@lru_cache(maxsize=64)
def _unit_noise(seed: int) -> Array:
    return pixel_noise(len(OTHERS) + 1, seed)


def _estimate(p: EpipolarParams, both: Pair, seen: Views) -> Estimate:
    noise = p.noise * _unit_noise(p.seed)[: p.points]
    left, right = seen.pixels_left + noise[:, 0], seen.pixels_right + noise[:, 1]
    both_see = np.isfinite(left[:, 0] + right[:, 0])
    count = int(both_see.sum())
    if count < FEWEST:
        return Estimate("few", count, left, right)
    found = eight_point(left[both_see], right[both_see])
    if not found.unique:
        return Estimate("ambiguous", count, left, right, found.conditioning)
    noisy, exact = (left, right), (seen.pixels_left, seen.pixels_right)
    pixel_left, pixel_right = exact[0][0], exact[1][0]
    return Estimate(
        "found", count, left, right, found.conditioning, found.F, found.singular_values,
        line_right=_line(epipolar_line_right(found.F, pixel_left)),
        line_left=_line(epipolar_line_left(found.F, pixel_right)),
        noisy_rms=_rms(found.F, *noisy),
        exact_rms=_rms(found.F, *exact),
        noisy_rms_true=None if both.F is None else _rms(both.F, *noisy),
        difference=None if both.E is None else _difference(normalize(both.left.K.T @ found.F @ both.left.K), both.E),
    )  # fmt: skip


def _rms(F: Array, left: Array, right: Array) -> float:
    squares = sampson_distance(F, left, right) ** 2
    return math.sqrt(float(np.nanmean(squares)))


def _difference(matrix: Array, other: Array) -> float:
    """Of two matrices that are defined up to sign."""
    return min(float(np.linalg.norm(matrix - other)), float(np.linalg.norm(matrix + other)))


# ---- what exists


def existing(pixel: Array) -> Pixel | None:
    """A pixel, or None where it isn't finite."""
    u, v = pixel.tolist()
    return (u, v) if math.isfinite(u + v) else None


def _line(line: Array) -> Array | None:
    return line if math.isfinite(line.item(0)) else None


def _number(value: Array) -> float | None:
    number = float(value)
    return number if math.isfinite(number) else None
