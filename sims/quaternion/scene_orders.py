"""Two objects side by side that make the same two turns, each in its own order."""

from __future__ import annotations

import numpy as np

from geometry.arrays import Array
from sims.kit.scene.stage import Stage
from sims.quaternion.ball import FRAME
from sims.quaternion.solution import QuaternionSolution

ASIDE = 1.05
"""Metres of each from the middle, to the left or right in the first view."""
SCALE = 0.7
SIDES = {"left": "A first, then B", "right": "B first, then A"}


class BothOrders:
    """Two objects side by side that make the turns A and B, one of them A first, the other B first."""

    def __init__(self, stage: Stage) -> None:
        self.node = stage.group("/orders")
        self.bodies = {}
        self.axes = []
        for sign, (side, words) in zip((-1.0, 1.0), SIDES.items(), strict=True):
            path = f"/orders/{side}"
            stage.group(path).pose(position=(sign * ASIDE * FRAME[0]).tolist())
            self.bodies[side] = stage.group(f"{path}/object")
            stage.aircraft(f"{path}/object", scale=SCALE)
            self.axes += [
                Turn(stage, path, "A", "held", "axis angle"),
                Turn(stage, path, "B", "left", "axis_b angle_b"),
            ]
            stage.label(f"{path}/label", words, (0.0, 0.0, -1.15))

    def draw(self, s: QuaternionSolution) -> None:
        self.node.show(s.orders is not None)
        if s.orders is None:
            return
        self.bodies["left"].pose(s.orders.left.tolist())
        self.bodies["right"].pose(s.orders.right.tolist())
        for turn, n in zip(self.axes, 2 * s.orders.axes, strict=True):
            turn.draw(n)


class Turn:
    """The axis of A or B through an object, with its letter."""

    def __init__(self, stage: Stage, path: str, letter: str, role: str, links: str) -> None:
        self.arrow = stage.arrow(f"{path}/{letter}", role, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), radius=0.014)
        self.label = stage.label(f"{path}/{letter}/letter", letter)
        for link in links.split():
            stage.linked(link, self.arrow)

    def draw(self, n: Array) -> None:
        self.arrow.draw(np.array([[np.zeros(3), n]]))
        self.label.pose(position=(1.12 * n).tolist())
