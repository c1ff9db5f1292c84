"""Long work that says how far it is, and ends when nobody waits for it any more.

A session that solves in the pool gives the thread that does it a `Work`, in which it writes what it does; what takes
long also asks now and then whether it is still wanted. Whoever solves otherwise (tests, the API) is never stopped.
"""

from __future__ import annotations

from collections.abc import Callable
from contextvars import ContextVar
from dataclasses import dataclass


@dataclass
class Work:
    """What a thread does for a session: in words, and how much of it is done, 0 to 1, or None where nobody knows."""

    wanted: Callable[[], bool] = lambda: True
    words: str = ""
    done: float | None = None
    cancelled: bool = False


at_work: ContextVar[Work | None] = ContextVar("at_work", default=None)


class Superseded(Exception):
    """The result is no longer wanted."""


def begins(words: str) -> None:
    """Say what is done from here on. Raise `Superseded` if it is no longer wanted."""
    if (work := at_work.get()) is not None:
        work.words = words
    goes_on(None)


def goes_on(done: float | None = None) -> None:
    """Say how much of it is done, 0 to 1. Raise `Superseded` if the rest is no longer wanted."""
    if (work := at_work.get()) is not None:
        work.done = done
        if work.cancelled or not work.wanted():
            raise Superseded
