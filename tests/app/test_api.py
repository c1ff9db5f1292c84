"""The API: the catalogue, solving, and what it says of bad parameters; and the page for bad links."""

from __future__ import annotations

import functools
import json
from collections.abc import Iterator
from html import escape, unescape
from typing import Any

import httpx
import pytest

from app.routes import api
from sims import SIMS, by_slug
from sims.kit.fields import Switch
from sims.kit.refusals import BadParams
from sims.kit.schema import solution_schema
from sims.kit.sim import Sim, jsonable
from sims.kit.spelling import clipped
from tests.app.bad_values import HOSTILE, JSON, JSON_NAMES, LINK, LINK_NAMES
from tests.app.conftest import Local
from tests.per_sim import per_sim
from tests.schema import wrong
from tests.server import wait_for
from tests.sims.cases import FEW, FEW_NAMES
from tests.sims.contract import contract_of

AnySim = Sim[Any, Any]
TRIANGULATION = next(sim for sim in SIMS if sim.slug == "triangulation")
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
def test_one_sim_with_objectives_and_schema(client: httpx.Client, sim: AnySim) -> None:
    """On the server that has loaded all lessons: their steps are told too, and states of the point cloud take long."""
    told = strict(client.get(f"/api/sims/{sim.slug}"))
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


@functools.cache
def schema_of(slug: str) -> Any:
    sim = by_slug(slug)
    assert sim is not None
    return solution_schema(api.solved(sim))


def thinned(sim: AnySim, params: Any) -> Any:
    """A cloud has the same kinds of results with a twentieth of its points, in a tenth of the time."""
    return params.changed({"voxel_size": 0.1}) if sim.heavy and params.voxel_size == 0.0 else params


@per_sim(("sim", "name", "params"), [(sim, name, thinned(sim, params)) for sim, name, params in FEW], FEW_NAMES)
def test_solve_answers_what_the_sim_solves_as_its_schema_says(
    http: httpx.Client, sim: AnySim, name: str, params: Any
) -> None:
    sent = params.model_dump(mode="json")
    answer = http.post(f"/api/sims/{sim.slug}/solve", json=sent)
    assert answer.status_code == 200
    told = strict(answer)
    assert told["params"] == sent
    assert told["solution"] == jsonable(sim.solve(params))
    assert not list(wrong(told["solution"], schema_of(sim.slug)))


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
    meaning = contract_of(sim).state
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


@per_sim(("sim", "name", "value"), JSON, JSON_NAMES)
def test_bad_parameter_is_named_and_what_is_wrong_stands_in_fields(
    http: httpx.Client, sim: AnySim, name: str, value: Any
) -> None:
    answer = post(http, sim, json.dumps({name: value}))
    details = complaints(answer)
    assert name in {detail["parameter"] for detail in details}
    for detail in details:
        assert name in detail["loc"] or name in detail["msg"]
        assert detail["allowed"]
        assert len(detail["received"]) <= 80
        if detail["parameter"] == name:
            assert detail["received"] == clipped(json.dumps(value))
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


POST = {"content-type": "application/json"}


def post(http: httpx.Client, sim: AnySim, body: str | bytes, **headers: str) -> httpx.Response:
    return http.post(f"/api/sims/{sim.slug}/solve", content=body, headers={**POST, **headers})


def numbers() -> Iterator[tuple[AnySim, str, Any]]:
    """Each number of each sim, and a value that it may have."""
    for sim in SIMS:
        for name in sim.params.numeric:
            field = sim.params.model_fields[name]
            low, _ = sim.params().bounds(name)
            yield sim, name, list(field.default) if isinstance(field.default, tuple) else low


NUMBERS = [(sim, name, good) for sim, name, good in numbers() if good != []]


@pytest.mark.parametrize(("sim", "name", "good"), NUMBERS, ids=[f"{sim.slug}: {name}" for sim, name, _ in NUMBERS])
def test_a_number_is_neither_text_nor_true_or_false(http: httpx.Client, sim: AnySim, name: str, good: Any) -> None:
    for bad in (json.dumps(good).replace("null", '"1"'), True, "1e0"):
        value = [str(v) for v in good] if isinstance(good, list) and bad is not True else bad
        for detail in complaints(http.post(f"/api/sims/{sim.slug}/solve", json={name: value})):
            assert detail["parameter"] == name
            assert detail["received"] == clipped(json.dumps(value))
            assert "number" in detail["allowed"]


@each_sim
def test_switches_are_true_or_false(http: httpx.Client, sim: AnySim) -> None:
    for name, kind in sim.params.kinds.items():
        if isinstance(kind, Switch):
            for value in (1, 0, "true", "1", None):
                (detail,) = complaints(http.post(f"/api/sims/{sim.slug}/solve", json={name: value}))
                assert (detail["parameter"], detail["allowed"]) == (name, "true or false")


def test_parameters_that_do_not_go_together_are_each_named(http: httpx.Client) -> None:
    body = {"angles": [1, 2], "lengths": [1, 1, 1]}
    details = complaints(http.post("/api/sims/transform-chain/solve", json=body))
    assert [(d["parameter"], d["received"]) for d in details] == [("angles", "[1, 2]"), ("lengths", "[1, 1, 1]")]
    assert "as many" in details[0]["allowed"]


@pytest.mark.parametrize("number", ["7", "7.0", "7e0"])
def test_a_whole_number_may_be_spelled_as_a_fraction(http: httpx.Client, number: str) -> None:
    told = strict(post(http, TRIANGULATION, f'{{"seed": {number}, "focal": 700, "left_uv": [410, 210.0]}}'))
    assert (told["params"]["seed"], told["params"]["focal"]) == (7, 700.0)


@pytest.mark.parametrize(
    ("body", "named"),
    [
        ('{"focal": 1e400}', "focal"),
        ('{"focal": NaN}', "focal"),
        ('{"focal": -Infinity}', "focal"),
        ('{"focal": ' + "9" * 400 + "}", "focal"),
        ('{"seed": ' + "9" * 400 + "}", "seed"),
        ('{"seed": 1.5}', "seed"),
        ('{"focal": ' + "9" * 5000 + "}", ""),
        ('{"focal": 700, "focal": 800}', "focal"),
        ('{"focal": {"a": 1, "a": 2}}', "a"),
        ('{"focal": ' + "[" * 900 + "]" * 900 + "}", "focal"),
        ('{"focal": ' + "[" * 20_000 + "]" * 20_000 + "}", ""),
        ('{"\\ud800": 1}', ""),
        ('{"focal": "\\ud800"}', "focal"),
        ('{"method": "\\ud800"}', "method"),
        ('{"seed": 1', ""),
        ("[1]", ""),
        ("7", ""),
        (b"\xff\xfe", ""),
        (b"\xff\xfe\x00", ""),
    ],
    ids=lambda v: str(v)[:30],
)
def test_hostile_json_is_refused_in_words(http: httpx.Client, body: str | bytes, named: str) -> None:
    (detail,) = complaints(post(http, TRIANGULATION, body))
    assert {"input", "msg", "type"} <= detail.keys()
    assert detail["parameter"] == named
    assert detail["allowed"]


@pytest.mark.parametrize("kind", ["text/plain", "application/x-www-form-urlencoded", "multipart/form-data", "", "\xff"])
def test_a_body_that_says_it_is_no_json_is_refused(http: httpx.Client, kind: str) -> None:
    answer = http.post("/api/sims/camera/solve", content=b"{}", headers={b"content-type": kind.encode("latin-1")})
    assert answer.status_code == 415
    assert "application/json" in strict(answer)["detail"]


def test_json_of_a_kind_is_json(http: httpx.Client) -> None:
    for kind in ("application/json; charset=utf-8", "Application/JSON", "application/ld+json"):
        assert post(http, TRIANGULATION, "{}", **{"content-type": kind}).status_code == 200


# ---- pages of other origins

ELSEWHERE = {"origin": "https://course.example"}


@pytest.mark.parametrize(
    ("method", "path", "body", "status"),
    [
        ("GET", "/api/sims", None, 200),
        ("GET", "/api/sims/camera", None, 200),
        ("POST", "/api/sims/camera/solve", b"{}", 200),
        ("POST", "/api/sims/camera/solve", b'{"fx": 1}', 422),
        ("POST", "/api/sims/camera/solve", b"1" * 70_000, 413),
        ("GET", "/api/sims/nothing", None, 404),
        ("GET", "/api/nothing", None, 404),
        ("DELETE", "/api/sims", None, 405),
    ],
)
def test_pages_of_any_origin_may_read_the_api(
    http: httpx.Client, method: str, path: str, body: bytes | None, status: int
) -> None:
    answer = http.request(method, path, content=body, headers={**ELSEWHERE, **POST})
    assert answer.status_code == status
    assert answer.headers["access-control-allow-origin"] == "*"
    assert "access-control-allow-credentials" not in answer.headers


def test_a_browser_that_asks_first_may_post_json(http: httpx.Client) -> None:
    asked = {"access-control-request-method": "POST", "access-control-request-headers": "content-type"}
    answer = http.options("/api/sims/camera/solve", headers={**ELSEWHERE, **asked})
    assert answer.status_code == 200
    assert "POST" in answer.headers["access-control-allow-methods"]
    assert "content-type" in answer.headers["access-control-allow-headers"]
    asked["access-control-request-method"] = "DELETE"
    assert http.options("/api/sims/camera/solve", headers={**ELSEWHERE, **asked}).status_code == 400


@pytest.mark.parametrize("path", ["/", "/sims/camera", "/healthz", "/docs", "/apis"])
def test_only_the_api_is_open(http: httpx.Client, path: str) -> None:
    assert "access-control-allow-origin" not in http.get(path, headers=ELSEWHERE).headers


def test_what_fails_on_the_server_is_said_too(local: Local, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(api, "strict", lambda *_: 1 / 0)
    answer = local.http.post("/api/sims/camera/solve", json={}, headers=ELSEWHERE)
    assert (answer.status_code, answer.headers["access-control-allow-origin"]) == (500, "*")
    assert "log" in strict(answer)["detail"]
    wait_for(lambda: any("ZeroDivisionError" in problem for problem in local.problems), "a line in the log")
    local.problems.clear()


# ---- what a solution is


@pytest.fixture(scope="module")
def openapi(client: httpx.Client) -> Any:
    """The description of the whole API."""
    return strict(client.get("/openapi.json"))


@each_sim
def test_the_schema_is_told_and_says_what_is_what(client: httpx.Client, openapi: Any, sim: AnySim) -> None:
    schema = strict(client.get(f"/api/sims/{sim.slug}"))["solution"]
    path = openapi["paths"][f"/api/sims/{sim.slug}/solve"]["post"]
    answer = path["responses"]["200"]["content"]["application/json"]["schema"]
    assert answer["properties"]["solution"] == schema
    assert set(path["requestBody"]["content"]["application/json"]["schema"]["properties"]) == set(
        sim.params.model_fields
    )
    assert schema["description"]
    told = strict(client.post(f"/api/sims/{sim.slug}/solve"))
    assert not list(wrong(told["solution"], schema))
    for name in schema["required"]:
        rest = {key: value for key, value in told["solution"].items() if key != name}
        assert list(wrong(rest, schema)), name
        assert list(wrong({**rest, name: b"no JSON"}, schema)), name


# ---- bad parameters in a link


@per_sim(("sim", "name", "text"), LINK, LINK_NAMES)
def test_bad_link_names_the_parameter_the_value_and_what_is_allowed(
    http: httpx.Client, sim: AnySim, name: str, text: str
) -> None:
    """On the page and in its frame in turn: the words are the same, and each parameter has several that are bad."""
    path = "/embed" if LINK.index((sim, name, text)) % 2 else ""
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
    contract = contract_of(sim)
    link, meaning = contract.link, contract.state
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
    link = contract_of(sim).link
    for query in ("", f"?{link}", f"?{link}&theme=dark&controls=0&view=3,-3,2,0,0,0"):
        page = http.get(f"/sims/{sim.slug}{query}")
        assert page.status_code == 200
        assert http.get(f"/sims/{sim.slug}/embed{query}").status_code == 200
