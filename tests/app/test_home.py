"""A sim taken home: what is refused, and that the file needs nothing beside itself."""

from __future__ import annotations

import re
from typing import Any

import httpx
import pytest

from app.routes import answers, home
from geometry import GeometryError
from sims import SIMS, by_slug
from sims.kit import taken
from sims.kit.sim import Sim
from tests.app.conftest import Local


def test_the_file_says_what_it_is_and_asks_for_nothing(http: httpx.Client, local: Local) -> None:
    sessions = local.sessions
    answer = http.get("/sims/euler-angles/home?yaw=45&sweep=pitch&from=−60&to=60&frames=3&theme=dark&view=1,2,3,0,0,0")
    assert answer.status_code == 200
    name = re.search(r'filename="(.*)"', answer.headers["content-disposition"])
    assert name is not None
    assert re.fullmatch(r"sim3-euler-angles-pitch-\d{4}-\d\d-\d\d\.html", name[1])
    page = answer.text
    assert '<html lang="en" data-theme="dark"' in page
    outside = re.findall(r'(?:src|href)="(?!data:|#)([^"]*)"', page.partition('<script type="text/plain"')[0])
    assert outside == [f"{local.url}/sims/euler-angles?yaw=45&amp;pitch=-60"]
    assert "Taken home from Sim3 on 20" in page
    assert not re.search(r'from "\.', page), "a script in a page has no folder beside it"
    assert local.sessions == sessions, "nobody is there to use a session"


@pytest.mark.parametrize("sim", [sim for sim in SIMS if not sim.heavy], ids=lambda sim: sim.slug)
def test_every_sim_offers_sweeps(http: httpx.Client, sim: Sim[Any, Any]) -> None:
    offered = http.get(f"/sims/{sim.slug}/sweeps").json()
    assert offered["why"] == ""
    assert all(number["low"] < number["high"] and number["label"] for number in offered["numbers"])
    assert offered["numbers"]


def test_what_the_controls_of_a_state_hide_is_no_sweep(http: httpx.Client) -> None:
    sim = by_slug("triangulation")
    assert sim is not None
    own = sim.params().changed(sim.states["toe-in pair"]).query()
    names = [{n["name"] for n in http.get(f"/sims/triangulation/sweeps?{q}").json()["numbers"]} for q in ("", own)]
    assert names[0] - names[1] == {"focal", "doffs", "cx", "cy", "width", "height"}
    refused = http.get(f"/sims/triangulation/home?sweep=focal&{own}").json()["detail"]
    assert "sweep: got 'focal', allowed: one of: baseline" in refused


def test_a_sim_that_works_long_offers_its_state_alone(http: httpx.Client) -> None:
    offered = http.get("/sims/point-cloud/sweeps").json()
    assert offered["numbers"] == []
    assert "state can be taken home" in offered["why"]
    refused = http.get("/sims/point-cloud/home?sweep=voxel_size")
    assert (refused.status_code, refused.json()["detail"]) == (422, offered["why"])


@pytest.mark.parametrize(
    ("query", "words"),
    [
        ("sweep=nothing", "sweep: got 'nothing', allowed: one of: yaw, pitch, roll, progress"),
        ("from=1&to=2", "sweep: got '', allowed"),
        ("sweep=order", "sweep: got 'order', allowed"),
        ("sweep=yaw&from=-200", "from: got '-200', allowed: a number from -180 to 180"),
        ("sweep=yaw&to=many", "to: got 'many', allowed: a number from -180 to 180"),
        ("sweep=yaw&to=nan", "to: got 'nan', allowed: a number from -180 to 180"),
        ("sweep=yaw&from=5&to=5", "from and to are both 5"),
        ("sweep=yaw&yaw=1000", "yaw: got '1000'"),
        ("nothing=1", "nothing: got '1'"),
        ("sweep=yaw&frames=73", "frames: got '73', allowed: a whole number from 2 to 72"),
        ("sweep=yaw&frames=1", "frames: got '1', allowed"),
    ],
)
def test_what_cant_be_taken_is_said(http: httpx.Client, query: str, words: str) -> None:
    answer = http.get(f"/sims/euler-angles/home?{query}")
    assert answer.status_code == 422
    assert words in answer.json()["detail"]
    assert answer.headers["access-control-allow-origin"] == "*"


def test_too_large_a_file_and_too_many_at_once_are_refused(http: httpx.Client, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(taken, "LARGEST", 1000)
        answer = http.get("/sims/euler-angles/home")
        assert answer.status_code == 413
        assert "too large" in answer.json()["detail"]
    monkeypatch.setattr(answers, "EACH", 0)
    assert http.get("/sims/euler-angles/home").status_code == 429


def test_a_state_that_has_no_solution_is_refused_in_words(http: httpx.Client, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object, **__: object) -> None:
        raise GeometryError("axis", "zero", "a direction")

    monkeypatch.setattr(home, "Taken", fail)
    answer = http.get("/sims/quaternion/home")
    assert answer.status_code == 422
    assert answer.json()["detail"].startswith("Nothing can be shown of it: axis")


def test_there_is_no_file_of_no_sim(http: httpx.Client) -> None:
    assert http.get("/sims/nothing/home").status_code == 404
