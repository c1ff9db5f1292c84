"""One parameter that goes from a value to another one, state by state."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Any

from sims.kit.fields import Numbers, OptionalNumber, Slider
from sims.kit.fields.numbers import Number
from sims.kit.params import Params
from sims.kit.readout import quantity


@dataclass(frozen=True)
class Swept:
    """A number that a sweep can lead: a parameter, or as `angles.2` an entry of one."""

    name: str
    label: str
    low: float
    high: float
    value: float
    step: float
    unit: str
    whole: bool

    def values(self, begin: float, end: float, most: int) -> list[float]:
        """From one to the other, evenly; whole ones each once."""
        found = [begin + (end - begin) * k / (most - 1) for k in range(most)]
        return list(dict.fromkeys(float(round(v)) for v in found)) if self.whole else [*found[:-1], end]

    def state(self, params: Params, value: float) -> Params:
        """The state in which the parameter has a value."""
        return params.moved({self.name: int(value) if self.whole else value})

    def words(self, value: float) -> str:
        """The value for people, with a digit more than a step of its slider has."""
        digits = 0 if self.whole else max(0, 1 - math.floor(math.log10(self.step)))
        return quantity(value, self.unit, min(digits, 4))


def sweepable(params: Params, idle: Collection[str] = ()) -> Iterator[Swept]:
    """The numbers of a state that a sweep can lead, sliders first; without those that are `idle` in it."""
    names = [name for name in params.arranged if name in params.numeric and name not in idle]
    for name in sorted(names, key=lambda name: not isinstance(params.kinds[name], Slider)):
        kind, value = params.kinds[name], getattr(params, name)
        if isinstance(kind, Number) and not isinstance(kind, OptionalNumber) and value is not None:
            yield _swept(params, name, params.label(name), value, 0)
        elif isinstance(kind, Numbers):
            for k, entry in enumerate(value):
                yield _swept(params, f"{name}.{k}", params.entry_label(name, k), entry, k)


def _swept(params: Params, name: str, label: str, value: float, k: int) -> Swept:
    field = name.partition(".")[0]
    kind: Any = params.numeric[field]
    low, high = params.ranges(field)[k]
    whole = isinstance(value, int)
    return Swept(name, label, low, high, float(value), params.increment(field), kind.unit, whole)
