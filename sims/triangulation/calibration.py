"""Real rigs: those of two well-known data sets, and others by their calibration files.

A rig is a dict of the parameters that describe it, in metres and pixels. A pair of cameras that isn't rectified keeps
its own matrices, and how its cameras are turned and shifted against each other.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from geometry.epipolar import sampson_distance
from geometry.triangulation import triangulate_midpoint, triangulate_optimal
from sims.kit import stereo_text
from sims.kit.calibration import cameras
from sims.kit.readout import quantity
from sims.kit.stereo import length
from sims.kit.stereo_text import Found, between, calibrated, chosen, taken
from sims.triangulation.holding import held_point, seen
from sims.triangulation.params import OF_CURVE, OF_RIG, TriangulationParams
from sims.triangulation.rig import Rig as Cameras
from sims.triangulation.rig import rig as rig_of

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
PARALLEL: Rig = {name: TriangulationParams.model_fields[name].default for name in OF_RIG}
"""The sim's own."""
EXAMPLE = """\
cam0=[4161.221 0 1445.577; 0 4161.221 984.686; 0 0 1]
cam1=[4161.221 0 1654.636; 0 4161.221 984.686; 0 0 1]
doffs=209.059
baseline=176.252
width=2880
height=1988"""
TOE_IN = """\
K1: [900, 0, 640, 0, 900, 360, 0, 0, 1]
K2: [1400, 0, 950, 0, 1400, 530, 0, 0, 1]
R: [0.866025403784, 0, 0.5, 0, 1, 0, -0.5, 0, 0.866025403784]
T: [-0.772740661, 0, 0.207055236]
image_size1: [1280, 720]
image_size2: [1920, 1080]"""
"""Two unlike cameras 0.8 m apart, each turned by 15° to the other's side."""
DECIMALS = 9
"""What metres and pixels are rounded to: more digits are there by arithmetic alone."""
ALIKE = 1e-6
"""By what part numbers may differ that are the same for both cameras."""
TURNED = 1e-4
"""The same of the entries of a rotation that turns nothing."""
ALONG = 0.01
"""By what part of the baseline the right camera may be higher or farther ahead: KITTI's colour cameras are by half."""
NEAR = 0.5
"""Pixels that pixels of one point may be off."""
MILLI = 0.001
"""Metres of a millimetre: the other unit that T is usually in."""


def read(text: str) -> list[Found]:
    """The cameras of a text: two or more. Raises ValueError in words."""
    found = stereo_text.read(text)
    for each, written in zip(found, cameras(text), strict=True):
        if not each["size"] and written.first(("p",)):  # KITTI's odometry has no more than P0 to P3
            each["size"] = [round(KITTI[name]) for name in ("width", "height")]
    return found


def changes(p: TriangulationParams, found: list[Found]) -> dict[str, Any]:
    """The state with the pair that was chosen, rectified or not. Raises ValueError in words."""
    left, right = chosen(found, p.left_of_text, p.right_of_text)
    rectified = _rectified(left, right)
    return with_pair(p, left, right) if rectified is None else with_rig(p, rectified)


def with_rig(p: TriangulationParams, rig: Rig) -> dict[str, Any]:
    """The state with a parallel rig, which looks at the point that the rig before looked at."""
    made: dict[str, Any] = {**rig, "own": None, "own_size": None}
    after = p.model_copy(update=made)
    before = None if p.pair else tuple([getattr(p, name) for name in OF_CURVE])
    return {**made, **(held_point(p, after) or _middles(after)), "before": before}


def with_pair(p: TriangulationParams, left: Found, right: Found) -> dict[str, Any]:
    """The state with somebody's pair, which looks at the same point if both cameras see it at its depth.

    If not, then where the middles of their pictures meet.
    """
    made = calibrated(left, right)
    made |= {"baseline": _metres(length(made["own"])) or p.baseline, "before": None}
    after = p.model_copy(update=made)
    cameras, middles, before = rig_of(after), _middles(after), rig_of(p)
    held = triangulate_optimal(before.left, before.right, p.left_uv, p.right_uv)
    if held.valid and (pixels := seen(cameras, held.point)) and _meet(cameras, pixels):
        return {**made, **pixels}
    met = triangulate_midpoint(cameras.left, cameras.right, middles["left_uv"], middles["right_uv"])
    return {**made, **((seen(cameras, met.point) if met.valid else {}) or middles)}


def says(p: TriangulationParams, found: list[Found]) -> str:
    """What was taken, of which pictures, and in which unit."""
    if p.pair is None:
        return f"Taken as a rectified rig: b is {quantity(p.baseline, 'm', 3)}, f {quantity(p.focal, 'px', 1)}."
    words = taken(found, (p.left_of_text, p.right_of_text), p.sizes, said=p.own_size is not None)
    return f"{words} The cameras aren’t rectified, and stand as they were calibrated. {unit(p)}"


def unit(p: TriangulationParams) -> str:
    """How long somebody's T is, and what is made of that, in a sentence."""
    assert p.pair is not None
    long = length(p.pair)
    metres = _metres(long)
    if metres is None or not _alike([metres, p.baseline]):
        apart = quantity(p.baseline, "m", 2)
        return f"T is {long:.5g} long in its unit; here the cameras are {apart} apart, and lengths grow with that."
    name = "metres" if _alike([metres, long]) else "millimetres"
    return f"T, which is {long:.5g} long, is taken to be in {name}."


def middlebury(p: TriangulationParams) -> dict[str, Any]:
    """The rig of Middlebury's Adirondack."""
    return with_rig(p, MIDDLEBURY)


def kitti(p: TriangulationParams) -> dict[str, Any]:
    """The rig of KITTI's grey cameras."""
    return with_rig(p, KITTI)


def toe_in(p: TriangulationParams) -> dict[str, Any]:
    """Two cameras that are turned to each other's side."""
    return with_pair(p, *read(TOE_IN))


def parallel(p: TriangulationParams) -> dict[str, Any]:
    """The sim's own cameras."""
    return with_rig(p, PARALLEL)


def _rectified(left: Found, right: Found) -> Rig | None:
    """The rig that two cameras are, if they are rectified. Raises ValueError in words."""
    (f, fy, cx, cy), (fx_right, fy_right, cx_right, cy_right) = left["lens"], right["lens"]
    T = between(left, right)
    x, y, z = (-T[:3, 3]).tolist()
    if not (
        _alike([f, fy, fx_right, fy_right])
        and _alike([cy, cy_right])
        and np.allclose(T[:3, :3], np.eye(3), rtol=0.0, atol=TURNED)
        and math.hypot(y, z) <= ALONG * x
        and x > 0.0
        and right["size"] in (left["size"], [])
    ):
        return None
    if not left["size"]:
        raise ValueError("The text doesn’t say how large the pictures are: there should be width and height.")
    width, height = left["size"]
    baseline, doffs = _metres(x) or round(x, DECIMALS), round(cx_right - cx, DECIMALS)
    return {
        "focal": f, "cx": cx, "cy": cy, "doffs": doffs, "baseline": baseline, "width": width, "height": height,
    }  # fmt: skip


def _metres(long: float) -> float | None:
    """A length that can be a baseline here, as metres or else as millimetres."""
    low, high = TriangulationParams.numeric["baseline"].bounds
    return next((round(m, DECIMALS) for m in (long, MILLI * long) if low <= m <= high), None)


def _middles(p: TriangulationParams) -> dict[str, Any]:
    """The pixels in the middle of both pictures."""
    left, right = ((0.5 * (width - 1.0), 0.5 * (height - 1.0)) for width, height in p.sizes)
    return {"left_uv": left, "right_uv": right}


def _meet(cameras: Cameras, pixels: Mapping[str, Any]) -> bool:
    """Whether these are pixels of one point: else no place at that depth is in both pictures."""
    return float(sampson_distance(cameras.F, pixels["left_uv"], pixels["right_uv"])) < NEAR


def _alike(values: Iterable[float]) -> bool:
    first, *others = values
    return all(math.isclose(first, other, rel_tol=ALIKE) for other in others)
