"""Live rooms: who steers, how many watch, and whose viewpoint the others follow."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any, cast

import numpy as np
import pytest
from starlette.websockets import WebSocket

from app.rooms import telling
from app.rooms.keys import new_key, room_of
from app.sockets.outgoing import MOST_WAITING, Outgoing
from sims.kit.scene.view import FIELD
from tests.app.conftest import Local
from tests.app.page import Page, closed, connect
from tests.server import camera_message

FROM_ABOVE = (1.0, -2.0, 6.0)
FROM_BELOW = (1.0, -2.0, -6.0)
CLICK = {
    "type": "SceneNodeClickMessage", "name": "/nothing", "instance_index": None, "ray_origin": (0.0, 0.0, 0.0),
    "ray_direction": (0.0, 0.0, 1.0), "screen_pos": (0.5, 0.5), "modifier": None, "owner": "",
}  # fmt: skip


class Room:
    """Pages that open the same room."""

    def __init__(self, url: str, stack: ExitStack) -> None:
        self._url = url
        self._stack = stack
        self.teacher = self.sit(Page(url))

    def sit(self, page: Page) -> Page:
        return self._stack.enter_context(page)

    def watch(self, **hello: Any) -> Page:
        return self.sit(Page(self._url, room=self.teacher.room, hello=hello))

    def helper(self) -> Page:
        """Another page with the key."""
        return self.sit(Page(self._url, key=self.teacher.key))

    def hand_over(self) -> str:
        """The ticket of a new link."""
        before = part(self.teacher).get("ticket")
        self.teacher.tell({"type": "lend", "on": True})
        self.teacher.until(lambda: part(self.teacher)["ticket"] not in ("", before), "a ticket")
        return str(part(self.teacher)["ticket"])

    def take_back(self) -> None:
        self.teacher.tell({"type": "lend", "on": False})
        self.teacher.until(lambda: part(self.teacher)["ticket"] == "", "the ticket to be worth nothing")


@pytest.fixture
def room(local: Local) -> Iterator[Room]:
    with ExitStack() as stack:
        yield Room(local.url, stack)


def part(page: Page) -> dict[str, Any]:
    """What a page was told last of its part in the room."""
    return next((m for m in reversed(page.told) if m["type"] == "room"), {})


def seen_from(page: Page) -> tuple[float, ...]:
    """Where the server has led a page's viewpoint; nothing if it hasn't yet."""
    return tuple(page.led.get("view", ())[:3])


def look(page: Page, position: tuple[float, float, float], **more: Any) -> None:
    """Turn the view by hand, as viser's client tells it."""
    page.send({**camera_message(), "position": position, "fov": FIELD, **more})


def led_to(page: Page, position: tuple[float, float, float]) -> None:
    """Wait until a page's view is led somewhere."""
    page.until(lambda: seen_from(page) and np.allclose(seen_from(page), position), f"the view from {position}")


def test_the_driver_knows_how_many_watch_and_watchers_don_t(room: Room) -> None:
    first, second = room.watch(), room.watch()
    room.teacher.until(lambda: part(room.teacher).get("watchers") == 2, "two who watch")
    room.helper()
    room.teacher.settle()
    assert part(room.teacher)["watchers"] == 2, "who has the key doesn't watch"
    first.settle()
    assert "watchers" not in part(first)
    assert "ticket" not in part(first)
    second.close()
    room.teacher.until(lambda: part(room.teacher)["watchers"] == 1, "one who watches")


def test_only_the_first_page_with_control_is_told_that_the_room_begins_with_its_state(local: Local) -> None:
    key = new_key()
    with ExitStack() as stack:
        kinds: tuple[dict[str, Any], ...] = ({"room": room_of(key)}, {"key": key}, {"key": key})
        pages = [stack.enter_context(Page(local.url, "yaw=5", **kind)) for kind in kinds]
        assert [page.states[0]["begins"] for page in pages] == [False, True, False]


def test_a_watcher_follows_the_viewpoint_lets_go_and_rejoins(room: Room) -> None:
    watcher = room.watch()
    look(room.teacher, FROM_ABOVE)
    led_to(watcher, FROM_ABOVE)
    late = room.watch()
    led_to(late, FROM_ABOVE)

    watcher.tell({"type": "follow", "on": False})
    watcher.until(lambda: not part(watcher)["follows"], "the view to be let go")
    look(room.teacher, FROM_BELOW)
    led_to(late, FROM_BELOW)
    watcher.settle()
    assert np.allclose(seen_from(watcher), FROM_ABOVE)

    watcher.tell({"type": "follow", "on": True})
    led_to(watcher, FROM_BELOW)
    assert part(watcher)["follows"]


def test_who_had_let_go_before_the_connection_broke_off_is_not_led(room: Room) -> None:
    look(room.teacher, FROM_ABOVE)
    follower = room.watch()
    led_to(follower, FROM_ABOVE)
    free = room.watch(follows=False)
    free.settle()
    assert not seen_from(free)


def test_all_who_follow_are_told_the_same_and_it_is_encoded_once(room: Room, monkeypatch: pytest.MonkeyPatch) -> None:
    watchers = [room.watch() for _ in range(3)]
    look(room.teacher, FROM_BELOW)
    for watcher in watchers:
        led_to(watcher, FROM_BELOW)
    encoded: list[str] = []
    whole = telling.encode

    def counted(message: Any) -> str:
        encoded.append(message["type"])
        return whole(message)

    monkeypatch.setattr(telling, "encode", counted)
    look(room.teacher, FROM_ABOVE, image_width=1600, image_height=800)
    room.teacher.slide("yaw", 33)
    for watcher in watchers:
        led_to(watcher, FROM_ABOVE)
        watcher.until(lambda page=watcher: page.params["yaw"] == 33, "the state")  # type: ignore[misc]
    assert watchers[0].led["aspect"] == 2.0, "pages of other shapes see the same"
    assert encoded.count("led") == encoded.count("show") == 1


def test_watchers_lead_nobody_and_hand_nothing_over(local: Local, room: Room) -> None:
    watcher, other = room.watch(), room.watch()
    look(room.teacher, FROM_ABOVE)
    led_to(other, FROM_ABOVE)
    before = local.refusals["watching"]
    look(watcher, FROM_BELOW)
    watcher.tell({"type": "lend", "on": True})
    local.refused("watching", before)
    look(room.teacher, (3.0, 3.0, 3.0))
    led_to(other, (3.0, 3.0, 3.0))
    assert part(room.teacher)["ticket"] == ""


def test_who_is_handed_over_to_steers_until_it_is_taken_back(local: Local, room: Room) -> None:
    ticket = room.hand_over()
    helped = room.watch(ticket=ticket)
    helped.until(lambda: part(helped).get("steers"), "control")
    helped.slide("yaw", 77)
    room.teacher.until(lambda: room.teacher.params["yaw"] == 77, "what the other sets")
    assert part(room.teacher)["helpers"] == 1
    room.teacher.slide("pitch", 11)
    helped.until(lambda: helped.params["pitch"] == 11, "what the one with the key sets")

    before = local.refusals["watching"]
    helped.tell({"type": "lend", "on": False})
    local.refused("watching", before)

    room.take_back()
    helped.until(lambda: not part(helped)["steers"], "control to be taken")
    helped.slide("yaw", -5)
    local.refused("watching", before + 1)
    again = room.watch(ticket=ticket)
    again.settle()
    assert not part(again)["steers"]
    room.teacher.settle()
    assert room.teacher.params["yaw"] == 77


def test_a_new_link_takes_control_from_who_has_the_old_one(room: Room) -> None:
    helped = room.watch(ticket=room.hand_over())
    helped.until(lambda: part(helped).get("steers"), "control")
    room.hand_over()
    helped.until(lambda: not part(helped)["steers"], "control to be taken")


@pytest.mark.parametrize("ticket", ["", "x", "ü", "0" * 60])
def test_no_other_ticket_steers(room: Room, ticket: str) -> None:
    without = room.watch(ticket=ticket)
    room.hand_over()
    without.settle()
    assert not part(without)["steers"]


def test_a_page_that_keeps_its_scene_alone_steers_no_more(local: Local, room: Room) -> None:
    helped = room.watch(ticket=room.hand_over())
    helped.until(lambda: part(helped).get("steers"), "control")
    room.teacher.until(lambda: part(room.teacher)["helpers"] == 1, "the other to be known")
    helped.channel.close()
    room.teacher.until(lambda: part(room.teacher)["helpers"] == 0, "the other to be gone")
    before = local.refusals["watching"]
    helped.send(CLICK)
    local.refused("watching", before)


def test_the_newest_who_turns_the_view_leads_and_the_others_follow(room: Room) -> None:
    helped = room.watch(ticket=room.hand_over())
    watcher = room.watch()
    look(room.teacher, FROM_ABOVE)
    led_to(helped, FROM_ABOVE)
    look(helped, FROM_ABOVE)  # its client tells that it is there
    look(helped, FROM_BELOW)  # on its way still: a view that is led leads nobody
    helped.settle()
    assert part(helped)["follows"]

    helped.tell({"type": "follow", "on": False})
    led_to(watcher, FROM_BELOW)
    led_to(room.teacher, FROM_BELOW)
    room.take_back()
    watcher.until(lambda: np.allclose(seen_from(watcher), FROM_ABOVE), "the view of who has the key")


def test_two_with_the_key_have_views_of_their_own(room: Room) -> None:
    helper, watcher = room.helper(), room.watch()
    look(room.teacher, FROM_ABOVE)
    led_to(watcher, FROM_ABOVE)
    look(helper, FROM_ABOVE)
    look(helper, FROM_BELOW)
    led_to(watcher, FROM_BELOW)
    room.teacher.settle()
    assert not seen_from(room.teacher)


def test_a_server_that_begins_anew_learns_from_the_driver_what_is_handed_over(local: Local) -> None:
    hello = {"ticket": "a-ticket-of-before"}
    with Page(local.url, hello=hello) as teacher, Page(local.url, room=teacher.room, hello=hello) as helped:
        helped.until(lambda: part(helped).get("steers"), "control")
        with Page(local.url, key=teacher.key, hello={"ticket": "another"}):
            teacher.settle()
            assert part(teacher)["ticket"] == hello["ticket"], "only who begins a room brings one"


def test_who_looks_through_a_camera_of_the_sim_leads_by_the_state_alone(room: Room) -> None:
    watcher = room.watch()
    look(room.teacher, FROM_ABOVE)
    led_to(watcher, FROM_ABOVE)
    look(room.teacher, FROM_BELOW, fov=1.2)
    look(room.teacher, (4.0, 4.0, 4.0))
    led_to(watcher, (4.0, 4.0, 4.0))


def test_a_longer_ticket_is_nonsense(local: Local, room: Room) -> None:
    channel = connect(f"{room.teacher.address}channel?viewer=0123456789", viser=False)
    channel.send('{"type": "hello", "dark": false, "reduced": false, "query": "", "ticket": "%s"}' % ("0" * 61))
    assert closed(channel) == 1008


def test_of_the_viewpoints_that_wait_for_a_slow_page_the_newest_is_sent() -> None:
    sent: list[dict[str, Any]] = []

    class Page:
        async def send_text(self, text: str) -> None:
            sent.append(json.loads(text))

    async def told() -> None:
        outgoing = Outgoing(cast("WebSocket", Page()))
        for k in range(2 * MOST_WAITING):
            outgoing.put({"type": "led", "view": [k]})
            outgoing.put({"type": "show", "version": k, "values": {f"{k}": k}, "parts": {}})
        outgoing.put({"type": "point", "name": ""})
        sending = asyncio.create_task(outgoing.send())
        while len(sent) < 3:
            await asyncio.sleep(0)
        sending.cancel()

    asyncio.run(told())
    led, show, point = sent
    assert led["view"] == [2 * MOST_WAITING - 1]
    assert len(show["values"]) == 2 * MOST_WAITING, "nothing of what is to show is lost"
    assert point["type"] == "point"
