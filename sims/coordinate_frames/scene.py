"""The scene: a car in the world, the axes of a convention on its roof, others elsewhere, and a point in both."""

from __future__ import annotations

import math

import numpy as np

from geometry.arrays import Array
from sims.coordinate_frames import meshes
from sims.coordinate_frames.conventions import Drawn
from sims.coordinate_frames.params import GRIDS, FramesParams
from sims.coordinate_frames.readouts import distance_in_words, in_brackets
from sims.coordinate_frames.solution import DRAWN, FramesSolution
from sims.kit.palette import AXES, DASHES
from sims.kit.scene.stage import Stage
from sims.kit.types import IDENTITY, ORIGIN, Place, Quaternion

LENGTH, APART, TOGETHER = 1.25, 1.0, 1.52
"""Lengths of the first axes, and of the second ones elsewhere or at the first: there they reach beyond."""
BEYOND = 0.13
"""How far beyond its axis a letter stands."""
RADIUS, LIT_RADIUS, DIM_RADIUS = 0.02, 0.034, 0.012
"""Radii of an axis, of one that the rule is at, and of the others then."""


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
        starts = [] if s.arrow is None else [np.zeros(3)] * (s.tip is None) + [s.origin_world] * s.apart
        self.arrows.draw(np.array([[start, start + s.arrow] for start in starts]))
        copied = s.arrow is not None and s.apart and (s.tip is None or s.cartesian is None)
        self.label.show(copied)
        if copied:
            self.label.pose(position=s.origin_world + s.arrow)
        self.sight.show(s.apart and s.corner is not None)
        if s.point_world is not None and s.corner is not None:
            self.sight.path(np.array([s.origin_world, s.point_world]))


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
Z_ROUND: Quaternion = (0.0, 1.0, 0.0, 0.0)
FLOOR = -0.66
CLEAR = 0.4
"""Opacity of the car: an axis that leads down is seen through it."""
ARC_RADIUS = 0.85
KNUCKLES = (0.22, -0.09, 0.17)
"""Where the knuckles are in the axes: the thumb then lies along Z, and X runs along the fingers."""
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


class AxesFigure:
    """A convention's axes. What belongs to Z hangs on a node of its own, which turns round for left-handed axes."""

    MARK = ""

    def __init__(self, stage: Stage, name: str) -> None:
        self.node = stage.group(name)
        self.third = stage.group(f"{name}/third")
        paths = (name, name, f"{name}/third")
        self.letters = [
            stage.label(f"{path}/letter_{a}", a.upper() + self.MARK) for a, path in zip(AXES, paths, strict=True)
        ]
        self.shafts(stage, [f"{path}/{axis}" for axis, path in zip(AXES, paths, strict=True)])

    def shafts(self, stage: Stage, names: list[str]) -> None:
        self.arrows = [stage.arrows(name, axis, radius=RADIUS) for axis, name in zip(AXES, names, strict=True)]
        stage.linked("convention", *self.arrows)

    def reach(self, k: int, tip: Place) -> None:
        self.arrows[k].between((ORIGIN, tip))

    def draw(self, drawn: Drawn, length: float) -> None:
        """From the node's origin; Z is shorter while it changes sides."""
        self.node.pose(drawn.wxyz)
        self.third.pose(IDENTITY if drawn.side >= 0.0 else Z_ROUND)
        height = max(abs(drawn.side), 0.01) * length
        for k, (letter, tip) in enumerate(zip(self.letters, _along_axes(length, height), strict=True)):
            self.reach(k, tip)
            letter.pose(position=_along_axes(length + BEYOND, height + BEYOND)[k])

    def light(self, lit: str | None) -> None:
        """Make one axis thick and the others thin."""
        for axis, arrow in zip(AXES, self.arrows, strict=True):
            arrow.thickness(RADIUS if lit is None else LIT_RADIUS if axis == lit else DIM_RADIUS)


class GhostAxes(AxesFigure):
    """Those of the second frame: thin, and dashed."""

    MARK = "′"

    def shafts(self, stage: Stage, names: list[str]) -> None:
        self.lines = [stage.lines(n, a, width=2.5, dash=DASHES[a]) for a, n in zip(AXES, names, strict=True)]
        stage.linked("to", *self.lines)

    def reach(self, k: int, tip: Place) -> None:
        self.lines[k].path((ORIGIN, tip))


def _along_axes(length: float, height: float) -> tuple[Place, Place, Place]:
    return (length, 0.0, 0.0), (0.0, length, 0.0), (0.0, 0.0, height)


class Grid:
    """The plane of two axes: faint lines along each in its colour, and a strong one through the point's foot."""

    def __init__(self, stage: Stage, name: str, first: int, second: int, size: float = 1.5, cell: float = 0.5) -> None:
        self.offsets, self.size = np.arange(-size, size + 0.5 * cell, cell), size
        self.node = stage.strokes(name, [AXES[first], AXES[second]] * len(self.offsets), width=1.0, faint=True)
        both = [self._lines(first, second, self.offsets), self._lines(second, first, self.offsets)]
        self.node.draw(np.stack(both, axis=1).reshape(-1, 2, 3))
        # With all three there is one along each axis.
        self.along, self.at = (second, first) if (first, second) == (0, 2) else (first, second)
        self.through = stage.strokes(f"{name}/through", [AXES[self.along]], width=3.0)

    def _lines(self, along: int, at: int, offsets: Array) -> Array:
        """Lines along an axis, at places on another."""
        pieces = np.zeros((len(offsets), 2, 3))
        pieces[:, :, along] = -self.size, self.size
        pieces[:, :, at] = offsets[:, None]
        return pieces

    def draw(self, corner: Array | None, *, shown: bool) -> None:
        self.node.show(shown)
        self.through.show(corner is not None)
        if shown and corner is not None:
            self.through.draw(self._lines(self.along, self.at, corner[[self.at]]))


class Hand:
    """A right or a left hand at the origin, its thumb along Z, and the arc that its fingers sweep, from X to Y."""

    def __init__(self, stage: Stage, name: str) -> None:
        self.node = stage.group(name)
        self.hands = {side: _Fingers(stage, f"{name}/{side}", left=side == "left") for side in ("right", "left")}
        self.arc = stage.lines(f"{name}/arc", "ink", width=3.5)
        self.head = stage.mesh(f"{name}/head", meshes.arrow_head(), "ink")

    def draw(self, s: FramesSolution, rule: float, shown: bool) -> None:
        self.node.show(shown)
        if not shown:
            return
        self.node.pose(s.drawn.wxyz)
        for side, fingers in self.hands.items():
            fingers.node.show(side == s.handedness)
            fingers.bend(rule)
        angle = rule * math.pi / 2
        self.arc.arc(ARC_RADIUS, angle)
        self.head.pose(_about_z(angle), (ARC_RADIUS * math.cos(angle), ARC_RADIUS * math.sin(angle), 0.0))


class _Fingers:
    """One hand; its fingers bend at three joints."""

    def __init__(self, stage: Stage, name: str, *, left: bool) -> None:
        self.node = stage.group(name)
        x, y, z = KNUCKLES
        self.node.pose(position=(x, y, -z if left else z))
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
