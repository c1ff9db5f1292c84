"""All classes of this process."""

from __future__ import annotations

import asyncio
import secrets
import time
from collections.abc import Callable

from app.classes.codes import code_of
from app.classes.live import Class, Find
from app.classes.subject import Subject
from app.rooms.places import Fairness, Full, neighbourhood
from app.rooms.solver import workers

MOST_CLASSES = 200
EACH, A_MINUTE = 50, 60
"""Classes that one address, which may be a whole school's, may have at once, and open within a minute."""


class Wrong(Exception):
    """The key is none of this class."""


class Classes:
    """Classes by their codes; each ends by itself after some hours."""

    def __init__(self, find: Find, hours: float, draining: Callable[[], bool]) -> None:
        self._find = find
        self._seconds = hours * 3600
        self._draining = draining
        self._by_code: dict[str, Class] = {}
        self._ends: dict[str, asyncio.TimerHandle] = {}
        self._fairness = Fairness(EACH, A_MINUTE, "classes")
        self._pool = workers("class", 1)

    def __len__(self) -> int:
        return len(self._by_code)

    def find(self, code: str) -> Class | None:
        """The class of a code, if it is there."""
        return self._by_code.get(code)

    async def code_of(self, key: str, address: str) -> str:
        """The code of the class that a key leads. Raises `Full` where an address asks for too many."""
        self._fairness.count(neighbourhood(address))
        return await asyncio.get_running_loop().run_in_executor(self._pool, code_of, key)

    async def open(self, code: str, key: str, subject: Subject, ends: float | None, address: str) -> Class:
        """The class that a key leads, begun if it isn't there. Raises `Wrong` or `Full`.

        `ends` is what a server before said of when.
        """
        if code not in self._by_code:
            if await self.code_of(key, address) != code:
                raise Wrong
            if code not in self._by_code:  # not from another page meanwhile
                self._begin(code, key, subject, ends, neighbourhood(address))
        found = self._by_code[code]
        if not secrets.compare_digest(found.key, key):
            raise Wrong
        return found

    def _begin(self, code: str, key: str, subject: Subject, ends: float | None, opener: str) -> None:
        if self._draining():
            raise Full("The server is being restarted.", wait=2)
        self._fairness.may_have(opener, self._by_code.values())
        if len(self._by_code) >= MOST_CLASSES:
            self._drop_one()
        latest = time.time() + self._seconds
        begun = Class(code, key, subject, min(latest, ends or latest), opener, self._find)
        self._by_code[code] = begun
        self._ends[code] = asyncio.get_running_loop().call_later(max(begun.ends - time.time(), 0.0), self.end, code)

    def _drop_one(self) -> None:
        """Forget a class that nobody is in: its teacher's page would bring it back. Raises `Full`."""
        empty = next((code for code, each in self._by_code.items() if not each.occupied), None)
        if empty is None:
            raise Full("This server has as many classes as it can hold.")
        self.end(empty)

    def end(self, code: str) -> None:
        """End a class."""
        if (found := self._by_code.pop(code, None)) is not None:
            self._ends.pop(code).cancel()
            found.end()

    def close(self) -> None:
        """End with the server: pages look for another, and bring their classes there."""
        for timer in self._ends.values():
            timer.cancel()
        for each in self._by_code.values():
            each.close()
        self._pool.shutdown(wait=False, cancel_futures=True)
