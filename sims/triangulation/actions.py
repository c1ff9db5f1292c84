"""What buttons and handles do to a state."""

from __future__ import annotations

from typing import Any

from sims.triangulation.params import FARTHEST, LAST, LAST_SEED, TriangulationParams
from sims.triangulation.solution import TriangulationSolution, _pair, rig


def hold_point(p: TriangulationParams, place: tuple[float, ...]) -> dict[str, Any]:
    """Both pixels of a point in the world; it stays where both pictures show it."""
    cameras = rig(p.baseline, p.focal)
    x, y, z = place
    in_front = (x, max(y, 1e-3), z)
    (u, v), (other, _) = (_pair(camera.project(in_front)[0]) for camera in (cameras.left, cameras.right))
    nearest = u - LAST[0]
    other = max(other, nearest)
    shift = max(-other, 0.0) + min(LAST[0] - u, 0.0)
    v = min(max(v, 0.0), LAST[1])
    return {"left_uv": (u + shift, v), "right_uv": (other + shift, v)}


def hold_left(p: TriangulationParams, place: tuple[float, ...]) -> dict[str, Any]:
    """The left pixel."""
    return {"left_uv": place[:2]}


def hold_right(p: TriangulationParams, place: tuple[float, ...]) -> dict[str, Any]:
    """The right pixel."""
    return {"right_uv": place[:2]}


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
