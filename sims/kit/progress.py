"""Long work that ends when nobody waits for it any more.

A session that solves in the pool says, for the thread that does it, whether a newer state waits; what takes long
asks now and then. Whoever solves otherwise (tests, the API) is never stopped.
"""

from __future__ import annotations

from collections.abc import Callable
from contextvars import ContextVar

stale: ContextVar[Callable[[], bool]] = ContextVar("stale", default=lambda: False)
"""Whether a newer state waits."""


class Superseded(Exception):
    """The result is no longer wanted."""


def goes_on(done: float = 0.0) -> None:
    """Raise `Superseded` if the result is no longer wanted; `done`, 0 to 1, is how much of it there is."""
    if stale.get()():
        raise Superseded
