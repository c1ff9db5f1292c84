"""Pins what sims/kit/viser_internals.py takes for granted about viser, and checks what it makes of it.

When one of the first tests fails, viser has changed: see what took the place of the name, mend
sims/kit/viser_internals.py, and only then this file.
"""

from __future__ import annotations

import asyncio
import dataclasses
import inspect
import itertools
import re
import socket
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any, get_type_hints

import numpy as np
import pytest
import viser
import websockets.asyncio.server
from viser import _messages, _scene_handles
from viser._assignable_props_api import AssignablePropsBase
from viser._gui_handles import _GuiHandleState
from viser._scene_handles import _SceneNodeHandleState
from viser.infra._infra import WebsockClientConnection, WebsockServer
from websockets.exceptions import ConnectionClosedOK

from sims import SIMS
from sims.kit import viser_internals
from sims.kit.recording import Recorder
from sims.kit.viser_internals import (
    PROTOCOL,
    ViserHost,
    Wire,
    send_pose,
    set_pose,
    set_property,
    set_visible,
)
from tests.server import Rig

VISER = Path(viser.__file__).parent
PINNED = {
    "_assignable_props_api",
    "_prop_hints",
    "_scene_api",
    "_set_pose_vector",
    "_impl",
    "_live_connections",
    "_owner_id",
    "_state",
    "_websock_connection",
    "_websock_interface",
    "_websock_server",
}
OWN = {"_handler", "_send", "_waiting", "_newest", "_taken", "_arrived", "_take_over"}


# ---- viser is as it was


def test_viser_is_the_version_that_was_looked_at() -> None:
    assert viser.__version__.rsplit(".", 1)[0] == "1.1", "pyproject.toml pins one minor version of viser"


def test_every_private_name_in_use_is_pinned_here() -> None:
    source = Path(viser_internals.__file__).read_text(encoding="utf-8")
    used = set(re.findall(r"(?<=\.)_[a-z]\w*", source))
    assert used - OWN == PINNED


def test_viser_starts_its_socket_with_the_function_that_we_replace() -> None:
    source = inspect.getsource(WebsockServer._background_worker)
    assert "websockets.asyncio.server.serve(" in source
    assert "serve_future.server.sockets" in source
    assert list(inspect.signature(websockets.asyncio.server.serve.__init__).parameters)[1:2] == ["handler"]


def test_viser_uses_of_a_connection_what_a_wire_has() -> None:
    source = inspect.getsource(WebsockServer._background_worker)
    source = source[source.index("async def ws_handler") : source.index("# Host client on the same port")]
    used = set(re.findall(r"\bconnection\.(\w+)", source)) | set(re.findall(r"\bwebsocket\.(\w+)", _pumps()))
    assert used <= {"subprotocol", "close", "send", "recv"}


def _pumps() -> str:
    from viser.infra import _infra

    return inspect.getsource(_infra._message_producer) + inspect.getsource(_infra._message_consumer)


def test_connections_are_kept_by_client_id() -> None:
    source = inspect.getsource(WebsockServer._background_worker)
    assert "self._live_connections[client_id] = connection" in source


def test_handles_keep_state_where_we_read_it() -> None:
    names = {f.name for f in dataclasses.fields(_SceneNodeHandleState)}
    assert {"name", "props", "api", "wxyz", "position", "visible"} <= names
    names = {f.name for f in dataclasses.fields(_GuiHandleState)}
    assert {"uuid", "value", "props", "gui_api"} <= names


def test_a_client_without_a_browser_is_as_one_with_one(rig: Rig) -> None:
    outbox = Recorder(rig.host.viser.loop)
    client = rig.host.viser.alone(outbox)
    assert vars(client.camera._state).keys() == vars(rig.browser.client.camera._state).keys()
    assert client.camera.image_width > client.camera.image_height > 0
    client.scene.add_frame("/alone")
    client.flush()
    assert "/alone" in [getattr(message, "name", "") for message in outbox.taken()]
    assert outbox.taken() == []
    assert client.client_id not in rig.host.viser.server.get_clients()


def test_type_hints_of_a_handle_are_those_that_viser_would_work_out(rig: Rig) -> None:
    source = inspect.getsource(inspect.getmodule(AssignablePropsBase) or AssignablePropsBase)
    assert "return get_type_hints(type(self._impl.props))" in source
    frame, label = rig.host.call(
        lambda: (rig.browser.client.scene.add_frame("/hints"), rig.browser.client.scene.add_label("/hints/x", "x"))
    )
    for handle in (frame, label):
        assert handle._prop_hints == get_type_hints(type(handle._impl.props))
    assert frame._prop_hints is not label._prop_hints
    rig.host.call(frame.remove)


@pytest.mark.parametrize(
    ("message", "fields"),
    [
        (_messages.SetOrientationMessage, ["name", "wxyz", "owner"]),
        (_messages.SetPositionMessage, ["name", "position", "owner"]),
        (_messages.SetSceneNodeVisibilityMessage, ["name", "visible", "owner"]),
    ],
)
def test_messages_have_the_fields_that_we_fill(message: Any, fields: list[str]) -> None:
    assert [f.name for f in dataclasses.fields(message)] == fields


def test_setters_still_leave_out_small_changes() -> None:
    """The reason for `set_pose`; once this fails, viser's own setters may do."""
    source = Path(_scene_handles.__file__).read_text(encoding="utf-8")
    assert source.count("_set_pose_vector(") == 5, "its setters call it"
    own = (
        "    value_cast: _PoseTupleT = cast_vector(value, length)\n    value_arr = np.asarray(value_cast)\n"
        "    if np.allclose(value_arr, current):\n        return\n"
        "    current[:] = value_arr\n    queue(make_message(value_cast))\n"
    )
    assert own in source, "what ours does too"


def test_setters_leave_out_what_those_of_viser_do() -> None:
    numbers = [0.0, -0.0, 1e-8, 1.1e-8, 0.5, 0.500005, 0.50001, -0.5, 3, 1e300, np.inf, -np.inf, np.nan]
    for old, new in itertools.product(numbers, repeat=2):
        current, sent = np.array([0.5, old, 0.0]), list[Any]()
        with np.errstate(invalid="ignore"):
            same = np.allclose((0.5, new, 0.0), current)
        _scene_handles._set_pose_vector(
            current, (0.5, new, 0.0), 3, sent.append, partial(_messages.SetPositionMessage, "/node")
        )
        assert [message.position for message in sent] == ([] if same else [(0.5, new, 0.0)])
        np.testing.assert_array_equal(current, [0.5, old if same else new, 0.0])


def test_client_and_server_speak_of_the_same_version() -> None:
    assert f"viser-v{viser.__version__}" == PROTOCOL
    version = (VISER / "client/src/VersionInfo.ts").read_text(encoding="utf-8")
    assert f'"{viser.__version__}"' in version


def test_client_takes_its_websocket_address_from_the_path() -> None:
    source = (VISER / "client/src/App.tsx").read_text(encoding="utf-8")
    assert "window.location.href" in source
    assert 'replace("http://", "ws://")' in source


# ---- the host


@pytest.fixture(scope="module")
def rig() -> Iterator[Rig]:
    made = Rig(SIMS[0])
    yield made
    made.close()
    assert not made.problems()


def test_host_knows_the_wire_of_each_viewer(rig: Rig) -> None:
    assert rig.host.viser.wire_of(rig.browser.client) is rig.browser.wire


def test_host_listens_nowhere(monkeypatch: pytest.MonkeyPatch) -> None:
    listened: list[Any] = []
    monkeypatch.setattr(socket.socket, "listen", lambda own, *_: listened.append(own))
    monkeypatch.setattr(asyncio.BaseEventLoop, "create_server", lambda *a, **k: listened.append(a))
    host = ViserHost()
    try:
        assert host.loop.is_running()
        assert not listened
    finally:
        host.stop()
    assert not host.loop.is_running()


def test_host_turns_away_another_version(rig: Rig) -> None:
    async def send(_: bytes) -> None: ...

    wire = Wire(send, lambda client: None, "viser-v0.0.1")
    rig.host.wait(rig.host.viser.connect(wire))
    assert wire.closed.is_set()


# ---- poses, values, properties


@pytest.fixture
def node(rig: Rig) -> Iterator[viser.FrameHandle]:
    frame = rig.host.call(lambda: rig.browser.client.scene.add_frame("/probe"))
    yield frame
    rig.host.call(frame.remove)
    rig.settle()


def messages_of(rig: Rig, work: Callable[[], object]) -> int:
    """How many messages something sends, besides the one that ends the waiting."""
    rig.settle()
    before = rig.model.messages
    rig.host.call(work)
    rig.settle()
    return rig.model.messages - before - 1


def test_pose_arrives_exactly(rig: Rig, node: viser.FrameHandle) -> None:
    wxyz, position = (0.8, 0.36, 0.48, 1e-300), (1 / 3, -1e-12, 1e9)
    rig.host.call(lambda: set_pose(node, wxyz, position))
    rig.settle()
    assert rig.model.node("/probe").wxyz == wxyz
    assert rig.model.node("/probe").position == position
    assert tuple(node.wxyz) == wxyz
    assert tuple(node.position) == position


def test_the_same_pose_is_not_sent_again(rig: Rig, node: viser.FrameHandle) -> None:
    wxyz, position = (0.6, 0.8, 0.0, 0.0), (1.0, 2.0, 3.0)
    assert messages_of(rig, lambda: set_pose(node, wxyz, position)) == 2
    assert messages_of(rig, lambda: set_pose(node, wxyz, position)) == 0
    assert messages_of(rig, lambda: set_pose(node, (0.6, 0.8, 0.0, 1e-17), position)) == 1
    assert messages_of(rig, lambda: set_pose(node)) == 0


def test_many_poses_at_once_are_one_message(rig: Rig, node: viser.FrameHandle) -> None:
    def move() -> None:
        for k in range(100):
            set_pose(node, position=(k + 1.0, 0.0, 0.0))

    assert messages_of(rig, move) == 1
    assert rig.model.node("/probe").position == (100.0, 0.0, 0.0)


def test_node_made_anew_at_once_stands_at_its_own_pose(rig: Rig) -> None:
    scene = rig.browser.client.scene
    first = rig.host.call(lambda: scene.add_frame("/again", position=(1.0, 2.0, 3.0)))
    rig.settle()

    def again() -> viser.FrameHandle:
        first.remove()
        second = scene.add_frame("/again")
        send_pose(second)
        return second

    second = rig.host.call(again)
    rig.settle()
    np.testing.assert_array_equal(rig.model.world_pose("/again"), np.eye(4))
    rig.host.call(second.remove)


def test_visibility_is_sent_when_it_changes(rig: Rig, node: viser.FrameHandle) -> None:
    assert messages_of(rig, lambda: set_visible(node, True)) == 0
    assert messages_of(rig, lambda: set_visible(node, False)) == 1
    assert not rig.model.visible("/probe")
    assert not node.visible


def test_property_arrives_as_it_is(rig: Rig) -> None:
    scene = rig.browser.client.scene
    points = np.zeros((2, 2, 3), np.float32)
    lines = rig.host.call(lambda: scene.add_line_segments("/segments", points, colors=(0, 0, 0)))
    moved = np.arange(12, dtype=np.float32).reshape(2, 2, 3)
    rig.host.call(lambda: set_property(lines, "points", moved))
    rig.settle()
    np.testing.assert_array_equal(rig.model.points("/segments"), moved)
    np.testing.assert_array_equal(lines.points, moved)
    rig.host.call(lines.remove)


def test_connection_is_forgotten_when_it_ends(rig: Rig) -> None:
    server: Any = rig.host.viser.server
    internals: WebsockServer = server._websock_server
    before = len(internals._live_connections), len(server.get_clients())
    second = rig.join()
    assert len(internals._live_connections) == before[0] + 1
    assert isinstance(second.client._websock_connection, WebsockClientConnection)
    second.leave()
    rig.browsers.remove(second)
    assert (len(internals._live_connections), len(server.get_clients())) == before


# ---- the wire


async def nothing(_: bytes) -> None: ...


def received(*messages: tuple[str, str | None]) -> list[str]:
    """What viser takes of messages that were waiting."""

    async def run() -> list[str]:
        wire = Wire(nothing, None)
        for text, value_of in messages:
            wire.feed(text.encode(), value_of)
        wire.hang_up()
        taken = []
        with suppress(ConnectionClosedOK):
            while True:
                taken.append((await wire.recv()).decode())
        return taken

    return asyncio.run(run())


def test_of_waiting_values_only_the_newest_goes_on() -> None:
    assert received(("a1", "a"), ("a2", "a"), ("a3", "a")) == ["a3"]
    assert received(("a1", "a"), ("b1", "b"), ("a2", "a"), ("b2", "b")) == ["a2", "b2"]


def test_presses_all_go_on_and_keep_their_place() -> None:
    assert received(("press", None), ("press", None)) == ["press", "press"]
    assert received(("a1", "a"), ("press", None), ("a2", "a")) == ["a1", "press", "a2"]
    assert received(("a1", "a"), ("a2", "a"), ("end", None), ("a3", "a"), ("a4", "a")) == ["a2", "end", "a4"]


def test_value_that_viser_has_taken_is_not_replaced() -> None:
    async def run() -> list[bytes]:
        wire = Wire(nothing, None)
        taken = []
        for k in range(3):
            wire.feed(b"a%d" % k, "a")
            wire.feed(b"b%d" % k, "b")
            taken += [await wire.recv(), await wire.recv()]
        return taken

    assert asyncio.run(run()) == [b"a0", b"b0", b"a1", b"b1", b"a2", b"b2"]


def test_values_are_replaced_while_viser_takes_others() -> None:
    async def run() -> list[bytes]:
        wire = Wire(nothing, None)
        for name in ("a", "b", "c"):
            wire.feed(f"{name}1".encode(), name)
        first = await wire.recv()
        for name in ("a", "b", "c"):
            wire.feed(f"{name}2".encode(), name)
        return [first, *[await wire.recv() for _ in range(3)]]

    assert asyncio.run(run()) == [b"a1", b"b2", b"c2", b"a2"]


def test_waiting_stays_short_however_much_comes() -> None:
    messages = [(f"{k}", f"{k % 5}") for k in range(10_000)]
    assert received(*messages) == ["9995", "9996", "9997", "9998", "9999"]


def test_receiving_waits_for_a_message_or_the_end() -> None:
    async def run() -> None:
        wire = Wire(nothing, None)
        waiting = asyncio.create_task(wire.recv())
        await asyncio.sleep(0)
        wire.feed(b"late")
        assert await waiting == b"late"
        ending = asyncio.create_task(wire.recv())
        await asyncio.sleep(0)
        wire.hang_up()
        with pytest.raises(ConnectionClosedOK):
            await ending
        with pytest.raises(ConnectionClosedOK):
            await wire.send(b"too late")

    asyncio.run(run())


def test_sending_passes_bytes_on() -> None:
    sent: list[bytes] = []

    async def keep(data: bytes) -> None:
        sent.append(data)

    async def run() -> None:
        wire = Wire(keep, "context")
        await wire.send(b"frame")
        await wire.close()
        assert wire.closed.is_set()
        assert wire.context == "context"
        assert wire.subprotocol == PROTOCOL

    asyncio.run(run())
    assert sent == [b"frame"]
