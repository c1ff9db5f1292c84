"""Sessions (rooms): one Params, any number of viewers, one writer.

Everything here runs on viser's event loop, so there are no locks. An update makes the newest Params and marks
the session dirty; one task per session solves and draws. What arrives meanwhile replaces what was waiting: frames
are dropped under load, never queued, and the last state always arrives.
"""

from __future__ import annotations

import asyncio
import hashlib
import logging
import re
import secrets
import time
from collections.abc import AsyncIterator, Callable, Iterator, Mapping
from contextlib import suppress
from contextvars import copy_context
from typing import Any

from pydantic import ValidationError

from app.motion import gliding, play
from app.trouble import Unknown, error_message
from app.workers import Solver, workers
from sims.kit import child
from sims.kit.offers import Offers
from sims.kit.params import Params
from sims.kit.progress import Superseded, Work, at_work
from sims.kit.sim import Library, Sim, Step, jsonable
from sims.kit.viewer import Viewer

log = logging.getLogger("sim3")
STATE_INTERVAL = 0.4
"""Seconds between state messages on the channel while a learner drags. Each changes the address, which Safari allows
a hundred times in 30 s."""
LOADING = 10.0
"""Seconds that a page may take from its address to its websockets; its session is kept so long at least."""
PATIENCE = 0.2
"""Seconds that a solve in the pool goes on for while a newer state waits."""
LONG, REPORTED_EVERY = 0.4, 0.2
"""Seconds without a drawing from which on pages are told how far the work is, and between two such messages."""
SOLVED_WITHIN = 20.0
"""Seconds that a page which wants the solution waits for that of the newest state."""
UNVISITED = 60.0
"""Seconds that a session without viewers is kept."""


WORK_ENDED = {"type": "work", "text": "", "done": None, "cancel": False}


class Session:
    """One running sim."""

    def __init__(
        self, sim: Sim[Any, Any], room: str, params: Params, solver: Solver, library: Library | None = None
    ) -> None:
        self.sim = sim
        self.room = room
        self.params = self.initial = self._solved = params
        self.library = library
        self.given = () if library is None else (library,)
        """What the sim's functions need besides the parameters."""
        self.solution: Any = None if sim.heavy else sim.solve(params, *self.given)
        """None until what takes long is there."""
        self.viewers: set[Viewer] = set()
        self.listeners: set[Callable[[dict[str, Any]], None]] = set()
        self.left_at = time.monotonic()
        self.version = 0
        self._solver = solver
        self._turn = asyncio.Lock()
        """Of what is worked out for this session: one thing at a time."""
        self._work: Work | None = None
        """What the pool does for this session."""
        self._drawn_at = 0.0
        self._drawing: asyncio.Task[None] | None = None
        self._dirty = False
        self._motion: asyncio.Task[None] | None = None
        self._seeking: asyncio.Task[None] | None = None
        self._sought: tuple[Callable[[], Any], Callable[[Any], None]] | None = None
        self._pointing: Callable[[dict[str, Any]], None] | None = None
        self._told_at = 0.0
        self._telling: asyncio.TimerHandle | None = None
        self.reduced_motion = False
        self.waiting = False
        """Only people who watch have come so far."""
        self.uploaded = ""
        """What the library knows the file as that somebody uploaded; it stays there as long as the session lives."""
        self.uploaded_bytes = 0
        if sim.heavy:
            self.redraw()

    def begin(self, params: Params, opened: Params) -> None:
        """Somebody with control comes, and brings the room's state and the one that a reset leads back to."""
        self.waiting = False
        self.initial = opened
        self._set(params)

    def change(self, changes: Mapping[str, Any], *, live: bool = True) -> None:
        """Take changes from a control (kept within bounds) or, not live, from a link or message (refused if bad).

        Raises pydantic's ValidationError for values that are refused; the state stays.
        """
        self.stop_motion()
        self.redraw()  # also where nothing changes: a control that was moved too far goes back
        self._set(self._offers().moved(changes) if live else self.params.changed(changes))

    def _offers(self) -> Offers[Any]:
        return self.sim.offers(self.params, self.solution, *self.given)

    def glide(self, changes: Mapping[str, Any], seconds: float) -> None:
        """Take changes as from a link, and go there within some seconds; at once where motion is reduced.

        Numbers glide; words, switches, and lists of another length are set at the start. Raises ValidationError.
        """
        target = self.params.changed(changes)
        self.stop_motion()
        self.redraw()
        if self.reduced_motion:
            self._set(target)
            return
        ends = gliding(self.params, target)
        self._set(target.moved({name: getattr(self.params, name) for name in ends}))
        self._begin(iter([Step(ends, seconds), Step(dict(target.__dict__), 0.0)]))

    def drag(self, name: str, place: tuple[float, ...]) -> None:
        """Take the place where a handle was dragged to, in the scene (metres) or a picture (pixels)."""
        handle = self.sim.handles.get(name)
        if handle is None:
            raise Unknown("handle", name, self.sim.handles)
        if not self.sim.heavy:
            self.change(handle(self.params, place, *self.given))
            return
        self._seek(lambda: handle(self.params, place, *self.given), self.change)

    def _seek(self, find: Callable[[], Any], take: Callable[[Any], None]) -> None:
        """Find something out in the pool, and take it; of what comes meanwhile only the last counts."""
        self._sought = find, take
        if self._seeking is None:
            self._seeking = asyncio.get_running_loop().create_task(self._find())

    async def _find(self) -> None:
        try:
            while self._sought is not None:
                (find, take), self._sought = self._sought, None
                try:
                    async with self._turn:
                        found = await self._solver.run(find)
                    take(found)
                except Exception as error:
                    self._tell(error_message(self.sim, error))
        finally:
            self._seeking = None

    def upload(self, known_as: str, size: int, changes: Mapping[str, Any]) -> None:
        """Show a file of some bytes that the library has taken, in place of the one before."""
        self.forget(self.uploaded)
        self.uploaded, self.uploaded_bytes = known_as, size
        self.stop_motion()
        self._set(self.params.moved(changes))

    def point(self, name: str, by: Callable[[dict[str, Any]], None] | None = None) -> None:
        """Light up for everybody what somebody points at in a picture or table; an empty name is nothing.

        `by` is the channel that it came from, whose page has lit up its own pictures and tables.
        """
        self._pointing = by if name else None
        for viewer in list(self.viewers):
            self._light(viewer, name)
        for listener in list(self.listeners):
            if listener is not by:
                listener({"type": "point", "name": name})

    def select(self, name: str) -> None:
        """Select what is linked under a name; nothing happens where that can't be selected."""
        with suppress(ValidationError):
            selected = self.params.changed({self.sim.selects: name})
            self.stop_motion()
            self._set(selected)

    def act(self, name: str) -> None:
        """Press a button: reset, or one of the sim's actions."""
        self.stop_motion()
        if name == "reset":
            self._set(self.initial)
            return
        action = next((a for a in self.sim.actions if a.name == name), None)
        if action is None:
            raise Unknown("action", name, ["reset", *(a.name for a in self.sim.actions)])
        if self.sim.heavy:
            self._seek(lambda: action.run(self.params, *self.given), self._take_result)
        else:
            self._take_result(action.run(self.params, *self.given))

    def _take_result(self, result: Mapping[str, Any] | Iterator[Step]) -> None:
        if isinstance(result, Mapping):
            self._set(self.params.changed(result))
        else:
            self._begin(result)

    def _begin(self, motion: Iterator[Step]) -> None:
        self._motion = asyncio.get_running_loop().create_task(self._play(motion))

    async def _each(self, steps: Iterator[Step]) -> AsyncIterator[Step]:
        """The steps of a motion; what takes long is found out in the pool."""
        while True:
            step = await self._solver.run(next, steps, None) if self.sim.heavy else next(steps, None)
            if step is None:
                return
            yield step

    def stop_motion(self) -> None:
        """End a running animation where it is."""
        if self._motion is not None:
            self._motion.cancel()
            self._motion = None

    async def _play(self, steps: Iterator[Step]) -> None:
        try:
            async for changes in play(self._each(steps), lambda: self.params, reduced=self.reduced_motion):
                self._set(self.params.moved(changes))
                if self.sim.heavy and self._drawing is not None:  # what takes long is seen before the motion goes on
                    await asyncio.wait([self._drawing])
        except Exception as error:
            self._tell(error_message(self.sim, error))
        self._motion = None

    def cancel(self) -> None:
        """Give up the work that the pool does: back to the state that is drawn."""
        if self._work is not None:
            self.stop_motion()
            self._work.cancelled = True
            self._set(self._before)
            self.redraw()

    @property
    def _before(self) -> Params:
        """The state to which a cancelled one gives way: the one that is drawn, or, at first, that of the sim."""
        first: Params = self.sim.params()
        return first if self.solution is None else self._solved

    def _set(self, params: Params) -> None:
        if params == self.params:
            return
        self.params = params
        self.version += 1
        self.redraw()

    def redraw(self) -> None:
        """Solve and draw soon; calls before that happens join it."""
        self._dirty = True
        if self._drawing is None:
            self._drawing = asyncio.get_running_loop().create_task(self._draw())

    async def _draw(self) -> None:
        self._drawn_at = time.monotonic()
        reporting = asyncio.create_task(self._report()) if self.sim.heavy else None
        try:
            while self._dirty:
                self._dirty = False
                params = self.params
                try:
                    self.solution = await self._solve(params)
                    self._solved = params
                except Superseded:
                    continue
                except Exception as error:
                    self._tell(error_message(self.sim, error))
                    if self.params is params:
                        self.params = self._solved
                for viewer in list(self.viewers) if self.solution is not None else ():
                    self._show(viewer)
                self._drawn_at = time.monotonic()
                self._tell_state_soon()
        except Exception:
            log.exception("drawing %s failed", self.sim.slug)
        finally:
            self._drawing = None
            if reporting is not None:
                reporting.cancel()

    def _show(self, viewer: Viewer) -> None:
        """Draw for one viewer; what goes wrong there is no matter of the others."""
        try:
            viewer.draw(self._solved, self.solution)
        except Exception:
            log.exception("drawing %s for a viewer failed", self.sim.slug)

    def _light(self, viewer: Viewer, name: str) -> None:
        try:
            viewer.point(name)
        except Exception:
            log.exception("pointing in %s failed for a viewer", self.sim.slug)

    async def _solve(self, params: Params) -> Any:
        if not self.sim.heavy:
            return self.sim.solve(params, *self.given)
        work = self._work = Work(self._wanted(time.monotonic() + PATIENCE), "Waiting until others' work is done")
        context = copy_context()
        context.run(at_work.set, work)
        try:
            async with self._turn:
                found = await self._solver.run(context.run, self.sim.solve, params, *self.given)
        finally:
            self._work = None
        if work.cancelled:
            raise Superseded
        return found

    def _wanted(self, until: float) -> Callable[[], bool]:
        """Unless a newer state waits, for longer than anybody should."""
        return lambda: not self._dirty or time.monotonic() < until

    async def _report(self) -> None:
        """Tell the pages how far the work is, once nothing was drawn for long, until something is."""
        told = False
        try:
            while True:
                await asyncio.sleep(REPORTED_EVERY)
                long = self._work is not None and time.monotonic() - self._drawn_at > LONG
                if long or told:
                    self._tell(self._progress() if long else WORK_ENDED)
                told = long
        finally:
            if told:
                self._tell(WORK_ENDED)

    def _progress(self) -> dict[str, Any]:
        assert self._work is not None
        return {
            "type": "work", "text": self._work.words, "done": self._work.done,
            "cancel": self.params != self._before,
        }  # fmt: skip

    def state(self) -> dict[str, Any]:
        """The state message for pages."""
        return self._state(self.params)

    async def solved_state(self) -> dict[str, Any]:
        """The same with the solution, once the newest state is solved; both are of the state that is solved."""
        if self._drawing is not None:
            await asyncio.wait([self._drawing], timeout=SOLVED_WITHIN)
        solution = None if self.solution is None else jsonable(self.solution)
        return {**self._state(self._solved), "solution": solution}

    def _state(self, params: Params) -> dict[str, Any]:
        words = "" if self.solution is None else self.sim.describe(self._solved, self.solution)
        return {
            "type": "state", "version": self.version, "params": params.model_dump(mode="json"),
            "query": params.query(), "text": words,
        }  # fmt: skip

    def _tell(self, message: dict[str, Any]) -> None:
        for listener in list(self.listeners):
            listener(message)

    def _tell_state_soon(self) -> None:
        if self._telling is None:
            wait = self._told_at + STATE_INTERVAL - time.monotonic()
            self._telling = asyncio.get_running_loop().call_later(max(wait, 0.0), self._tell_state)

    def _tell_state(self) -> None:
        self._telling = None
        self._told_at = time.monotonic()
        if self.listeners:
            self._tell(self.state())

    def join(self, viewer: Viewer) -> None:
        """Add a viewer and show it the present state."""
        self.viewers.add(viewer)
        if self.solution is not None:
            viewer.draw(self._solved, self.solution)

    def leave(self, viewer: Viewer | None = None, listener: Callable[[dict[str, Any]], None] | None = None) -> None:
        """Forget a viewer or a channel."""
        self.viewers.discard(viewer)
        self.listeners.discard(listener)
        if listener is not None and listener is self._pointing:
            self.point("")
        if not self.viewers and not self.listeners:
            self.left_at = time.monotonic()
            self.stop_motion()

    def end(self) -> list[asyncio.Task[None]]:
        """Give back what the session keeps elsewhere, and give up its work; what still has to end is returned."""
        self.forget(self.uploaded)
        working = [task for task in (self._drawing, self._motion, self._seeking) if task is not None]
        for task in working:
            task.cancel()
        return working

    def forget(self, known_as: str) -> None:
        """Have the library forget an uploaded file."""
        if self.library is not None:
            self.library.remove(known_as)

    @property
    def occupied(self) -> bool:
        """Somebody looks at it."""
        return bool(self.viewers or self.listeners)


class Full(RuntimeError):
    """No more sessions fit."""


class Sessions:
    """All sessions of this process, by sim and room."""

    def __init__(self, limit: int, libraries: Mapping[str, Library] | None = None) -> None:
        self._limit = limit
        self._libraries = libraries or {}
        """Of the sims that have files, by slug."""
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
        return sum(session.uploaded_bytes for session in self._by_room.values())

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
        session = self.find(sim, room)
        if session is None:
            self.sweep()
            if len(self._by_room) >= self._limit:
                self._drop_one()
            session = self._by_room[sim.slug, room] = Session(
                sim, room, params, self._solver, self._libraries.get(sim.slug)
            )
            session.waiting = True
            if sim.ahead and sim.slug not in self._begun and session._drawing is not None:
                self._begun.add(sim.slug)
                session._drawing.add_done_callback(lambda _: self._work_ahead(sim))
        if session.waiting and not watching:
            session.begin(params, params if opened is None else opened)
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


def new_key() -> str:
    """A fresh unguessable key; whoever has it controls the session."""
    return secrets.token_urlsafe(16)


def room_of(key: str) -> str:
    """The room that a key controls."""
    return hashlib.sha256(key.encode()).hexdigest()[:20]


def is_room(name: str) -> bool:
    """Whether some key could control a room of that name."""
    return re.fullmatch("[0-9a-f]{20}", name) is not None
