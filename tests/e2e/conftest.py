"""One browser and one server for all browser tests; each learner has a browser context to themselves."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import Any

import pytest
from playwright.sync_api import Browser, ViewportSize

from tests.e2e.learner import Learner, Witness
from tests.server import PROMPT, Server

DESK = ViewportSize(width=880, height=600)
OPTIONS = {"color_scheme": "light", "reduced_motion": "no-preference"}


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if "tests/e2e" in item.path.as_posix():
            item.add_marker(pytest.mark.e2e)


@pytest.fixture(scope="session")
def server() -> Iterator[Server]:
    with Server("-c", PROMPT) as server:
        yield server


class Seats:
    """Pages that were left, for whoever comes next with the same options: a new one takes as long as a short test."""

    def __init__(self, browser: Browser, server: Server) -> None:
        self._browser = browser
        self._server = server
        self._free: dict[str, list[Learner]] = {}

    def new(self, options: dict[str, Any]) -> Learner:
        context = self._browser.new_context(**options)
        return Learner(context.new_page(), Witness(context), self._server.url)

    @contextmanager
    def taken(self, options: dict[str, Any], *, painted: bool) -> Iterator[Learner]:
        free = self._free.setdefault(f"{painted} {sorted(options.items())}", [])
        learner = free.pop() if free else self.new(options)
        yield learner
        learner.leave()
        free.append(learner)


@pytest.fixture(scope="session")
def seats(browser: Browser, server: Server) -> Seats:
    return Seats(browser, server)


class Classroom:
    """Lets learners in, each with a browser of their own; at the end nobody may have met an error."""

    def __init__(self, seats: Seats, server: Server, stack: ExitStack) -> None:
        self.server = server
        self._seats = seats
        self._stack = stack
        self._learners: list[Learner] = []

    def enter(self, *, size: ViewportSize = DESK, **options: Any) -> Learner:
        """A learner before an empty page, which nobody else had or gets; options are those of Playwright's contexts."""
        learner = self._seats.new({"viewport": size, **OPTIONS, **options})
        self._stack.callback(learner.page.context.close)
        self._stack.callback(learner.sockets.forget)
        self._learners.append(learner)
        return learner

    def open(self, path: str, *, size: ViewportSize = DESK, **options: Any) -> Learner:
        """A learner who has opened a sim: `euler-angles/embed?yaw=45`, or any address of one."""
        learner = self._sit(size, options, painted=True)
        learner.open(path)
        return learner

    def open_column(self, path: str, *, size: ViewportSize = DESK, **options: Any) -> Learner:
        """A learner who has opened a sim's address, without viser's client: all but what is painted in the scene."""
        learner = self._sit(size, options, painted=False)
        learner.open_column(path)
        return learner

    def _sit(self, size: ViewportSize, options: dict[str, Any], *, painted: bool) -> Learner:
        seat = self._seats.taken({"viewport": size, **OPTIONS, **options}, painted=painted)
        learner = self._stack.enter_context(seat)
        learner.page.set_viewport_size(size)
        self._learners.append(learner)
        return learner

    def complaints(self) -> list[str]:
        return [complaint for learner in self._learners for complaint in learner.witness.complaints]


@pytest.fixture
def classroom(seats: Seats, server: Server) -> Iterator[Classroom]:
    """Everybody in it leaves at the end; no page may have logged an error or asked another host for anything."""
    with ExitStack() as stack:
        classroom = Classroom(seats, server, stack)
        yield classroom
        assert not classroom.complaints(), "\n".join(classroom.complaints())
