"""Files on their way to the server."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from fastapi import Request
from starlette.requests import ClientDisconnect

STALL = 10.0
"""Seconds without a byte after which a file is given up."""
BUSY = "The server has as many files as it can hold; try again later."


class Refusal(Exception):
    """What is said, and the status it is said with."""

    def __init__(self, status: int, words: str) -> None:
        super().__init__(words)
        self.status = status


class Coming:
    """The files that come and are read just now. Only what has come takes room: a slow page holds up nobody."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._bytes = 0

    @asynccontextmanager
    async def received(self, request: Request, length: int) -> AsyncIterator[bytes]:
        """The body of a request, which takes room as long as it is needed. Raises `Refusal`."""
        data = bytearray()
        chunks = request.stream()
        try:
            while chunk := await asyncio.wait_for(anext(chunks, b""), STALL):
                data += chunk
                self._bytes += len(chunk)
                if self._bytes > self._most:
                    raise Refusal(503, BUSY)
            if len(data) != length:
                raise Refusal(400, "The file broke off on its way.")
            yield bytes(data)
        except (TimeoutError, ClientDisconnect):
            raise Refusal(400, "The file broke off on its way.") from None
        finally:
            self._bytes -= len(data)
