"""One browser looking at a session: controls made from Params, the scene, image panes and read-outs."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from html import escape
from typing import Any, NamedTuple, Protocol

import numpy as np
import viser

from geometry import GeometryError
from sims.kit import pane, readout
from sims.kit.controls import Control, TypedPlace, controls, worded
from sims.kit.layout import LAYOUT
from sims.kit.offers import Offers
from sims.kit.palette import DARK, LIGHT
from sims.kit.params import Params
from sims.kit.scene.stage import Stage
from sims.kit.sim import Library, Sim, Typed
from sims.kit.types import Place
from sims.kit.viser_internals import control_id, received, set_property

ACCENT = (11, 95, 215)
FARTHEST = 1e4
"""Metres that a viewpoint may be away."""


class Host(Protocol):
    """What a viewer tells its session."""

    def change(self, changes: Mapping[str, Any]) -> None: ...

    def act(self, name: str) -> None: ...

    def select(self, name: str) -> None: ...

    def drag(self, name: str, place: tuple[float, ...]) -> None: ...

    def click(self, name: str, ray: tuple[float, ...]) -> None: ...


@dataclass(frozen=True)
class Look:
    """What the viewer's page said of itself."""

    dark: bool = False
    controls: bool = True
    watching: bool = False
    width: int = 1280
    height: int = 800
    """Both of the page, in pixels."""

    @property
    def narrow(self) -> bool:
        return self.width < LAYOUT.narrow

    @property
    def phone(self) -> bool:
        return self.width <= LAYOUT.phone

    @property
    def low(self) -> bool:
        return self.height < LAYOUT.low


class Input(NamedTuple):
    """A control that a page can set, and what becomes of its value."""

    handle: Any
    take: Callable[[Any], None]


class Viewer:
    """Everything that one viser client shows."""

    def __init__(
        self, sim: Sim[Any, Any], client: viser.ClientHandle, host: Host, look: Look, params: Params,
        library: tuple[Library, ...] = (),
    ) -> None:  # fmt: skip
        self.sim = sim
        self._library = library
        """The server's, where the sim has files."""
        self.client = client
        self.look = look
        self.palette = DARK if look.dark else LIGHT
        self._style = self.palette.style()
        self._host = host
        self._inputs: dict[str, Input] = {}
        self._form: tuple[Any, ...] = ()
        client.gui.configure_theme(
            dark_mode=look.dark, show_logo=False, show_share_button=False, brand_color=ACCENT,
        )  # fmt: skip
        client.gui.set_panel_label(sim.title)
        if look.controls:
            self._dock()
        # viser's bottom sheet on phones has one column: pictures in which nothing is held come after the controls, and
        # all of them where the first control would else be out of sight
        held = any(not name.startswith("/") for name in sim.handles)
        first = not (look.phone or look.narrow) or (not look.low and (held or not look.phone))
        self._panes = self._add_panes() if first else None
        self._controls: list[Control] = []
        self._places: list[TypedPlace] = []
        self._readouts: viser.GuiHtmlHandle | None = None
        self._preview: viser.GuiHtmlHandle | None = None
        if look.controls:
            self._add_controls(sim.offers(params, None, *library))
        if self._panes is None:
            self._panes = self._add_panes()
        if look.controls:
            self._readouts = self._add_readouts()
        width = look.width - self._docked()
        self._stage = Stage(client, self.palette, self._dragged, self._picked, self._clicked, width, look.phone)
        self.scene = sim.scene(self._stage)
        self._highlight: Callable[[str], None] | None = getattr(self.scene, "highlight", None)
        self._highlighted = ""
        self._live = False

    def input(self, control: str, value: Any) -> bool:
        """Take what the page says that a control is set to; False if there is none, or it can't be set to that."""
        known = self._inputs.get(control)
        if known is None or not received(known.handle, value):
            return False
        with suppress(LookupError):  # no page sends what isn't offered
            known.take(known.handle.value)
        return True

    def draw(self, params: Params, solution: Any) -> None:
        """Show a state; only what differs is sent, in one window."""
        with self.client.atomic():
            self.scene.draw(params, solution)
            if self._highlight is not None and self._highlighted:
                self._highlight(self._highlighted)
            if not self._live:
                self._live = True
                self.client.gui.add_html("<span hidden data-s3-drawn></span>")  # in the same window
            offers = self.sim.offers(params, solution, *self._library)
            if (form := offers.form()) != self._form:
                self._form = form
                for control in self._controls:
                    control.reword(offers)
            for control in self._controls:
                control.draw(offers)
            for place in self._places:
                place.draw(params, solution)
            if self._readouts is not None:
                html = readout.render(self.sim.readouts(params, solution)) + self._regions(offers)
                set_property(self._readouts, "content", html)
            if self._preview is not None and self.sim.files is not None:
                preview = self.sim.files.preview(params, *self._library)
                set_property(self._preview, "content", "" if preview is None else readout.render([preview]))
            if self._panes is not None and self.sim.panes is not None:
                panes = self.sim.panes(params, solution)
                set_property(self._panes, "content", pane.render(panes, self._style))
        self.client.flush()

    def look_from(self, view: Sequence[float], fit: bool = False) -> None:
        """Move this page's viewpoint: where it is and where it looks, x, y, z each. Raises GeometryError.

        `fit`: the page has another size, and the view is what then fits the sim's first one; where the scene has
        chosen another one since, that is fitted anew.
        """
        if fit and self._stage.looked is not None:
            self._stage.look(*self._stage.looked)
            self.client.flush()
            return
        viewpoint, target = np.array(view[:3]), np.array(view[3:])
        if not (np.abs(view) < FARTHEST).all() or np.linalg.norm(viewpoint - target) < 1e-6:
            allowed = f"six numbers within {FARTHEST:g} m: viewpoint x, y, z, and another place x, y, z to look at"
            raise GeometryError("view", [*view], allowed)
        self.client.camera.position = viewpoint
        self.client.camera.look_at = target
        self.client.flush()

    def highlight(self, name: str) -> None:
        """Highlight what somebody hovers over elsewhere, in scenes that know how; an empty name is nothing."""
        self._highlighted = name
        if self._highlight is not None and self._live:
            with self.client.atomic():
                self._highlight(name)
            self.client.flush()

    def _regions(self, offers: Offers[Any]) -> str:
        """Where on a slider's track something happens, as fractions, for the companion to mark."""
        return _marks(
            tuple((worded(offers, name), offers.bounds(name), tuple(s)) for name, s in offers.params.regions().items())
        )

    @property
    def _panel(self) -> int:
        return LAYOUT.narrow_panel if self.look.narrow else LAYOUT.panel

    def _docked(self) -> int:
        """Pixels that panels take of the width."""
        if self.look.phone:
            return 0
        pictures = LAYOUT.pictures if self.sim.panes is not None and not self.look.narrow else 0
        return pictures + (self._panel if self.look.controls else 0)

    def _dock(self) -> None:
        panel = self.client.gui.main_panel
        panel.dock_right()
        panel.set_width(self._panel)

    def _add_panes(self) -> viser.GuiHtmlHandle | None:
        if self.sim.panes is None:
            return None
        # viser's bottom sheet puts other panels out of sight, and a low page has no room for a second one
        if self.look.phone or (self.look.narrow and self.look.low):
            with self.client.gui.add_folder("Pictures"):
                return self.client.gui.add_html("")
        panel = self.client.gui.add_panel()
        with panel.add_tab("Pictures"):
            html = self.client.gui.add_html("")
        if self.look.narrow:
            panel.dock_above(self.client.gui.main_panel)
        else:
            panel.dock_left()
            panel.set_width(LAYOUT.pictures)
        return html

    def _add_controls(self, offers: Offers[Any]) -> None:
        gui = self.client.gui
        groups: dict[str, list[str]] = {}
        for name, kind in offers.params.kinds.items():
            if not kind.hidden:
                groups.setdefault(kind.group, []).append(name)
        for group, names in groups.items():
            with gui.add_folder(group or "Parameters", expand_by_default=not group):
                for name in names:
                    if self.sim.files is not None and name == self.sim.files.previewed:
                        self._preview = gui.add_html("")
                    self._controls += controls(
                        gui, offers, name, disabled=self.look.watching, listen=self._listen, change=self._host.change
                    )
                if self.sim.files is not None and group == self.sim.files.group:
                    gui.add_html(upload(self.sim.files.endings, disabled=self.look.watching))
                if not group:
                    self._places = [self._typed(typed) for typed in self.sim.typed]
        with gui.add_folder("Actions"):
            for action in self.sim.actions:
                if not action.group:
                    self._button(action.label, action.hint, action.name)
            for group in dict.fromkeys(action.group for action in self.sim.actions if action.group):
                with gui.add_folder(group, expand_by_default=False):
                    for action in (action for action in self.sim.actions if action.group == group):
                        self._button(action.label, action.hint, action.name)
            self._button("Reset", "Back to the state of the link that you opened", "reset", color="gray")
            gui.add_html(toolbar(self.sim.downloads))

    def _add_readouts(self) -> viser.GuiHtmlHandle:
        with self.client.gui.add_folder("Read-outs"):
            return self.client.gui.add_html("")

    def _button(self, label: str, hint: str, name: str, color: Any = None) -> None:
        button = self.client.gui.add_button(label, hint=hint, color=color, disabled=self.look.watching)
        self._listen(button, lambda _: self._host.act(name))

    def _listen(self, handle: Any, take: Callable[[Any], None]) -> None:
        self._inputs[control_id(handle)] = Input(handle, take)

    def _typed(self, typed: Typed[Any, Any]) -> TypedPlace:
        handle = self.client.gui.add_vector3(
            f"{typed.title} ({typed.unit})", (0.0, 0.0, 0.0), min=typed.low, max=typed.high, step=typed.step,
            hint=typed.description, disabled=self.look.watching,
        )  # fmt: skip

        self._listen(handle, lambda v: self._host.drag(typed.handle, v))
        return TypedPlace(typed, handle)

    def _picked(self, name: str) -> None:
        if not self.look.watching:
            self._host.select(name)

    def _clicked(self, name: str, ray: tuple[float, ...]) -> None:
        if not self.look.watching:
            self._host.click(name, ray)

    def _dragged(self, name: str, place: Place) -> None:
        if not self.look.watching:
            self._host.drag(name, place)


@lru_cache(maxsize=256)
def _marks(regions: tuple[tuple[str, tuple[float, float], tuple[tuple[float, float], ...]], ...]) -> str:
    spans = {
        label: [[(v - low) / (high - low) for v in span] for span in parts] for label, (low, high), parts in regions
    }
    return f'<span hidden data-s3-regions="{escape(json.dumps(spans))}"></span>' if spans else ""


def toolbar(downloads: Iterable[str] = ()) -> str:
    """The buttons that every sim has, and those for what can be had as a file."""
    files = "".join(
        f'<button type="button" data-s3="download" value="{escape(name)}">Download {escape(name)}</button>'
        for name in downloads
    )
    return (
        '<div class="s3-toolbar">'
        '<button type="button" data-s3="share">Share link</button>'
        '<button type="button" data-s3="picture">Save picture</button>'
        '<button type="button" data-s3="keys" aria-keyshortcuts="?">Keys <kbd>?</kbd></button>'
        f"{files}</div>"
    )


def upload(endings: Sequence[str], *, disabled: bool) -> str:
    """Where a file is chosen to be uploaded; the page sends it and says how far it is."""
    off = " disabled" if disabled else ""
    return (
        '<div class="s3-upload"><label>Bring a file<input type="file" aria-label="Bring a file" data-s3-file'
        f' accept="{",".join(endings)}"{off}>'
        '</label><progress max="1" hidden aria-label="Upload"></progress>'
        '<button type="button" hidden data-s3="give-up">Cancel</button>'
        f'<p data-s3-file-status role="status">{", ".join(e[1:].upper() for e in endings)}; it stays on this server'
        " while the sim is open.</p></div>"
    )
