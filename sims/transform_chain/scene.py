"""The scene: the arm, its transforms as arrows, what a joint's turn traces, the arm with two transforms exchanged."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from sims.kit.readout import quantity
from sims.kit.scene.stage import Stage
from sims.kit.types import ORIGIN
from sims.transform_chain import meshes
from sims.transform_chain.params import ChainParams
from sims.transform_chain.readouts import sub, transform_name
from sims.transform_chain.scene_arm import Arm, frame
from sims.transform_chain.solution import ENOUGH, ChainSolution

NOWHERE = np.zeros((2, 3))
END = 0.42
"""Length of the axes of the end effector's frame."""
NAMED = 4
"""Arrows that are named at most."""


def seen(p: ChainParams, s: ChainSolution) -> Iterator[npt.ArrayLike]:
    """What must be in sight."""
    yield from s.composed[:, :3, 3]
    if p.target is not None:
        yield p.target


class ChainScene:
    """The arm stands on a column; the world's origin is where its first joint is."""

    def __init__(self, stage: Stage) -> None:
        stage.ground(size=8.0, height=meshes.FLOOR)
        stage.axes("/world", 0.55, radius=0.008)
        grey = (70, 80, 92) if stage.palette.dark else (166, 176, 187)
        stage.mesh("/foot", meshes.foot(), grey)
        self.column = stage.mesh("/column", meshes.column(), grey)
        self.stage = stage
        self.arm = Arm(stage, "")
        self.end = End(stage)
        self.grip = stage.grip("/grip", 0.032, halo=2.4)
        self.arrows = stage.arrows("/transforms", "ink", radius=0.013)
        stage.linked("show", self.arrows)
        self.circle = stage.lines("/trace", "held", width=2.5, dash=(0.06, 0.05))
        stage.linked("trace", self.circle)
        self.status = Status(stage)
        self.target = Target(stage)
        self.ghost: Ghost | None = None

    def draw(self, p: ChainParams, s: ChainSolution) -> None:
        self.arm.draw(s.joints, s.size)
        self.column.pose(position=(0.0, 0.0, -meshes.AXLE * s.size))
        self.column.scale((s.size, s.size, -meshes.FLOOR - meshes.AXLE * s.size))
        self._name(p, s)
        self.end.draw(p, s)
        self.grip.pose(position=s.end)
        self.arrows.draw(s.arrows)
        self.circle.show(s.circle is not None)
        if s.circle is not None:
            self.circle.pose(s.circle.wxyz, s.circle.centre)
            self.circle.arc(max(s.circle.radius, 1e-6), 2.0 * math.pi)
        self.target.draw(p, s)
        self.status.draw(p, s)
        self._swap(p, s)

    def _name(self, p: ChainParams, s: ChainSolution) -> None:
        """Name the arrows: all of a short arm, of a long one the first and the last two."""
        n = p.count
        named = {*range(1, n + 1)} if n <= NAMED else {1, 2, n - 1, n}
        for i, (link, length) in enumerate(zip(self.arm.links, p.lengths, strict=False), start=1):
            along = -0.5 * length if p.show == "individual" else 0.0
            link.name(transform_name(p.show, i) if i in named else "", (along, 0.0, 0.06 + 0.14 * s.size))

    def _swap(self, p: ChainParams, s: ChainSolution) -> None:
        if self.ghost is None:
            if s.swapped is None:
                return
            self.ghost = Ghost(self.stage)
        self.ghost.draw(p, s)


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
        ends = np.stack([np.zeros((3, 3)), np.eye(3)], axis=1) * END
        self.axes = stage.arrows("/end_effector/axes", ("x", "y", "z"), ends, radius=0.017)
        self.letters = [stage.label(f"/end_effector/letter_{a}", a) for a in "xyz"]
        self.point = stage.ball("/end_effector/point", 0.028, "ink")
        self.arm = stage.lines("/end_effector/arm", "ink", width=1.5, dash=(0.03, 0.03))
        stage.linked("point", self.arm)
        self.letter = stage.label("/end_effector/letter_p", "p")

    def draw(self, p: ChainParams, s: ChainSolution) -> None:
        self.node.pose(s.wxyz, s.end)
        for part in self.parts:
            part.scale(s.size)
        self.axes.scale(s.size)
        for k, letter in enumerate(self.letters):
            letter.pose(position=tuple(1.12 * END * s.size * (k == j) for j in range(3)))
        x, y, z = p.point
        self.point.pose(position=p.point)
        self.letter.pose(position=(x, y, z + 0.09))
        self.arm.path([ORIGIN, p.point])


class Ghost:
    """The arm with two transforms exchanged, from these on: before them it is the same."""

    def __init__(self, stage: Stage) -> None:
        self.node = stage.group("/swapped")
        self.arm = Arm(stage, "/swapped", ghost=True)
        self.end = stage.group("/swapped_end")
        self.frame = frame(stage, "/swapped_end/frame")
        self.label = stage.label("/swapped_end/label", "", (0.0, 0.0, -0.16))
        self.apart = stage.lines("/swapped_apart", "ghost", width=1.5)

    def draw(self, p: ChainParams, s: ChainSolution) -> None:
        for node in (self.node, self.end, self.apart):
            node.show(s.swapped is not None)
        if s.swapped is None or p.swap is None:
            return
        self.node.pose(s.swapped.wxyz, s.swapped.origin)
        self.arm.draw(s.swapped.joints, 0.92 * s.size)
        self.end.pose(s.swapped.end_wxyz, s.swapped.end)
        self.frame.scale(END * s.size)
        self.label.text(f"T{sub(p.swap - 1)}{sub(p.swap)} and T{sub(p.swap)}{sub(p.swap + 1)} swapped")
        self.apart.stroke((s.end, s.swapped.end))


class Status:
    """What hinders the end effector, in words where it is."""

    def __init__(self, stage: Stage) -> None:
        self.node = stage.group("/status")
        self.label = stage.label("/status/label", "", (0.0, 0.0, 0.3))
        self.lost = stage.lines("/status/lost", "warn", width=3.0, dash=(0.05, 0.04))
        self.pull = stage.lines("/pull", "warn", width=2.0, dash=(0.05, 0.05))
        self.mark = stage.ball("/pull/mark", 0.035, "warn")

    def draw(self, p: ChainParams, s: ChainSolution) -> None:
        self.pull.show(s.short is not None)
        if p.pull is not None and s.short is not None:
            self.pull.path([s.end, p.pull])
            self.mark.pose(position=p.pull)
        self.node.show(s.short is not None or s.singular)
        self.node.pose(position=s.end)
        self.lost.show(s.lost is not None)
        if s.lost is not None:
            self.lost.path([(-0.5 * s.lost).tolist(), (0.5 * s.lost).tolist()])
        if s.short is not None:
            why = "out of reach" if s.pull_outside else "not reached"
            self.label.text(f"⚠ {why}: {quantity(s.short, 'm', 2)} short")
        elif s.singular:
            self.label.text("⚠ singular pose")


class Target:
    """A place to reach: a hollow ring, and a filled ball once the end effector is there."""

    def __init__(self, stage: Stage) -> None:
        self.node = stage.group("/target")
        self.rings = [stage.lines(f"/target/ring{k}", "held", width=3.0) for k in range(2)]
        self.rings[1].pose((math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0))
        for ring in self.rings:
            ring.arc(0.09, 2.0 * math.pi)
        self.ball = stage.ball("/target/ball", 0.06, "ink")
        self.label = stage.label("/target/label", "", (0.0, 0.0, 0.18))

    def draw(self, p: ChainParams, s: ChainSolution) -> None:
        self.node.show(p.target is not None)
        if p.target is None or s.target_distance is None:
            return
        reached = s.target_distance <= ENOUGH
        self.node.pose(position=p.target)
        self.ball.show(reached)
        self.label.text("✓ target reached" if reached else f"target {quantity(s.target_distance, 'm', 2)} away")
