"""A pointer that holds a node: where the node would go."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from sims.kit.types import Place


def listen(handle: Any, drag: Callable[[Place], None]) -> None:
    """Tell `drag` the place (world, metres) to which the pointer pulls a node of viser's.

    The node moves in the plane that faces the viewer; with Shift held, along the world axis nearest to the pull.
    """
    offset = np.zeros(3)
    origin = np.zeros(3)

    def moved(event: Any, straight: bool) -> None:
        nonlocal offset, origin
        if event.phase == "start":
            origin = np.array(handle.position)
            offset = origin - np.array(event.start_position)
        target = np.array(event.end_position) + offset
        if straight:
            pull = target - origin
            keep = np.argmax(np.abs(pull))
            target = origin + np.where(np.arange(3) == keep, pull, 0.0)
        drag((float(target[0]), float(target[1]), float(target[2])))

    @handle.on_drag("left")  # type: ignore[untyped-decorator]
    async def _(event: Any) -> None:
        moved(event, straight=False)

    @handle.on_drag("left", modifier="shift")  # type: ignore[untyped-decorator]
    async def _(event: Any) -> None:
        moved(event, straight=True)
