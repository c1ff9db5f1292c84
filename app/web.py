"""The FastAPI application: every address of the public contract."""

from __future__ import annotations

import logging
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Any

from fastapi import FastAPI, HTTPException, Request, WebSocket
from fastapi.responses import HTMLResponse, JSONResponse, RedirectResponse, Response
from fastapi.staticfiles import StaticFiles
from starlette.middleware.gzip import GZipMiddleware

from app import links, pages
from app.api import OpenApi, add_api, in_api
from app.bridge import Bridge
from app.docs import described
from app.files import ADDRESS, add_files
from app.pages import sim_or_404
from app.proxies import Forwarded, Prefix
from app.security import Headers, SmallBodies
from app.session import Full, Session, Sessions, is_room, new_key, room_of
from app.settings import ROOT, Settings
from geometry import GeometryError
from sims import SIMS, by_slug
from sims.kit import viser_client
from sims.kit.params import Params
from sims.kit.refusals import BadParams, Complaint
from sims.kit.sim import Sim
from sims.kit.spelling import clipped
from sims.kit.viser_internals import ViserHost

log = logging.getLogger("sim3")
AnySim = Sim[Any, Any]


def create_app(settings: Settings, host: ViserHost) -> FastAPI:
    """The application, bound to a running viser host."""
    largest = settings.max_upload * 1_000_000
    libraries = {sim.slug: sim.files.library(settings.cloud_dir, largest) for sim in SIMS if sim.files is not None}
    sessions = Sessions(settings.max_sessions, libraries)
    bridge = Bridge(host, sessions, settings.origins)

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        yield
        await sessions.close()
        answers.close()

    app = FastAPI(
        title="Sim3", summary="Interactive 3D-geometry sims", version="1", lifespan=lifespan,
        docs_url=None, redoc_url=None, redirect_slashes=False,
    )  # fmt: skip
    app.state.sessions, app.state.bridge = sessions, bridge
    app.add_middleware(GZipMiddleware, minimum_size=2000, compresslevel=6)
    app.add_middleware(SmallBodies, files=ADDRESS)
    app.add_middleware(OpenApi)
    app.add_middleware(Headers, frame_ancestors=settings.frame_ancestors)
    app.add_middleware(Prefix, prefix=settings.root_path, routes=app.routes)
    app.add_middleware(Forwarded, trusted_hosts=settings.forwarded_allow_ips)
    app.mount("/static", Static(directory=ROOT / "static"), name="static")
    _add_errors(app)
    _add_pages(app, sessions, largest)
    app.state.answers = answers = add_api(app, sessions)
    _add_sockets(app, bridge)
    add_files(app, sessions, largest)

    @page(app, "/docs")
    async def docs(request: Request) -> Response:
        return pages.render(request, "docs.html", described=described())

    @app.api_route("/healthz", methods=["GET", "HEAD"], include_in_schema=False)
    async def healthz() -> dict[str, Any]:
        return {"status": "ok", "sims": len(SIMS), "sessions": len(sessions)}

    return app


FOR_EVER = {"access-control-allow-origin": "*", "cache-control": "public, max-age=31536000, immutable"}
"""For what never changes under its address, also in frames that are sandboxed into an origin of their own."""


class Static(StaticFiles):
    """Our own files, whose addresses carry their fingerprints."""

    def file_response(self, *args: Any, **kwargs: Any) -> Response:
        response = super().file_response(*args, **kwargs)
        response.headers.update(FOR_EVER)
        return response


def page(app: FastAPI, path: str) -> Callable[[Any], Any]:
    """Registers who makes a page; HEAD is answered as GET is, but for the body."""
    return app.api_route(path, methods=["GET", "HEAD"], response_class=HTMLResponse, include_in_schema=False)


FULL = 60
"""Seconds after which a full server may have room again."""


def _add_pages(app: FastAPI, sessions: Sessions, largest: int) -> None:
    @page(app, "/")
    async def launcher(request: Request) -> Response:
        return pages.render(request, "launcher.html")

    @page(app, "/sims")
    @page(app, "/sims/")
    async def sims(request: Request) -> Response:
        return RedirectResponse(f"{pages.base(request)}/")

    @page(app, "/sims/{slug}")
    async def lesson(request: Request, slug: str) -> Response:
        sim = sim_or_404(slug)
        given = request.query_params.multi_items()
        links.read(sim, given)
        return pages.render(request, "sim.html", sim=sim, query=links.own(given))

    @page(app, "/sims/{slug}/embed")
    async def embed(request: Request, slug: str) -> Response:
        sim = sim_or_404(slug)
        key = new_key()
        return joined(request, sim, room_of(key), key)

    @page(app, "/sims/{slug}/s/{room}/{key}/")
    async def controlled(request: Request, slug: str, room: str, key: str) -> Response:
        sim = sim_or_404(slug)
        if room_of(key) != room:
            raise HTTPException(404, "This link's key doesn't fit its room.")
        return joined(request, sim, room, key)

    def joined(request: Request, sim: AnySim, room: str, key: str) -> Response:
        """The page of a room, with control of it."""
        given = request.query_params.multi_items()
        params = links.read(sim, given)
        if request.method != "HEAD":  # nobody is there to use a session
            try:
                params = _opened(sim, room, params, changes=bool(links.parts(given).params)).params
            except GeometryError as error:  # of what no parameter's bounds exclude
                wrong = Complaint(error.argument, clipped(error.received), error.allowed)
                good = {name: text for name, text in params.query_items().items() if name != error.argument}
                raise BadParams([wrong], good) from None
        return pages.viewer(request, sim, params, largest, room, key)

    def _opened(sim: AnySim, room: str, params: Params, *, changes: bool) -> Session:
        known = sessions.find(sim, room)
        try:
            session = sessions.open(sim, room, params)
        except Full:
            words = "All places on this server are taken; try again in a minute."
            raise HTTPException(503, words, {"retry-after": str(FULL)}) from None
        if known and changes:
            session.change(params.model_dump(), live=False)
        return session

    @page(app, "/sims/{slug}/s/{room}/")
    async def watched(request: Request, slug: str, room: str) -> Response:
        if not is_room(room):
            raise HTTPException(404, "There is no such room.")
        sim = sim_or_404(slug)
        known = sessions.find(sim, room)
        return pages.viewer(request, sim, known.params if known else sim.params(), largest, room)

    @app.api_route("/viser/{fingerprint}/{name}", methods=["GET", "HEAD"], include_in_schema=False)
    async def client(request: Request, fingerprint: str, name: str) -> Response:
        if fingerprint != viser_client.fingerprint() or name not in viser_client.files():
            raise HTTPException(404, "There is no such file.")
        kind = "text/css" if name.endswith(".css") else "text/javascript"
        plain, zipped = pages.client_file(name)
        if "gzip" not in request.headers.get("accept-encoding", ""):
            return Response(plain, media_type=kind, headers={**FOR_EVER, "vary": "accept-encoding"})
        headers = {**FOR_EVER, "vary": "accept-encoding", "content-encoding": "gzip"}
        return Response(zipped, media_type=kind, headers=headers)

    # Without the host, as Starlette's own redirects of this kind have it: a proxy in front may have another.
    @page(app, "/sims/{slug}/s/{room}/{key}")
    @page(app, "/sims/{slug}/s/{room}")
    async def with_slash(request: Request) -> Response:
        return redirect(request, request.scope["path"] + "/")

    @page(app, "/sims/{slug}/")
    @page(app, "/sims/{slug}/embed/")
    @page(app, "/docs/")
    async def without_slash(request: Request) -> Response:
        return redirect(request, request.scope["path"].rstrip("/"))

    def redirect(request: Request, path: str) -> Response:
        return RedirectResponse(f"{path}?{request.url.query}" if request.url.query else path)


def _add_sockets(app: FastAPI, bridge: Bridge) -> None:
    async def enter(ws: WebSocket, slug: str, room: str, key: str | None, kind: str) -> None:
        sim = by_slug(slug)
        if sim is None or (key is not None and room_of(key) != room) or not is_room(room):
            bridge.refusals["address"] += 1
            await ws.close(1008)
            return
        await getattr(bridge, kind)(ws, sim, room, watching=key is None)

    @app.websocket("/sims/{slug}/s/{room}/channel")
    async def watch_channel(ws: WebSocket, slug: str, room: str) -> None:
        await enter(ws, slug, room, None, "channel")

    @app.websocket("/sims/{slug}/s/{room}/{key}/channel")
    async def channel(ws: WebSocket, slug: str, room: str, key: str) -> None:
        await enter(ws, slug, room, key, "channel")

    @app.websocket("/sims/{slug}/s/{room}")
    @app.websocket("/sims/{slug}/s/{room}/")
    async def watch(ws: WebSocket, slug: str, room: str) -> None:
        await enter(ws, slug, room, None, "scene")

    @app.websocket("/sims/{slug}/s/{room}/{key}")
    @app.websocket("/sims/{slug}/s/{room}/{key}/")
    async def control(ws: WebSocket, slug: str, room: str, key: str) -> None:
        await enter(ws, slug, room, key, "scene")


def _add_errors(app: FastAPI) -> None:
    @app.exception_handler(BadParams)
    async def bad_params(request: Request, error: BadParams) -> Response:
        sim = by_slug(request.path_params.get("slug", ""))
        return pages.render(
            request,
            "bad_params.html",
            status=422,
            sim=sim,
            complaints=error.complaints,
            good=links.spelled(error.good),
        )

    @app.exception_handler(404)
    @app.exception_handler(503)
    async def missing(request: Request, error: HTTPException) -> Response:
        if in_api(request.scope):
            return JSONResponse({"detail": error.detail}, error.status_code, error.headers)
        response = pages.render(request, "missing.html", status=error.status_code, detail=error.detail)
        response.headers.update(error.headers or {})
        return response
