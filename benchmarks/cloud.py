"""A simulated learner at point clouds, who has two scans registered again and again, or drags the voxel slider."""

from __future__ import annotations

import asyncio
import json
import secrets
from contextlib import AsyncExitStack, suppress
from time import perf_counter
from typing import Any
from urllib.parse import parse_qs

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from benchmarks.learner import HELLO, PROTOCOL
from tests.frames import Message, decode_frame, encode_message

SLUG = "point-cloud"
SCANS = {"dataset": "two-scans", "process": "register", "step": 40}
REACH, STEP = 0.3, 0.001
"""Metres within which pairs are looked for; each time another, so that no result is known already."""
POINTS = "/cloud/points"


class Cloud:
    """One page of the sim in a room of its own. It looks at what is drawn only where it is told so: that costs time."""

    def __init__(self, host: str, path: str, camera: Message, *, looks: bool = False) -> None:
        self._looks = looks
        self._url = f"ws://{host}{path}"
        self._camera = camera
        self._stack = AsyncExitStack()
        self._tasks: list[asyncio.Task[None]] = []
        self._states: asyncio.Queue[Message] = asyncio.Queue()
        self._channel: ClientConnection
        self._viser: ClientConnection
        self._count = 0
        self._drawn: asyncio.Queue[tuple[int, float]] = asyncio.Queue()
        """Numbers of points that came, and when."""
        self.took: list[float] = []
        """Seconds of each registration, until the page heard of it."""

    async def open(self) -> None:
        """Connect as the page does; returns when the first state was drawn."""
        viewer = secrets.token_hex(8)
        options: dict[str, Any] = {"compression": None, "max_size": None, "ping_interval": None}
        channel = connect(f"{self._url}channel?viewer={viewer}", **options)
        self._channel = await self._stack.enter_async_context(channel)
        await self._channel.send(json.dumps(HELLO))
        scene = connect(f"{self._url}?viewer={viewer}", subprotocols=[PROTOCOL], **options)
        self._viser = await self._stack.enter_async_context(scene)
        await self._viser.send(encode_message(self._camera))
        self._tasks += [asyncio.create_task(self._listen()), asyncio.create_task(self._watch())]
        while not (await self._states.get())["text"]:
            pass

    async def register(self) -> float:
        """Have the scans registered; seconds until that is shown."""
        self._count += 1
        distance = round(REACH + STEP * self._count, 3)
        begin = perf_counter()
        await self._channel.send(
            json.dumps({"type": "set", "params": {**SCANS, "distance": distance, "neighbors": 12 + self._count % 30}})
        )
        while not _shows(await self._states.get(), distance):
            pass
        return perf_counter() - begin

    async def keep_registering(self) -> None:
        """One registration after the other."""
        while True:
            self.took.append(await self.register())

    async def drag(self, counts: dict[float, int], rate: float) -> list[float]:
        """Move the voxel slider through sizes at that rate; seconds until each cloud, or one after it, came.

        `counts` says how many points the cloud of each size has.
        """
        loop = asyncio.get_running_loop()
        sent, ages = list[float](), list[float]()
        places = {count: place for place, count in enumerate(counts.values())}
        while not self._drawn.empty():
            self._drawn.get_nowait()
        begin = loop.time() + 0.1

        async def send() -> None:
            for place, size in enumerate(counts):
                await asyncio.sleep(begin + place / rate - loop.time())
                sent.append(perf_counter())
                await self._channel.send(json.dumps({"type": "slide", "name": "voxel_size", "value": size}))

        sending = asyncio.create_task(send())
        while len(ages) < len(counts):
            count, now = await self._drawn.get()
            ages += [now - at for at in sent[len(ages) : places.get(count, -1) + 1]]
        await sending
        return ages

    async def close(self) -> None:
        await self._stack.aclose()
        await asyncio.gather(*self._tasks)

    async def _watch(self) -> None:
        with suppress(ConnectionClosed):
            async for frame in self._viser:
                now = perf_counter()
                for message in decode_frame(frame) if isinstance(frame, bytes) and self._looks else ():
                    self._see(message, now)

    def _see(self, message: Message, now: float) -> None:
        if message.get("name") == POINTS and "points" in message.get("updates", ()):
            self._drawn.put_nowait((len(message["updates"]["points"]) // 3, now))

    async def _listen(self) -> None:
        with suppress(ConnectionClosed):
            async for text in self._channel:
                message = json.loads(text)
                if message["type"] == "state":
                    self._states.put_nowait(message)


def _shows(state: Message, distance: float) -> bool:
    """Whether that registration was drawn: the words are those of what is drawn last."""
    return "registration" in state["text"] and parse_qs(state["query"]).get("distance") == [f"{distance:g}"]
