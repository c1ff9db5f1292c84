"""What comes through a websocket, as far as it may be read: one place for both sockets and every message."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from time import monotonic
from typing import Any, Literal, NamedTuple, Protocol, TypeVar

from starlette.websockets import WebSocket

LARGEST_MESSAGE = 16 * 1024
MESSAGES_PER_SECOND = 200
NONSENSE = 50
"""Refused messages that one without sense counts as."""
STRANGERS = 1000
"""Websockets that may be open without having said who they are."""
T = TypeVar("T")


class Decoder(Protocol):
    """What makes a message of a frame."""

    def decode(self, data: Any, /) -> Any: ...


class Read(NamedTuple):
    """One message: as it came, what it says (None if it makes no sense), and in words why it makes none."""

    data: Any
    message: Any
    trouble: str = ""


class Ended(Exception):
    """Nothing more comes, or nothing more is taken; the code to close with."""

    def __init__(self, code: int) -> None:
        super().__init__(code)
        self.code = code


@dataclass
class RateLimit:
    """Lets a number of messages a second pass, with as much again for a burst."""

    rate: float = MESSAGES_PER_SECOND
    tokens: float = 2 * MESSAGES_PER_SECOND
    at: float = field(default_factory=monotonic)
    refused: int = 0

    def passes(self) -> bool:
        now = monotonic()
        self.tokens = min(self.tokens + (now - self.at) * self.rate, 2 * self.rate)
        self.at = now
        if self.tokens < 1.0:
            self.refused += 1
            return False
        self.tokens -= 1.0
        return True

    @property
    def flooding(self) -> bool:
        return self.refused > 10 * self.rate


class Inbox:
    """The messages of one websocket: of one kind, not too large and not too many."""

    def __init__(
        self, ws: WebSocket, kind: Literal["text", "bytes"], decoder: Decoder, refusals: Counter[str], reason: str
    ) -> None:
        self._ws = ws
        self._kind = kind
        self._decoder = decoder
        self._refusals = refusals
        self._reason = reason
        """What nonsense is counted under."""
        self._limit = RateLimit()

    async def next(self) -> Read:
        """The next message. Raises `Ended`."""
        while True:
            event = await self._ws.receive()
            if event["type"] == "websocket.disconnect":
                raise Ended(1000)
            data = event.get(self._kind)
            if data is None or len(data) > LARGEST_MESSAGE:
                self._refusals["size or kind"] += 1
                raise Ended(1009)
            if self._limit.passes():
                return self._read(data)
            self._refusals["rate"] += 1
            self._enough()

    def _read(self, data: Any) -> Read:
        try:
            return Read(data, self._decoder.decode(data))
        except Exception as error:  # whatever a decoder stumbles over is the sender's doing: depth, text, numbers
            self._refusals[self._reason] += 1
            self._limit.refused += NONSENSE
            self._enough()
            return Read(data, None, str(error)[:200] or type(error).__name__)

    def _enough(self) -> None:
        if self._limit.flooding:
            raise Ended(1008)


class Strangers:
    """Websockets that haven't said yet who they are: not for long, and not too many. Who has waited longest goes."""

    def __init__(self, refusals: Counter[str]) -> None:
        self._refusals = refusals
        self._waiting: dict[object, tuple[Callable[[], object], asyncio.TimerHandle]] = {}

    def enter(self, end: Callable[[], object], seconds: float) -> Callable[[], None]:
        """Count one in, which `end` closes in the end. Call what is returned when it is a stranger no more."""
        mark = object()
        timer = asyncio.get_running_loop().call_later(seconds, self._end, mark)
        self._waiting[mark] = end, timer
        if len(self._waiting) > STRANGERS:
            self._end(next(iter(self._waiting)))
        return partial(self._known, mark)

    async def greeting(self, inbox: Inbox, kind: type[T], seconds: float) -> T:
        """The first message of a websocket, which says who it is. Raises `Ended` where that isn't said, or too late."""
        reading = asyncio.ensure_future(inbox.next())
        known = self.enter(reading.cancel, seconds)
        try:
            await asyncio.wait((reading,))
        finally:
            known()
            reading.cancel()
        if reading.cancelled() or reading.exception() or not isinstance(hello := reading.result().message, kind):
            self._refusals["no greeting"] += 1
            raise Ended(1008)
        return hello

    def _known(self, mark: object) -> None:
        if (waiting := self._waiting.pop(mark, None)) is not None:
            waiting[1].cancel()

    def _end(self, mark: object) -> None:
        end, timer = self._waiting.pop(mark)
        timer.cancel()
        self._refusals["silent"] += 1
        end()
