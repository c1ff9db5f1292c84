"""The scene of one viewer: viser nodes in the colours of the theme, each with its cheapest setter.

Names are kinematic: `/body/nose` moves with `/body`. Lines keep a constant width in pixels, labels a
constant size on the screen. A node whose points aren't given has none until it is drawn.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt
import trimesh
import viser

from sims.kit.palette import AXES, DASHES, RGB, Palette
from sims.kit.scene import bodies, dragging, view
from sims.kit.scene.lights import light
from sims.kit.scene.nodes import HEAD_LENGTH, HEAD_RADIUS, Arrows, Cloud, Grip, Label, Lines, Node, Solid, Strokes
from sims.kit.scene.pieces import Dash, dashes
from sims.kit.types import Line, Place, Vector

NO_LINE = np.zeros((2, 3))
NO_ARROW = np.zeros((1, 2, 3))
NO_POINTS = np.zeros((0, 3))
SHEET = trimesh.Trimesh(np.eye(4, 3), [[0, 1, 2], [0, 2, 3]], process=False)


class Stage:
    """Makes nodes for one viewer."""

    def __init__(
        self, client: viser.ClientHandle, palette: Palette, drag: Callable[[str, tuple[float, ...]], None],
        pick: Callable[[str], None] = lambda name: None,
        click: Callable[[str, tuple[float, ...]], None] = lambda name, ray: None,
        home: Callable[[Vector, Vector, float], None] = lambda position, look_at, radius: None,
    ) -> None:  # fmt: skip
        self.client = client
        self.scene = client.scene
        self.palette = palette
        self._drag = drag
        self._pick = pick
        self._click = click
        self._home = home
        self._linked: dict[str, list[Node]] = {}
        self._highlighted = ""

    def ground(self, size: float = 8.0, height: float = 0.0, cell: float = 0.5) -> Node:
        """The light floor grid, and soft light from above."""
        grey = (58, 66, 76) if self.palette.dark else (222, 226, 230)
        section = (78, 88, 100) if self.palette.dark else (200, 206, 212)
        grid = self.scene.add_grid(
            "/ground", width=size, height=size, plane="xy", cell_size=cell, section_size=2 * cell,
            cell_color=grey, section_color=section, cell_thickness=0.6, section_thickness=0.9,
            position=(0.0, 0.0, height), shadow_opacity=0.0,
        )  # fmt: skip
        light(self.scene)
        return Node(grid)

    def rays(self, name: str) -> None:
        """Have the session hear under `name` of each click into the scene, as a ray: origin, then unit direction."""

        @self.scene.on_click()  # type: ignore[arg-type]
        async def _(event: Any) -> None:
            self._click(name, (*event.ray_origin, *event.ray_direction))

    def look(self, position: Vector, look_at: Vector, radius: float) -> None:
        """Look from a place at another, or from so far behind it that a sphere of `radius` fits; so does Home view."""
        self._home(position, look_at, radius)
        view.look(self.client.camera, position, look_at, radius)

    def look_through(self, window: view.Window) -> None:
        """See the scene as through a window; the sim's view of such a state is from the same place, with radius 0."""
        view.look_through(self.client.camera, window)

    def stand_back(self) -> None:
        """See the scene upright and as wide as usual again; the sim's view of the state says from where."""
        view.stand_back(self.client.camera)

    def linked(self, name: str, *nodes: Node) -> None:
        """Highlight nodes together with all else that is linked under a name: a control, entries of a matrix."""
        self._linked.setdefault(name, []).extend(nodes)

    def highlight(self, name: str) -> None:
        """Highlight what is linked under a name, and nothing else."""
        if name != self._highlighted:
            for node in self._linked.get(self._highlighted, ()):
                node.stress(False)
        for node in self._linked.get(name, ()):
            node.stress(True)
        self._highlighted = name

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
            for axis, tip in zip(AXES, unit, strict=True):
                self.lines(f"{name}/{axis}", axis, [np.zeros(3), tip], width=1.5, dash=DASHES[axis])
        else:
            self.arrows(f"{name}/arrows", AXES, np.stack([np.zeros((3, 3)), unit], axis=1), radius=radius)
        for axis, word, tip in zip(AXES, letters or (), unit, strict=False):
            self.label(f"{name}/letter_{axis}", word, tip * 1.08)
        return frame

    def lines(
        self, name: str, role: str, points: npt.ArrayLike = NO_LINE, *, width: float = 2.0, dash: Dash = None
    ) -> Lines:
        """A polyline through points (n, 3); `role` is a colour of the palette, `dash` its (on, off) in metres."""
        pieces = dashes(np.asarray(points, dtype=float), dash)
        rgb = self.palette.line(role)
        handle = self.scene.add_line_segments(
            name, points=pieces, colors=np.broadcast_to(np.array(rgb, np.uint8), pieces.shape),
            thickness=width, thickness_units="screen",
        )  # fmt: skip
        return Lines(handle, rgb, dash)

    def strokes(self, name: str, roles: Sequence[str], *, width: float = 2.0, faint: bool = False) -> Strokes:
        """One straight piece in the colour of each role; they begin without length."""
        color = self.palette.faint if faint else self.palette.line
        colors = np.array([[color(role)] * 2 for role in roles], np.uint8)
        handle = self.scene.add_line_segments(
            name, points=np.zeros(colors.shape), colors=colors, thickness=width, thickness_units="screen"
        )
        return Strokes(handle)

    def arrow(self, name: str, role: str, tail: Vector, tip: Vector, *, radius: float = 0.015) -> Arrows:
        """An arrow from tail to tip."""
        return self.arrows(name, role, np.array([[tail, tip]]), radius=radius)

    def arrows(
        self, name: str, roles: str | Sequence[str], ends: npt.ArrayLike = NO_ARROW, *, radius: float = 0.015
    ) -> Arrows:
        """Arrows from tails to tips (n, 2, 3), any number of them in one colour, or each in that of its role."""
        colors = [self.palette.line(role) for role in ([roles] if isinstance(roles, str) else roles)]
        handle = self.scene.add_arrows(
            name, points=np.asarray(ends, dtype=float),
            colors=np.array(colors[0] if isinstance(roles, str) else colors, np.uint8), shaft_radius=radius,
            head_radius=HEAD_RADIUS * radius, head_length=HEAD_LENGTH * radius,
        )  # fmt: skip
        return Arrows(handle)

    def label(
        self, name: str, text: str = "", position: Vector = (0.0, 0.0, 0.0), *, anchor: Any = "center-center"
    ) -> Label:
        """Words in the scene."""
        handle = self.scene.add_label(name, text, position=_triple(position), anchor=anchor, font_screen_scale=1.15)
        return Label(handle)

    def mesh(
        self, name: str, body: trimesh.Trimesh, role: str | RGB, *, opacity: float | None = None, side: Any = "front",
        flat: bool = False,
    ) -> Solid:  # fmt: skip
        """A solid body in one colour."""
        color = role if isinstance(role, tuple) else self.palette.surface(role)
        handle = self.scene.add_mesh_simple(
            name, vertices=body.vertices, faces=body.faces, color=color, opacity=opacity, side=side,
            flat_shading=flat, cast_shadow=False, receive_shadow=False,
        )  # fmt: skip
        return Solid(handle)

    def sheet(self, name: str, role: str, *, opacity: float) -> Solid:
        """A pane that is seen through, from both sides; its `vertices` are four corners."""
        return self.mesh(name, SHEET, role, opacity=opacity, side="double", flat=True)

    def ball(self, name: str, radius: float, role: str, *, opacity: float | None = None, side: Any = "front") -> Solid:
        """A sphere; one that others are inside of shows its back, or they'd be hidden."""
        handle = self.scene.add_icosphere(
            name, radius=radius, subdivisions=3, color=self.palette.surface(role), opacity=opacity,
            side=side, cast_shadow=False, receive_shadow=False,
        )  # fmt: skip
        return Solid(handle)

    def cloud(self, name: str, role: str, points: npt.NDArray[Any] = NO_POINTS, *, size: float = 0.01) -> Cloud:
        """Many small dots of one colour, sent as float32."""
        handle = self.scene.add_point_cloud(
            name, points=points.astype(np.float32), colors=self.palette.surface(role), point_size=size,
            point_shape="circle", precision="float32",
        )  # fmt: skip
        return Cloud(handle)

    def aircraft(
        self, name: str, *, scale: float = 1.0, ghost: tuple[float, float] | None = None
    ) -> tuple[Solid, Solid]:
        """The aircraft with its marked wing, under a node; a `ghost` has opacities of its hull and its mark."""
        parts = bodies.aircraft(scale)
        hull, mark = ghost or (None, None)
        return (
            self.mesh(f"{name}/hull", parts["hull"], self.palette.solid if ghost is None else "ghost", opacity=hull),
            self.mesh(f"{name}/mark", parts["mark"], "held", opacity=mark),
        )

    def grip(
        self, name: str, radius: float, role: str = "held", *, halo: float = 1.7,
        axis: Callable[[], Vector] | None = None,
    ) -> Grip:  # fmt: skip
        """A ball that the pointer can drag, with a ring `halo` times as wide; the session hears of it under `name`.

        It moves in the plane that faces the viewer; with Shift held, along the world axis nearest to the pull. One with
        an `axis`, a unit vector through the world's origin, stays on its circle about that.
        """
        ball = self.ball(name, radius, role)
        rings = [
            self.mesh(f"{name}/halo{k}", ring, role, opacity=0.55)
            for k, ring in enumerate(bodies.rings(halo * radius, 0.14 * halo * radius))
        ]
        dragging.listen(ball.handle, partial(self._drag, name), None if axis is None else self._round(axis))
        return Grip(ball.handle, rings)

    def turned_by(self, body: Node, name: str, grip: Grip, line: Callable[[], Line | None]) -> None:
        """Have a body that the grip of that name turns turn by itself too, wherever it is taken; see `listen_round`."""
        eye = partial(getattr, self.client.camera, "position")
        grip.moves(dragging.listen_round(body.handle, partial(self._drag, name), grip.handle, line, eye))

    def carried_by(self, parts: Sequence[Node], name: str, grip: Grip) -> None:
        """Have the parts of a body that the grip of that name moves move by themselves too, wherever they are taken."""
        for part in parts:
            grip.moves(dragging.listen(grip.handle, partial(self._drag, name), body=part.handle))

    def pulled(
        self, parts: Sequence[Node], name: str, turned: Callable[[], npt.NDArray[np.float64]], *, least: float
    ) -> None:
        """Have a body that turns about the world's origin be pulled by any of its parts; see `listen_anywhere`."""
        eye = partial(getattr, self.client.camera, "position")
        for part in parts:
            dragging.listen_anywhere(part.handle, partial(self._drag, name), eye, turned, least)

    def _round(self, axis: Callable[[], Vector]) -> dragging.Path:
        return lambda at, pulled: dragging.on_circle(at, axis(), self.client.camera.position, pulled)

    def link(self, node: Node, name: str) -> None:
        """A click on the node selects `name`, as a click on its mark in a picture or its row in a table does."""

        @node.handle.on_click  # type: ignore[untyped-decorator]
        async def _(_: Any) -> None:
            self._pick(name)


def _triple(vector: Vector) -> Place:
    return float(vector[0]), float(vector[1]), float(vector[2])
