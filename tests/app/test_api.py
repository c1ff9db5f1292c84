"""The API: the catalogue, solving, and what it says of bad parameters; and the page for bad links."""

from __future__ import annotations

import json
from html import escape, unescape
from typing import Any

import httpx
import pytest

from sims import SIMS
from sims.kit.params import BadParams
from sims.kit.sim import Sim, jsonable
from tests.app.bad_values import HOSTILE, JSON, JSON_NAMES, LINK, LINK_NAMES
from tests.sims.cases import FEW, FEW_NAMES
from tests.sims.contract import GOLDEN

AnySim = Sim[Any, Any]
each_sim = pytest.mark.parametrize("sim", SIMS, ids=lambda sim: sim.slug)


def strict(answer: httpx.Response) -> Any:
    """The answer's JSON, which may not hold NaN or infinity."""

    def refuse(word: str) -> None:
        raise AssertionError(f"{word} in the answer")

    assert answer.headers["content-type"] == "application/json"
    return json.loads(answer.text, parse_constant=refuse)


# ---- the catalogue


def test_catalogue_lists_the_sims_in_order(http: httpx.Client) -> None:
    cards = strict(http.get("/api/sims"))
    assert [card["slug"] for card in cards] == [sim.slug for sim in SIMS]
    for card, sim in zip(cards, SIMS, strict=True):
        assert (card["title"], card["summary"]) == (sim.title, sim.summary)
        assert card["concepts"]


@each_sim
def test_one_sim_with_objectives_and_schema(http: httpx.Client, sim: AnySim) -> None:
    told = strict(http.get(f"/api/sims/{sim.slug}"))
    assert {"slug", "title", "summary", "concepts", "objectives", "parameters"} <= told.keys()
    assert set(told["parameters"]["properties"]) == set(sim.params.model_fields)
    assert told["parameters"]["additionalProperties"] is False
    for name, schema in told["parameters"]["properties"].items():
        assert {"title", "description", "default"} <= schema.keys(), name
    assert {o["level"] for o in told["objectives"]} <= {
        "Remember",
        "Understand",
        "Apply",
        "Analyze",
        "Evaluate",
        "Create",
    }


@pytest.mark.parametrize("path", ["/api/sims/nothing", "/api/nothing", f"/api/sims/{'x' * 500}"])
def test_what_does_not_exist_is_told_in_json(http: httpx.Client, path: str) -> None:
    answer = http.get(path)
    assert answer.status_code == 404
    detail = strict(answer)["detail"]
    assert detail
    assert len(detail) < 200


def test_methods_that_make_no_sense_are_refused(http: httpx.Client) -> None:
    assert http.get(f"/api/sims/{SIMS[0].slug}/solve").status_code == 405
    assert http.post("/api/sims").status_code == 405
    assert http.delete(f"/api/sims/{SIMS[0].slug}").status_code == 405


def test_openapi_describes_every_sim(http: httpx.Client) -> None:
    paths = strict(http.get("/openapi.json"))["paths"]
    assert {f"/api/sims/{sim.slug}/solve" for sim in SIMS} <= set(paths)
    assert http.get("/docs").status_code == 200


def test_health(http: httpx.Client) -> None:
    told = strict(http.get("/healthz"))
    assert told["status"] == "ok"
    assert told["sims"] == len(SIMS)


# ---- solving


@pytest.mark.parametrize(("sim", "name", "params"), FEW, ids=FEW_NAMES)
def test_solve_answers_what_the_sim_solves(http: httpx.Client, sim: AnySim, name: str, params: Any) -> None:
    sent = params.model_dump(mode="json")
    answer = http.post(f"/api/sims/{sim.slug}/solve", json=sent)
    assert answer.status_code == 200
    told = strict(answer)
    assert told["params"] == sent
    assert told["solution"] == jsonable(sim.solve(params))


@each_sim
def test_all_parameters_are_optional(http: httpx.Client, sim: AnySim) -> None:
    defaults = sim.params().model_dump(mode="json")
    for answer in (http.post(f"/api/sims/{sim.slug}/solve"), http.post(f"/api/sims/{sim.slug}/solve", json={})):
        assert answer.status_code == 200
        assert strict(answer)["params"] == defaults
    name = next(iter(defaults))
    answer = http.post(f"/api/sims/{sim.slug}/solve", json={name: defaults[name]})
    assert strict(answer)["params"] == defaults


@each_sim
def test_golden_link_means_the_same_here(http: httpx.Client, sim: AnySim) -> None:
    _, meaning = GOLDEN[sim.slug]
    told = strict(http.post(f"/api/sims/{sim.slug}/solve", json=meaning))
    assert told["params"] == told["params"] | meaning


@each_sim
def test_solving_opens_no_room(http: httpx.Client, sim: AnySim) -> None:
    before = strict(http.get("/healthz"))["sessions"]
    http.post(f"/api/sims/{sim.slug}/solve")
    assert strict(http.get("/healthz"))["sessions"] == before


# ---- bad parameters in the API


def complaints(answer: httpx.Response) -> list[dict[str, Any]]:
    """The details in FastAPI's form."""
    assert answer.status_code == 422, answer.text[:300]
    details: list[dict[str, Any]] = strict(answer)["detail"]
    assert details
    for detail in details:
        assert {"loc", "msg", "type"} <= detail.keys()
        assert detail["loc"][0] == "body"
    return details


@pytest.mark.parametrize(("sim", "name", "value"), JSON, ids=JSON_NAMES)
def test_bad_parameter_is_named(http: httpx.Client, sim: AnySim, name: str, value: Any) -> None:
    body = json.dumps({name: value})
    answer = http.post(f"/api/sims/{sim.slug}/solve", content=body, headers={"content-type": "application/json"})
    for detail in complaints(answer):
        assert name in detail["loc"] or name in detail["msg"]
    assert len(answer.text) < 20_000


@each_sim
@pytest.mark.parametrize("name", ["colour", "", "__class__", "model_config", HOSTILE, "x" * 1000])
def test_unknown_parameter_is_named(http: httpx.Client, sim: AnySim, name: str) -> None:
    (detail,) = complaints(http.post(f"/api/sims/{sim.slug}/solve", json={name: 1}))
    assert name in detail["loc"]


@each_sim
def test_everything_wrong_is_told_at_once(http: httpx.Client, sim: AnySim) -> None:
    body = {name: {"a": 1} for name in sim.params.model_fields}
    told = {
        part for detail in complaints(http.post(f"/api/sims/{sim.slug}/solve", json=body)) for part in detail["loc"]
    }
    assert set(body) <= told


@pytest.mark.parametrize(
    "body",
    [b"not json", b"{", b"[]", b'"text"', b"17", b"\xff\xfe\x00", b'{"yaw": 1', b"[" * 50_000, b'{"a":' * 5_000],
    ids=["words", "brace", "list", "string", "number", "bytes", "cut off", "deep list", "deep object"],
)
@each_sim
def test_body_that_is_no_object_is_refused(http: httpx.Client, sim: AnySim, body: bytes) -> None:
    answer = http.post(f"/api/sims/{sim.slug}/solve", content=body, headers={"content-type": "application/json"})
    assert answer.status_code in (400, 422)
    assert strict(answer)["detail"]
    assert "Traceback" not in answer.text


def test_a_body_of_any_sensible_size_is_read(http: httpx.Client) -> None:
    body = b" " * 60_000 + b"{}"
    answer = http.post(f"/api/sims/{SIMS[0].slug}/solve", content=body, headers={"content-type": "application/json"})
    assert answer.status_code == 200


@each_sim
def test_null_means_all_defaults(http: httpx.Client, sim: AnySim) -> None:
    answer = http.post(f"/api/sims/{sim.slug}/solve", content=b"null", headers={"content-type": "application/json"})
    assert strict(answer)["params"] == sim.params().model_dump(mode="json")


# ---- bad parameters in a link


@pytest.mark.parametrize("path", ["", "/embed"], ids=["page", "embed"])
@pytest.mark.parametrize(("sim", "name", "text"), LINK, ids=LINK_NAMES)
def test_bad_link_names_the_parameter_the_value_and_what_is_allowed(
    http: httpx.Client, sim: AnySim, name: str, text: str, path: str
) -> None:
    answer = http.get(f"/sims/{sim.slug}{path}", params={name: text})
    assert answer.status_code == 422
    assert answer.headers["content-type"].startswith("text/html")
    page = answer.text
    assert "<script>alert" not in page
    shown = unescape(page)
    assert name in shown
    with pytest.raises(BadParams) as caught:
        sim.params.from_query([(name, text)])
    ((_, received, allowed),) = caught.value.complaints
    assert " ".join(allowed.split()) in " ".join(shown.split())
    assert " ".join(received.split()) in " ".join(shown.split())
    assert len(page) < 40_000


@each_sim
@pytest.mark.parametrize("path", ["", "/embed"], ids=["page", "embed"])
def test_the_good_rest_of_a_bad_link_is_kept(http: httpx.Client, sim: AnySim, path: str) -> None:
    link, meaning = GOLDEN[sim.slug]
    bad = next(iter(meaning))
    rest = "&".join(part for part in link.split("&") if not part.startswith(f"{bad}="))
    answer = http.get(f"/sims/{sim.slug}{path}?{rest}&{bad}=%3Cb%3E&colour=red&theme=dark")
    assert answer.status_code == 422
    assert escape(f"{rest}&theme=dark") in answer.text
    assert "colour=red" not in answer.text
    assert http.get(f"/sims/{sim.slug}?{rest}&theme=dark").status_code == 200


@pytest.mark.parametrize(
    ("option", "text"),
    [
        ("theme", "blue"),
        ("theme", ""),
        ("controls", "2"),
        ("controls", "yes"),
        ("view", "1,2,3"),
        ("view", "1,2,3,nan,0,0"),
        ("view", "1,2,3,inf,0,0"),
        ("view", "0,0,0,0,0,0"),
        ("view", "a,b,c,d,e,f"),
        ("view", HOSTILE),
        ("theme", HOSTILE),
    ],
)
def test_bad_page_option_is_named(http: httpx.Client, option: str, text: str) -> None:
    answer = http.get(f"/sims/{SIMS[0].slug}/embed", params={option: text})
    assert answer.status_code == 422
    assert option in answer.text
    assert "<script>alert" not in answer.text


def test_name_of_an_unknown_parameter_is_escaped(http: httpx.Client) -> None:
    answer = http.get(f"/sims/{SIMS[0].slug}", params={HOSTILE: HOSTILE})
    assert answer.status_code == 422
    assert "<script>alert" not in answer.text
    assert (
        escape(HOSTILE) in answer.text
        or escape(HOSTILE, quote=False) in answer.text
        or HOSTILE in unescape(answer.text)
    )


def test_a_link_full_of_mistakes_gets_a_short_page(http: httpx.Client) -> None:
    query = "&".join(f"a{k}=1" for k in range(3000))
    answer = http.get(f"/sims/{SIMS[0].slug}?{query}")
    assert answer.status_code == 422
    assert len(answer.text) < 40_000


@each_sim
def test_good_links_open(http: httpx.Client, sim: AnySim) -> None:
    link, _ = GOLDEN[sim.slug]
    for query in ("", f"?{link}", f"?{link}&theme=dark&controls=0&view=3,-3,2,0,0,0"):
        page = http.get(f"/sims/{sim.slug}{query}")
        assert page.status_code == 200
        room = http.get(f"/sims/{sim.slug}/embed{query}", follow_redirects=False)
        assert room.status_code == 307
        assert room.headers["location"].endswith(query or "/")
        assert http.get(room.headers["location"]).status_code == 200
