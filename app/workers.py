"""Threads that work beside the event loop, and give way to it."""

from __future__ import annotations

import os
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress

GIVES_WAY = 10
"""Steps of niceness."""


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
