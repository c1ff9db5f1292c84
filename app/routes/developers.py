"""For those whose pages have a sim in them: how the two talk, and what a frame there allows."""

from __future__ import annotations

from fastapi import APIRouter, Request, WebSocket
from fastapi.responses import Response

from app.routes import rendering
from app.routes.pages import page
from app.routes.rendering import sim_or_404
from app.routes.services import Given
from app.routes.snippets import iframe
from app.sockets.visits import close

router = APIRouter(include_in_schema=False)
SHOWN = "euler-angles"
"""The sim of the example."""
EXAMPLE = "example.html"


@page("/developers", router)
async def developers(request: Request) -> Response:
    example = _example(request)
    return rendering.render(request, "developers.html", example=bytes(example.body).decode())


@page("/developers/example", router)
async def example(request: Request) -> Response:
    return _example(request)


def _example(request: Request) -> Response:
    """A page that hosts a sim: it works wherever it is put, and what is told of it is its own source."""
    return rendering.render(request, EXAMPLE, sim=sim_or_404(SHOWN))


@page("/check", router)
async def check(request: Request) -> Response:
    frame = iframe(f"{request.base_url}check", "What this page allows Sim3", height=700)
    return rendering.render(request, "check.html", frame=frame, bare="framed" in request.query_params)


@router.websocket("/check/socket")
async def check_socket(ws: WebSocket, given: Given) -> None:
    """Opens as a sim's websockets do, for the same pages, and says so."""
    if await given.bridge.visits.may(ws):
        await ws.accept()
        await close(ws, 1000)
