"""The scene: the arm, its transforms as arrows, what a joint's turn traces, the arm with two transforms exchanged."""

from __future__ import annotations

import math

from sims.kit.scene.nodes import Arrows, Label, Node
from sims.kit.scene.stage import Stage
from sims.kit.types import IDENTITY, ORIGIN
from sims.transform_chain import meshes
from sims.transform_chain.labels import said, world
from sims.transform_chain.params import ChainParams
from sims.transform_chain.scene_arm import Arm, frame
from sims.transform_chain.scene_spans import Straight
from sims.transform_chain.solution import ENOUGH, ChainSolution

LINKED = ("angles", "lengths", "axes", "offsets")
"""Lists whose controls stand for a link each."""
POINTING = {"x": IDENTITY, "z": (math.sqrt(0.5), 0.0, -math.sqrt(0.5), 0.0)}
"""Turns the gripper, which points along x."""


class ChainScene:
    """The arm stands on a column; the world's origin is where its first joint is."""

    def __init__(self, stage: Stage) -> None:
        stage.ground(size=8.0, height=meshes.FLOOR)
        self.world = stage.arrows("/world", ("x", "y", "z"), meshes.AXES, radius=0.0145)
        grey = (70, 80, 92) if stage.palette.dark else (166, 176, 187)
        stage.mesh("/foot", meshes.foot(), grey)
        self.column = stage.mesh("/column", meshes.column(), grey)
        self.stage = stage
        self.arm = Arm(stage, "")
        self.end = End(stage)
        self.grip = stage.grip("/grip", 0.032, halo=2.4)
        stage.carried_by(self.end.parts, "/grip", self.grip)
        self.composed: list[Straight[Arrows]] = []
        self.circle = stage.lines("/trace", "held", width=2.5, dash=(0.06, 0.05))
        stage.linked("trace", self.circle)
        self.status = Status(stage)
        self.target = Target(stage)
        self.ghost: Ghost | None = None
        self.words = Words(stage)

    def draw(self, p: ChainParams, s: ChainSolution) -> None:
        self.world.scale(world(s))
        self.arm.draw(s.joints, s.size, p.stage, arrows=p.show == "individual", tool=s.tool)
        self.arm.hold(s.holds, s.lines, s.size)
        self.column.pose(position=(0.0, 0.0, -meshes.AXLE * s.size))
        self.column.scale((s.size, s.size, -meshes.FLOOR - meshes.AXLE * s.size))
        self.end.draw(p, s)
        self.grip.pose(position=s.end)
        self.grip.scale(s.size)
        self._compose(p, s)
        self.circle.show(s.circle is not None)
        if s.circle is not None:
            self.circle.pose(s.circle.wxyz, s.circle.centre)
            self.circle.arc(max(s.circle.radius, 1e-6), 2.0 * math.pi)
        self.target.draw(p, s)
        self.status.draw(p, s)
        self._swap(p, s)
        self.words.draw(p, s)

    def highlight(self, name: str) -> None:
        """A link's arrow and frame stand out with its controls and matrices."""
        field, _, k = name.partition(".")
        number = int(k) + 1 if field in LINKED and k.isdecimal() else 0
        self.arm.stress(number)
        for i, straight in enumerate(self.composed, start=1):
            straight.node.stress(i == number or name == "show")
        self.end.axes.stress(number == self.arm.count)
        if name == "show":
            self.arm.stress_arrows()

    def _compose(self, p: ChainParams, s: ChainSolution) -> None:
        shown = s.spans if p.show == "composed" else ()
        while len(self.composed) < len(shown):
            self.composed.append(Straight(self._arrow(f"/composed{len(self.composed) + 1}")))
        for i, straight in enumerate(self.composed, start=1):
            straight.node.thickness(meshes.ARROW * s.size)
            straight.draw(shown[i - 1] if i <= len(shown) and p.stage in (None, i) else None)

    def _arrow(self, name: str) -> Arrows:
        return self.stage.arrows(name, "ink", radius=meshes.ARROW)

    def _swap(self, p: ChainParams, s: ChainSolution) -> None:
        if self.ghost is None:
            if s.swapped is None:
                return
            self.ghost = Ghost(self.stage)
        self.ghost.draw(p, s)


class Words:
    """The labels, made as they are needed."""

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self._labels: dict[str, Label] = {}
        stage.group("/words")

    def draw(self, p: ChainParams, s: ChainSolution) -> None:
        words = {word.name: word for word in said(p, s)}
        for name in words.keys() - self._labels.keys():
            self._labels[name] = self._stage.label(f"/words/{name}", "")
        for name, label in self._labels.items():
            word = words.get(name)
            label.say(None if word is None else word.text)
            if word is not None:
                label.pose(position=word.place)


class End:
    """The end effector: a gripper with a thick frame, and the point that is taken through the chain."""

    def __init__(self, stage: Stage) -> None:
        self.node = stage.group("/end_effector")
        parts = meshes.gripper()
        grey = (126, 138, 152) if stage.palette.dark else (140, 152, 166)
        self.parts = [
            stage.mesh("/end_effector/hand", parts["hand"], grey, flat=True),
            stage.mesh("/end_effector/mark", parts["mark"], "held", flat=True),
        ]
        self.axes = stage.arrows("/end_effector/axes", ("x", "y", "z"), meshes.END * meshes.AXES, radius=0.017)
        self.point = stage.ball("/end_effector/point", 0.028, "ink")
        self.arm = stage.lines("/end_effector/arm", "ink", width=1.5, dash=(0.03, 0.03))
        stage.linked("point", self.arm)

    def draw(self, p: ChainParams, s: ChainSolution) -> None:
        self.node.pose(s.wxyz, s.end)
        for part in self.parts:
            part.pose(POINTING[s.tool])
            part.scale(s.size)
        self.axes.scale(s.size)
        self.point.pose(position=p.point)
        self.point.scale(s.size)
        self.arm.path([ORIGIN, p.point])


class Ghost:
    """The arm with two transforms exchanged, from these on: before them it is the same."""

    def __init__(self, stage: Stage) -> None:
        self.node = stage.group("/swapped")
        self.arm = Arm(stage, "/swapped", ghost=True)
        self.end = stage.group("/swapped_end")
        self.frame = frame(stage, "/swapped_end/frame")
        self.apart = Straight(stage.lines("/swapped_apart", "ghost", width=1.5))

    def draw(self, p: ChainParams, s: ChainSolution) -> None:
        for node in (self.node, self.end):
            node.show(s.swapped is not None)
        self.apart.draw(None if s.swapped is None else s.swapped.apart)
        if s.swapped is None:
            return
        self.node.pose(s.swapped.wxyz, s.swapped.origin)
        self.arm.draw(s.swapped.joints, 0.92 * s.size)
        self.end.pose(s.swapped.end_wxyz, s.swapped.end)
        self.frame.scale(meshes.END * s.size)


class Status:
    """What hinders the end effector."""

    def __init__(self, stage: Stage) -> None:
        self.lost = stage.lines("/lost", "warn", width=3.0, dash=(0.05, 0.04))
        self.pulled = Straight(stage.lines("/pulled", "warn", width=2.0, dash=(0.05, 0.05)))
        self.mark = stage.ball("/pull", 0.035, "warn")

    def draw(self, p: ChainParams, s: ChainSolution) -> None:
        self.pulled.draw(s.pulled if s.short is not None else None)
        self.mark.place(p.pull if s.short is not None else None)
        self.lost.place(None if s.lost is None else s.end)
        if s.lost is not None:
            self.lost.path([(-0.5 * s.lost).tolist(), (0.5 * s.lost).tolist()])


class Target:
    """A place to reach: a hollow ring, and a filled ball once the end effector is there."""

    def __init__(self, stage: Stage) -> None:
        self.node: Node = stage.group("/target")
        self.rings = [stage.lines(f"/target/ring{k}", "held", width=3.0) for k in range(2)]
        self.rings[1].pose((math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0))
        for ring in self.rings:
            ring.arc(0.09, 2.0 * math.pi)
        self.ball = stage.ball("/target/ball", 0.06, "ink")

    def draw(self, p: ChainParams, s: ChainSolution) -> None:
        self.node.place(p.target)
        self.ball.show(s.target_distance is not None and s.target_distance <= ENOUGH)
