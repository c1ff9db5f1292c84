"""What goes out on the channel."""

from __future__ import annotations

import asyncio
import json
from typing import Any

from starlette.websockets import WebSocket

from sims.kit.sim import jsonable

MOST_WAITING = 32
"""Messages that wait for a page that reads slowly; from then on the oldest is dropped."""


def encode(message: dict[str, Any]) -> str:
    """A message as JSON in ASCII: whatever a sim or a stranger put into it, it can be sent."""
    return json.dumps(jsonable(message), allow_nan=False)


class Outgoing:
    """The messages to one page."""

    def __init__(self, ws: WebSocket) -> None:
        self._ws = ws
        self._waiting: asyncio.Queue[dict[str, Any]] = asyncio.Queue(MOST_WAITING)

    def put(self, message: dict[str, Any]) -> None:
        """Have a message sent."""
        if self._waiting.full():
            self._waiting.get_nowait()
        self._waiting.put_nowait(message)

    async def send(self) -> None:
        """Send what comes, until the page is gone."""
        while True:
            await self._ws.send_text(encode(await self._waiting.get()))
