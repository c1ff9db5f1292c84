"""The scripts of a sim's page: kept for ever under the fingerprint of all, and asked for at once."""

from __future__ import annotations

import re

import httpx
import pytest

from app.routes.rendering import modules
from sims.kit import viser_client

PAGE = "/sims/euler-angles/embed"


def test_every_script_that_is_imported_is_asked_for_beforehand(http: httpx.Client) -> None:
    page = http.get(PAGE).text
    preloaded = re.findall(r'<link rel="modulepreload" href="([^"]*/viewer/[^"]*)" crossorigin>', page)
    assert {address.rpartition("/")[2] for address in preloaded} == {*modules()} - {"boot.js"}
    imported = {name for text in modules().values() for name in re.findall(rb'from "\./([\w.]+)";', text)}
    assert {name.decode() for name in imported} == {*modules()} - {"boot.js", "main.js"}
    for address in preloaded:
        answer = http.get(address)
        assert answer.status_code == 200
        assert answer.headers["content-type"].startswith("text/javascript")
        assert answer.headers["access-control-allow-origin"] == "*", "a sandboxed frame has an origin of its own"
        assert "immutable" in answer.headers["cache-control"]


def test_no_script_is_kept_under_a_wrong_fingerprint(http: httpx.Client) -> None:
    (address,) = re.findall(r'src="([^"]*/boot\.js)"', http.get(PAGE).text)
    start, _, name = address.rpartition("/")
    assert http.get(address).status_code == 200
    assert http.get(f"{start}x/{name}").status_code == 404
    assert http.get(f"{start}/none.js").status_code == 404
    assert http.get(f"{start}/..%2Fpage.js").status_code == 404


@pytest.mark.parametrize(
    ("accepted", "coding"),
    [
        ("gzip, deflate, br, zstd", "zstd"),
        ("gzip, deflate", "gzip"),
        ("zstd;q=0, gzip; q=0.5", "gzip"),
        ("identity", None),
        ("zstd;q=0.0", None),
    ],
)
def test_what_never_changes_comes_as_small_as_the_browser_can_read_it(
    http: httpx.Client, accepted: str, coding: str | None
) -> None:
    address = f"/viser/{viser_client.fingerprint()}/client.js"
    answer = http.get(address, headers={"accept-encoding": accepted})
    assert answer.headers.get("content-encoding") == coding
    assert "accept-encoding" in answer.headers["vary"].lower()
    assert answer.content == viser_client.files()["client.js"]
