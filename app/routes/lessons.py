"""The course: launcher, lessons, and where each concept is learnt."""

from __future__ import annotations

import asyncio

from fastapi import APIRouter, HTTPException, Request
from fastapi.responses import RedirectResponse, Response

from app.lessons.concepts import CONCEPTS, MEANINGS
from app.lessons.lesson import Lesson
from app.routes import code, links, qr, rendering
from app.routes.card import card
from app.routes.pages import page
from app.routes.rendering import AnySim, sim_or_404
from app.routes.services import Given

router = APIRouter(include_in_schema=False)


@page("/", router)
async def launcher(request: Request, given: Given) -> Response:
    return rendering.render(request, "launcher.html", shelf=given.lessons, concepts=CONCEPTS)


@page("/sims/{slug}", router)
async def of_sim(request: Request, given: Given, slug: str) -> Response:
    sim = sim_or_404(slug)
    lesson = await asyncio.to_thread(given.lessons.begun, sim)
    given.sessions.work_ahead("lessons", given.lessons.loading())  # who reads one will read others
    return _lesson(request, sim, lesson, f"sims/{slug}")


@page("/lessons/{name}", router)
async def own(request: Request, given: Given, name: str) -> Response:
    if name not in given.lessons.own:
        raise HTTPException(404, f"There is no lesson named {name[:60]!r}.")
    lesson = given.lessons.own[name]
    return _lesson(request, lesson.sim, lesson, f"lessons/{name}")


def _lesson(request: Request, sim: AnySim, lesson: Lesson | None, path: str) -> Response:
    """The page of a lesson; the sim beside it begins as the link says, else as the first step does."""
    items = request.query_params.multi_items()
    params, query = links.read(sim, items), links.own(items)
    first = query
    if not query and lesson is not None:
        params, first = lesson.begins.params, lesson.begins.link
    address = str(request.url.replace(query=""))
    return rendering.in_parts(
        request, "sim.html", sim=sim, lesson=lesson, query=query, first=first, scripts=code.shown(sim, params),
        address=address, path=path, card=card(request, sim, lesson, path),
        code_of_address=qr.inline(address),
    )  # fmt: skip


@page("/concepts", router)
async def concepts(request: Request, given: Given) -> Response:
    return rendering.render(request, "concepts.html", concepts=CONCEPTS, meanings=MEANINGS, shelf=given.lessons)


@page("/concepts/{slug}", router)
async def concept(request: Request, given: Given, slug: str) -> Response:
    place = given.lessons.concepts.get(slug)
    if place is None:
        raise HTTPException(404, f"There is no concept named {slug[:60]!r}.")
    return RedirectResponse(f"{rendering.base(request)}/sims/{place}#concept-{slug}")
