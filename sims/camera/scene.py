"""The scene: the world that stands still, and the camera with its frustum, its picture and its lines of sight."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from geometry.arrays import Array
from sims.camera.params import CameraParams
from sims.camera.solution import CameraSolution, Frustum
from sims.camera.world import BY_ROLE, PLACES, ROLES, TITLES, WIRES, Place
from sims.kit.scene.camera_figure import CameraFigure
from sims.kit.scene.stage import Stage
from sims.kit.types import ORIGIN

WIDTHS = {"ink": 2.0, "x": 2.0, "y": 2.5, "z": 3.0}
SPOT, GRIP = 0.055, 0.075
BODY = 1.6
"""Times its usual size."""
ABOVE = 0.2
NAMED = {"house": "roof-near", "near post": "near-post", "far post": "far-post"}
HINTS = {"eye": "move", "look": "aim"}
SIGHTS = ("x", "y", "z")
NOTHING: Array = np.zeros((4, 3))


def seen(p: CameraParams, s: CameraSolution) -> list[npt.ArrayLike]:
    """What must be in sight."""
    return [p.position]


class CameraScene:
    """Everything in the street keeps its place; all that belongs to the camera hangs on one node."""

    def __init__(self, stage: Stage) -> None:
        stage.ground(size=20.0, cell=0.5)
        stage.axes("/world", 0.6, radius=0.008)
        for role, numbers in BY_ROLE.items():
            lines = stage.lines(f"/street/{role}", role, width=WIDTHS[role])
            lines.pieces(WIRES[numbers])
        for name, place in PLACES.items():
            spot = stage.ball(f"/points/{name}", SPOT, "ink")
            spot.pose(position=place)
            stage.link(spot, name)
        self.selected = stage.ball("/selected", 1.5 * SPOT, "held")
        self.highlighted = stage.ball("/lit", 1.4 * SPOT, "held")
        self.highlighted.show(False)
        self.selected_label = stage.label("/selected/label", "", (0.0, 0.0, ABOVE))
        self.labels = {
            point: stage.label(f"/names/{point}", words, above(PLACES[point])) for words, point in NAMED.items()
        }
        self.camera = CameraInScene(stage)
        self.stand = stage.lines("/stand", "ghost", width=1.2)
        self.eye = stage.grip("/eye", GRIP)
        self.look = stage.grip("/look", GRIP)
        self.hints = [stage.label(f"/{name}/hint", words, (0.0, 0.0, 0.2)) for name, words in HINTS.items()]

    def draw(self, p: CameraParams, s: CameraSolution) -> None:
        x, y, _ = p.position
        grip = s.grip.tolist()
        self.camera.draw(p, s)
        self.stand.stroke(((x, y, 0.0), grip))
        self.eye.pose(position=grip)
        self.look.pose(position=s.look.tolist())
        self.selected.pose(position=PLACES[p.selected])
        self.selected_label.text(TITLES[p.selected].lower())
        for point, label in self.labels.items():
            label.show(p.show_labels and p.selected != point)
        for hint in self.hints:
            hint.show(p.show_labels)

    def highlight(self, name: str) -> None:
        """Highlight the point that somebody hovers over in the picture or the table, or none."""
        self.highlighted.place(PLACES.get(name))


def above(place: Place) -> Place:
    """Where a label stands."""
    return place[0], place[1], place[2] + ABOVE


class CameraInScene:
    """The camera: body, axes, frustum, and its picture with the lines of sight that make it."""

    def __init__(self, stage: Stage) -> None:
        self.figure = CameraFigure(stage, "/camera", "ink", "C")
        stage.axes("/camera/axes", 0.7, radius=0.016, letters=("x", "y", "z"))
        self.axis = stage.lines("/camera/axis", "ghost", width=1.5)
        for parameter in ("fx", "fy", "cx", "cy", "skew"):
            stage.linked(parameter, self.figure.edges)
        for parameter in ("pan", "tilt", "roll"):
            stage.linked(parameter, self.axis)
        self.far = stage.lines("/camera/far", "ghost", width=1.0)
        self.wires = stage.strokes("/camera/wires", ROLES, width=1.5)
        self.dots = stage.cloud("/camera/dots", "ink", size=0.022)
        self.rays = stage.lines("/camera/rays", "ghost", width=0.6)
        self.dot = stage.ball("/camera/dot", 0.024, "held")
        self.ray = stage.lines("/camera/ray", "held", width=3.5)
        self.meets = stage.strokes("/camera/vanishing", SIGHTS, width=2.5)
        self.label = stage.label("/camera/label", "picture", anchor="top-center")

    def draw(self, p: CameraParams, s: CameraSolution) -> None:
        self.figure.node.pose(s.orientation.tolist(), p.position)
        self.axis.stroke((ORIGIN, (0.0, 0.0, s.reach)))
        f = s.frustum
        there = f is not None
        self.figure.draw(NOTHING if f is None else f.corners, BODY, None if f is None else f.back)
        for node in (self.figure.picture, self.wires, self.dots):
            node.show(there)
        self.figure.edges.show(there and p.show_frustum)
        self.far.pieces(None if f is None or f.far is None or not p.show_frustum else _box(f.corners, f.far))
        self.rays.pieces(f.rays if f is not None and p.show_rays else None)
        self.meets.show(there and p.show_vanishing)
        self.label.show(there and p.show_labels)
        chosen = None if f is None or f.chosen is None else f.chosen.tolist()
        self.dot.place(chosen and chosen[1])
        self.ray.stroke(chosen and [chosen[0], chosen[2]])
        if f is not None:
            self.wires.draw(_all_wires(f, s.shown))
            self.dots.points(f.dots)
            self.meets.draw(np.stack([np.zeros((3, 3)), 1.5 * f.meet], axis=1))
            self.label.pose(position=f.corners[3].tolist())


def _box(near: Array, far: Array) -> Array:
    """Edges (8, 2, 3) from the picture's corners to the far ones, and round those."""
    edges = np.empty((8, 2, 3))
    edges[:4, 0], edges[:4, 1] = near, far
    edges[4:, 0], edges[4:, 1] = far, np.roll(far, -1, axis=0)
    return edges


def _all_wires(f: Frustum, shown: npt.NDArray[np.intp]) -> Array:
    """A piece for each edge of the world; those that aren't in the picture have no length."""
    pieces = np.empty((len(ROLES), 2, 3))
    pieces[:] = f.corners[0]
    pieces[shown] = f.wires
    return pieces
