"""The pages: those of rooms, what they load, and what is no lesson."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from fastapi import APIRouter, HTTPException, Request
from fastapi.responses import HTMLResponse, RedirectResponse, Response
from fastapi.staticfiles import StaticFiles

from app import security
from app.proxies import address_of
from app.rooms.keys import is_room, new_key, room_of
from app.rooms.registry import Sessions
from app.rooms.session import Session
from app.routes import links, rendering
from app.routes.docs import described
from app.routes.rendering import sim_or_404
from app.routes.services import Given, Services
from geometry import GeometryError
from sims.kit import viser_client
from sims.kit.column import Column
from sims.kit.params import Params
from sims.kit.refusals import BadParams, Complaint
from sims.kit.sim import Sim
from sims.kit.spelling import clipped

AnySim = Sim[Any, Any]
FOR_EVER = {**security.ANYWHERE, "cache-control": "public, max-age=31536000, immutable"}
"""For what never changes under its address."""
router = APIRouter(include_in_schema=False)


class Static(StaticFiles):
    """Our own files, whose addresses carry their fingerprints."""

    def file_response(self, *args: Any, **kwargs: Any) -> Response:
        response = super().file_response(*args, **kwargs)
        response.headers.update(FOR_EVER)
        return response


def page(path: str, on: APIRouter = router) -> Callable[[Any], Any]:
    """Registers who makes a page; HEAD is answered as GET is, but for the body."""
    return on.api_route(path, methods=["GET", "HEAD"], response_class=HTMLResponse)


@page("/sims")
@page("/sims/")
async def sims(request: Request) -> Response:
    return RedirectResponse(f"{rendering.base(request)}/")


@page("/docs")
async def docs(request: Request) -> Response:
    return rendering.render(request, "docs.html", described=described())


@page("/sims/{slug}/embed")
async def embed(request: Request, given: Given, slug: str) -> Response:
    sim = sim_or_404(slug)
    key = new_key()
    return await _joined(request, given, sim, room_of(key), key)


@page("/sims/{slug}/s/{room}/{key}/")
async def controlled(request: Request, given: Given, slug: str, room: str, key: str) -> Response:
    sim = sim_or_404(slug)
    if room_of(key) != room:
        raise HTTPException(404, "This link's key doesn't fit its room.")
    return await _joined(request, given, sim, room, key)


async def _joined(request: Request, given: Services, sim: AnySim, room: str, key: str) -> Response:
    """The page of a room, with control of it."""
    query = request.query_params.multi_items()
    params = links.read(sim, query)
    session = None
    if request.method != "HEAD":  # nobody is there to use a session
        try:
            session = _opened(
                given.sessions, sim, room, params, address_of(request), changes=bool(links.parts(query).params)
            )
            params = session.params
        except GeometryError as error:  # of what no parameter's bounds exclude
            raise refusal_of(params, error) from None
    return await _page(request, given, sim, params, session, room, key)


def refusal_of(params: Params, error: GeometryError) -> BadParams:
    """What is wrong with a state that no parameter's bounds exclude, and that has no solution all the same."""
    wrong = Complaint(error.argument, clipped(error.received), error.allowed)
    return BadParams([wrong], {name: text for name, text in params.query_items().items() if name != error.argument})


async def _page(
    request: Request, given: Services, sim: AnySim, params: Params, session: Session | None, room: str, key: str = ""
) -> Response:
    """The page of a room whose session, if it runs, says what its column begins with."""
    options = dict(links.parts(request.query_params.multi_items()).options)
    only = options["only"].split(",") if "only" in options else None
    solution = session.solution if session is not None and session.drawing.solved == params else None
    column = Column(sim, given.sessions.given(sim)).html(params, solution, only)
    view = sim.home(params, solution)
    lesson = await given.lessons.soon(sim) if options.get("lesson") == "1" else None
    steps = [] if lesson is None else lesson.data()
    return rendering.viewer(request, sim, column, view, options, given.largest, steps, room, key)


def _opened(sessions: Sessions, sim: AnySim, room: str, params: Params, address: str, *, changes: bool) -> Session:
    known = sessions.find(sim, room)
    session = sessions.open(sim, room, params, address=address)
    if known and changes:
        session.change(params.model_dump(), live=False)
    return session


@page("/sims/{slug}/s/{room}/")
async def watched(request: Request, given: Given, slug: str, room: str) -> Response:
    if not is_room(room):
        raise HTTPException(404, "There is no such room.")
    sim = sim_or_404(slug)
    known = given.sessions.find(sim, room)
    links.read(sim, request.query_params.multi_items())
    return await _page(request, given, sim, known.params if known else sim.params(), known, room)


@page("/viser/{fingerprint}/{name}")
async def client(request: Request, fingerprint: str, name: str) -> Response:
    return _file(request, viser_client.files(), name, known=fingerprint == viser_client.fingerprint())


@page("/viewer/{fingerprint}/{name}")
async def script(request: Request, fingerprint: str, name: str) -> Response:
    return _module(request, "viewer", fingerprint, name)


@page("/lesson/{fingerprint}/{name}")
async def lesson_script(request: Request, fingerprint: str, name: str) -> Response:
    return _module(request, "lesson", fingerprint, name)


@page("/classroom/{fingerprint}/{name}")
async def class_script(request: Request, fingerprint: str, name: str) -> Response:
    return _module(request, "classroom", fingerprint, name)


def _module(request: Request, folder: str, fingerprint: str, name: str) -> Response:
    known = fingerprint == rendering.modules_fingerprint(folder)
    return _file(request, rendering.modules(folder), name, known=known)


def _file(request: Request, files: Mapping[str, bytes], name: str, *, known: bool) -> Response:
    """A file that never changes under its address."""
    if not known or name not in files:
        raise HTTPException(404, "There is no such file.")
    data, headers = files[name], {**FOR_EVER, "vary": "accept-encoding"}
    accepted = request.headers.get("accept-encoding", "")
    if coding := next((each for each in rendering.COMPRESSIONS if _takes(accepted, each)), None):
        data, headers["content-encoding"] = rendering.compressed(data, coding), coding
    kind = "text/css" if name.endswith(".css") else "text/javascript"
    return Response(data, media_type=kind, headers=headers)


def _takes(accepted: str, coding: str) -> bool:
    """Whether a header names a coding, with another weight than zero."""
    given = (each.partition(";q=") for each in accepted.replace(" ", "").split(","))
    return any(name == coding and (not weight or bool(weight.strip("0."))) for name, _, weight in given)


# Without the host, as Starlette's own redirects of this kind have it: a proxy in front may have another.
@page("/sims/{slug}/s/{room}/{key}")
@page("/sims/{slug}/s/{room}")
async def with_slash(request: Request) -> Response:
    return _redirect(request, request.scope["path"] + "/")


@page("/sims/{slug}/")
@page("/sims/{slug}/embed/")
@page("/docs/")
@page("/class/")
async def without_slash(request: Request) -> Response:
    return _redirect(request, request.scope["path"].rstrip("/"))


def _redirect(request: Request, path: str) -> Response:
    return RedirectResponse(f"{path}?{request.url.query}" if request.url.query else path)
