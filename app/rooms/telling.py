"""What a session tells its pages on their channels."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any

from sims.kit.sim import jsonable

Message = dict[str, Any]
Listener = Callable[[Message], None]
"""Takes the messages to one page."""
STATE_INTERVAL = 0.4
"""Seconds between state messages on the channel while a learner drags. Each changes the address, which Safari allows
a hundred times in 30 s."""


def encode(message: Mapping[str, Any]) -> str:
    """A message as JSON in ASCII: whatever a sim or a stranger put into it, it can be sent."""
    return json.dumps(jsonable(message), allow_nan=False)


class Shared(dict[str, Any]):
    """A message to many pages, which nobody changes: it is encoded once, not for each."""

    @cached_property
    def text(self) -> str:
        """As it is sent."""
        return encode(self)


class Telling:
    """Tells every page that listens; the state, made by `state`, no more often than an address may change."""

    def __init__(self, state: Callable[[], Message]) -> None:
        self.listeners: set[Listener] = set()
        self._state = state
        self._told_at = 0.0
        self._waiting: asyncio.TimerHandle | None = None
        self._interval = STATE_INTERVAL

    def tell(self, message: Message, *, but: Listener | None = None) -> None:
        """Tell everybody but one."""
        shared = Shared(message)
        for listener in list(self.listeners):
            if listener is not but:
                listener(shared)

    def tell_state_soon(self) -> None:
        """Tell the state that will be the newest then."""
        if self._waiting is None:
            wait = self._told_at + self._interval - time.monotonic()
            self._waiting = asyncio.get_running_loop().call_later(max(wait, 0.0), self._tell_state)

    def hurry(self) -> None:
        """Tell each state at once from now on: a page may soon have to go on from it elsewhere."""
        self._interval = 0.0
        if self._waiting is not None:
            self._waiting.cancel()
            self._tell_state()

    def _tell_state(self) -> None:
        self._waiting = None
        self._told_at = time.monotonic()
        if self.listeners:
            self.tell(self._state())

    def end(self) -> None:
        """Tell nothing more by itself."""
        if self._waiting is not None:
            self._waiting.cancel()
