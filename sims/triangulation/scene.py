"""The scene: two cameras, their rays, the points that the methods find, and how sure they are."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from geometry.arrays import Array
from geometry.camera import Camera
from sims.kit.readout import THIN, figure, quantity
from sims.kit.scene.camera_figure import CameraFigure
from sims.kit.scene.stage import Stage
from sims.kit.types import ORIGIN, Pixel
from sims.kit.world_drawing import draw_in_scene
from sims.triangulation.corners import WORLD
from sims.triangulation.params import NAMES, TriangulationParams
from sims.triangulation.rig import Rig, Standing, rig
from sims.triangulation.scene_closeup import CloseUp
from sims.triangulation.scene_region import SEEN_GAP, Region, gap_in_words, in_steps
from sims.triangulation.scene_shapes import Shape
from sims.triangulation.solution import METHODS, TriangulationSolution

FAR = 12.0
"""Metres that a ray is drawn when it leads to no point."""
BACKWARD = 4.0
"""Metres that it is drawn backwards, to where the lines of sight meet."""
LEAST_AHEAD = 0.5
"""How much of a line of sight leads ahead at least where words stand between both."""
RADIUS = 0.06
POST = (0.0, 0.08, -0.12)
"""Where the post begins on which a camera stands, in its axes."""
WARNINGS = {"parallel": "⚠ parallel rays: no finite point", "behind": "⚠ no point in front: the rays diverge"}


def seen(p: TriangulationParams, s: TriangulationSolution) -> list[Array]:
    """What must be in sight."""
    places = [np.array(each.center) for each in rig(p).standing]
    return places if s.target is None else [*places, s.target]


class TriangulationScene:
    """The middle between both cameras is at a height of 1 m; they look along Y, somebody's own to both sides of it."""

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
        left, right = cameras.standing
        sights = (left, cameras.left, s.sight_left), (right, cameras.right, s.sight_right)
        for k, (drawn, (standing, camera, sight)) in enumerate(zip(self.cameras, sights, strict=True)):
            drawn.stand(standing, camera, cameras.size, sight)
            behind = s.closest_points[k] if s.status == "behind" and s.closest_points is not None else None
            drawn.look(*(None if at is None else camera.to_camera(at).item(2) for at in (s.point, behind)))
        self.baseline.stroke((left.center, right.center))
        self.baseline_label.text(f"baseline {quantity(p.baseline, 'm', 2)}")
        self._held(s)
        for name, shape in self.points.items():
            found = s.by_method[name].point
            shape.draw(None if found is None else found.tolist(), name == p.method, RADIUS)
        at = ORIGIN if s.point is None else s.point.tolist()
        self.region.draw(p, s, at)
        self._gap(s)
        self._in_words(p, s, at, self.closeup.draw(p, s))
        self._warn(s, cameras)

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
        self.words.text(f"{NAMES[p.method]}: depth {figure(s.depth or 0.0, digits)}{unsure}{THIN}m{cut}")

    def _warn(self, s: TriangulationSolution, cameras: Rig) -> None:
        self.warning.show(s.point is None or s.vague)
        if s.point is not None and not s.vague:
            return
        self.warning.text(WARNINGS.get(s.status, "⚠ almost parallel: depth unknown"))
        sights = (cameras.left, s.sight_left), (cameras.right, s.sight_right)
        x, y = np.mean([camera.R.T[:2] @ [*sight, 1.0] for camera, sight in sights], axis=0).tolist()
        self.warning.pose(position=(3.0 * x / max(y, LEAST_AHEAD), 3.0, 1.5))


class CameraInScene:
    """One camera with the pixel that it measured, and the line of sight through it."""

    def __init__(self, stage: Stage, name: Literal["left", "right"], letter: str) -> None:
        path = f"/{name}"
        self.name = name
        self.figure = CameraFigure(stage, path, name, letter)
        self.post = stage.lines(f"{path}/post", "ghost", width=1.2)
        self.pixel = stage.ball(f"{path}/pixel", 0.016, name)
        self.ray = stage.lines(f"{path}/ray", name, width=1.8)
        stage.linked("focal", self.figure.edges)
        stage.linked(f"{name}_uv", self.ray)
        self.back = stage.lines(f"{path}/back", name, width=1.5, dash=(0.08, 0.08))
        self.highlighted = stage.lines(f"{path}/lit", name, width=6.0)
        self.highlighted.show(False)
        self.sight: Pixel = (0.0, 0.0)
        self.end = ORIGIN

    def stand(self, standing: Standing, camera: Camera, size: float, sight: Pixel) -> None:
        """Draw the camera with its measured pixel; `sight` is x and y of that at depth 1, in the camera's axes."""
        self.figure.node.pose(standing.wxyz, standing.center)
        self.figure.draw(standing.corners, size)
        down = (standing.center[2] - POST[1]) * camera.R[:, 2]
        self.post.stroke((POST, tuple((POST - down).tolist())))
        near = standing.corners.item(0, 2)
        self.sight = x, y = sight
        self.pixel.pose(position=(x * near, y * near, near))
        self.pixel.scale(size)

    def look(self, depth: float | None, behind: float | None) -> None:
        """Draw the line of sight: to a point's depth, or back to where it is nearest the other one, if either is."""
        x, y = self.sight
        far = FAR if depth is None else 1.2 * in_steps(depth) + 0.15
        self.end = x * far, y * far, far
        self.ray.stroke((ORIGIN, self.end))
        back = 0.0 if behind is None else min(max(behind, -BACKWARD), 0.0)
        self.back.show(back < 0.0)
        if back < 0.0:
            self.back.path([ORIGIN, (x * back, y * back, back)])

    def highlight(self, name: str) -> None:
        """Make the ray thick if it has that name."""
        self.highlighted.stroke((ORIGIN, self.end) if name == self.name else None)
