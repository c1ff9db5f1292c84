"""The only place that touches what viser doesn't publish. `tests/sims/test_viser_internals.py` pins each name.

Why each is needed:

- viser serves its own socket, and its server accepts any Origin and any message. `ViserHost` starts it
  without a socket: viewers reach it only through a `Wire` that the bridge feeds with messages it has checked.
- The path of a viewer's websocket (which says whose session it is) isn't in viser's public API.
- viser's buffer of what waits for a client costs half of an update; each client gets an `Outbox` in its place.
- viser's pose setters skip a change that `np.allclose` calls equal (relative 1e-5), so what is drawn could lag
  behind what is shown, and they cost 40 µs each. `set_pose` compares exactly and costs a tenth.
- Every handle works out the type hints of its properties anew, which is half the cost of opening a sim;
  here each kind of handle does so once.
- A scene is recorded for a file through a client that no browser stands behind; viser knows no such client.
- Assigning any other property resolves type hints each time (30 µs for an array); `set_property` doesn't.
"""

from __future__ import annotations

import asyncio
import functools
import math
from collections import deque
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager, redirect_stdout
from io import StringIO
from types import SimpleNamespace
from typing import Any, get_type_hints
from unittest import mock

import numpy as np
import numpy.typing as npt
import viser
import websockets.asyncio.server
from viser import _scene_handles
from viser._assignable_props_api import AssignablePropsBase
from viser._scene_api import cast_vector
from viser.infra import WebsockClientConnection
from websockets.exceptions import ConnectionClosedOK

from sims.kit.outbox import Change, Outbox

Array = npt.NDArray[np.float64]
NOBODY: Any = -1
"""Number of a client without a browser; viser counts its own from 0."""
PROTOCOL = f"viser-v{viser.__version__}"


@functools.cache
def _hints(props: type) -> dict[str, Any]:
    return get_type_hints(props)


AssignablePropsBase._prop_hints = property(lambda self: _hints(type(self._impl.props)))  # type: ignore[arg-type, assignment, method-assign]


def _set_pose_vector(current: Array, value: Any, length: int, queue: Any, make_message: Any) -> None:
    """As viser's own, whose `np.allclose` takes a fifth of the time in which a scene is made."""
    new = cast_vector(value, length)
    if all(a == b or abs(a - b) <= 1e-8 + 1e-5 * abs(b) < math.inf for a, b in zip(new, current.tolist(), strict=True)):
        return
    current[:] = new
    queue(make_message(new))


_scene_handles._set_pose_vector = _set_pose_vector


class Wire:
    """What viser sees as one viewer's websocket; the bridge holds its other end."""

    def __init__(self, send: Callable[[bytes], Awaitable[None]], context: Any, protocol: str = PROTOCOL) -> None:
        self.subprotocol = protocol
        self.context = context
        self.closed = asyncio.Event()
        self._send = send
        self._waiting: deque[bytes] = deque()
        self._newest: dict[str, int] = {}
        self._taken = 0
        self._arrived = asyncio.Event()

    def feed(self, message: bytes, value_of: str | None = None) -> None:
        """Hand a message to viser. Of waiting messages with the same `value_of`, only the newest goes on.

        A message without `value_of` (a press, a drag's end) keeps its place: later values don't overtake it.
        """
        at = self._newest.get(value_of, -1) - self._taken if value_of else -1
        if at >= 0:
            self._waiting[at] = message
            return
        if value_of:
            self._newest[value_of] = self._taken + len(self._waiting)
        else:
            self._newest.clear()
        self._waiting.append(message)
        self._arrived.set()

    def hang_up(self) -> None:
        """Tell viser that the viewer is gone."""
        self.closed.set()
        self._arrived.set()

    async def recv(self) -> bytes:
        while not self._waiting:
            if self.closed.is_set():
                raise ConnectionClosedOK(None, None)
            self._arrived.clear()
            await self._arrived.wait()
        self._taken += 1
        return self._waiting.popleft()

    async def send(self, data: bytes) -> None:
        if self.closed.is_set():
            raise ConnectionClosedOK(None, None)
        await self._send(data)

    async def close(self, code: int = 1000, reason: str = "") -> None:
        self.hang_up()


class ViserHost:
    """One viser server per process, on its own event loop and without a socket."""

    def __init__(self) -> None:
        captured: dict[str, Any] = {}

        @asynccontextmanager
        async def serve(handler: Any, *_: Any, **__: Any) -> AsyncIterator[Any]:
            captured["handler"] = handler
            yield SimpleNamespace(server=SimpleNamespace(sockets=[]))

        with mock.patch.object(websockets.asyncio.server, "serve", serve), redirect_stdout(StringIO()):
            self.server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
        self._handler: Callable[[Wire], Awaitable[None]] = captured["handler"]
        self.loop: asyncio.AbstractEventLoop = self.server.get_event_loop()
        self.server.on_client_connect(self._take_over)

    async def _take_over(self, client: viser.ClientHandle) -> None:
        """Give a new client an outbox of ours; viser has nothing of its own to say to it yet."""
        outbox = Outbox(self.wire_of(client).send, self.loop)
        client._websock_connection._state.message_buffer = outbox  # type: ignore[assignment]

    async def connect(self, wire: Wire) -> None:
        """Run one viewer's connection until it ends. Call on `loop`."""
        await self._handler(wire)

    def wire_of(self, client: viser.ClientHandle) -> Wire:
        """The connection that a client handle belongs to."""
        return self.server._websock_server._live_connections[client.client_id]  # type: ignore[return-value]

    def alone(self, outbox: Outbox) -> viser.ClientHandle:
        """A client without a browser: what it is sent stays in its outbox."""
        state: Any = SimpleNamespace(message_buffer=outbox, event_loop=self.loop)
        client = viser.ClientHandle(WebsockClientConnection(NOBODY, state), self.server)
        vars(client.camera._state).update(
            update_timestamp=1.0, image_width=4, image_height=3, position=np.array([0.0, -5.0, 2.0]),
            up_direction=np.array([0.0, 0.0, 1.0]),
        )  # fmt: skip
        return client

    def stop(self) -> None:
        """End viser's loop and thread."""
        with redirect_stdout(StringIO()):
            self.server.stop()


def set_pose(
    node: viser.SceneNodeHandle,
    wxyz: tuple[float, float, float, float] | None = None,
    position: tuple[float, float, float] | None = None,
) -> None:
    """Assign a node's orientation and position where they differ at all from the last ones."""
    impl = node._impl
    if wxyz is not None and tuple(impl.wxyz.tolist()) != wxyz:
        impl.wxyz[:] = wxyz
        _put(impl, "wxyz", "SetOrientationMessage", {"wxyz": wxyz})
    if position is not None and tuple(impl.position.tolist()) != position:
        impl.position[:] = position
        _put(impl, "position", "SetPositionMessage", {"position": position})


def send_pose(node: viser.SceneNodeHandle) -> None:
    """Send a node's pose even where it is the default.

    A node that is made again under a name that was removed a moment before reaches the browser as one message,
    and the browser keeps the old node's pose.
    """
    impl = node._impl
    _put(impl, "wxyz", "SetOrientationMessage", {"wxyz": impl.wxyz.tolist()})
    _put(impl, "position", "SetPositionMessage", {"position": impl.position.tolist()})


def set_visible(node: viser.SceneNodeHandle, visible: bool) -> None:
    """Show or hide a node."""
    impl = node._impl
    if impl.visible != visible:
        impl.visible = visible
        _put(impl, "visible", "SetSceneNodeVisibilityMessage", {"visible": visible})


def set_property(handle: Any, name: str, value: Any) -> None:
    """Assign a property of a node. The value must have the type that goes over the wire.

    An array must not be changed afterwards: it is sent later.
    """
    impl = handle._impl
    setattr(impl.props, name, value)
    if isinstance(value, np.ndarray):
        _put(impl, name, "SceneNodeUpdateMessage", {}, (name, value))
    else:
        _put(impl, name, "SceneNodeUpdateMessage", {"updates": {name: value}})


def _put(impl: Any, what: str, kind: str, fields: dict[str, Any], array: Any = None) -> None:
    name, api = impl.name, impl.api
    body = {"type": kind, "name": name, "owner": api._owner_id, **fields}
    api._websock_interface.get_message_buffer().put((name, what), Change(("scene", name), body, array))
