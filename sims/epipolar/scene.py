"""The scene: two cameras and their pictures, the baseline, points, rays, and the epipolar plane."""

from __future__ import annotations

from typing import Literal

import numpy as np

from sims.epipolar.candidate import Candidate
from sims.epipolar.drawing import CameraDrawing, Segment
from sims.epipolar.eye import eyes
from sims.epipolar.params import OTHERS, WORLD, EpipolarParams, Place, Side
from sims.epipolar.ray import Trail
from sims.epipolar.readouts import baseline, short_trouble
from sims.epipolar.solution import EpipolarSolution
from sims.kit.readout import quantity
from sims.kit.scene.camera_figure import CameraFigure, Post
from sims.kit.scene.stage import Stage
from sims.kit.types import ORIGIN
from sims.kit.view import View
from sims.kit.world_drawing import draw_in_scene

SPOT = 0.045
OTHER: dict[Side, Side] = {"left": "right", "right": "left"}


def seen(p: EpipolarParams, s: EpipolarSolution) -> list[Place]:
    """What must be in sight; not P while it slides along its ray, or the view would step back and forth."""
    centers = [s.drawn.left.center, s.drawn.right.center]
    return centers if s.trail is not None else [*centers, p.point]


SIDE_BY_SIDE = View((4.2, -3.4, 3.9), (0.0, 2.6, 0.9), 3.2)
BEHIND_EACH_OTHER = View((-4.5, -3.2, 4.4), (0.0, 2.5, 0.8), 3.5)
"""From the other side: from that of the first the epipolar plane is seen edge-on."""


def view_of(p: EpipolarParams) -> View:
    """From where both pictures and the epipolar plane are seen, as the cameras stand."""
    across, along, up = (abs(a - b) for a, b in zip(*(eye.center for eye in eyes(p)), strict=True))
    return BEHIND_EACH_OTHER if along > max(across, up) else SIDE_BY_SIDE


class EpipolarScene:
    """World coordinates, but for what lies on a camera's picture."""

    def __init__(self, stage: Stage) -> None:
        stage.ground(size=24.0, cell=0.5)
        draw_in_scene(stage, WORLD)
        self.cameras = CameraInScene(stage, "left", "L", "e"), CameraInScene(stage, "right", "R", "e′")
        self.baseline = stage.lines("/baseline", "ink", width=2.5)
        self.middle = stage.group("/middle")
        self.baseline_label = stage.label("/middle/label", "", (0.0, 0.0, -0.5))
        self.plane = stage.sheet("/plane", "held", opacity=0.16)
        self.rays = stage.strokes("/rays", ("left", "right"), width=1.8)
        stage.linked("point", self.rays)
        stage.linked("depth", self.rays)
        self.trail = TrailInScene(stage)
        self.candidate = CandidateInScene(stage)
        self.others = [stage.ball(f"/points/{k}", SPOT, "ink") for k in range(2, len(OTHERS) + 2)]
        for k, (ball, place) in enumerate(zip(self.others, OTHERS.tolist(), strict=True), start=2):
            ball.pose(position=place)
            stage.link(ball, f"{k}")
        self.grips = [stage.grip(f"/{name}_center", 0.1, halo=1.9) for name in ("left", "right")]
        for name, camera, grip in zip(("left", "right"), self.cameras, self.grips, strict=True):
            stage.carried_by(camera.figure.solids, f"/{name}_center", grip)
        self.held = stage.grip("/point", 0.06, halo=2.4)
        stage.link(self.held, "1")
        stage.label("/point/label", "P", (0.0, 0.0, 0.26))
        self.drop = stage.lines("/point/drop", "ghost", width=1.2)
        self.pick_ray = stage.lines("/pick_ray", "held", width=3.0)
        self.selected = Mark(stage, "/selected", width=1.8)
        self.selected_label = stage.label("/selected/ball/label", "", (0.0, 0.0, 0.22))
        self.highlighted = Mark(stage, "/lit", width=3.5)
        self.warning = stage.label("/warning", "")
        self.places: dict[str, Place] = {}
        self.centers: Segment = (ORIGIN, ORIGIN)

    def draw(self, p: EpipolarParams, s: EpipolarSolution) -> None:
        for drawn, camera, grip in zip((s.drawn.left, s.drawn.right), self.cameras, self.grips, strict=True):
            camera.draw(drawn)
            grip.pose(position=drawn.center)
            grip.show(p.pair is None)  # somebody's cameras stand as they were calibrated
        self.centers = s.drawn.left.center, s.drawn.right.center
        self._baseline(s)
        self._points(p)
        self._linked(p, s)
        self.rays.draw([(center, p.point) for center in self.centers])
        self.trail.draw(s.trail)
        self.candidate.draw(s.candidate)
        self.plane.vertices(s.drawn.plane if p.show_plane else None)
        self.pick_ray.stroke(s.drawn.picked_ray)
        trouble = short_trouble(s)
        self.warning.say(trouble and f"⚠ {trouble}")
        x, y, z = p.point if s.F is not None else self.centers[0]
        self.warning.pose(position=(x, y, z + 0.55))

    def _baseline(self, s: EpipolarSolution) -> None:
        left, right = self.centers
        self.baseline.stroke((left, right))
        x, y, _ = (0.5 * (a + b) for a, b in zip(left, right, strict=True))
        self.middle.pose(position=(x, y, min(left[2], right[2])))  # below both, where it hides neither
        self.baseline_label.text(baseline(s))

    def _points(self, p: EpipolarParams) -> None:
        self.held.pose(position=p.point)
        self.drop.stroke((ORIGIN, (0.0, 0.0, -p.point[2])))
        for k, ball in enumerate(self.others, start=2):
            ball.show(k <= p.points)

    def _linked(self, p: EpipolarParams, s: EpipolarSolution) -> None:
        self.places = {f"{k}": (x, y, z) for k, (x, y, z) in enumerate(s.points.tolist(), start=1)}
        self.selected.draw(self.places.get(f"{p.selected}") if p.selected > 1 else None, self.centers)
        self.selected_label.text(f"point {p.selected}")

    def highlight(self, name: str) -> None:
        """Highlight the point that somebody hovers over in a picture or the table, or none."""
        self.highlighted.draw(self.places.get(name), self.centers)


class TrailInScene:
    """The piece of the left ray along which P has slid, with a dot for each metre of depth."""

    def __init__(self, stage: Stage) -> None:
        self.line = stage.lines("/trail", "held", width=5.0)
        self.steps = stage.cloud("/trail_steps", "held", size=0.055)

    def draw(self, trail: Trail | None) -> None:
        self.line.stroke(None if trail is None else trail.ends)
        self.steps.show(trail is not None and len(trail.steps) > 0)
        if trail is not None:
            self.steps.points(trail.steps)


class CandidateInScene:
    """The ray of the free pixel, and the gap between it and the left ray."""

    def __init__(self, stage: Stage) -> None:
        self.ray = stage.lines("/candidate/ray", "held", width=2.5)
        self.gap = stage.lines("/candidate/gap", "held", width=5.0)
        self.place = stage.group("/candidate/place")
        self.words = stage.label("/candidate/place/label", "", (0.0, 0.0, -0.3))
        stage.linked("off_line", self.ray, self.gap)

    def draw(self, c: Candidate | None) -> None:
        self.ray.stroke(None if c is None else c.ray)
        self.gap.stroke(None if c is None else c.nearest)
        self.place.place(None if c is None or c.nearest is None else c.nearest[1])
        if c is not None and c.gap is not None:
            self.words.text(f"gap {quantity(c.gap, 'm', 2)}")


class Mark:
    """A point that is selected or highlighted: a ball in its place, and its lines of sight from both centres."""

    def __init__(self, stage: Stage, path: str, width: float) -> None:
        self.node = stage.group(path)
        self.node.show(False)
        self.ball = stage.ball(f"{path}/ball", 1.9 * SPOT, "held")
        self.rays = stage.strokes(f"{path}/rays", ("left", "right"), width=width)

    def draw(self, place: Place | None, centers: Segment) -> None:
        self.node.show(place is not None)
        self.ball.place(place)
        if place is not None:
            self.rays.draw([(center, place) for center in centers])


class CameraInScene:
    """One camera, and what lies on its picture."""

    def __init__(self, stage: Stage, name: Literal["left", "right"], letter: str, epipole: str) -> None:
        path, other = f"/{name}", OTHER[name]
        self.figure = CameraFigure(stage, path, name, letter)
        self.post = Post(stage, path)
        self.pixel = stage.ball(f"{path}/pixel", 0.022, name)
        self.others = stage.cloud(f"{path}/others", name, size=0.016)
        self.line = stage.lines(f"{path}/line", other, width=3.0)
        for parameter in (name, f"{name}_pan", "focal"):
            stage.linked(parameter, self.figure.edges)
        self.stretch = stage.lines(f"{path}/stretch", other, width=1.2)
        self.all_lines = stage.lines(f"{path}/all_lines", other, width=1.0)
        self.picked_line = stage.lines(f"{path}/picked_line", "held", width=4.0)
        self.epipole = stage.group(f"{path}/epipole")
        stage.ball(f"{path}/epipole/ball", 0.03, "ink")
        stage.label(f"{path}/epipole/label", epipole, (0.0, -0.12, 0.0))
        self.toward = stage.lines(f"{path}/toward", "ink", width=1.2)

    def draw(self, d: CameraDrawing) -> None:
        self.figure.node.pose(d.wxyz, d.center)
        self.figure.draw(d.corners, d.size)
        self.post.draw(d.up, d.center[2], d.size)
        self.pixel.place(d.pixel)
        self.epipole.place(d.epipole)
        self.toward.stroke(None if d.epipole is None else (ORIGIN, d.epipole))
        self.line.stroke(d.line)
        self.stretch.stroke(d.stretch)
        self.picked_line.stroke(d.picked_line)
        self.others.show(len(d.others) > 0)
        self.others.points(d.others)
        self.all_lines.pieces(np.array(d.all_lines) if d.all_lines else None)
