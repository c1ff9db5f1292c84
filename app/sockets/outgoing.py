"""What goes out on the channel."""

from __future__ import annotations

import asyncio
import json
from collections import deque
from typing import Any

from starlette.websockets import WebSocket

from app.rooms.showing import merged
from sims.kit.sim import jsonable

MOST_WAITING = 32
"""Messages that wait for a page that reads slowly; from then on the oldest is dropped."""


def encode(message: dict[str, Any]) -> str:
    """A message as JSON in ASCII: whatever a sim or a stranger put into it, it can be sent."""
    return json.dumps(jsonable(message), allow_nan=False)


class Outgoing:
    """The messages to one page. What it is to show waits as one message, however much has changed meanwhile."""

    def __init__(self, ws: WebSocket) -> None:
        self._ws = ws
        self._waiting: deque[dict[str, Any]] = deque()
        self._show: dict[str, Any] | None = None
        """The one among those that says what the page is to show."""
        self._arrived = asyncio.Event()

    def put(self, message: dict[str, Any]) -> None:
        """Have a message sent."""
        if message["type"] == "show":
            if self._show is not None:
                self._show |= merged(self._show, message)
                return
            self._show = message = {**message}
        if len(self._waiting) >= MOST_WAITING:
            self._waiting.remove(next(each for each in self._waiting if each is not self._show))
        self._waiting.append(message)
        self._arrived.set()

    async def send(self) -> None:
        """Send what comes, until the page is gone."""
        while True:
            await self._arrived.wait()
            self._arrived.clear()
            while self._waiting:
                message = self._waiting.popleft()
                if message is self._show:
                    self._show = None
                await self._ws.send_text(encode(message))
