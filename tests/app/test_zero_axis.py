"""A zero axis names no direction: pages and the API refuse it by name."""

from __future__ import annotations

import httpx


def test_the_api_refuses_a_zero_axis_by_name(http: httpx.Client) -> None:
    answer = http.post("/api/sims/quaternion/solve", json={"axis": [0, 0, 0]})
    assert answer.status_code == 422
    assert "axis must not be zero" in answer.json()["detail"][0]["msg"]


def test_a_link_to_a_zero_axis_is_refused_by_name_and_the_rest_is_kept(http: httpx.Client) -> None:
    for path in ("/sims/quaternion", "/sims/quaternion/embed"):
        page = http.get(f"{path}?axis=0,0,0&angle=30")
        assert page.status_code == 422
        assert "axis must not be zero" in page.text
        assert "angle=30" in page.text
