"""`python -m tests.prompt`: the server as tests in a browser have it.

It tells a new state sooner than `python -m app` does, since tests wait for little else, and where one lesson is read it
doesn't load all others, which takes a processor for ten seconds. Whoever calls it `localhost` is given nothing in place
of viser's client, which takes most of the time that a page needs.
"""

from __future__ import annotations

from fastapi import FastAPI
from starlette.responses import Response
from starlette.types import ASGIApp, Receive, Scope, Send

from app import __main__
from app.lessons.shelf import Shelf
from app.rooms import telling
from app.settings import Settings
from app.web import create_app
from sims.kit.viser_internals import ViserHost

NOTHING = Response(
    media_type="text/javascript", headers={"Cache-Control": "max-age=3600", "Access-Control-Allow-Origin": "*"}
)


class Unpainted:
    """What `localhost` is given."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        unpainted = scope["type"] == "http" and dict(scope["headers"]).get(b"host", b"").startswith(b"localhost:")
        answer = NOTHING if unpainted and "/viser/" in scope["path"] else self._app
        await answer(scope, receive, send)


def app(settings: Settings, host: ViserHost) -> FastAPI:
    made = create_app(settings, host)
    made.add_middleware(Unpainted)
    return made


if __name__ == "__main__":
    telling.STATE_INTERVAL = 0.05
    Shelf.loading = lambda _: []  # type: ignore[method-assign, assignment]
    __main__.create_app = app  # type: ignore[attr-defined]
    __main__.main()
