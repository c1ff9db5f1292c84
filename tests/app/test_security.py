"""Headers of every answer, and who may enter which room."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from socket import create_connection

import httpx
import pytest
from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidStatus, NegotiationError

from app.rooms.keys import new_key, room_of
from sims import SIMS
from tests.app.conftest import Local
from tests.app.page import SLUG, Page, closed, connect
from tests.frames import encode_message
from tests.server import PATIENCE, camera_message

KEY = new_key()
ROOM = room_of(KEY)
OTHER = room_of(new_key())
ADDRESSES = {
    "launcher": ("/", 200),
    "lesson": (f"/sims/{SLUG}", 200),
    "embed": (f"/sims/{SLUG}/embed", 200),
    "room": (f"/sims/{SLUG}/s/{ROOM}/{KEY}/", 200),
    "watching": (f"/sims/{SLUG}/s/{ROOM}/", 200),
    "without slash": (f"/sims/{SLUG}/s/{ROOM}/{KEY}", 307),
    "catalogue": ("/api/sims", 200),
    "health": ("/healthz", 200),
    "static": ("/static/page.js", 200),
    "bad link": (f"/sims/{SLUG}?yaw=x", 422),
    "no such sim": ("/sims/nothing", 404),
    "no such page": ("/nothing", 404),
    "no such file": ("/static/nothing.js", 404),
    "wrong key": (f"/sims/{SLUG}/s/{OTHER}/{KEY}/", 404),
}  # fmt: skip
each_address = pytest.mark.parametrize(("path", "status"), ADDRESSES.values(), ids=ADDRESSES.keys())


def policy(answer: httpx.Response) -> dict[str, str]:
    parts = answer.headers["content-security-policy"].split("; ")
    return {name: rest for name, _, rest in (part.partition(" ") for part in parts)}


@each_address
def test_every_answer_has_the_security_headers(http: httpx.Client, path: str, status: int) -> None:
    answer = http.get(path, follow_redirects=False)
    assert answer.status_code == status
    rules = policy(answer)
    assert rules["default-src"] == "'self'"
    assert rules["object-src"] == "'none'"
    assert rules["base-uri"] == "'none'"
    assert "frame-ancestors" not in rules, "a star would leave out frames within a sandboxed one"
    for sources in rules.values():
        assert "*" not in sources
        assert "http" not in sources, "nothing is loaded from another host"
    assert answer.headers["x-content-type-options"] == "nosniff"
    assert answer.headers["referrer-policy"] == "no-referrer"
    assert "camera=()" in answer.headers["permissions-policy"]
    assert "x-frame-options" not in answer.headers, "embedding is what the sims are for"


@each_address
def test_nothing_is_kept_in_cookies(http: httpx.Client, path: str, status: int) -> None:
    assert "set-cookie" not in http.get(path, follow_redirects=False).headers


def test_pages_with_a_key_are_not_kept_by_caches(http: httpx.Client) -> None:
    for path in (f"/sims/{SLUG}/embed", f"/sims/{SLUG}/s/{ROOM}/{KEY}/", f"/sims/{SLUG}/s/{ROOM}/"):
        assert http.get(path).headers["cache-control"] == "no-store"


def test_our_own_pages_may_always_embed() -> None:
    with Local(frame_ancestors="https://school.example") as local:
        assert policy(local.http.get("/"))["frame-ancestors"] == "'self' https://school.example"


def test_embedding_can_be_kept_to_some_sites() -> None:
    with Local(frame_ancestors="'self' https://school.example") as local:
        for path in ("/", f"/sims/{SLUG}/s/{ROOM}/{KEY}/"):
            assert policy(local.http.get(path))["frame-ancestors"] == "'self' https://school.example"


@pytest.mark.parametrize(
    "path",
    [
        "/static/../pyproject.toml",
        "/static/%2e%2e/pyproject.toml",
        "/static/..%2fpyproject.toml",
        "/static//etc/passwd",
    ],
)
def test_static_files_come_from_their_folder_alone(http: httpx.Client, path: str) -> None:
    host, port = http.base_url.host, http.base_url.port
    with create_connection((host, port), timeout=5) as raw:  # httpx would tidy the path
        raw.sendall(f"GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n".encode())
        answer = b"".join(iter(lambda: raw.recv(4096), b"")).decode()
    assert answer.startswith("HTTP/1.1 404")
    assert "[project]" not in answer
    assert "root:" not in answer


# ---- rooms


def test_each_embedding_gets_a_room_of_its_own(http: httpx.Client) -> None:
    places = {json.loads(page_data(http.get(f"/sims/{SLUG}/embed").text))["path"] for _ in range(20)}
    assert len(places) == 20
    for place in places:
        *_, room, key, rest = place.split("/")
        assert rest == ""
        assert room_of(key) == room


def page_data(page: str) -> str:
    """What the page of a sim knows about its room."""
    found = re.search(r'<script id="sim3" type="application/json">(.*?)</script>', page, re.S)
    assert found
    return found[1]


@pytest.mark.parametrize(
    "path",
    [
        f"/sims/{SLUG}/s/{OTHER}/{KEY}/",
        f"/sims/{SLUG}/s/{ROOM}/wrong/",
        f"/sims/{SLUG}/s/{ROOM}/{KEY}x/",
        f"/sims/{SLUG}/s/{ROOM.upper()}/{KEY}/",
        f"/sims/nothing/s/{ROOM}/{KEY}/",
        f"/sims/nothing/s/{ROOM}/",
        f"/sims/{SLUG}/s/",
        f"/sims/{SLUG}/s/{'x' * 3000}/",
    ],
    ids=["other room", "wrong key", "longer key", "capitals", "wrong slug", "wrong slug, watching", "no room", "long"],
)
def test_wrong_address_gets_a_page_that_says_so(http: httpx.Client, path: str) -> None:
    answer = http.get(path, follow_redirects=True)
    assert answer.status_code == 404
    assert answer.headers["content-type"].startswith("text/html")
    assert "<h1" in answer.text
    assert re.search(r'href="/("|sims/)', answer.text), "it leads on to what there is"
    assert len(answer.text) < 20_000


def test_name_of_a_missing_sim_is_escaped(http: httpx.Client) -> None:
    answer = http.get("/sims/%3Cscript%3Ealert(1)%3C%2Fscript%3E")
    assert answer.status_code == 404
    assert "<script>alert" not in answer.text


def test_a_full_server_says_so() -> None:
    with Local(max_sessions=2) as local, Page(local.url) as one, Page(local.url) as other:
        answer = local.http.get(f"/sims/{SLUG}/embed", follow_redirects=True)
        assert answer.status_code == 503
        assert "All places on this server are taken" in answer.text
        assert int(answer.headers["retry-after"]) > 0
        socket = connect(f"{local.url}/sims/{SLUG}/s/{ROOM}/{KEY}/", viser=True)
        socket.send(encode_message(camera_message()))
        assert closed(socket) == 1013
        local.refused("full")
        channel = connect(f"{local.url}/sims/{SLUG}/s/{ROOM}/{KEY}/channel", viser=False)
        channel.send(json.dumps({"type": "hello", "dark": False, "reduced": False, "query": ""}))
        assert closed(channel) == 1013
        one.works()
        other.works()


# ---- websockets


def sockets(url: str, room: str, key: str | None, slug: str = SLUG) -> Iterator[tuple[str, bool]]:
    """Addresses of both websockets of a room, and whether it is viser's."""
    place = f"{url}/sims/{slug}/s/{room}/" + (f"{key}/" if key else "")
    yield place, True
    yield place.rstrip("/"), True
    yield f"{place}channel", False


@pytest.mark.parametrize(
    ("room", "key", "slug"),
    [
        (OTHER, KEY, SLUG),
        (ROOM, "wrong", SLUG),
        (ROOM, KEY, "nothing"),
        (ROOM, None, "nothing"),
        ("x" * 41, None, SLUG),
    ],
    ids=["other room", "wrong key", "wrong slug", "wrong slug, watching", "long room"],
)
def test_websocket_with_a_wrong_address_is_refused(local: Local, room: str, key: str | None, slug: str) -> None:
    rooms = local.sessions
    for address, viser in sockets(local.url, room, key, slug):
        before = local.refusals["address"]
        with pytest.raises(InvalidStatus, match="403"):
            connect(address, viser=viser)
        local.refused("address", before)
    assert local.sessions == rooms


@pytest.mark.parametrize(
    "origin",
    [
        "https://evil.example", "http://127.0.0.1", "http://127.0.0.1:1", "file://", "http://127.0.0.1.evil.example",
        "http://[", "http://[::1", "http://a:99999999999", "http://\xff", "https://", "http://user@127.0.0.1",
    ],
)  # fmt: skip
def test_websocket_from_another_sites_page_is_refused_with_a_reason(
    local: Local, origin: str, caplog: pytest.LogCaptureFixture
) -> None:
    local.services.bridge.visits.warned.clear()
    for address, viser in sockets(local.url, ROOM, KEY):
        before = local.refusals["origin"]
        assert "page" in refusal(address, viser=viser, origin=origin)
        local.refused("origin", before)
    said = [record.getMessage() for record in caplog.records if "websocket was refused" in record.getMessage()]
    assert len(said) == 1, "a line in the log, and one alone"


def refusal(address: str, *, viser: bool, origin: str) -> str:
    """The reason with which a websocket is closed at once."""
    with pytest.raises(ConnectionClosed) as caught:
        connect(address, viser=viser, origin=origin).recv(timeout=PATIENCE)
    assert caught.value.rcvd is not None
    assert caught.value.rcvd.code == 4403
    reason = caught.value.rcvd.reason
    assert len(reason.encode()) <= 120
    return reason


def test_websocket_from_an_own_page_a_sandboxed_frame_or_a_program_is_taken(local: Local) -> None:
    for origin in (local.url, "null", None):
        for address, viser in sockets(local.url, ROOM, KEY):
            connect(address, viser=viser, origin=origin).close()


def test_further_origins_can_be_named() -> None:
    with Local(origins="https://school.example https://other.example") as local:
        for address, viser in sockets(local.url, ROOM, KEY):
            connect(address, viser=viser, origin="https://school.example").close()
            assert "https://evil.example" in refusal(address, viser=viser, origin="https://evil.example")


def test_another_version_of_visers_protocol_is_refused(local: Local) -> None:
    before = local.refusals["protocol"]
    with pytest.raises((InvalidStatus, InvalidHandshake, NegotiationError)):
        connect(f"{local.url}/sims/{SLUG}/s/{ROOM}/{KEY}/", viser=False)
    local.refused("protocol", before)


# ---- who may do what


def test_who_watches_sees_and_changes_nothing(local: Local) -> None:
    with Page(local.url, "yaw=12") as teacher, Page(local.url, room=teacher.room) as watcher:
        assert watcher.params["yaw"] == 12.0
        for message in (
            {"type": "set", "params": {"yaw": 50}},
            {"type": "action", "name": "reset"},
            {"type": "handle", "name": "/grip", "x": 1, "y": 2},
        ):
            before = local.refusals["watching"]
            watcher.tell(message)
            local.refused("watching", before)
        before = local.refusals["watching"]
        watcher.slide("yaw", 50.0)
        local.refused("watching", before)
        teacher.works()
        yaw = teacher.params["yaw"]
        watcher.until(lambda: watcher.params["yaw"] == yaw, "the watcher to follow")
        assert f"yaw {yaw:.0f}°" in watcher.model.labels().values()
        assert local.http.get(f"/sims/{SLUG}/s/{teacher.room}/?yaw=70").status_code == 200
        teacher.settle()
        assert teacher.params["yaw"] == yaw, "opening a watching link changes nothing"


def test_page_options_alone_change_no_running_room(local: Local) -> None:
    with Page(local.url, "yaw=12") as page:
        path = page.address.removeprefix(local.url)
        assert local.http.get(f"{path}?theme=dark&view=3,-3,2,0,0,0").status_code == 200
        page.settle()
        assert page.params["yaw"] == 12.0
        assert local.http.get(f"{path}?yaw=33").status_code == 200
        page.settle()
        assert page.params["yaw"] == 33.0


def test_rooms_are_apart(local: Local) -> None:
    with Page(local.url) as one, Page(local.url) as other:
        before = other.params, other.model.messages
        one.works()
        other.settle()
        assert (other.params, other.model.messages) == before


def test_every_sim_can_be_opened_and_used(local: Local) -> None:
    for sim in SIMS:
        with Page(local.url, slug=sim.slug) as page:
            assert page.params == sim.params.from_query(()).model_dump(mode="json")
            assert not page.model.strays
