"""All sessions of this process."""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from typing import Any

from app.rooms.places import Fairness, Full, neighbourhood
from app.rooms.session import Session
from app.rooms.solver import ROOM, Solver, workers
from sims.kit import child
from sims.kit.params import Params
from sims.kit.progress import Work, at_work
from sims.kit.sim import Library, Sim

LOADING = 10.0
"""Seconds that a page may take from its address to its websockets; its session is kept so long at least."""
LEFT = 2.0
"""Seconds that a session which everybody has left is kept at least: its page may be loading anew."""
UNVISITED = 60.0
"""Seconds that a session without viewers is kept."""
SWEPT_EVERY = 15.0
"""Seconds between two looks at whether sessions can go."""


class Sessions:
    """At most `limit` sessions, by sim and room. `libraries` are those of the sims that have files, by slug.

    What an address may have of them `fairness` says. A session in which nobody does anything for `idle` seconds is put
    away. Solutions that take long may take `most` bytes in all.
    """

    def __init__(
        self, limit: int, libraries: Mapping[str, Library] | None = None, fairness: Fairness | None = None,
        idle: float = math.inf, most: int = ROOM,
    ) -> None:  # fmt: skip
        self.limit = limit
        self._fairness = fairness or Fairness(limit, limit)
        self._idle = idle
        self.put_away: Callable[[Session], None] = lambda session: None
        """Closes the pages of a session; they wait until somebody does something."""
        self.draining = False
        """The server ends soon: rooms that it doesn't have are opened elsewhere."""
        self._sweeping: asyncio.Task[None] | None = None
        self._libraries = libraries or {}
        self._by_room: dict[tuple[str, str], Session] = {}
        self._solver = Solver(most)
        self.aside = workers("aside", 1)
        """Reads files and answers the API, one thing at a time however long it takes, beside what solves."""
        self._ahead = workers("ahead", 1)
        self._closed = False
        self._begun: set[str] = set()
        """Names of the work ahead that has begun."""

    def __len__(self) -> int:
        return len(self._by_room)

    def uploaded_bytes(self) -> int:
        """Bytes of all files that sessions keep."""
        return sum(sum(session.uploads.values()) for session in self._by_room.values())

    def solved_bytes(self) -> int:
        """Bytes of what is kept of solutions that take long."""
        return self._solver.memory.bytes

    def given(self, sim: Sim[Any, Any]) -> tuple[Library, ...]:
        """What a sim's functions need besides the parameters."""
        library = self._libraries.get(sim.slug)
        return () if library is None else (library,)

    def find(self, sim: Sim[Any, Any], room: str) -> Session | None:
        """The running session of a room."""
        return self._by_room.get((sim.slug, room))

    def open(
        self, sim: Sim[Any, Any], room: str, params: Params, *, opened: Params | None = None, watching: bool = False,
        address: str = "",
    ) -> Session:  # fmt: skip
        """The session of a room, begun with `params` if nobody with control has been there. Raises `Full`.

        `opened` is the state of the link, where that is another: the page of a restarted server has gone on since.
        `address` is that of who asks.
        """
        session = self.find(sim, room) or self._begin(sim, room, params, neighbourhood(address))
        if session.waiting and not watching:
            session.begin(params, params if opened is None else opened)
        return session

    def _begin(self, sim: Sim[Any, Any], room: str, params: Params, opener: str) -> Session:
        self.sweep()
        if self.draining:
            raise Full("The server is being restarted.", wait=2)
        if len(self._by_room) >= self.limit:
            self._drop_one()
        self._fairness.may_open(opener, self._by_room.values())
        session = Session(sim, room, params, self._solver, self._libraries.get(sim.slug))
        session.opener = opener
        self._by_room[sim.slug, room] = session
        session.waiting = True
        if sim.ahead and session.drawing.task is not None:
            session.drawing.task.add_done_callback(lambda _: self.work_ahead(sim.slug, sim.ahead))
        return session

    def work_ahead(self, name: str, pieces: Iterable[Callable[[], object]]) -> None:
        """Begin, once for a name, with work that somebody will need soon: a piece at a time, giving way to all else."""
        if name in self._begun:
            return
        self._begun.add(name)
        with suppress(RuntimeError):  # the server ends already
            for piece in pieces:
                self._ahead.submit(self._do_ahead, piece)

    def _do_ahead(self, piece: Callable[[], object]) -> None:
        at_work.set(Work(lambda: not self._closed))  # this thread does nothing else
        piece()

    def _drop_one(self) -> None:
        """Make room: forget the session that nobody has looked at for longest. Raises `Full` if all are in use.

        One that everybody has left can go soon, for who comes back brings its state; one whose page loads has time.
        """
        now = time.monotonic()
        empty = [
            (s.left_at, key)
            for key, s in self._by_room.items()
            if not s.occupied and s.left_at < now - (LEFT if s.visited else LOADING)
        ]
        if not empty:
            raise Full
        self._by_room.pop(min(empty)[1]).end()

    def sweep(self) -> None:
        """Forget sessions that nobody has looked at for a while, and put away those in which nobody does anything."""
        now = time.monotonic()
        for key, session in list(self._by_room.items()):
            if not session.occupied and now - session.left_at > UNVISITED:
                self._by_room.pop(key).end()
            elif session.occupied and now - session.touched_at > self._idle:
                self.put_away(session)

    def begin_sweeping(self) -> None:
        """Sweep now and then from now on, whether or not somebody comes."""

        async def sweeping() -> None:
            while True:
                await asyncio.sleep(SWEPT_EVERY)
                self.sweep()

        self._sweeping = asyncio.create_task(sweeping())

    def by_sim(self) -> dict[str, list[Session]]:
        """All sessions, by the slugs of their sims."""
        found: dict[str, list[Session]] = {}
        for (slug, _), session in self._by_room.items():
            found.setdefault(slug, []).append(session)
        return found

    def drain(self) -> None:
        """The server ends soon: it takes no new rooms, and pages know the newest state, to go on from it elsewhere."""
        self.draining = True
        for session in self._by_room.values():
            session.telling.hurry()

    async def close(self) -> None:
        """End the sessions, the pools, and the processes that read files."""
        if self._sweeping is not None:
            self._sweeping.cancel()
        working = [task for session in self._by_room.values() for task in session.end()]
        await asyncio.gather(*working, return_exceptions=True)
        self._closed = True
        # What was begun ahead ends at the next state that it comes to, and uses until then what is closed below.
        await asyncio.to_thread(self._ahead.shutdown, cancel_futures=True)
        child.stop()
        self.aside.shutdown(wait=False, cancel_futures=True)
        self._solver.close()
