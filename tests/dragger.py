"""A simulated learner on the channel alone: drags a slider, and comes back by itself as the page does."""

from __future__ import annotations

import asyncio
import json
import secrets
from contextlib import suppress
from time import perf_counter

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import WebSocketException

from app.rooms.keys import new_key, room_of

AGAIN = 0.25
"""Seconds until the page tries again."""


class Dragger:
    """One page in a room of its own; `gap` is the longest time that nothing came of what the hand did."""

    def __init__(self, url: str, slug: str = "euler-angles") -> None:
        key = new_key()
        self.room = room_of(key)
        self._address = f"{url}/sims/{slug}/s/{self.room}/{key}/channel".replace("http", "ws", 1)
        self._query = ""
        self._socket: ClientConnection | None = None
        self.value = 0
        self.shown: float | None = None
        self.gap = 0.0
        self.connections = 0

    async def stay(self) -> None:
        """Be connected until cancelled."""
        while True:
            with suppress(WebSocketException, OSError, TimeoutError):
                viewer = secrets.token_hex(8)
                options = {"compression": None, "ping_interval": None, "open_timeout": 5, "proxy": None}
                async with connect(f"{self._address}?viewer={viewer}", **options) as socket:  # type: ignore[arg-type]
                    hello = {"type": "hello", "dark": False, "reduced": True, "query": self._query}
                    await socket.send(json.dumps(hello))
                    self._socket = socket
                    self.connections += 1
                    async for message in socket:
                        self._take(json.loads(message))
            self._socket = None
            await asyncio.sleep(AGAIN)

    def _take(self, message: dict[str, object]) -> None:
        if message["type"] == "state":
            params = message["params"]
            assert isinstance(params, dict)
            self._query = str(message["query"])
        elif message["type"] == "show":
            values = message["values"]
            assert isinstance(values, dict)
            self.shown = values.get("yaw", self.shown)

    async def drag(self, seconds: float, rate: float = 10.0) -> None:
        """Move the slider to and fro; then wait until its last value is shown."""
        begin = answered = perf_counter()
        while (now := perf_counter()) - begin < seconds or self.shown != self.value:
            if self.shown == self.value:
                answered = now
                if now - begin < seconds:
                    self.value = self.value % 170 + 1
            self.gap = max(self.gap, now - answered)
            if self._socket is not None:
                with suppress(WebSocketException):
                    await self._socket.send(json.dumps({"type": "slide", "name": "yaw", "value": self.value}))
            await asyncio.sleep(1 / rate)
