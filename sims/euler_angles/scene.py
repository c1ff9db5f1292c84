"""An aircraft in its three turns: each turn in the frame before it."""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np

from sims.euler_angles.actions import ARCS, BODY, WHOLE
from sims.euler_angles.params import NEAR_LOCK, EulerParams
from sims.euler_angles.solution import RADII, EulerSolution, Turn
from sims.kit.palette import DASHES
from sims.kit.readout import quantity
from sims.kit.scene.stage import Stage
from sims.kit.types import Place, Vector

TIPS = (0.92, 0.94)
"""Metres from the middle to the grips of nose and left wing."""
GRIP = 0.05
LEAST = 0.6
"""Metres from the middle of the aircraft within which it is turned as a ball of that radius."""
REACHED = 0.01
"""Degrees from the aircraft within which the target hides in it."""
ANCHORS = dict(zip(RADII, ("top-left", "bottom-left", "center-left"), strict=True))
"""The first label hangs lower, clear of the next one where the two arcs meet, and of the letter of the world's X."""


class EulerScene:
    """World frame, ghost frames after one and two turns, the aircraft, and an arc for each turn."""

    def __init__(self, stage: Stage) -> None:
        stage.ground(size=6.0, height=-1.3)
        stage.axes("/world", 1.55, radius=0.008)
        parents = ["/turn1", "/turn1/turn2", "/turn1/turn2/turn3"]
        self.frames = [
            stage.axes(parents[0], 1.15, ghost=True, letters=None),
            stage.axes(parents[1], 1.15, ghost=True, letters=None),
            stage.axes(parents[2], 1.15, radius=0.02, letters=("x", "y", "z")),
        ]
        stage.pulled(stage.aircraft(parents[2]), WHOLE, partial(getattr, self, "R"), least=LEAST)
        self.target = stage.group("/target")
        stage.aircraft("/target", ghost=(0.35, 0.35))
        self.target_label = stage.label("/target/label", "", (-0.9, 0.0, 0.45))
        self.stage = stage
        self.befores = ["", *parents[:2]]
        self.arcs: list[Any] = []
        self.order = ""
        self.names: tuple[str, ...] = ()
        self.held = [stage.grip(name, GRIP, axis=partial(self._axis, k)) for k, name in enumerate(ARCS)]
        self.body = [stage.grip(name, GRIP) for name in BODY]
        self.axes, self.R = np.eye(3), np.eye(3)

    def _axis(self, k: int) -> Vector:
        axis: Vector = self.axes[k]
        return axis

    def draw(self, p: EulerParams, s: EulerSolution) -> None:
        if p.order != self.order:
            self._rebuild(p)
        for frame, arc, turn in zip(self.frames, self.arcs, s.turns, strict=True):
            frame.pose(turn.wxyz)
            arc.draw(turn, near_lock=s.lock_distance < NEAR_LOCK)
        self.names, self.R = p.names, s.R_progress
        self._hold(s, p.progress >= 3.0)
        self.target.show(s.target is not None and s.target.angle > REACHED)
        if s.target is not None:
            self.target.pose(s.target.wxyz)
            self.target_label.text(f"target, {quantity(s.target.angle, '°', 0)} away")

    def _hold(self, s: EulerSolution, whole: bool) -> None:
        """Put the grips where arcs, nose and wing end, where all turns are made."""
        self.axes = np.array([arc[:, 2] for arc in s.arcs])
        tips = [tip * (s.R @ spot) for tip, spot in zip(TIPS, BODY.values(), strict=True)]
        for grip, place in zip(
            (*self.held, *self.body), (*s.ends.tolist(), *(tip.tolist() for tip in tips)), strict=True
        ):
            grip.place(place if whole else None)

    def highlight(self, name: str) -> None:
        """Make the turn of an angle stand out, with the axis that it is about."""
        for arc, angle in zip(self.arcs, self.names, strict=False):
            arc.highlight(angle == name)

    def _rebuild(self, p: EulerParams) -> None:
        self.order = p.order
        for arc in self.arcs:
            arc.remove()
        self.arcs = [
            Arc(self.stage, f"{before}/arc{k}", axis, RADII[k], p.locks if k == 1 else ())
            for k, (before, axis) in enumerate(zip(self.befores, p.order, strict=True))
        ]


class Arc:
    """The arc of one turn with its label, its axis while the turn is being made, and the two places where it locks.

    Where it locks, the whole circle is shown.
    """

    def __init__(self, stage: Stage, name: str, axis: str, radius: float, locks: tuple[float, ...]) -> None:
        self.node = stage.group(name)
        self.radius = radius
        self.line = stage.lines(f"{name}/line", axis, width=4.0, dash=DASHES[axis])
        self.start = stage.lines(f"{name}/start", "ghost", [(0, 0, 0), (radius, 0, 0)], width=1.2)
        self.end = stage.lines(f"{name}/end", axis, [(0, 0, 0), (radius, 0, 0)], width=1.5)
        self.axis = stage.lines(f"{name}/axis", axis, [(0, 0, -1.7), (0, 0, 1.7)], width=5.0)
        self.axis.show(False)
        self.label = stage.label(f"{name}/label", "", anchor=ANCHORS[radius])
        self.current = False
        self.locks = {lock: stage.label(f"{name}/words{lock:.0f}", "") for lock in locks}
        if locks:
            stage.lines(f"{name}/circle", "ghost", width=1.2).arc(radius, 2.0 * math.pi)
        for lock, label in self.locks.items():
            region = stage.lines(f"{name}/lock{lock:.0f}", "warn", width=3.0, dash=(0.03, 0.03))
            region.arc(radius, math.radians(2 * NEAR_LOCK), math.radians(lock - NEAR_LOCK))
            label.pose(position=_beside(radius, math.radians(lock)))

    def draw(self, turn: Turn, *, near_lock: bool) -> None:
        radians = math.radians(turn.applied)
        self.node.pose(turn.seen)
        visible = abs(turn.applied) > 0.5
        self.line.arc(self.radius, radians)
        self.end.pose((math.cos(radians / 2), 0.0, 0.0, math.sin(radians / 2)))
        for part in (self.line, self.start, self.end, self.label):
            part.show(visible)
        self.current = turn.current
        self.axis.show(turn.current)
        self.label.pose(position=_beside(self.radius, radians / 2))
        self.label.text(f"{turn.name} {quantity(turn.applied, '°', 0)}")
        for lock, words in self.locks.items():
            near = near_lock and abs(lock - turn.applied) < NEAR_LOCK
            words.text(f"{'⚠ ' * near}lock at {quantity(lock, '°', 0)}")

    def highlight(self, on: bool) -> None:
        self.axis.show(on or self.current)
        for part in (self.line, self.end):
            part.stress(on)

    def remove(self) -> None:
        self.node.handle.remove()


def _beside(radius: float, angle: float) -> Place:
    """Where words about an angle (radians) of an arc stand, in its frame."""
    return 1.1 * radius * math.cos(angle), 1.1 * radius * math.sin(angle), 0.0
