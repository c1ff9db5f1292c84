"""From where a state is looked at by itself: from farther away where something would be out of sight."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sims import SIMS, by_slug
from sims.kit.sim import Sim
from sims.kit.view import SPARE, STEP, View
from tests.server import Rig

FAR = [
    ("camera", {"position": (0.0, -9.0, 3.0)}), ("coordinate-frames", {"point": (3.0, 3.0, 3.0)}),
    ("epipolar", {"point": (2.0, 9.0, 1.2)}), ("triangulation", {"right_uv": (380.0, 210.0)}),
    ("transform-chain", {"angles": (0.0,) * 5, "lengths": (1.5,) * 5, "axes": "zyyyy"}),
]  # fmt: skip


def home(sim: Sim[Any, Any], **changes: Any) -> View:
    params = sim.params().changed(changes)
    return sim.home(params, sim.solve(params))


@pytest.mark.parametrize("sim", SIMS, ids=lambda sim: sim.slug)
def test_a_sim_opens_in_its_own_view(sim: Sim[Any, Any]) -> None:
    assert sim.home(sim.params(), sim.solve(sim.params())) == sim.view


@pytest.mark.parametrize(("slug", "changes"), FAR)
def test_what_a_state_moves_away_is_still_in_sight(slug: str, changes: dict[str, Any]) -> None:
    sim = by_slug(slug)
    assert sim is not None
    assert sim.seen is not None
    view = home(sim, **changes)
    params = sim.params().changed(changes)
    own, middle = sim.home(params, None), np.array(view.look_at)
    places = [np.asarray(place) for place in sim.seen(params, sim.solve(params))]
    assert max(math.dist(place, middle) for place in places) <= SPARE * view.radius, "it is out of sight"
    lost = math.dist(own.look_at, middle) + own.radius - view.radius
    assert lost < 1e-9, "something of the sim's own view is out of sight"
    kept = max(math.dist(place, own.look_at) for place in places)
    assert own.radius < view.radius < kept / SPARE * STEP, "it is looked at from too far"
    assert np.subtract(view.position, view.look_at) == pytest.approx(np.subtract(own.position, own.look_at))

    with Rig(sim) as rig:
        rig.show(params)
        told = [message for message in rig.browser.told if message["type"] == "home"]
        assert [(each["radius"], each["moved"]) for each in told] == [(sim.view.radius, False), (view.radius, False)]


def test_a_wider_view_moves_its_middle_to_where_more_is_to_be_seen() -> None:
    view = View((0.0, -5.0, 3.0), (0.0, 0.0, 1.0), 1.0)
    ahead = view.holding([(0.0, 3.0, 1.0)])
    assert ahead.radius == STEP**3, "a view that keeps its middle takes four steps"
    assert (ahead.position, ahead.look_at) == ((0.0, ahead.radius - 6.0, 3.0), (0.0, ahead.radius - 1.0, 1.0))
    around = view.holding([(0.0, 3.0, 1.0), (0.0, -3.0, 1.0)])
    assert (around.look_at, around.radius) == (view.look_at, STEP**4)


def test_nobody_steps_back_for_what_runs_away() -> None:
    sim = by_slug("coordinate-frames")
    assert sim is not None
    assert home(sim, w=0.001) == sim.view


def test_a_view_from_just_one_place_never_steps_back_and_the_page_hears_that_it_was_moved() -> None:
    camera = by_slug("camera")
    assert camera is not None
    exact = View((1.0, 2.0, 3.0), (1.0, 3.0, 3.0), 0.0)
    assert exact.holding([(50.0, 0.0, 0.0)]) is exact
    with Rig(camera) as rig:
        rig.show(camera.params().changed({"through": True}))
        rig.show(camera.params())
        told = [message for message in rig.browser.told if message["type"] == "home"]
        radius = camera.view.radius
        assert [(each["radius"], each["moved"]) for each in told] == [(radius, False), (0.0, True), (radius, False)]
