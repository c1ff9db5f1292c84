"""Where the point may be: the ellipsoid of three standard deviations, and the cloud of noisy reconstructions."""

from __future__ import annotations

import numpy as np

from geometry import quaternion
from sims.kit.readout import quantity
from sims.kit.stage import Stage
from sims.triangulation.model import NO_POINTS, TriangulationParams, TriangulationSolution

SIGMAS = 3.0
SEEN_GAP = 0.0005
"""Metres between the rays from which on it is said that they miss."""


def gap_in_words(s: TriangulationSolution) -> str:
    """By how much the rays miss each other."""
    return f"rays miss by {quantity(100.0 * s.ray_gap, 'cm', 1)}"


class Region:
    """The ellipsoid and the cloud, as they are, or `times` as large round the result."""

    def __init__(self, stage: Stage, path: str, dot: float) -> None:
        self.node = stage.group(path)
        self.ball = stage.ball(f"{path}/ellipsoid", 1.0, "ink", opacity=0.3)
        self.axis = stage.lines(f"{path}/axis", np.zeros((2, 3)), "ink", width=2.0)
        self.cloud = stage.cloud(f"{path}_cloud", NO_POINTS, "ink", size=dot)
        self.shown = NO_POINTS, 0.0

    def draw(self, p: TriangulationParams, s: TriangulationSolution, times: float | None = None) -> None:
        """Without `times` in the world's coordinates, else in those of a node at the result."""
        origin = 0.0 if times is None or s.point is None else s.point
        times = times or 1.0
        if s.cloud is not self.shown[0] or times != self.shown[1]:
            self.shown = s.cloud, times
            self.cloud.points(times * (s.cloud - origin))
        self.node.show(p.show_ellipsoid and s.ellipsoid_axes is not None and not s.vague)
        if s.ellipsoid_axes is None or s.ellipsoid_directions is None or s.point is None:
            return
        a, b, c = (times * SIGMAS * s.ellipsoid_axes).tolist()
        turn = quaternion.from_matrix(s.ellipsoid_directions).tolist()
        self.node.pose(turn, (times * (s.point - origin)).tolist())
        self.ball.scale((a, b, c))
        self.axis.path([(-a, 0.0, 0.0), (a, 0.0, 0.0)])
