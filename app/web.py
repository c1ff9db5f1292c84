"""The FastAPI application: every address of the public contract."""

from __future__ import annotations

from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from functools import partial
from typing import Any

from fastapi import FastAPI, Request
from fastapi.responses import JSONResponse, Response
from starlette.exceptions import HTTPException
from starlette.middleware.gzip import GZipMiddleware
from starlette.routing import Route, WebSocketRoute

from app.classes.registry import Classes
from app.lessons.shelf import Shelf
from app.proxies import Forwarded, Prefix
from app.rooms.places import Fairness, Full
from app.rooms.registry import Sessions
from app.routes import (
    about,
    api,
    classes,
    code,
    developers,
    files,
    home,
    lessons,
    links,
    oembed,
    pages,
    rendering,
    sharing,
    sockets,
    text,
    watching,
)
from app.routes.answers import Answers, Busy, Gone, solved
from app.routes.coming import Coming, Refusal
from app.routes.services import Services
from app.security import Headers, SmallBodies
from app.settings import ROOT, Settings
from app.sockets.bridge import Bridge
from app.sockets.classes import ClassSockets
from sims import SIMS, by_slug
from sims.kit.refusals import BadParams
from sims.kit.viser_internals import ViserHost

ROUTERS = (
    pages.router, lessons.router, code.router, text.router, sharing.router, oembed.router, developers.router,
    about.router, api.router, sockets.router, files.router, home.router,
    watching.router, classes.router,
)  # fmt: skip


class Application(FastAPI):
    """What the API takes and answers is described by the sims."""

    def openapi(self) -> dict[str, Any]:
        """The schema, made once."""
        if self.openapi_schema is None:
            api.describe(super().openapi())
        return super().openapi()


def create_app(settings: Settings, host: ViserHost) -> FastAPI:
    """The application, bound to a running viser host."""
    services = _services(settings, host)

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        services.sessions.begin_sweeping()
        yield
        services.lessons.close()
        await services.sessions.close()
        services.classes.close()
        services.answers.close()

    app = Application(
        title="Sim3", summary="Interactive 3D-geometry sims", version="1", lifespan=lifespan,
        docs_url=None, redoc_url=None, redirect_slashes=False, exception_handlers=HANDLERS,
    )  # fmt: skip
    app.state.services = services
    app.add_middleware(GZipMiddleware, minimum_size=2000, compresslevel=6)
    app.add_middleware(SmallBodies, files=files.ADDRESS)
    app.add_middleware(api.OpenApi)
    app.add_middleware(Headers, frame_ancestors=settings.frame_ancestors)
    app.add_middleware(Prefix, prefix=settings.root_path, addresses=["/static", "/openapi.json", *_addresses()])
    app.add_middleware(Forwarded, trusted_hosts=settings.forwarded_allow_ips)
    app.mount("/static", pages.Static(directory=ROOT / "static"), name="static")
    for router in ROUTERS:
        app.include_router(router)
    return app


def _addresses() -> list[str]:
    return [route.path for router in ROUTERS for route in router.routes if isinstance(route, Route | WebSocketRoute)]


def _services(settings: Settings, host: ViserHost) -> Services:
    largest = settings.max_upload * 1_000_000
    libraries = {sim.slug: sim.files.library(settings.cloud_dir, largest) for sim in SIMS if sim.files is not None}
    fairness = Fairness(settings.max_sessions_per_address, settings.max_openings)
    sessions = Sessions(
        settings.max_sessions, libraries, fairness, settings.idle_minutes * 60, settings.max_memory * 1_000_000
    )
    bridge = Bridge(host, sessions, settings.origins)
    sessions.put_away = lambda session: bridge.visits.put_away(session.sim, session.room)
    shelf = Shelf(SIMS, sessions.given, settings.lesson_dir)
    answers, coming = Answers(), Coming(files.AT_ONCE * largest)
    running = Classes(partial(solved, sessions, answers), settings.class_hours, lambda: sessions.draining)
    of_classes = ClassSockets(
        running, bridge.visits, bridge.refusals, bridge.strangers, partial(classes.subject_of, shelf)
    )
    return Services(sessions, bridge, shelf, answers, coming, running, of_classes, largest, host)


async def _bad_params(request: Request, error: Exception) -> Response:
    """A page that names what is wrong with a link, and leads to the sim with the rest."""
    assert isinstance(error, BadParams)
    sim = by_slug(request.path_params.get("slug", ""))
    good = links.spelled(error.good)
    return rendering.render(request, "bad_params.html", status=422, sim=sim, complaints=error.complaints, good=good)


async def _missing(request: Request, error: Exception) -> Response:
    """What isn't there, or not now."""
    assert isinstance(error, HTTPException)
    if api.in_api(request.scope):
        return JSONResponse({"detail": error.detail}, error.status_code, error.headers)
    headers = error.headers or {}
    wait = headers.get("retry-after")
    response = rendering.render(request, "missing.html", status=error.status_code, detail=error.detail, wait=wait)
    response.headers.update(headers)
    return response


async def _full(request: Request, error: Exception) -> Response:
    """What has no place now, and may have one soon."""
    assert isinstance(error, Full)
    request.app.state.services.bridge.refusals["full"] += 1
    return await _missing(request, HTTPException(503, str(error), {"retry-after": str(error.wait)}))


HANDLERS: dict[int | type[Exception], Callable[[Request, Any], Any]] = {
    BadParams: _bad_params, 404: _missing, 503: _missing, Full: _full, Refusal: files.refused,
    api.BadBody: api.bad_body, Busy: api.busy, Gone: api.gone, Exception: api.failed,
}  # fmt: skip
"""Who answers when something goes wrong."""
