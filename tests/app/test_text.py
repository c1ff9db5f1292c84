"""A sim without its scene: plain HTML for every state, and a form that leads to another one."""

from __future__ import annotations

import html
import re
from typing import Any
from urllib.parse import urlencode

import httpx
import pytest

from sims import SIMS
from sims.kit.sim import Sim
from tests.sims.contract import contract_of
from tests.sims.markup import mistakes

AnySim = Sim[Any, Any]
each_sim = pytest.mark.parametrize("sim", SIMS, ids=lambda sim: sim.slug)
FIELD = re.compile(r'<(?:input|select) id="(\w+)" name="\w+"(?: value="([^"]*)")?')


def page(http: httpx.Client, sim: AnySim, query: str = "") -> str:
    answer = http.get(f"/sims/{sim.slug}/text?{query}")
    assert answer.status_code == 200, answer.text[:2000]
    return answer.text


@each_sim
def test_every_sim_has_its_words_numbers_and_pictures(http: httpx.Client, sim: AnySim) -> None:
    text = page(http, sim)
    params = sim.params.from_query(())
    solution = sim.solve(params)
    main = text.partition("<main")[2].partition("</main>")[0]
    assert not mistakes(text)
    assert sim.caption(params, solution) in html.unescape(text)
    assert sim.describe(params, solution) in html.unescape(text)
    assert main.count("<figure") == len(sim.panes(params, solution) if sim.panes else ())
    for what in ("<script", "data-handle", 'tabindex="0"', "Arrow keys"):
        assert what not in main, "it works without"


@each_sim
def test_its_form_holds_every_control_and_the_state_of_the_link(http: httpx.Client, sim: AnySim) -> None:
    found = dict(FIELD.findall(page(http, sim, contract_of(sim).link)))
    assert {*found} == {name for name, kind in sim.params.kinds.items() if not kind.hidden}
    sent = {name: value for name, value in found.items() if value}
    again = page(http, sim, urlencode(sent))
    assert dict(FIELD.findall(again)).items() >= sent.items()


@pytest.mark.parametrize(("slug", "state"), [("epipolar", "own pair"), ("triangulation", "toe-in pair")])
def test_what_no_control_sets_goes_on_with_the_form(http: httpx.Client, slug: str, state: str) -> None:
    sim = next(each for each in SIMS if each.slug == slug)
    params = sim.params().changed(sim.states[state])
    text = page(http, sim, params.query())
    sent = {**dict(FIELD.findall(text)), **dict(re.findall(r'<input type="hidden" name="(\w+)" value="([^"]*)"', text))}
    switches = {name: "1" if getattr(params, name) else "0" for name in sent if type(getattr(params, name)) is bool}
    words = {name: value for name in sent if type(value := getattr(params, name)) is str}
    assert sim.params.from_query({**sent, **switches, **words}.items()) == params


def test_numbers_are_typed_as_beside_the_scene(http: httpx.Client) -> None:
    found = dict(FIELD.findall(http.get("/sims/euler-angles/text?yaw=45,5&pitch=π/6&roll=").text))
    assert (found["yaw"], found["pitch"], found["roll"]) == ("45.5", "30", "10")
    found = dict(FIELD.findall(http.get("/sims/camera/text?position=(1; −2; 3)").text))
    assert found["position"] == "1,-2,3"


@pytest.mark.parametrize(
    ("query", "name"), [("yaw=400", "yaw"), ("yaw=many", "yaw"), ("nothing=1", "nothing"), ("order=ZYX", "order")]
)
def test_what_is_wrong_is_said(http: httpx.Client, query: str, name: str) -> None:
    answer = http.get(f"/sims/euler-angles/text?{query}")
    assert answer.status_code == 422
    assert name in answer.text


def test_a_sim_that_there_is_not_has_none(http: httpx.Client) -> None:
    assert http.get("/sims/nothing/text").status_code == 404
