"""What solutions take of a server's memory: all together no more than it has."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

Held = Mapping[int, int]
"""Bytes of arrays by their identity: what several solutions share counts once."""


class NoRoom(MemoryError):
    """A solution is given up again, because all of them would take too much memory."""

    def __init__(self, size: int) -> None:
        words = f"The server has no room for this just now ({size / 1e6:,.0f} MB)."
        super().__init__(f"{words} Take a smaller cloud or larger voxels, or try again later.")


def held(solution: Any) -> dict[int, int]:
    """What a solution holds."""
    return {id(array): array.nbytes for array in _arrays(solution)}


def _arrays(value: Any) -> Iterator[np.ndarray[Any, Any]]:
    if isinstance(value, np.ndarray):
        while isinstance(value.base, np.ndarray):  # views hold all of what they look at
            value = value.base
        yield value
    elif is_dataclass(value) and not isinstance(value, type):
        for field in fields(value):
            yield from _arrays(getattr(value, field.name))
    elif isinstance(value, Mapping):
        for each in value.values():
            yield from _arrays(each)
    elif isinstance(value, (tuple, list)):
        for each in value:
            if not isinstance(each, (int, float, str)):
                yield from _arrays(each)


class Memory:
    """The room of all solutions that take long."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._held: dict[object, Held] = {}

    def take(self, owner: object, solution: Any) -> None:
        """Keep what the owner's newest solution holds, in place of the one before. Raises NoRoom; that one stays."""
        mine = held(solution)
        others = self._together(each for who, each in self._held.items() if who is not owner)
        if (size := sum((others | mine).values())) > self._most and size > sum(others.values()):
            raise NoRoom(sum(mine.values()))
        self._held[owner] = mine

    def free(self, owner: object) -> None:
        """Forget what an owner holds."""
        self._held.pop(owner, None)

    @property
    def bytes(self) -> int:
        """Held by all."""
        return sum(self._together(self._held.values()).values())

    @staticmethod
    def _together(all_: Iterable[Held]) -> dict[int, int]:
        found: dict[int, int] = {}
        for each in all_:
            found |= each
        return found
