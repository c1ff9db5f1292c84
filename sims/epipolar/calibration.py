"""Two calibrated cameras from a text as OpenCV, Kalibr, ROS, Middlebury or KITTI write it."""

from __future__ import annotations

from typing import Any

import numpy as np

from geometry.arrays import Array
from geometry.triangulation import triangulate_midpoint
from sims.epipolar.eye import eyes
from sims.epipolar.params import POINT, EpipolarParams, Place
from sims.kit.stereo import camera
from sims.kit.stereo_text import Found, calibrated, chosen, taken

EXAMPLE = """\
K1: [458.654, 0, 367.215, 0, 457.296, 248.375, 0, 0, 1]
K2: [457.587, 0, 379.999, 0, 456.134, 255.238, 0, 0, 1]
R: [0.999997, 0.002312, 0.000376, -0.002317, 0.999898, 0.014090, -0.000343, -0.014091, 0.999901]
T: [-0.110074, 0.000399, -0.000853]
image_size: [752, 480]"""
"""The cameras of a flying robot. Source: Burri et al. 2016, "The EuRoC micro aerial vehicle datasets"."""


def changes(p: EpipolarParams, found: list[Found]) -> dict[str, Any]:
    """The state with the pair that was chosen. Raises ValueError in words."""
    made = {
        **calibrated(*chosen(found, p.left_of_text, p.right_of_text)), "pick": None, "candidate": None, "trail": None,
    }  # fmt: skip
    return {**made, "point": _in_sight(p.model_copy(update=made))}


def says(p: EpipolarParams, found: list[Found]) -> str:
    """Which cameras were taken, and of which pictures."""
    return taken(found, (p.left_of_text, p.right_of_text), p.sizes, said=p.own_size is not None)


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
