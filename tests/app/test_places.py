"""A server's rooms are for everybody: what one address may have, and what it is told beyond that."""

from __future__ import annotations

import re
from types import SimpleNamespace

import pytest
from playwright.sync_api import Page, expect

from app.rooms import places
from app.rooms.places import Fairness, Full, neighbourhood
from app.sockets.visits import IDLE
from tests.app.conftest import Local
from tests.app.page import Page as LearnersPage
from tests.app.page import closed


def rooms(*openers: str) -> list[SimpleNamespace]:
    return [SimpleNamespace(opener=opener) for opener in openers]


def test_one_address_has_so_many_rooms_and_others_have_theirs() -> None:
    fair = Fairness(2, 100)
    taken = rooms("10.0.0.1", "10.0.0.1", "10.0.0.2")
    with pytest.raises(Full, match="has 2 sims open"):
        fair.may_open("10.0.0.1", taken)
    fair.may_open("10.0.0.2", taken)
    fair.may_open("", taken + rooms("", "", ""))


def test_rooms_are_opened_no_faster_than_allowed(monkeypatch: pytest.MonkeyPatch) -> None:
    now = 100.0
    monkeypatch.setattr(places, "monotonic", lambda: now)
    fair = Fairness(1000, 60)
    for _ in range(60):
        fair.may_open("10.0.0.1", [])
    with pytest.raises(Full) as full:
        fair.may_open("10.0.0.1", [])
    assert full.value.wait == 1
    fair.may_open("10.0.0.2", [])
    now += 2.0
    for _ in range(2):
        fair.may_open("10.0.0.1", [])
    with pytest.raises(Full):
        fair.may_open("10.0.0.1", [])


def test_addresses_are_forgotten_in_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(places, "REMEMBERED", 3)
    fair = Fairness(10, 1)
    for k in range(5):
        fair.may_open(f"10.0.0.{k}", [])
    fair.may_open("10.0.0.0", [])  # a stranger again
    with pytest.raises(Full):
        fair.may_open("10.0.0.4", [])


@pytest.mark.parametrize(
    ("address", "known_as"),
    [
        ("192.0.2.7", "192.0.2.7"), ("::ffff:192.0.2.7", "192.0.2.7"), ("2001:db8:1:2:3:4:5:6", "2001:db8:1:2::"),
        ("2001:db8:1:2::9%eth0", "2001:db8:1:2::"), ("testclient", ""), ("", ""),
    ],
)  # fmt: skip
def test_of_an_address_its_household_counts(address: str, known_as: str) -> None:
    assert neighbourhood(address) == known_as


def test_who_has_too_many_is_told_in_words_and_tries_again_by_itself() -> None:
    with Local(max_sessions_per_address=3) as local:
        for _ in range(3):
            assert local.http.get("/sims/camera/embed").status_code == 200
        refused = local.http.get("/sims/camera/embed")
        assert refused.status_code == 503
        assert "has 3 sims open on this server" in refused.text
        wait = refused.headers["retry-after"]
        assert f'<meta http-equiv="refresh" content="{wait}">' in refused.text
        local.refused("full")
        assert local.http.get("/sims/camera").status_code == 200, "pages without a room are for everybody"


def test_a_room_in_which_nobody_does_anything_is_put_away_and_comes_back() -> None:
    with Local(idle_minutes=1e-9) as local, LearnersPage(local.url, "yaw=33") as page:
        local.sweep()
        assert {closed(page.channel), closed(page.viser)} == {IDLE}
        with LearnersPage(local.url, page.states[-1]["query"], key=page.key) as again:
            assert again.params["yaw"] == 33.0


@pytest.mark.e2e
def test_a_page_that_was_put_away_waits_for_a_touch(page: Page) -> None:
    with Local(idle_minutes=1e-9) as local:
        page.set_viewport_size({"width": 320, "height": 240})
        page.goto(f"{local.url}/sims/euler-angles/embed?yaw=33&controls=0")
        page.wait_for_function("window.sim3?.live")
        paused = page.get_by_role("heading", name="Paused")
        local.sweep()
        expect(paused).to_be_visible()
        page.wait_for_timeout(2000)
        expect(paused).to_be_visible()  # it doesn't come back by itself
        page.mouse.click(20, 20)
        expect(paused).to_be_hidden()
        expect(page).to_have_url(re.compile("yaw=33"))
