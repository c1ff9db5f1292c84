"""The application in this process, served on a port: its insides can be looked at. And one in a process of its own."""

from __future__ import annotations

import asyncio
import gc
import logging
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any, Self

import httpx
import pytest
import uvicorn

from app.__main__ import config
from app.lessons.shelf import Shelf
from app.rooms import telling
from app.routes.services import Services
from app.settings import Settings
from app.web import create_app
from sims.kit.viser_internals import ViserHost
from tests.server import PATIENCE, Server, wait_for

PREFIX = "/geo/sim3"
LESSON = """---
title: Our own lesson
summary: Turn it.
sim: euler-angles
---

## What to see

Some words.
"""


class Local:
    """The whole server in this process, on a port that the system chooses."""

    def __init__(self, **settings: Any) -> None:
        self.problems: list[str] = []
        self._host = ViserHost()
        self._log = _Recorder(self.problems)
        given = Settings(port=0, **settings)
        made = config(given, create_app(given, self._host))
        self.app: Any = made.app
        for name in ("sim3", "asyncio", "uvicorn.error"):
            logging.getLogger(name).addHandler(self._log)
        loop = self._host.loop
        loop.call_soon_threadsafe(loop.set_exception_handler, self._failed)
        self._server = uvicorn.Server(made)
        self._serving = asyncio.run_coroutine_threadsafe(self._server.serve(), loop)
        wait_for(lambda: self._server.started, "the server to listen")
        port = self._server.servers[0].sockets[0].getsockname()[1]
        self.url = f"http://127.0.0.1:{port}"
        self.http = httpx.Client(base_url=self.url, trust_env=False, timeout=PATIENCE)

    @property
    def services(self) -> Services:
        """What the server's routes work with."""
        services: Services = self.app.state.services
        return services

    @property
    def refusals(self) -> Counter[str]:
        """What the bridge refused so far, by reason."""
        return Counter(self.services.bridge.refusals)

    @property
    def sessions(self) -> int:
        """How many rooms are open."""
        return len(self.services.sessions)

    def refused(self, why: str, more_than: int = 0) -> None:
        """Wait until the bridge has refused something for a reason more often than so many times."""
        wait_for(lambda: self.refusals[why] > more_than, f"a refusal because of {why}; there were {self.refusals}")

    def sweep(self) -> None:
        """Look now at which sessions can go."""
        self._do(self.services.sessions.sweep)

    def drain(self) -> None:
        """Take no new rooms, as a server that ends soon."""
        self._do(self.services.sessions.drain)

    def _do(self, work: Callable[[], None]) -> None:
        async def done() -> None:
            work()

        asyncio.run_coroutine_threadsafe(done(), self._host.loop).result(PATIENCE)

    def close(self) -> None:
        self.http.close()
        self._server.should_exit = True
        self._serving.result(PATIENCE)
        gc.collect()
        self._host.stop()
        for name in ("sim3", "asyncio", "uvicorn.error"):
            logging.getLogger(name).removeHandler(self._log)

    def _failed(self, _: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
        self.problems.append(f"{context['message']}: {context.get('exception')!r}")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: object, *_: object) -> None:
        self.close()
        if kind is None and self.problems:
            raise AssertionError("went wrong unseen: " + "; ".join(self.problems))


class _Recorder(logging.Handler):
    def __init__(self, said: list[str]) -> None:
        super().__init__(logging.ERROR)
        self._said = said

    def emit(self, record: logging.LogRecord) -> None:
        self._said.append(logging.Formatter().format(record))


@pytest.fixture(scope="module")
def local() -> Iterator[Local]:
    """One server for the tests of a module; at its end nothing may have gone wrong unseen.

    It tells each state at once: most of a test's time would else be the wait between two. Where one lesson is read it
    doesn't solve the states of all others, as the server of `server` does.
    """
    with pytest.MonkeyPatch.context() as patch, Local() as local:
        patch.setattr(telling, "STATE_INTERVAL", 0.0)
        patch.setattr(Shelf, "loading", lambda _: [])
        yield local


@pytest.fixture
def http(local: Local) -> httpx.Client:
    """For requests to it."""
    return local.http


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """A process with a prefix and a lesson of somebody's own, for all tests that only look at its pages."""
    folder = tmp_path_factory.mktemp("lessons")
    (folder / "ours.md").write_text(LESSON)
    with Server(SIM3_ROOT_PATH=PREFIX, SIM3_LESSON_DIR=str(folder)) as running:
        yield running


@pytest.fixture(scope="session")
def client(server: Server) -> Iterator[httpx.Client]:
    """For requests to it."""
    with httpx.Client(base_url=server.url, trust_env=False, timeout=PATIENCE) as client:
        yield client
