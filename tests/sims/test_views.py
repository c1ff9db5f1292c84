"""From where a state is looked at by itself: from farther away where something would be out of sight."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sims import SIMS, by_slug
from sims.kit.sim import SPARE, STEP, Sim, View
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
    reach = max(math.dist(np.asarray(place), view.look_at) for place in sim.seen(params, sim.solve(params)))
    assert view.radius > sim.view.radius
    assert reach / SPARE <= view.radius, "it is out of sight"
    assert view.radius < reach / SPARE * STEP, "it is looked at from too far"
    assert (view.position, view.look_at) == (sim.view.position, sim.view.look_at)

    with Rig(sim) as rig:
        rig.show(params)
        told = [message for message in rig.browser.told if message["type"] == "home"]
        assert [(each["radius"], each["moved"]) for each in told] == [(sim.view.radius, False), (view.radius, False)]


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
