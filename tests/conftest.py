"""What all tests share."""

from __future__ import annotations

import gc
from collections.abc import Iterator

import pytest

from tests.server import shared_host


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
