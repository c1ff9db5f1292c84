"""The two websockets of a viewer: viser's own, and the channel for what viser's client doesn't do.

Both carry the viewer's name in their query, which pairs them: the channel says what the page looks like and which
state it holds (so that a restarted server can go on), and only then is the scene drawn.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import logging
import re
from collections import Counter
from dataclasses import dataclass, field
from time import monotonic
from typing import Annotated, Any
from urllib.parse import parse_qsl

import msgspec
import viser
from pydantic import ValidationError
from starlette.websockets import WebSocket, WebSocketDisconnect

from app import origins
from app.messages import GuiUpdateMessage, decoder
from app.session import Full, Session, Sessions, refusal
from sims.kit.params import BadParams, Params
from sims.kit.sim import Sim
from sims.kit.viewer import Look, Viewer
from sims.kit.viser_internals import PROTOCOL, ViserHost, Wire

log = logging.getLogger("sim3")
LARGEST_MESSAGE = 16 * 1024
MESSAGES_PER_SECOND = 200
HELLO_WITHIN = 2.0
WRONG_ORIGIN = 4403
"""Code with which a websocket is closed whose page comes from elsewhere, as far as the server can see."""
MOST_WARNINGS = 100
"""Different refusals that the log tells of."""
Number = Annotated[float, msgspec.Meta(ge=-1e9, le=1e9)]


class Hello(msgspec.Struct, tag="hello", tag_field="type", forbid_unknown_fields=True):
    """First message on the channel."""

    dark: bool
    reduced: bool
    width: int
    controls: bool
    query: Annotated[str, msgspec.Meta(max_length=4000)]
    opened: Annotated[str, msgspec.Meta(max_length=4000)] = ""
    """The query that the page was opened with, to which a reset returns."""


class Handle(msgspec.Struct, tag="handle", tag_field="type", forbid_unknown_fields=True):
    """A handle in an image pane was moved to a place, in pixels."""

    name: Annotated[str, msgspec.Meta(max_length=100)]
    x: Number
    y: Number


class Set(msgspec.Struct, tag="set", tag_field="type", forbid_unknown_fields=True):
    """The page around the sim sets parameters."""

    params: Annotated[dict[str, Any], msgspec.Meta(max_length=100)]


class Act(msgspec.Struct, tag="action", tag_field="type", forbid_unknown_fields=True):
    """A button by name."""

    name: Annotated[str, msgspec.Meta(max_length=100)]


class Point(msgspec.Struct, tag="point", tag_field="type", forbid_unknown_fields=True):
    """The pointer is on something that is linked across pictures, tables and the scene; an empty name: on nothing."""

    name: Annotated[str, msgspec.Meta(max_length=100)]


class Select(msgspec.Struct, tag="select", tag_field="type", forbid_unknown_fields=True):
    """A click on something that is linked."""

    name: Annotated[str, msgspec.Meta(max_length=100)]


class Cancel(msgspec.Struct, tag="cancel", tag_field="type", forbid_unknown_fields=True):
    """Gives up what is being worked on."""


class Get(msgspec.Struct, tag="get", tag_field="type", forbid_unknown_fields=True):
    """Asks for the state."""


channel_decoder = msgspec.json.Decoder(Hello | Handle | Set | Act | Point | Select | Cancel | Get)


@dataclass
class Bucket:
    """Lets a number of messages a second pass, with as much again for a burst."""

    rate: float = MESSAGES_PER_SECOND
    tokens: float = 2 * MESSAGES_PER_SECOND
    at: float = field(default_factory=monotonic)
    refused: int = 0

    def passes(self) -> bool:
        now = monotonic()
        self.tokens = min(self.tokens + (now - self.at) * self.rate, 2 * self.rate)
        self.at = now
        if self.tokens < 1.0:
            self.refused += 1
            return False
        self.tokens -= 1.0
        return True

    @property
    def flooding(self) -> bool:
        return self.refused > 10 * self.rate


@dataclass
class Visit:
    """One page looking at one room, by its two websockets; they share what the channel said first."""

    sim: Sim[Any, Any]
    room: str
    watching: bool
    name: str = ""
    sockets: int = 0
    viewer: Viewer | None = None
    hello: asyncio.Future[Hello] = field(default_factory=lambda: asyncio.get_running_loop().create_future())


@dataclass
class Link:
    """One viser connection of a visit."""

    visit: Visit
    viewer: Viewer | None = None

    def take(self, message: GuiUpdateMessage) -> bool:
        """Give a value to its control, which viser needn't hear of; False if there is none that can take it."""
        return self.viewer is not None and self.viewer.input(message.uuid, message.updates.value)


class Bridge:
    """Connects browsers to sessions."""

    def __init__(self, host: ViserHost, sessions: Sessions, further: str) -> None:
        self.host = host
        self.sessions = sessions
        self.refusals: Counter[str] = Counter()
        self._further = {origins.parse(text) for text in further.split()}
        self._warned: set[str] = set()
        self._visits: dict[str, Visit] = {}
        host.server.on_client_connect(self._on_connect)

    async def scene(self, ws: WebSocket, sim: Sim[Any, Any], room: str, *, watching: bool) -> None:
        """viser's websocket: check each message and hand it on, until the page goes."""
        if PROTOCOL not in ws.scope.get("subprotocols", ()):
            self.refusals["protocol"] += 1
            await ws.close(1008)
            return
        if not await self._same_origin(ws, PROTOCOL):
            return
        visit = self._visit(ws, sim, room, watching)
        await ws.accept(subprotocol=PROTOCOL)

        async def send(data: bytes) -> None:
            with contextlib.suppress(WebSocketDisconnect, RuntimeError):
                await ws.send_bytes(data)

        link = Link(visit)
        wire = Wire(send, link)
        serving = asyncio.create_task(self.host.connect(wire))
        pumping = asyncio.create_task(self._pump(ws, wire, link))
        code = 1013
        try:
            await asyncio.wait((serving, pumping), return_when=asyncio.FIRST_COMPLETED)
            code = pumping.result() if pumping.done() else code
        finally:
            wire.hang_up()
            pumping.cancel()
            await asyncio.gather(serving, pumping, return_exceptions=True)
            session = self.sessions.find(sim, room)
            if session is not None and link.viewer is not None:
                session.leave(viewer=link.viewer)
            self._part(visit)
            if code != 1000:
                with contextlib.suppress(WebSocketDisconnect, RuntimeError):
                    await ws.close(code)

    async def _pump(self, ws: WebSocket, wire: Wire, link: Link) -> int:
        bucket = Bucket()
        while not wire.closed.is_set():
            event = await ws.receive()
            if event["type"] == "websocket.disconnect":
                return 1000
            data = event.get("bytes")
            if data is None or len(data) > LARGEST_MESSAGE:
                self.refusals["size or kind"] += 1
                return 1009
            if not bucket.passes():
                self.refusals["rate"] += 1
                if bucket.flooding:
                    return 1008
                continue
            try:
                message = decoder.decode(data)
            except (msgspec.DecodeError, UnicodeDecodeError):
                self.refusals["message"] += 1
                if self.bad(bucket):
                    return 1008
                continue
            if link.visit.watching and message.commands:
                self.refusals["watching"] += 1
                continue
            if not isinstance(message, GuiUpdateMessage):
                wire.feed(data, message.value_of)
            elif not link.take(message):
                self.refusals["value"] += 1
        return 1000

    @staticmethod
    def bad(bucket: Bucket) -> bool:
        """Count a message that makes no sense; many of them end the connection."""
        bucket.refused += 50
        return bucket.flooding

    async def _on_connect(self, client: viser.ClientHandle) -> None:
        wire = self.host.wire_of(client)
        asyncio.get_running_loop().create_task(self._show(client, wire, wire.context))

    async def _show(self, client: viser.ClientHandle, wire: Wire, link: Link) -> None:
        visit = link.visit
        with contextlib.suppress(asyncio.TimeoutError):
            await asyncio.wait_for(asyncio.shield(visit.hello), HELLO_WITHIN)
        if wire.closed.is_set():
            return
        hello = visit.hello.result() if visit.hello.done() else Hello(False, False, 1280, True, "")
        try:
            # A page whose first message is late may still bring its state.
            silent = visit.watching or not visit.hello.done()
            session = self.sessions.open(visit.sim, visit.room, visit.sim.params(), watching=silent)
            look = Look(hello.dark, hello.controls, visit.watching, hello.width)
            link.viewer = visit.viewer = Viewer(visit.sim, client, session, look, session.params)
            session.join(link.viewer)
        except Full:
            self.refusals["full"] += 1
            wire.hang_up()
        except Exception:
            log.exception("showing %s failed", visit.sim.slug)
            wire.hang_up()

    async def channel(self, ws: WebSocket, sim: Sim[Any, Any], room: str, *, watching: bool) -> None:
        """The channel: JSON both ways."""
        if not await self._same_origin(ws):
            return
        visit = self._visit(ws, sim, room, watching)
        await ws.accept()
        outgoing: asyncio.Queue[dict[str, Any]] = asyncio.Queue(maxsize=32)

        def listener(message: dict[str, Any]) -> None:
            if outgoing.full():
                outgoing.get_nowait()
            outgoing.put_nowait(message)

        async def sender() -> None:
            while True:
                await ws.send_text(json.dumps(await outgoing.get(), allow_nan=False))

        sending = asyncio.create_task(sender())
        session: Session | None = None
        code = 1000
        try:
            session = await self._greet(ws, visit)
            session.listeners.add(listener)
            listener({**session.state(), "room": room, "watching": watching})
            code = await self._listen(ws, session, visit, listener)
        except Full:
            self.refusals["full"] += 1
            code = 1013
        except WebSocketDisconnect as end:
            code = end.code
        except RuntimeError:
            pass
        finally:
            sending.cancel()
            await asyncio.gather(sending, return_exceptions=True)
            if session is not None:
                session.leave(listener=listener)
            self._part(visit)
            with contextlib.suppress(WebSocketDisconnect, RuntimeError):
                await ws.close(code)

    async def _greet(self, ws: WebSocket, visit: Visit) -> Session:
        """Take the page's first message; a room that isn't running goes on from the state that the page holds."""
        try:
            hello = channel_decoder.decode(await asyncio.wait_for(ws.receive_text(), HELLO_WITHIN * 5))
        except (msgspec.DecodeError, KeyError, TimeoutError):
            hello = None
        if not isinstance(hello, Hello):
            self.refusals["channel"] += 1
            raise WebSocketDisconnect(1008)
        held, opened = ("", "") if visit.watching else (hello.query, hello.opened)
        session = self.sessions.open(
            visit.sim, visit.room, _state(visit.sim, held), opened=_state(visit.sim, opened), watching=visit.watching
        )
        session.reduced_motion = session.reduced_motion or hello.reduced
        if not visit.hello.done():
            visit.hello.set_result(hello)
        return session

    async def _listen(self, ws: WebSocket, session: Session, visit: Visit, answer: Any) -> int:
        bucket = Bucket()
        while True:
            event = await ws.receive()
            if event["type"] == "websocket.disconnect":
                return 1000
            text = event.get("text")
            if text is None or len(text) > LARGEST_MESSAGE:
                self.refusals["size or kind"] += 1
                return 1009
            if not bucket.passes():
                self.refusals["rate"] += 1
                if bucket.flooding:
                    return 1008
                continue
            try:
                message = channel_decoder.decode(text)
            except (msgspec.DecodeError, UnicodeError, RecursionError) as error:
                self.refusals["channel"] += 1
                if self.bad(bucket):
                    return 1008
                answer({"type": "error", "message": f"not understood: {error}"})
                continue
            self._obey(session, visit, message, answer)

    def _obey(self, session: Session, visit: Visit, message: Any, answer: Any) -> None:
        if isinstance(message, Get):
            answer(session.state())
            return
        if visit.watching and isinstance(message, Point):  # for their own eyes
            if visit.viewer is not None:
                visit.viewer.point(message.name)
            return
        if visit.watching:
            self.refusals["watching"] += 1
            return
        try:
            if isinstance(message, Handle):
                session.drag(message.name, (message.x, message.y))
            elif isinstance(message, Act):
                session.act(message.name)
            elif isinstance(message, Point):
                session.point(message.name, answer)
            elif isinstance(message, Select):
                session.select(message.name)
            elif isinstance(message, Cancel):
                session.cancel()
            elif isinstance(message, Set):
                session.change(message.params, live=False)
        except ValidationError as error:
            answer({"type": "error", "message": refusal(error)})
        except KeyError as error:
            answer(
                {
                    "type": "error",
                    "message": f"no such action, handle or parameter: {str(error.args[0])[:80]}",
                }
            )

    def _visit(self, ws: WebSocket, sim: Sim[Any, Any], room: str, watching: bool) -> Visit:
        """The visit that this socket belongs to; the first of its two sockets begins it."""
        name = ws.query_params.get("viewer", "")
        name = f"{sim.slug}/{room}/{watching}/{name}" if re.fullmatch(r"[a-z0-9]{8,40}", name) else ""
        visit = self._visits.get(name) or Visit(sim, room, watching, name)
        if name:
            self._visits[name] = visit
        visit.sockets += 1
        return visit

    def _part(self, visit: Visit) -> None:
        visit.sockets -= 1
        if not visit.sockets:
            self._visits.pop(visit.name, None)

    async def _same_origin(self, ws: WebSocket, protocol: str | None = None) -> bool:
        """Whether the page may open a websocket; if not, it is told why. The key in the path is the secret.

        A browser shows a page nothing of a websocket that isn't accepted, so it is, and closed with a reason.
        """
        wrong = origins.mismatch(ws.headers, ws.url.scheme == "wss", self._further)
        if wrong is None:
            return True
        self.refusals["origin"] += 1
        if (line := wrong.line()) not in self._warned and len(self._warned) < MOST_WARNINGS:
            self._warned.add(line)  # once: pages try again every second
            log.warning("a websocket was refused. %s", line)
        with contextlib.suppress(WebSocketDisconnect, RuntimeError):
            await ws.accept(subprotocol=protocol)
            await ws.close(WRONG_ORIGIN, wrong.reason())
        return False


def _state(sim: Sim[Any, Any], query: str) -> Params:
    """The state that a page says it holds; the first one of the sim where that is none."""
    try:
        state: Params = sim.params.from_query(parse_qsl(query, keep_blank_values=True))
    except BadParams:
        state = sim.params()
    return state
