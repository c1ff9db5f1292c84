"""Answers that take long: one at a time, each address in its turn, and only as long as somebody waits for them.

What is quick doesn't come here: it is answered at once.
"""

from __future__ import annotations

import asyncio
from collections import Counter, deque
from collections.abc import Callable, Coroutine
from contextvars import copy_context
from typing import Any, TypeVar

from starlette.requests import Request

from app.proxies import address_of
from app.rooms.registry import Sessions
from app.rooms.solver import workers
from sims.kit.params import Params
from sims.kit.progress import Work, at_work
from sims.kit.sim import Sim

T = TypeVar("T")
EACH, ALL = 40, 200
"""Answers that one address, which may be that of a whole school, and all together may wait for."""
LONGEST = 30.0
"""Seconds that one may take."""
RETRY = 10
"""Seconds after which it is worth another try."""


class Busy(Exception):
    """Why there is no answer, and the status that says so."""

    def __init__(self, status: int, words: str) -> None:
        super().__init__(words)
        self.status = status


class Gone(Exception):
    """Nobody waits any more."""


class Answers:
    """Works answers out beside one event loop."""

    def __init__(self) -> None:
        self._pool = workers("answer", 1)
        self._asked: Counter[str] = Counter()
        """How many each address waits for."""
        self._turns: dict[str, deque[asyncio.Future[None]]] = {}
        """Those that haven't begun, by address; the first address has the next turn."""
        self._busy = False

    async def find(self, address: str, find: Callable[[], T], gone: Coroutine[Any, Any, None]) -> T:
        """What `find` makes. Raises `Busy`; or `Gone` when `gone` has ended, for then its caller has left."""
        leaving = asyncio.ensure_future(gone)
        try:
            turn = self._line_up(address)
            try:
                await asyncio.wait((turn, leaving), return_when=asyncio.FIRST_COMPLETED)
                if leaving.done():
                    raise Gone
            except BaseException:
                self._leave(address, turn)
                raise
            return await self._work(address, turn, find, leaving)
        finally:
            leaving.cancel()

    def _line_up(self, address: str) -> asyncio.Future[None]:
        if self._asked[address] >= EACH:
            raise Busy(429, f"This address waits for {EACH} answers already; ask again when some of them have come.")
        if self._asked.total() >= ALL:
            raise Busy(503, f"This server has {ALL} answers to work out already; ask again in a moment.")
        turn = asyncio.get_running_loop().create_future()
        self._turns.setdefault(address, deque()).append(turn)
        self._asked[address] += 1
        self._next()
        return turn

    async def _work(
        self, address: str, turn: asyncio.Future[None], find: Callable[[], T], leaving: asyncio.Future[None]
    ) -> T:
        work, context = Work(), copy_context()
        context.run(at_work.set, work)
        working = asyncio.get_running_loop().run_in_executor(self._pool, context.run, find)

        def ended(_: object) -> None:
            if not working.cancelled():
                working.exception()  # nobody else may ask for it
            self._leave(address, turn)

        working.add_done_callback(ended)
        try:
            await asyncio.wait((working, leaving), timeout=LONGEST, return_when=asyncio.FIRST_COMPLETED)
        finally:
            work.cancelled = True
        if working.done():
            return working.result()
        if leaving.done():
            raise Gone
        raise Busy(503, f"This took longer than {LONGEST:g} s and was given up. A larger voxel_size makes it quicker.")

    def _leave(self, address: str, turn: asyncio.Future[None]) -> None:
        self._asked -= Counter([address])  # which forgets addresses that wait for nothing
        if turn.done():
            self._busy = False
        else:
            self._turns[address].remove(turn)
            if not self._turns[address]:
                del self._turns[address]
        self._next()

    def _next(self) -> None:
        """Begin with the next address's first answer; what else it waits for comes after everybody else's turn."""
        if self._busy or not self._turns:
            return
        address = next(iter(self._turns))
        waiting = self._turns.pop(address)
        waiting.popleft().set_result(None)
        if waiting:
            self._turns[address] = waiting
        self._busy = True

    def close(self) -> None:
        """End the pool."""
        self._pool.shutdown(wait=False, cancel_futures=True)


async def solved(sessions: Sessions, answers: Answers, asker: str, sim: Sim[Any, Any], params: Params) -> Any:
    """The solution of a state for somebody who stays; where it takes long, in the turn of who asks."""
    if not sim.heavy:
        return sim.solve(params, *sessions.given(sim))
    return await answers.find(asker, lambda: sim.solve(params, *sessions.given(sim)), _stays())


async def _stays() -> None:
    """Never ends: whoever gives up cancels it."""
    await asyncio.Event().wait()


async def found_for(request: Request, answers: Answers, find: Callable[[], T]) -> T:
    """What `find` makes, in the turn of a request's address and as long as its caller is there."""
    return await answers.find(address_of(request), find, _left(request))


async def _left(request: Request) -> None:
    """Ends when the caller has gone."""
    while (await request.receive())["type"] != "http.disconnect":
        pass
