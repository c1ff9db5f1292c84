"""What is to be reached with two rays."""

from __future__ import annotations

import math
from itertools import combinations

from sims.kit.challenge import Challenge, Progress, nearer
from sims.kit.readout import quantity
from sims.triangulation.params import TriangulationParams
from sims.triangulation.solution import TriangulationSolution

GAP, ERROR = 0.05, 3.0
"""Metres by which the rays miss, and pixels that both reprojection errors stay below."""
UNSURE, EXACTLY = 0.1, 0.002
"""Standard deviation of the depth in metres, and how near to it is there."""
DISAGREE = 0.01
"""Metres between the points of any two methods."""
NO_POINT = Progress(0.0, "The rays give no point: bring them together in front of the cameras first.")
RIG = ("baseline", "focal", "own")


def _miss(p: TriangulationParams, s: TriangulationSolution) -> Progress:
    found = s.by_method[p.method]
    if found.reprojection_left is None or found.reprojection_right is None:
        return NO_POINT
    worst = max(found.reprojection_left, found.reprojection_right)
    words = (
        f"The rays miss by {quantity(100.0 * s.ray_gap, 'cm', 1)}; the errors are"
        f" {quantity(found.reprojection_left, 'px', 2)} and {quantity(found.reprojection_right, 'px', 2)}"
    )
    if s.ray_gap > GAP and worst < ERROR:
        return Progress(1.0, "The rays miss by more than 5 cm, and hardly a pixel shows it")
    return Progress(min(s.ray_gap / GAP, 1.0) * min(ERROR / max(worst, ERROR), 1.0) * 0.99, words)


def _unsure(p: TriangulationParams, s: TriangulationSolution) -> Progress:
    if s.depth_sigma is None:
        return NO_POINT
    start = TriangulationParams()
    if any(getattr(p, name) != getattr(start, name) for name in RIG) or s.sigma_px != 1.0:
        return Progress(0.0, "Leave the cameras and the noise as they open, and change the depth alone.")
    words = f"σ of the depth is {quantity(100.0 * s.depth_sigma, 'cm', 1)}: 10 cm are wanted"
    return nearer(abs(s.depth_sigma - UNSURE), UNSURE, EXACTLY, words, "Here the depth is 10 cm unsure")


def _disagree(_: TriangulationParams, s: TriangulationSolution) -> Progress:
    points = [found.point for found in s.by_method.values() if found.point is not None]
    if len(points) < len(s.by_method):
        return NO_POINT
    nearest = min(math.dist(a, b) for a, b in combinations(points, 2))
    words = f"The two that agree best are {quantity(1000.0 * nearest, 'mm', 1)} apart: 10 mm are wanted"
    if nearest > DISAGREE:
        return Progress(1.0, "Three methods, three points")
    return Progress(0.99 * nearest / DISAGREE, words)


CHALLENGES: tuple[Challenge[TriangulationParams, TriangulationSolution], ...] = (
    Challenge(
        id="rays-miss", title="A wide miss that hardly shows",
        goal="Make the rays miss by more than 5 cm while both reprojection errors are below 3 px.",
        near=_miss, solves={"left_uv": (390, 210), "right_uv": (340, 215)},
        misses=({"right_uv": (320, 216)}, {"right_uv": (320, 222)}, {"left_uv": (390, 210), "right_uv": (340, 213)}),
    ),
    Challenge(
        id="ten-centimetres", title="Ten centimetres unsure",
        goal="With the cameras as they open: find the depth at which σ of the depth is 10 cm.",
        near=_unsure, solves={"left_uv": (347, 210), "right_uv": (275.7, 210)},
        misses=({"left_uv": (347, 210), "right_uv": (277, 210)}, {"right_uv": (335, 210)}),
    ),
    Challenge(
        id="three-points", title="Three methods, three points",
        goal="Make the three methods disagree, each with each, by more than 1 cm.",
        near=_disagree, solves={"right_uv": (320, 228)}, misses=({"right_uv": (320, 222)}, {"right_uv": (320, 214)}),
    ),
)  # fmt: skip
