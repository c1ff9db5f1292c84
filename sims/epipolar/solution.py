"""The mathematics of a state: what follows from the cameras and the point, and where all of it is drawn."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from geometry.arrays import Array
from geometry.epipolar import epipolar_line_left, epipolar_line_right, epipolar_residual, sampson_distance
from sims.epipolar.candidate import Candidate, candidate
from sims.epipolar.drawing import Drawing, Segment, camera_drawing, drawn_size, plane
from sims.epipolar.estimate import Estimate, estimate
from sims.epipolar.eye import eyes
from sims.epipolar.own import OwnPair, own
from sims.epipolar.params import OTHERS, EpipolarParams, Pixel, Place, Side, read_pick
from sims.epipolar.ray import Trail, trail
from sims.epipolar.rig import Pair, Views, existing, existing_line, other_drawings, pair, views
from sims.kit.stereo import Eye, Size

EXACT = 1e-9
"""Angle, in radians, below which the 3D point counts as being on the baseline."""
FAR = 9.0
"""Metres that the ray of a picked pixel is drawn."""


@dataclass(frozen=True, eq=False)
class Picked:
    """The pixel that the learner chose, its line in the other picture, and a piece of its ray in the world."""

    side: Side
    pixel: Pixel
    line: Array | None
    ray: Segment


@dataclass(frozen=True, eq=False)
class EpipolarSolution:
    """What doesn't exist is None. Pixels and lines without a number are those of the 3D point."""

    K: Array
    """The left camera's; the sim's own two have the same."""
    K_right: Array
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
    size_left: Size
    size_right: Size
    baseline: float
    """Metres, in the scene."""
    points: Array
    pixels_left: Array
    pixels_right: Array
    lines_left: Array | None
    lines_right: Array | None
    depth_left: float
    depth_right: float
    on_baseline: bool
    picked: Picked | None
    own: OwnPair | None
    trail: Trail | None
    candidate: Candidate | None
    estimate: Estimate
    drawn: Drawing


def solve(p: EpipolarParams) -> EpipolarSolution:
    """All the mathematics of a state."""
    rig = eyes(p)
    both, others = pair(*rig), views(*rig, p.points - 1)
    (left, depth_left), (right, depth_right) = (camera.project(p.point) for camera in (both.left, both.right))
    pixel_left, pixel_right = existing(left), existing(right)
    aligned = both.F is not None and _aligned(p.point, *rig)
    lines: tuple[Array | None, Array | None] = None, None
    if both.F is not None and not aligned:
        lines = existing_line(epipolar_line_left(both.F, right)), existing_line(epipolar_line_right(both.F, left))
    match = None if both.F is None or pixel_left is None or pixel_right is None else (both.F, left, right)
    together = _with_first(left, right, *lines, others)
    picked = None if p.pick is None else _picked(both, p.pick)
    return EpipolarSolution(
        K=both.left.K,
        K_right=both.right.K,
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
        size_left=rig[0].size,
        size_right=rig[1].size,
        baseline=math.dist(rig[0].center, rig[1].center),
        points=_world_points(p.point, p.points),
        pixels_left=together.pixels_left,
        pixels_right=together.pixels_right,
        lines_left=together.lines_left,
        lines_right=together.lines_right,
        depth_left=float(depth_left),
        depth_right=float(depth_right),
        on_baseline=aligned,
        picked=picked,
        own=own(p, both),
        trail=trail(p, both, float(depth_left)),
        candidate=candidate(p, both, left, lines[1]),
        estimate=estimate(p, both, together),
        drawn=_drawn(p, rig, both, (pixel_left, pixel_right), lines, picked, aligned),
    )


def _drawn(
    p: EpipolarParams, rig: tuple[Eye, Eye], both: Pair, pixels: tuple[Pixel | None, Pixel | None],
    lines: tuple[Array | None, Array | None], picked: Picked | None, aligned: bool,
) -> Drawing:  # fmt: skip
    left, right = rig
    size = drawn_size(math.dist(left.center, right.center))
    still = other_drawings(left, right, p.points - 1, p.show_all_lines)
    eyes = [
        camera_drawing(
            eye, size, pixel=pixel, line=line, epipole=epipole, others=others, all_lines=chords,
            picked=picked.line if picked is not None and picked.side != side else None,
        )
        for side, eye, pixel, line, epipole, (others, chords) in zip(
            ("left", "right"), rig, pixels, lines, (both.epipole_left, both.epipole_right), still, strict=True,
        )
    ]  # fmt: skip
    sheet = None if both.F is None or aligned else plane(left.center, right.center, p.point)
    return Drawing(eyes[0], eyes[1], sheet, None if picked is None else picked.ray)


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


def _world_points(point: Place, count: int) -> Array:
    """The points that are shown, (count, 3)."""
    return np.concatenate([[point], OTHERS[: count - 1]])


def _aligned(point: Place, left: Eye, right: Eye) -> bool:
    """Whether the point is on the line through both centres: then there is no single epipolar plane."""
    (ax, ay, az), (bx, by, bz) = (
        [a - b for a, b in zip(end, left.center, strict=True)] for end in (point, right.center)
    )
    crossed = math.hypot(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)
    return crossed <= EXACT * math.hypot(ax, ay, az) * math.hypot(bx, by, bz)


def _picked(both: Pair, pick: str) -> Picked:
    side, pixel = read_pick(pick)
    eye = both.left if side == "left" else both.right
    line = None
    if both.F is not None:
        line = existing_line((epipolar_line_right if side == "left" else epipolar_line_left)(both.F, pixel))
    start, along = eye.pixel_ray(pixel)
    (x, y, z), (a, b, c) = start.tolist(), (start + FAR * along).tolist()
    return Picked(side, pixel, line, ((x, y, z), (a, b, c)))


def _number(value: Array) -> float | None:
    number = float(value)
    return number if math.isfinite(number) else None
