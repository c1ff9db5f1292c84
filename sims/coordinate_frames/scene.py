"""The scene: a car in the world, the axes of a convention on its roof, and a point in them."""

from __future__ import annotations

import math

import numpy as np

from geometry.arrays import Array
from sims.coordinate_frames import meshes
from sims.coordinate_frames.conventions import Axes
from sims.coordinate_frames.params import GRIDS, FramesParams
from sims.coordinate_frames.readouts import distance_in_words, in_brackets
from sims.coordinate_frames.solution import DRAWN, FramesSolution
from sims.kit.palette import AXES, DASHES
from sims.kit.scene.stage import Stage
from sims.kit.types import IDENTITY, ORIGIN, Quaternion

LENGTH, GHOST_LENGTH = 1.25, 1.52
"""Lengths of the axes; those of the second convention reach beyond, so that neither hides the other's letters."""


def seen(p: FramesParams, s: FramesSolution) -> list[Array]:
    """What must be in sight."""
    return [] if s.point_world is None else [s.point_world]


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
        self.edges = [stage.lines(f"{name}/{axis}", axis, width=2.5, dash=DASHES[axis]) for axis in AXES]
        self.others = stage.strokes(f"{name}/others", ["ghost"] * 6, width=1.0)
        stage.linked("point", *self.edges)

    def draw(self, corner: Array | None) -> None:
        self.node.show(corner is not None)
        if corner is None:
            return
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
Z_ROUND: Quaternion = (0.0, 1.0, 0.0, 0.0)
FLOOR = -0.66
ARC_RADIUS = 0.42
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
            stage.mesh(f"/car/{name}", parts[name], color, flat=name in ("body", "glass"))
        for word, (tail, tip, place) in WORDS.items():
            stage.arrow(f"/{word}", "ghost", tail, tip, radius=0.012)
            stage.label(f"/{word}/label", word, place)


class AxesFigure:
    """A convention's axes. What belongs to Z hangs on a node of its own, which turns round for left-handed axes."""

    def __init__(self, stage: Stage, name: str, length: float, mark: str = "", *, ghost: bool = False) -> None:
        self.node = stage.group(name)
        self.third = stage.group(f"{name}/third")
        for axis, path, tip in zip(AXES, (name, name, f"{name}/third"), length * np.eye(3), strict=True):
            if ghost:
                line = stage.lines(f"{path}/{axis}", axis, [np.zeros(3), tip], width=2.0, dash=DASHES[axis])
                stage.linked("to", line)
            else:
                stage.linked("convention", stage.arrow(f"{path}/{axis}", axis, np.zeros(3), tip, radius=0.02))
            stage.label(f"{path}/letter_{axis}", axis.upper() + mark, tip * (1.0 + 0.13 / length))

    def draw(self, axes: Axes) -> None:
        self.node.pose(axes.wxyz)
        self.third.pose(IDENTITY if axes.sign > 0.0 else Z_ROUND)


class Grid:
    """The plane of two axes: lines along each in its colour."""

    def __init__(self, stage: Stage, name: str, first: int, second: int, size: float = 1.0, cell: float = 0.25) -> None:
        offsets = np.arange(-size, size + 0.5 * cell, cell)
        pieces = np.zeros((2, len(offsets), 2, 3))
        for half, (along, across) in zip(pieces, ((first, second), (second, first)), strict=True):
            half[:, 0, along], half[:, 1, along] = -size, size
            half[:, :, across] = offsets[:, None]
        roles = [AXES[first]] * len(offsets) + [AXES[second]] * len(offsets)
        self.node = stage.strokes(name, roles, width=1.0)
        self.node.draw(pieces.reshape(-1, 2, 3).tolist())


class Hand:
    """A right or a left hand with its thumb along Z, and the arc that its fingers sweep, from X to Y."""

    def __init__(self, stage: Stage, name: str) -> None:
        self.node = stage.group(name)
        self.hands = {side: _Fingers(stage, f"{name}/{side}", left=side == "left") for side in ("right", "left")}
        self.arc = stage.lines(f"{name}/arc", "ink", width=3.5)
        self.head = stage.mesh(f"{name}/head", meshes.arrow_head(), "ink")

    def draw(self, axes: Axes, rule: float, shown: bool) -> None:
        self.node.show(shown)
        if not shown:
            return
        self.node.pose(axes.wxyz)
        for side, fingers in self.hands.items():
            fingers.node.show(side == axes.handedness)
            fingers.node.pose(position=axes.hand)
            fingers.bend(rule)
        angle = rule * math.pi / 2
        self.arc.arc(ARC_RADIUS, angle)
        self.head.pose(_about_z(angle), (ARC_RADIUS * math.cos(angle), ARC_RADIUS * math.sin(angle), 0.0))


class _Fingers:
    """One hand; its fingers bend at three joints."""

    def __init__(self, stage: Stage, name: str, *, left: bool) -> None:
        self.node = stage.group(name)
        parts = meshes.hand(left=left)
        self.joints = []
        stage.mesh(f"{name}/palm", parts["palm"], "ghost")
        stage.mesh(f"{name}/thumb", parts["thumb"], "z")
        path = name
        for part, at in zip(("near", "middle", "far"), (0.04, *meshes.SEGMENTS), strict=True):
            path = f"{path}/{part}"
            joint = stage.mesh(path, parts[part], "ghost")
            joint.pose(position=(at, 0.0, 0.0))
            self.joints.append(joint)
        side = "left" if left else "right"
        stage.label(f"{name}/label", f"{side} hand", (-0.72, 0.0, 0.16 if left else -0.16))

    def bend(self, rule: float) -> None:
        for joint, most in zip(self.joints, meshes.CURL, strict=True):
            joint.pose(_about_z(math.radians(most) * rule))


def _about_z(angle: float) -> Quaternion:
    return math.cos(angle / 2), 0.0, 0.0, math.sin(angle / 2)
