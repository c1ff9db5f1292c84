"""Threads that work beside the event loop, and give way to it."""

from __future__ import annotations

import asyncio
import os
import sys
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import Any, TypeVar

from app.rooms.memory import Memory

T = TypeVar("T")
ROOM = 1_500_000_000
GIVES_WAY = 10
"""Steps of niceness."""
AT_ONCE, MOST = 2, 32
"""Threads that solve at once, and with those that have done so for long."""
LONG = 1.0
"""Seconds after which who solves no longer keeps others from it."""


class Solver:
    """Solves beside the event loop: a few at once, and nobody waits for those that take long.

    What is found may take `most` bytes in all.
    """

    def __init__(self, most: int = ROOM) -> None:
        self.memory = Memory(most)
        self._pool = workers("solve", MOST)
        self._free = asyncio.Semaphore(AT_ONCE)

    async def run(self, work: Callable[..., T], *given: Any) -> T:
        """What some work makes, in its turn."""
        await self._free.acquire()
        loop = asyncio.get_running_loop()
        held = True

        def release() -> None:
            nonlocal held
            if held:
                held = False
                self._free.release()

        waiting = loop.call_later(LONG, release)
        try:
            return await loop.run_in_executor(self._pool, work, *given)
        finally:
            waiting.cancel()
            release()

    def close(self) -> None:
        """End it; what has begun goes on until it asks whether it is wanted."""
        self._pool.shutdown(wait=False, cancel_futures=True)


def workers(name: str, most: int) -> ThreadPoolExecutor:
    """At most so many threads for what takes long."""
    return ThreadPoolExecutor(most, thread_name_prefix=name, initializer=_give_way)


def _give_way() -> None:
    """Let the event loop go first, and with it everybody else's sims. Threads that this one begins inherit it.

    On one core, what takes long would else get most of it, and learners in other sims wait five times as long. Only
    on Linux have threads a niceness of their own.
    """
    if sys.platform == "linux":
        me = threading.get_native_id()
        with suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, me, os.getpriority(os.PRIO_PROCESS, me) + GIVES_WAY)
