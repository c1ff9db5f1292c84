"""The pages of a class: where a teacher opens it, the teacher's own, and that of its learners."""

from __future__ import annotations

import re
from typing import Any
from urllib.parse import parse_qsl

from fastapi import APIRouter, HTTPException, Request, WebSocket
from fastapi.responses import RedirectResponse, Response

from app.classes.codes import is_code, is_key
from app.classes.subject import Subject
from app.lessons.shelf import Shelf
from app.proxies import address_of
from app.rooms.keys import new_key
from app.routes import links, qr, rendering
from app.routes.pages import page
from app.routes.rendering import AnySim
from app.routes.services import Given, Services
from app.security import NEVER_KEPT
from sims import by_slug
from sims.kit.refusals import BadParams, Complaint
from sims.kit.spelling import clipped

PAGE = re.compile(r"sims/(?P<slug>[a-z-]+)(?P<alone>/embed)?|lessons/(?P<name>[a-z0-9-]+)")
"""What a class may be about, as addresses below the path prefix: a sim alone, its lesson, or a lesson of the school."""
router = APIRouter(include_in_schema=False)


def subject_of(shelf: Shelf, address: str, query: str) -> Subject:
    """What a class is about. Raises ValueError, BadParams where the query is wrong."""
    sim = sim_of(shelf, address)
    if sim is None:
        raise ValueError(f"there is no page {clipped(address)!r}")
    items = parse_qsl(query, keep_blank_values=True)
    links.read(sim, items)
    return Subject(sim, address, links.own(items), dict(items).get("challenge", ""))


def sim_of(shelf: Shelf, address: str) -> AnySim | None:
    """The sim of a sim's or a lesson's address, if there is one."""
    found = PAGE.fullmatch(address)
    if found is None:
        return None
    if found["name"] is not None:
        lesson = shelf.own.get(found["name"])
        return None if lesson is None else lesson.sim
    sim = by_slug(found["slug"])
    return None if sim is None or (not found["alone"] and sim.slug not in shelf.outlines) else sim


@page("/class", router)
async def choose(request: Request, given: Given) -> Response:
    """What the class is to be about; `?sim=…` and a state begin with that, `?code=…` joins one."""
    query = dict(request.query_params)
    if (code := query.pop("code", "").strip().lower()) and is_code(code):
        return RedirectResponse(f"{rendering.base(request)}/class/{code}")
    slug, challenge = query.pop("sim", ""), query.pop("challenge", "")
    address = f"sims/{slug}/embed" if by_slug(slug) else ""
    wrong = "No class has such a code: it has six letters and digits." if code else ""
    return _form(request, given, address, challenge, links.spelled(query), wrong)


def _form(
    request: Request, given: Services, address: str, challenge: str, state: str, wrong: str = "", status: int = 200
) -> Response:
    return rendering.render(
        request, "class_open.html", status=status, outlines=given.lessons.outlines, own=given.lessons.own,
        address=address, challenge=challenge, state=state, wrong=wrong,
    )  # fmt: skip


@router.post("/class")
async def begin(request: Request, given: Given) -> Response:
    """Leads to the page of a new class. Nothing is kept here: that page's websocket opens it, wherever it leads."""
    said = dict(parse_qsl((await request.body()).decode(errors="replace"), keep_blank_values=True))
    address, challenge, state = (said.get(name, "") for name in ("page", "challenge", "state"))
    query = dict(parse_qsl(state, keep_blank_values=True))
    if said.get("begun", "") not in ("", address.removesuffix("/embed")):
        query = {}  # the state of another sim
    if challenge:
        query["challenge"] = challenge
    try:
        subject = subject_of(given.lessons, address, links.spelled(query))
        key = new_key()
        code = await given.classes.code_of(key, address_of(request))
    except BadParams as error:
        words = "; ".join(map(_words, error.complaints))
        return _form(request, given, address, challenge, state, words, 422)
    except ValueError:
        return _form(request, given, "", "", "", "Choose a lesson or a sim.", 422)
    address = links.spelled({"page": subject.page, **dict(parse_qsl(subject.query, keep_blank_values=True))})
    return RedirectResponse(f"{rendering.base(request)}/class/{code}/{key}/?{address}", 303, NEVER_KEPT)


def _words(wrong: Complaint) -> str:
    name, received, allowed = wrong
    return f"{name}: received {received or 'nothing'}, allowed is {allowed}"


@page("/class/{code}/{key}/", router)
async def teach(request: Request, given: Given, code: str, key: str) -> Response:
    """The teacher's page; whether its key fits its code is found out when it opens the class."""
    query = dict(request.query_params)
    address = query.pop("page", "")
    try:
        subject = subject_of(given.lessons, address, links.spelled(query))
    except ValueError:
        subject = None
    if subject is None or not is_code(code) or not is_key(key):
        raise HTTPException(404, "There is no such class.")
    link = f"{request.base_url}class/{code}"
    data = {
        **_data(request, code), "socket": f"{rendering.base(request)}/class/{code}/{key}/socket",
        "page": subject.page, "query": subject.query, "address": subject.address, "link": link,
    }  # fmt: skip
    return _page(
        request, "class_teacher.html", data, title=_title(given, subject), challenge=_goal(subject), code=code,
        link=link, qr=qr.inline(link),
    )  # fmt: skip


def _title(given: Services, subject: Subject) -> str:
    if subject.page.endswith("/embed"):
        return subject.sim.title
    name = subject.page.removeprefix("lessons/")
    lesson = given.lessons.own.get(name) or given.lessons.outlines.get(subject.sim.slug)
    return subject.sim.title if lesson is None else lesson.title


def _goal(subject: Subject) -> Any:
    return next((each for each in subject.sim.challenges if each.id == subject.challenge), None)


@page("/class/{code}", router)
async def learn(request: Request, code: str) -> Response:
    """A learner's page, of whatever the class is about: its websocket says that."""
    if code != (small := code.lower()) and is_code(small):
        return RedirectResponse(f"{rendering.base(request)}/class/{small}")
    if not is_code(code):
        raise HTTPException(404, "No class has such a code: it has six letters and digits.")
    data = {**_data(request, code), "socket": f"{rendering.base(request)}/class/{code}/socket"}
    return _page(request, "class_learner.html", data, code=code)


def _data(request: Request, code: str) -> dict[str, str]:
    return {"code": code, "base": rendering.base(request), "place": f"{rendering.base(request)}/class/{code}"}


def _page(request: Request, template: str, data: dict[str, Any], **context: Any) -> Response:
    response = rendering.render(request, template, data=data, bare=True, **context)
    response.headers.update(NEVER_KEPT)
    return response


@router.websocket("/class/{code}/socket")
async def learner(ws: WebSocket, given: Given, code: str) -> None:
    if is_code(code):
        await given.class_sockets.learn(ws, code)
    else:
        await ws.close(1008)


@router.websocket("/class/{code}/{key}/socket")
async def teacher(ws: WebSocket, given: Given, code: str, key: str) -> None:
    if is_code(code) and is_key(key):
        await given.class_sockets.teach(ws, code, key)
    else:
        await ws.close(1008)
