"""The states in which every sim is tested: defaults, each bound, each choice, each named state."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from sims import SIMS
from sims.kit.fields import Choice, Switch, Vector
from sims.kit.params import Params
from sims.kit.sim import Sim

AnySim = Sim[Any, Any]


def few(sim: AnySim) -> Iterator[tuple[str, Params]]:
    """Name and parameters of the defaults, each named state and each choice."""
    start = sim.params()
    yield "defaults", start
    yield from ((name, start.changed(changes)) for name, changes in sim.states.items())
    yield from ((_differs(chosen), chosen) for chosen in _choices(start))


def bounds(sim: AnySim) -> Iterator[tuple[str, Params]]:
    """Each number at both its bounds; and for each choice, all numbers at their least and at their greatest."""
    start: Params = sim.params()
    numbers = start.numeric
    for end in (0, 1):
        for name in numbers:
            yield f"{ENDS[end]} {name}", start.moved({name: _at_end(start, name, end)})
        for chosen in _choices(start):
            extremes = {name: _at_end(chosen, name, end) for name in numbers}
            yield f"{_differs(chosen)}, all {ENDS[end]}", chosen.moved(extremes)


ENDS = ("least", "greatest")


def _at_end(params: Params, name: str, end: int) -> Any:
    value, bound, kind = getattr(params, name), params.bounds(name)[end], params.kinds[name]
    if value is None and isinstance(kind, Vector):
        return tuple(bounds[end] for bounds in kind.each)
    return tuple(bound for _ in value) if isinstance(value, tuple) else bound


def _choices(start: Params) -> Iterator[Params]:
    """Each other word of each choice and each switch turned, one at a time."""
    for name, kind in start.kinds.items():
        words = kind.words if isinstance(kind, Choice) else (True, False) if isinstance(kind, Switch) else ()
        yield from (start.moved({name: word}) for word in words if word != getattr(start, name))


def _differs(params: Params) -> str:
    """In which parameters a state isn't the default."""
    return ", ".join(f"{name}={text}" for name, text in params.query_items().items()) or "defaults"


FEW = [(sim, name, params) for sim in SIMS for name, params in few(sim)]
FEW_NAMES = [f"{sim.slug}: {name}" for sim, name, _ in FEW]
ALL = [*FEW, *((sim, name, params) for sim in SIMS for name, params in bounds(sim))]
NAMES = [f"{sim.slug}: {name}" for sim, name, _ in ALL]


SOLUTIONS: dict[Params, Any] = {}


def solved(sim: AnySim, params: Params) -> Any:
    """The solution of a state, which is found once for all tests of a process."""
    if params not in SOLUTIONS:
        library = () if sim.files is None else (sim.files.library(None, 1),)
        SOLUTIONS[params] = sim.solve(params, *library)
    return SOLUTIONS[params]
