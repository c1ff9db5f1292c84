"""Goals that a learner reaches with a sim: checked by the mathematics, with how near one is in words."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Generic, NamedTuple, TypeVar

from sims.kit.params import Params

P = TypeVar("P", bound=Params)
S = TypeVar("S")


class Progress(NamedTuple):
    """How near a state is to a goal: 0 (far) to 1 (there), and in words, as in "12° to go"."""

    fraction: float
    words: str

    @property
    def solved(self) -> bool:
        """Whether the goal is reached."""
        return self.fraction >= 1.0


@dataclass(frozen=True, kw_only=True)
class Challenge(Generic[P, S]):
    """A goal, and who says how near a state is to it.

    `near` gets parameters and solution; where the goal is a `path` also those of the state before, or None twice.
    """

    id: str
    title: str
    goal: str
    """What is to be reached, in a sentence."""
    near: Callable[..., Progress]
    path: bool = False
    solves: Mapping[str, Any]
    """Changes of the defaults that reach it, for the tests; of a path, its last state."""
    misses: Sequence[Mapping[str, Any]]
    """States that nearly reach it, and don't."""
    starts: Mapping[str, Any] | None = None
    """The state before, where the goal is a path."""

    def progress(self, params: P, solution: S, before: tuple[P, S] | None = None) -> Progress:
        """How near a state is; `before` is the one that was seen before it."""
        found = self.near(params, solution, *(before or (None, None))) if self.path else self.near(params, solution)
        return Progress(min(max(found.fraction, 0.0), 1.0), found.words)


def nearer(left: float, far: float, within: float, words: str, done: str) -> Progress:
    """Progress where `left` is what is left to go, `far` where it begins to count; reached `within` a tolerance."""
    if left <= within:
        return Progress(1.0, done)
    return Progress(min(max(1.0 - left / far, 0.0), 0.99), words)


def told(challenges: Sequence[Challenge[P, S]]) -> list[dict[str, str]]:
    """What a page says of challenges: plain values for JSON."""
    return [{"id": each.id, "title": each.title, "goal": each.goal} for each in challenges]


def checked(
    challenges: Sequence[Challenge[P, S]], params: P, solution: S, before: tuple[P, S] | None = None
) -> dict[str, dict[str, Any]]:
    """Whether each challenge is solved, how near that is, and what is said of it: plain values for JSON."""
    found = {each.id: each.progress(params, solution, before) for each in challenges}
    return {
        name: {"solved": progress.solved, "progress": round(progress.fraction, 3), "words": progress.words}
        for name, progress in found.items()
    }
