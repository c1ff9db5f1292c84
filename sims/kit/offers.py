"""What the controls of a state offer: by itself, what its parameters say."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any, Generic, TypeVar

from sims.kit.params import Params

P = TypeVar("P", bound=Params)


class Offers(Generic[P]):
    """Bounds, steps, words and entries of a state's controls.

    A sim whose controls depend on more than the parameters, such as on a file or on what was worked out, has one of its
    own.
    """

    def __init__(self, params: P, solution: object = None) -> None:
        self.params = params

    def form(self) -> tuple[Any, ...]:
        """All that labels, bounds and marks depend on."""
        return self.params.form()

    def idle(self) -> Collection[str]:
        """Names of the controls and buttons that mean nothing in this state, as its `form` says: they aren't shown."""
        return ()

    def bounds(self, name: str) -> tuple[float, float]:
        """Least and greatest value that a control goes to."""
        return self.params.bounds(name)

    def increment(self, name: str) -> float:
        """By how much a step of a slider changes a number."""
        return self.params.increment(name)

    def options(self, name: str) -> Mapping[Any, str]:
        """What a dropdown offers: each value, and how it is shown."""
        return self.params.options(name)

    def label(self, name: str) -> str:
        """Words beside a control."""
        return self.params.label(name)

    def about(self, name: str) -> str:
        """What a control is for."""
        return self.params.about(name)

    def entries(self, name: str) -> Any:
        """The entries of a list, which have a control each; None for a number without one."""
        return getattr(self.params, name)

    def entry_label(self, name: str, k: int) -> str:
        """Words beside the control of the k-th entry, from 0, of a list."""
        return self.params.entry_label(name, k)

    def moved(self, changes: Mapping[str, Any]) -> P:
        """The state after a control moved: what `Params.moved` does."""
        return self.params.moved(changes)
