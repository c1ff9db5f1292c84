"""Start the server: `python -m app`. Settings come from the environment (see app/settings.py)."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import signal
import sys
import threading

import uvicorn
from fastapi import FastAPI

from app import logs
from app.routes.services import Services
from app.settings import Settings, load
from app.sockets.protocol import LARGEST, Websocket
from app.web import create_app
from sims.kit.viser_internals import ViserHost

log = logging.getLogger("sim3")
SWITCH = 0.001
"""Seconds that a thread which works beside the event loop may keep Python's lock when the loop asks for it."""
TELLING = 0.05
"""Seconds in which pages have been told what they go on from."""


def main() -> None:
    """Run until interrupted. One event loop serves viser, the pages and all websockets."""
    settings = load()
    sys.setswitchinterval(SWITCH)
    logs.begin(settings.log)
    if sys.platform != "win32":
        import uvloop

        asyncio.set_event_loop_policy(uvloop.EventLoopPolicy())
    host = ViserHost()
    app = create_app(settings, host)
    server = uvicorn.Server(config(settings, app))
    finished = threading.Event()
    ending = Ending(server, app.state.services, settings.drain_seconds)
    signal.signal(signal.SIGINT, lambda *_: ending.now())
    signal.signal(signal.SIGTERM, lambda *_: host.loop.call_soon_threadsafe(ending.begin))

    async def serve() -> None:
        try:
            await server.serve()
        finally:
            finished.set()

    serving = asyncio.run_coroutine_threadsafe(serve(), host.loop)
    threading.Thread(target=announce, args=(server, settings), daemon=True).start()
    while not finished.wait(0.2):
        pass
    with contextlib.suppress(SystemExit):
        serving.result()
    host.stop()
    if not server.started:
        raise SystemExit(f"Sim3 can't listen on {settings.host}:{settings.port}; is the port taken? Set SIM3_PORT.")
    # Threads that still solve or read files work for nobody, and Python would wait for them, be it for a minute.
    logging.shutdown()
    sys.stdout.flush()
    os._exit(0)


class Ending:
    """How the server ends: it takes no new rooms, lets balancers see it, sends the pages elsewhere, and is gone."""

    def __init__(self, server: uvicorn.Server, services: Services, seconds: float) -> None:
        self._server = server
        self._services = services
        self._seconds = seconds

    def begin(self) -> None:
        """End in the time that balancers need; asked for the second time, at once."""
        if self._services.sessions.draining:
            self.now()
            return
        self._services.sessions.drain()
        log.info("ending: no new rooms are taken, and /readyz says so")
        asyncio.get_running_loop().call_later(max(self._seconds, TELLING), self._last)

    def _last(self) -> None:
        self._services.bridge.visits.send_elsewhere()
        self.now()

    def now(self) -> None:
        """End at once."""
        self._server.should_exit = True


def config(settings: Settings, app: FastAPI) -> uvicorn.Config:
    """How uvicorn serves the application."""
    return uvicorn.Config(
        app, host=settings.host, port=settings.port, ws=Websocket,
        ws_max_size=LARGEST, ws_per_message_deflate=False, log_config=None, log_level="warning", access_log=False,
        timeout_graceful_shutdown=2, proxy_headers=False, lifespan="on",
    )  # fmt: skip


def announce(server: uvicorn.Server, settings: Settings) -> None:
    """Say where to look, once the server listens."""
    while not server.started and not server.should_exit:
        threading.Event().wait(0.05)
    for item in server.servers:
        host, port = item.sockets[0].getsockname()[:2]
        shown = "localhost" if host in ("127.0.0.1", "0.0.0.0", "::1", "::") else host
        print(f"Sim3 is ready: http://{shown}:{port}{settings.root_path}/  (Ctrl+C ends it)", flush=True)


if __name__ == "__main__":
    main()
