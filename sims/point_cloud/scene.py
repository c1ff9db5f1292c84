"""The scene: the points, the box round them, normals, the selected point, and what a process found."""

from __future__ import annotations

import numpy as np
import trimesh

from geometry import quaternion
from geometry.arrays import Array
from sims.kit.palette import before_film, rgb
from sims.kit.readout import THIN, figure, quantity
from sims.kit.scene.bodies import rings
from sims.kit.scene.nodes import Arrows, Cloud, Node
from sims.kit.scene.stage import Stage
from sims.kit.types import ORIGIN
from sims.kit.view import View
from sims.point_cloud.layers import Cells, Layer, boxed
from sims.point_cloud.params import VIEWS, CloudParams
from sims.point_cloud.scene_selected import About, CellsInScene
from sims.point_cloud.selected import Selected
from sims.point_cloud.solution import CloudSolution

PIXELS = 350.0
"""Pixels, about, that the radius of the first view takes."""
NOWHERE = np.zeros((1, 3), np.float32)
OUT_OF_SIGHT = np.full((2, 3), -1e9, np.float32)
"""Dots that are behind all that can be seen."""
MARKED = 1.5
"""How much larger marked points are."""
NAMES = 4
ANCHORS = {"x": "top-center", "y": "top-left", "z": "center-left"}
SLENDER = 0.05
"""Radius of an arrow's shaft, of its length."""
RING = 0.04
"""Radius of the ring round the selected point, of the view's."""
GROWS = 0.22
"""Diameter of a dot of size 1, of the edge of the cell that it is the mean of: thinned surfaces stay surfaces."""
GHOST, PALE = 0.35, 0.6
"""Size of the original's dots, of those that are as large as the cloud alone says; and how much they differ from the
page."""
HELD = 0.035
"""Radius of the ball that the second scan is held by, of the view's."""


class CloudScene:
    """Everything is in the cloud's own frame; the second scan of a registration moves as one."""

    def __init__(self, stage: Stage) -> None:
        self.stage = stage
        self.floor = stage.ground()
        self.base = Points(stage, "/cloud")
        self.marked = Points(stage, "/marked")
        self.box = Box(stage)
        self.ring = Ring(stage)
        self.plane = Patch(stage)
        self.mesh = Mesh(stage)
        self.links = stage.lines("/pairs", "held", width=1.5)
        self.about = About(stage)
        self.passed, self.dot = CellsInScene(stage, "/under", "ink"), 1.0
        self.ghost: Cloud = stage.cloud("/original", "ghost")
        # With new colours viser's client gives up a cloud's material, and the browser compiles its program anew for the
        # next one, unless something else is drawn with it.
        stage.cloud("/kept", "page").draw(OUT_OF_SIGHT, np.zeros((2, 3), np.uint8))
        pale = PALE * np.array(rgb(stage.palette.ghost)) + (1.0 - PALE) * np.array(rgb(stage.palette.page))
        self._pale = before_film(pale[None])
        self._held = HELD * VIEWS["two-scans"].radius
        self.grip = stage.grip("/second", self._held)
        self.names = [stage.label(f"/name{k}", "", anchor="bottom-center") for k in range(NAMES)]
        self._view: View | None = None
        for node in (self.box.node, self.ring.node, self.plane.node, self.mesh.body, self.grip, *self.names):
            node.show(False)  # until a cloud is there
        stage.rays("/cloud")
        for name in ("process", "step"):
            stage.linked(name, self.links, self.plane.rim)
        stage.linked("distance", self.plane.rim)
        stage.linked("deviations", self.marked.dots)
        for name in ("show_normals", "neighbors"):
            stage.linked(name, self.base.arrows, self.marked.arrows)

    def draw(self, p: CloudParams, s: CloudSolution) -> None:
        view = s.drawn.view
        if view is not self._view:
            self._turn_to(view, s)
        dot = p.point_size * view.radius / PIXELS
        size = max(dot, p.point_size * GROWS * p.voxel_size)
        alone = s.surface is not None and p.step == 2
        self.base.draw(s.drawn.base, size, hidden=alone)
        self.marked.draw(s.drawn.marked, size if s.registration else MARKED * size)
        self.base.point(s.drawn.base_normals, s.drawn.arrow)
        self.marked.point(s.drawn.marked_normals, s.drawn.arrow)
        self.marked.node.pose(quaternion.from_matrix(s.drawn.T[:3, :3]).tolist(), s.drawn.T[:3, 3])
        self.box.draw(s.minimum, s.maximum, p.show_box and s.points_out > 0)
        self.ring.draw(s.selected, view.radius)
        self.dot = GHOST * dot
        self.about.draw(s, max(1.4 * dot, 0.5 * size), self.dot)
        self._original(s, self.dot)
        self.grip.place(s.drawn.grip)
        self.plane.draw(s.drawn.ground)
        self.mesh.draw(s)
        self._pairs(s)
        self._names(s)

    def under(self, cells: Cells | None) -> None:
        """Show the cells under the pointer."""
        self.passed.draw(cells, self.dot)

    def _turn_to(self, view: View, s: CloudSolution) -> None:
        """Another cloud may be far larger: look at all of it, and lay the floor for it."""
        if self._view is not None or view not in VIEWS.values():  # the page begins with those views
            self.stage.look(view.position, view.look_at, view.radius)
        if HELD * view.radius != self._held:  # what hangs on a ball isn't stretched with it
            self._held = HELD * view.radius
            self.grip = self.stage.grip("/second", self._held)
        self._view = view
        self.floor.scale(round(view.radius / 2.5) or 1.0)
        low = 0.0 if view in VIEWS.values() else s.minimum.item(2)
        self.floor.pose(position=(view.look_at[0], view.look_at[1], low - 0.01 * view.radius))

    def _original(self, s: CloudSolution, size: float) -> None:
        self.ghost.show(s.drawn.ghost is not None)
        if s.drawn.ghost is not None:
            self.ghost.size(size)
            self.ghost.draw(s.drawn.ghost, np.broadcast_to(self._pale, s.drawn.ghost.shape))

    def _pairs(self, s: CloudSolution) -> None:
        links = None if s.registration is None else s.registration.links
        self.links.pieces(links)

    def _names(self, s: CloudSolution) -> None:
        for k, label in enumerate(self.names):
            label.show(k < len(s.drawn.names))
            if k < len(s.drawn.names):
                words, place = s.drawn.names[k]
                label.text(words)
                label.pose(position=place.tolist())


class Points:
    """One layer of points with their normals."""

    def __init__(self, stage: Stage, name: str) -> None:
        self.node = stage.group(name)
        self.dots: Cloud = stage.cloud(f"{name}/points", "ink")
        self.arrows: Arrows = stage.arrows(f"{name}/normals", "ink")

    def draw(self, layer: Layer, size: float, *, hidden: bool = False) -> None:
        self.dots.show(len(layer.points) > 0 and not hidden)
        self.dots.size(size)
        if len(layer.points):
            self.dots.draw(layer.points, layer.colors)

    def point(self, normals: Array, length: float) -> None:
        """Arrows (n, 2, 3) of a length."""
        self.arrows.draw(normals)
        self.arrows.thickness(SLENDER * length)


class Box:
    """The box along the axes, with its dimensions at the edges that are nearest to the first view."""

    def __init__(self, stage: Stage) -> None:
        self.node = stage.group("/box")
        self.edges = stage.lines("/box/edges", "ghost", width=1.5)
        stage.linked("show_box", self.edges)
        self.labels = [stage.label(f"/box/{axis}", "", anchor=anchor) for axis, anchor in ANCHORS.items()]

    def draw(self, low: Array, high: Array, visible: bool) -> None:
        self.node.show(visible)
        for label in self.labels:
            label.show(visible)
        if not visible:
            return
        self.edges.pieces(boxed(low, high))
        middle = 0.5 * (low + high)
        places = (middle[0], low[1], low[2]), (high[0], middle[1], low[2]), (low[0], low[1], middle[2])
        for axis, label, place, length in zip("xyz", self.labels, places, (high - low).tolist(), strict=True):
            label.text(f"{axis} {quantity(length, 'm', 2)}")
            label.pose(position=place)


class Ring:
    """Rings round the selected point, with its coordinates, and its normal."""

    def __init__(self, stage: Stage) -> None:
        self.node: Node = stage.group("/selected")
        self.rings = [stage.mesh(f"/selected/ring{k}", ring, "held") for k, ring in enumerate(rings(1.0, 0.26))]
        self.normal = stage.lines("/selected/normal", "held", width=3.0)
        stage.linked("selected", self.normal)
        self.label = stage.label("/selected/label", "", anchor="bottom-left")

    def draw(self, selected: Selected | None, radius: float) -> None:
        self.node.show(selected is not None)
        self.label.show(selected is not None)
        if selected is None:
            return
        self.node.pose(position=selected.position.tolist())
        for ring in self.rings:
            ring.scale(RING * radius)
        self.normal.show(selected.normal is not None)
        if selected.normal is not None:
            self.normal.stroke((ORIGIN, (3.0 * RING * radius * selected.normal).tolist()))
        x, y, z = (figure(v, 2) for v in selected.position.tolist())
        self.label.text(f"({x}, {y}, {z}){THIN}m")
        self.label.pose(position=(0.0, 0.0, 1.4 * RING * radius))


class Patch:
    """The piece of the ground plane over the box."""

    def __init__(self, stage: Stage) -> None:
        self.node = stage.group("/ground_plane")
        self.face = stage.sheet("/ground_plane/face", "held", opacity=0.28)
        self.rim = stage.lines("/ground_plane/rim", "held", width=2.5)
        self.label = stage.label("/ground_plane/label", "ground")

    def draw(self, corners: Array | None) -> None:
        self.node.show(corners is not None)
        if corners is not None:
            self.face.vertices(corners)
            self.rim.path(corners[[0, 1, 2, 3, 0]])
            self.label.pose(position=(0.5 * (corners[0] + corners[3])).tolist())


class Mesh:
    """The surface."""

    def __init__(self, stage: Stage) -> None:
        start = trimesh.Trimesh(np.eye(3), [[0, 1, 2]], process=False)
        self.body = stage.mesh("/surface", start, (178, 172, 160), side="double", flat=True)

    def draw(self, s: CloudSolution) -> None:
        found = s.surface if s.surface is not None and s.surface.triangles else None
        self.body.show(found is not None)
        if found is not None:
            self.body.shape(found.vertices, found.faces)
