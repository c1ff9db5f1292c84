"""Every sim has the same rooms: who has read one finds their way in the others."""

from __future__ import annotations

import inspect
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from sims import SIMS
from sims.kit.sim import Sim

AnySim = Sim[Any, Any]
ROOT = Path(__file__).resolve().parents[2]
EACH = {"__init__", "params", "solution", "scene", "readouts", "actions"}
ELSEWHERE = {
    "model": "params and solution", "solve": "solution", "solving": "solution", "words": "readouts",
    "hands": "actions", "moves": "actions", "picture": "panes", "pictures": "panes", "bodies": "meshes",
    "figures": "scene or meshes", "utils": "what it is about", "helpers": "what it is about",
}  # fmt: skip
"""Names that a room had once, or might get, and how it is called."""
MOST_LINES = 300
each_sim = pytest.mark.parametrize("sim", SIMS, ids=[sim.slug for sim in SIMS])


def package(sim: AnySim) -> Path:
    return ROOT / "sims" / sim.slug.replace("-", "_")


def room_of(thing: Any) -> str:
    """The module, of those of its package, in which something stands."""
    module = inspect.getmodule(thing)
    assert isinstance(module, ModuleType)
    return module.__name__.rpartition(".")[2]


@each_sim
def test_the_rooms_are_there(sim: AnySim) -> None:
    names = {path.stem for path in package(sim).glob("*.py")}
    assert not EACH - names, f"sims/{package(sim).name} lacks {sorted(EACH - names)}"
    wrong = {f"{name}.py: call it {ELSEWHERE[name]}" for name in names & ELSEWHERE.keys()}
    assert not wrong


@each_sim
def test_everything_stands_in_its_room(sim: AnySim) -> None:
    assert room_of(sim.params) == "params"
    assert room_of(sim.solve) == "solution"
    assert room_of(sim.scene) == "scene"
    assert room_of(sim.readouts) == room_of(sim.describe) == "readouts"
    assert sim.panes is None or room_of(sim.panes) == "panes"
    topics = {path.stem for path in package(sim).glob("*.py")} - EACH
    for held in [*(action.run for action in sim.actions), *sim.handles.values()]:
        assert room_of(held) in {"actions", *topics}, held


@each_sim
def test_what_is_taught_stands_in_its_room(sim: AnySim) -> None:
    for challenge in sim.challenges:
        assert room_of(challenge.near) == "challenges", challenge.id
    scripts = {path.name for path in package(sim).glob("script_*")}
    assert scripts in (set(), {"script_numpy.py", "script_library.py"}), "both scripts, or none"
    assert {path.name for path in package(sim).glob("*.md")} <= {"lesson.md"}


@each_sim
def test_no_room_is_too_large(sim: AnySim) -> None:
    lines = {path.name: len(path.read_text().splitlines()) for path in package(sim).rglob("*.py")}
    too_large = {name: count for name, count in lines.items() if count > MOST_LINES}
    assert not too_large, f"part them by what they are about: {too_large}"
