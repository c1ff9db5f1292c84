"""The scene: a car that never moves, the axes of two conventions, the point, the hand."""

from __future__ import annotations

import numpy as np

from geometry.arrays import Array
from sims.coordinate_frames.figures import DASHES, FLOOR, AxesFigure, Car, Grid, Hand
from sims.coordinate_frames.model import DRAWN, GRIDS, FramesParams, FramesSolution
from sims.coordinate_frames.words import distance_in_words, in_brackets
from sims.kit.palette import AXES
from sims.kit.stage import Stage

LENGTH, GHOST_LENGTH = 1.25, 1.52
"""Of the axes; those of the second convention reach beyond, so that neither hides the other's letters."""


class FramesScene:
    """The axes begin on the car's roof."""

    def __init__(self, stage: Stage) -> None:
        stage.ground(size=6.0, height=FLOOR)
        Car(stage)
        stage.ball("/origin", 0.05, "ink")
        self.axes = AxesFigure(stage, "/axes", LENGTH)
        self.second = AxesFigure(stage, "/to", GHOST_LENGTH, "′", ghost=True)
        self.grids = {name: Grid(stage, f"/axes/{name}", *pair) for name, pair in GRIDS.items()}
        self.hand = Hand(stage, "/rule")
        self.box = Box(stage, "/axes/box")
        self.point = Point(stage)

    def draw(self, p: FramesParams, s: FramesSolution) -> None:
        self.axes.draw(s.axes)
        self.second.node.show(s.axes_to is not s.axes)
        self.second.draw(s.axes_to)
        for name, grid in self.grids.items():
            grid.node.show(getattr(p, name))
        self.hand.draw(s.axes, p.rule, p.show_rule)
        self.box.draw(s.corner)
        self.point.draw(p, s)


class Box:
    """From the point a dashed line to each plane, along the axis whose coordinate it is; the other edges thin."""

    def __init__(self, stage: Stage, name: str) -> None:
        self.node = stage.group(name)
        self.edges = [
            stage.lines(f"{name}/{axis}", np.zeros((2, 3)), axis, width=2.5, dash=DASHES[axis]) for axis in AXES
        ]
        self.others = stage.strokes(f"{name}/others", ["ghost"] * 6, width=1.0)
        self.shown: Array | None = None

    def draw(self, corner: Array | None) -> None:
        self.node.show(corner is not None)
        if corner is None or (self.shown is not None and np.array_equal(corner, self.shown)):
            return
        self.shown = corner
        x, y, z = corner.tolist()
        feet = (0.0, y, z), (x, 0.0, z), (x, y, 0.0)
        for edge, foot in zip(self.edges, feet, strict=True):
            edge.path([foot, (x, y, z)])
        on_x, on_y, on_z = (x, 0.0, 0.0), (0.0, y, 0.0), (0.0, 0.0, z)
        yz, xz, xy = feet
        self.others.draw([(xy, on_x), (xy, on_y), (xz, on_x), (xz, on_z), (yz, on_y), (yz, on_z)])


class Point:
    """What the learner holds: a point, or the tip of a direction; and the way that w has moved it."""

    def __init__(self, stage: Stage) -> None:
        self.grip = stage.grip("/point", 0.06)
        self.label = stage.label("/point/label", "", (0.0, 0.0, 0.12), anchor="bottom-right")
        self.ray = stage.lines("/ray", np.zeros((2, 3)), "held", width=1.5)
        self.undivided = stage.ball("/undivided", 0.04, "ghost")
        stage.label("/undivided/label", "w = 1", (0.0, 0.0, -0.12))
        self.arrow = stage.arrow("/away", (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), "held", radius=0.02)
        self.away = stage.label("/away/label", "", anchor="bottom-right")
        self.tip: list[float] | None = None

    def draw(self, p: FramesParams, s: FramesSolution) -> None:
        place = s.tip if s.point_world is None else s.point_world
        seen = place is not None and (s.distance is None or s.distance < DRAWN)
        self.grip.show(seen)
        if place is not None and seen:
            self.grip.pose(position=place.tolist())
            self.label.text(in_brackets(p, s))
        divided = s.cartesian is not None and p.w != 1.0 and s.direction is not None
        self.undivided.show(divided)
        self.ray.show(divided and s.tip is None)
        if divided:
            self.undivided.pose(position=s.undivided.tolist())
            if place is not None and s.tip is None:
                self.ray.stroke((0.0, 0.0, 0.0), tuple(place.tolist()))
        self._away(s)

    def _away(self, s: FramesSolution) -> None:
        self.arrow.show(s.tip is not None)
        self.away.show(s.tip is not None and s.distance is not None)
        if s.tip is None:
            return
        if (tip := s.tip.tolist()) != self.tip:
            self.tip = tip
            self.arrow.between((0.0, 0.0, 0.0), tip)
            self.away.pose(position=[1.03 * v for v in tip])
        if s.distance is not None:
            self.away.text(distance_in_words(s.distance))
