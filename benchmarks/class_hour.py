"""A class hour in six minutes: `python -m benchmarks.class_hour [--quick]`. Learners drag while replicas behind HAProxy
are restarted and killed.

What is measured: for each learner, beside the scene and in it, the longest time in which nothing came of what the hand
did, and how often a state was lost; for each server its memory, descriptors, threads and tasks. These must not grow
while it lives, and once all have left there must be as many as before anybody came.

Learners drag for some seconds and rest for some, each at their own times: what a learner who rests has set must still
be there when the next server has taken over. Some load their page anew now and then.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import random
import statistics
import tempfile
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter

import httpx
from prometheus_client.parser import text_string_to_metric_families
from websockets.asyncio.client import connect
from websockets.exceptions import WebSocketException
from websockets.typing import Subprotocol

from benchmarks.learner import PROTOCOL, yaw_of
from tests.dragger import OPTIONS, Dragger, Felt
from tests.frames import decode_frame, encode_message
from tests.replicas import Replicas
from tests.server import PATIENCE, Server, camera_message

LEARNERS, SERVERS, RATE = 30, 3, 5.0
"""Learners, processes, and how often a second each hand moves."""
LOADS_ANEW = 5
"""One of so many learners loads the page anew in each rest."""
AGAIN = 1.0
"""Seconds until viser's client tries again; the first time it does so at once."""
LOOKED_EVERY = 2.0
FORGOTTEN_AFTER = 80.0
"""Seconds after which a server has forgotten rooms that nobody looks at."""
BOUND = 2.0
"""Seconds that a learner may feel."""
NAMES = {
    "process_resident_memory_bytes": "MB", "process_open_fds": "descriptors", "sim3_threads": "threads",
    "sim3_tasks": "tasks", "sim3_pages": "pages", "sim3_sessions": "sessions",
}  # fmt: skip
"""What a server holds."""


class Looker(Dragger):
    """With the scene too."""

    def __init__(self, url: str) -> None:
        super().__init__(url)
        self.scene = Felt()
        self.drawn: int | None = None
        self.lost = 0
        self._sockets: list[asyncio.Task[None]] = []

    async def look(self) -> None:
        """Have the scene drawn until cancelled."""
        while True:
            at = perf_counter()
            with suppress(WebSocketException, OSError, TimeoutError):
                address = f"{self._address}?viewer={self._viewer}"
                async with connect(address, subprotocols=[Subprotocol(PROTOCOL)], **OPTIONS) as socket:  # type: ignore[arg-type]
                    await socket.send(encode_message(camera_message()))
                    async for frame in socket:
                        assert isinstance(frame, bytes)
                        self._draw(frame)
            await asyncio.sleep(max(0.0, at + AGAIN - perf_counter()))

    def _draw(self, frame: bytes) -> None:
        for message in decode_frame(frame):
            if (yaw := yaw_of(message)) is not None:
                self.drawn = yaw
                self.scene.see(yaw)

    async def move(self) -> None:
        self.scene.move(self.value % 170 + 1)
        await super().move()

    async def learn(self, seconds: float, chance: random.Random, *, anew: bool) -> None:
        """Drag and rest by turns."""
        begin = perf_counter()
        self._open()
        try:
            while (left := begin + seconds - perf_counter()) > 0.0:
                await self.drag(min(left, chance.uniform(1.0, 5.0)), RATE)
                await asyncio.sleep(chance.uniform(0.5, 5.0))
                self._check()
                if anew:
                    await self._leave()
                    self._open()
            await asyncio.sleep(1.0)
            self._check()
        finally:
            await self._leave()

    def _check(self) -> None:
        """After a rest, all shows what the hand has set."""
        missing = self.felt.give_up(), self.scene.give_up()
        self.lost += any(missing) or not self.shown == self.drawn == self.value

    def _open(self) -> None:
        self._sockets = [asyncio.create_task(self.stay()), asyncio.create_task(self.look())]

    async def _leave(self) -> None:
        for each in self._sockets:
            each.cancel()
        await asyncio.gather(*self._sockets, return_exceptions=True)
        self._socket = None


@dataclass
class Life:
    """What one process held, from its start to its end, with seconds since the benchmark began."""

    server: int
    held: list[dict[str, float]] = field(default_factory=list)

    def lines(self) -> Iterator[str]:
        """First, in the middle and last of what it held while learners were there."""
        busy = [each for each in self.held if each["sim3_pages"]]
        for each in [busy[0], busy[len(busy) // 2], busy[-1]] if len(busy) > 2 else busy:
            yield f"  server {self.server} {each['at']:5.0f} s: {worded(each)}"


def worded(held: dict[str, float]) -> str:
    return ", ".join(f"{held[n] / (1e6 if words == 'MB' else 1):.0f} {words}" for n, words in NAMES.items())


def holds(server: Server) -> dict[str, float]:
    """What a server holds just now. Raises httpx.TransportError."""
    with httpx.Client(trust_env=False, timeout=PATIENCE) as http:  # a connection that stays would be a descriptor more
        text = http.get(f"{server.origin}/metrics").text
    found = dict.fromkeys([*NAMES, "process_start_time_seconds"], 0.0)
    for family in text_string_to_metric_families(text):
        for sample in family.samples:
            if sample.name in found:
                found[sample.name] += sample.value
    return found


class Looking:
    """Asks each server what it holds, every now and then."""

    def __init__(self, replicas: Replicas) -> None:
        self._replicas = replicas
        self.begin = perf_counter()
        self.late = 0.0
        """Seconds by which this machine let the learners themselves wait, at most."""
        self.ended: list[float] = []
        """When servers were ended, in seconds."""
        self._lives: dict[tuple[int, float], Life] = {}

    @property
    def now(self) -> float:
        """Seconds since the beginning."""
        return perf_counter() - self.begin

    async def wait(self) -> None:
        """See how late the machine is."""
        while True:
            at = perf_counter()
            await asyncio.sleep(0.05)
            self.late = max(self.late, perf_counter() - at - 0.05)

    async def look(self) -> None:
        """Ask until cancelled."""
        while True:
            for k, server in enumerate(self._replicas.servers):
                with suppress(httpx.TransportError):
                    held = await asyncio.to_thread(holds, server)
                    life = self._lives.setdefault((k, held["process_start_time_seconds"]), Life(k))
                    life.held.append({**held, "at": self.now})
            await asyncio.sleep(LOOKED_EVERY)

    def lines(self) -> Iterator[str]:
        for life in self._lives.values():
            yield from life.lines()


async def hour(replicas: Replicas, learners: list[Looker], looking: Looking, seconds: float) -> None:
    """All learn; in each sixth of the time a server is restarted, the last one by a kill."""
    looking.begin = perf_counter()
    asking = [asyncio.create_task(looking.look()), asyncio.create_task(looking.wait())]
    learning = [
        asyncio.create_task(each.learn(seconds, random.Random(k), anew=k % LOADS_ANEW == 0))
        for k, each in enumerate(learners)
    ]
    try:
        for turn in range(5):
            await asyncio.sleep(max(0.0, (turn + 1) * seconds / 6 - looking.now))
            looking.ended.append(looking.now)
            await asyncio.to_thread(replicas.servers[turn % SERVERS].restart, hard=turn == 4)
        await asyncio.gather(*learning)
    finally:
        for task in (*asking, *learning):
            task.cancel()
        await asyncio.gather(*asking, *learning, return_exceptions=True)


def measure(quick: bool) -> Iterator[str]:
    """Lines for people."""
    seconds = 60.0 if quick else 360.0
    yield f"load average {os.getloadavg()[0]:.1f} before the start"
    with tempfile.TemporaryDirectory() as folder, Replicas(Path(folder), SERVERS) as replicas:
        yield f"before anybody comes: {worded(holds(replicas.servers[0]))}"
        learners = [Looker(replicas.url) for _ in range(LEARNERS)]
        looking = Looking(replicas)
        asyncio.run(hour(replicas, learners, looking, seconds))
        yield f"{LEARNERS} learners, {SERVERS} processes, {seconds:.0f} s, four restarts and a kill"
        ends = ", ".join(f"{at:.0f}" for at in looking.ended)
        yield f"ended at {ends} s; the learners themselves up to {looking.late:.2f} s late"
        yield from _felt("beside the scene", [each.felt for each in learners], looking.begin)
        yield from _felt("in the scene", [each.scene for each in learners], looking.begin)
        yield f"states lost: {sum(each.lost for each in learners)}"
        yield f"connections: {sum(each.connections for each in learners)}"
        yield from looking.lines()
        yield f"after all have left ({FORGOTTEN_AFTER:.0f} s):"
        asyncio.run(asyncio.sleep(FORGOTTEN_AFTER))
        for k, server in enumerate(replicas.servers):
            yield f"  server {k}: {worded(holds(server))}"


def _felt(where: str, each: list[Felt], begin: float) -> Iterator[str]:
    longest = sorted(felt.longest for felt in each)
    over = sum(one > BOUND for one in longest)
    when = max(each, key=lambda felt: felt.longest).at - begin
    yield (
        f"longest that nothing came, {where}: median {statistics.median(longest):.2f} s, "
        f"worst {longest[-1]:.2f} s (at {when:.0f} s), {over} learners over {BOUND:g} s"
    )


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.class_hour", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="one minute in place of six")
    for line in measure(parser.parse_args().quick):
        print(line, flush=True)


if __name__ == "__main__":
    main()
