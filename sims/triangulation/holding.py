"""What stays while the cameras change: how the pixels of a point in space move with the rig.

In a parallel rig all of it follows from the pixels, with d = u_left - u_right + doffs and Z = f b / d. For cameras that
are turned the point itself is looked for, and seen again.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from geometry.arrays import Array
from geometry.triangulation import triangulate_optimal
from sims.kit.types import Pixel
from sims.triangulation.rig import Rig, rig

if TYPE_CHECKING:
    from sims.triangulation.params import TriangulationParams

Miss = tuple[Pixel, Pixel]
"""By how much each pixel isn't that of the point."""
EXACT: Miss = (0.0, 0.0), (0.0, 0.0)
TRIES = 30
"""How often a point is put to where one picture shows it, and then the other; few are enough."""


def held_point(before: TriangulationParams, after: TriangulationParams) -> dict[str, Any]:
    """The pixels that show, after a change of the rig, the point which they showed before it.

    Rays that miss each other go on to miss by as many pixels: what is held is the optimal point. Nothing is held where
    there is no point in front of the cameras; what a picture doesn't show any more goes to where both do.
    """
    if before.pair is not None or after.pair is not None:
        cameras = rig(before)
        found = triangulate_optimal(cameras.left, cameras.right, before.left_uv, before.right_uv)
        return seen(rig(after), found.point, missed(before, found.point)) if found.valid else {}
    (ul, vl), (ur, vr) = before.left_uv, before.right_uv
    d = ul - ur + before.doffs
    if d <= 0.0:
        return {}
    # With f / Z = d / b, nothing changes where the rig doesn't, not even by rounding.
    scale = after.focal / before.focal
    aside = 0.5 * d * (after.baseline - before.baseline) / before.baseline
    left = after.cx + scale * (ul - before.cx + aside)
    right = after.cx + after.doffs + scale * (ur - before.cx - before.doffs - aside)
    down = after.cy - before.cy + (scale - 1.0) * (0.5 * (vl + vr) - before.cy)
    return in_sight((left, vl + down), (right, vr + down), after.last)


def apart(p: TriangulationParams, more: float) -> dict[str, Any]:
    """The pixels with so much more disparity, for a point nearer in the direction in which the rig sees it."""
    (ul, vl), (ur, vr) = p.left_uv, p.right_uv
    return in_sight((ul + 0.5 * more, vl), (ur - 0.5 * more, vr), p.last)


def in_sight(left: Pixel, right: Pixel, last: Pixel) -> dict[str, Any]:
    """The pixels, or, where one is in no picture, the nearest that are, with the depth and the miss if there can be.

    Those of a parallel rig.
    """
    (ul, vl), (ur, vr) = left, right
    ur = min(max(ur, ul - last[0]), ul + last[0])
    u = max(-min(ul, ur), 0.0) + min(last[0] - max(ul, ur), 0.0)
    vr = min(max(vr, vl - last[1]), vl + last[1])
    v = max(-min(vl, vr), 0.0) + min(last[1] - max(vl, vr), 0.0)
    return {
        side: (min(max(x + u, 0.0), last[0]), min(max(y + v, 0.0), last[1]))
        for side, (x, y) in (("left_uv", (ul, vl)), ("right_uv", (ur, vr)))
    }


def missed(p: TriangulationParams, point: Array) -> Miss:
    """By how much the pixels of a state aren't those of a point."""
    cameras = rig(p)
    (a, b), (c, d) = (camera.project(point)[0].tolist() for camera in (cameras.left, cameras.right))
    return (p.left_uv[0] - a, p.left_uv[1] - b), (p.right_uv[0] - c, p.right_uv[1] - d)


def seen(cameras: Rig, point: Array, miss: Miss = EXACT) -> dict[str, Any]:
    """The pixels of a point, or of the nearest that both pictures show at its depth; none behind a camera."""
    point = _in_both(cameras, point)
    made: dict[str, Any] = {}
    both = zip(("left_uv", "right_uv"), (cameras.left, cameras.right), cameras.sizes, miss, strict=True)
    for name, camera, size, (off_u, off_v) in both:
        u, v = camera.project(point)[0].tolist()
        if math.isnan(u):
            return {}
        made[name] = _within((u + off_u, v + off_v), size)
    return made


def _in_both(cameras: Rig, point: Array) -> Array:
    """A point aside, as far before the left camera, that is in both pictures, if there is one.

    What a picture shows at a depth is convex: to go to the one and to the other in turn leads to where both are.
    """
    row, center = cameras.left.R[2], cameras.left.center
    depth = float(row @ (point - center))
    for _ in range(TRIES):
        moved = False
        for camera, size in zip((cameras.left, cameras.right), cameras.sizes, strict=True):
            u, v = camera.project(point)[0].tolist()
            at = _within((u, v), size)
            if not math.dist(at, (u, v)) > 1e-9:
                continue
            along = camera.back_projection @ [*at, 1.0]
            ahead = float(row @ along)
            further = (depth - float(row @ (camera.center - center))) / ahead if ahead else -1.0
            if further <= 0.0:
                return point
            point, moved = camera.center + further * along, True
        if not moved:
            break
    return np.asarray(point)


def _within(pixel: Pixel, size: tuple[int, int]) -> Pixel:
    u, v = (min(max(x, 0.0), end - 1.0) for x, end in zip(pixel, size, strict=True))
    return u, v
