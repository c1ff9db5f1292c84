"""One browser and one server for all browser tests; each learner has a browser context of their own."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import pytest
from playwright.sync_api import Browser, ViewportSize

from tests.browser import launch_options
from tests.e2e.learner import Learner, Witness
from tests.server import Server

DESK = ViewportSize(width=880, height=600)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    for item in items:
        if "tests/e2e" in item.path.as_posix():
            item.add_marker(pytest.mark.e2e)


@pytest.fixture(scope="session")
def browser_type_launch_args() -> dict[str, Any]:
    """For pytest-playwright's own `browser`, which lives as long as the test run."""
    return {**launch_options()}


@pytest.fixture(scope="session")
def server() -> Iterator[Server]:
    with Server() as server:
        yield server


class Classroom:
    """Lets learners in, each with a browser of their own; at the end nobody may have met an error."""

    def __init__(self, browser: Browser, server: Server, stack: ExitStack) -> None:
        self.server = server
        self._browser = browser
        self._stack = stack
        self._witnesses: list[Witness] = []

    def enter(self, *, size: ViewportSize = DESK, **options: Any) -> Learner:
        """A learner before an empty page; options are those of Playwright's contexts."""
        options = {"viewport": size, "color_scheme": "light", "reduced_motion": "no-preference", **options}
        context = self._browser.new_context(**options)
        self._stack.callback(context.close)
        witness = Witness(context)
        self._witnesses.append(witness)
        return Learner(context.new_page(), witness, self.server.url)

    def open(self, path: str, *, size: ViewportSize = DESK, **options: Any) -> Learner:
        """A learner who has opened a sim: `euler-angles/embed?yaw=45`, or any address of one."""
        learner = self.enter(size=size, **options)
        learner.open(path)
        return learner

    def complaints(self) -> list[str]:
        return [complaint for witness in self._witnesses for complaint in witness.complaints]


@pytest.fixture
def classroom(browser: Browser, server: Server) -> Iterator[Classroom]:
    """Everybody in it leaves at the end; no page may have logged an error or asked another host for anything."""
    with ExitStack() as stack:
        classroom = Classroom(browser, server, stack)
        yield classroom
        assert not classroom.complaints(), "\n".join(classroom.complaints())
