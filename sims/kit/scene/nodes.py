"""What a scene is made of. Each setter sends only what differs from what it was given last.

Values that a setter was given are kept for that, not copied: an array, or a list, must not be changed afterwards.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from sims.kit.scene.pieces import Dash, arc_pieces, dashes
from sims.kit.types import Segment, Vector
from sims.kit.viser_internals import send_pose, set_pose, set_property, set_visible

STRESS = 2.0
"""How much thicker lines, arrows and dots are while they are highlighted."""
HEAD_RADIUS, HEAD_LENGTH = 2.6, 7.0
"""Size of an arrow's head, in radii of its shaft."""


class Node:
    """A drawn thing with a pose relative to its parent."""

    def __init__(self, handle: Any) -> None:
        self.handle = handle
        self._given: dict[str, tuple[Any, ...]] = {}
        self._assigned: dict[str, Any] = {}
        self._pose: tuple[Any, Any] = (None, None)
        send_pose(handle)

    def pose(self, wxyz: Sequence[float] | None = None, position: Vector | None = None) -> None:
        """Turn and move it; what isn't given stays."""
        turned: Any = self._pose[0] if wxyz is None else tuple(map(float, wxyz))
        moved: Any = self._pose[1] if position is None else tuple(map(float, position))
        if (turned, moved) != self._pose:  # a tenth of the cost of asking viser's arrays
            was, self._pose = self._pose, (turned, moved)
            set_pose(self.handle, turned if turned != was[0] else None, moved if moved != was[1] else None)

    def place(self, position: Vector | None) -> None:
        """Show it at a place; hide it where there is none."""
        self.show(position is not None)
        if position is not None:
            self.pose(position=position)

    def show(self, visible: bool) -> None:
        """Show or hide it, and what hangs on it."""
        set_visible(self.handle, visible)

    def scale(self, factors: float | tuple[float, float, float]) -> None:
        """Stretch it (not what hangs on it): by one factor, or by one along each of its own axes."""
        self._assign("scale", factors)

    def stress(self, on: bool) -> None:
        """Make it stand out while what it is linked with is pointed at."""

    def _assign(self, name: str, value: float | str | tuple[float, ...]) -> None:
        """Send a property that isn't an array."""
        if self._assigned.get(name) != value:
            self._assigned[name] = value
            set_property(self.handle, name, value)

    def differs(self, what: str, *given: Any) -> bool:
        """Whether this is something else than what was given under that name last time."""
        last = self._given.get(what)
        self._given[what] = given
        if last is None or len(last) != len(given):
            return True
        for a, b in zip(last, given, strict=True):  # noqa: SIM110 — a generator takes half as long again
            if a is not b and not _same(a, b):
                return True
        return False


def _same(a: Any, b: Any) -> bool:
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return type(a) is type(b) and a.shape == b.shape and bool((a == b).all())
    return bool(a == b)


class Solid(Node):
    """A body, which can be bent and painted."""

    def color(self, rgb: tuple[int, int, int]) -> None:
        """Paint it: `palette.surface` of a role."""
        self._assign("color", rgb)

    def vertices(self, vertices: npt.NDArray[np.float64] | None) -> None:
        """Move the corners (n, 3) of its faces; hide it where there are none."""
        self.show(vertices is not None)
        if vertices is not None and self.differs("vertices", vertices):
            set_property(self.handle, "vertices", vertices.astype(np.float32))

    def shape(self, vertices: npt.NDArray[np.float64], faces: npt.NDArray[Any]) -> None:
        """Become another body: corners (n, 3), and the three corners of each face (m, 3)."""
        self.vertices(vertices)
        if self.differs("faces", faces):
            set_property(self.handle, "faces", faces.astype(np.uint32))


class Grip(Solid):
    """A ball that the pointer can drag, with the rings round it."""

    def __init__(self, handle: Any, rings: Sequence[Node]) -> None:
        super().__init__(handle)
        self._rings = rings
        self._holds: list[Callable[[bool], None]] = []

    def moves(self, hold: Callable[[bool], None]) -> None:
        """Have something that moves it too be held only while it is shown."""
        self._holds.append(hold)
        if not self.handle.visible:
            hold(False)

    def show(self, visible: bool) -> None:
        if visible != self.handle.visible:
            for hold in self._holds:
                hold(visible)
        super().show(visible)

    def scale(self, factors: float | tuple[float, float, float]) -> None:
        for node in self._rings:
            node.scale(factors)
        super().scale(factors)


class Cloud(Node):
    """Many dots, of one colour or each of its own."""

    def __init__(self, handle: Any) -> None:
        super().__init__(handle)
        self._size = float(handle.point_size)
        self._stress = 1.0

    def stress(self, on: bool) -> None:
        self._stress = STRESS if on else 1.0
        self.size(self._size)

    def points(self, points: npt.NDArray[np.floating[Any]]) -> None:
        """Move the dots to places (n, 3)."""
        if self.differs("points", points):
            set_property(self.handle, "points", points.astype(np.float32))

    def draw(self, points: npt.NDArray[np.float32], colors: npt.NDArray[np.uint8]) -> None:
        """Dots (n, 3) and their colours (n, 3), as `palette.before_film` makes them."""
        for name, values in (("points", points), ("colors", colors)):
            if self.differs(name, values):
                set_property(self.handle, name, values)

    def size(self, metres: float) -> None:
        """Diameter of each dot."""
        self._size = metres
        self._assign("point_size", metres * self._stress)


class Lines(Node):
    """Separate straight pieces of one colour; dashes are pieces too."""

    def __init__(self, handle: Any, rgb: tuple[int, int, int], dash: Dash) -> None:
        super().__init__(handle)
        self._rgb = np.array(rgb, np.uint8)
        self._dash = dash
        self._count = len(handle.points)
        self._width = float(handle.thickness)

    def stress(self, on: bool) -> None:
        self._assign("thickness", self._width * STRESS if on else self._width)

    def path(self, points: npt.ArrayLike) -> None:
        """Draw a polyline through points (n, 3)."""
        if self.differs("pieces", "path", points):
            self._send(dashes(np.asarray(points, dtype=float), self._dash))

    def pieces(self, pieces: npt.NDArray[Any] | None) -> None:
        """Draw pieces (n, 2, 3); hide them where there are none."""
        there = pieces is not None and len(pieces) > 0
        self.show(there)
        if pieces is not None and there and self.differs("pieces", "pieces", pieces):
            self._send(pieces)

    def stroke(self, ends: Segment | Sequence[Sequence[float]] | None) -> None:
        """Draw one undashed piece; hide it where there is none."""
        self.show(ends is not None)
        if ends is not None and self.differs("pieces", "stroke", ends):
            self._send(np.array([ends]))

    def arc(self, radius: float, angle: float, start: float = 0.0) -> None:
        """Draw a circular arc in the node's own xy plane, counter-clockwise from its x axis (radians)."""
        if self.differs("pieces", "arc", radius, angle, start):
            self._send(arc_pieces(radius, angle, start, self._dash))

    def _send(self, pieces: npt.NDArray[Any]) -> None:
        if len(pieces) != self._count:
            self._count = len(pieces)
            set_property(self.handle, "colors", np.broadcast_to(self._rgb, pieces.shape).copy())
        set_property(self.handle, "points", pieces.astype(np.float32))


class Strokes(Node):
    """Straight pieces, each in a colour of its own, that move at once."""

    def __init__(self, handle: Any) -> None:
        super().__init__(handle)
        self._width = float(handle.thickness)

    def stress(self, on: bool) -> None:
        self._assign("thickness", self._width * STRESS if on else self._width)

    def draw(self, pieces: Sequence[Sequence[Sequence[float]]] | npt.NDArray[np.float64]) -> None:
        """Two ends for each piece (n, 2, 3)."""
        if self.differs("pieces", pieces):
            set_property(self.handle, "points", np.array(pieces, np.float32))


class Label(Node):
    """Words at a place; constant size on the screen."""

    def text(self, text: str) -> None:
        """Change the words."""
        self._assign("text", text)

    def say(self, text: str | None) -> None:
        """Show words; hide the label where there are none."""
        self.show(text is not None)
        if text is not None:
            self.text(text)


class Arrows(Node):
    """One arrow or several, whose ends move at once."""

    def __init__(self, handle: Any) -> None:
        super().__init__(handle)
        self._radius = float(handle.shaft_radius)
        self._stress = 1.0

    def between(self, ends: Segment | None) -> None:
        """Place the only one, from tail to tip; hide it where there is none."""
        self.show(ends is not None)
        if ends is not None and self.differs("points", "one", ends):
            set_property(self.handle, "points", np.array([ends], np.float32))

    def draw(self, ends: npt.NDArray[np.float64]) -> None:
        """Tails and tips (n, 2, 3); hide them where there are none."""
        self.show(len(ends) > 0)
        if len(ends) and self.differs("points", "many", ends):
            set_property(self.handle, "points", ends.astype(np.float32))

    def thickness(self, radius: float) -> None:
        """Radius of their shafts in metres; their heads go with it."""
        self._radius = radius
        self._thicken()

    def stress(self, on: bool) -> None:
        self._stress = STRESS if on else 1.0
        self._thicken()

    def _thicken(self) -> None:
        radius = self._radius * self._stress
        for name, times in (("shaft_radius", 1.0), ("head_radius", HEAD_RADIUS), ("head_length", HEAD_LENGTH)):
            self._assign(name, times * radius)
