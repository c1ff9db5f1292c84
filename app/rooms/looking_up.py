"""What a heavy sim's buttons, handles and clicks mean is found out in the pool."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

from app.rooms.solver import Solver


class LookingUp:
    """One thing is found out at a time, in a session's `turn`; of what is asked meanwhile only the last counts."""

    def __init__(self, solver: Solver, turn: asyncio.Lock, failed: Callable[[Exception], None]) -> None:
        self._solver = solver
        self._turn = turn
        self._failed = failed
        self._asked: tuple[Callable[[], Any], Callable[[Any], None]] | None = None
        self.task: asyncio.Task[None] | None = None
        """As long as something is asked."""

    def ask(self, find: Callable[[], Any], take: Callable[[Any], None]) -> None:
        """Have something found in the pool, and taken on the event loop."""
        self._asked = find, take
        if self.task is None:
            self.task = asyncio.get_running_loop().create_task(self._find())

    async def _find(self) -> None:
        try:
            while self._asked is not None:
                (find, take), self._asked = self._asked, None
                try:
                    async with self._turn:
                        found = await self._solver.run(find)
                    take(found)
                except Exception as error:
                    self._failed(error)
        finally:
            self.task = None
