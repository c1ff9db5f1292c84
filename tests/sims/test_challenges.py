"""Every challenge of the registry: what solves it, what doesn't, and how near it says that states are."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

import pytest

from app.routes import links
from sims import SIMS
from sims.kit.challenge import Challenge, Progress, checked
from sims.kit.fields import Numeric
from sims.kit.params import Params
from sims.kit.sim import Sim, jsonable
from tests.sims import cases

AnySim = Sim[Any, Any]
AnyChallenge = Challenge[Any, Any]
CASES = [(sim, each) for sim in SIMS for each in sim.challenges]
each_sim = pytest.mark.parametrize("sim", SIMS, ids=lambda sim: sim.slug)
each_challenge = pytest.mark.parametrize(
    ("sim", "challenge"), CASES, ids=[f"{sim.slug}: {each.id}" for sim, each in CASES]
)


def solved(sim: AnySim, params: Params) -> tuple[Params, Any]:
    """A state with its solution."""
    return params, cases.solved(sim, params)


def opening(sim: AnySim) -> Params:
    """What a link without parameters opens."""
    params: Params = sim.params(**sim.params.opening)
    return params


def at(sim: AnySim, challenge: AnyChallenge, changes: Mapping[str, Any]) -> Progress:
    """How near some changes of the defaults are; of a path, coming from where it starts."""
    before = None if challenge.starts is None else solved(sim, sim.params().changed(challenge.starts))
    return challenge.progress(*solved(sim, sim.params().changed(changes)), before)


def found(sim: AnySim, challenge: AnyChallenge) -> Iterator[Progress]:
    """What is said in the states that the challenge names and in those of the sim."""
    yield challenge.progress(*solved(sim, opening(sim)))
    for changes in (challenge.solves, *challenge.misses, *sim.states.values()):
        yield at(sim, challenge, changes)


def differ_in_numbers_alone(sim: AnySim, challenge: AnyChallenge, miss: Mapping[str, Any]) -> bool:
    """Whether a miss becomes a solution by moving numbers: it is near then, by its own measure."""
    start = sim.params()
    one, other = start.changed(challenge.solves), start.changed(miss)
    moved = [name for name in type(start).model_fields if getattr(one, name) != getattr(other, name)]
    return all(isinstance(start.kinds[name], Numeric) for name in moved)


@each_sim
def test_a_sim_has_two_to_four_challenges_with_names_of_their_own(sim: AnySim) -> None:
    ids = [each.id for each in sim.challenges]
    assert 2 <= len(ids) <= 4
    assert len({*ids}) == len(ids)
    assert all(re.fullmatch(r"[a-z]+(-[a-z0-9]+)*", each) for each in ids)
    assert len({each.title for each in sim.challenges}) == len(ids)


@each_challenge
def test_it_is_solved_by_what_it_says_solves_it(sim: AnySim, challenge: AnyChallenge) -> None:
    assert at(sim, challenge, challenge.solves).solved
    assert challenge.path == (challenge.starts is not None), "a path has a start, and nothing else has one"


@each_challenge
def test_what_is_reached_can_be_sent_as_a_link(sim: AnySim, challenge: AnyChallenge) -> None:
    state = sim.params().changed(challenge.solves)
    again = links.read(sim, [*state.query_items().items(), ("challenge", challenge.id)])
    assert again == state


@each_challenge
def test_a_path_is_not_its_end_alone(sim: AnySim, challenge: AnyChallenge) -> None:
    if challenge.path:
        assert not challenge.progress(*solved(sim, sim.params().changed(challenge.solves))).solved


def test_a_path_may_come_from_an_arm_of_fewer_joints() -> None:
    sim, path = next(case for case in CASES if case[1].id == "two-orders")
    arm = {"axes": "zzy", "lengths": (1, 0, 0), "swap": 2}
    fewer = {"axes": "zy", "lengths": (0, 1), "angles": (30, 40)}
    before, after = (solved(sim, sim.params().changed(each)) for each in (fewer, arm))
    assert not path.progress(*after, before).solved


@each_challenge
def test_nobody_has_solved_it_at_the_start(sim: AnySim, challenge: AnyChallenge) -> None:
    assert not challenge.progress(*solved(sim, opening(sim))).solved
    assert not challenge.progress(*solved(sim, sim.params())).solved


@each_challenge
def test_a_near_miss_is_a_miss_and_is_told_as_nearer_than_the_start(sim: AnySim, challenge: AnyChallenge) -> None:
    assert challenge.misses
    start = challenge.progress(*solved(sim, opening(sim))).fraction
    for miss in challenge.misses:
        progress = at(sim, challenge, miss)
        assert not progress.solved, miss
        if differ_in_numbers_alone(sim, challenge, miss):
            assert progress.fraction > start, miss


@each_challenge
def test_what_is_said_is_said_for_people(sim: AnySim, challenge: AnyChallenge) -> None:
    done = at(sim, challenge, challenge.solves).words
    assert challenge.title[0].isupper()
    assert challenge.goal[0].isupper()
    assert challenge.goal.endswith((".", "?"))
    for progress in found(sim, challenge):
        assert 0.0 <= progress.fraction <= 1.0
        assert progress.words.strip()
        assert not re.search(r"\bnan\b|\binf\b|\bNone\b|-\d|'", progress.words), progress.words
        assert progress.solved or progress.words != done, "near and there are said in different words"


@each_sim
def test_a_sim_says_of_all_its_challenges_how_near_a_state_is(sim: AnySim) -> None:
    said = checked(sim.challenges, *solved(sim, opening(sim)))
    assert list(said) == [each.id for each in sim.challenges]
    assert jsonable(said) == said
    assert not any(each["solved"] for each in said.values())
