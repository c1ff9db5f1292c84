"""What a heavy sim's buttons, handles, clicks and pointers mean is found out in the pool."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from typing import Any

from app.rooms.solver import Solver

MOST = 32
"""Presses that may wait."""


class LookingUp:
    """One thing is found out at a time, in a session's `turn`. Each press of a button counts, of all else the last."""

    def __init__(self, solver: Solver, turn: asyncio.Lock, failed: Callable[[Exception], None]) -> None:
        self._solver = solver
        self._turn = turn
        self._failed = failed
        self._asked: deque[tuple[Callable[[], Any], Callable[[Any], None], str]] = deque(maxlen=MOST)
        self.task: asyncio.Task[None] | None = None
        """As long as something is asked."""

    def ask(self, find: Callable[[], Any], take: Callable[[Any], None], kind: str = "") -> None:
        """Have something found in the pool, and taken on the event loop; in place of one of its kind that waits."""
        if kind and self._asked and self._asked[-1][2] == kind:
            self._asked.pop()
        self._asked.append((find, take, kind))
        if self.task is None:
            self.task = asyncio.get_running_loop().create_task(self._find())

    async def _find(self) -> None:
        try:
            while self._asked:
                find, take, _ = self._asked.popleft()
                try:
                    async with self._turn:
                        found = await self._solver.run(find)
                    take(found)
                except Exception as error:
                    self._failed(error)
        finally:
            self.task = None
