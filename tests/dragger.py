"""A simulated learner: drags a slider, and comes back by itself as the page does."""

from __future__ import annotations

import asyncio
import json
import re
import secrets
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import WebSocketException

from app.rooms.keys import new_key, room_of

CHANNEL = Path(__file__).parent.parent / "static/viewer/channel.js"
SAID = {name: int(ms) / 1000 for name, ms in re.findall(r"(?m)^const (\w+) = (\d+);", CHANNEL.read_text("utf-8"))}
FIRST, LAST = SAID["FIRST"], SAID["LAST"]
"""Seconds until the page tries again: at first, and in the end; each time twice as long."""
TOLD = SAID["TOLD"]
"""Seconds within which the page holds the state that has what was put in."""
SHOWN_WITHIN = 10.0
OPTIONS = {"compression": None, "max_size": None, "ping_interval": None, "open_timeout": 5, "proxy": None}


@dataclass
class Felt:
    """What a hand did and nothing has come of yet; `longest` is the longest time that this took."""

    longest: float = 0.0
    at: float = 0.0
    """When that ended."""
    _moved: dict[int, float] = field(default_factory=dict)

    def move(self, value: int) -> None:
        """The hand sets a value."""
        self._moved[value] = perf_counter()

    def see(self, value: float) -> None:
        """A value is shown, and with it all before it."""
        while value in self._moved:
            self._end(self._moved.pop(next(iter(self._moved))))

    def give_up(self) -> bool:
        """Whether something is missing; it is waited for no longer, and its time counts."""
        missing = bool(self._moved)
        while self._moved:
            self._end(self._moved.popitem()[1])
        return missing

    def _end(self, begun: float) -> None:
        now = perf_counter()
        if now - begun > self.longest:
            self.longest, self.at = now - begun, now


class Dragger:
    """One page in a room of its own, with its channel alone."""

    def __init__(self, url: str, slug: str = "euler-angles") -> None:
        key = new_key()
        self.room = room_of(key)
        self._address = f"{url}/sims/{slug}/s/{self.room}/{key}/".replace("http", "ws", 1)
        self._viewer = secrets.token_hex(8)
        self._query = ""
        self._socket: ClientConnection | None = None
        self._moved_at = 0.0
        """When the hand set the value; 0 if the state that the page holds has it."""
        self.value = 0
        self.shown: float | None = None
        self.felt = Felt()
        self.connections = 0

    async def stay(self) -> None:
        """Be connected until cancelled."""
        wait = FIRST
        while True:
            with suppress(WebSocketException, OSError, TimeoutError):
                address = f"{self._address}channel?viewer={self._viewer}"
                async with connect(address, **OPTIONS) as socket:  # type: ignore[arg-type]
                    wait = FIRST
                    await self._talk(socket)
            if self._socket is not None and perf_counter() - self._moved_at > TOLD:
                self._moved_at = 0.0
            self._socket = None
            await asyncio.sleep(wait)
            wait = min(2.0 * wait, LAST)

    async def _talk(self, socket: ClientConnection) -> None:
        hello = {"type": "hello", "dark": False, "reduced": True, "query": self._query}
        await socket.send(json.dumps(hello))
        self._socket = socket
        self.connections += 1
        if self._moved_at:
            await self._say()
        async for message in socket:
            self._take(json.loads(message))

    def _take(self, message: dict[str, object]) -> None:
        if message["type"] == "state":
            self._query = str(message["query"])
        elif message["type"] == "show":
            values = message["values"]
            assert isinstance(values, dict)
            self.shown = values.get("yaw", self.shown)
            if self.shown is not None:
                self.felt.see(self.shown)

    async def _say(self) -> None:
        if self._socket is not None:
            with suppress(WebSocketException):
                await self._socket.send(json.dumps({"type": "slide", "name": "yaw", "value": self.value}))

    async def move(self) -> None:
        """Set the slider to the next value; without a connection that is said once there is one."""
        self.value = self.value % 170 + 1
        self._moved_at = perf_counter()
        self.felt.move(self.value)
        await self._say()

    async def drag(self, seconds: float, rate: float = 10.0) -> None:
        """Move the slider to and fro; then wait until its last value is shown, but not for ever."""
        begin = perf_counter()
        while perf_counter() - begin < seconds:
            await self.move()
            await asyncio.sleep(1 / rate)
        end = perf_counter() + SHOWN_WITHIN
        while self.shown != self.value and perf_counter() < end:
            await asyncio.sleep(0.01)
