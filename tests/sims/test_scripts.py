"""The scripts that learners take away: run at many states, they find what the sim finds."""

from __future__ import annotations

import contextlib
import io
import random
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.scripts import LANGUAGES, Script, of_state, script
from geometry import GeometryError
from sims import SIMS
from sims.kit.fields import Choice, Switch, Vector
from sims.kit.params import Params
from sims.kit.sim import Sim, jsonable

AnySim = Sim[Any, Any]
EACH = [
    (sim, language, found) for sim in SIMS for language in LANGUAGES if (found := script(sim, language)) is not None
]
each_script = pytest.mark.parametrize(("sim", "language", "found"), EACH, ids=[f"{s.slug}: {n}" for s, n, _ in EACH])
STATES = 10
FEWEST = 4
"""Results of the sim that a script must find too."""
WITHIN, SINGLE = 1e-9, 1e-6
"""How near; and of clouds, which are shown in single precision."""
EITHER = {"quaternion", "q", "q_total", "lost_axis", "normal"}
"""What is the same with the opposite sign, in a library at least."""
CLOUDS: tuple[Mapping[str, Any], ...] = (
    {"selected": 50_000, "neighbors": 30}, {"dataset": "statue", "voxel_size": 0.05, "selected": 77},
    {"dataset": "two-scans", "voxel_size": 0.2, "selected": 9},
    {"dataset": "statue", "voxel_size": 0.05, "process": "outliers", "selected": 5},
)  # fmt: skip


def states(sim: AnySim) -> Iterator[Params]:
    """Defaults, the named states, the singular ones among them, and random ones."""
    yield sim.params()
    if sim.heavy:
        yield from (sim.params().changed(each) for each in CLOUDS)
        return
    yield from (sim.params().changed(changes) for changes in sim.states.values())
    chance = random.Random(sim.slug)
    for _ in range(STATES):
        yield _random(sim.params(), chance)


def _random(start: Params, chance: random.Random) -> Params:
    """Words first: what numbers are allowed may follow from them."""
    words = {
        name: chance.choice(list(kind.words) if isinstance(kind, Choice) else [True, False])
        for name, kind in start.kinds.items()
        if isinstance(kind, Choice | Switch) and not kind.hidden
    }
    state = start.moved(words)
    numbers: dict[str, Any] = {}
    for name, kind in state.numeric.items():
        value = getattr(state, name)
        if kind.hidden or value is None:
            continue
        ranges = state.ranges(name) if isinstance(kind, Vector) else [state.bounds(name)] * np.size(value)
        drawn = [chance.uniform(*each) for each in ranges]
        numbers[name] = tuple(drawn) if isinstance(value, tuple) else type(value)(drawn[0])
    return state.moved(numbers)


def undecided(params: Params, solution: Any) -> bool:
    """Whether rounding says how far away rays meet, or a quotient is larger than numbers go."""
    return getattr(solution, "parallax_angle", 1.0) < 1e-6 or 0.0 < getattr(params, "w", 1.0) < 1e-300


def run(found: Script, params: Params) -> dict[str, Any]:
    """What a script's names are in the end."""
    names: dict[str, Any] = {}
    with contextlib.redirect_stdout(io.StringIO()) as said, warnings.catch_warnings():
        warnings.simplefilter("error")
        exec(compile(of_state(found, params), "script", "exec"), names)
    assert said.getvalue(), "it prints what it finds"
    return names


def shared(names: Mapping[str, Any], params: Params, solution: Any) -> dict[str, tuple[Any, Any]]:
    """What both have: by its name the script's value and the sim's; what is selected has fields of its own."""
    theirs = jsonable(solution)
    theirs = {**(theirs.get("selected") or {}), **theirs}
    return {
        name: (jsonable(plain(value)), theirs[name])
        for name, value in names.items()
        if name in theirs and name not in params.kinds
    }


def plain(value: Any) -> Any:
    return (
        np.asarray(value, dtype=float)
        if isinstance(value, list) and len(value) and not isinstance(value[0], dict)
        else value
    )


def differ(ours: Any, theirs: Any, within: float) -> bool:
    """Whether two values of a name are others; of what is named within them, only what the script has counts."""
    if isinstance(ours, dict):
        return any(differ(value, theirs[name], within) for name, value in ours.items())
    if isinstance(ours, list) and ours and isinstance(ours[0], dict):
        named = {each["name"]: each for each in theirs}
        return any(differ(each, named[each["name"]], within) for each in ours)
    if ours is None or theirs is None or isinstance(ours, str):
        return bool(ours != theirs)
    a, b = np.asarray(ours, dtype=float), np.asarray(theirs, dtype=float)
    return a.shape != b.shape or not np.allclose(a, b, rtol=within, atol=within * max(1.0, float(np.abs(b).max())))


def opposite(value: Any) -> Any:
    return None if value is None else (-np.asarray(value, dtype=float)).tolist()


@each_script
def test_a_script_finds_what_the_sim_finds(
    sim: AnySim, language: str, found: Script, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    most, within = 0, SINGLE if sim.heavy else WITHIN
    for params in states(sim):
        try:
            solution = sim.solve(params)
        except GeometryError:
            continue
        if undecided(params, solution):
            continue
        for name, make in sim.downloads.items():
            (tmp_path / name).write_bytes(make(params))
        both = shared(run(found, params), params, solution)
        wrong = {
            name: pair
            for name, pair in both.items()
            if differ(*pair, within) and not (name in EITHER and not differ(opposite(pair[0]), pair[1], within))
        }
        assert not wrong, params.query()
        most = max(most, len(both))
    assert most >= FEWEST, f"only {most} of the sim's results have a name in it"
