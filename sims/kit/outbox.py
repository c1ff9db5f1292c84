"""What waits to be sent to one viewer, in viser's wire format.

It takes the place of viser's own buffer per client, which walks every message field by field, keeps four indices
and holds a window open for 1/60 s: half of the cost of an update, and of the memory of a session. Here a change
that the kit makes is stored as it goes over the wire, and what waits leaves at a flush or the next turn of the loop.
"""

from __future__ import annotations

import asyncio
import threading
import time
import types
from collections.abc import Callable, Coroutine, Generator, Hashable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple, Protocol

import msgspec
import numpy as np
import numpy.typing as npt
import zstandard
from websockets.exceptions import ConnectionClosed

Entity = tuple[str, str]
Window = Coroutine[Any, Any, None]
Send = Callable[[bytes], Window]
_pack = msgspec.msgpack.Encoder().encode
_compress = zstandard.ZstdCompressor(level=-1).compress


class Message(Protocol):
    """What viser gives its buffer, as far as it is used here."""

    @property
    def excluded_self_client(self) -> int | None: ...
    @property
    def lifecycle_phase(self) -> str | None: ...
    @property
    def entity_type(self) -> str | None: ...
    @property
    def entity_id_field(self) -> str | None: ...
    def redundancy_key(self) -> str: ...
    def entity_state_key(self) -> Entity | None: ...
    def as_serializable_dict(self, binary_buffers: list[memoryview]) -> dict[str, Any]: ...


class Change(NamedTuple):
    """A change of one property, ready for the wire but for an array, which goes beside it."""

    entity: Entity
    body: dict[str, Any]
    array: tuple[str, npt.NDArray[Any]] | None = None


class Outbox:
    """What waits: of messages about the same thing only the newest, in the order in which they last changed."""

    def __init__(self, send: Send, loop: asyncio.AbstractEventLoop) -> None:
        self._send = send
        self._loop = loop
        self._thread = threading.get_ident()
        self._waiting: dict[Hashable, Change | Message] = {}
        self._held = 0
        self._rung = False
        self._sending: asyncio.Task[None] | None = None
        self.done = False

    def put(self, key: Hashable, message: Change | Message) -> None:
        """Have a message sent; it takes the place of a waiting one with the same key."""
        if self.done:
            return
        self._waiting.pop(key, None)
        self._waiting[key] = message
        if not self._rung:
            self._ring()

    def flush(self) -> None:
        """Send what waits. While a window is on its way to a slow page, the next one gathers."""
        if threading.get_ident() != self._thread:
            self._loop.call_soon_threadsafe(self.flush)
            return
        self._rung = False
        if self._held or self._sending or not self._waiting:
            return
        window = self._send(self.take())
        try:
            waits_for = window.send(None)  # at most pages it is written at once: a task would only come later
        except StopIteration:
            return
        except ConnectionClosed:
            self.set_done()
            return
        self._sending = self._loop.create_task(self._finish(window, waits_for))

    async def _finish(self, window: Window, waits_for: Any) -> None:
        try:
            await _rest(window, waits_for)
        except ConnectionClosed:
            self.set_done()
        finally:
            self._sending = None
            self.flush()

    def take(self) -> bytes:
        """All that waits, as one window of viser's format: sizes, packed messages, then arrays at multiples of 8."""
        waiting, self._waiting = self._waiting, {}
        arrays: list[memoryview] = []
        packed = _pack(
            {
                "messages": [body(message, arrays) for message in waiting.values()],
                "timestampSec": time.perf_counter(),
                "binaryBufferLengths": [array.nbytes for array in arrays],
            }
        )
        squeezed = _compress(packed)
        parts: list[bytes | memoryview] = [
            len(packed).to_bytes(8, "little"),
            len(squeezed).to_bytes(8, "little"),
            squeezed,
        ]
        at = 16 + len(squeezed)
        for array in arrays:
            parts += (bytes(-at % 8), array)
            at += -at % 8 + array.nbytes
        return b"".join(parts)

    def _ring(self) -> None:
        self._rung = True
        if threading.get_ident() == self._thread:
            self._loop.call_soon(self.flush)
        else:
            self._loop.call_soon_threadsafe(self.flush)

    # ---- what viser asks of its buffer

    def push(self, message: Message) -> None:
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
        if self._waiting and not self._rung:
            self._ring()

    def set_done(self) -> None:
        """The viewer is gone."""
        self.done = True
        self._waiting.clear()


@types.coroutine
def _rest(window: Window, waits_for: Any) -> Generator[Any, Any, None]:
    """What is left of a coroutine that was begun outside a task, and waits for something."""
    yield waits_for
    yield from window.__await__()


def body(message: Change | Message, arrays: list[memoryview]) -> dict[str, Any]:
    """A message ready for the wire; its arrays are appended."""
    if not isinstance(message, Change):
        return message.as_serializable_dict(arrays)
    if message.array is None:
        return message.body
    name, array = message.array
    placed = {name: {"__binary_index": len(arrays), "dtype": array.dtype.str}}
    arrays.append(np.ascontiguousarray(array).data)
    return {**message.body, "updates": placed}


def _entity(message: Change | Message) -> Entity | None:
    return message.entity if isinstance(message, Change) else message.entity_state_key()
