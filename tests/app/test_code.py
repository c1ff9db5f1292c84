"""Scripts of a state over HTTP: their names and kinds, the numbers in them, and the page of a link that is wrong."""

from __future__ import annotations

import ast
import json
import re
from typing import Any

import httpx
import nbformat
import pytest

from app import scripts
from app.routes.code import shown
from sims import SIMS
from sims.kit.sim import Sim
from tests.app.toys import toy
from tests.sims.contract import contract_of

AnySim = Sim[Any, Any]
each_sim = pytest.mark.parametrize("sim", SIMS, ids=lambda sim: sim.slug)


def values(text: str, sim: AnySim) -> dict[str, Any]:
    """What a script sets, of the sim's parameters."""
    found = {}
    for node in ast.parse(text).body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            name = node.targets[0].id
            if name in sim.params.model_fields and name not in found:
                found[name] = ast.literal_eval(node.value)
    return found


@each_sim
@pytest.mark.parametrize("language", scripts.LANGUAGES)
def test_a_script_begins_with_the_defaults_and_has_nothing_of_ours(sim: AnySim, language: str) -> None:
    found = scripts.script(sim, language)
    assert found is not None
    assert scripts.of_state(found, sim.params()) == found.text
    own = values(found.text, sim)
    assert len(own) >= 3
    assert own == {name: getattr(sim.params(), name) for name in own}
    assert not re.findall(r"^(?:from|import) (?:sims|geometry|app)\b", found.text, re.M)
    assert (found.title == "NumPy") == (language == "numpy")


@each_sim
def test_a_script_has_the_numbers_of_its_link_and_differs_in_nothing_else(http: httpx.Client, sim: AnySim) -> None:
    link = contract_of(sim).link
    params = sim.params.from_query([tuple(each.split("=")) for each in link.split("&")])
    for language in scripts.LANGUAGES:
        answer = http.get(f"/sims/{sim.slug}/code?lang={language}&{link}")
        assert answer.headers["content-type"] == "text/x-python; charset=utf-8"
        assert re.fullmatch(
            rf'attachment; filename="sim3-{sim.slug}-(numpy|scipy|opencv)\.py"', answer.headers["content-disposition"]
        )
        assert answer.headers["access-control-allow-origin"] == "*"
        found, script = values(answer.text, sim), scripts.script(sim, language)
        assert script is not None
        assert found == {name: getattr(params, name) for name in found}
        lines = zip(answer.text.splitlines(), script.text.splitlines(), strict=True)
        assert all(a == b or a.partition(" = ")[0] in found for a, b in lines)


@each_sim
def test_a_notebook_has_heading_link_and_the_whole_script(http: httpx.Client, sim: AnySim) -> None:
    link = contract_of(sim).link
    answer = http.get(f"/sims/{sim.slug}/code?format=ipynb&{link}")
    assert answer.headers["content-type"].startswith("application/x-ipynb+json")
    assert answer.headers["content-disposition"].endswith('.ipynb"')
    made = nbformat.reads(answer.text, as_version=4)
    nbformat.validate(made)
    first, *code = made.cells
    assert first.source.startswith(f"# {sim.title}\n")
    (state,) = re.findall(r"\((http\S+)\)", first.source)
    assert http.get(state).status_code == 200
    assert len(code) > 1
    plain = http.get(f"/sims/{sim.slug}/code?{link}").text
    parts = [ast.dump(node) for cell in code for node in ast.parse(cell.source).body]
    assert parts == [ast.dump(node) for node in ast.parse(plain).body[1:]]
    assert json.loads(answer.text)["nbformat"] == 4


def test_the_opening_state_is_that_of_a_link_without_a_state(http: httpx.Client) -> None:
    assert 'convention = "ros"' in http.get("/sims/coordinate-frames/code").text


@pytest.mark.parametrize(
    ("query", "name"),
    [
        ("lang=fortran", "lang"),
        ("format=pdf", "format"),
        ("yaw=400", "yaw"),
        ("nothing=1", "nothing"),
        ("view=1", "view"),
    ],
)
def test_a_bad_parameter_is_named(http: httpx.Client, query: str, name: str) -> None:
    answer = http.get(f"/sims/euler-angles/code?pitch=45&{query}")
    assert answer.status_code == 422
    assert f"<code>{name}</code>" in answer.text
    assert "/sims/euler-angles?pitch=45" in answer.text
    assert ("which this sim doesn’t have" in answer.text) == (name == "nothing")


def test_a_text_of_a_link_stays_a_text_of_the_script(http: httpx.Client) -> None:
    text = http.get("/sims/point-cloud/code", params={"dataset": "file", "second": "a'+print(1)#.ply"}).text
    assert values(text, next(sim for sim in SIMS if sim.slug == "point-cloud"))["second"] == "a'+print(1)#.ply"


def test_a_sim_without_scripts_shows_none() -> None:
    sim, _ = toy()
    assert shown(sim, sim.params()) == []


@each_sim
def test_a_lesson_page_has_both_scripts_in_its_state(http: httpx.Client, sim: AnySim) -> None:
    link = contract_of(sim).link
    page = http.get(f"/sims/{sim.slug}?{link}").text
    for language in scripts.LANGUAGES:
        assert f'data-lang="{language}"' in page
        assert f"/sims/{sim.slug}/code?lang={language}&amp;{link.split('&')[0]}" in page
