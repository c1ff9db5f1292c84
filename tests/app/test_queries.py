"""Links as people, mail programs and books write them."""

from __future__ import annotations

import json
import re
from typing import Any
from urllib.parse import parse_qs, urlsplit

import httpx
import pytest

from app.routes.links import TRACKING
from geometry import GeometryError
from sims import SIMS, by_slug
from tests.app.conftest import Local
from tests.app.test_security import page_data

TRACKED = "utm_source=mail&fbclid=1&gclid=2&mc_cid=3&mc_eid=4&msclkid=5&_ga=6&UTM_Medium=7&igshid=8&gad_source=9"
PAGES = ("/sims/euler-angles", "/sims/euler-angles/embed")


@pytest.mark.parametrize("path", PAGES)
def test_what_follows_people_is_ignored_and_not_handed_on(http: httpx.Client, path: str) -> None:
    page = http.get(f"{path}?{TRACKED}&yaw=45&theme=dark&utm_source=again")
    assert page.status_code == 200
    assert "utm_" not in page.text.replace("utm_source=again", "")
    frames = re.findall(r'<iframe[^>]* src="([^"]+)"', page.text)
    assert [parse_qs(urlsplit(src.replace("&amp;", "&")).query) for src in frames] == [
        {"yaw": ["45"], "theme": ["dark"]}
    ] * len(frames)


def test_no_parameter_is_taken_for_one_that_follows_people() -> None:
    assert not [name for sim in SIMS for name in sim.params.model_fields if TRACKING.fullmatch(name)]


@pytest.mark.parametrize("path", PAGES)
@pytest.mark.parametrize("query", ["yaw=1&yaw=2", "yaw=1&yaw=1", "theme=dark&theme=light"])
def test_what_is_given_twice_is_refused(http: httpx.Client, path: str, query: str) -> None:
    page = http.get(f"{path}?{query}&pitch=12")
    assert page.status_code == 422
    assert "one value" in page.text
    assert "pitch=12" in page.text, "the good part is kept"


@pytest.mark.parametrize(
    ("slug", "query", "name", "value"),
    [
        ("euler-angles", "yaw=−90", "yaw", -90.0),
        ("quaternion", "axis=−1,0,−0.5", "axis", [-1.0, 0.0, -0.5]),
        ("transform-chain", "angles=10,−20.5,30", "angles", [10.0, -20.5, 30.0]),
    ],
)
def test_the_minus_of_books_is_a_minus(local: Local, slug: str, query: str, name: str, value: object) -> None:
    page = local.http.get(f"/sims/{slug}/embed?{query}&view=−3,−3,2,0,0,0")
    assert page.status_code == 200
    room = json.loads(page_data(page.text))["path"].split("/")[4]
    sim = by_slug(slug)
    assert sim is not None
    session = local.services.sessions.find(sim, room)
    assert session is not None
    assert session.params.model_dump(mode="json")[name] == value


@pytest.mark.parametrize(
    ("slug", "query", "meant"),
    [
        ("euler-angles", "order=ZYX", "zyx"),
        ("euler-angles", "frame=Extrinsic", "extrinsic"),
        ("euler-angles", "frame=extrinsc", "extrinsic"),
        ("euler-angles", "Yaw=10", "yaw"),
        ("euler-angles", "pich=10", "pitch"),
        ("camera", "projection=ortographic", "orthographic"),
        ("camera", "show_rays=false", "0"),
        ("camera", "theme=Dark", "dark"),
    ],
)
def test_what_was_meant_is_asked(http: httpx.Client, slug: str, query: str, meant: str) -> None:
    page = http.get(f"/sims/{slug}?{query}")
    assert page.status_code == 422
    assert f"did you mean <code>{meant}</code>?" in page.text


def test_nothing_is_suggested_for_what_is_like_nothing(http: httpx.Client) -> None:
    page = http.get("/sims/euler-angles?order=abc&velocity=9&yaw=x")
    assert page.status_code == 422
    assert "did you mean" not in page.text


def test_the_api_asks_what_was_meant_too(http: httpx.Client) -> None:
    answer = http.post("/api/sims/euler-angles/solve", json={"order": "ZYX", "Pitch": 3})
    words = [item["msg"] for item in answer.json()["detail"]]
    assert any("did you mean zyx?" in said for said in words)
    assert any("did you mean pitch?" in said for said in words)


@pytest.mark.parametrize(
    "path",
    ["/", "/sims", "/sims/camera", "/sims/camera/embed?fx=700", "/docs", "/openapi.json", "/healthz", "/api/sims",
     "/api/sims/camera", "/static/page.js", "/sims/nothing", "/sims/camera?fx=x"],
)  # fmt: skip
def test_head_answers_as_get_does_without_a_body_or_a_session(local: Local, path: str) -> None:
    before = local.sessions
    head = local.http.head(path)
    assert local.sessions == before
    get = local.http.get(path)
    assert head.status_code == get.status_code
    assert head.content == b""
    for name in ("content-type", "content-security-policy", "cache-control", "location", "retry-after"):
        assert head.headers.get(name) == get.headers.get(name)


@pytest.mark.parametrize("path", ["/sims", "/sims/"])
def test_the_folder_of_the_sims_leads_to_the_launcher(http: httpx.Client, path: str) -> None:
    page = http.get(path, follow_redirects=True)
    assert (page.status_code, page.url.path) == (200, "/")


def test_a_full_server_says_when_to_come_again() -> None:
    with Local(max_sessions=1) as local:
        assert local.http.get("/sims/camera/embed").status_code == 200
        full = local.http.get("/sims/camera/embed")
        assert full.status_code == 503
        assert int(full.headers["retry-after"]) > 0


@pytest.mark.parametrize("argument", ["yaw", "matrix"])
def test_parameters_for_which_no_geometry_exists_get_a_page(local: Local, argument: str) -> None:
    def solve(params: Any) -> Any:
        raise GeometryError(argument, "<b>45", "something else")

    sim = by_slug("euler-angles")
    assert sim is not None
    rooms = local.sessions
    before = sim.solve
    object.__setattr__(sim, "solve", solve)
    try:
        answer = local.http.get("/sims/euler-angles/embed?yaw=45&pitch=5")
    finally:
        object.__setattr__(sim, "solve", before)
    assert answer.status_code == 422
    assert "something else" in answer.text
    assert "<b>45" not in answer.text
    assert ("?pitch=5" in answer.text) == (argument == "yaw")
    assert local.sessions == rooms


@pytest.mark.parametrize("path", ["/sims/camera/", "/sims/camera/embed/", "/docs/"])
def test_a_slash_too_many_leads_on_without_naming_a_host(http: httpx.Client, path: str) -> None:
    answer = http.get(f"{path}?fx=700", follow_redirects=False)
    assert answer.status_code == 307
    assert answer.headers["location"] == f"{path.rstrip('/')}?fx=700"
