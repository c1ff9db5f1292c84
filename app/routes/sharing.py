"""A state to hand on: its link, the link as a QR code, and what teachers paste into their own pages."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from fastapi import APIRouter, HTTPException, Request
from fastapi.responses import Response

from app.routes import links, rendering
from app.routes import qr as codes
from app.routes.own import place_of
from app.routes.pages import page
from app.routes.rendering import AnySim, sim_or_404
from app.routes.services import Given, Services
from app.routes.snippets import HEIGHT, snippets
from app.security import ANYWHERE
from sims.kit.refusals import BadParams, Complaint
from sims.kit.sim import Library
from sims.kit.spelling import clipped

router = APIRouter(include_in_schema=False)
FORM = OPENS, SEEN, FRAME = "share-opens", "share-seen", "share-height"
"""What the form asks besides what a link holds: what opens, the view that can be included, a frame's height."""
LOWEST, HIGHEST = 200, 2000
"""Pixels that a frame may be high."""
LONGEST = 1000
"""Characters of a link in whose code a phone finds the squares from the back row."""


@page("/sims/{slug}/share", router)
async def of_sim(request: Request, given: Given, slug: str) -> Response:
    sim = sim_or_404(slug)
    return _share(request, given, sim, f"sims/{slug}", steps=slug in given.lessons.outlines)


@page("/lessons/{name}/share", router)
async def of_own(request: Request, given: Given, name: str) -> Response:
    if name not in given.lessons.own:
        raise HTTPException(404, f"There is no lesson named {name[:60]!r}.")
    lesson = given.lessons.own[name]
    return _share(request, given, lesson.sim, f"lessons/{name}", steps=bool(lesson.steps))


def _share(request: Request, given: Services, sim: AnySim, path: str, *, steps: bool) -> Response:
    """The page, which is the dialog's content too. Without JavaScript its form leads to the next one."""
    asked = request.query_params
    items = linked(asked.multi_items())
    links.read(sim, items)
    height, (state, options), query = _height(asked.get(FRAME, "")), links.parts(items), links.own(items)
    search = f"?{query}" if query else ""
    embed = f"sims/{sim.slug}/embed{search}"
    link = f"{request.base_url}{path}{search}" if asked.get(OPENS) == "lesson" else f"{request.base_url}{embed}"
    response = rendering.render(
        request, "share.html", sim=sim, steps=steps, path=path, state=state, options=dict(options),
        opens=asked.get(OPENS), seen=asked.get(SEEN) or dict(options).get("view", ""), height=height,
        bounds=(LOWEST, HIGHEST), controls=_controls(sim, given.sessions.given(sim)), link=link,
        short=len(link) <= LONGEST, embed=embed, snippets=snippets(f"{request.base_url}{embed}", sim.title, height),
    )  # fmt: skip
    response.headers.update(ANYWHERE)
    return response


def linked(items: Iterable[tuple[str, str]]) -> list[tuple[str, str]]:
    """What the form says, as a link says it: nothing for what is as usual, one list of the controls that are ticked."""
    asked = [item for item in items if item[0] not in FORM]
    some = dict(asked).get("controls", "some") == "some"
    only = ",".join(text for name, text in asked if name == "only") if some else ""
    usual = {("controls", "1"), ("controls", "some"), ("theme", ""), ("challenge", ""), ("lesson", "0")}
    rest = [item for item in asked if item[0] != "only" and item not in usual]
    return [*rest, ("only", only)] if only else rest


def _height(text: str) -> int:
    if not text:
        return HEIGHT
    if text.isdecimal() and LOWEST <= int(text) <= HIGHEST:
        return int(text)
    raise BadParams([Complaint(FRAME, clipped(text), f"{LOWEST} to {HIGHEST} pixels")], {})


def _controls(sim: AnySim, library: tuple[Library, ...]) -> list[tuple[str, str]]:
    """What `only` may name, each with the words that stand beside it."""
    offers = sim.offers(sim.params(), None, *library)
    words: dict[str, Any] = {name: offers.label(name) for name in sim.params.visible}
    words |= {dial.handle: dial.title for dial in sim.dials}
    words |= {action.name: action.label for action in sim.actions}
    return [(name, words[name]) for name in links.controls(sim) if name in words]


@router.api_route("/qr", methods=["GET", "HEAD"])
async def qr(request: Request, url: str = "") -> Response:
    """The code of a link of this server."""
    if place_of(request, url) is None:
        raise HTTPException(404, "There are codes for links of this server only.")
    if len(url) > LONGEST:
        raise HTTPException(404, f"A link in a code may have {LONGEST} characters; this one has {len(url)}.")
    return Response(codes.svg(url), media_type="image/svg+xml", headers={"cache-control": "public, max-age=86400"})
