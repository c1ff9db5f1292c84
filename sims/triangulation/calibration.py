"""Real rigs: those of two well-known data sets, and others by their calibration files.

A rig is a dict of the parameters that describe it, in metres and pixels.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from geometry.arrays import Array
from sims.kit.calibration import cameras, poses
from sims.triangulation.holding import held_point
from sims.triangulation.params import OF_CURVE, TriangulationParams

Rig = Mapping[str, float]
MIDDLEBURY: Rig = {
    "baseline": 0.176252, "focal": 4161.221, "cx": 1445.577, "cy": 984.686, "doffs": 209.059, "width": 2880,
    "height": 1988,
}  # fmt: skip
"""Adirondack. Source: Scharstein et al. 2014, "High-resolution stereo datasets with subpixel-accurate ground truth"."""
KITTI: Rig = {
    "baseline": 0.53715, "focal": 721.5377, "cx": 609.5593, "cy": 172.854, "doffs": 0.0, "width": 1242, "height": 375,
}  # fmt: skip
"""The grey cameras. Source: Geiger et al. 2013, "Vision meets robotics: The KITTI dataset"."""
EXAMPLE = """\
cam0=[4161.221 0 1445.577; 0 4161.221 984.686; 0 0 1]
cam1=[4161.221 0 1654.636; 0 4161.221 984.686; 0 0 1]
doffs=209.059
baseline=176.252
width=2880
height=1988"""
DECIMALS = 9
"""What metres and pixels are rounded to: more digits are there by arithmetic alone."""
ALIKE = 1e-6
"""By what part numbers may differ that are the same for both cameras."""
TURNED = 1e-4
"""The same of the entries of a rotation that turns nothing."""


def read(text: str) -> dict[str, float]:
    """The rig of the first two cameras of a text. Raises ValueError in words."""
    pair = cameras(text)[:2]
    matrices = [K for each in pair if (K := each.K) is not None]
    if len(matrices) < 2:
        raise ValueError("No calibration was found: there should be cam0, cam1 and baseline, or P0 and P1.")
    left, right = poses(pair)
    size = pair[0].size or {name: KITTI[name] for name in ("width", "height") if pair[0].first(("p",))}
    if len(size) < 2:
        raise ValueError("The text doesn’t say how large the pictures are: there should be width and height.")
    rig = _rig(matrices[0], matrices[1], right @ np.linalg.inv(left))
    return {**rig, **{name: round(value) for name, value in size.items()}}


def changes(p: TriangulationParams, rig: Rig) -> dict[str, Any]:
    """The state with that rig, which looks at the point that the rig before looked at."""
    after = p.model_copy(update=dict(rig))
    middle = {"left_uv": after.middle, "right_uv": after.middle}
    before = tuple([getattr(p, name) for name in OF_CURVE])
    return {**rig, **(held_point(p, after) or middle), "before": before}


def middlebury(p: TriangulationParams) -> dict[str, Any]:
    """The rig of Middlebury's Adirondack."""
    return changes(p, MIDDLEBURY)


def kitti(p: TriangulationParams) -> dict[str, Any]:
    """The rig of KITTI's grey cameras."""
    return changes(p, KITTI)


def _rig(left: Array, right: Array, T: Array) -> dict[str, float]:
    """Baseline, focal length and principal points, of both K and of T_right_left. Raises ValueError in words."""
    (f, skew, cx), (_, fy, cy), _ = left.tolist()
    if not _alike([f, fy, right[0, 0], right[1, 1]]) or skew or right[0, 1]:
        raise ValueError("The focal lengths differ, or pixels are skewed: this is for cameras that were rectified.")
    if not _alike([cy, right[1, 2]]):
        raise ValueError("The principal points are at different heights: this is for cameras that were rectified.")
    if not np.allclose(T[:3, :3], np.eye(3), rtol=0.0, atol=TURNED):
        raise ValueError("The cameras are turned against each other: this is for cameras that were rectified.")
    baseline, doffs = (round(float(value), DECIMALS) for value in (-T[0, 3], right[0, 2] - cx))
    return {"focal": f, "cx": cx, "cy": cy, "doffs": doffs, "baseline": baseline}


def _alike(values: Iterable[float]) -> bool:
    first, *others = values
    return all(math.isclose(first, other, rel_tol=ALIKE) for other in others)
