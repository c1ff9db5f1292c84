"""One driver who drags at 20 Hz and turns the view, and forty who watch. `python -m benchmarks.watching [--quick]`.

What is measured: how old a value is when a watcher sees it, on the wire; how many viewpoints a second each is led to;
and what the server uses of its core.
"""

from __future__ import annotations

import argparse
import asyncio
import os
from time import perf_counter
from typing import Any

import numpy as np

from benchmarks.learner import FIRST, Learner
from benchmarks.process import CORES, cpu_seconds
from benchmarks.servers import Sim3
from tests.frames import encode_message
from tests.server import camera_message

RATE = 20.0
"""Values, and viewpoints, a second."""
LAST_WITHIN = 2.0


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


if __name__ == "__main__":
    main()
