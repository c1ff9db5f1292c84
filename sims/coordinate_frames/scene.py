"""The scene: a car in the world, the axes of a convention on its roof, others elsewhere, and a point in both."""

from __future__ import annotations

import math

import numpy as np

from geometry.arrays import Array
from sims.coordinate_frames import meshes
from sims.coordinate_frames.params import GRIDS, FramesParams
from sims.coordinate_frames.readouts import distance_in_words, in_brackets
from sims.coordinate_frames.scene_axes import AxesFigure, Box, GhostAxes, Grid
from sims.coordinate_frames.scene_hand import Hand
from sims.coordinate_frames.solution import DRAWN, FramesSolution
from sims.kit.scene.stage import Stage
from sims.kit.types import ORIGIN, Quaternion

LENGTH, APART, TOGETHER = 1.25, 1.0, 1.52
"""Lengths of the first axes, and of the second ones elsewhere or at the first: there they reach beyond."""


def seen(p: FramesParams, s: FramesSolution) -> list[Array]:
    """What must be in sight."""
    found = [] if s.point_world is None else [s.point_world]
    return [*found, *(s.origin_world + APART * s.axes_to.basis.T)] if s.apart else found


class FramesScene:
    """The first axes begin on the car's roof."""

    def __init__(self, stage: Stage) -> None:
        stage.ground(size=6.0, height=FLOOR)
        Car(stage)
        stage.ball("/origin", 0.05, "ink")
        self.axes = AxesFigure(stage, "/axes")
        self.second = Second(stage)
        self.grids = {name: Grid(stage, f"/axes/{name}", *pair) for name, pair in GRIDS.items()}
        self.hand = Hand(stage, "/rule")
        self.box = Box(stage, "/axes/box")
        self.point = Point(stage)
        self.direction = Direction(stage)

    def draw(self, p: FramesParams, s: FramesSolution) -> None:
        self.axes.draw(s.drawn, LENGTH)
        self.axes.light(p.lit)
        self.second.draw(s)
        for name, grid in self.grids.items():
            grid.draw(s.corner, shown=getattr(p, name))
        self.hand.draw(s, p.rule, p.show_rule)
        self.box.draw(s.corner)
        self.point.draw(p, s)
        self.direction.draw(s)


class Second:
    """The second frame, the ring by which it is pulled, and how far it is from the first."""

    def __init__(self, stage: Stage) -> None:
        self.axes = GhostAxes(stage, "/to")
        self.grip = stage.grip("/second", 0.055)
        self.shift = stage.lines("/shift", "ghost", width=1.5, dash=(0.03, 0.04))
        stage.linked("origin", self.shift, self.grip)

    def draw(self, s: FramesSolution) -> None:
        place = s.origin_world.tolist()
        self.axes.node.show(s.apart or s.axes_to is not s.axes)
        self.axes.node.pose(position=place)
        self.axes.draw(s.drawn_to, APART if s.apart else TOGETHER)
        self.grip.pose(position=place)
        self.shift.show(s.apart)
        if s.apart:
            self.shift.path((ORIGIN, place))


class Direction:
    """(x, y, z) with w = 0: one arrow, drawn from either origin; and where the point is for the second."""

    def __init__(self, stage: Stage) -> None:
        self.arrows = stage.arrows("/directions", "ink", radius=0.014)
        self.label = stage.label("/directions/label", "same direction", anchor="bottom-left")
        self.sight = stage.lines("/sight", "held", width=1.5, dash=(0.05, 0.05))
        stage.linked("w", self.arrows)

    def draw(self, s: FramesSolution) -> None:
        self.arrows.draw(s.arrows)
        copied = s.apart and len(s.arrows) > 0 and (s.tip is None or s.cartesian is None)
        self.label.show(copied)
        if copied:
            self.label.pose(position=s.arrows[-1, 1])
        self.sight.show(s.apart and s.corner is not None)
        if s.point_world is not None and s.corner is not None:
            self.sight.path(np.array([s.origin_world, s.point_world]))


class Point:
    """What the learner holds: a point, or the tip of a direction; and the way that w has moved it."""

    def __init__(self, stage: Stage) -> None:
        self.grip = stage.grip("/point", 0.06)
        self.label = stage.label("/point/label", "", (0.0, 0.0, 0.12), anchor="bottom-center")
        self.ray = stage.lines("/ray", "held", width=1.5)
        stage.linked("w", self.ray)
        self.undivided = stage.ball("/undivided", 0.04, "ghost")
        stage.label("/undivided/label", "w = 1", (0.0, 0.0, -0.12))
        self.arrow = stage.arrows("/away", "held", radius=0.02)
        self.away = stage.label("/away/label", anchor="bottom-right")

    def draw(self, p: FramesParams, s: FramesSolution) -> None:
        place = s.tip if s.point_world is None else s.point_world
        held = None if place is None or (s.distance is not None and s.distance >= DRAWN) else place.tolist()
        self.grip.place(held)
        if held is not None:
            self.label.text(in_brackets(p, s))
        divided = s.cartesian is not None and p.w != 1.0 and s.direction is not None
        self.undivided.place(s.undivided.tolist() if divided else None)
        self.ray.stroke((ORIGIN, place.tolist()) if divided and place is not None and s.tip is None else None)
        tip = None if s.tip is None else s.tip.tolist()
        self.arrow.between(None if tip is None else (ORIGIN, tip))
        self.away.say(None if tip is None or s.distance is None else distance_in_words(s.distance))
        if tip is not None:
            self.away.pose(position=[1.03 * v for v in tip])


QUARTER: Quaternion = (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
"""Turns the car's nose, +X of its own, to forward."""
FLOOR = -0.66
CLEAR = 0.4
"""Opacity of the car: an axis that leads down is seen through it."""
WORDS = {
    "forward": ((0.0, 0.95, -0.36), (0.0, 1.38, -0.36), (0.0, 1.58, -0.36)),
    "right": ((1.15, 0.1, FLOOR), (1.5, 0.1, FLOOR), (1.68, 0.1, FLOOR)),
    "up": ((-0.75, 0.1, FLOOR), (-0.75, 0.1, FLOOR + 0.32), (-0.75, 0.1, FLOOR + 0.44)),
}
"""Tail and tip of the arrow that stands for each direction, and the place of its word."""


class Car:
    """The world: a car, and its right, forward and up in words. It never moves."""

    def __init__(self, stage: Stage) -> None:
        dark = stage.palette.dark
        body, glass = stage.palette.solid, (44, 52, 62) if dark else (120, 132, 146)
        tyres, trim = ((30, 35, 42), (150, 160, 170)) if dark else ((72, 80, 90), (236, 240, 244))
        stage.group("/car").pose(QUARTER)
        parts = meshes.car()
        for name, color in (("body", body), ("glass", glass), ("tyres", tyres), ("trim", trim)):
            stage.mesh(f"/car/{name}", parts[name], color, flat=name in ("body", "glass"), opacity=CLEAR)
        for word, (tail, tip, place) in WORDS.items():
            stage.arrow(f"/{word}", "ghost", tail, tip, radius=0.012)
            stage.label(f"/{word}/label", word, place)
