"""Where the point may be: the ellipsoid of three standard deviations, and the cloud of noisy reconstructions."""

from __future__ import annotations

import math
from collections.abc import Sequence

from sims.kit.readout import quantity
from sims.kit.scene.stage import Stage
from sims.triangulation.params import TriangulationParams
from sims.triangulation.solution import TriangulationSolution

SIGMAS = 3.0
SEEN_GAP = 0.0005
"""Metres between the rays from which on it is said that they miss."""


def in_steps(depth: float) -> float:
    """The depth but for a tenth: for sizes that follow it and needn't be drawn anew each time."""
    return math.exp2(round(4.0 * math.log2(depth)) / 4.0)


def gap_in_words(s: TriangulationSolution) -> str:
    """By how much the rays miss each other."""
    return f"rays miss by {quantity(100.0 * s.ray_gap, 'cm', 1)}"


class Region:
    """The ellipsoid and the cloud, as they are, or `times` as large round the result."""

    def __init__(self, stage: Stage, path: str, dot: float, opacity: float) -> None:
        self.node = stage.group(path)
        self.ball = stage.ball(f"{path}/ellipsoid", 1.0, "ink", opacity=opacity)
        self.cloud = stage.cloud(f"{path}_cloud", "ink", size=dot)

    def draw(self, p: TriangulationParams, s: TriangulationSolution, at: Sequence[float], times: float = 0.0) -> None:
        """With the ellipsoid at a place; with `times`, in a node that stands for the result."""
        self.cloud.points(s.cloud if s.point is None or not times else times * (s.cloud - s.point))
        self.node.show(p.show_ellipsoid and s.ellipsoid_axes is not None and not s.vague)
        if s.ellipsoid_axes is None or s.ellipsoid_orientation is None:
            return
        longer = SIGMAS * (times or 1.0)
        a, b, c = s.ellipsoid_axes.tolist()
        self.node.pose(s.ellipsoid_orientation.tolist(), at)
        self.ball.scale((longer * a, longer * b, longer * c))
