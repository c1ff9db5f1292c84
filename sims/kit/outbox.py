"""What waits to be sent to one viewer, in viser's wire format.

It takes the place of viser's own buffer per client, which walks every message field by field, keeps four indices
and holds a window open for 1/60 s: half of the cost of an update, and of the memory of a session. Here a change
that the kit makes is stored as it goes over the wire, and everything that waits leaves at the next turn of the loop.
"""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Awaitable, Callable, Hashable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

import msgspec
import numpy as np
import numpy.typing as npt
import zstandard
from viser import _messages
from websockets.exceptions import ConnectionClosed

Entity = tuple[str, str]
_pack = msgspec.msgpack.Encoder().encode
_compress = zstandard.ZstdCompressor(level=1).compress


class Change(NamedTuple):
    """A change of one property, ready for the wire but for an array, which goes beside it."""

    entity: Entity
    body: dict[str, Any]
    array: tuple[str, npt.NDArray[Any]] | None = None


class Outbox:
    """Of messages about the same thing only the newest waits, in the order in which they last changed."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self.done = False
        self._loop = loop
        self._thread = threading.get_ident()
        self._waiting: dict[Hashable, Change | _messages.Message] = {}
        self._wake = asyncio.Event()
        self._held = 0

    def put(self, key: Hashable, message: Change | _messages.Message) -> None:
        """Have a message sent; it takes the place of a waiting one with the same key."""
        if self.done:
            return
        self._waiting.pop(key, None)
        self._waiting[key] = message
        self._ring()

    async def run(self, send: Callable[[bytes], Awaitable[None]]) -> None:
        """Send what waits, until the viewer is gone. While one window is on its way, the next one gathers."""
        try:
            while not self.done:
                await self._wake.wait()
                self._wake.clear()
                if self._waiting and not self._held:
                    await send(self.take())
        except ConnectionClosed:
            self.done = True

    def take(self) -> bytes:
        """All that waits, as one window of viser's format: sizes, packed messages, then arrays at multiples of 8."""
        waiting, self._waiting = self._waiting, {}
        arrays: list[memoryview] = []
        packed = _pack(
            {
                "messages": [_body(message, arrays) for message in waiting.values()],
                "timestampSec": time.perf_counter(),
                "binaryBufferLengths": [array.nbytes for array in arrays],
            }
        )
        squeezed = _compress(packed)
        parts = [len(packed).to_bytes(8, "little"), len(squeezed).to_bytes(8, "little"), squeezed]
        at = 16 + len(squeezed)
        for array in arrays:
            parts += (bytes(-at % 8), array)
            at += -at % 8 + array.nbytes
        return b"".join(parts)

    def _ring(self) -> None:
        if self._held:
            return
        if threading.get_ident() == self._thread:
            self._wake.set()
        else:
            self._loop.call_soon_threadsafe(self._wake.set)

    # ---- what viser asks of its buffer

    def push(self, message: _messages.Message) -> None:
        """Take a message of viser's own; one that is meant for the other viewers doesn't go to this one."""
        if message.excluded_self_client is not None:
            return
        if message.lifecycle_phase == "remove" and message.entity_type and message.entity_id_field:
            entity = message.entity_type, getattr(message, message.entity_id_field)
            self._forget(entity, keep_bindings=True)
        self.put(message.redundancy_key(), message)

    def remove_entity_state_from_buffer(self, kind: str, name: str) -> None:
        """Forget what waits about a node that another of the same name takes the place of."""
        self._forget((kind, name), keep_bindings=False)

    def _forget(self, entity: Entity, *, keep_bindings: bool) -> None:
        self._waiting = {
            key: message
            for key, message in self._waiting.items()
            if _entity(message) != entity
            or (keep_bindings and not isinstance(message, Change) and message.lifecycle_phase is None)
        }

    @contextmanager
    def sanctioned_dead_writes(self) -> Iterator[None]:
        """viser warns of messages to viewers who are gone; here they are dropped."""
        yield

    def atomic_start(self) -> None:
        """From here on nothing leaves until `atomic_end`."""
        self._held += 1

    def atomic_end(self) -> None:
        """What came since `atomic_start` leaves together."""
        self._held -= 1
        if self._waiting:
            self._ring()

    def flush(self) -> None:
        """Nothing is kept back that a flush could send."""

    def set_done(self) -> None:
        """The viewer is gone."""
        self.done = True
        self._waiting.clear()
        self._ring()


def _body(message: Change | _messages.Message, arrays: list[memoryview]) -> dict[str, Any]:
    if not isinstance(message, Change):
        return message.as_serializable_dict(arrays)
    if message.array is None:
        return message.body
    name, array = message.array
    placed = {name: {"__binary_index": len(arrays), "dtype": array.dtype.str}}
    arrays.append(np.ascontiguousarray(array).data)
    return {**message.body, "updates": placed}


def _entity(message: Change | _messages.Message) -> Entity | None:
    return message.entity if isinstance(message, Change) else message.entity_state_key()
