"""The states in which every sim is tested: defaults, each bound, each choice, each named state."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from sims import SIMS
from sims.kit.params import Params, choices, extra, numeric_fields
from sims.kit.sim import Sim

AnySim = Sim[Any, Any]


def states(sim: AnySim) -> Iterator[tuple[str, Params]]:
    """Name and parameters of each."""
    start = sim.params()
    yield "defaults", start
    for name, changes in sim.states.items():
        yield name, start.changed(changes)
    for chosen in _choices(start):
        yield from _at_bounds(chosen)


def _choices(start: Params) -> Iterator[Params]:
    """The defaults, and each word of each choice and each switch turned, one at a time."""
    yield start
    for name, field in type(start).model_fields.items():
        words: tuple[Any, ...] = choices(field)
        if extra(field).get("control") == "switch":
            words = (True, False)
        yield from (start.moved({name: word}) for word in words if word != getattr(start, name))


def _at_bounds(start: Params) -> Iterator[tuple[str, Params]]:
    differs = ", ".join(f"{k}={v}" for k, v in start.query_items().items()) or "defaults"
    if differs != "defaults":
        yield differs, start
    for name in numeric_fields(type(start)):
        value = getattr(start, name)
        for end, bound in zip(("least", "greatest"), start.bounds(name), strict=True):
            at_end = tuple(bound for _ in value) if isinstance(value, tuple) else bound
            yield f"{differs}, {end} {name}", start.moved({name: at_end})


ALL = [(sim, name, params) for sim in SIMS for name, params in states(sim)]
NAMES = [f"{sim.slug}: {name}" for sim, name, _ in ALL]
FEW = [case for case in ALL if "," not in case[1]]
"""Without the bounds: defaults, named states, choices."""
FEW_NAMES = [f"{sim.slug}: {name}" for sim, name, _ in FEW]
