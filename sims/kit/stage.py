"""The scene of one viewer: viser nodes in the colours of the theme, each with its cheapest setter.

Names are kinematic: `/body/nose` moves with `/body`. Lines keep a constant width in pixels, labels a
constant size on the screen.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import trimesh
import viser

from sims.kit.palette import AXES, Palette
from sims.kit.viser_internals import send_pose, set_pose, set_property, set_visible

Vector = Sequence[float] | npt.NDArray[np.float64]
Quaternion = tuple[float, float, float, float]
Drag = Callable[["Dragged"], None]
FIELD = 0.7
"""Vertical field of view in radians, as boot.js sets it."""
SHEET = 0.55
"""Share of a phone's height that viser's bottom sheet leaves free."""
HEAD_RADIUS, HEAD_LENGTH = 2.6, 7.0
"""Of an arrow, in radii of its shaft."""
IDENTITY: Quaternion = (1.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Dragged:
    """A pointer that holds a node: where the node would go (world, metres)."""

    position: tuple[float, float, float]
    finished: bool


class Node:
    """A drawn thing with a pose relative to its parent."""

    _scale: float | tuple[float, float, float] = 1.0

    def __init__(self, handle: Any) -> None:
        self.handle = handle
        self._pose: tuple[Any, Any] = (None, None)
        send_pose(handle)

    def pose(self, wxyz: Sequence[float] | None = None, position: Vector | None = None) -> None:
        turned: Any = self._pose[0] if wxyz is None else tuple(map(float, wxyz))
        moved: Any = self._pose[1] if position is None else tuple(map(float, position))
        if (turned, moved) != self._pose:  # a tenth of the cost of asking viser's arrays
            was, self._pose = self._pose, (turned, moved)
            set_pose(self.handle, turned if turned != was[0] else None, moved if moved != was[1] else None)

    def show(self, visible: bool) -> None:
        set_visible(self.handle, visible)

    def scale(self, factors: float | tuple[float, float, float]) -> None:
        """Stretch it (not what hangs on it): by one factor, or by one along each of its own axes."""
        if factors != self._scale:
            self._scale = factors
            set_property(self.handle, "scale", factors)


class Solid(Node):
    """A body, which can be bent and painted."""

    def color(self, rgb: tuple[int, int, int]) -> None:
        """Paint it: `palette.surface` of a role."""
        set_property(self.handle, "color", rgb)

    def vertices(self, vertices: npt.NDArray[np.float64]) -> None:
        """Move the corners (n, 3) of its faces."""
        set_property(self.handle, "vertices", vertices.astype(np.float32))

    def shape(self, vertices: npt.NDArray[np.float64], faces: npt.NDArray[Any]) -> None:
        """Become another body: corners (n, 3), and the three corners of each face (m, 3)."""
        self.vertices(vertices)
        set_property(self.handle, "faces", faces.astype(np.uint32))


class Cloud(Node):
    """Many dots, of one colour or each of its own."""

    _shown: npt.NDArray[np.float32] | None = None
    _colors: npt.NDArray[np.uint8] | None = None
    _size: float | None = None

    def points(self, points: npt.NDArray[np.float64]) -> None:
        """Move the dots to places of shape (n, 3)."""
        set_property(self.handle, "points", points.astype(np.float32))

    def draw(self, points: npt.NDArray[np.float32], colors: npt.NDArray[np.uint8]) -> None:
        """Dots (n, 3) and their colours (n, 3), as `palette.before_film` makes them; both are kept, not copied."""
        if points is not self._shown:
            self._shown = points
            set_property(self.handle, "points", points)
        self.paint(colors)

    def paint(self, colors: npt.NDArray[np.uint8]) -> None:
        """Colours (n, 3) of the dots."""
        if colors is not self._colors:
            self._colors = colors
            set_property(self.handle, "colors", colors)

    def size(self, metres: float) -> None:
        """Diameter of each dot."""
        if metres != self._size:
            self._size = metres
            set_property(self.handle, "point_size", metres)


class Lines(Node):
    """Separate straight pieces; dashes are pieces too."""

    def __init__(self, handle: Any, rgb: tuple[int, int, int], dash: tuple[float, float] | None) -> None:
        super().__init__(handle)
        self._rgb = np.array(rgb, np.uint8)
        self._dash = dash
        self._count = len(handle.points)
        self._arc: tuple[float, float, float] | None = None
        self._stroke: tuple[Sequence[float], Sequence[float]] | None = None

    def path(self, points: npt.ArrayLike) -> None:
        """Draw a polyline through points of shape (n, 3)."""
        self.pieces(dashes(np.asarray(points, dtype=float), self._dash))

    def pieces(self, pieces: npt.NDArray[Any]) -> None:
        """Draw pieces of shape (n, 2, 3)."""
        if len(pieces) != self._count:
            self._count = len(pieces)
            set_property(self.handle, "colors", np.broadcast_to(self._rgb, pieces.shape).copy())
        set_property(self.handle, "points", pieces.astype(np.float32))

    def stroke(self, start: Sequence[float], end: Sequence[float]) -> None:
        """Draw one undashed piece."""
        if (start, end) != self._stroke:
            self._stroke = start, end
            set_property(self.handle, "points", np.array([(start, end)], np.float32))

    def arc(self, radius: float, angle: float, start: float = 0.0) -> None:
        """Draw a circular arc in the node's own xy plane, counter-clockwise from its x axis (radians)."""
        if self._arc != (radius, angle, start):
            self._arc = radius, angle, start
            self.pieces(arc_pieces(radius, angle, start, self._dash))


class Strokes(Node):
    """Straight pieces, each in a colour of its own, that move at once."""

    _shown: Sequence[Sequence[Sequence[float]]] = ()

    def draw(self, pieces: Sequence[Sequence[Sequence[float]]]) -> None:
        """Two ends for each piece."""
        if pieces != self._shown:
            self._shown = pieces
            set_property(self.handle, "points", np.array(pieces, np.float32))

    def move(self, pieces: npt.NDArray[np.float64]) -> None:
        """Two ends for each piece (n, 2, 3), which are known to differ from those before."""
        set_property(self.handle, "points", pieces.astype(np.float32))


class Label(Node):
    """Words at a place; constant size on the screen."""

    _shown = ""

    def text(self, text: str) -> None:
        if text != self._shown:
            self._shown = text
            set_property(self.handle, "text", text)


class Arrows(Node):
    """One arrow or several, whose ends move at once."""

    _radius: float | None = None

    def between(self, tail: Vector, tip: Vector) -> None:
        """Place the only one."""
        self.draw(np.array([[tail, tip]], dtype=float))

    def draw(self, ends: npt.NDArray[np.float64]) -> None:
        """Tails and tips (n, 2, 3)."""
        set_property(self.handle, "points", ends.astype(np.float32))

    def thickness(self, radius: float) -> None:
        """Radius of their shafts in metres; their heads go with it."""
        if radius != self._radius:
            self._radius = radius
            for name, times in (("shaft_radius", 1.0), ("head_radius", HEAD_RADIUS), ("head_length", HEAD_LENGTH)):
                set_property(self.handle, name, times * radius)


ARC_PIECES = 48


def arc_pieces(radius: float, angle: float, start: float, dash: tuple[float, float] | None) -> npt.NDArray[np.float64]:
    """An arc in the xy plane as pieces (n, 2, 3); dashes (metres along it) keep their length."""
    length = abs(angle) * radius
    count = ARC_PIECES if dash is None else max(int(length / sum(dash)) + 1, 1)
    step = angle / count if dash is None else math.copysign(sum(dash) / radius, angle)
    ends = np.empty((count, 2))
    ends[:, 0] = start + step * np.arange(count)
    ends[:, 1] = ends[:, 0] + (step if dash is None else math.copysign(dash[0] / radius, angle))
    if dash is not None:
        np.clip(ends, min(start, start + angle), max(start, start + angle), out=ends)
    pieces = np.zeros((count, 2, 3))
    pieces[..., 0] = radius * np.cos(ends)
    pieces[..., 1] = radius * np.sin(ends)
    return pieces


def dashes(points: npt.NDArray[np.float64], dash: tuple[float, float] | None) -> npt.NDArray[np.float64]:
    """A polyline (n, 3) as pieces (m, 2, 3): its segments, or dashes of (on, off) metres along it."""
    if dash is None or len(points) < 2:
        return np.stack([points[:-1], points[1:]], axis=1)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    on, off = dash
    starts = np.arange(0.0, max(along[-1], 1e-9), on + off)[:400]
    ends = np.minimum(starts + on, along[-1])
    sample = [np.column_stack([np.interp(s, along, points[:, k]) for k in range(3)]) for s in (starts, ends)]
    return np.stack(sample, axis=1)


class Stage:
    """Makes nodes for one viewer."""

    def __init__(
        self, client: viser.ClientHandle, palette: Palette, drag: Callable[[str, Dragged], None],
        pick: Callable[[str], None] = lambda name: None,
        point: Callable[[str, tuple[float, ...]], None] = lambda name, ray: None,
        width: float = math.inf, phone: bool = False,
    ) -> None:  # fmt: skip
        self.client = client
        self._width = width
        """Pixels that panels leave to the scene, once they are there."""
        self._phone = phone
        self.looked: tuple[Vector, Vector, float] | None = None
        """What `look` was told last."""
        self.scene = client.scene
        self.palette = palette
        self._drag = drag
        self._pick = pick
        self._point = point

    def ground(self, size: float = 8.0, height: float = 0.0, cell: float = 0.5) -> Node:
        """The light floor grid, and soft light from above."""
        grey = (58, 66, 76) if self.palette.dark else (222, 226, 230)
        section = (78, 88, 100) if self.palette.dark else (200, 206, 212)
        grid = self.scene.add_grid(
            "/ground", width=size, height=size, plane="xy", cell_size=cell, section_size=2 * cell,
            cell_color=grey, section_color=section, cell_thickness=0.6, section_thickness=0.9,
            position=(0.0, 0.0, height), shadow_opacity=0.0,
        )  # fmt: skip
        self.scene.configure_default_lights(enabled=False)
        # viser's default map costs a machine without a GPU 10 s at each opening, and bleaches every colour.
        self.scene.configure_environment_map(None)
        self.scene.add_light_hemisphere("/sky", sky_color=(255, 255, 255), ground_color=(150, 158, 168), intensity=2.6)
        self.scene.add_light_directional("/sun", intensity=1.2, position=(2.0, -3.0, 6.0))
        return Node(grid)

    def rays(self, name: str) -> None:
        """Have the session hear under `name` of each click into the scene, as a ray: origin, then unit direction."""

        @self.scene.on_click()  # type: ignore[arg-type]
        async def _(event: Any) -> None:
            self._point(name, (*event.ray_origin, *event.ray_direction))

    def look(self, position: Vector, look_at: Vector, radius: float) -> None:
        """Look from a place at another, or from so far behind it that a sphere of `radius` fits."""
        self.looked = position, look_at, radius
        camera = self.client.camera
        seen = SHEET if self._phone else 1.0  # of the height; boot.js does the same for the first view
        height = camera.image_height or 1  # a frame that is hidden again has none
        aspect = (min(camera.image_width, self._width) or 1) / (seen * height)
        half = math.tan(0.5 * FIELD) * min(1.0, aspect) * seen
        away = np.subtract(position, look_at)
        away *= radius / math.sin(math.atan(half)) / float(np.linalg.norm(away))
        middle = np.subtract(look_at, (0.0, 0.0, 0.75 * radius if self._phone else 0.0))
        camera.position = middle + away
        camera.look_at = middle

    def group(self, name: str) -> Node:
        """An invisible frame that others hang on."""
        return Node(self.scene.add_frame(name, show_axes=False))

    def axes(
        self, name: str, length: float, *, radius: float = 0.012, letters: Sequence[str] | None = ("X", "Y", "Z"),
        ghost: bool = False,
    ) -> Node:  # fmt: skip
        """A coordinate frame: three arrows in axis colours with letters at their tips.

        A ghost (a frame before or between) is thin, dashed per axis, and has no heads.
        """
        frame = self.group(name)
        unit = np.eye(3) * length
        if ghost:
            patterns = {"x": (length, 0.0), "y": (0.12, 0.05), "z": (0.05, 0.05)}
            for axis, tip in zip(AXES, unit, strict=True):
                self.lines(f"{name}/{axis}", [np.zeros(3), tip], axis, width=1.5, dash=patterns[axis])
        else:
            self.arrows(f"{name}/arrows", np.stack([np.zeros((3, 3)), unit], axis=1), AXES, radius=radius)
        for axis, word, tip in zip(AXES, letters or (), unit, strict=False):
            self.label(f"{name}/letter_{axis}", word, tip * 1.08)
        return frame

    def lines(
        self, name: str, points: npt.ArrayLike, role: str, *, width: float = 2.0,
        dash: tuple[float, float] | None = None,
    ) -> Lines:  # fmt: skip
        """A polyline through points (n, 3); `role` is a colour of the palette, `dash` its (on, off) in metres."""
        pieces = dashes(np.asarray(points, dtype=float), dash)
        rgb = self.palette.line(role)
        handle = self.scene.add_line_segments(
            name, points=pieces, colors=np.broadcast_to(np.array(rgb, np.uint8), pieces.shape),
            thickness=width, thickness_units="screen",
        )  # fmt: skip
        return Lines(handle, rgb, dash)

    def strokes(self, name: str, roles: Sequence[str], *, width: float = 2.0) -> Strokes:
        """One straight piece in the colour of each role; they begin without length."""
        colors = np.array([[self.palette.line(role)] * 2 for role in roles], np.uint8)
        handle = self.scene.add_line_segments(
            name, points=np.zeros(colors.shape), colors=colors, thickness=width, thickness_units="screen"
        )
        return Strokes(handle)

    def arrow(self, name: str, tail: Vector, tip: Vector, role: str, *, radius: float = 0.015) -> Arrows:
        """An arrow from tail to tip."""
        return self.arrows(name, np.array([[tail, tip]]), role, radius=radius)

    def arrows(self, name: str, ends: npt.ArrayLike, roles: str | Sequence[str], *, radius: float = 0.015) -> Arrows:
        """Arrows from tails to tips (n, 2, 3), any number of them in one colour, or each in that of its role."""
        colors = [self.palette.line(role) for role in ([roles] if isinstance(roles, str) else roles)]
        handle = self.scene.add_arrows(
            name, points=np.asarray(ends, dtype=float),
            colors=np.array(colors[0] if isinstance(roles, str) else colors, np.uint8), shaft_radius=radius,
            head_radius=HEAD_RADIUS * radius, head_length=HEAD_LENGTH * radius,
        )  # fmt: skip
        return Arrows(handle)

    def label(
        self, name: str, text: str, position: Vector = (0.0, 0.0, 0.0), *, anchor: Any = "center-center"
    ) -> Label:
        """Words in the scene."""
        handle = self.scene.add_label(name, text, position=_triple(position), anchor=anchor, font_screen_scale=1.15)
        return Label(handle)

    def mesh(
        self, name: str, body: trimesh.Trimesh, role: str | tuple[int, int, int], *, opacity: float | None = None,
        side: Any = "front", flat: bool = False,
    ) -> Solid:  # fmt: skip
        """A solid body in one colour."""
        color = role if isinstance(role, tuple) else self.palette.surface(role)
        handle = self.scene.add_mesh_simple(
            name, vertices=body.vertices, faces=body.faces, color=color, opacity=opacity, side=side,
            flat_shading=flat, cast_shadow=False, receive_shadow=False,
        )  # fmt: skip
        return Solid(handle)

    def ball(self, name: str, radius: float, role: str, *, opacity: float | None = None, side: Any = "front") -> Solid:
        """A sphere; one that others are inside of shows its back, or they'd be hidden."""
        handle = self.scene.add_icosphere(
            name, radius=radius, subdivisions=3, color=self.palette.surface(role), opacity=opacity,
            side=side, cast_shadow=False, receive_shadow=False,
        )  # fmt: skip
        return Solid(handle)

    def cloud(self, name: str, points: npt.NDArray[Any], role: str, *, size: float = 0.01) -> Cloud:
        """Many small dots of one colour, sent as float32."""
        handle = self.scene.add_point_cloud(
            name, points=points.astype(np.float32), colors=self.palette.surface(role), point_size=size,
            point_shape="circle", precision="float32",
        )  # fmt: skip
        return Cloud(handle)

    def grip(self, name: str, radius: float, role: str = "held", *, halo: float = 1.7) -> Node:
        """A ball that the pointer can drag, with a ring `halo` times as wide; the session hears of it under `name`.

        It moves in the plane that faces the viewer; with Shift held, along the world axis nearest to the pull.
        """
        ball = self.ball(name, radius, role)
        ring = trimesh.creation.torus(
            major_radius=halo * radius, minor_radius=0.07 * halo * radius, major_sections=48, minor_sections=8
        )
        for k, turn in enumerate([np.eye(4), trimesh.transformations.rotation_matrix(np.pi / 2, [1, 0, 0])]):
            self.mesh(f"{name}/halo{k}", ring.copy().apply_transform(turn), role, opacity=0.55)
        self._listen(ball.handle, name)
        return ball

    def link(self, node: Node, name: str) -> None:
        """A click on the node selects `name`, as a click on its mark in a picture or its row in a table does."""

        @node.handle.on_click  # type: ignore[untyped-decorator]
        async def _(_: Any) -> None:
            self._pick(name)

    def _listen(self, handle: Any, name: str) -> None:
        offset = np.zeros(3)
        origin = np.zeros(3)

        def moved(event: Any, straight: bool) -> None:
            nonlocal offset, origin
            if event.phase == "start":
                origin = np.array(handle.position)
                offset = origin - np.array(event.start_position)
            target = np.array(event.end_position) + offset
            if straight:
                pull = target - origin
                keep = np.argmax(np.abs(pull))
                target = origin + np.where(np.arange(3) == keep, pull, 0.0)
            place = (float(target[0]), float(target[1]), float(target[2]))
            self._drag(name, Dragged(place, event.phase == "end"))

        @handle.on_drag("left")  # type: ignore[untyped-decorator]
        async def _(event: Any) -> None:
            moved(event, straight=False)

        @handle.on_drag("left", modifier="shift")  # type: ignore[untyped-decorator]
        async def _(event: Any) -> None:
            moved(event, straight=True)


def _triple(vector: Vector) -> tuple[float, float, float]:
    return float(vector[0]), float(vector[1]), float(vector[2])
