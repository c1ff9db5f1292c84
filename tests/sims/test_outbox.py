"""What waits for a page: the newest of each thing, in the order of the last changes, and nothing for who is gone."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Coroutine
from typing import Any

import numpy as np
import pytest
from viser import _messages
from websockets.exceptions import ConnectionClosedOK

from sims.kit.outbox import Change, Outbox
from tests.frames import Message, decode_frame


class Page:
    """The other end, which may be slow, and may go."""

    def __init__(self) -> None:
        self.windows: list[list[Message]] = []
        self.reading = asyncio.Event()
        self.reading.set()
        self.gone = False
        self.outbox = Outbox(self.take, asyncio.get_running_loop())

    async def take(self, data: bytes) -> None:
        await self.reading.wait()
        if self.gone:
            raise ConnectionClosedOK(None, None)
        self.windows.append(decode_frame(data))

    @property
    def values(self) -> list[list[Any]]:
        return [[message["updates"]["value"] for message in window] for window in self.windows]

    def put(self, name: str, value: Any) -> None:
        body = {"type": "GuiUpdateMessage", "uuid": name, "updates": {"value": value}}
        self.outbox.put((name, "value"), Change(("gui", name), body))


def run(test: Callable[[Page], Coroutine[Any, Any, None]]) -> None:
    async def with_page() -> None:
        await test(Page())

    asyncio.run(asyncio.wait_for(with_page(), 20))


async def turn() -> None:
    for _ in range(4):
        await asyncio.sleep(0)


def test_what_is_put_in_one_turn_leaves_together_at_the_next() -> None:
    async def test(page: Page) -> None:
        for k in range(100):
            page.put("a", k)
            page.put("b", -k)
        assert not page.windows
        await turn()
        assert page.values == [[99, -99]]

    run(test)


def test_what_changed_last_leaves_last() -> None:
    async def test(page: Page) -> None:
        for name in ("a", "b", "a"):
            page.put(name, name)
        await turn()
        assert page.values == [["b", "a"]]

    run(test)


def test_a_flush_sends_before_it_returns() -> None:
    async def test(page: Page) -> None:
        page.put("a", 1)
        page.outbox.flush()
        assert page.values == [[1]]
        await turn()
        assert page.values == [[1]], "and only once"

    run(test)


def test_while_a_page_does_not_read_the_next_window_gathers() -> None:
    async def test(page: Page) -> None:
        page.reading.clear()
        for k in range(50):
            page.put("a", k)
            page.outbox.flush()
            await turn()
        assert not page.windows
        page.reading.set()
        await turn()
        assert page.values == [[0], [49]]

    run(test)


def test_nothing_leaves_inside_an_atomic_block() -> None:
    async def test(page: Page) -> None:
        page.outbox.atomic_start()
        page.outbox.atomic_start()
        page.put("a", 1)
        page.outbox.atomic_end()
        page.outbox.flush()
        await turn()
        assert not page.windows
        page.outbox.atomic_end()
        await turn()
        assert page.values == [[1]]

    run(test)


@pytest.mark.parametrize("slow", [False, True])
def test_who_is_gone_gets_nothing_more_and_nothing_is_kept(slow: bool) -> None:
    async def test(page: Page) -> None:
        page.gone = True
        if slow:
            page.reading.clear()
        page.put("a", 1)
        await turn()
        page.reading.set()
        await turn()
        assert page.outbox.done
        page.put("a", 2)
        await turn()
        assert not page.windows
        assert not page.outbox._waiting

    run(test)


def test_other_threads_may_put() -> None:
    async def test(page: Page) -> None:
        thread = threading.Thread(target=page.put, args=("a", 1))
        thread.start()
        while not page.windows:
            await asyncio.sleep(0.001)
        thread.join()
        assert page.values == [[1]]

    run(test)


def test_arrays_arrive_as_they_are() -> None:
    async def test(page: Page) -> None:
        points = np.arange(24, dtype=np.float32).reshape(4, 6)[::2, ::-1]
        colors = np.arange(5, dtype=np.uint8)
        for name, array in (("points", points), ("colors", colors)):
            body = {"type": "SceneNodeUpdateMessage", "name": "/n", "owner": ""}
            page.outbox.put(("/n", name), Change(("scene", "/n"), body, (name, array)))
        await turn()
        (window,) = page.windows
        np.testing.assert_array_equal(window[0]["updates"]["points"].reshape(2, 6), points)
        np.testing.assert_array_equal(window[1]["updates"]["colors"], colors)

    run(test)


def pose(name: str) -> Change:
    return Change(("scene", name), {"type": "SetPositionMessage", "name": name, "position": (1.0, 2.0, 3.0)})


def test_a_removed_node_leaves_no_changes_behind() -> None:
    async def test(page: Page) -> None:
        for name in ("/a", "/b"):
            page.outbox.put((name, "position"), pose(name))
            page.outbox.push(_messages.SetSceneNodeClickBindingsMessage(name, ()))
        page.outbox.push(_messages.RemoveSceneNodeMessage("/a"))
        await turn()
        (window,) = page.windows
        assert [(m["type"], m["name"]) for m in window] == [
            ("SetSceneNodeClickBindingsMessage", "/a"),
            ("SetPositionMessage", "/b"),
            ("SetSceneNodeClickBindingsMessage", "/b"),
            ("RemoveSceneNodeMessage", "/a"),
        ], "what can be clicked is told by messages that don't belong to the node"

    run(test)


def test_a_node_in_anothers_place_inherits_nothing() -> None:
    async def test(page: Page) -> None:
        page.outbox.put(("/a", "position"), pose("/a"))
        page.outbox.push(_messages.SetSceneNodeClickBindingsMessage("/a", ()))
        page.outbox.remove_entity_state_from_buffer("scene", "/a")
        await turn()
        assert not page.windows

    run(test)


def test_what_is_meant_for_the_others_is_not_for_this_page() -> None:
    async def test(page: Page) -> None:
        message = _messages.GuiUpdateMessage("a", {"value": 1})
        message.excluded_self_client = 0  # type: ignore[assignment]
        page.outbox.push(message)
        await turn()
        assert not page.windows

    run(test)
