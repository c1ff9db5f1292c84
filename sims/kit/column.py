"""What a sim's page shows beside the scene: words, numbers, pictures and controls, as HTML in parts.

The page begins with all of it (`Column.html`). Then it is told of the parts that differ from what they were, and of
what each input shows (`Column.of`).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from html import escape
from typing import Any, NamedTuple

from sims.kit import controls, pane, readout
from sims.kit.offers import Offers
from sims.kit.params import Params
from sims.kit.paste import Paste
from sims.kit.sim import Action, Library, Sim, Typed
from sims.kit.types import Place

PANES = "panes"
Parts = dict[str, str]


class Shown(NamedTuple):
    """The HTML of each part, and what each input shows, by their names."""

    parts: Parts
    values: dict[str, controls.Shown]


class Column:
    """Makes the parts of a sim's states, on a server with a library of files where the sim has some."""

    def __init__(self, sim: Sim[Any, Any], library: tuple[Library, ...] = ()) -> None:
        self.sim = sim
        self._library = library
        self._form: Any = None
        self._controls: Parts = {}

    def of(self, params: Params, solution: Any) -> Shown:
        """What a state shows. Without a solution yet: the controls alone."""
        offers = self.sim.offers(params, solution, *self._library)
        parts, values = dict(self._controls_of(offers)), controls.values(offers)
        if solution is not None:
            places = {typed.handle: typed.place(params, solution) for typed in self.sim.typed}
            parts |= self._rest(params, solution, places)
            for handle, place in places.items():
                values |= {f"{handle}.{k}": value for k, value in enumerate(_clean(place))}
        return Shown(parts, values)

    def html(self, params: Params, solution: Any, only: Collection[str] | None = None) -> str:
        """The whole column; `only`: of the controls, those of these parameters and actions."""
        offers = self.sim.offers(params, solution, *self._library)
        parts = {f"control:{name}": controls.html(offers, name) for name in params.visible}
        if solution is not None:
            places = {typed.handle: typed.place(params, solution) for typed in self.sim.typed}
            parts |= self._rest(params, solution, places)
        return "".join(self._page(parts, only))

    def _controls_of(self, offers: Offers[Any]) -> Parts:
        """The controls without what they show, made anew where what they offer may have changed."""
        form = offers.form()
        if form != self._form:
            self._form = form
            names = offers.params.visible
            self._controls = {f"control:{name}": controls.html(offers, name, filled=False) for name in names}
        return self._controls

    def _rest(self, params: Params, solution: Any, places: Mapping[str, Place | None]) -> Parts:
        """What follows from the solution; `places` are those of the nodes that can be typed."""
        sim = self.sim
        found = {"caption": escape(sim.caption(params, solution))}
        read = readout.folded(sim.readouts(params, solution))
        for title in ("", *sim.folds):
            found[f"read:{title}"] = readout.render(read.get(title, ()))
        for typed in sim.typed:
            found[f"control:{typed.handle}"] = "" if places[typed.handle] is None else placed(typed)
        if sim.files is not None:
            preview = sim.files.preview(params, *self._library)
            found["preview"] = "" if preview is None else readout.render([preview])
        if sim.panes is not None:
            panes = sim.panes(params, solution)
            found[PANES] = "".join(pane.figure(each) for each in panes)
            found |= {f"pane:{each.name}": pane.content(each) for each in panes}
        return found

    def _page(self, parts: Parts, only: Collection[str] | None) -> Iterator[str]:
        def part(name: str, tag: str = "div", kind: str = "") -> str:
            # the frames of pictures are parts within a part
            inside = re.sub(r'data-part="(pane:[^"]*)">', lambda frame: frame[0] + parts[frame[1]], parts.get(name, ""))
            return f'<{tag} class="{kind}" data-part="{escape(name)}">{inside}</{tag}>'

        def wanted(action: Action) -> bool:
            return not action.group if only is None else action.name in only

        sim = self.sim
        yield part("caption", "p", "s3-caption")
        yield part("read:", kind="s3-key")
        if sim.panes is not None:
            yield part(PANES, kind="s3-panes")
        yield '<fieldset class="s3-controls"><legend class="s3-hidden">Controls</legend>'
        first = (
            self._names("") if only is None else [name for name in dict.fromkeys(only) if name in sim.params.visible]
        )
        yield from (part(f"control:{name}") for name in first)
        yield from (part(f"control:{typed.handle}") for typed in sim.typed if only is None)
        yield self._actions(wanted)
        if only is None:
            yield from (self._fold(title, part) for title in self._titles())
        yield f"</fieldset>{toolbar(sim.downloads)}"

    def _fold(self, title: str, part: Callable[..., str]) -> str:
        files = self.sim.files
        inside = [part(f"read:{title}", kind="s3-read")] if title in self.sim.folds else []
        for name in self._names(title):
            if files is not None and name == files.previewed:
                inside.append(part("preview", kind="s3-read"))
            inside.append(part(f"control:{name}"))
        if files is not None and title == files.group:
            inside.append(upload(files.endings))
        if self.sim.paste is not None and title == self.sim.paste.group:
            inside.append(pasted(self.sim.paste))
        pressed = "".join(button(action) for action in self.sim.actions if action.group == title)
        inside += [f'<div class="s3-actions">{pressed}</div>'] * bool(pressed)
        return f'<details class="s3-fold"><summary>{escape(title)}</summary>{"".join(inside)}</details>'

    def _actions(self, wanted: Callable[[Action], bool]) -> str:
        shown = [action for action in self.sim.actions if wanted(action)]
        inside = "".join(button(action, primary=not k) for k, action in enumerate(shown))
        return (
            f'<div class="s3-actions">{inside}'
            '<button type="button" data-act="reset" title="Back to the state and the view of the link that you opened">'
            'Reset</button><button type="button" data-s3="home" title="Back to the sim’s own view of the scene">'
            "Home view</button></div>"
        )

    def _names(self, group: str) -> list[str]:
        return [name for name in self.sim.params.visible if self.sim.params.kinds[name].group == group]

    def _titles(self) -> list[str]:
        groups = [self.sim.params.kinds[name].group for name in self.sim.params.visible]
        groups += [action.group for action in self.sim.actions]
        groups += [] if self.sim.paste is None else [self.sim.paste.group]
        return [title for title in dict.fromkeys((*self.sim.folds, *groups)) if title]


def _clean(place: Place | None) -> Sequence[float | None]:
    """A place that was worked out, without what rounding left of a zero: no −6e-17 in a box."""
    return (None, None, None) if place is None else [round(v, 12) + 0.0 for v in place]


def button(action: Action, *, primary: bool = False) -> str:
    """What starts an action."""
    kind = ' class="s3-primary"' if primary else ""
    return (
        f'<button type="button"{kind} data-act="{escape(action.name)}" title="{escape(action.hint)}">'
        f"{escape(action.label)}</button>"
    )


def placed(typed: Typed[Any, Any]) -> str:
    """Three boxes for what dragging a node of the scene sets."""
    inside = controls.vector(typed.handle, typed.title, "xyz", (None, None, None), typed.unit, typed.step)
    return controls.control(typed.handle, typed.title, inside, typed.description, kind="s3-line")


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


def pasted(paste: Paste[Any]) -> str:
    """A box for a text of one's own, which the page sends."""
    ask, why = controls.asked("paste", paste.title, paste.about)
    chooser = f'<input type="file" data-s3-text="" accept="{",".join(paste.endings)}"/>'
    file = f'<label class="s3-file">From a file{chooser}</label>' if paste.endings else ""
    return (
        f'<div class="s3-control s3-paste"><div class="s3-label"><label for="paste">{escape(paste.title)}</label>{ask}'
        f'</div>{why}<textarea id="paste" rows="4" spellcheck="false" placeholder="{escape(paste.example)}"></textarea>'
        '<p class="s3-wrong" role="alert" hidden=""></p><div class="s3-actions">'
        f'<button type="button" data-s3="take">Use this</button>{file}<span role="status"></span></div></div>'
    )


def upload(endings: Sequence[str]) -> str:
    """Where a file is chosen to be uploaded; the page sends it and says how far it is."""
    return (
        '<div class="s3-upload"><label>Bring a file<input type="file" data-s3-file=""'
        f' accept="{",".join(endings)}"/>'
        '</label><progress max="1" hidden="" aria-label="Upload"></progress>'
        '<button type="button" hidden="" data-s3="give-up">Cancel</button>'
        f'<p data-s3-file-status="" role="status">{", ".join(e[1:].upper() for e in endings)}; it stays on this server'
        " while the sim is open.</p></div>"
    )
