"""The scene: three rings in a stand, an aircraft in the inner one, and the angular velocities that they reach."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from sims.gimbal_lock import digits, meshes
from sims.gimbal_lock.actions import AIRCRAFT as AIRCRAFT_HELD
from sims.gimbal_lock.params import GimbalParams
from sims.gimbal_lock.rings import RINGS, Ring
from sims.gimbal_lock.solution import GimbalSolution
from sims.kit.palette import DASHES, RGB
from sims.kit.readout import figure, quantity
from sims.kit.scene.nodes import Label
from sims.kit.scene.pieces import arc_pieces
from sims.kit.scene.stage import Stage
from sims.kit.types import ORIGIN, Line, Vector

AIRCRAFT = 0.75
"""Scale of the aircraft, which then has room in the inner ring."""
LEAST = 0.45
"""Metres from its middle within which it is turned as a ball of that radius."""
STROKES = {"length": ((0.98, 0.0, 0.0), (-0.88, 0.0, 0.0)), "span": ((-0.1, 0.98, 0.0), (-0.1, -0.98, 0.0))}
"""Dashed through the ghost of the aircraft, from nose to tail and from tip to tip."""
PER_RATE = 0.76
"""Metres of the ellipsoid for an angular velocity that is as large as the ring rates together: far from lock it is
round the aircraft."""
FLAT = 1e-6
"""Half of the height of the ellipsoid where it is a disc: a body without any can't be shaded."""
TIPS = {"z": 1.68, "y": 1.55, "x": 1.55}
"""How far the axes reach, in metres from the middle."""
ANCHORS = {"z": "bottom-center", "y": "bottom-center", "x": "top-center"}
"""Labels stand above their tip or hang below it: where Z and X point up together, both are read."""
LOST = 1.5
"""How far the arrow of the lost axis reaches."""
WORLD = (-0.62, -0.8, meshes.FLOOR + 0.01)
"""Where the axes of the world are shown: beside the stand, where they hide nothing."""
NEAR_TIP = (0.09, 0.0, 0.72 * LOST)
"""In the ellipsoid's frame, whose x points down at lock."""
SAME = 0.01
"""Degrees from the aircraft within which its ghost hides in it."""
WIDTHS = {"z": 6.0, "y": 4.0, "x": 2.5}
"""Widths of the axes' lines, in pixels: where two coincide, both are seen."""
BEYOND = 0.07
"""How far beyond its axis a label stands, in metres."""
GRIP = 0.075
"""Radius of what a ring is held by."""
LAMPS = (0.72, 0.62, meshes.FLOOR)
"""Where the lamps stand: beside the foot, to its right in the first view."""
GAP = 0.22
"""Metres between two lamps."""
LIT, OUT = (255, 205, 20), (62, 68, 76)
CIRCLE = arc_pieces(1.0, 2.0 * math.pi, 0.0, None)


class GimbalScene:
    """Three poses turn everything: each ring is nested in the one outside it."""

    def __init__(self, stage: Stage) -> None:
        stage.ground(size=6.0, height=meshes.FLOOR)
        dark = stage.palette.dark
        steel = (112, 122, 134) if dark else (150, 158, 168)
        stage.mesh("/stand", meshes.stand(), steel)
        stage.axes("/world", 0.4, radius=0.008).pose(position=WORLD)
        holders = ["", "/outer", "/outer/middle", "/outer/middle/inner"]
        self.rings = [stage.group(name) for name in holders[1:]]
        bodies = [
            stage.mesh(f"{k}/ring", meshes.ring(ring), ring.letter) for k, ring in zip(holders[1:], RINGS, strict=True)
        ]
        self.labels = [self._ring(stage, ring, *pair) for ring, *pair in zip(RINGS, holders, holders[1:], strict=False)]
        stage.pulled(
            stage.aircraft(holders[3], scale=AIRCRAFT), AIRCRAFT_HELD, partial(getattr, self, "R"), least=LEAST
        )
        stage.mesh(f"{holders[3]}/mount", meshes.mount(AIRCRAFT), steel)
        self.ghost = stage.group("/ghost")
        stage.aircraft("/ghost", scale=AIRCRAFT, ghost=(0.35, 0.35))
        for name, ends in STROKES.items():
            stage.lines(f"/ghost/{name}", "ghost", AIRCRAFT * np.array(ends), width=1.5, dash=(0.05, 0.04))
        self.ghost_label = stage.label("/ghost/label", "", (-0.75, 0.0, 0.4))
        self.reach = Reach(stage)
        self.axes, self.R = np.eye(3), np.eye(3)
        axes = [partial(self._axis, k) for k in range(3)]
        self.grips = [stage.grip(ring.grip, GRIP, axis=axis) for ring, axis in zip(RINGS, axes, strict=True)]
        for ring, body, grip, axis in zip(RINGS, bodies, self.grips, axes, strict=True):
            stage.turned_by(body, ring.grip, grip, partial(_through_middle, axis))
        self.lamps = Lamps(stage)

    def _axis(self, k: int) -> Vector:
        axis: Vector = self.axes[:, k]
        return axis

    def _ring(self, stage: Stage, ring: Ring, holder: str, name: str) -> Label:
        """The ring's stripe; and its pivots and axis, which stay with what holds it."""
        stage.mesh(f"{name}/stripe", meshes.stripe(ring), "page")
        stage.mesh(f"{holder}/pivots", meshes.pivots(ring), ring.letter)
        along = np.eye(3)["xyz".index(ring.letter)]
        tip = TIPS[ring.letter]
        ends = [-TIPS["x"] * along, (tip - 0.1) * along]
        axis = stage.lines(f"{holder}/axis", ring.letter, ends, width=WIDTHS[ring.letter], dash=DASHES[ring.letter])
        arrow = stage.arrow(f"{holder}/tip", ring.letter, (tip - 0.14) * along, tip * along, radius=0.02)
        stage.linked({"z": "yaw", "y": "pitch", "x": "roll"}[ring.letter], axis, arrow)
        return stage.label(f"{holder}/label", "", (tip + BEYOND) * along, anchor=ANCHORS[ring.letter])

    def draw(self, p: GimbalParams, s: GimbalSolution) -> None:
        for node, wxyz in zip(self.rings, s.rings, strict=True):
            node.pose(wxyz)
        for ring, label, angle in zip(RINGS, self.labels, p.angles, strict=True):
            label.text(f"{ring.letter.upper()} {ring.angle} {digits.angle(angle)}")
        self.axes, self.R = s.axes, s.R
        for grip, place in zip(self.grips, s.grips.tolist(), strict=True):
            grip.pose(position=place)
        self.lamps.draw(s)
        self.reach.draw(p, s)
        self.ghost.show(s.ghost is not None and s.ghost.angle > SAME)
        if s.ghost is not None:
            self.ghost.pose(s.ghost.wxyz)
            self.ghost_label.text(f"ghost, {quantity(s.ghost.angle, '°', 0)} away")


def _through_middle(axis: Callable[[], Vector]) -> Line:
    return ORIGIN, axis()


class Reach:
    """The ellipsoid of angular velocities, with its three outlines, and what becomes of its shortest axis."""

    def __init__(self, stage: Stage) -> None:
        self.node = stage.group("/reach")
        self.shape = stage.group("/reach/shape")
        self.ball = stage.ball("/reach/shape/ball", 1.0, "ink", opacity=0.16, side="double")
        self.outline = stage.lines("/reach/shape/outline", "ghost", width=1.2)
        self.outline.pieces(np.concatenate([np.roll(CIRCLE, k, axis=2) for k in range(3)]))
        self.weak = stage.group("/reach/weak")
        stage.lines("/reach/weak/axis", "ink", [(0, 0, -LOST), (0, 0, LOST)], width=2.5, dash=(0.06, 0.06))
        self.weak_label = stage.label("/reach/weak/label", "", NEAR_TIP, anchor="top-center")
        self.lost = stage.group("/reach/lost")
        for name, end in (("arrow", LOST), ("opposite", -LOST)):
            stage.arrow(f"/reach/lost/{name}", "ink", (0.0, 0.0, 0.0), (0.0, 0.0, end), radius=0.025)
        stage.label("/reach/lost/label", "⚠ no ring turns about this", NEAR_TIP, anchor="top-center")

    def draw(self, p: GimbalParams, s: GimbalSolution) -> None:
        a, b, c = (max(PER_RATE * v, FLAT) for v in s.singular_values.tolist())
        self.node.pose(s.reach)
        self.shape.show(p.show_reach)
        self.ball.scale((a, b, c))
        self.outline.scale((a, b, c))
        self.lost.show(s.lost_axis is not None)
        self.weak.show(s.near)
        if s.near:
            self.weak_label.text(f"⚠ rings must turn {figure(s.effort, 0)}× as fast")


class Lamps:
    """One for each way to turn, which grows dark as that one is lost; in a row beside the stand."""

    def __init__(self, stage: Stage) -> None:
        half = math.radians(47.5 / 2.0)  # across the first view
        stage.group("/lamps").pose((math.cos(half), 0.0, 0.0, math.sin(half)), LAMPS)
        stage.mesh("/lamps/base", meshes.base(3 * GAP, GAP), (70, 76, 84))
        self.bulbs = [stage.ball(f"/lamps/{k}", 0.08, "ink") for k in range(3)]
        for k, bulb in enumerate(self.bulbs):
            bulb.pose(position=((k - 1) * GAP, 0.0, 0.11))
        self.words = stage.label("/lamps/label", "", (0.0, 0.0, 0.26), anchor="bottom-center")

    def draw(self, s: GimbalSolution) -> None:
        for bulb, glow in zip(self.bulbs, s.glow, strict=True):
            bulb.color(_mixed(glow))
            bulb.scale(1.0 if glow else 0.7)
        self.words.text(f"{s.dof} ways to turn" if s.dof == 3 else f"⚠ {s.dof} ways to turn")


def _mixed(glow: float) -> RGB:
    """The colour of a lamp that is lit by so much."""
    red, green, blue = (round(out + (lit - out) * glow) for out, lit in zip(OUT, LIT, strict=True))
    return red, green, blue
