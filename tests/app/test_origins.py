"""Origins are compared as origins: scheme, host and port, however they are written."""

from __future__ import annotations

import pytest
from starlette.datastructures import Headers

from app.sockets import origins

SCHOOL = {origins.parse("https://school.example")}


def wrong(origin: str | None, host: str, *, secure: bool = False, forwarded: str = "") -> str:
    """Which header doesn't fit, if any does not."""
    headers = {"host": host, **({"origin": origin} if origin is not None else {})}
    if forwarded:
        headers["x-forwarded-host"] = forwarded
    found = origins.mismatch(Headers(headers), secure, SCHOOL)
    return "" if found is None else found.header or "Origin"


@pytest.mark.parametrize(
    ("origin", "host", "secure"),
    [
        ("https://x.org", "x.org", True),
        ("https://x.org", "x.org:443", True),
        ("https://x.org:443", "x.org", True),
        ("https://x.org", "X.ORG:443", True),
        ("http://x.org", "x.org:80", False),
        ("http://x.org:8000", "x.org:8000", False),
        ("https://x.org", "x.org", False),  # a proxy ended TLS and didn't say so
        ("https://x.org", "x.org:443", False),
        ("http://[::1]:8000", "[0:0:0:0:0:0:0:1]:8000", False),
        ("https://school.example", "x.org", False),
        ("https://SCHOOL.example:443", "x.org", False),
        ("null", "x.org", True),
        (None, "x.org", True),
    ],
)
def test_own_pages_and_those_named_may_come(origin: str | None, host: str, secure: bool) -> None:
    assert not wrong(origin, host, secure=secure)


@pytest.mark.parametrize(
    ("origin", "host", "header"),
    [
        ("https://x.org", "backend:8000", "Host"),
        ("https://x.org", "x.org:8443", "Host"),
        ("http://x.org", "x.org:443", "Host"),
        ("https://x.org:8443", "x.org", "Host"),
        ("https://x.org.evil.example", "x.org", "Host"),
        ("http://school.example", "x.org", "Host"),
        ("http://[", "[", "Origin"),
        ("http://x.org/", "x.org", "Origin"),
        ("http://a@x.org", "x.org", "Origin"),
        ("http://x.org:99999", "x.org:99999", "Origin"),
        ("chrome-extension://abc", "x.org", "Origin"),
        ("https://x.org", "", "Host"),
    ],
)
def test_others_are_refused_and_the_wrong_header_is_named(origin: str, host: str, header: str) -> None:
    assert wrong(origin, host) == header


def test_a_page_without_tls_of_a_server_with_it_is_another() -> None:
    assert wrong("http://x.org", "x.org", secure=True) == "X-Forwarded-Proto"


def test_a_forwarded_host_that_is_not_believed_is_hinted_at() -> None:
    found = origins.mismatch(
        Headers({"host": "backend", "origin": "https://x.org", "x-forwarded-host": "x.org"}), False, ()
    )
    assert found is not None
    assert "FORWARDED_ALLOW_IPS" in found.line()


def test_reasons_fit_a_websockets_close_frame() -> None:
    for origin, host in (("https://" + "é" * 300, "x"), ("https://" + "a" * 300 + ".org", "b" * 300)):
        found = origins.mismatch(Headers({"host": host, "origin": origin.encode().decode("latin-1")}), False, ())
        assert found is not None
        assert len(found.reason().encode()) <= origins.LONGEST_REASON
