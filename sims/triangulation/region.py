"""Where the point may be: the ellipsoid of three standard deviations, and the cloud of noisy reconstructions."""

from __future__ import annotations

from collections.abc import Sequence

from sims.kit.readout import quantity
from sims.kit.stage import Stage
from sims.triangulation.model import NO_POINTS, TriangulationParams, TriangulationSolution

SIGMAS = 3.0
SEEN_GAP = 0.0005
"""Metres between the rays from which on it is said that they miss."""
HERE = (0.0, 0.0, 0.0)


def gap_in_words(s: TriangulationSolution) -> str:
    """By how much the rays miss each other."""
    return f"rays miss by {quantity(100.0 * s.ray_gap, 'cm', 1)}"


class Region:
    """The ellipsoid and the cloud, as they are, or `times` as large round the result."""

    def __init__(self, stage: Stage, path: str, dot: float, opacity: float) -> None:
        self.node = stage.group(path)
        self.ball = stage.ball(f"{path}/ellipsoid", 1.0, "ink", opacity=opacity)
        self.cloud = stage.cloud(f"{path}_cloud", NO_POINTS, "ink", size=dot)
        self.shown = NO_POINTS, 0.0

    def draw(
        self, p: TriangulationParams, s: TriangulationSolution, place: Sequence[float], times: float = 0.0
    ) -> None:
        """With the ellipsoid at a place: in the world, or `times` as large in the coordinates of a node at the result."""
        if s.cloud is not self.shown[0] or (times != self.shown[1] and len(s.cloud)):
            self.shown = s.cloud, times
            self.cloud.points(times * (s.cloud - s.point) if times and s.point is not None else s.cloud)
        self.node.show(p.show_ellipsoid and s.ellipsoid_axes is not None and not s.vague)
        if s.ellipsoid_axes is None or s.ellipsoid_orientation is None:
            return
        longer = SIGMAS * (times or 1.0)
        a, b, c = s.ellipsoid_axes.tolist()
        self.node.pose(s.ellipsoid_orientation.tolist(), place)
        self.ball.scale((longer * a, longer * b, longer * c))
