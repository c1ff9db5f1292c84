"""What goes out on the channel."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Mapping

from starlette.websockets import WebSocket

from app.rooms.showing import merged
from app.rooms.telling import Message, Shared, encode

MOST_WAITING = 32
"""Messages that wait for a page that reads slowly; from then on the oldest is dropped."""
AS_ONE: Mapping[str, Callable[[Message, Message], Message]] = {"show": merged, "led": lambda older, newer: newer}
"""Kinds of which one waits, whatever has changed meanwhile: of an older and a newer one, what is sent."""


class Outgoing:
    """The messages to one page."""

    def __init__(self, ws: WebSocket) -> None:
        self._ws = ws
        self._waiting: deque[Message] = deque()
        self._arrived = asyncio.Event()

    def put(self, message: Message) -> None:
        """Have a message sent."""
        kind = message["type"]
        at = next((k for k, each in enumerate(self._waiting) if each["type"] == kind in AS_ONE), None)
        if at is not None:
            self._waiting[at] = AS_ONE[kind](self._waiting[at], message)
            return
        if len(self._waiting) >= MOST_WAITING:
            self._waiting.remove(next(each for each in self._waiting if each["type"] != "show"))
        self._waiting.append(message)
        self._arrived.set()

    async def send(self) -> None:
        """Send what comes, until the page is gone."""
        while True:
            await self._arrived.wait()
            self._arrived.clear()
            while self._waiting:
                message = self._waiting.popleft()
                await self._ws.send_text(message.text if isinstance(message, Shared) else encode(message))
