"""Plays a sim's motions: numbers glide to each step's values, eased, at up to 30 frames a second."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Coroutine, Iterator, Mapping
from typing import Any

from sims.kit.params import Params
from sims.kit.sim import Step

FRAME = 1 / 30
PAUSE = 0.6
"""Seconds at each step when motion is reduced; one with words takes its own time, so that they can be read."""


def eased(fraction: float) -> float:
    """Smooth start and stop."""
    return fraction * fraction * (3.0 - 2.0 * fraction)


def between(a: Any, b: Any, fraction: float) -> Any:
    """A number or vector on the way from a to b; b for anything else."""
    if isinstance(a, tuple) and isinstance(b, tuple) and len(a) == len(b):
        return tuple(between(p, q, fraction) for p, q in zip(a, b, strict=True))
    if isinstance(a, bool) or isinstance(b, bool) or not isinstance(a, (int, float)) or not isinstance(b, (int, float)):
        return b
    on_the_way = a + (b - a) * fraction
    return round(on_the_way) if isinstance(a, int) and isinstance(b, int) else on_the_way


def gliding(start: Params, target: Params) -> dict[str, Any]:
    """The target's numbers that can glide there, as their kinds have it."""
    found = {name: (getattr(start, name), getattr(target, name)) for name in target.numeric}
    return {name: b for name, (a, b) in found.items() if target.kinds[name].glides(a, b)}


async def play(
    steps: AsyncIterator[Step], now: Callable[[], Params], *, reduced: bool
) -> AsyncIterator[Mapping[str, Any]]:
    """Yield changes frame by frame; under reduced motion only each step's end, with a pause."""
    loop = asyncio.get_running_loop()
    async for step in steps:
        start = now()
        if reduced or step.seconds <= 0.0:
            yield step.changes
            pause = max(PAUSE, step.seconds) if step.words else PAUSE
            await asyncio.sleep(pause if reduced else 0.0)
            continue
        begin = loop.time()
        while (fraction := (loop.time() - begin) / step.seconds) < 1.0:
            done = fraction if step.even else eased(fraction)
            yield {k: between(getattr(start, k), v, done) for k, v in step.changes.items()}
            await asyncio.sleep(FRAME)
        yield step.changes


class Motion:
    """The motion of a session, if one runs.

    `following` finds the next step, `now` the state, `show` has changes drawn, `say` has each step's words shown until
    others come, or none; what goes wrong is told to `failed`.
    """

    def __init__(
        self, following: Callable[[Iterator[Step]], Coroutine[Any, Any, Step | None]], now: Callable[[], Params],
        show: Callable[[Mapping[str, Any]], Coroutine[Any, Any, None]], say: Callable[[str], None],
        failed: Callable[[Exception], None],
    ) -> None:  # fmt: skip
        self._following = following
        self._now = now
        self._show = show
        self._say = say
        self._failed = failed
        self.reduced = False
        self.task: asyncio.Task[None] | None = None
        """As long as a motion runs."""

    def begin(self, steps: Iterator[Step]) -> None:
        """Play a motion, in place of one that runs."""
        self.stop()
        self.task = asyncio.get_running_loop().create_task(self._play(steps))

    def stop(self) -> None:
        """End a running motion where it is."""
        if self.task is not None:
            self.task.cancel()
            self._ended()

    async def _play(self, steps: Iterator[Step]) -> None:
        try:
            async for changes in play(self._each(steps), self._now, reduced=self.reduced):
                await self._show(changes)
        except Exception as error:
            self._failed(error)
        self._ended()

    def _ended(self) -> None:
        self.task = None
        self._say("")

    async def _each(self, steps: Iterator[Step]) -> AsyncIterator[Step]:
        while (step := await self._following(steps)) is not None:
            self._say(step.words)
            yield step
