"""The little world in a scene, and as it is seen in a picture: solid, shaded, and without what is hidden."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from operator import itemgetter

import numpy as np
import trimesh

from geometry.affine_camera import AffineCamera
from geometry.arrays import Array
from geometry.camera import Camera
from geometry.painting import Painter, Pixels, clip_polygon
from geometry.projection import frame_planes, ground_line
from sims.kit.palette import before_tone_mapping, rgb
from sims.kit.pane import Picture
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
PAINTER = Painter([body.faces for body in BODIES])
OF_FACE = [body.paint for body in BODIES for _ in body.faces]


def draw_in_scene(stage: Stage, offset: Place = ORIGIN) -> None:
    """Put the little world into a scene, moved by so many metres: a solid for each colour, and their edges."""
    stage.group("/things").pose(position=offset)
    for paint, shades in PAINTS.items():
        mesh = _mesh([body for body in BODIES if body.paint == paint])
        stage.mesh(f"/things/{paint}", mesh, before_tone_mapping(shades[stage.palette.dark]), flat=True)
    edges = stage.lines("/things/edges", "ghost", width=0.8)
    edges.pieces(_edges())


def draw_in_picture(picture: Picture, camera: Camera | AffineCamera, offset: Place = ORIGIN) -> None:
    """Paint what a camera sees of the little world, moved by so many metres, and of the ground, into its picture."""
    P = _moved(camera.P, offset)
    nearest = _moved(camera.depth_row, offset) - (0.0, 0.0, 0.0, NEAREST)
    planes = np.concatenate([_framing(P, picture.width, picture.height), [nearest]])
    picture.areas([(GROUND, [ground])] if (ground := _ground(P, picture)) else [], edges=False)
    painted = PAINTER.paint(P, planes)
    by_fill = groupby(((FILLS[face], outline) for face, outline in painted), key=itemgetter(0))
    picture.areas((fill, [outline for _, outline in same]) for fill, same in by_fill)


def _moved(rows: Array, offset: Place) -> Array:
    """Rows (..., 4) that say of a place in the world what they said of it, moved back by an offset."""
    moved: Array = rows.copy()
    moved[..., 3] += rows[..., :3].dot(offset)
    return moved


def _framing(P: Array, width: float, height: float) -> Array:
    """Planes (4, 4) round what a picture shows, with a margin."""
    planes: Array = frame_planes(P, width, height) + MARGIN * P[2]
    return planes


def _ground(P: Array, picture: Picture) -> Pixels:
    """The part of a picture, with a margin, that shows the ground."""
    a, b, c = ground_line(P)
    left, top, right, bottom = -MARGIN, -MARGIN, picture.width + MARGIN, picture.height + MARGIN
    corners = [(u, v, a * u + b * v + c) for u, v in ((left, top), (right, top), (right, bottom), (left, bottom))]
    return [(u, v) for u, v, _ in clip_polygon(corners, 2)] if (a, b, c) != (0.0, 0.0, 0.0) else []


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
