"""Real rigs: those of two well-known data sets, and others by their calibration files.

A rig is a dict of the parameters that describe it, in metres and pixels.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from typing import Any

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
KITTI_PAIRS = (
    ("P_rect_00", "P_rect_01", "S_rect_00"),
    ("P_rect_02", "P_rect_03", "S_rect_02"),
    ("P0", "P1", ""),
    ("P2", "P3", ""),
)
"""Names of both projection matrices, and of the size of the pictures where a file has it."""
DECIMALS = 9
"""What metres and pixels are rounded to: more digits are there by arithmetic alone."""
ALIKE = 1e-6
"""By what part numbers may differ that are the same for both cameras."""


def read(text: str) -> dict[str, float]:
    """The rig of a calibration file as Middlebury or KITTI have it. Raises ValueError in words."""
    entries = dict(re.findall(r"^\s*(\w+)\s*[=:]\s*(.+?)\s*$", text, re.MULTILINE))
    if {"cam0", "cam1", "baseline"} <= entries.keys():
        return _middlebury(entries)
    for left, right, size in KITTI_PAIRS:
        if {left, right} <= entries.keys():
            return _kitti(_numbers(left, entries[left], 12), _numbers(right, entries[right], 12), entries.get(size, ""))
    raise ValueError("No calibration was found: there should be cam0, cam1 and baseline, or P0 and P1.")


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


def _middlebury(entries: Mapping[str, str]) -> dict[str, float]:
    left, right = (_numbers(name, entries[name], 9) for name in ("cam0", "cam1"))
    (baseline,) = _numbers("baseline", entries["baseline"], 1)
    width, height = (_numbers(name, entries.get(name, ""), 1)[0] for name in ("width", "height"))
    return {
        **_rig(left[:6], right[:6]),
        "baseline": round(baseline / 1000.0, DECIMALS),
        "width": round(width),
        "height": round(height),
    }


def _kitti(left: list[float], right: list[float], size: str) -> dict[str, float]:
    """The rig of two projection matrices (3, 4) by rows, whose fourth column has -f times the place of the camera."""
    rig = _rig([*left[:3], *left[4:7]], [*right[:3], *right[4:7]])
    width, height = _numbers("S_rect", size, 2) if size else (KITTI["width"], KITTI["height"])
    baseline = round((left[3] - right[3]) / rig["focal"], DECIMALS)
    return {**rig, "baseline": baseline, "width": round(width), "height": round(height)}


def _rig(left: list[float], right: list[float]) -> dict[str, float]:
    """Focal length and principal points of the first two rows of both K. Raises ValueError."""
    f, skew, cx, zero, fy, cy = left
    if f <= 0.0:
        raise ValueError("The focal length should be above 0.")
    if not _alike([f, fy, right[0], right[4]]) or any((skew, zero, right[1], right[3])):
        raise ValueError("The focal lengths differ, or pixels are skewed: this is for cameras that were rectified.")
    if not _alike([cy, right[5]]):
        raise ValueError("The principal points are at different heights: this is for cameras that were rectified.")
    return {"focal": f, "cx": cx, "cy": cy, "doffs": round(right[2] - cx, DECIMALS)}


def _alike(values: Iterable[float]) -> bool:
    first, *others = values
    return all(math.isclose(first, other, rel_tol=ALIKE) for other in others)


def _numbers(name: str, text: str, count: int) -> list[float]:
    """So many numbers from a text. Raises ValueError in words."""
    try:
        found = [float(word) for word in re.split(r"[\s;,]+", text.strip(" \t[]"))]
    except ValueError:
        found = []
    if len(found) != count or not all(map(math.isfinite, found)):
        raise ValueError(f"“{name}” should have {count} number{'s' * (count > 1)}.")
    return found
