"""A class hour in six minutes: learners drag without a pause while replicas behind HAProxy are restarted and killed.

What is measured: for each learner the longest time in which nothing came of what the hand did, and whether a state was
lost; for each server its memory, descriptors, threads and tasks, which must not grow.
"""

from __future__ import annotations

import asyncio
import statistics
import tempfile
from collections.abc import Iterator
from pathlib import Path
from time import perf_counter
from typing import Any

import httpx
from prometheus_client.parser import text_string_to_metric_families

from tests.dragger import Dragger
from tests.replicas import Replicas
from tests.server import PATIENCE, Server

LEARNERS, SERVERS, HANDS = 30, 3, 5.0
"""Learners, processes, and how often a second each hand moves."""
KEPT = {
    "process_resident_memory_bytes": "memory, MB", "process_open_fds": "descriptors", "sim3_threads": "threads",
    "sim3_tasks": "tasks", "sim3_sessions": "sessions",
}  # fmt: skip


def kept(server: Server) -> dict[str, float]:
    """What a server holds just now."""
    text = httpx.get(f"{server.origin}/metrics", trust_env=False, timeout=PATIENCE).text
    found: dict[str, float] = {}
    for family in text_string_to_metric_families(text):
        for sample in family.samples:
            if sample.name in KEPT:
                found[sample.name] = found.get(sample.name, 0.0) + sample.value
    return found


async def hour(replicas: Replicas, learners: list[Dragger], seconds: float) -> list[dict[str, Any]]:
    """All drag; in each sixth of the time a server is restarted, the last one by a kill. What they hold before each."""
    staying = [asyncio.create_task(each.stay()) for each in learners]
    dragging = [asyncio.create_task(each.drag(seconds, HANDS)) for each in learners]
    rows: list[dict[str, Any]] = []
    begin = perf_counter()
    try:
        for turn in range(5):
            await asyncio.sleep(max(0.0, begin + (turn + 1) * seconds / 6 - perf_counter()))
            server = replicas.servers[turn % len(replicas.servers)]
            rows += await _held(replicas, f"{perf_counter() - begin:.0f} s")
            await asyncio.to_thread(server.restart, hard=turn == 4)
        await asyncio.gather(*dragging)
        rows += await _held(replicas, "end")
    finally:
        for task in (*staying, *dragging):
            task.cancel()
        await asyncio.gather(*staying, *dragging, return_exceptions=True)
    return rows


async def _held(replicas: Replicas, when: str) -> list[dict[str, Any]]:
    each = await asyncio.gather(*(asyncio.to_thread(kept, server) for server in replicas.servers))
    return [{"when": when, "server": k, **held} for k, held in enumerate(each)]


def measure(quick: bool) -> Iterator[str]:
    """Lines for people."""
    seconds = 60.0 if quick else 360.0
    with tempfile.TemporaryDirectory() as folder, Replicas(Path(folder), SERVERS) as replicas:
        learners = [Dragger(replicas.url) for _ in range(LEARNERS)]
        rows = asyncio.run(hour(replicas, learners, seconds))
        rooms = replicas.rooms()
    gaps = sorted(each.gap for each in learners)
    yield f"{LEARNERS} learners, {SERVERS} processes, {seconds:.0f} s, four restarts and a kill"
    yield f"longest gap of a learner: median {statistics.median(gaps):.2f} s, worst {gaps[-1]:.2f} s"
    yield f"last states lost: {sum(each.shown != each.value for each in learners)}; rooms: {rooms}"
    yield f"came back: {sum(each.connections - 1 for each in learners)} times"
    for row in rows:
        held = ", ".join(f"{words} {_shown(name, row.get(name, 0.0))}" for name, words in KEPT.items())
        yield f"  {row['when']:>6}  server {row['server']}: {held}"


def _shown(name: str, value: float) -> str:
    return f"{value / 1e6:.0f}" if name.endswith("bytes") else f"{value:.0f}"


if __name__ == "__main__":
    import argparse

    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="one minute in place of six")
    for line in measure(parser.parse_args().quick):
        print(line, flush=True)
