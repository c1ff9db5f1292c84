"""Solving the newest state of a session, and drawing it for everybody who looks."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable
from contextvars import copy_context
from typing import Any

from app import metrics
from app.rooms.showing import Showing
from app.rooms.solver import Solver
from app.rooms.telling import Message, Telling
from sims.kit.column import Column
from sims.kit.params import Params
from sims.kit.progress import Superseded, Work, at_work
from sims.kit.sim import Library, Sim
from sims.kit.viewer import Viewer

log = logging.getLogger("sim3")
PATIENCE = 0.2
"""Seconds that a solve in the pool goes on for while a newer state waits."""
LONG, REPORTED_EVERY = 0.4, 0.2
"""Seconds without a drawing from which on pages are told how far the work is, and between two such messages."""
BROKEN = {"type": "error", "message": "This state can’t be drawn; the server’s log says why.", "errors": []}
WORK_ENDED = {"type": "work", "text": "", "done": None, "cancel": False}


class Drawing:
    """Keeps what is seen up to the newest state, which `newest` knows with its version.

    One task solves and draws. What arrives meanwhile replaces what was waiting: frames are dropped under load, never
    queued, and the last state always arrives. A state that can't be solved is told to `failed`.
    """

    def __init__(
        self, sim: Sim[Any, Any], params: Params, given: tuple[Library, ...], solver: Solver, turn: asyncio.Lock,
        telling: Telling, newest: Callable[[], tuple[Params, int]], failed: Callable[[Params, Exception], None],
    ) -> None:  # fmt: skip
        self.sim = sim
        self.solved = params
        self.solution: Any = None if sim.heavy else sim.solve(params, *given)
        """The solution of the state that is `solved`; None until what takes long is there."""
        self.version = 0
        """The version of the state that is solved."""
        self.viewers: set[Viewer] = set()
        self._showing = Showing(Column(sim, given))
        self.task: asyncio.Task[None] | None = None
        """As long as something is to be drawn."""
        self._given = given
        self._solver = solver
        self._turn = turn
        self._telling = telling
        self._newest = newest
        self._failed = failed
        self._dirty = False
        self._asked_at = 0.0
        self._drawn_at = 0.0
        self.work: Work | None = None
        """What the pool does for this session."""
        self._latency = metrics.LATENCY.labels(sim.slug)
        self._solving = metrics.SOLVING.labels(sim.slug)
        self._coalesced = metrics.COALESCED.labels(sim.slug)
        for what in ("solve", "draw", "check"):  # at 0, or the first one would not be seen as an increase
            metrics.FAILURES.labels(sim.slug, what)
        self.words = ""
        """What a motion says, in place of the caption."""

    def soon(self) -> None:
        """Solve and draw soon; calls before that happens join it."""
        if self._dirty:
            self._coalesced.inc()
        else:
            self._asked_at = time.monotonic()
        self._dirty = True
        if self.task is None:
            self.task = asyncio.get_running_loop().create_task(self._draw())

    def say(self, words: str) -> None:
        """Show words in place of the caption; none, and it is back."""
        if words != self.words:
            self.words = words
            self.soon()

    def join(self, viewer: Viewer) -> None:
        """Add a viewer and show it what is solved."""
        self.viewers.add(viewer)
        if self.solution is not None:
            viewer.draw(self.solved, self.solution, self.version)

    def everything(self) -> Message:
        """What a page that comes shows beside the scene."""
        return self._showing.everything(self.solved, self.solution, self.version, self.words)

    async def drawn(self, within: float | None = None) -> None:
        """Wait until nothing is to be drawn, at most for some seconds."""
        if self.task is not None:
            await asyncio.wait([self.task], timeout=within)

    async def _draw(self) -> None:
        self._drawn_at = time.monotonic()
        reporting = asyncio.create_task(self._report()) if self.sim.heavy else None
        try:
            while self._dirty:
                self._dirty, asked_at = False, self._asked_at
                try:
                    await self._solve(*self._newest())
                except Superseded:
                    continue
                for viewer in list(self.viewers) if self.solution is not None else ():
                    self._show(viewer)
                if self._telling.listeners:
                    self._telling.tell(self._showing.news(self.solved, self.solution, self.version, self.words))
                self._drawn_at = time.monotonic()
                self._latency.observe(self._drawn_at - asked_at)
                self._telling.tell_state_soon()
        except Exception:
            self._broke()
        finally:
            self.task = None
            if reporting is not None:
                reporting.cancel()

    async def _solve(self, params: Params, version: int) -> None:
        """Bring the solution up to a state. Raises `Superseded`."""
        begun = time.monotonic()
        try:
            self.solution = await (self._work_out(params) if self.sim.heavy else self._at_once(params))
            self.solved, self.version = params, version
            self._solving.observe(time.monotonic() - begun)
        except Superseded:
            raise
        except Exception as error:
            self._failed(params, error)

    async def _at_once(self, params: Params) -> Any:
        return self.sim.solve(params, *self._given)

    async def _work_out(self, params: Params) -> Any:
        """The same in the pool."""
        work = self.work = Work(self._wanted(time.monotonic() + PATIENCE), "Waiting until others' work is done")
        context = copy_context()
        context.run(at_work.set, work)
        try:
            async with self._turn:
                found = await self._solver.run(context.run, self.sim.solve, params, *self._given)
        finally:
            self.work = None
        if work.cancelled:
            raise Superseded
        self._solver.memory.take(self, found)
        return found

    def _wanted(self, until: float) -> Callable[[], bool]:
        """Unless a newer state waits, for longer than anybody should."""
        return lambda: not self._dirty or time.monotonic() < until

    def _show(self, viewer: Viewer) -> None:
        """Draw for one viewer; what goes wrong there is no matter of the others."""
        try:
            viewer.draw(self.solved, self.solution, self.version)
        except Exception:
            self._broke()

    def _broke(self) -> None:
        """Count, log and tell that a state can't be drawn; the session goes on."""
        metrics.FAILURES.labels(self.sim.slug, "draw").inc()
        log.exception("drawing %s failed in the state %s", self.sim.slug, self.solved.query())
        self._telling.tell(BROKEN)

    @property
    def before(self) -> Params:
        """The state to which a cancelled one gives way: the one that is drawn, or, at first, that of the sim."""
        first: Params = self.sim.params()
        return first if self.solution is None else self.solved

    async def _report(self) -> None:
        """Tell the pages how far the work is, once nothing was drawn for long, until something is."""
        told = False
        try:
            while True:
                await asyncio.sleep(REPORTED_EVERY)
                long = self.work is not None and time.monotonic() - self._drawn_at > LONG
                if long or told:
                    self._telling.tell(self._progress() if long else WORK_ENDED)
                told = long
        finally:
            if told:
                self._telling.tell(WORK_ENDED)

    def _progress(self) -> dict[str, Any]:
        assert self.work is not None
        cancel = self._newest()[0] != self.before
        return {"type": "work", "text": self.work.words, "done": self.work.done, "cancel": cancel}
