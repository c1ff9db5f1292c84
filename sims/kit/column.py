"""What a sim's page shows beside the scene: words, numbers, pictures and controls, as HTML in parts.

The page begins with all of it (`Column.html`). Then it is told of the parts that differ from what they were, and of
what each input shows (`Column.of`).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from html import escape
from typing import Any, NamedTuple

from sims.kit import controls, pane, readout
from sims.kit.fields import Opened
from sims.kit.offers import Offers
from sims.kit.params import Params
from sims.kit.paste import Paste
from sims.kit.sim import Action, Dial, Library, Sim, Typed
from sims.kit.types import Place

PANES = "panes"
ARRANGED = "arranged"
"""The part that tells the page in which order the controls stand: their names, which nobody sees."""
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
            places, dials = self._found(params, solution)
            parts |= self._rest(params, solution, places, dials)
            for handle, place in places.items():
                values |= {f"{handle}.{k}": value for k, value in enumerate(_clean(place))}
            values |= dials
        return Shown(parts, values)

    def html(self, params: Params, solution: Any, only: Collection[str] | None = None) -> str:
        """The whole column; `only`: of the controls, those of these parameters and actions."""
        offers = self.sim.offers(params, solution, *self._library)
        parts = self._inputs(offers, filled=True)
        if solution is not None:
            parts |= self._rest(params, solution, *self._found(params, solution))
        return "".join(self._page(parts, params, only))

    def _controls_of(self, offers: Offers[Any]) -> Parts:
        """The controls without what they show, made anew where what they offer may have changed."""
        form = offers.form()
        if form != self._form:
            self._form = form
            arranged = " ".join(self._names("", offers.params))
            self._controls = {**self._inputs(offers, filled=False), ARRANGED: arranged}
        return self._controls

    def _inputs(self, offers: Offers[Any], *, filled: bool) -> Parts:
        """The controls and buttons; what is idle stays in the page, hidden."""
        idle = offers.idle()
        found = {f"control:{name}": controls.html(offers, name, filled=filled) for name in offers.params.visible}
        first = next((a.name for a in self.sim.actions if not a.group and a.name not in idle), "")
        found |= {f"action:{a.name}": button(a, primary=a.name == first) for a in self.sim.actions}
        return {
            name: f'<div hidden="">{html}</div>' if name.partition(":")[2] in idle else html
            for name, html in found.items()
        }

    def _found(self, params: Params, solution: Any) -> tuple[dict[str, Place | None], dict[str, float | None]]:
        """Places of the nodes that can be typed, and what the dials show, by their handles."""
        return (
            {typed.handle: typed.place(params, solution) for typed in self.sim.typed},
            {dial.handle: dial.value(params, solution) for dial in self.sim.dials},
        )

    def _rest(
        self, params: Params, solution: Any, places: Mapping[str, Place | None], dials: Mapping[str, float | None]
    ) -> Parts:
        """What follows from the solution, and from what was `_found` in it."""
        sim = self.sim
        found = {"caption": escape(sim.caption(params, solution))}
        read = readout.folded(sim.readouts(params, solution))
        for title in ("", *sim.folds):
            found[f"read:{title}"] = readout.render(read.get(title, ()))
        for typed in sim.typed:
            found[f"control:{typed.handle}"] = "" if places[typed.handle] is None else placed(typed)
        for dial in sim.dials:
            found[f"control:{dial.handle}"] = "" if dials[dial.handle] is None else dialled(dial)
        if sim.files is not None:
            preview = sim.files.preview(params, *self._library)
            found["preview"] = "" if preview is None else readout.render([preview])
        if sim.panes is not None:
            panes = sim.panes(params, solution)
            found[PANES] = "".join(pane.figure(each) for each in panes)
            found |= {f"pane:{each.name}": pane.content(each) for each in panes}
        return found

    def _page(self, parts: Parts, params: Params, only: Collection[str] | None) -> Iterator[str]:
        def part(name: str, tag: str = "div", kind: str = "") -> str:
            # the frames of pictures are parts within a part
            inside = re.sub(r'data-part="(pane:[^"]*)">', lambda frame: frame[0] + parts[frame[1]], parts.get(name, ""))
            return f'<{tag} class="{kind}" data-part="{escape(name)}">{inside}</{tag}>'

        def wanted(action: Action) -> bool:
            return not action.group if only is None else not {*action.names}.isdisjoint(only)

        sim = self.sim
        yield part("caption", "p", "s3-caption")
        yield part("read:", kind="s3-key")
        if sim.panes is not None:
            yield part(PANES, kind="s3-panes")
        yield '<fieldset class="s3-controls"><legend class="s3-hidden">Controls</legend>'
        yield from (part(f"control:{dial.handle}") for dial in sim.dials if only is None or dial.handle in only)
        wished = self._names("", params) if only is None else dict.fromkeys(only)
        first = [name for name in wished if name in sim.params.visible]
        yield from (part(f"control:{name}") for name in first)
        yield f'<p hidden="" data-part="{ARRANGED}">{" ".join(first)}</p>'
        yield from (part(f"control:{typed.handle}") for typed in sim.typed if only is None)
        yield self._actions([part(f"action:{a.name}", "div", "s3-act") for a in sim.actions if wanted(a)])
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
        pressed = "".join(part(f"action:{a.name}", "div", "s3-act") for a in self.sim.actions if a.group == title)
        inside += [f'<div class="s3-actions">{pressed}</div>'] * bool(pressed)
        opens = self._opens(title)
        return f'<details class="s3-fold"{opens}><summary>{escape(title)}</summary>{"".join(inside)}</details>'

    def _opens(self, title: str) -> str:
        """What a fold's opening and closing choose, where that is part of the state."""
        for name, kind in self.sim.params.kinds.items():
            if isinstance(kind, Opened) and (word := next((w for w, t in kind.folds.items() if t == title), "")):
                return f' data-fold="{escape(name)}" data-open="{escape(word)}" data-closed="{escape(kind.closed)}"'
        return ""

    def _actions(self, shown: Iterable[str]) -> str:
        return (
            f'<div class="s3-actions">{"".join(shown)}'
            '<button type="button" data-act="reset" title="Back to the state and the view of the link that you opened">'
            'Reset</button><button type="button" data-s3="home" title="Back to the sim’s own view of the scene">'
            "Home view</button></div>"
        )

    def _names(self, group: str, params: Params | None = None) -> list[str]:
        names = self.sim.params.visible if params is None else params.arranged
        return [name for name in names if self.sim.params.kinds[name].group == group]

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


@lru_cache(maxsize=16)
def dialled(dial: Dial[Any, Any]) -> str:
    """A slider for a number that follows from the state."""
    inside = controls.slider(dial.handle, dial.title, None, (dial.low, dial.high), dial.step, dial.unit)
    return controls.control(
        dial.handle, dial.title, inside, dial.description, kind="s3-line", target=f"s-{dial.handle}"
    )


def toolbar(downloads: Iterable[str] = ()) -> str:
    """The buttons that every sim has, and those for what can be had as a file; what few people want is folded."""
    files = "".join(
        f'<button type="button" data-s3="download" value="{escape(name)}">Download {escape(name)}</button>'
        for name in downloads
    )
    return (
        '<div class="s3-toolbar">'
        '<button type="button" data-s3="share">Share</button>'
        '<button type="button" data-s3="present">Present</button>'
        '<button type="button" data-s3="more" aria-expanded="false" aria-controls="more">More</button>'
        '<div class="s3-actions" id="more" hidden="">'
        '<button type="button" data-s3="code" title="A Python script with the numbers of now">Copy code</button>'
        '<button type="button" data-s3="picture">Save picture</button>'
        '<button type="button" data-s3="take-home">Take it home</button>'
        '<button type="button" data-s3="keys" aria-keyshortcuts="?">Keys <kbd>?</kbd></button>'
        f"{files}</div></div>"
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
