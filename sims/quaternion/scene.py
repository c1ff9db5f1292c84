"""The scene: the object between its start and its target, the axis with its angle, p, and the nose's paths."""

from __future__ import annotations

import math

import numpy as np
import trimesh

from sims.kit.readout import quantity
from sims.kit.scene.stage import Stage
from sims.quaternion.params import TIP, QuaternionParams
from sims.quaternion.paths import Name, NosePath
from sims.quaternion.solution import QuaternionSolution

ARC, HEIGHT = 0.42, 1.4
"""Radius of the angle's arc, and how far up the axis it is, in metres: outside the unit sphere."""
SPHERE = trimesh.creation.icosphere(subdivisions=4)
ARROWHEAD = trimesh.creation.cone(radius=0.05, height=0.15, sections=24)
ARROWHEAD.apply_transform(trimesh.transformations.rotation_matrix(-0.5 * np.pi, (1.0, 0.0, 0.0)))
ARROWHEAD.apply_translation((ARC, -0.12, 0.0))
NAMES: dict[Name, str] = {"slerp": "SLERP", "nlerp": "NLERP", "euler": "Euler"}


class QuaternionScene:
    """All about the origin."""

    def __init__(self, stage: Stage) -> None:
        stage.ground(size=6.0, height=-1.4)
        stage.axes("/world", 1.12, radius=0.008)
        self.object = stage.axes("/object", 1.08, radius=0.018, letters=None)
        stage.aircraft("/object")
        self.start, self.target = Ghost(stage, "start"), Ghost(stage, "target")
        self.axis = Axis(stage)
        self.sphere = Sphere(stage)
        self.point = Point(stage)
        self.euler = stage.label("/euler", "", (0.0, 0.0, -1.32))

    def draw(self, p: QuaternionParams, s: QuaternionSolution) -> None:
        self.object.pose(s.interpolated.q.tolist())
        self.start.draw(s.start.tolist(), not s.at_start)
        self.target.draw(s.q_total.tolist(), not s.at_target)
        self.axis.draw(p, s)
        self.sphere.draw(p, s)
        self.point.draw(p, s)
        self.euler.say(euler_in_words(s) if p.show_euler else None)


def euler_in_words(s: QuaternionSolution) -> str:
    """Yaw, pitch and roll of the target."""
    named = zip(("yaw", "pitch", "roll"), s.euler, strict=True)
    return ", ".join(f"{name} {quantity(angle, '°', 0)}" for name, angle in named)


class Ghost:
    """The object where it starts, or where it goes."""

    def __init__(self, stage: Stage, name: str) -> None:
        self.node = stage.group(f"/{name}")
        stage.aircraft(f"/{name}", ghost=(0.22, 0.35))
        stage.label(f"/{name}/label", name, (-0.98, 0.0, 0.42))

    def draw(self, wxyz: list[float], visible: bool) -> None:
        self.node.show(visible)
        if visible:
            self.node.pose(wxyz)


class Axis:
    """The axis as an arrow whose tip the learner holds, and the arc of the angle about it."""

    def __init__(self, stage: Stage) -> None:
        self.frame = stage.group("/axis")
        arrow = stage.arrow("/axis/arrow", "held", (0.0, 0.0, 0.0), (0.0, 0.0, TIP - 0.03), radius=0.018)
        stage.linked("axis", arrow)
        stage.lines("/axis/back", "held", [(0.0, 0.0, 0.0), (0.0, 0.0, -TIP)], width=1.5, dash=(0.06, 0.05))
        self.turn = stage.group("/axis/turn")
        self.turn.pose(position=(0.0, 0.0, HEIGHT))
        self.line = stage.lines("/axis/turn/arc", "held", [(ARC, 0.0, 0.0), (ARC, 0.0, 0.001)], width=4.0)
        stage.lines("/axis/turn/begin", "ghost", [(0.0, 0.0, 0.0), (ARC, 0.0, 0.0)], width=1.5)
        self.end = stage.lines("/axis/turn/end", "held", [(0.0, 0.0, 0.0), (ARC, 0.0, 0.0)], width=1.5)
        stage.mesh("/axis/turn/end/head", ARROWHEAD, "held")
        stage.linked("angle", self.line, self.end)
        self.label = stage.label("/axis/turn/label", "")
        self.tip = stage.grip("/tip", 0.05)
        stage.label("/tip/label", "n", (0.0, 0.0, 0.17))

    def draw(self, p: QuaternionParams, s: QuaternionSolution) -> None:
        self.frame.pose(s.axis_frame.tolist())
        self.tip.pose(position=s.tip.tolist())
        radians = math.radians(p.angle)
        self.turn.show(p.angle > 0.0)
        self.line.arc(ARC, radians)
        self.end.pose((math.cos(radians / 2), 0.0, 0.0, math.sin(radians / 2)))
        middle = 1.4 * ARC * math.cos(radians / 2), 1.4 * ARC * math.sin(radians / 2), 0.0
        self.label.pose(position=middle)
        self.label.text(f"θ {quantity(p.angle, '°', 0)}")


class Sphere:
    """The unit sphere with the paths of the nose."""

    def __init__(self, stage: Stage) -> None:
        self.node = stage.group("/sphere")
        stage.mesh("/sphere/ball", SPHERE, "ghost", opacity=0.1, side="back")
        for axis, turn in {"x": (0.5, 0.5, 0.5, 0.5), "y": (0.5, -0.5, -0.5, -0.5), "z": (1.0, 0.0, 0.0, 0.0)}.items():
            circle = stage.lines(f"/sphere/circle_{axis}", "ghost", width=0.8)
            circle.arc(1.0, 2.0 * math.pi)
            circle.pose(turn)
        self.paths = {name: Path(stage, name) for name in NAMES}

    def draw(self, p: QuaternionParams, s: QuaternionSolution) -> None:
        self.node.show(p.show_paths)
        if not p.show_paths:
            return
        for name, path in self.paths.items():
            path.draw(s.ways[name], p.interpolation)


class Path:
    """One interpolation's path and marks: thick in ink where it is the chosen one, else thin as a ghost."""

    def __init__(self, stage: Stage, name: Name) -> None:
        self.name = name
        path = f"/sphere/{name}"
        stage.group(path)
        self.thick = stage.lines(f"{path}/chosen", "ink", width=3.5)
        self.thin = stage.lines(f"{path}/ghost", "ghost", width=1.5)
        stage.linked("interpolation", self.thick)
        stage.linked("t", self.thick)
        self.label = stage.label(f"{path}/label", NAMES[name])

    def draw(self, way: NosePath, chosen: Name) -> None:
        """Where SLERP's and NLERP's arc is drawn for one of them, only the other's marks are added."""
        line, other = (self.thick, self.thin) if chosen == self.name else (self.thin, self.thick)
        line.pieces(way.marks if {self.name, chosen} == {"slerp", "nlerp"} else way.drawn)
        other.show(False)
        self.label.show(chosen == self.name)
        if chosen == self.name:
            self.label.pose(position=(1.2 * way.path[len(way.path) // 2]).tolist())


class Point:
    """p, which the learner holds, its image, and the arc about the axis between them."""

    def __init__(self, stage: Stage) -> None:
        self.grip = stage.grip("/point", 0.045)
        stage.label("/point/label", "p", (0.0, 0.0, -0.16))
        self.image = stage.ball("/image", 0.055, "ink")
        self.image_name = stage.label("/image/label", "p′", (0.0, 0.0, -0.16))
        self.track = stage.lines("/axis/track", "held", width=1.8, dash=(0.03, 0.04))
        stage.linked("point", self.track)

    def draw(self, p: QuaternionParams, s: QuaternionSolution) -> None:
        turning = s.track.radius > 0.01 and p.angle > 0.0
        self.grip.show(p.show_point)
        self.image.show(p.show_point)
        self.image_name.show(s.moved)
        self.track.show(p.show_point and turning)
        if not p.show_point:
            return
        self.grip.pose(position=p.point)
        self.image.pose(position=s.rotated_point.tolist())
        if turning:
            self.track.arc(s.track.radius, math.radians(p.angle), s.track.begin)
            self.track.pose(position=(0.0, 0.0, s.track.height))
