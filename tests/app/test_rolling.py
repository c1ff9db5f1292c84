"""A restart behind HAProxy while learners drag: nobody loses a state, and a room is in one process."""

from __future__ import annotations

import asyncio
from pathlib import Path

import httpx
import pytest

from tests.dragger import Dragger
from tests.proxies import find
from tests.replicas import Replicas
from tests.server import PATIENCE, wait_for

LEARNERS = 6


async def _drag_through(replicas: Replicas, learners: list[Dragger]) -> None:
    """Restart a server while all drag, until the last value of each is shown."""
    staying = [asyncio.create_task(each.stay()) for each in learners]
    dragging = [asyncio.create_task(each.drag(1.0)) for each in learners]
    try:
        await asyncio.gather(*dragging)
        dragging = [asyncio.create_task(each.drag(3.0)) for each in learners]
        await asyncio.to_thread(replicas.servers[0].restart, hard=False)
        await asyncio.gather(*dragging)
    finally:
        for task in staying:
            task.cancel()
        await asyncio.gather(*staying, return_exceptions=True)


def test_a_restart_behind_a_balancer_costs_nobody_a_state(tmp_path: Path) -> None:
    if not find("haproxy"):
        pytest.skip("HAProxy is not installed")
    with Replicas(tmp_path, 2, SIM3_MAX_SESSIONS_PER_ADDRESS=f"{LEARNERS}") as replicas:
        learners = [Dragger(replicas.url) for _ in range(LEARNERS)]
        asyncio.run(_drag_through(replicas, learners))
        assert all(each.shown == each.value for each in learners)
        assert sum(each.connections for each in learners) > LEARNERS, "somebody had to come back"
        assert sum(replicas.rooms()) == LEARNERS, "a room is in one process"
        _each_address_has_its_places(replicas)


def _each_address_has_its_places(replicas: Replicas) -> None:
    """Also where a proxy that is trusted stands before the balancer."""

    def ask(address: str) -> int:
        page = f"{replicas.url}/sims/euler-angles/embed"
        return httpx.get(page, headers={"x-forwarded-for": address}, trust_env=False, timeout=PATIENCE).status_code

    before = replicas.rooms()

    def taken() -> bool:
        ask("192.0.2.1")
        return all(now == then + LEARNERS for now, then in zip(replicas.rooms(), before, strict=True))

    wait_for(taken, "all places of an address to be taken, on each server")
    assert ask("198.51.100.7, 192.0.2.1") == 503
    assert ask("192.0.2.2") == 200
