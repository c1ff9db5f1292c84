"""One browser and one server for all browser tests; each learner has a browser context to themselves."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import Any

import pytest
from playwright.sync_api import Browser, ViewportSize

from tests.browser import COARSE
from tests.e2e.learner import Learner, Witness
from tests.server import Server

DESK = ViewportSize(width=880, height=600)
EYES = {"color_scheme": "light", "reduced_motion": "no-preference"}
"""What a page can be told anew at any time."""


# As schools have it set, frames of other sites have no storage. Chromium without windows knows no such setting.
NO_STORAGE = """for (const name of ["localStorage", "sessionStorage", "indexedDB"]) {
    const top = location.ancestorOrigins[location.ancestorOrigins.length - 1];
    if (top && top !== "null" && new URL(top).hostname !== location.hostname) Object.defineProperty(window, name, { get() {
        throw new DOMException("Access is denied for this document.", "SecurityError");
    } });
}"""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if "tests/e2e" in item.path.as_posix():
            item.add_marker(pytest.mark.e2e)


@pytest.fixture(scope="session")
def server() -> Iterator[Server]:
    with Server("-m", "tests.prompt") as server:
        yield server


class Seats:
    """Pages that were left, for whoever comes next: to open a sim in a new browser takes twice as long."""

    def __init__(self, browser: Browser, server: Server) -> None:
        self._browser = browser
        self._server = server
        self._free: dict[str, list[Learner]] = {}

    def new(self, size: ViewportSize, options: dict[str, Any]) -> Learner:
        context = self._browser.new_context(**{"viewport": size, **EYES, "device_scale_factor": COARSE, **options})
        context.add_init_script(NO_STORAGE)
        return Learner(context.new_page(), Witness(context), self._server.url)

    @contextmanager
    def taken(self, size: ViewportSize, options: dict[str, Any]) -> Iterator[Learner]:
        fixed = {name: value for name, value in options.items() if name not in EYES}
        free = self._free.setdefault(f"{sorted(fixed.items())}", [])
        learner = free.pop() if free else self.new(size, fixed)
        learner.page.set_viewport_size(size)
        learner.page.emulate_media(**{name: options.get(name, usual) for name, usual in EYES.items()})
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

    def enter(self, *, size: ViewportSize = DESK, painted: bool = True, **options: Any) -> Learner:
        """A learner before an empty page; options are those of Playwright's contexts."""
        learner = self._stack.enter_context(self._seats.taken(size, options))
        learner.painted = painted
        self._learners.append(learner)
        return learner

    def enter_alone(self, *, size: ViewportSize = DESK, **options: Any) -> Learner:
        """A learner before an empty page, which nobody else had or gets: for what can't be undone in a browser."""
        learner = self._seats.new(size, options)
        self._stack.callback(learner.page.context.close)
        self._stack.callback(learner.sockets.forget)
        self._learners.append(learner)
        return learner

    def open(self, path: str, **seat: Any) -> Learner:
        """A learner who has opened a sim: `euler-angles/embed?yaw=45`, or any address of one."""
        learner = self.enter(**seat)
        learner.open(path)
        return learner

    def open_column(self, path: str, **seat: Any) -> Learner:
        """A learner who has opened a sim's address, without viser's client: all but what is painted in the scene."""
        learner = self.enter(**seat)
        learner.open_column(path)
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
