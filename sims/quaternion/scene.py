"""The scene: the object between its start and its target, and the axis with its angle; then what a topic adds."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import trimesh

from geometry import quaternion
from sims.kit.readout import quantity
from sims.kit.scene.stage import Stage
from sims.quaternion.params import TIP, WHOLE, QuaternionParams
from sims.quaternion.scene_orders import BothOrders
from sims.quaternion.scene_ways import Ways
from sims.quaternion.solution import QuaternionSolution

ARC, HEIGHT = 0.42, 1.4
"""Radius of the angle's arc, and how far up the axis it is, in metres: outside the unit sphere."""
BESIDE = 0.72
"""Metres from the axis to the angle in words: clear of what the arc is held by."""
LEAST = 0.6
"""Metres from the middle within which the object, or its axis, is turned as a ball of that radius."""
GRASP = trimesh.creation.cylinder(radius=0.07, segment=[(0.0, 0.0, 0.0), (0.0, 0.0, TIP - 0.1)], sections=12)
"""What is held of the axis' arrow: wider than it is, for fingers."""
LAP = 0.12
"""How far below the arc the circle of the first whole turn is, once the angle is in its second."""


class QuaternionScene:
    """All about the origin."""

    def __init__(self, stage: Stage) -> None:
        stage.ground(size=6.0, height=-1.4)
        self.world = stage.axes("/world", 1.12, radius=0.008)
        self.object = stage.axes("/object", 1.08, radius=0.018, letters=None)
        self.R = np.eye(3)
        stage.pulled(stage.aircraft("/object"), "/object", partial(getattr, self, "R"), least=LEAST)
        self.start, self.target = Ghost(stage, "start"), Ghost(stage, "target")
        self.axis = Axis(stage)
        self.point = Point(stage)
        self.ways, self.orders = Ways(stage), BothOrders(stage)
        self.euler = stage.label("/euler", "", (0.0, 0.0, -1.32))

    def draw(self, p: QuaternionParams, s: QuaternionSolution) -> None:
        alone = p.topic not in ("order", "path")
        self.object.show(alone)
        self.object.pose(s.interpolated.q.tolist())
        self.R = s.interpolated.R
        self.world.show(alone)
        self.start.draw(s.start.tolist(), alone and not s.at_start)
        self.target.draw(s.q_total.tolist(), alone and not s.at_target)
        self.axis.draw(p, s, alone)
        self.point.draw(p, s, p.topic == "point" and p.show_point)
        self.ways.draw(p, s)
        self.orders.draw(s)
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
    """The axis as an arrow, held by its tip or anywhere along it, and the arc of the angle about it."""

    def __init__(self, stage: Stage) -> None:
        self.frame = stage.group("/axis")
        arrow = stage.arrow("/axis/arrow", "held", (0.0, 0.0, 0.0), (0.0, 0.0, TIP - 0.03), radius=0.018)
        stage.linked("axis", arrow)
        self.R = np.eye(3)
        grasp = stage.mesh("/axis/grasp", GRASP, "held", opacity=0.0)  # arrows can't be held
        stage.pulled([grasp], "/axis", partial(getattr, self, "R"), least=LEAST)
        stage.lines("/axis/back", "held", [(0.0, 0.0, 0.0), (0.0, 0.0, -TIP)], width=1.5, dash=(0.06, 0.05))
        self.turn = stage.group("/axis/turn")
        self.turn.pose(position=(0.0, 0.0, HEIGHT))
        self.lap = stage.lines("/axis/turn/lap", "held", width=2.0)
        self.lap.arc(ARC, 2.0 * math.pi)
        self.lap.pose(position=(0.0, 0.0, -LAP))
        self.line = stage.lines("/axis/turn/arc", "held", [(ARC, 0.0, 0.0), (ARC, 0.0, 0.001)], width=4.0)
        stage.lines("/axis/turn/begin", "ghost", [(0.0, 0.0, 0.0), (ARC, 0.0, 0.0)], width=1.5)
        self.end = stage.lines("/axis/turn/end", "held", [(0.0, 0.0, 0.0), (ARC, 0.0, 0.0)], width=1.5)
        stage.linked("angle", self.line, self.end)
        self.label = stage.label("/axis/turn/label", "")
        self.n = np.array([0.0, 0.0, 1.0])
        self.hand = stage.grip("/angle", 0.045, axis=partial(getattr, self, "n"))
        self.tip = stage.grip("/tip", 0.05)
        stage.label("/tip/label", "n", (0.0, 0.0, 0.17))

    def draw(self, p: QuaternionParams, s: QuaternionSolution, visible: bool) -> None:
        self.frame.show(visible)
        self.tip.show(visible)
        self.hand.show(visible)
        self.n = s.n
        self.R = frame = quaternion.to_matrix(s.axis_frame)
        radians = math.radians(p.angle)
        self.hand.pose(position=(frame @ (ARC * math.cos(radians), ARC * math.sin(radians), HEIGHT)).tolist())
        self.frame.pose(s.axis_frame.tolist())
        self.tip.pose(position=s.tip.tolist())
        again = p.angle > WHOLE
        radians = math.radians(p.angle - WHOLE if again else p.angle)
        self.lap.show(again)
        self.line.show(p.angle > 0.0)
        self.line.arc(ARC, radians)
        self.end.pose((math.cos(radians / 2), 0.0, 0.0, math.sin(radians / 2)))
        middle = BESIDE * math.cos(radians / 2), BESIDE * math.sin(radians / 2), 0.0
        self.label.pose(position=middle)
        self.label.text(f"θ {quantity(p.angle, '°', 0)}")


class Point:
    """p, which the learner holds, its image, and the arc about the axis between them."""

    def __init__(self, stage: Stage) -> None:
        self.grip = stage.grip("/point", 0.045)
        stage.label("/point/label", "p", (0.0, 0.0, -0.16))
        self.image = stage.ball("/image", 0.055, "ink")
        self.image_name = stage.label("/image/label", "p′", (0.0, 0.0, -0.16))
        self.track = stage.lines("/axis/track", "held", width=1.8, dash=(0.03, 0.04))
        stage.linked("point", self.track)

    def draw(self, p: QuaternionParams, s: QuaternionSolution, visible: bool) -> None:
        turning = s.track.radius > 0.01 and p.angle > 0.0
        self.grip.show(visible)
        self.image.show(visible)
        self.image_name.show(s.moved)
        self.track.show(visible and turning)
        if not visible:
            return
        self.grip.pose(position=p.point)
        self.image.pose(position=s.rotated_point.tolist())
        if turning:
            self.track.arc(s.track.radius, math.radians(min(p.angle, WHOLE)), s.track.begin)
            self.track.pose(position=(0.0, 0.0, s.track.height))
