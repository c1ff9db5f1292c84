"""Hostile and broken clients on both websockets, while a learner in another room works on undisturbed."""

from __future__ import annotations

import gc
import itertools
import json
import random
import socket
from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Any

import httpx
import msgspec
import pytest
from websockets.exceptions import ConnectionClosed

from app.rooms.keys import new_key, room_of
from app.sockets import channel as channels
from app.sockets import scene
from app.sockets.protocol import LARGEST
from app.sockets.scene import Link
from app.sockets.visits import Visit
from sims.kit.viewer import Viewer
from sims.kit.viser_internals import PROTOCOL, Wire
from tests.app.conftest import Local
from tests.app.page import SLUG, Page, closed, connect
from tests.frames import encode_message
from tests.server import Server, camera_message, wait_for

NAN, INFINITE = float("nan"), float("inf")
VECTOR, PLACE = (0.0, 0.0, 0.0), (0.5, 0.5)


@pytest.fixture(scope="module")
def learner(local: Local) -> Iterator[Page]:
    """Somebody who only wants to learn."""
    with Page(local.url) as page:
        yield page


@pytest.fixture(scope="module")
def visitors(local: Local) -> Iterator[Callable[[], Page]]:
    """Pages to misuse; each a few times only, for the server has little patience with one that makes no sense."""
    pages: list[Page] = []
    uses = itertools.count()

    def visitor() -> Page:
        if next(uses) % 12 == 0 or any(s.close_code for s in (pages[-1].viser, pages[-1].channel)):
            pages.append(Page(local.url))
        return pages[-1]

    yield visitor
    for page in pages:
        page.close()


@pytest.fixture
def visitor(visitors: Callable[[], Page], learner: Page) -> Iterator[Page]:
    """A page to misuse. When it has been, the learner's still works."""
    yield visitors()
    learner.works()


# ---- what isn't a message at all


def garbage() -> Iterator[bytes]:
    chance = random.Random(7)
    for length in (1, 2, 3, 7, 16, 100, 1000, 16_000):
        yield chance.randbytes(length)
    yield from (msgspec.msgpack.encode(value) for value in (None, True, 17, 1.5, "text", [], {}, [1, 2], {"type": 3}))
    yield from (b"\x91" * 16_000, b"\x81\xa4type" * 2_000, b"\xdd\xff\xff\xff\xff", b"\xc6\xff\xff\xff\xff", b"")


@pytest.mark.parametrize("data", list(garbage()), ids=lambda data: f"{len(data)} {data[:6].hex()}")
def test_random_bytes_are_dropped_and_counted(local: Local, visitor: Page, data: bytes) -> None:
    before = local.refusals["message"]
    visitor.viser.send(data)
    local.refused("message", before)
    visitor.works()


def test_random_bytes_again_and_again_end_the_connection(local: Local, visitor: Page) -> None:
    chance = random.Random(8)
    with suppress(ConnectionClosed):
        for _ in range(200):
            visitor.viser.send(chance.randbytes(50))
    assert closed(visitor.viser) == 1008


@pytest.mark.parametrize("data", ["text", json.dumps(camera_message()), "", b"x" * 20_000, b"x" * (LARGEST + 1)])
def test_text_and_huge_frames_end_the_connection(local: Local, visitor: Page, data: str | bytes) -> None:
    before = local.refusals["size or kind"]
    visitor.viser.send(data)
    assert closed(visitor.viser) == 1009
    if len(data) <= LARGEST:  # uvicorn itself refuses larger ones
        local.refused("size or kind", before)


# ---- messages that viser would obey


FORBIDDEN = [
    {"type": "ShareUrlRequest"},
    {"type": "ShareUrlDisconnect"},
    {"type": "RunJavascriptMessage", "source": "alert(1)"},
    {"type": "GuiButtonHoldMessage", "uuid": "x", "frequency": 1e9},
    {"type": "GuiFormSubmitMessage", "uuid": "x"},
    {"type": "GuiRemoveMessage", "uuid": "x"},
    {"type": "ResetGuiMessage"},
    {"type": "RemoveSceneNodeMessage", "name": "/world", "owner": ""},
    {"type": "SetPositionMessage", "name": "/turn1", "position": (9.0, 9.0, 9.0), "owner": ""},
    {"type": "SceneNodeUpdateMessage", "name": "/world", "updates": {}, "owner": ""},
    {"type": "FileTransferStartUpload", "source_component_uuid": "x", "transfer_uuid": "y", "filename": "../x",
     "mime_type": "text/plain", "part_count": 1, "size_bytes": 1},
    {"type": "FileTransferPart", "transfer_uuid": "y", "source_component_uuid": "x", "part_index": 0, "content": b"x"},
    {"type": "GetRenderResponseMessage", "payload": b"x"},
    {"type": "CommandTriggerMessage", "uuid": "x"},
    {"type": "LocalStorageGetItemResponseMessage", "request_uuid": "x", "value": "y"},
    {"type": "_messages"},
    {"type": "Message"},
    {"type": "object"},
    {"type": "x" * 10_000},
]  # fmt: skip


@pytest.mark.parametrize("message", FORBIDDEN, ids=lambda m: str(m["type"])[:30])
def test_other_types_of_messages_do_not_reach_viser(local: Local, visitor: Page, message: dict[str, Any]) -> None:
    before = local.refusals["message"]
    visitor.send(message)
    local.refused("message", before)
    visitor.works()
    assert "ShareUrlUpdated" not in visitor.model.latest


DRAG = {
    "type": "SceneNodeDragMessage", "phase": "start", "name": "/world", "instance_index": None,
    "start_position": VECTOR, "start_screen_pos": PLACE, "end_position": VECTOR, "end_screen_pos": PLACE,
    "button": "left", "modifier": None, "owner": "",
}  # fmt: skip
BROKEN = {
    "camera without fields": {"type": "ViewerCameraMessage"},
    "camera with NaN": {**camera_message(), "fov": NAN},
    "camera infinitely far": {**camera_message(), "position": (INFINITE, 0.0, 0.0)},
    "camera too far": {**camera_message(), "position": (1e300, 0.0, 0.0)},
    "camera with words": {**camera_message(), "wxyz": "1000"},
    "camera with five numbers": {**camera_message(), "wxyz": (1.0, 0.0, 0.0, 0.0, 0.0)},
    "camera with more": {**camera_message(), "camera_cb": []},
    "drag with NaN": {**DRAG, "end_position": (NAN, 0.0, 0.0)},
    "drag in no phase": {**DRAG, "phase": "before"},
    "drag with no button": {**DRAG, "button": "fourth"},
    "drag of a number": {**DRAG, "name": 5},
    "drag of a long name": {**DRAG, "name": "/" * 401},
}


@pytest.mark.parametrize("message", BROKEN.values(), ids=BROKEN.keys())
def test_messages_with_wrong_fields_are_dropped(local: Local, visitor: Page, message: dict[str, Any]) -> None:
    before = local.refusals["message"]
    visitor.send(message)
    local.refused("message", before)
    visitor.works()


def test_nobody_can_set_anything_of_viser_itself(local: Local, visitor: Page) -> None:
    """Not even a control's value: viser has no controls here."""
    for updates in ({"value": 1.0}, {"disabled": True}):
        before = local.refusals["message"]
        visitor.send({"type": "GuiUpdateMessage", "uuid": "x", "updates": updates})
        local.refused("message", before)
    visitor.works()


# ---- messages that pass and make no sense


ODD_VALUES = [
    "abc",
    "",
    "nan",
    "inf",
    "1e999",
    True,
    False,
    [],
    [1.0],
    [1.0, 2.0, 3.0],
    [1e9] * 32,
    2**63,
    -(2**63),
    0,
    1e9,
]


NO_CONTROLS = [
    "yaw",
    "order",
    "frame",
    "animate",
    "",
    "yaw.1",
    "yaw.x",
    "order:preset",
    "/nothing.1",
    "/.9",
    "__class__",
]


@pytest.mark.parametrize("name", NO_CONTROLS)
def test_a_control_survives_values_of_other_kinds(local: Local, visitor: Page, name: str) -> None:
    before = local.refusals["channel"]
    for text in [value for value in ODD_VALUES if isinstance(value, str)]:
        visitor.enter(name, text)
    visitor.slide(name, 1e9)
    visitor.enter(name, [1.0])
    visitor.works()
    assert -180.0 <= visitor.params["yaw"] <= 180.0
    assert local.refusals["channel"] >= before + 1, "values of another kind are counted"


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("yaw", "many"),
        ("yaw", "400"),
        ("yaw", "nan"),
        ("yaw", "1e999"),
        ("yaw", "--5"),
        ("order", "abc"),
        ("order", "XYZ"),
    ],
)
def test_what_cannot_be_meant_is_answered_beside_its_control(visitor: Page, name: str, text: str) -> None:
    visitor.enter(name, text)
    answers = [m["control"] for m in visitor.told if "control" in m]
    visitor.until(lambda: [m["control"] for m in visitor.told if "control" in m] == [*answers, name], "an answer")
    visitor.works()


SENSELESS = {
    "unknown node": {**DRAG, "name": "/nothing"},
    "node that can't be dragged": DRAG,
    "drag that never began": {**DRAG, "phase": "update"},
    "drag that ends twice": {**DRAG, "phase": "end"},
    "drag of the root": {**DRAG, "name": ""},
    "drag of somebody else's": {**DRAG, "owner": "17"},
    "drag with an odd modifier": {**DRAG, "modifier": "hyper"},
    "batch index": {**DRAG, "instance_index": -5},
    "click": {"type": "SceneNodeClickMessage", "name": "/nothing", "instance_index": None, "ray_origin": VECTOR,
              "ray_direction": VECTOR, "screen_pos": PLACE, "modifier": None, "owner": ""},
    "pointer": {"type": "ScenePointerMessage", "event_type": "click", "ray_origin": None, "ray_direction": None,
                "screen_pos": [], "modifier": None},
    "unknown pointer": {"type": "ScenePointerMessage", "event_type": "hover", "ray_origin": VECTOR,
                        "ray_direction": VECTOR, "screen_pos": [PLACE] * 8, "modifier": "x"},
    "transform": {"type": "TransformControlsUpdateMessage", "name": "/world", "wxyz": (0.0,) * 4, "position": VECTOR,
                  "owner": ""},
    "transform start": {"type": "TransformControlsDragStartMessage", "name": "/nothing", "owner": ""},
    "transform end": {"type": "TransformControlsDragEndMessage", "name": "/nothing", "owner": ""},
    "camera without a direction": {**camera_message(), "wxyz": (0.0,) * 4, "up_direction": VECTOR},
    "camera without a picture": {**camera_message(), "image_height": 0, "image_width": -(2**31)},
    "camera inside out": {**camera_message(), "near": 100.0, "far": -1.0, "fov": 0.0},
}  # fmt: skip


@pytest.mark.parametrize("message", SENSELESS.values(), ids=SENSELESS.keys())
def test_messages_without_sense_do_no_harm(visitor: Page, message: dict[str, Any]) -> None:
    visitor.send(message)
    visitor.send(message)
    visitor.works()


# ---- the channel


BEFORE_HELLO: list[str | bytes] = [
    "",
    "not json",
    "{}",
    "[]",
    b"\x00\x01",
    '{"type": "get"}',
    '{"type": "set", "params": {"yaw": 1}}',
    '{"type": "hello"}',
    '{"type": "hello", "dark": 1, "reduced": false, "query": ""}',
    '{"type": "hello", "dark": false, "reduced": NaN, "query": ""}',
    json.dumps({"type": "hello", "dark": False, "reduced": False, "query": "x" * 4001}),
    "[" * 16_000,
    '{"type": "set", "params": {"a": ' + "[" * 10_000,
    '{"type": "hello", "query": "\\ud800"}',
    '{"type": "get", "solution": true}',
    "x" * (LARGEST + 1),
]


@pytest.mark.parametrize("first", BEFORE_HELLO, ids=lambda first: f"{len(first)} {first[:40]!r}")
def test_a_channel_that_does_not_greet_is_closed(local: Local, learner: Page, first: str | bytes) -> None:
    before, rooms = local.refusals["no greeting"], local.sessions
    key = new_key()
    channel = connect(f"{local.url}/sims/{SLUG}/s/{room_of(key)}/{key}/channel", viser=False)
    channel.send(first)
    assert closed(channel) in (1008, 1009)
    if len(first) <= LARGEST:
        local.refused("no greeting", before)
    assert local.sessions == rooms
    learner.works()


def test_a_channel_that_says_nothing_is_closed(local: Local, learner: Page, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(scene, "HELLO_WITHIN", 0.05)
    monkeypatch.setattr(channels, "GREETED_WITHIN", 0.25)
    before = local.refusals["no greeting"]
    key = new_key()
    channel = connect(f"{local.url}/sims/{SLUG}/s/{room_of(key)}/{key}/channel", viser=False)
    assert closed(channel) == 1008
    local.refused("no greeting", before)
    learner.works()


def test_a_greeting_with_a_bad_state_begins_at_the_defaults(local: Local) -> None:
    for query in ("yaw=x", "yaw=999&roll=5", "%00=%ff", "&&&&", "yaw=1;roll=2"):
        with Page(local.url, query) as page:
            assert page.params["yaw"] == 30.0


AFTER_HELLO: list[str] = [
    "not json",
    "",
    "[]",
    "17",
    "[" * 10_000,
    '{"type": "sudo"}',
    '{"type": "get", "more": 1}',
    '{"type": "action"}',
    '{"type": "action", "name": 5}',
    '{"type": "point"}',
    '{"type": "point", "name": ["roof"]}',
    '{"type": "point", "name": "' + "x" * 101 + '"}',
    '{"type": "select", "name": 3}',
    '{"type": "select", "name": "' + "x" * 101 + '"}',
    '{"type": "action", "name": "' + "x" * 101 + '"}',
    '{"type": "handle", "name": "/grip", "x": NaN, "y": 0}',
    '{"type": "handle", "name": "/grip", "x": 1e10, "y": 0}',
    '{"type": "handle", "name": "/grip", "x": "1", "y": 0}',
    '{"type": "set", "params": []}',
    '{"type": "set", "params": {"yaw": NaN}}',
    '{"type": "set", "params": {"a": ' + "[" * 10_000 + "}}",
    json.dumps({"type": "set", "params": {f"a{k}": 1 for k in range(101)}}),
    '{"type": "set", "params": {"yaw": 1}',
]


@pytest.mark.parametrize("text", AFTER_HELLO, ids=lambda text: f"{len(text)} {text[:40]}")
def test_nonsense_on_the_channel_is_dropped_and_counted(local: Local, visitor: Page, text: str) -> None:
    before = local.refusals["channel"]
    visitor.channel.send(text)
    local.refused("channel", before)
    visitor.works()


REFUSED: list[tuple[dict[str, Any], str]] = [
    ({"type": "set", "params": {"yaw": 181}}, "yaw"),
    ({"type": "set", "params": {"yaw": "east"}}, "yaw"),
    ({"type": "set", "params": {"yaw": None}}, "yaw"),
    ({"type": "set", "params": {"yaw": [1]}}, "yaw"),
    ({"type": "set", "params": {"yaw": 10**400}}, "yaw"),
    ({"type": "set", "params": {"order": "abc"}}, "order"),
    ({"type": "set", "params": {"order": {"a": {"b": 1}}}}, "order"),
    ({"type": "set", "params": {"colour": "red"}}, "colour"),
    ({"type": "set", "params": {"__class__": 1}}, "__class__"),
    ({"type": "set", "params": {"model_config": {}}}, "model_config"),
    ({"type": "set", "params": {"x" * 5000: 1}}, "x"),
    ({"type": "action", "name": "explode"}, "explode"),
    ({"type": "action", "name": "__init__"}, "__init__"),
    ({"type": "handle", "name": "/nothing", "x": 1, "y": 2}, "/nothing"),
]


@pytest.mark.parametrize(("message", "named"), REFUSED, ids=lambda v: str(v)[:60])
def test_bad_values_are_refused_in_words_and_the_state_stays(
    visitor: Page, message: dict[str, Any], named: str
) -> None:
    before, told = visitor.params, len(visitor.errors)
    visitor.tell(message)
    visitor.until(lambda: len(visitor.errors) > told, "what is wrong")
    assert named in visitor.errors[-1]
    assert len(visitor.errors[-1]) < 500
    visitor.settle()
    assert visitor.params == before
    visitor.works()


def test_a_second_greeting_changes_nothing(visitor: Page) -> None:
    greeting = {"dark": True, "reduced": True, "query": "yaw=99"}
    before = visitor.params
    visitor.tell({"type": "hello", **greeting})
    visitor.settle()
    assert visitor.params == before
    visitor.works()


@pytest.mark.parametrize("data", [b"bytes", "x" * 20_000])
def test_binary_and_huge_frames_end_the_channel(local: Local, visitor: Page, data: str | bytes) -> None:
    before = local.refusals["size or kind"]
    visitor.channel.send(data)
    assert closed(visitor.channel) == 1009
    local.refused("size or kind", before)


# ---- without a key


def test_who_only_watches_may_send_nonsense_too(local: Local, learner: Page) -> None:
    with Page(local.url, room=learner.room) as watcher:
        before = local.refusals["message"]
        for data in garbage():
            watcher.viser.send(data)
        local.refused("message", before)
        before = local.refusals["watching"]
        watcher.slide("yaw", 5.0)
        watcher.enter("order", "xyz")
        watcher.tell({"type": "action", "name": "reset"})
        watcher.tell({"type": "over", "ray": [0, 0, 5, 0, 0, -1]})
        watcher.send(DRAG)
        local.refused("watching", before + 4)
        watcher.settle()
        assert watcher.params["order"] == "zyx"
    learner.works()


# ---- too much


def pour(send: Callable[[], object], count: int) -> None:
    """Send as fast as it goes, until the server has enough."""
    with suppress(ConnectionClosed):
        for _ in range(count):
            send()


def test_a_flood_is_thinned_and_then_cut_off(local: Local, visitor: Page, learner: Page) -> None:
    before = local.refusals["rate"]
    camera = encode_message(camera_message())
    pour(lambda: visitor.viser.send(camera), 10_000)
    local.refused("rate", before + 1000)
    learner.works()
    assert closed(visitor.viser) == 1008


def test_a_flood_of_the_channel_is_thinned_and_then_cut_off(local: Local, visitor: Page, learner: Page) -> None:
    before = local.refusals["rate"]
    pour(lambda: visitor.channel.send('{"type": "get"}'), 10_000)
    local.refused("rate", before + 1000)
    learner.works()
    assert closed(visitor.channel) == 1008


@pytest.mark.parametrize("chunked", [False, True])
def test_a_huge_body_is_refused_before_it_is_read(local: Local, learner: Page, chunked: bool) -> None:
    piece = b"1" * (1 << 16)
    left = iter(range(5000))
    body: Any = (piece for _ in left) if chunked else 320 * piece
    with suppress(httpx.WriteError):  # it needn't wait until all is written
        answer = local.http.post(f"/api/sims/{SLUG}/solve", content=body, headers={"content-type": "application/json"})
        assert answer.status_code == 413
        assert len(answer.text) < 200
    if chunked:
        assert sum(1 for _ in left) > 100, "most of it was never asked for"
    learner.works()


def test_fast_sliders_are_not_a_flood_and_the_last_value_arrives(local: Local, visitor: Page) -> None:
    before = local.refusals
    for k in range(300):
        visitor.slide("yaw", k / 2)
    visitor.until(lambda: visitor.params["yaw"] == 149.5, "the last value")
    assert local.refusals == before


def test_a_page_that_does_not_read_holds_nobody_up(local: Local, learner: Page) -> None:
    with Page(local.url) as teacher:
        idle = [connect(f"{teacher.address}?viewer=idle{k:06}", viser=True) for k in range(5)]
        for socket_ in idle:
            socket_.send(encode_message(camera_message()))
        for _ in range(3):
            for k in range(80):
                teacher.slide("yaw", float(k))
            teacher.works()
        learner.works()
        for socket_ in idle:
            socket_.close()


# ---- connections that break


def raw(local: Local, sent: bytes) -> socket.socket:
    """A TCP connection on which something was said."""
    connection = socket.create_connection(("127.0.0.1", int(local.url.rsplit(":", 1)[1])), timeout=5)
    connection.sendall(sent)
    return connection


def handshake(path: str) -> bytes:
    return (
        f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        f"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
        f"Sec-WebSocket-Protocol: {PROTOCOL}\r\n\r\n"
    ).encode()


def test_half_open_connections_do_no_harm(local: Local, learner: Page) -> None:
    key = new_key()
    path = f"/sims/{SLUG}/s/{room_of(key)}/{key}/"
    starts = [b"", b"GET ", handshake(path)[:80], b"\x16\x03\x01\x02\x00", b"\x00" * 1000, handshake(path)]
    held = [raw(local, start) for start in starts for _ in range(5)]
    learner.works()
    for connection in held:
        connection.close()
    learner.works()


@pytest.mark.parametrize(
    "frame",
    [
        b"\x82\x05hello",
        b"\x8f\x80\x00\x00\x00\x00",
        b"\xf2\x80\x00\x00\x00\x00",
        b"\x82\xff" + b"\xff" * 12,
        b"\x02\x80abcd",
    ],
    ids=["not masked", "unknown kind", "reserved bits", "endless", "never finished"],
)
def test_broken_websocket_frames_do_no_harm(local: Local, learner: Page, frame: bytes) -> None:
    key = new_key()
    for _ in range(3):
        connection = raw(local, handshake(f"/sims/{SLUG}/s/{room_of(key)}/{key}/"))
        assert b"101 Switching Protocols" in connection.recv(4096)
        connection.sendall(frame)
        learner.works()
        connection.close()


def test_connections_that_break_off_leave_no_viewer(local: Local, learner: Page) -> None:
    with Page(local.url) as teacher:
        session = local.services.sessions.find(_sim(), teacher.room)
        assert session is not None
        viewers, listeners = session.drawing.viewers, session.telling.listeners
        for _ in range(5):
            other = Page(local.url, room=teacher.room)
            for end in (other.viser, other.channel):
                end.socket.shutdown(socket.SHUT_RDWR)  # without websocket's own farewell
        wait_for(lambda: (len(viewers), len(listeners)) == (1, 1), "the broken ones to be forgotten")
        teacher.works()
    learner.works()


def _sim() -> Any:
    from sims import by_slug

    return by_slug(SLUG)


def alive(kind: type) -> int:
    """How many objects of a kind there are."""
    gc.collect()
    return sum(type(o) is kind for o in gc.get_objects())


def test_pages_that_went_leave_nothing_behind(local: Local, learner: Page) -> None:
    learner.settle()
    open_before = len(local.services.bridge.visits)
    before = {kind: alive(kind) for kind in (Viewer, Wire, Visit, Link)}
    for _ in range(20):
        Page(local.url).close()
    # What an earlier test's page had may still have been there before, and be freed meanwhile.
    wait_for(lambda: all(alive(kind) <= count for kind, count in before.items()), "what the pages had to be freed")
    wait_for(lambda: len(local.services.bridge.visits) <= open_before, "the visits to end")


# ---- the server as a process of its own


@pytest.fixture(scope="module")
def process() -> Iterator[Server]:
    """What it prints is checked when it ends."""
    with Server() as server:
        yield server


def test_memory_stays_flat(process: Server) -> None:
    """While pages open, misuse it and close."""
    with Page(process.url) as learner:
        chance = random.Random(9)

        def abuse(rounds: int) -> float:
            for _ in range(rounds):
                with Page(process.url) as page:
                    page.slide("yaw", float(chance.randrange(90)))
                    page.viser.send(chance.randbytes(chance.randrange(1, 5000)))
                    page.tell({"type": "set", "params": {"yaw": "x" * chance.randrange(5000)}})
                    page.enter("order", "17")
                    page.settle()
            learner.works()
            return process.memory()

        warm = abuse(15)
        assert abuse(30) - warm < 8.0, "megabytes"
        learner.works()


def test_a_killed_server_goes_on_where_the_page_was(process: Server) -> None:
    page = Page(process.url, "yaw=12&order=xyz")
    page.slide("yaw", 77.0)
    page.until(lambda: page.params["yaw"] == 77.0, "the state to follow")
    query = page.states[-1]["query"]
    process.restart(hard=True)
    page.close()
    with Page(process.url, room=page.room) as watcher:
        again = Page(process.url, query, key=page.key)
        watcher.until(lambda: watcher.params == again.params, "the watcher to follow")
        assert again.params == page.params
        again.works()
        again.close()
