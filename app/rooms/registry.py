"""All sessions of this process."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Mapping
from contextlib import suppress
from typing import Any

from app.rooms.session import Session
from app.rooms.solver import Solver, workers
from sims.kit import child
from sims.kit.params import Params
from sims.kit.sim import Library, Sim

LOADING = 10.0
"""Seconds that a page may take from its address to its websockets; its session is kept so long at least."""
UNVISITED = 60.0
"""Seconds that a session without viewers is kept."""


class Full(RuntimeError):
    """No more sessions fit."""


class Sessions:
    """At most `limit` sessions, by sim and room. `libraries` are those of the sims that have files, by slug."""

    def __init__(self, limit: int, libraries: Mapping[str, Library] | None = None) -> None:
        self._limit = limit
        self._libraries = libraries or {}
        self._by_room: dict[tuple[str, str], Session] = {}
        self._solver = Solver()
        self.aside = workers("aside", 1)
        """Reads files and answers the API, one thing at a time however long it takes, beside what solves."""
        self._ahead = workers("ahead", 1)
        self._begun: set[str] = set()
        """Sims whose work ahead has begun."""

    def __len__(self) -> int:
        return len(self._by_room)

    def uploaded_bytes(self) -> int:
        """Bytes of all files that sessions keep."""
        return sum(sum(session.uploads.values()) for session in self._by_room.values())

    def given(self, sim: Sim[Any, Any]) -> tuple[Library, ...]:
        """What a sim's functions need besides the parameters."""
        library = self._libraries.get(sim.slug)
        return () if library is None else (library,)

    def find(self, sim: Sim[Any, Any], room: str) -> Session | None:
        """The running session of a room."""
        return self._by_room.get((sim.slug, room))

    def open(
        self, sim: Sim[Any, Any], room: str, params: Params, *, opened: Params | None = None, watching: bool = False
    ) -> Session:
        """The session of a room, begun with `params` if nobody with control has been there. Raises `Full`.

        `opened` is the state of the link, where that is another: the page of a restarted server has gone on since.
        """
        session = self.find(sim, room) or self._begin(sim, room, params)
        if session.waiting and not watching:
            session.begin(params, params if opened is None else opened)
        return session

    def _begin(self, sim: Sim[Any, Any], room: str, params: Params) -> Session:
        self.sweep()
        if len(self._by_room) >= self._limit:
            self._drop_one()
        session = Session(sim, room, params, self._solver, self._libraries.get(sim.slug))
        self._by_room[sim.slug, room] = session
        session.waiting = True
        if sim.ahead and sim.slug not in self._begun and session.drawing.task is not None:
            self._begun.add(sim.slug)
            session.drawing.task.add_done_callback(lambda _: self._work_ahead(sim))
        return session

    def _work_ahead(self, sim: Sim[Any, Any]) -> None:
        """Begin with what people in that sim will need soon."""
        with suppress(RuntimeError):  # the server ends already
            for piece in sim.ahead:
                self._ahead.submit(piece)

    def _drop_one(self) -> None:
        """Make room: forget the session that nobody has looked at for longest. Raises `Full` if all are in use."""
        before = time.monotonic() - LOADING
        empty = [(s.left_at, key) for key, s in self._by_room.items() if not s.occupied and s.left_at < before]
        if not empty:
            raise Full
        self._by_room.pop(min(empty)[1]).end()

    def sweep(self) -> None:
        """Forget sessions that nobody has looked at for a while."""
        now = time.monotonic()
        for key, session in list(self._by_room.items()):
            if not session.occupied and now - session.left_at > UNVISITED:
                self._by_room.pop(key).end()

    async def close(self) -> None:
        """End the sessions, the pools, and the processes that read files."""
        working = [task for session in self._by_room.values() for task in session.end()]
        await asyncio.gather(*working, return_exceptions=True)
        child.stop()
        self.aside.shutdown(wait=False, cancel_futures=True)
        self._ahead.shutdown(wait=False, cancel_futures=True)
        self._solver.close()
