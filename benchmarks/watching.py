"""One driver who drags at 20 Hz and turns the view, and forty who watch; and a class of forty with its grid.

`python -m benchmarks.watching [--quick]`. What is measured: how old a value is when a watcher sees it, on the wire; how
many viewpoints a second each is led to; in the class, how old the teacher's state is when a learner's page is told it
while all work on; and what the server uses of its core.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import secrets
from contextlib import AsyncExitStack
from time import perf_counter
from typing import Any

import numpy as np
from websockets.asyncio.client import ClientConnection, connect

from app.classes.codes import code_of
from app.rooms.keys import new_key
from benchmarks.learner import FIRST, Learner
from benchmarks.process import CORES, cpu_seconds
from benchmarks.servers import SLUG, Sim3
from tests.frames import encode_message
from tests.server import camera_message

RATE = 20.0
"""Values, and viewpoints, a second."""
LAST_WITHIN = 2.0
SHOWN = 2.5
"""States of the teacher's sim a second: as often as its page is told them."""
REACHED = 1.0
"""States of each learner's sim a second: as often as their pages report them."""


class Watcher(Learner):
    """Somebody who looks at what another page sets."""

    views = 0
    """To how many viewpoints it was led."""

    def watch(self, driver: Learner) -> None:
        self.values, self._index, self.sent = driver.values, driver._index, driver.sent

    def _hear(self, message: str | bytes) -> None:
        self.views += '"type": "led"' in str(message)


async def turn(driver: Learner, seconds: float) -> None:
    """Turn the view round, as a hand does."""
    for k in range(int(seconds * RATE)):
        angle = 0.02 * k
        await driver._viser.send(
            encode_message(camera_message((4.0 * float(np.sin(angle)), -4.0 * float(np.cos(angle)), 2.0)))
        )
        await asyncio.sleep(1.0 / RATE)


async def measured(host: str, pid: int, path: str, count: int, seconds: float) -> dict[str, Any]:
    driver = Learner(host, path, camera_message())
    await driver.open()
    room = path.rsplit("/", 2)[0] + "/"
    watchers = [Watcher(host, room, camera_message()) for _ in range(count)]
    for watcher in watchers:
        await watcher.open()
    cpu, begin = cpu_seconds(pid), perf_counter()
    values = range(FIRST, FIRST + int(seconds * RATE))
    dragging = asyncio.create_task(driver.drag(values, RATE, asyncio.get_running_loop().time() + 0.1))
    await asyncio.sleep(0)
    for watcher in watchers:
        watcher.watch(driver)
    await asyncio.gather(dragging, turn(driver, seconds))
    took, used = perf_counter() - begin, cpu_seconds(pid) - cpu
    end = perf_counter() + LAST_WITHIN
    while not all(each.arrived for each in watchers) and perf_counter() < end:
        await asyncio.sleep(0.01)
    ages = [1e3 * age for each in watchers for age in each.ages]
    found = {
        "ages": np.percentile(ages, (50, 95, 99)), "lost": sum(not each.arrived for each in watchers),
        "views": float(np.median([each.views for each in watchers])) / seconds, "share": used / took,
    }  # fmt: skip
    await asyncio.gather(driver.close(), *(each.close() for each in watchers))
    return found


async def class_of(host: str, pid: int, count: int, seconds: float) -> dict[str, Any]:
    """All eyes on a teacher who goes on, while every learner's page reports another state each second."""
    ages: list[float] = []
    sent: dict[float, float] = {}
    key = new_key()
    place = f"ws://{host}/class/{code_of(key)}"
    grids = 0

    async def sit(stack: AsyncExitStack, path: str, first: dict[str, Any]) -> ClientConnection:
        options: dict[str, Any] = {"compression": None, "ping_interval": None}
        socket = await stack.enter_async_context(connect(f"{place}{path}/socket", **options))
        await socket.send(json.dumps(first))
        await socket.recv()
        return socket

    async def hear(socket: ClientConnection) -> None:
        nonlocal grids
        async for text in socket:
            message = json.loads(text)
            grids += message["type"] == "grid"
            if message["type"] == "eyes" and (at := sent.get((message["params"] or {}).get("yaw", -1.0))) is not None:
                ages.append(perf_counter() - at)

    async def work(socket: ClientConnection, k: int) -> None:
        for turn in range(int(seconds * REACHED)):
            await socket.send(json.dumps({"type": "at", "params": {"yaw": (7 * turn + k) % 170}}))
            await asyncio.sleep(1.0 / REACHED)

    async with AsyncExitStack() as stack:
        teacher = await sit(stack, f"/{key}", {"type": "open", "page": f"sims/{SLUG}/embed"})
        learners = [await sit(stack, "", {"type": "join", "me": secrets.token_hex(8)}) for _ in range(count)]
        hearing = [asyncio.create_task(hear(each)) for each in (teacher, *learners)]
        await teacher.send(json.dumps({"type": "look", "eyes": True}))
        cpu, begin = cpu_seconds(pid), perf_counter()
        working = [asyncio.create_task(work(each, k)) for k, each in enumerate(learners)]
        for yaw in range(int(seconds * SHOWN)):
            sent[yaw] = perf_counter()
            await teacher.send(json.dumps({"type": "show", "params": {"yaw": yaw}}))
            await asyncio.sleep(1.0 / SHOWN)
        await asyncio.gather(*working)
        share = (cpu_seconds(pid) - cpu) / (perf_counter() - begin)
        end = perf_counter() + LAST_WITHIN
        while len(ages) < len(sent) * count and perf_counter() < end:
            await asyncio.sleep(0.01)
        for task in hearing:
            task.cancel()
        await asyncio.gather(*hearing, return_exceptions=True)
    lost = len(sent) * count - len(ages)
    return {
        "ages": np.percentile([1e3 * age for age in ages], (50, 95, 99)),
        "lost": lost,
        "grids": grids,
        "share": share,
    }


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.watching", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="two seconds in place of ten")
    seconds = 2.0 if parser.parse_args().quick else 10.0
    print(f"load average {os.getloadavg()[0]:.1f} before the start")
    for count in (1, 40):
        with Sim3() as server:
            os.sched_setaffinity(0, {CORES[-1]})
            found = asyncio.run(measured(f"127.0.0.1:{server.port}", server.pid, server.page(), count, seconds))
        p50, p95, p99 = found["ages"]
        print(
            f"{count:3} watching: age of a value p50/p95/p99 {p50:.0f}/{p95:.0f}/{p99:.0f} ms, "
            f"last lost {found['lost']}, {found['views']:.1f} viewpoints/s, server {found['share']:.0%} of its core"
        )
    with Sim3() as server:
        found = asyncio.run(class_of(f"127.0.0.1:{server.port}", server.pid, 40, seconds))
        p50, p95, p99 = found["ages"]
        print(
            f" 40 in a class: age of the teacher's state p50/p95/p99 {p50:.0f}/{p95:.0f}/{p99:.0f} ms, "
            f"lost {found['lost']}, {found['grids'] / seconds:.1f} grids/s, server {found['share']:.0%} of its core"
        )


if __name__ == "__main__":
    main()
