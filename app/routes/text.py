"""A sim without its scene: numbers, pictures and words of a state, and a form that leads to another one.

Plain HTML that works without JavaScript, websockets and WebGL: for screen readers, for print, and for weak machines.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from fastapi import APIRouter, Request
from fastapi.responses import Response

from app.routes import links, rendering
from app.routes.answers import found_for
from app.routes.pages import page, refusal_of
from app.routes.rendering import sim_or_404
from app.routes.services import Given
from geometry import GeometryError
from sims.kit import pane, readout
from sims.kit.controls import key, unit_of
from sims.kit.fields import Choice, Kind, Numbers, Numeric, OptionalNumber, Switch, Text, Vector
from sims.kit.params import Params
from sims.kit.sim import Library, Sim
from sims.kit.spelling import plain, spell, typed, typed_row

router = APIRouter(include_in_schema=False)


class Field(NamedTuple):
    """A parameter in the form; with options it is chosen, else typed."""

    name: str
    label: str
    about: str
    value: str
    unit: str
    options: dict[str, str] | None


@page("/sims/{slug}/text", router)
async def text(request: Request, given: Given, slug: str) -> Response:
    sim = sim_or_404(slug)
    items = [(name, _spelled(sim, name, value)) for name, value in request.query_params.multi_items() if value.strip()]
    params = links.read(sim, items)
    library = given.sessions.given(sim)
    find = _finding(sim, params, library)
    try:
        shown = await found_for(request, given.answers, find) if sim.heavy else find()
    except GeometryError as error:
        raise refusal_of(params, error) from None
    form = list(_fields(sim, params, library))
    kept = {name: text for name, text in params.query_items().items() if params.kinds[name].hidden}
    return rendering.render(request, "text.html", sim=sim, form=form, kept=kept, query=links.own(items), **shown)


def _finding(sim: Sim[Any, Any], params: Params, library: tuple[Library, ...]) -> Callable[[], dict[str, Any]]:
    def find() -> dict[str, Any]:
        solution = sim.solve(params, *library)
        panes = sim.panes(params, solution) if sim.panes is not None else ()
        return {
            "caption": sim.caption(params, solution), "description": sim.describe(params, solution),
            "readouts": readout.still(sim.readouts(params, solution)),
            "panes": [(each.title, each.note, pane.still(each)) for each in panes],
        }  # fmt: skip

    return find


def _spelled(sim: Sim[Any, Any], name: str, text: str) -> str:
    """What was typed into the form as a link spells it; what can't be a number is left to be refused in words."""
    kind = sim.params.kinds.get(name)
    try:
        if isinstance(kind, Vector | Numbers):
            return ",".join(plain(typed(each, kind.unit)) for each in typed_row(text))
        return plain(typed(text, kind.unit)) if isinstance(kind, Numeric) else text
    except ValueError:
        return text


def _fields(sim: Sim[Any, Any], params: Params, library: tuple[Library, ...]) -> Iterator[Field]:
    offers = sim.offers(params, None, *library)
    for name in params.arranged:
        kind, value = params.kinds[name], getattr(params, name)
        words = offers.label(name), offers.about(name)
        yield Field(name, *words, _shown(value), unit_of(kind), _options(kind, name, offers))


def _shown(value: Any) -> str:
    return "" if value is None else spell(value)


def _options(kind: Kind, name: str, offers: Any) -> dict[str, str] | None:
    if isinstance(kind, Switch):
        return {"1": "On", "0": "Off"}
    if isinstance(kind, Choice | OptionalNumber | Text):
        return {key(value): words for value, words in offers.options(name).items()}
    return None
