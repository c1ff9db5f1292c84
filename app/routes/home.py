"""A sim to be taken home: its present state, or a sweep of one parameter, as one HTML file that needs no server."""

from __future__ import annotations

import functools
import re
from base64 import b64encode
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from fastapi import APIRouter, Request
from fastapi.responses import JSONResponse, Response

from app.routes import links, rendering
from app.routes.answers import Busy, found_for
from app.routes.coming import Refusal
from app.routes.rendering import sim_or_404
from app.routes.services import Given
from app.security import ANYWHERE, NEVER_KEPT
from app.settings import ROOT
from geometry import GeometryError
from sims.kit import pane, viser_client
from sims.kit.palette import DARK
from sims.kit.params import Params
from sims.kit.refusals import BadParams
from sims.kit.scene.view import FIELD
from sims.kit.sim import Sim
from sims.kit.spelling import clipped, number_text
from sims.kit.sweep import Swept, sweepable
from sims.kit.taken import Taken, TooLarge

AnySim = Sim[Any, Any]
FRAMES = 72
"""Frames that a sweep has, unless fewer are asked for."""
HEAVY = "This sim works too long for a sweep: its state can be taken home."
OURS = ("sweep", "from", "to", "frames")
SHEETS = ("tokens.css", "readouts.css", "viewer.css", "viser.css", "home.css")
SCRIPTS = {"viewer": ("frames.js", "page.js", "view.js", "viser_dom.js"), "home": ("film.js",)}
"""What static/home/main.js imports, with what that imports."""
router = APIRouter(include_in_schema=False)


@dataclass(frozen=True)
class Wish:
    """What somebody takes home."""

    params: Params
    options: dict[str, str]
    swept: Swept | None
    values: Sequence[float]

    @property
    def states(self) -> list[Params]:
        """By frames."""
        return [self.params] if self.swept is None else [self.swept.state(self.params, v) for v in self.values]

    @property
    def told(self) -> list[dict[str, str]]:
        """By frames of a sweep: the value for people, and the query of its live state."""
        if self.swept is None:
            return []
        pairs = zip(self.values, self.states, strict=True)
        return [{"words": self.swept.words(value), "query": state.query()} for value, state in pairs]


@router.get("/sims/{slug}/sweeps")
async def sweeps(request: Request, slug: str) -> Response:
    """What can be swept in a state, for the page to offer."""
    sim = sim_or_404(slug)
    numbers = [] if sim.heavy else _sweepable(sim, _wish(sim, request.query_params.multi_items()).params)
    offered = [{"name": n.name, "label": n.label, "low": n.low, "high": n.high, "unit": n.unit} for n in numbers]
    return JSONResponse({"numbers": offered, "why": HEAVY if sim.heavy else ""}, headers=ANYWHERE)


@router.get("/sims/{slug}/home")
async def home(request: Request, given: Given, slug: str) -> Response:
    sim = sim_or_404(slug)
    wish = _wish(sim, request.query_params.multi_items())

    def find() -> bytes:
        taken = Taken(given.host, sim, wish.states, given.sessions.given(sim), dark=wish.options.get("theme") == "dark")
        return _page(request, sim, wish, taken)

    try:
        page = await found_for(request, given.answers, find)
    except GeometryError as error:
        raise Refusal(422, f"Nothing can be shown of it: {error}.") from None
    except TooLarge:
        raise Refusal(413, "That would be too large a file. Take the state alone, or show fewer points.") from None
    except Busy as busy:
        raise Refusal(busy.status, str(busy)) from None
    return Response(page, media_type="text/html", headers=_headers(sim, wish))


def _headers(sim: AnySim, wish: Wish) -> dict[str, str]:
    what = f"-{wish.swept.name}" if wish.swept else ""
    name = f"sim3-{sim.slug}{what}-{_today()}.html"
    return {
        "content-disposition": f'attachment; filename="{name}"', **NEVER_KEPT, **ANYWHERE,
        "access-control-expose-headers": "content-disposition",
    }  # fmt: skip


def _today() -> str:
    return datetime.now(UTC).date().isoformat()


def _wish(sim: AnySim, items: list[tuple[str, str]]) -> Wish:
    """What a query asks for. Raises `Refusal`."""
    try:
        rest = [item for item in items if item[0] not in OURS]
        params, options = links.read(sim, rest), dict(links.parts(rest).options)
    except BadParams as error:
        raise Refusal(422, f"{error}.") from None
    asked = {name: text for name, text in items if name in OURS}
    if not asked:
        return Wish(params, options, None, ())
    if sim.heavy:
        raise Refusal(422, HEAVY)
    known = {each.name: each for each in _sweepable(sim, params)}
    swept = known.get(asked.get("sweep", ""))
    if swept is None:
        raise Refusal(422, f"sweep: got {clipped(asked.get('sweep', ''))!r}, allowed: one of: {', '.join(known)}.")
    begin, end = (
        _bound(swept, name, asked.get(name), usual) for name, usual in (("from", swept.low), ("to", swept.high))
    )
    if begin == end:
        raise Refusal(422, f"from and to are both {clipped(asked['to'])}; a sweep needs two values.")
    return Wish(params, options, swept, swept.values(begin, end, _frames(asked.get("frames", f"{FRAMES}"))))


def _sweepable(sim: AnySim, params: Params) -> Iterator[Swept]:
    """What the controls of a state show, and a sweep can lead."""
    return sweepable(params, sim.offers(params).idle())


def _frames(text: str) -> int:
    if not (text.isdecimal() and len(text) < 4 and 2 <= int(text) <= FRAMES):
        raise Refusal(422, f"frames: got {clipped(text)!r}, allowed: a whole number from 2 to {FRAMES}.")
    return int(text)


def _bound(swept: Swept, name: str, text: str | None, usual: float) -> float:
    try:
        value = usual if text is None else float(number_text(text))
    except ValueError:
        value = swept.high + 1.0
    if not swept.low <= value <= swept.high:
        allowed = f"a number from {swept.low:g} to {swept.high:g}"
        raise Refusal(422, f"{name}: got {clipped(text or '')!r}, allowed: {allowed}.")
    return value


def _page(request: Request, sim: AnySim, wish: Wish, taken: Taken) -> bytes:
    first, parts = wish.states[0], taken.parts[0]
    view = sim.home(first, taken.solution)
    dark = wish.options.get("theme") == "dark"
    data = {
        "slug": sim.slug, "dark": dark, "view": [*view.position, *view.look_at], "radius": view.radius, "field": FIELD,
        "label": {"ink": DARK.ink, "plate": DARK.page}, "socket": "", "viewer": "",
        "live": f"{str(request.base_url).rstrip('/')}/sims/{sim.slug}",
        "options": links.spelled({"view": wish.options["view"]}) if "view" in wish.options else "",
        "sweep": wish.told,
    }  # fmt: skip
    page = rendering.templates.get_template("home.html").render(
        sim=sim, data=data, date=_today(), theme="dark" if dark else "light", swept=wish.swept,
        query=first.query(), parts=parts, panes=_panes(sim, first, taken), styles=_styles(),
        folds=[name.partition(":")[2] for name in taken.recorded if name.startswith("read:") and name != "read:"],
        modules=_modules(), main=_bare(rendering.modules("home")["main.js"].decode()), client=viser_client.held(),
        film=b64encode(taken.packed()).decode(), marker=b64encode(taken.marker()).decode(),
    )  # fmt: skip
    return page.encode()


def _panes(sim: AnySim, params: Params, taken: Taken) -> str:
    """The pictures of the first frame, each in its place."""
    panes = sim.panes(params, taken.solution) if sim.panes is not None else ()
    return "".join(
        pane.figure(each).replace("></figure>", f">{taken.parts[0][f'pane:{each.name}']}</figure>") for each in panes
    )


@functools.cache
def _styles() -> str:
    return "\n".join((ROOT / "static" / name).read_text(encoding="utf-8") for name in SHEETS)


@functools.cache
def _modules() -> dict[str, str]:
    """Scripts by the names that others import them by, as addresses that hold them."""
    return {
        f"sim3/{name}": f"data:text/javascript;base64,{b64encode(_bare(text.decode()).encode()).decode()}"
        for folder, names in SCRIPTS.items()
        for name, text in rendering.modules(folder).items() if name in names
    }  # fmt: skip


def _bare(script: str) -> str:
    """A script that imports others by names: a script in a page, or in an address, has no folder beside it."""
    return re.sub(r'from "(?:\.|\.\./viewer)/', 'from "sim3/', script)
