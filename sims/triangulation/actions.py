"""What buttons and handles do to a state."""

from __future__ import annotations

from typing import Any

import numpy as np

from geometry.triangulation import triangulate_optimal
from sims.kit.scale import Scale
from sims.triangulation.depth_plot import within
from sims.triangulation.holding import apart, in_sight, missed, seen
from sims.triangulation.params import FARTHEST, LAST_SEED, TriangulationParams
from sims.triangulation.rig import rig
from sims.triangulation.solution import TriangulationSolution, measured, pair


def hold_point(p: TriangulationParams, place: tuple[float, ...]) -> dict[str, Any]:
    """Both pixels of a point in the world; it stays where both pictures show it."""
    cameras = rig(p)
    if p.pair is not None:
        return seen(cameras, np.array(place))
    x, y, z = place
    in_front = (x, max(y, 1e-3), z)
    left, right = (pair(camera.project(in_front)[0]) for camera in (cameras.left, cameras.right))
    return in_sight(left, right, p.last)


def hold_depth(p: TriangulationParams, place: tuple[float, ...]) -> dict[str, Any]:
    """Both pixels of the point at the depth to which it was dragged in the plot, where it is drawn with its noise."""
    if p.pair is not None:
        return _farther(p, place[0])
    (ul, _), (ur, _) = measured(p)
    d, fb = ul - ur + p.doffs, p.focal * p.baseline
    return apart(p, fb / within(place[0], fb / d) - d) if d > 0.0 else {}


def _farther(p: TriangulationParams, depth: float) -> dict[str, Any]:
    """The same of turned cameras: the point moves along the left camera's line to it."""
    cameras = rig(p)
    found = triangulate_optimal(cameras.left, cameras.right, *measured(p))
    if not found.valid:
        return {}
    center, now = cameras.left.center, float(cameras.left.project(found.point)[1])
    return seen(cameras, center + within(depth, now) / now * (found.point - center), missed(p, found.point))


def hold_left(p: TriangulationParams, place: tuple[float, ...]) -> dict[str, Any]:
    """The left pixel."""
    return {"left_uv": Scale.of(*p.sizes[0]).pixel(place)}


def hold_right(p: TriangulationParams, place: tuple[float, ...]) -> dict[str, Any]:
    """The right pixel."""
    return {"right_uv": Scale.of(*p.sizes[1]).pixel(place)}


def held_point(p: TriangulationParams, s: TriangulationSolution) -> tuple[float, float, float] | None:
    """The point without noise, where its coordinates say something."""
    if s.target is None:
        return None
    x, y, z = s.target.tolist()
    return (x, y, z) if y <= FARTHEST[1] else None


def new_sample(p: TriangulationParams) -> dict[str, Any]:
    """Noise of the next seed."""
    return {"seed": (p.seed + 1) % (LAST_SEED + 1), "noise": p.noise or 1.0}


def switch_noise(p: TriangulationParams) -> dict[str, Any]:
    """Noise of one pixel, or none."""
    return {"noise": 0.0 if p.noise else 1.0}
