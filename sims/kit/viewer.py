"""One browser looking at the scene of a session."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol

import numpy as np
import viser

from geometry import GeometryError
from sims.kit.palette import DARK, LIGHT
from sims.kit.params import Params
from sims.kit.scene.stage import Stage
from sims.kit.sim import Sim
from sims.kit.types import Vector
from sims.kit.view import View

FARTHEST = 1e4
"""Metres that a viewpoint may be away."""
VERSION = "/version"
"""The node whose x says which version of the state the scene shows."""


class Host(Protocol):
    """What a viewer tells its session."""

    def select(self, name: str) -> None: ...

    def drag(self, name: str, place: tuple[float, ...]) -> None: ...

    def click(self, name: str, ray: tuple[float, ...]) -> None: ...

    def home(self, position: Vector, look_at: Vector, radius: float, *, moved: bool = True) -> None: ...


class Viewer:
    """The scene that one viser client shows; who only watches holds nothing in it."""

    def __init__(
        self, sim: Sim[Any, Any], client: viser.ClientHandle, host: Host, *, dark: bool = False, watching: bool = False
    ) -> None:
        self.sim = sim
        self.client = client
        self.watching = watching
        self._host = host
        client.gui.configure_theme(dark_mode=dark, show_logo=False, show_share_button=False)
        self._stage = Stage(client, DARK if dark else LIGHT, self._dragged, self._picked, self._clicked, host.home)
        self.scene = sim.scene(self._stage)
        self._highlight: Callable[[str], None] | None = getattr(self.scene, "highlight", None)
        self._highlighted = ""
        self._under: Callable[[object], None] | None = getattr(self.scene, "under", None)
        self._live = False
        self._version = self._stage.group(VERSION)
        self._home: View | None = None

    def draw(self, params: Params, solution: Any, version: int) -> None:
        """Show a state; only what differs is sent, in one window."""
        with self.client.atomic():
            if self._under is not None:
                self._under(None)
            self.scene.draw(params, solution)
            if self._highlighted:
                self._show_highlighted()
            self._live = True
            self._version.pose(position=(float(version), 0.0, 0.0))
        self.client.flush()
        self._step_back(params, solution)

    def _step_back(self, params: Params, solution: Any) -> None:
        """Tell the page when the state needs another view; whoever chose their own keeps it."""
        if self.sim.seen is None:
            return
        home = self.sim.home(params, solution)
        if home != self._home:
            self._home = home
            self._host.home(home.position, home.look_at, home.radius, moved=not home.radius)

    def look_from(self, view: Sequence[float]) -> None:
        """Move this page's viewpoint: where it is and where it looks, x, y, z each. Raises GeometryError."""
        viewpoint, target = np.array(view[:3]), np.array(view[3:])
        if not (np.abs(view) < FARTHEST).all() or np.linalg.norm(viewpoint - target) < 1e-6:
            allowed = f"six numbers within {FARTHEST:g} m: viewpoint x, y, z, and another place x, y, z to look at"
            raise GeometryError("view", [*view], allowed)
        self.client.camera.position = viewpoint
        self.client.camera.look_at = target
        self.client.flush()

    def highlight(self, name: str) -> None:
        """Highlight what somebody hovers over elsewhere; an empty name is nothing."""
        self._highlighted = name
        if self._live:
            with self.client.atomic():
                self._show_highlighted()
            self.client.flush()

    def under(self, found: object) -> None:
        """Show what is under the pointer, or nothing for None, until the next drawing."""
        if self._live and self._under is not None:
            with self.client.atomic():
                self._under(found)
            self.client.flush()

    def _show_highlighted(self) -> None:
        self._stage.highlight(self._highlighted)
        if self._highlight is not None:
            self._highlight(self._highlighted)

    def _picked(self, name: str) -> None:
        if not self.watching:
            self._host.select(name)

    def _clicked(self, name: str, ray: tuple[float, ...]) -> None:
        if not self.watching:
            self._host.click(name, ray)

    def _dragged(self, name: str, place: tuple[float, ...]) -> None:
        if not self.watching:
            self._host.drag(name, place)
