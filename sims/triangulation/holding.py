"""What stays while the cameras change: how the pixels of a point in space move with the rig.

In a parallel rig all of it follows from the pixels, with d = u_left - u_right + doffs and Z = f b / d.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sims.triangulation.params import TriangulationParams

Pixel = tuple[float, float]


def held_point(before: TriangulationParams, after: TriangulationParams) -> dict[str, Any]:
    """The pixels that show, after a change of the rig, the point which they showed before it.

    Rays that miss each other go on to miss by as many pixels: what is held is the optimal point. Nothing is held where
    there is no point in front of the cameras; what a picture doesn't show any more goes to where both do.
    """
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
    """The pixels, or, where one is in no picture, the nearest that are, with the depth and the miss if there can be."""
    (ul, vl), (ur, vr) = left, right
    ur = min(max(ur, ul - last[0]), ul + last[0])
    u = max(-min(ul, ur), 0.0) + min(last[0] - max(ul, ur), 0.0)
    vr = min(max(vr, vl - last[1]), vl + last[1])
    v = max(-min(vl, vr), 0.0) + min(last[1] - max(vl, vr), 0.0)
    return {
        side: (min(max(x + u, 0.0), last[0]), min(max(y + v, 0.0), last[1]))
        for side, (x, y) in (("left_uv", (ul, vl)), ("right_uv", (ur, vr)))
    }
