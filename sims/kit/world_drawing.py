"""The little world in a scene, and as it is seen in a picture: solid, shaded, and without what is hidden."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise
from operator import itemgetter

import numpy as np
import numpy.typing as npt
import trimesh

from geometry.affine_camera import AffineCamera
from geometry.arrays import Array
from geometry.camera import Camera
from geometry.painting import Painter, Pixels, clip_polygon
from geometry.projection import ground_line
from sims.kit.palette import before_tone_mapping, rgb
from sims.kit.pane import Picture
from sims.kit.scene.nodes import Node
from sims.kit.scene.stage import Stage
from sims.kit.types import ORIGIN, Place
from sims.kit.world import BODIES, Body, Paint

PAINTS: dict[Paint, tuple[str, str]] = {
    "wall": ("#eadfc8", "#8f8775"), "roof": ("#cfa08c", "#85655a"), "post": ("#bca88f", "#76695a"),
    "cube-left": ("#b5c9a8", "#66785c"), "cube-right": ("#aebfd6", "#5d6c82"), "cube-far": ("#dccb96", "#85794f"),
    "bed": ("#e4e1db", "#40444a"), "sleeper": ("#c6b8a6", "#5e564d"), "rail": ("#98a1aa", "#737c86"),
}  # fmt: skip
"""Soft colours, in light and in dark: they leave the strong ones to axes and marks."""
GROUND = "light-dark(#f3f4f1, #1c2126)"
SUN = np.array([0.45, -0.3, 0.84])
"""Where most light of the pictures comes from: so that the sides of a thing differ."""
SHADE, SUNSHINE = 0.82, 0.24
NEAREST = 1e-3
"""Metres of depth from which on pictures show things."""
MARGIN = 3.0
"""Pixels beyond the frame where faces are cut off: there, nobody sees that edge."""
LONG = 20.0
"""Pixels of an edge that stays straight where edges are bent."""
Box = tuple[float, float, float, float]
"""Left, top, right and bottom, in pixels."""
PAINTER = Painter([body.faces for body in BODIES])
OF_FACE = [body.paint for body in BODIES for _ in body.faces]


@dataclass(frozen=True)
class Sight:
    """What a picture shows of the world, in pixels: where the ground is, and faces by their numbers, far ones first."""

    ground: Pixels
    faces: Sequence[tuple[int, Pixels]]

    def outlines(self) -> Array:
        """Edges (n, 2, 2) of all faces but the sleepers, whose many would be all that one sees."""
        starts, ends, _ = _sides([corners for face, corners in self.faces if OF_FACE[face] != "sleeper"])
        return np.stack([starts, ends], axis=1)

    def bent(self, bend: Callable[[Array], Array]) -> Sight:
        """The same through a lens that moves pixels (n, 2)."""
        rings = _bent([self.ground, *(corners for _, corners in self.faces)], bend)
        return Sight(rings[0], [(face, ring) for (face, _), ring in zip(self.faces, rings[1:], strict=True)])


def draw_in_scene(stage: Stage, offset: Place = ORIGIN) -> Node:
    """Put the little world into a scene, moved by so many metres: a solid for each colour, and their edges."""
    things = stage.group("/things")
    things.pose(position=offset)
    for paint, shades in PAINTS.items():
        mesh = _mesh([body for body in BODIES if body.paint == paint])
        stage.mesh(f"/things/{paint}", mesh, before_tone_mapping(shades[stage.palette.dark]), flat=True)
    stage.lines("/things/edges", "ghost", width=0.8).pieces(_edges())
    return things


def draw_in_picture(picture: Picture, camera: Camera | AffineCamera, offset: Place = ORIGIN) -> None:
    """Paint what a camera sees of the little world, moved by so many metres, and of the ground, into its picture."""
    draw_sight(picture, see(camera, frame(picture.width, picture.height), offset))


def draw_sight(picture: Picture, sight: Sight) -> None:
    """Paint what is seen into a picture."""
    if sight.ground:
        picture.areas([(GROUND, [sight.ground])], edges=False)
    by_fill = groupby(((FILLS[face], outline) for face, outline in sight.faces), key=itemgetter(0))
    picture.areas((fill, [outline for _, outline in same]) for fill, same in by_fill)


def frame(width: float, height: float) -> Box:
    """The frame of a picture of so many pixels, with a margin."""
    return -0.5 - MARGIN, -0.5 - MARGIN, width - 0.5 + MARGIN, height - 0.5 + MARGIN


def see(camera: Camera | AffineCamera, box: Box, offset: Place = ORIGIN) -> Sight:
    """What a camera shows within a box of its pixels of the world, moved by so many metres."""
    P = _moved(camera.P, offset)
    nearest = _moved(camera.depth_row, offset) - (0.0, 0.0, 0.0, NEAREST)
    left, top, right, bottom = box
    u, v, w = P
    planes = np.stack([u - left * w, v - top * w, right * w - u, bottom * w - v, nearest])
    return Sight(_ground(P, box), PAINTER.paint(P, planes))


def _moved(rows: Array, offset: Place) -> Array:
    """Rows (..., 4) that say of a place in the world what they said of it, moved back by an offset."""
    moved: Array = rows.copy()
    moved[..., 3] += rows[..., :3].dot(offset)
    return moved


def _ground(P: Array, box: Box) -> Pixels:
    """The part of a box that shows the ground."""
    a, b, c = ground_line(P)
    left, top, right, bottom = box
    corners = [(u, v, a * u + b * v + c) for u, v in ((left, top), (right, top), (right, bottom), (left, bottom))]
    return [(u, v) for u, v, _ in clip_polygon(corners, [2])] if (a, b, c) != (0.0, 0.0, 0.0) else []


def _bent(rings: Sequence[Pixels], bend: Callable[[Array], Array]) -> list[Pixels]:
    """Polygons whose edges are bent as the lens bends them: all at once, with as many corners as it takes."""
    starts, ends, borders = _sides(rings)
    along = ends - starts
    counts = np.ceil(np.hypot(*along.T) / LONG).clip(1.0, 40.0).astype(int)
    edge = np.repeat(np.arange(len(starts)), counts)
    within = (np.arange(len(edge)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[edge]
    moved = [(u, v) for u, v in bend(starts[edge] + within[:, None] * along[edge]).tolist()]
    of_corner = np.concatenate([[0], np.cumsum(counts)])
    return [moved[first:end] for first, end in pairwise(of_corner[borders].tolist())]


def _sides(rings: Sequence[Pixels]) -> tuple[Array, Array, npt.NDArray[np.intp]]:
    """Where the edges of all rings start and end (n, 2), and the numbers at which rings begin and the last one ends."""
    borders = np.cumsum([0, *map(len, rings)])
    starts = np.array([corner for ring in rings for corner in ring]).reshape(-1, 2)
    after = np.arange(1, len(starts) + 1)
    filled = borders[1:] > borders[:-1]
    after[borders[1:][filled] - 1] = borders[:-1][filled]
    return starts, starts[after], borders


def _fills() -> Iterator[str]:
    """The colour of each face: in CSS, for both themes, darker the more it is turned away from the sun."""
    for paint, normal in zip(OF_FACE, PAINTER.planes[:, :3], strict=True):
        share = SHADE + SUNSHINE * float(normal @ SUN)
        shades = [tuple(round(min(share * value, 255.0)) for value in rgb(text)) for text in PAINTS[paint]]
        light, dark = (f"#{red:02x}{green:02x}{blue:02x}" for red, green, blue in shades)
        yield f"light-dark({light}, {dark})"


FILLS = list(_fills())


def _mesh(bodies: list[Body]) -> trimesh.Trimesh:
    """Bodies of one colour, as triangles."""
    corners: list[Place] = []
    triangles: list[tuple[int, int, int]] = []
    for face in (face for body in bodies for face in body.faces):
        first = len(corners)
        corners += face
        triangles += [(first, first + k, first + k + 1) for k in range(1, len(face) - 1)]
    return trimesh.Trimesh(np.array(corners), triangles, process=False)


def _edges() -> Array:
    """Every edge (n, 2, 3) of the bodies, once."""
    found = {
        tuple(sorted((tuple(a), tuple(b))))
        for body in BODIES
        for face in body.faces
        for a, b in zip(face, (*face[1:], face[0]), strict=True)
    }
    return np.array(sorted(found))
