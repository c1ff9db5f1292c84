"""What all tests share."""

from __future__ import annotations

import gc
import os
from collections.abc import Iterator

import pytest
from hypothesis import settings
from playwright.sync_api import expect

from sims.kit import child
from tests.browser import FOR_TESTS, LaunchOptions, launch_options
from tests.server import PATIENCE, shared_host

# The examples of a property are the same in every run, whatever else runs: `make fuzz` looks for others. How long one
# takes says nothing on a busy machine.
settings.register_profile("sim3", deadline=None, derandomize=True, database=None, max_examples=40)
settings.register_profile("fuzz", deadline=None, max_examples=500)
settings.load_profile(os.environ.get("SIM3_EXAMPLES", "sim3"))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Tests with a browser come last: from its first use on, Playwright keeps an event loop running here."""
    items.sort(key=lambda item: "browser" in getattr(item, "fixturenames", ()))


def pytest_collection_finish() -> None:
    """Modules and tests live as long as the run: no collection of garbage looks through them again."""
    gc.collect()
    gc.freeze()


expect.set_options(timeout=1000 * PATIENCE)


@pytest.fixture(scope="session")
def browser_type_launch_args() -> LaunchOptions:
    """For pytest-playwright's own `browser`, which lives as long as the test run."""
    return launch_options(*FOR_TESTS)


@pytest.fixture(scope="session", autouse=True)
def _one_viser_host() -> Iterator[None]:
    """Ends the host that the rigs shared, if one was made, and fails when a task failed on it unseen."""
    yield
    if shared_host.cache_info().currsize:
        host = shared_host()
        gc.collect()
        host.call(lambda: None)
        host.viser.stop()
        assert not host.problems


@pytest.fixture(scope="session", autouse=True)
def _no_child_is_left() -> Iterator[None]:
    """Ends the processes that read files."""
    yield
    child.stop()
