"""The two websockets of a viewer: viser's own, and the channel for what viser's client doesn't do.

Both carry the viewer's name in their query, which pairs them: the channel says what the page looks like and which
state it holds (so that a restarted server can go on), and only then is the scene drawn.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import re
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Annotated, Any
from urllib.parse import parse_qsl

import msgspec
import viser
from starlette.websockets import WebSocket, WebSocketDisconnect

from app import origins
from app.commands import Answer, Commands
from app.inbox import Ended, Inbox, Read, Strangers
from app.messages import GuiUpdateMessage, decoder
from app.outgoing import Outgoing
from app.session import Full, Session, Sessions
from app.trouble import error_message, refused
from sims.kit.params import Params
from sims.kit.refusals import BadParams
from sims.kit.sim import Sim
from sims.kit.viewer import Look, Viewer
from sims.kit.viser_internals import PROTOCOL, ViserHost, Wire

log = logging.getLogger("sim3")
HELLO_WITHIN = 2.0
SEEN_WITHIN = 30.0
"""Seconds that viser's websocket may be open before it shows something."""
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
    height: int = 800


class Handle(msgspec.Struct, tag="handle", tag_field="type", forbid_unknown_fields=True):
    """A handle in an image pane was moved to a place, in pixels."""

    name: Annotated[str, msgspec.Meta(max_length=100)]
    x: Number
    y: Number


class Set(msgspec.Struct, tag="set", tag_field="type", forbid_unknown_fields=True):
    """The page around the sim sets parameters."""

    params: Annotated[dict[str, Any], msgspec.Meta(max_length=100)]
    seconds: float | None = None
    """To glide there in; None is at once."""


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


class View(msgspec.Struct, tag="view", tag_field="type", forbid_unknown_fields=True):
    """The page looks from another place: viewpoint and looked-at place, x, y, z each."""

    view: Annotated[list[Number], msgspec.Meta(min_length=6, max_length=6)]
    fit: bool = False
    """As it fits the sim's first view; a scene that has found another one since fits that."""


class Get(msgspec.Struct, tag="get", tag_field="type", forbid_unknown_fields=True):
    """Asks for the state, and for its solution too."""

    solution: bool = False


channel_decoder = msgspec.json.Decoder(Hello | Handle | Set | Act | Point | Select | Cancel | Get | View)


@dataclass
class Visit:
    """One page looking at one room, by its two websockets; they share what the channel said first."""

    sim: Sim[Any, Any]
    room: str
    watching: bool
    name: str = ""
    sockets: int = 0
    viewer: Viewer | None = None
    tell: Answer = lambda message: None
    """Says something on the channel, once there is one."""
    asking: asyncio.Task[None] | None = None
    """Waits for a solution that the page wants."""
    hello: asyncio.Future[Hello] = field(default_factory=lambda: asyncio.get_running_loop().create_future())


@dataclass
class Link:
    """One viser connection of a visit."""

    visit: Visit
    seen: Callable[[], None]
    """To be called once it shows something."""
    viewer: Viewer | None = None
    commands: Commands | None = None

    def take(self, message: GuiUpdateMessage) -> bool:
        """Give a value to its control, which viser needn't hear of; False if there is none that can take it."""
        if self.viewer is None or self.commands is None:
            return False
        return bool(self.commands.attempt(self.viewer.input, message.uuid, message.updates.value))


class Bridge:
    """Connects browsers to sessions."""

    def __init__(self, host: ViserHost, sessions: Sessions, further: str) -> None:
        self.host = host
        self.sessions = sessions
        self.refusals: Counter[str] = Counter()
        self.strangers = Strangers(self.refusals)
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

        wire = Wire(send, None)
        link = wire.context = Link(visit, self.strangers.enter(wire.hang_up, SEEN_WITHIN))
        serving = asyncio.create_task(self.host.connect(wire))
        pumping = asyncio.create_task(self._pump(ws, wire, link))
        code = 1013
        try:
            await asyncio.wait((serving, pumping), return_when=asyncio.FIRST_COMPLETED)
            code = pumping.result() if pumping.done() else code
        finally:
            link.seen()
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
        inbox = Inbox(ws, "bytes", decoder, self.refusals, "message")
        try:
            while not wire.closed.is_set():
                self._hand_on(await inbox.next(), wire, link)
        except Ended as end:
            return end.code
        return 1000

    def _hand_on(self, read: Read, wire: Wire, link: Link) -> None:
        message = read.message
        if read.trouble:
            return
        if link.visit.watching and message.commands:
            self.refusals["watching"] += 1
        elif not isinstance(message, GuiUpdateMessage):
            wire.feed(read.data, message.value_of)
        elif not link.take(message):
            self.refusals["value"] += 1

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
            look = Look(hello.dark, hello.controls, visit.watching, hello.width, hello.height)
            link.commands = Commands(session, lambda message: visit.tell(message))
            link.viewer = visit.viewer = Viewer(visit.sim, client, link.commands, look, session.params, session.given)
            session.join(link.viewer)
            link.seen()
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
        outgoing = Outgoing(ws)
        inbox = Inbox(ws, "text", channel_decoder, self.refusals, "channel")
        sending = asyncio.create_task(outgoing.send())
        tell = visit.tell = outgoing.put
        session: Session | None = None
        code = 1000
        try:
            session = await self._greet(inbox, visit)
            session.listeners.add(tell)
            tell({**session.state(), "room": room, "watching": watching})
            while True:
                self._hear(await inbox.next(), session, visit, tell)
        except Full:
            self.refusals["full"] += 1
            code = 1013
        except Ended as end:
            code = end.code
        finally:
            sending.cancel()
            await asyncio.gather(sending, return_exceptions=True)
            if session is not None:
                session.leave(listener=tell)
            if visit.asking is not None:
                visit.asking.cancel()
            self._part(visit)
            with contextlib.suppress(WebSocketDisconnect, RuntimeError):
                await ws.close(code)

    async def _greet(self, inbox: Inbox, visit: Visit) -> Session:
        """Take the page's first message; a room that isn't running goes on from the state that the page holds."""
        reading = asyncio.ensure_future(inbox.next())
        known = self.strangers.enter(reading.cancel, HELLO_WITHIN * 5)
        try:
            await asyncio.wait((reading,))
        finally:
            known()
            reading.cancel()
        if reading.cancelled() or reading.exception() or not isinstance(hello := reading.result().message, Hello):
            self.refusals["no greeting"] += 1
            raise Ended(1008)
        session = self._open(visit, *(("", "") if visit.watching else (hello.query, hello.opened)))
        session.reduced_motion = session.reduced_motion or hello.reduced
        if not visit.hello.done():
            visit.hello.set_result(hello)
        return session

    def _open(self, visit: Visit, held: str, opened: str) -> Session:
        """The session of a state that a page holds; of the sim's first one, if that state can't be solved."""
        sim, room, watching = visit.sim, visit.room, visit.watching
        try:
            return self.sessions.open(sim, room, _state(sim, held), opened=_state(sim, opened), watching=watching)
        except Full:
            raise
        except Exception as error:
            visit.tell(error_message(sim, error))
            return self.sessions.open(sim, room, sim.params(), watching=watching)

    def _hear(self, read: Read, session: Session, visit: Visit, answer: Answer) -> None:
        if read.trouble:
            answer(refused(f"not understood: {read.trouble}"))
        else:
            self._obey(session, visit, read.message, answer)

    def _obey(self, session: Session, visit: Visit, message: Any, answer: Answer) -> None:
        if isinstance(message, Get):
            if message.solution:
                self._ask(session, visit, answer)
            else:
                answer(session.state())
            return
        commands = Commands(session, answer)
        if isinstance(message, View):  # of this page alone
            if visit.viewer is not None:
                commands.attempt(visit.viewer.look_from, message.view, message.fit)
            return
        if visit.watching and isinstance(message, Point):  # for their own eyes
            if visit.viewer is not None:
                commands.attempt(visit.viewer.point, message.name)
            return
        if visit.watching:
            self.refusals["watching"] += 1
            return
        if isinstance(message, Handle):
            commands.hold(message.name, (message.x, message.y))
        elif isinstance(message, Act):
            commands.act(message.name)
        elif isinstance(message, Point):
            commands.attempt(session.point, message.name, answer)
        elif isinstance(message, Select):
            commands.select(message.name)
        elif isinstance(message, Cancel):
            commands.attempt(session.cancel)
        elif isinstance(message, Set):
            commands.set(message.params, message.seconds)

    def _ask(self, session: Session, visit: Visit, answer: Answer) -> None:
        """Answer with the solution as soon as there is one; who asks again meanwhile gets the same answer."""

        async def told() -> None:
            answer(await session.solved_state())

        if visit.asking is None or visit.asking.done():
            visit.asking = asyncio.create_task(told())

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
