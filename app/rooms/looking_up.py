"""What a heavy sim's buttons, handles, clicks and pointers mean is found out in the pool."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from app.rooms.solver import Solver

MOST = 32
"""Presses that may wait; the first give way to later ones."""
Asked = tuple[Callable[[], Any], Callable[[Any], None], str]


class LookingUp:
    """One thing is found out at a time, in a session's `turn`.

    Each press of a button (its kind is empty) counts; of all else that waits between two presses, the last of its kind.
    """

    def __init__(self, solver: Solver, turn: asyncio.Lock, failed: Callable[[Exception], None]) -> None:
        self._solver = solver
        self._turn = turn
        self._failed = failed
        self._asked: list[Asked] = []
        self.task: asyncio.Task[None] | None = None
        """As long as something is asked."""

    def ask(self, find: Callable[[], Any], take: Callable[[Any], None], kind: str = "") -> None:
        """Have something found in the pool, and taken on the event loop; in place of one of its kind that waits."""
        presses = [k for k, (*_, waiting) in enumerate(self._asked) if not waiting]
        since = presses[-1] + 1 if presses else 0
        alike = [k for k, (*_, waiting) in enumerate(self._asked[since:], since) if waiting == kind]
        if alike:  # it keeps its turn, or of two kinds the one that comes more often would never have one
            self._asked[alike[0]] = find, take, kind
        else:
            if not kind and len(presses) == MOST:
                del self._asked[: presses[0] + 1]
            self._asked.append((find, take, kind))
        if self.task is None:
            self.task = asyncio.get_running_loop().create_task(self._find())

    async def _find(self) -> None:
        try:
            while self._asked:
                find, take, _ = self._asked.pop(0)
                try:
                    async with self._turn:
                        found = await self._solver.run(find)
                    take(found)
                except Exception as error:
                    self._failed(error)
        finally:
            self.task = None
