"""A page of a sim without a browser: its two websockets, and what comes through them."""

from __future__ import annotations

import itertools
import json
import secrets
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any, Self

import websockets.sync.client
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection
from websockets.typing import Origin, Subprotocol

from app.rooms.keys import new_key, room_of
from sims.kit.viser_internals import PROTOCOL
from tests.column import ColumnModel
from tests.frames import SceneModel, encode_message
from tests.server import PATIENCE, camera_message

SLUG = "euler-angles"


def connect(address: str, *, viser: bool, origin: str | None = None, unread: int | None = 16) -> ClientConnection:
    """A websocket to the server; `address` begins with http.

    With so many messages unread it takes no more, as a page does that hangs; it then doesn't answer pings either.
    """
    return websockets.sync.client.connect(
        address.replace("http", "ws", 1),
        subprotocols=[Subprotocol(PROTOCOL)] if viser else None,
        origin=None if origin is None else Origin(origin),
        compression=None,
        max_size=None,
        max_queue=unread,
        open_timeout=PATIENCE,
        close_timeout=2,
        ping_interval=None,
        proxy=None,
    )


def closed(socket: ClientConnection) -> int:
    """Wait until the server has closed a websocket; the code that it gave."""
    until = time.monotonic() + PATIENCE
    with suppress(ConnectionClosed):
        while time.monotonic() < until:
            socket.recv(timeout=PATIENCE)
    assert socket.close_code is not None, "the server didn't close the connection"
    return socket.close_code


class Page:
    """viser's client and the column beside it in one: with a key it controls the room, without it watches."""

    def __init__(
        self,
        url: str,
        query: str = "",
        *,
        slug: str = SLUG,
        key: str | None = None,
        room: str | None = None,
        hello: Mapping[str, Any] | None = None,
    ) -> None:
        self.key = new_key() if key is None and room is None else key
        self.room = room or room_of(str(self.key))
        self.address = f"{url}/sims/{slug}/s/{self.room}/" + (f"{self.key}/" if self.key else "")
        self.name = secrets.token_hex(8)
        self.model = SceneModel()
        self.column = ColumnModel()
        self.told: list[dict[str, Any]] = []
        self._counter = itertools.count(1)
        self.channel = connect(f"{self.address}channel?viewer={self.name}", viser=False)
        greeting = {"dark": False, "reduced": True, "query": query}
        self.tell({"type": "hello", **greeting, **(hello or {})})
        self.viser = connect(f"{self.address}?viewer={self.name}", viser=True)
        self.send(camera_message())
        self.until(lambda: self.column.parts and self.model.version >= 0, "the scene and the column")
        self.until(lambda: self.states, "the state")

    def tell(self, message: Mapping[str, Any]) -> None:
        """Send a message on the channel."""
        self.channel.send(json.dumps(message))

    def send(self, message: Mapping[str, Any]) -> None:
        """Send a message as viser's client."""
        self.viser.send(encode_message(message))

    def slide(self, name: str, value: Any) -> None:
        """Move a slider."""
        self.tell({"type": "slide", "name": name, "value": value})

    def enter(self, name: str, text: Any) -> None:
        """Type into a box, or choose."""
        self.tell({"type": "enter", "name": name, "text": text})

    @property
    def states(self) -> list[dict[str, Any]]:
        """The state messages so far."""
        return [m for m in self.told if m["type"] == "state"]

    @property
    def params(self) -> dict[str, Any]:
        """Parameters in the last state message."""
        params: dict[str, Any] = self.states[-1]["params"]
        return params

    @property
    def led(self) -> dict[str, Any]:
        """From where the page was told last to look, as somebody else does."""
        return next((m for m in reversed(self.told) if m["type"] == "led"), {})

    @property
    def errors(self) -> list[str]:
        """What the page was told to be wrong."""
        return [m["message"] for m in self.told if m["type"] == "error"]

    def until(self, happened: Callable[[], object], what: str) -> None:
        """Receive on both websockets until something is so."""
        end = time.monotonic() + PATIENCE
        while not happened():
            assert time.monotonic() < end, f"waited {PATIENCE:g} s in vain for {what}"
            self._receive(self.viser, self.model.feed)
            self._receive(self.channel, self._hear)

    def settle(self) -> None:
        """Wait until the server has answered what was sent so far, and drawn it."""
        at = len(self.states)
        self.tell({"type": "get"})
        self.until(lambda: len(self.states) > at, "an answer")

    def works(self) -> None:
        """Check that this page is still served: a control moves the state and the scene."""
        value = float(next(self._counter) % 90)
        self.slide("yaw", value)
        self.until(lambda: self.params["yaw"] == value, "the state to follow the slider")
        self.until(lambda: f"Turn about Z by {value:.1f}°" in self.column.html("read"), "the read-outs to follow")
        self.until(lambda: self.model.version == self.column.version, "the scene to follow")

    def _hear(self, text: Any) -> None:
        message = json.loads(text)
        self.told.append(message)
        self.column.take(message)

    @staticmethod
    def _receive(socket: ClientConnection, take: Callable[[Any], object]) -> None:
        try:
            while True:
                take(socket.recv(timeout=0.005))
        except TimeoutError:
            return

    def close(self) -> None:
        """The learner closes the page."""
        self.channel.close()
        self.viser.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
