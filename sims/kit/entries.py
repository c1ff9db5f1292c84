"""Controls of a list that grows and shrinks: one for each entry, a slider for a number, a dropdown for a letter."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import viser

from sims.kit.fields import Letters, Numbers
from sims.kit.offers import Offers
from sims.kit.viser_internals import set_property, set_value

Take = Callable[[Any], None]


def worded_entry(offers: Offers[Any], name: str, k: int) -> str:
    """Words beside the control of one entry, with the unit."""
    kind = offers.params.kinds[name]
    unit = kind.unit if isinstance(kind, Numbers) else ""
    return offers.entry_label(name, k) + (f" ({unit})" if unit else "")


class Entries:
    """As many controls as the list may have entries; those of entries that there aren't are hidden."""

    def __init__(
        self, gui: viser.GuiApi, offers: Offers[Any], name: str, shared: Mapping[str, Any],
        listen: Callable[[Any, Take], None], change: Callable[[Mapping[str, Any]], None],
    ) -> None:  # fmt: skip
        kind = offers.params.kinds[name]
        assert isinstance(kind, Numbers | Letters)
        self.name = name
        self._labels = kind.labels if isinstance(kind, Letters) else None
        self._letters = {shown: letter for letter, shown in (self._labels or {}).items()}
        self._absent: Any = min(kind.labels) if isinstance(kind, Letters) else min(max(0.0, kind.low), kind.high)
        """What a hidden control says, so that every page says the same."""
        self._handles = [self._add(gui, offers, k, shared) for k in range(kind.most)]
        self._count = len(self._handles)
        for k, handle in enumerate(self._handles):
            listen(handle, partial(self._taken, change, f"{name}.{k}"))

    def _add(self, gui: viser.GuiApi, offers: Offers[Any], k: int, shared: Any) -> Any:
        label = worded_entry(offers, self.name, k)
        start = self._shown(self._absent)
        if self._labels:
            return gui.add_dropdown(label, tuple(self._letters), initial_value=start, **shared)
        return gui.add_slider(label, *offers.bounds(self.name), offers.increment(self.name), start, **shared)

    def _taken(self, change: Callable[[Mapping[str, Any]], None], entry: str, shown: Any) -> None:
        change({entry: self._letters.get(shown, shown)})

    def _shown(self, value: Any) -> Any:
        return self._labels[value] if self._labels else value

    def draw(self, offers: Offers[Any]) -> None:
        """Show the entries of a state."""
        values = offers.entries(self.name)
        for k, handle in enumerate(self._handles):
            set_value(handle, self._shown(values[k] if k < len(values) else self._absent))

    def reword(self, offers: Offers[Any]) -> None:
        """Show as many controls as there are entries, and what each is called."""
        for k, handle in enumerate(self._handles):
            set_property(handle, "label", worded_entry(offers, self.name, k))
        count = len(offers.entries(self.name))
        if count != self._count:
            self._count = count
            for k, handle in enumerate(self._handles):
                handle.visible = k < count
