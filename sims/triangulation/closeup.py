"""A magnifying glass over the point: what is only millimetres or centimetres apart, drawn larger."""

from __future__ import annotations

import math

import numpy as np

from geometry.arrays import Array
from sims.kit.stage import Stage
from sims.triangulation.model import METHODS, NAMES, TriangulationParams, TriangulationSolution
from sims.triangulation.region import SEEN_GAP, SIGMAS, Region, gap_in_words
from sims.triangulation.shapes import Shape

RADIUS, HEIGHT = 0.19, 0.36
"""Of the glass, and how far above the point it hangs, as parts of the point's depth."""
MAGNIFICATIONS = tuple(10.0**power * k for power in range(7) for k in (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0))
LEAST = 1.5
"""Magnification below which it shows nothing more than the scene does."""
DOT = 0.06
"""Radius of a shape in it, as part of the glass's."""


class CloseUp:
    """A ball in which everything near the point is drawn larger, round the result of the chosen method."""

    def __init__(self, stage: Stage) -> None:
        self.node = stage.group("/closeup")
        self.glass = stage.ball("/closeup/glass", 1.0, "ghost", opacity=0.08, side="back")
        self.string = stage.lines("/closeup/string", np.zeros((2, 3)), "ghost", width=1.2)
        self.rays = [stage.lines(f"/closeup/ray_{side}", np.zeros((2, 3)), side, width=1.8) for side in SIDES]
        self.gap = stage.lines("/closeup/gap", np.zeros((2, 3)), "held", width=4.0)
        self.shapes = {name: Shape(stage, f"/closeup/{name}", name) for name in METHODS}
        self.names = {name: stage.label(f"/closeup/{name}/label", NAMES[name]) for name in METHODS}
        self.true = stage.ball("/closeup/true", 1.0, "held")
        self.region = Region(stage, "/closeup/uncertainty", 0.009)
        self.label = stage.label("/closeup/label", "")
        self.gap_label = stage.label("/closeup/gap_label", "")

    def draw(self, p: TriangulationParams, s: TriangulationSolution) -> bool:
        """Whether it is there."""
        times = magnification(s)
        self.node.show(times >= LEAST)
        if s.point is None or s.depth is None or times < LEAST:
            return False
        radius = RADIUS * s.depth
        self.node.pose(position=s.point + np.array([0.0, 0.0, HEIGHT * s.depth]))
        self.glass.scale(radius)
        self.string.path([(0.0, 0.0, -radius), (0.0, 0.0, -HEIGHT * s.depth)])
        self._rays(s, radius, times)
        for name, shape in self.shapes.items():
            found = s.by_method[name].point
            shape.draw(found, name == p.method, DOT * radius, s.point, times)
            apart = 0.0 if found is None else times * math.dist(found, s.point)
            self.names[name].show(apart > 0.15 * radius)
            self.names[name].pose(position=(0.0, 0.0, (-3.0 if name == "midpoint" else 3.0) * DOT * radius))
        self.true.show(s.true_point is not None)
        if s.true_point is not None:
            self.true.pose(position=times * (s.true_point - s.point))
            self.true.scale(0.8 * DOT * radius)
        self.region.draw(p, s, times)
        self.label.pose(position=(0.0, 0.0, 1.15 * radius))
        self.label.text(f"close-up ×{times:g}" + (", 3σ" if p.show_ellipsoid else ""))
        self.gap_label.pose(position=(0.0, 0.0, -1.15 * radius))
        self.gap_label.text(gap_in_words(s))
        self.gap_label.show(s.ray_gap > SEEN_GAP)
        return True

    def _rays(self, s: TriangulationSolution, radius: float, times: float) -> None:
        if s.closest_points is None or s.point is None:
            return
        near = times * (s.closest_points - s.point)
        for ray, at, (x, down) in zip(self.rays, near, (s.sight_left, s.sight_right), strict=True):
            ray.path(chord(at, np.array([x, 1.0, -down]), radius))
        self.gap.path(near)


SIDES = ("left", "right")


def chord(at: Array, along: Array, radius: float) -> Array:
    """The part (2, 3) of a line that is inside the glass; a point of it where it misses."""
    a, b, c = float(along @ along), float(along @ at), float(at @ at) - radius**2
    half = math.sqrt(max(b * b - a * c, 0.0))
    return np.array([at + (-b - half) / a * along, at + (-b + half) / a * along])


def magnification(s: TriangulationSolution) -> float:
    """The largest round one at which everything still fits the glass; 0 where there is nothing to show."""
    if s.point is None or s.depth is None or s.vague:
        return 0.0
    others = [found.point for found in s.by_method.values() if found.point is not None]
    others += [] if s.true_point is None else [s.true_point]
    apart = [math.dist(other, s.point) for other in others]
    widest = max(*apart, s.ray_gap, SIGMAS * float(s.ellipsoid_axes[0]) if s.ellipsoid_axes is not None else 0.0)
    room = RADIUS * s.depth / max(widest, 1e-9)
    return max((m for m in MAGNIFICATIONS if m <= room), default=0.0)
