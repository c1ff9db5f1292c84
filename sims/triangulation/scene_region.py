"""Where the point may be: the ellipsoid of three standard deviations, and the cloud of noisy reconstructions."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import trimesh

from geometry.arrays import Array
from sims.kit.readout import quantity
from sims.kit.scene.stage import Stage
from sims.triangulation.params import TriangulationParams
from sims.triangulation.solution import SIGMAS, TriangulationSolution

SEEN_GAP = 0.0005
"""Metres between the rays from which on it is said that they miss."""


def in_steps(depth: float) -> float:
    """The depth but for a tenth: for sizes that follow it and needn't be drawn anew each time."""
    return math.exp2(round(4.0 * math.log2(depth)) / 4.0)


def gap_in_words(s: TriangulationSolution) -> str:
    """By how much the rays miss each other."""
    return f"rays miss by {quantity(100.0 * s.ray_gap, 'cm', 1)}"


RINGS, AROUND = 9, 32


def slice_of_ball(part: float) -> Array:
    """Corners of what lies within `part` of a unit ball's radius along x: rings, and the middles of both cuts."""
    x = np.repeat(np.linspace(-part, part, RINGS), AROUND)
    angle = np.tile(np.linspace(0.0, math.tau, AROUND, endpoint=False), RINGS)
    radius = np.sqrt(1.0 - x * x)
    rings = np.column_stack([x, radius * np.cos(angle), radius * np.sin(angle)])
    return np.concatenate([rings, [[-part, 0.0, 0.0], [part, 0.0, 0.0]]])


def _triangles() -> Array:
    """Faces of such a slice, counter-clockwise from outside."""
    k = np.arange(AROUND)
    after, last, middles = (k + 1) % AROUND, (RINGS - 1) * AROUND, RINGS * AROUND
    sides = [
        np.column_stack(corners) + AROUND * ring
        for ring in range(RINGS - 1)
        for corners in ((k, k + AROUND, after), (after, k + AROUND, after + AROUND))
    ]
    near = np.column_stack([k, after, np.full(AROUND, middles)])
    far = np.column_stack([last + after, last + k, np.full(AROUND, middles + 1)])
    return np.concatenate([*sides, near, far])


SLICE = trimesh.Trimesh(slice_of_ball(0.5), _triangles(), process=False)


class Region:
    """The ellipsoid and the cloud, as they are, or `times` as large round the result; a long ellipsoid is cut."""

    def __init__(self, stage: Stage, path: str, dot: float, opacity: float) -> None:
        self.node = stage.group(path)
        self.ball = stage.ball(f"{path}/ellipsoid", 1.0, "ink", opacity=opacity)
        self.cut = stage.mesh(f"{path}/cut", SLICE, "ink", opacity=opacity)
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
        whole = s.drawn_part >= 1.0
        self.ball.show(whole)
        self.cut.vertices(None if whole else slice_of_ball(s.drawn_part))
        for body in (self.ball, self.cut):
            body.scale((longer * a, longer * b, longer * c))
