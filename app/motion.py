"""Plays a sim's motions: numbers glide to each step's values, eased, at up to 30 frames a second."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable, Mapping
from typing import Any

from sims.kit.params import Params
from sims.kit.sim import Step

FRAME = 1 / 30
PAUSE = 0.6
"""Seconds at each step when motion is reduced."""


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
            await asyncio.sleep(PAUSE if reduced else 0.0)
            continue
        begin = loop.time()
        while (fraction := (loop.time() - begin) / step.seconds) < 1.0:
            done = fraction if step.even else eased(fraction)
            yield {k: between(getattr(start, k), v, done) for k, v in step.changes.items()}
            await asyncio.sleep(FRAME)
        yield step.changes
