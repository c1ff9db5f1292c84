"""A magnifying glass over the point: what is only millimetres or centimetres apart, drawn larger."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence

from geometry.arrays import Array
from sims.kit.scene.stage import Stage
from sims.triangulation.params import NAMES, TriangulationParams
from sims.triangulation.rig import Rig, rig
from sims.triangulation.scene_region import SEEN_GAP, Region, gap_in_words, in_steps
from sims.triangulation.scene_shapes import Shape
from sims.triangulation.solution import METHODS, SIGMAS, TriangulationSolution

RADIUS, HEIGHT = 0.19, 0.36
"""Radius of the glass, and how far above the point it hangs, as parts of the point's depth."""
MAGNIFICATIONS = tuple(10.0**power * k for power in range(7) for k in (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0))
LEAST = 1.5
"""Magnification below which it shows nothing more than the scene does."""
DOT = 0.06
"""Radius of a shape in it, as part of the glass's."""
BESIDE = {
    "dlt": ("bottom-center", (0.0, 0.0, 2.0)), "midpoint": ("top-center", (0.0, 0.0, -2.0)),
    "optimal": ("center-left", (2.0, 0.0, 0.0)),
}  # fmt: skip
"""Where the name of each method stands, in radii of its shape: points that are all but one have names side by side."""
PLACES = 12
"""Decimals of a place: what differs by rounding alone isn't drawn anew."""
Place = list[float]


class CloseUp:
    """A ball in which everything near the point is drawn larger, round the result of the chosen method."""

    def __init__(self, stage: Stage) -> None:
        self.node = stage.group("/closeup")
        self.glass = stage.ball("/closeup/glass", 1.0, "ghost", opacity=0.08, side="back")
        self.string = stage.lines("/closeup/string", "ghost", width=1.2)
        self.rays = stage.strokes("/closeup/rays", ("left", "right", "held"), width=2.0)
        self.shapes = {name: Shape(stage, f"/closeup/{name}", name) for name in METHODS}
        self.names = {
            name: stage.label(f"/closeup/{name}/label", NAMES[name], anchor=BESIDE[name][0]) for name in METHODS
        }
        self.true = stage.ball("/closeup/true", 1.0, "held")
        self.highlighted = stage.ball("/closeup/true/lit", 1.0, "held")
        self.highlighted.show(False)
        self.region = Region(stage, "/closeup/uncertainty", 0.009, opacity=0.3)
        self.label = stage.label("/closeup/label", "")
        self.gap_label = stage.label("/closeup/gap_label", "")

    def draw(self, p: TriangulationParams, s: TriangulationSolution) -> bool:
        """Whether it is there."""
        if s.point is None or s.depth is None or s.vague:
            self.node.show(False)
            return False
        depth = in_steps(s.depth)
        radius = RADIUS * depth
        self._resize(radius, HEIGHT * depth)
        origin = s.point.tolist()
        places = {name: _from(origin, s.by_method[name].point) for name in METHODS}
        true = _from(origin, s.true_point)
        times = _magnification(s, [*places.values(), true], radius)
        self.node.show(times >= LEAST)
        if times < LEAST:
            return False
        x, y, z = origin
        self.node.pose(position=(x, y, z + HEIGHT * depth))
        for name, shape in self.shapes.items():
            place = _larger(times, places[name])
            shape.draw(place, name == p.method, DOT * radius)
            self.names[name].show(place is not None and math.hypot(*place) > 0.15 * radius)
        self.true.place(_larger(times, true))
        self._rays(rig(p), s, origin, times, radius)
        self.region.draw(p, s, (0.0, 0.0, 0.0), times)
        self.label.text(f"close-up ×{times:g}" + (", 3σ" if p.show_ellipsoid else ""))
        self.gap_label.show(s.ray_gap > SEEN_GAP)
        self.gap_label.text(gap_in_words(s))
        return True

    def highlight(self, name: str) -> None:
        """Highlight the point of a method, the true point, or nothing."""
        for method, shape in self.shapes.items():
            shape.highlighted.show(method == name)
        self.highlighted.show(name == "true")

    def _resize(self, radius: float, height: float) -> None:
        self.glass.scale(radius)
        self.true.scale(0.8 * DOT * radius)
        self.highlighted.scale(1.4 * DOT * radius)
        self.string.stroke(((0.0, 0.0, -radius), (0.0, 0.0, -height)))
        self.label.pose(position=(0.0, 0.0, 1.15 * radius))
        self.gap_label.pose(position=(0.0, 0.0, -1.15 * radius))
        for name, label in self.names.items():
            label.pose(position=[DOT * radius * v for v in BESIDE[name][1]])

    def _rays(self, cameras: Rig, s: TriangulationSolution, origin: Place, times: float, radius: float) -> None:
        if s.closest_points is None:
            return
        near = [_larger(times, _from(origin, point)) or origin for point in s.closest_points]
        left, right = (
            chord(at, (camera.R.T @ [*sight, 1.0]).tolist(), radius)
            for at, camera, sight in zip(
                near, (cameras.left, cameras.right), (s.sight_left, s.sight_right), strict=True
            )
        )
        self.rays.draw((left, right, near))


def _magnification(s: TriangulationSolution, places: Sequence[Place | None], radius: float) -> float:
    """The largest round one at which everything still fits the glass."""
    longest = 0.0 if s.ellipsoid_axes is None else SIGMAS * s.ellipsoid_axes.item(0)
    room = radius / max(s.ray_gap, longest, *(math.hypot(*place) for place in places if place is not None))
    return MAGNIFICATIONS[max(bisect_right(MAGNIFICATIONS, room) - 1, 0)]


def _from(origin: Place, point: Array | None) -> Place | None:
    return None if point is None else [a - b for a, b in zip(point.tolist(), origin, strict=True)]


def _larger(times: float, place: Place | None) -> Place | None:
    return None if place is None else [round(times * v, PLACES) for v in place]


def chord(at: Place, along: Sequence[float], radius: float) -> tuple[Place, Place]:
    """The ends of what a glass holds of a line; a point of it where it misses."""
    a, b = sum(v * v for v in along), sum(u * v for u, v in zip(at, along, strict=True))
    half = math.sqrt(max(b * b - a * (sum(v * v for v in at) - radius**2), 0.0))
    start, end = ([u + t / a * v for u, v in zip(at, along, strict=True)] for t in (-b - half, -b + half))
    return start, end
