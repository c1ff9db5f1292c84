"""A simulated learner: both websockets of a page, a slider that moves, and what comes back."""

from __future__ import annotations

import asyncio
import json
import math
import secrets
from contextlib import AsyncExitStack, suppress
from importlib.metadata import version
from time import perf_counter
from typing import Any

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed
from websockets.typing import Subprotocol

from tests.frames import Message, decode_frame, encode_message

PROTOCOL = Subprotocol(f"viser-v{version('viser')}")
SLIDER = "Yaw"
TURNED = "/turn1"
"""The node whose orientation is the slider's angle about z, in both ways of writing the sim."""
FIRST = -179
"""Slider values are whole degrees from here on up to 180: no two alike, for 17 seconds at 20 a second."""
HELLO = {"type": "hello", "dark": False, "reduced": False, "query": ""}


def yaw_of(message: Message) -> int | None:
    """To how many degrees a message turns the node that the slider turns; None where it does something else."""
    if message["type"] != "SetOrientationMessage" or message["name"] != TURNED:
        return None
    w, _, _, z = message["wxyz"]
    return round(math.degrees(2.0 * math.atan2(z, w)))


class Learner:
    """One page in a room of its own."""

    def __init__(self, host: str, path: str, camera: Message) -> None:
        self._camera = camera
        self._url = f"ws://{host}{path}"
        self._stack = AsyncExitStack()
        self._viser: ClientConnection
        self._channel: ClientConnection | None = None
        """What the slider moves on; a page of plain viser has none."""
        self._tasks: list[asyncio.Task[None]] = []
        self._slider = ""
        self._opened = asyncio.Event()
        self.values = range(0)
        self._index: dict[int, int] = {}
        self.sent: list[float] = []
        self.ages: list[float] = []
        """Seconds from sending each value until that state or a later one came, in order."""
        self.delays: list[float] = []
        """For each value that was drawn: seconds from sending it until its own state came."""
        self.late: list[float] = []
        """Seconds by which each value was sent too late."""
        self.backwards = 0
        self.shown: int | None = None

    async def open(self, *, within: float = 60.0) -> None:
        """Connect as the page does; returns when the controls and the first state have come."""
        await self.connect()
        await asyncio.wait_for(self._opened.wait(), within)

    async def connect(self) -> None:
        """The same, of any sim, without the wait."""
        viewer = secrets.token_hex(8)
        options: dict[str, Any] = {"compression": None, "max_size": None, "ping_interval": None}
        if "/s/" in self._url:
            channel = connect(f"{self._url}channel?viewer={viewer}", **options)
            self._channel = await self._stack.enter_async_context(channel)
            await self._listen(self._channel)
        viser_socket = connect(f"{self._url}?viewer={viewer}", subprotocols=[PROTOCOL], **options)
        self._viser = await self._stack.enter_async_context(viser_socket)
        await self._viser.send(encode_message(self._camera))
        self._tasks.append(asyncio.create_task(self._watch()))

    async def _listen(self, channel: ClientConnection) -> None:
        await channel.send(json.dumps(HELLO))

        async def listen() -> None:
            with suppress(ConnectionClosed):
                async for message in channel:
                    self._hear(message)

        self._tasks.append(asyncio.create_task(listen()))

    async def _watch(self) -> None:
        with suppress(ConnectionClosed):
            async for frame in self._viser:
                if isinstance(frame, bytes):
                    self._look(frame, perf_counter())

    def _hear(self, message: str | bytes) -> None:
        """Take what the channel says."""

    def _look(self, frame: bytes, now: float) -> None:
        for message in decode_frame(frame):
            if (yaw := yaw_of(message)) is not None:
                self._see(yaw, now)
            elif message["type"] == "GuiSliderMessage" and message["props"]["label"].startswith(SLIDER):
                self._slider = message["uuid"]

    def _see(self, value: int, now: float) -> None:
        self.shown = value
        if self._slider or self._channel:
            self._opened.set()
        index = self._index.get(value)
        if index is None:
            return
        if index < len(self.ages):
            self.backwards += index < len(self.ages) - 1
            return
        self.ages += [now - at for at in self.sent[len(self.ages) : index + 1]]
        self.delays.append(now - self.sent[index])

    async def drag(self, values: range, rate: float, begin: float) -> None:
        """Move the slider through `values`, `rate` of them a second, from the loop's time `begin` on."""
        self.values = values
        self._index = {value: index for index, value in enumerate(values)}
        self.sent, self.ages, self.delays, self.late = [], [], [], []
        loop = asyncio.get_running_loop()
        for index, value in enumerate(values):
            due = begin + index / rate
            await asyncio.sleep(due - loop.time())
            self.late.append(loop.time() - due)
            self.sent.append(perf_counter())
            if self._channel is not None:
                await self._channel.send(json.dumps({"type": "slide", "name": "yaw", "value": value}))
            else:
                update = {"type": "GuiUpdateMessage", "uuid": self._slider, "updates": {"value": value}}
                await self._viser.send(encode_message(update))

    @property
    def arrived(self) -> bool:
        """The last value that was sent is what is shown."""
        return self.shown == self.values[-1]

    async def close(self) -> None:
        """Go, as a closed page goes."""
        await self._stack.aclose()
        await asyncio.gather(*self._tasks)
