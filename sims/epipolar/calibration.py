"""Two calibrated cameras from a text as OpenCV, Kalibr, ROS, Middlebury or KITTI write it."""

from __future__ import annotations

from typing import Any, TypedDict

import numpy as np

from geometry.arrays import Array
from geometry.rotations import matrix_to_axis_angle
from geometry.triangulation import triangulate_midpoint
from sims.epipolar.eye import camera, eyes
from sims.epipolar.params import POINT, EpipolarParams, Place
from sims.kit.calibration import Written, cameras, poses

EXAMPLE = """\
K1: [458.654, 0, 367.215, 0, 457.296, 248.375, 0, 0, 1]
K2: [457.587, 0, 379.999, 0, 456.134, 255.238, 0, 0, 1]
R: [0.999997, 0.002312, 0.000376, -0.002317, 0.999898, 0.014090, -0.000343, -0.014091, 0.999901]
T: [-0.110074, 0.000399, -0.000853]
image_size: [752, 480]"""
"""The cameras of a flying robot. Source: Burri et al. 2016, "The EuRoC micro aerial vehicle datasets"."""


class Found(TypedDict):
    """One camera: fx, fy, cx, cy; the size of its pictures, if that is said; its pose by rows."""

    name: str
    lens: list[float]
    size: list[int]
    pose: list[list[float]]


def read(text: str) -> list[Found]:
    """The cameras of a text: two or more. Raises ValueError in words."""
    found = cameras(text)
    if len(found) < 2:
        raise ValueError(
            "No pair was found: there should be K1, K2, R and T, or Kalibr’s cam0 and cam1, or both cameras’ ROS files."
        )
    lenses = [_lens(each) for each in found]
    return [
        {"name": each.name, "lens": lens, "size": _size(each), "pose": pose.tolist()}
        for each, lens, pose in zip(found, lenses, poses(found), strict=True)
    ]


def changes(p: EpipolarParams, found: list[Found]) -> dict[str, Any]:
    """The state with the pair that was chosen. Raises ValueError in words."""
    if max(p.left_of_text, p.right_of_text) > len(found) or p.left_of_text == p.right_of_text:
        names = ", ".join(f"{k} is {each['name']}" for k, each in enumerate(found, start=1))
        raise ValueError(f"There is no pair of cameras {p.left_of_text} and {p.right_of_text} in the text: {names}.")
    left, right = found[p.left_of_text - 1], found[p.right_of_text - 1]
    T = np.array(right["pose"]) @ np.linalg.inv(left["pose"])
    if not T[:3, 3].any():
        raise ValueError("T is zero: without a baseline there is no F.")
    axis, angle = matrix_to_axis_angle(T[:3, :3])
    own = *left["lens"], *right["lens"], *np.degrees(axis * angle).tolist(), *T[:3, 3].tolist()
    size = (*left["size"], *right["size"]) if left["size"] and right["size"] else None
    made = {"own": own, "own_size": size, "pick": None, "candidate": None, "trail": None}
    return {**made, "point": _in_sight(p.model_copy(update=made))}


def says(p: EpipolarParams, found: list[Found]) -> str:
    """Which cameras were taken, and of which pictures."""
    left, right = (found[k - 1]["name"] for k in (p.left_of_text, p.right_of_text))
    sizes = " and ".join(f"{width} × {height}" for width, height in p.sizes)
    guessed = (
        "" if p.own_size else ", if the principal points are in their middle: the text doesn’t say how large they are"
    )
    more = f"; for others of its {len(found)}, choose them and take it again" if len(found) > 2 else ""
    return f"Taken: {left} on the left and {right} on the right{more}. Their pictures have {sizes} pixels{guessed}."


def _lens(each: Written) -> list[float]:
    K = each.K
    assert K is not None, "for there is a name of one"
    (fx, skew, cx), (_, fy, cy), _ = K.tolist()
    if abs(skew) > 1e-6 * fx:
        raise ValueError("A camera matrix should be (fx, 0, cx; 0, fy, cy; 0, 0, 1): this sim has no skew.")
    return [fx, fy, cx, cy]


def _size(each: Written) -> list[int]:
    return [round(value) for value in each.size.values()] if len(each.size) == 2 else []


def _in_sight(p: EpipolarParams) -> Place:
    """Where the 3D point is in both pictures: the place it has by itself, or where the middles of the pictures meet."""
    left, right = eyes(p)
    middles = [np.array(eye.last) / 2.0 for eye in (left, right)]
    met = triangulate_midpoint(camera(left), camera(right), *middles)
    for place in (np.array(POINT), met.point):
        if all(eye.shows(*camera(eye).project(place)[0].tolist()) for eye in (left, right)) and _may(place):
            x, y, z = place.tolist()
            return x, y, z
    return POINT


def _may(place: Array) -> bool:
    kind = EpipolarParams.numeric["point"]
    return kind.within(tuple(place.tolist()), kind.ranges(POINT, kind.bounds))
