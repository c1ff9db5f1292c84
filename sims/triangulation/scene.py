"""The scene: two cameras, their rays, the points that the methods find, and how sure they are."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from geometry import quaternion
from geometry.arrays import Array
from geometry.camera import R_WORLD_LEVEL
from sims.kit.readout import THIN, figure, quantity
from sims.kit.scene.camera_figure import CameraFigure
from sims.kit.scene.stage import Stage
from sims.kit.types import ORIGIN
from sims.kit.world_drawing import draw_in_scene
from sims.triangulation.corners import WORLD
from sims.triangulation.holding import Pixel
from sims.triangulation.params import NAMES, TriangulationParams
from sims.triangulation.rig import rig
from sims.triangulation.scene_closeup import CloseUp
from sims.triangulation.scene_region import SEEN_GAP, Region, gap_in_words, in_steps
from sims.triangulation.scene_shapes import Shape
from sims.triangulation.solution import METHODS, TriangulationSolution

LEVEL = quaternion.from_matrix(R_WORLD_LEVEL).tolist()
FAR = 12.0
"""Metres that a ray is drawn when it leads to no point."""
BACKWARD = 4.0
"""Metres that it is drawn backwards, to where the lines of sight meet."""
RADIUS = 0.06
WARNINGS = {"parallel": "⚠ parallel rays: no finite point", "behind": "⚠ no point in front: the rays diverge"}


def seen(p: TriangulationParams, s: TriangulationSolution) -> list[Array]:
    """What must be in sight."""
    places = [np.array([sign * p.baseline / 2, 0.0, 1.0]) for sign in (-1, 1)]
    return places if s.target is None else [*places, s.target]


class TriangulationScene:
    """Both cameras stand at a height of 1 m and look along Y."""

    def __init__(self, stage: Stage) -> None:
        stage.ground(size=16.0, cell=0.5)
        draw_in_scene(stage, WORLD)
        self.cameras = [CameraInScene(stage, "left", "L"), CameraInScene(stage, "right", "R")]
        self.baseline = stage.lines("/baseline", "ink", width=2.0)
        stage.linked("baseline", self.baseline)
        self.baseline_label = stage.label("/baseline/label", "", (0.0, -0.1, 0.45))
        self.points = {name: Shape(stage, f"/{name}", name) for name in METHODS}
        self.label = stage.group("/result")
        self.words = stage.label("/result/label", "", (-0.1, 0.0, 0.1), anchor="bottom-right")
        self.drop = stage.lines("/result/drop", "ghost", width=1.2)
        self.gap = stage.lines("/gap", "held", width=5.0)
        self.gap_label = stage.label("/gap/label", "")
        self.grip = stage.grip("/point", 0.75 * RADIUS, halo=2.8)
        self.true_label = stage.label("/point/label", "true point", (0.08, 0.0, -0.08), anchor="top-left")
        self.region = Region(stage, "/uncertainty", 0.004, opacity=0.45)
        self.closeup = CloseUp(stage)
        self.highlighted = stage.ball("/point/lit", 1.3 * RADIUS, "held")
        self.highlighted.show(False)
        self.warning = stage.label("/warning", "")

    def draw(self, p: TriangulationParams, s: TriangulationSolution) -> None:
        cameras = rig(p)
        half = 0.5 * p.baseline
        left, right = self.cameras
        left.draw(cameras.corners_left, cameras.size, s, s.sight_left, -half)
        right.draw(cameras.corners_right, cameras.size, s, s.sight_right, half)
        self.baseline.stroke(((-half, 0.0, 1.0), (half, 0.0, 1.0)))
        self.baseline_label.text(f"baseline {quantity(p.baseline, 'm', 2)}")
        self._held(s)
        for name, shape in self.points.items():
            found = s.by_method[name].point
            shape.draw(None if found is None else found.tolist(), name == p.method, RADIUS)
        at = ORIGIN if s.point is None else s.point.tolist()
        self.region.draw(p, s, at)
        self._gap(s)
        self._in_words(p, s, at, self.closeup.draw(p, s))
        self._warn(s)

    def highlight(self, name: str) -> None:
        """Highlight what somebody hovers over: an image point's ray, the point of a method, or the true point."""
        for camera in self.cameras:
            camera.highlight(name)
        for method, shape in self.points.items():
            shape.highlighted.show(method == name)
        self.highlighted.show(name == "true")
        self.closeup.highlight(name)

    def _held(self, s: TriangulationSolution) -> None:
        self.grip.place(None if s.target is None else s.target.tolist())
        self.true_label.show(s.true_point is not None)

    def _gap(self, s: TriangulationSolution) -> None:
        seen = s.by_method["midpoint"].point is not None and s.ray_gap > 1e-9 and s.point is not None
        self.gap.stroke(s.closest_points.tolist() if seen and s.closest_points is not None else None)

    def _in_words(self, p: TriangulationParams, s: TriangulationSolution, at: Sequence[float], closeup: bool) -> None:
        """The result, and what the close-up says where there is one."""
        self.gap_label.show(s.point is not None and not closeup and s.ray_gap > SEEN_GAP)
        self.label.show(s.point is not None)
        x, y, z = at
        self.label.pose(position=(x, y, z))
        self.drop.stroke((ORIGIN, (0.0, 0.0, -z)))
        if not closeup:
            self.gap_label.pose(position=(x, y, z + 0.45))
            self.gap_label.text(gap_in_words(s))
        digits = 2 if s.depth_sigma is None or s.depth_sigma >= 0.005 else 4
        unsure = f" ± {figure(s.depth_sigma, digits)}" if s.depth_sigma is not None and not s.vague else ""
        cut = ", ellipsoid cut" if p.show_ellipsoid and s.drawn_part < 1.0 and not s.vague else ""
        self.words.text(f"{NAMES[p.method]}: depth {figure(y, digits)}{unsure}{THIN}m{cut}")

    def _warn(self, s: TriangulationSolution) -> None:
        self.warning.show(s.point is None or s.vague)
        if s.point is not None and not s.vague:
            return
        self.warning.text(WARNINGS.get(s.status, "⚠ almost parallel: depth unknown"))
        x = 0.5 * (s.sight_left[0] + s.sight_right[0])
        self.warning.pose(position=(3.0 * x, 3.0, 1.5))


class CameraInScene:
    """One camera with the pixel that it measured, and the line of sight through it."""

    def __init__(self, stage: Stage, name: Literal["left", "right"], letter: str) -> None:
        path = f"/{name}"
        self.name = name
        self.figure = CameraFigure(stage, path, name, letter)
        stage.lines(f"{path}/post", "ghost", [(0.0, 0.08, -0.12), (0.0, 1.0, -0.12)], width=1.2)
        self.pixel = stage.ball(f"{path}/pixel", 0.016, name)
        self.ray = stage.lines(f"{path}/ray", name, width=1.8)
        stage.linked("focal", self.figure.edges)
        stage.linked(f"{name}_uv", self.ray)
        self.back = stage.lines(f"{path}/back", name, width=1.5, dash=(0.08, 0.08))
        self.highlighted = stage.lines(f"{path}/lit", name, width=6.0)
        self.highlighted.show(False)
        self.end = ORIGIN

    def draw(self, corners: Array, size: float, s: TriangulationSolution, sight: Pixel, at: float) -> None:
        self.figure.node.pose(LEVEL, (at, 0.0, 1.0))
        self.figure.draw(corners, size)
        x, y = sight
        near = corners.item(0, 2)
        self.pixel.pose(position=(x * near, y * near, near))
        self.pixel.scale(size)
        far = FAR if s.depth is None else 1.2 * in_steps(s.depth) + 0.15
        self.end = x * far, y * far, far
        self.ray.stroke((ORIGIN, self.end))
        self.back.show(s.status == "behind")
        if s.status == "behind":
            back = max(0.0 if s.closest_points is None else s.closest_points.item(0, 1), -BACKWARD)
            self.back.path([ORIGIN, (x * back, y * back, back)])

    def highlight(self, name: str) -> None:
        """Make the ray thick if it has that name."""
        self.highlighted.stroke((ORIGIN, self.end) if name == self.name else None)
