"""The FastAPI application: every address of the public contract."""

from __future__ import annotations

import logging
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

import fastapi_offline  # carries Swagger UI, so that /docs needs no other host
from fastapi import FastAPI, HTTPException, Request, WebSocket
from fastapi.openapi.docs import get_swagger_ui_html
from fastapi.responses import HTMLResponse, JSONResponse, RedirectResponse, Response
from fastapi.staticfiles import StaticFiles
from starlette.middleware.gzip import GZipMiddleware

from app import pages
from app.api import OpenApi, add_api, in_api
from app.bridge import Bridge
from app.files import ADDRESS, add_files
from app.pages import sim_or_404
from app.security import Headers, SmallBodies
from app.session import Full, Sessions, is_room, new_key, room_of
from app.settings import ROOT, Settings
from sims import SIMS, by_slug
from sims.kit import viser_client
from sims.kit.params import BadParams, Params
from sims.kit.sim import Sim
from sims.kit.viser_internals import ViserHost

log = logging.getLogger("sim3")
AnySim = Sim[Any, Any]


def create_app(settings: Settings, host: ViserHost) -> FastAPI:
    """The application, bound to a running viser host."""
    sessions = Sessions(settings.max_sessions)
    largest = settings.max_upload * 1_000_000
    for sim in SIMS:
        if sim.files is not None and settings.cloud_dir is not None:
            sim.files.offer(settings.cloud_dir, largest)
    bridge = Bridge(host, sessions, settings.origins)

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        yield
        sessions.close()
        answers.close()

    app = FastAPI(
        title="Sim3", summary="Interactive 3D-geometry sims", version="1", lifespan=lifespan,
        docs_url=None, redoc_url=None,
    )  # fmt: skip
    # uvicorn's own setting would put the prefix before every path, though not every proxy takes it away.
    app.root_path = settings.root_path
    app.state.sessions, app.state.bridge = sessions, bridge
    app.add_middleware(GZipMiddleware, minimum_size=2000, compresslevel=6)
    app.add_middleware(SmallBodies, files=ADDRESS)
    app.add_middleware(OpenApi)
    app.add_middleware(Headers, frame_ancestors=settings.frame_ancestors)
    app.mount("/static", Static(directory=ROOT / "static"), name="static")
    _add_errors(app)
    _add_pages(app, sessions, largest)
    app.state.answers = answers = add_api(app)
    _add_sockets(app, bridge)
    add_files(app, sessions, largest)

    app.mount("/swagger", StaticFiles(directory=Path(fastapi_offline.__file__).parent / "static"), name="swagger")

    @app.get("/docs", response_class=HTMLResponse, include_in_schema=False)
    async def docs(request: Request) -> Response:
        here = pages.base(request)
        return get_swagger_ui_html(
            openapi_url=f"{here}/openapi.json",
            title="Sim3 API",
            swagger_js_url=f"{here}/swagger/swagger-ui-bundle.js",
            swagger_css_url=f"{here}/swagger/swagger-ui.css",
            swagger_favicon_url=pages.static(request, "icons/sim3.svg"),
        )

    @app.get("/healthz", include_in_schema=False)
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


def _params(sim: AnySim, request: Request) -> Params:
    """Parameters of a link; page options are checked too. Raises BadParams."""
    items, options = pages.split_options(request.query_params.multi_items())
    wrong = pages.bad_options(options)
    kept = {name: text for name, text in options.items() if name not in {w[0] for w in wrong}}
    try:
        params: Params = sim.params.from_query(items)
    except BadParams as error:
        raise BadParams([*error.complaints, *wrong], {**error.good, **kept}) from None
    if wrong:
        raise BadParams(wrong, {**dict(items), **kept})
    return params


def _add_pages(app: FastAPI, sessions: Sessions, largest: int) -> None:
    @app.get("/", response_class=HTMLResponse, include_in_schema=False)
    async def launcher(request: Request) -> Response:
        return pages.render(request, "launcher.html")

    @app.get("/sims/{slug}", response_class=HTMLResponse, include_in_schema=False)
    async def lesson(request: Request, slug: str) -> Response:
        sim = sim_or_404(slug)
        _params(sim, request)
        return pages.render(request, "sim.html", sim=sim, query=request.url.query)

    @app.get("/sims/{slug}/embed", include_in_schema=False)
    async def embed(request: Request, slug: str) -> Response:
        sim = sim_or_404(slug)
        _params(sim, request)
        key = new_key()
        query = f"?{request.url.query}" if request.url.query else ""
        return RedirectResponse(f"{pages.base(request)}/sims/{slug}/s/{room_of(key)}/{key}/{query}", 307)

    @app.get("/sims/{slug}/s/{room}/{key}/", response_class=HTMLResponse, include_in_schema=False)
    async def controlled(request: Request, slug: str, room: str, key: str) -> Response:
        sim = sim_or_404(slug)
        if room_of(key) != room:
            raise HTTPException(404, "This link's key doesn't fit its room.")
        params = _params(sim, request)
        known = sessions.find(sim, room)
        try:
            session = sessions.open(sim, room, params)
        except Full:
            raise HTTPException(503, "All places on this server are taken; try again in a minute.") from None
        if known and pages.split_options(request.query_params.multi_items())[0]:
            session.change(params.model_dump(), live=False)
        return pages.viewer(request, sim, session.params, largest, watching=False)

    @app.get("/sims/{slug}/s/{room}/", response_class=HTMLResponse, include_in_schema=False)
    async def watched(request: Request, slug: str, room: str) -> Response:
        if not is_room(room):
            raise HTTPException(404, "There is no such room.")
        sim = sim_or_404(slug)
        known = sessions.find(sim, room)
        return pages.viewer(request, sim, known.params if known else sim.params(), largest, watching=True)

    @app.get("/viser/{fingerprint}/{name}", include_in_schema=False)
    async def client(request: Request, fingerprint: str, name: str) -> Response:
        if fingerprint != viser_client.fingerprint() or name not in viser_client.files():
            raise HTTPException(404, "There is no such file.")
        kind = "text/css" if name.endswith(".css") else "text/javascript"
        plain, zipped = pages.client_file(name)
        if "gzip" not in request.headers.get("accept-encoding", ""):
            return Response(plain, media_type=kind, headers={**FOR_EVER, "vary": "accept-encoding"})
        headers = {**FOR_EVER, "vary": "accept-encoding", "content-encoding": "gzip"}
        return Response(zipped, media_type=kind, headers=headers)

    @app.get("/sims/{slug}/s/{room}/{key}", include_in_schema=False)
    @app.get("/sims/{slug}/s/{room}", include_in_schema=False)
    async def slash(request: Request) -> Response:
        query = f"?{request.url.query}" if request.url.query else ""
        return RedirectResponse(
            f"{pages.base(request)}{request.scope['path'].removeprefix(request.scope.get('root_path', ''))}/{query}"
        )


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
            good=urlencode(error.good, safe=",-.:"),
        )

    @app.exception_handler(404)
    @app.exception_handler(503)
    async def missing(request: Request, error: HTTPException) -> Response:
        if in_api(request.scope):
            return JSONResponse({"detail": error.detail}, error.status_code)
        return pages.render(request, "missing.html", status=error.status_code, detail=error.detail)
