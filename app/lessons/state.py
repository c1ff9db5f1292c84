"""What a lesson says of a sim's state: the values that its text shows, asks for and checks."""

from __future__ import annotations

import logging
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from html import escape, unescape
from typing import Any, NamedTuple
from urllib.parse import parse_qsl

from app.routes import links
from geometry import GeometryError
from sims.kit.column import Column
from sims.kit.controls import letters, unit_of
from sims.kit.fields import Vector
from sims.kit.fields.numbers import Several
from sims.kit.params import Params
from sims.kit.progress import Superseded, goes_on
from sims.kit.readout import figure, quantity
from sims.kit.refusals import BadParams
from sims.kit.sim import Library, Sim, jsonable
from sims.kit.spelling import shown_number

AnySim = Sim[Any, Any]
NOTHING = "–"
LONGEST = 16
"""Entries of a row of numbers that a text can show."""
log = logging.getLogger("sim3")


class Held(NamedTuple):
    """A number that can be dragged in the text."""

    value: float
    bounds: tuple[float, float]
    label: str
    step: float
    unit: str


@dataclass(frozen=True)
class State:
    """A sim in a state, as a query names it, and what follows from it."""

    sim: AnySim
    query: str
    params: Params
    view: list[float] | None
    """Viewpoint and look-at, where the query has them."""
    library: tuple[Library, ...] = ()
    """The server's files for the sim, if it takes any."""

    @cached_property
    def solution(self) -> Any:
        """What follows from the parameters."""
        return self.sim.solve(self.params, *self.library)

    @cached_property
    def given(self) -> dict[str, Any]:
        """The parameters as JSON."""
        return self.params.model_dump(mode="json")

    @cached_property
    def found(self) -> Any:
        """The solution as JSON."""
        return jsonable(self.solution)

    @cached_property
    def column(self) -> str:
        """All that stands beside the scene."""
        return Column(self.sim, self.library).html(self.params, self.solution)

    @cached_property
    def linked(self) -> set[str]:
        """Names of all that can be pointed at."""
        return {unescape(name) for names in re.findall(r'data-link="([^"]*)"', self.column) for name in names.split()}

    @property
    def link(self) -> str:
        """The query with the view, for a link to the state."""
        view = "" if self.view is None else "view=" + ",".join(f"{each:g}" for each in self.view)
        return "&".join(filter(None, [self.query, view]))

    @cached_property
    def numbers(self) -> dict[str, Held]:
        """The parameters that are numbers, and those in their lists, as in `angles.0`."""
        p, found = self.params, dict[str, Held]()
        for name, kind in p.numeric.items():
            alone = not isinstance(kind, Several)
            for k, (value, bounds) in enumerate(zip(kind.entries(getattr(p, name)), p.ranges(name), strict=False)):
                label = p.label(name) if alone else _entry_label(p, name, k)
                found[name if alone else f"{name}.{k}"] = Held(value, bounds, label, kind.step, kind.unit)
        return found

    def value(self, path: str) -> Any:
        """The value at a path such as pitch, R.0.2 or solution.selected. Raises LookupError in words."""
        first, *rest = path.split(".")
        if first == "solution" and rest:
            first, *rest = rest
            at: Any = self.found
        else:
            at = self.given if first in self.given else self.found
        if first not in at:
            raise LookupError("a parameter or a field of the solution: " + ", ".join([*self.given, *self.found]))
        at = at[first]
        for step in rest:
            at = _within(at, step)
        _can_be_shown(at)
        return at


def _entry_label(p: Params, name: str, k: int) -> str:
    kind = p.kinds[name]
    return f"{p.label(name)} {letters(kind)[k]}" if isinstance(kind, Vector) else p.entry_label(name, k)


def _within(at: Any, step: str) -> Any:
    if isinstance(at, Mapping) and step in at:
        return at[step]
    if isinstance(at, Sequence) and not isinstance(at, str) and step.isdecimal() and int(step) < len(at):
        return at[int(step)]
    if isinstance(at, Mapping):
        raise LookupError("one of " + ", ".join(at))
    if isinstance(at, Sequence) and not isinstance(at, str):
        raise LookupError(f"0 to {len(at) - 1}")
    raise LookupError("nothing after the value")


def _can_be_shown(value: Any) -> None:
    """Raises LookupError for what is more than a number, a word or a short row of numbers."""
    if isinstance(value, Mapping):
        raise LookupError("one of its parts: " + ", ".join(value))
    row = isinstance(value, Sequence) and not isinstance(value, str)
    if row and (len(value) > LONGEST or not all(isinstance(each, int | float) for each in value)):
        raise LookupError(f"one of its {len(value)} entries, as in .0")


def read(sim: AnySim, query: str, library: tuple[Library, ...] = ()) -> State:
    """The state that a query names, solved. Raises LookupError in words."""
    return solved(named(sim, query, library))


def named(sim: AnySim, query: str, library: tuple[Library, ...] = ()) -> State:
    """The same, not solved yet. Raises LookupError in words."""
    try:
        items = parse_qsl(query.removeprefix("?"), keep_blank_values=True, strict_parsing=bool(query.strip("?")))
    except ValueError:
        raise LookupError("a link's query, as in ?pitch=90&yaw=30") from None
    try:
        params = links.read(sim, items)
    except BadParams as error:
        name, _, allowed = error.complaints[0][:3]
        raise LookupError(f"for {name}: {allowed}") from None
    return State(sim, params.query(), params, _view(dict(items)), library)


def solved(state: State) -> State:
    """The state itself: what has no solution isn't one of a lesson.

    Raises LookupError in words; `Superseded` where a server ends that reads ahead.
    """
    goes_on()
    try:
        state.solution  # noqa: B018 it is kept
    except Superseded:
        raise
    except GeometryError as error:
        raise LookupError(f"for {error.argument}: {error.allowed}") from None
    except Exception as error:
        log.exception("%s can't solve %r", state.sim.slug, state.query[:200])
        raise LookupError(f"a state that the sim can solve ({type(error).__name__})") from None
    return state


def setting(state: State) -> dict[str, Any]:
    """What a page asks a sim for to have it in a state."""
    return {"query": state.query, "params": state.given, **({} if state.view is None else {"view": state.view})}


def _view(given: Mapping[str, str]) -> list[float] | None:
    return [float(each) for each in given["view"].split(",")] if "view" in given else None


@dataclass(frozen=True)
class Shown:
    """How a value is shown in the text: with digits, or as its box has it; and its unit where it is a parameter."""

    path: str
    digits: int | None
    unit: str
    boxed: bool = False

    def text(self, value: Any) -> str:
        """For people."""
        if value is None:
            return NOTHING
        if isinstance(value, bool):
            return "yes" if value else "no"
        if isinstance(value, (int, float)) and self.boxed:
            return shown_number(value) + quantity(0, self.unit, 0)[1:]
        if isinstance(value, (int, float)):
            return quantity(value, self.unit, self._digits(value))
        if isinstance(value, Sequence) and not isinstance(value, str):
            return f"({', '.join(figure(each, self._digits(each)) for each in value)})"
        return str(value)

    def _digits(self, value: Any) -> int:
        return (0 if isinstance(value, int) else 3) if self.digits is None else self.digits

    def html(self, value: Any, tag: str = "span", *, live: bool = True) -> str:
        """An element, which is kept up to date if it is `live`."""
        if not live:
            return f"<{tag}>{escape(self.text(value))}</{tag}>"
        digits = "data-boxed" if self.boxed else f'data-digits="{self._digits(value)}"'
        unit = f' data-unit="{escape(self.unit)}"' if self.unit else ""
        return f'<{tag} data-value="{escape(self.path)}" {digits}{unit}>{escape(self.text(value))}</{tag}>'


def shown(sim: AnySim, what: str) -> Shown:
    """What {value:…} means: a path, and with another colon how many digits. Raises LookupError in words."""
    path, _, digits = what.partition(":")
    if digits and not (digits.isdecimal() and int(digits) <= 9):
        raise LookupError("after the path a colon and 0 to 9 digits")
    kind = sim.params.kinds.get(path)
    unit = "" if kind is None else unit_of(kind)
    return Shown(path, int(digits) if digits else None, unit, boxed=kind is not None and not digits)
