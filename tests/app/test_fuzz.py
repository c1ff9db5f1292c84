"""Hostile frames of all kinds on both websockets of a real server, while a neighbour in another room drags on."""

from __future__ import annotations

import json
import random
import socket
import threading
from collections import Counter, deque
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

import msgspec

from app.rooms.keys import new_key, room_of
from sims import SIMS
from sims.kit.sim import Sim
from sims.kit.viser_internals import PROTOCOL
from tests.app.page import Page
from tests.server import Server, camera_message

VISITS = 400
ANSWERS = 21
ROOMS = 24
GROWTH = 40.0
"""Megabytes that the server may have grown by, after a first round."""
TEXT, BINARY, CLOSE, PING = 1, 2, 8, 9
LIGHT = [sim for sim in SIMS if not sim.heavy]
HELLO = {"type": "hello", "dark": False, "reduced": False, "query": ""}


class Neighbour(threading.Thread):
    """Sets a parameter twenty times a second, and measures how long the answer takes."""

    def __init__(self, page: Page) -> None:
        super().__init__(daemon=True)
        self.page = page
        self.over = threading.Event()
        self.answered = 0
        self.failure: BaseException | None = None

    def run(self) -> None:
        try:
            while not self.over.wait(0.05):
                self._drag(float(self.answered % 90))
        except BaseException as failure:
            self.failure = failure

    def _drag(self, value: float) -> None:
        self.page.tell({"type": "set", "params": {"yaw": value}})
        self.page.tell({"type": "get"})
        while self._told() != value:
            pass
        self.answered += 1

    def _told(self) -> Any:
        return json.loads(self.page.channel.recv(timeout=20)).get("params", {}).get("yaw")


def frame(kind: int, data: bytes, *, first: int = 0x80, masked: bool = True) -> bytes:
    """One frame of the websocket protocol, masked with zeros."""
    size, mask = len(data), 0x80 if masked else 0
    if size < 126:
        length = bytes([mask | size])
    elif size < 1 << 16:
        length = bytes([mask | 126]) + size.to_bytes(2, "big")
    else:
        length = bytes([mask | 127]) + size.to_bytes(8, "big")
    return bytes([first | kind]) + length + bytes(4 if masked else 0) + data


class Stranger:
    """Makes frames by chance, always the same ones."""

    def __init__(self, seed: int) -> None:
        self.chance = random.Random(seed)
        self.keys = [new_key() for _ in range(ROOMS)]

    def visit(self, k: int) -> list[tuple[bytes, bytes]]:
        """The handshake, and what follows, of a visit's channel and of its scene's websocket."""
        chance = self.chance
        sim, key = chance.choice(LIGHT), chance.choice(self.keys)
        path = f"/sims/{sim.slug}/s/{room_of(key)}/" + (f"{key}/" if chance.random() < 0.8 else "")
        odd = chance.choice(["viewer=%ff", "viewer", "viewer=a&viewer=b"])
        name = f"viewer={k:08}" if chance.random() < 0.8 else odd
        channel = [frame(TEXT, json.dumps(HELLO).encode())] if chance.random() < 0.7 else []
        channel += [self._framed(TEXT, self._channel(sim)) for _ in range(chance.randrange(8))]
        scene = [frame(BINARY, _pack(camera_message()))] if chance.random() < 0.7 else []
        scene += [self._framed(BINARY, self._scene(sim)) for _ in range(chance.randrange(8))]
        return [
            (self._handshake(f"{path}channel?{name}"), b"".join(channel)),
            (self._handshake(f"{path}?{name}"), b"".join(scene)),
        ]

    def _handshake(self, path: str) -> bytes:
        chance = self.chance
        protocol = (
            PROTOCOL if chance.random() < 0.9 else chance.choice(["\xff", ",,,", f"{PROTOCOL},x", "viser-v0", " "])
        )
        origin = "" if chance.random() < 0.9 else f"Origin: {chance.choice(['null', 'http://x', chr(255) * 3, ''])}\r\n"
        kind = "GET" if chance.random() < 0.98 else "POST"
        return (
            f"{kind} {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n{origin}"
            f"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n"
            f"Sec-WebSocket-Protocol: {protocol}\r\n\r\n"
        ).encode("latin-1")

    def _framed(self, kind: int, data: bytes) -> bytes:
        chance = self.chance
        which = chance.random()
        if which < 0.75:
            return frame(kind, data)
        if which < 0.8:  # in pieces, some of them empty, with a ping between
            half = len(data) // 2
            rest = frame(0, b"", first=0) + frame(PING, b"still there?") + frame(0, data[half:])
            return frame(kind, data[:half], first=0) + rest
        odd = [
            frame(TEXT + BINARY - kind, data), frame(kind, data, masked=False), frame(kind, data, first=0xF0),
            frame(5, data), frame(CLOSE, chance.randbytes(chance.randrange(4))), frame(PING, data[:200]),
            frame(kind, b"x" * 70_000), frame(0, data), frame(kind, data)[: chance.randrange(1, 10)],
            frame(kind, data, first=0) + frame(0, b"", first=0) * 500, frame(PING, b"") * 50, chance.randbytes(40),
        ]  # fmt: skip
        return chance.choice(odd)

    def _channel(self, sim: Sim[Any, Any]) -> bytes:
        chance = self.chance
        which = chance.random()
        if which < 0.15:
            depth = chance.choice([10, 900, 5000])
            beginning = chance.choice([b"", b'{"type":"set","params":{"a":', b'{"type":"hello","query":'])
            return beginning + chance.choice([b"[", b'{"a":']) * (depth // 2)
        if which < 0.25:
            return chance.randbytes(chance.randrange(200))
        text = json.dumps(self._command(sim)).encode()
        if which < 0.5:
            return _mutated(chance, text)
        return text

    def _command(self, sim: Sim[Any, Any]) -> dict[str, Any]:
        """A message as it may be, but for what it says."""
        name = self.chance.choice(
            [*sim.handles, *(a.name for a in sim.actions), "reset", "x" * 100, "\ud800", "\0", ""]
        )
        return self.chance.choice(
            [
                {"type": "set", "params": self._params(sim)},
                {"type": "set", "params": self._params(sim), "seconds": self._number()},
                {"type": "handle", "name": name, "x": self._number(), "y": self._number()},
                {"type": "action", "name": name},
                {"type": "slide", "name": self._input(sim), "value": self._number()},
                {"type": "enter", "name": self._input(sim), "text": self._text()},
                {"type": "point", "name": name},
                {"type": "select", "name": name},
                {"type": "get", "solution": self.chance.random() < 0.5},
                {"type": "cancel"},
                {**HELLO, "query": "&".join(f"{n}={self._number()}" for n in sim.params.model_fields)},
                {"type": "sudo"},
            ]
        )

    def _input(self, sim: Sim[Any, Any]) -> str:
        names = [*sim.params.model_fields, *(typed.handle for typed in sim.typed), "\udfff", "/"]
        ends = ["", "", ".0", ".1", ".7", ".x", ":preset", ".-1"]
        return f"{self.chance.choice(names)}{self.chance.choice(ends)}"

    def _text(self) -> str:
        words = [
            "",
            "x",
            "1,2,3",
            "(1; 2; 3)",
            "π/0",
            "-π/3",
            "9" * 300,
            "1e999",
            "30 cm",
            "\u0663",
            "--1",
            "zyx",
            "\ud800",
        ]
        return self.chance.choice([f"{self._number()}", f"{self._number()}°", *words])

    def _params(self, sim: Sim[Any, Any]) -> dict[str, Any]:
        names = [*sim.params.model_fields, "__class__", "\udfff"]
        return {name: self._value() for name in self.chance.sample(names, self.chance.randrange(1, 4))}

    def _value(self) -> Any:
        number = self._number()
        words = ["x", "zyx", "left:1,1", "\ud800", None, True, {"a": [number]}, 10**30, 1e308, "9" * 500]
        return self.chance.choice([number, [number] * self.chance.randrange(1, 9), self.chance.choice(words)])

    def _number(self) -> float:
        near = self.chance.uniform(-10.0, 10.0)
        return self.chance.choice([0.0, -0.0, 1.0, 1e-300, 1e-9, 1e9, -1e9, 90.0, 180.0, near, near, round(near)])

    def _scene(self, sim: Sim[Any, Any]) -> bytes:
        chance = self.chance
        place = (self._number(), self._number(), self._number())
        name = chance.choice([*sim.handles, "/world", "", "/\0", "x" * 400])
        drag = {
            "type": "SceneNodeDragMessage", "phase": chance.choice(["start", "update", "end"]), "name": name,
            "instance_index": chance.choice([None, 0, -5, 2**31]), "start_position": place,
            "start_screen_pos": (0.5, 0.5), "end_position": place[::-1], "end_screen_pos": (0.5, 0.5),
            "button": "left", "modifier": None, "owner": "",
        }  # fmt: skip
        camera = {**camera_message(), "fov": self._number(), "position": place, "up_direction": (0.0, 0.0, 0.0)}
        bad = {**drag, "name": b"\xff", "type": chance.choice(["ShareUrlRequest", "RunJavascriptMessage", 5, None])}
        with suppress(UnicodeEncodeError, OverflowError):
            data = _pack(chance.choice([drag, camera, bad]))
            return data if chance.random() < 0.6 else _mutated(chance, data)
        return chance.choice([b"\x91", b"\x81\xa4type", b"\xdd\xff\xff\xff\xff"]) * chance.choice([1, 2000])


def _pack(message: dict[str, Any]) -> bytes:
    return msgspec.msgpack.encode(message)


def _mutated(chance: random.Random, data: bytes) -> bytes:
    """With some bytes changed, taken away or doubled."""
    changed = bytearray(data)
    for _ in range(chance.randrange(1, 4)):
        at = chance.randrange(len(changed) + 1)
        changed[at : at + chance.randrange(3)] = chance.choice(
            [b"", chance.randbytes(2), b"\\ud800", b"\xff", b"[" * 50]
        )
    return bytes(changed)


def pay(server: Server, visit: list[tuple[bytes, bytes]]) -> Iterator[tuple[socket.socket, bytes]]:
    """Make a visit; its connections, with the status that each handshake was answered with."""
    made = [socket.create_connection(("127.0.0.1", server.port), timeout=5) for _ in visit]
    with suppress(OSError):  # the server may have had enough before all is said
        for connection, (handshake, _) in zip(made, visit, strict=True):
            connection.sendall(handshake)
    statuses = [received(connection)[9:12] for connection in made]
    for connection, (_, frames), status in zip(made, visit, statuses, strict=True):
        with suppress(OSError):
            connection.sendall(frames if status == b"101" else b"")
        yield connection, status


def received(connection: socket.socket) -> bytes:
    """What there is to read; nothing, when the connection was cut off."""
    with suppress(OSError):
        return connection.recv(4096)
    return b""


def test_a_neighbour_drags_on_whatever_strangers_send() -> None:
    with Server() as server, Page(server.url) as page:
        strangers, neighbour = Stranger(11), Neighbour(page)
        seen: Counter[bytes] = Counter()
        staying: deque[socket.socket] = deque()
        neighbour.start()
        warm, visits = 0.0, 0
        while neighbour.is_alive() and (visits < VISITS or neighbour.answered < ANSWERS):
            for connection, status in pay(server, strangers.visit(visits)):
                seen[status] += 1
                staying.append(connection)
            while len(staying) > 40:
                staying.popleft().close()
            visits += 1
            if visits == 200:
                warm = server.memory()
        for connection in staying:
            connection.close()
        neighbour.over.set()
        neighbour.join(30)
        assert not neighbour.is_alive()
        if neighbour.failure is not None:
            raise neighbour.failure
        assert seen[b"101"] > visits
        assert seen[b"403"] + seen[b"400"] > 0, "handshakes that are refused"
        assert not seen[b"500"]
        assert server.memory() - warm < GROWTH
        for sim in LIGHT:
            Page(server.url, slug=sim.slug).close()
