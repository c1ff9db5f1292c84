"""The scene: the world that stands still, and the camera with its frustum, its picture and its lines of sight."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from geometry.arrays import Array
from sims.camera.params import CameraParams
from sims.camera.solution import CameraSolution
from sims.camera.window import USUAL, window
from sims.kit.scene.camera_figure import CameraFigure
from sims.kit.scene.stage import Stage
from sims.kit.types import Place
from sims.kit.world import PLACES, TITLES
from sims.kit.world_drawing import draw_in_scene

SPOT, GRIP = 0.045, 0.075
BODY = 1.6
"""Times its usual size."""
ABOVE = 0.2
NAMED = {"house": "roof-near", "near post": "near-post", "far post": "far-post"}
HINTS = {"eye": "move", "look": "aim"}
SIGHTS = ("x", "y", "z")
AHEAD: Array = np.subtract(USUAL.look_at, USUAL.position)
AHEAD /= np.linalg.norm(AHEAD)
MORE = 1.6
"""Times as far from the middle of the first view as the camera is beside it."""
NOTHING: Array = np.zeros((4, 3))


def seen(p: CameraParams, s: CameraSolution) -> list[npt.ArrayLike]:
    """What must be in sight: the camera, and room beside the middle where the scene is narrow."""
    if p.through:
        return []
    away = np.subtract(p.position, USUAL.look_at)
    return [s.grip, USUAL.look_at + MORE * (away - (away @ AHEAD) * AHEAD)]


class CameraScene:
    """Everything in the street keeps its place; all that belongs to the camera hangs on one node."""

    def __init__(self, stage: Stage) -> None:
        self.stage = stage
        stage.ground(size=20.0, cell=0.5)
        self.world = stage.axes("/world", 0.6, radius=0.008)
        draw_in_scene(stage)
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
        stage.carried_by(self.camera.figure.solids, "/eye", self.eye)
        self.hints = [stage.label(f"/{name}/hint", words, (0.0, 0.0, 0.2)) for name, words in HINTS.items()]
        self.through = False

    def draw(self, p: CameraParams, s: CameraSolution) -> None:
        x, y, _ = p.position
        grip = s.grip.tolist()
        self._look(p, s)
        self.camera.draw(p, s)
        self.stand.stroke(None if p.through else ((x, y, 0.0), grip))
        for node, place in ((self.eye, grip), (self.look, s.look.tolist())):
            node.pose(position=place)
            node.show(not p.through)
        self.selected.pose(position=PLACES[p.selected])
        self.selected_label.text(TITLES[p.selected].lower())
        for point, label in self.labels.items():
            label.show(p.show_labels and p.selected != point and not p.through)
        for hint in self.hints:
            hint.show(p.show_labels)

    def _look(self, p: CameraParams, s: CameraSolution) -> None:
        """See the scene as the camera does, or upright again."""
        if p.through:
            self.stage.look_through(window(p, s))
        elif self.through:
            self.stage.stand_back()
        self.through = p.through

    def highlight(self, name: str) -> None:
        """Highlight the point that somebody hovers over in the picture or the table, or none."""
        self.highlighted.place(PLACES.get(name))


def above(place: Place) -> Place:
    """Where a label stands."""
    return place[0], place[1], place[2] + ABOVE


class CameraInScene:
    """The camera: body, axes, frustum, and its picture with the lines of sight that make it.

    Who looks through it sees the picture's frame, and nothing else of it.
    """

    def __init__(self, stage: Stage) -> None:
        self.figure = CameraFigure(stage, "/camera", "ink", "C")
        self.axes = stage.axes("/camera/axes", 0.7, radius=0.016, letters=("x", "y", "z"))
        self.axis = stage.lines("/camera/axis", "ghost", width=1.5)
        for parameter in ("fx", "fy", "cx", "cy", "skew", "width", "height"):
            stage.linked(parameter, self.figure.edges)
        for parameter in ("pan", "tilt", "roll"):
            stage.linked(parameter, self.axis)
        self.far = stage.lines("/camera/far", "ghost", width=1.0)
        self.wires = stage.lines("/camera/wires", "ink", width=0.8)
        self.frame = stage.lines("/camera/frame", "ink", width=2.0)
        self.dots = stage.cloud("/camera/dots", "ink", size=0.022)
        self.rays = stage.lines("/camera/rays", "ghost", width=0.6)
        self.dot = stage.ball("/camera/dot", 0.024, "held")
        self.ray = stage.lines("/camera/ray", "held", width=3.5)
        self.meets = stage.strokes("/camera/vanishing", SIGHTS, width=2.5)

    def draw(self, p: CameraParams, s: CameraSolution) -> None:
        self.figure.node.pose(s.orientation.tolist(), p.position)
        f = s.frustum
        there, outside = f is not None, not p.through
        self.figure.show(outside)
        self.axes.show(outside)
        self.axis.stroke(((0.0, 0.0, 0.0), (0.0, 0.0, s.reach)) if outside else None)
        self.figure.draw(NOTHING if f is None else f.corners, BODY, None if f is None else f.back)
        self.figure.picture.show(there and outside)
        self.wires.pieces(f.wires if f is not None and outside else None)
        self.dots.show(there and outside)
        self.figure.edges.show(there and outside and p.show_frustum)
        self.frame.pieces(None if f is None or outside else _round(f.corners))
        boxed = f is not None and f.far is not None and p.show_frustum and outside
        self.far.pieces(_box(f.corners, f.far) if boxed and f is not None and f.far is not None else None)
        self.rays.pieces(f.rays if f is not None and p.show_rays and outside else None)
        self.meets.show(there and p.show_vanishing and outside)
        chosen = None if f is None or f.chosen is None else f.chosen.tolist()
        self.dot.place(chosen[1] if chosen and outside else None)
        self.ray.stroke([chosen[0], chosen[2]] if chosen and outside else None)
        if f is not None:
            self.dots.points(f.dots)
            self.meets.draw(np.stack([np.zeros((3, 3)), 1.5 * f.meet], axis=1))


def _round(corners: Array) -> Array:
    """Edges (4, 2, 3) round four corners."""
    return np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)


def _box(near: Array, far: Array) -> Array:
    """Edges (8, 2, 3) from the picture's corners to the far ones, and round those."""
    return np.concatenate([np.stack([near, far], axis=1), _round(far)])
