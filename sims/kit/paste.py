"""Text of a person's own that becomes a state: pasted into a box, or from a file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Generic, TypeVar

from sims.kit import child
from sims.kit.params import Params

P = TypeVar("P", bound=Params)
LONGEST = 64 * 1024
"""Bytes of a text: what a request may have that isn't a file."""
LIMITS = child.Limits(memory=200_000_000, seconds=5.0, output=1_000_000)


@dataclass(frozen=True)
class Paste(Generic[P]):
    """A box for such a text, in the fold `group`; `example` stands in it while it is empty."""

    group: str
    title: str
    about: str
    """In a sentence, without its full stop: what can be understood."""
    example: str
    read: Callable[[str], Any]
    """From the text to what JSON holds. A function of a module: it runs in a child with limits. Raises ValueError in
    words for whoever pasted."""
    changes: Callable[[P, Any], Mapping[str, Any]]
    """What of a state changes by what was read, with lists where `read` gave tuples. Raises ValueError in words too."""
    endings: tuple[str, ...] = ()
    """How files end that such a text may come from."""
    says: Callable[[P, Any], str] = lambda _, __: "Taken."
    """What was understood, in a sentence: of the state that shows it, and what was read."""

    def found(self, text: str) -> Any:
        """What `read` makes of a text, in a child. Raises ValueError in words."""
        by = f"{self.read.__module__}:{self.read.__qualname__}"
        return child.read(f"{__name__}:understood", "", text.encode(), limits=LIMITS, by=by)["found"]


def understood(_: str, data: bytes, by: str) -> dict[str, Any]:
    """What a reader makes of a text; for the child."""
    module, _, name = by.partition(":")
    return {"found": getattr(import_module(module), name)(data.decode())}
