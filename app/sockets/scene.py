"""viser's websocket: each message of its client is checked and handed on, until the page goes."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import viser
from starlette.websockets import WebSocket, WebSocketDisconnect

from app.rooms.places import Full
from app.rooms.registry import Sessions
from app.rooms.session import Session
from app.sockets.channel_messages import Hello
from app.sockets.commands import Commands
from app.sockets.inbox import Ended, Inbox, Read, Strangers
from app.sockets.viser_messages import ViewerCameraMessage, decoder
from app.sockets.visits import Visit, Visits, close
from sims.kit.scene.view import FIELD, Seen, aspect
from sims.kit.sim import Sim
from sims.kit.viewer import Viewer
from sims.kit.viser_internals import PROTOCOL, ViserHost, Wire

log = logging.getLogger("sim3")
HELLO_WITHIN = 2.0
"""Seconds that the scene waits for what the channel says first."""
SEEN_WITHIN = 30.0
"""Seconds that viser's websocket may be open before it shows something."""
SILENT = Hello(dark=False, reduced=False, query="")
"""What is taken for granted of a page that says nothing."""


@dataclass
class Link:
    """One viser connection of a visit."""

    visit: Visit
    seen: Callable[[], None]
    """To be called once it shows something."""
    viewer: Viewer | None = None


class SceneSockets:
    """The scenes of all pages."""

    def __init__(
        self, host: ViserHost, sessions: Sessions, visits: Visits, refusals: Counter[str], strangers: Strangers
    ) -> None:
        self._host = host
        self._sessions = sessions
        self._visits = visits
        self._refusals = refusals
        self._strangers = strangers
        host.server.on_client_connect(self._on_connect)

    async def serve(self, ws: WebSocket, sim: Sim[Any, Any], room: str, *, watching: bool) -> None:
        """Serve one page."""
        if PROTOCOL not in ws.scope.get("subprotocols", ()):
            self._refusals["protocol"] += 1
            await ws.close(1008)
        elif await self._visits.may(ws, PROTOCOL):
            with self._visits.enter(ws, sim, room, watching) as visit:
                await ws.accept(subprotocol=PROTOCOL)
                code = await self._serve(ws, visit)
            if code != 1000:
                await close(ws, code)

    async def _serve(self, ws: WebSocket, visit: Visit) -> int:
        """Serve until the page goes; the code to close with."""

        async def send(data: bytes) -> None:
            with contextlib.suppress(WebSocketDisconnect, RuntimeError):
                await ws.send_bytes(data)

        wire = Wire(send, None)
        link = wire.context = Link(visit, self._strangers.enter(wire.hang_up, SEEN_WITHIN))
        serving = asyncio.create_task(self._host.connect(wire))
        pumping = asyncio.create_task(self._pump(ws, wire, link))
        try:
            await asyncio.wait((serving, pumping), return_when=asyncio.FIRST_COMPLETED)
            return pumping.result() if pumping.done() else 1013
        finally:
            link.seen()
            wire.hang_up()
            pumping.cancel()
            await asyncio.gather(serving, pumping, return_exceptions=True)
            session = self._sessions.find(visit.sim, visit.room)
            if session is not None and link.viewer is not None:
                session.leave(viewer=link.viewer)

    async def _pump(self, ws: WebSocket, wire: Wire, link: Link) -> int:
        inbox = Inbox(ws, "bytes", decoder, self._refusals, "message")
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
            self._refusals["watching"] += 1
        else:
            if (session := self._sessions.find(link.visit.sim, link.visit.room)) is not None:
                session.touch()
                if isinstance(message, ViewerCameraMessage):
                    _lead(session, link.visit, message)
            wire.feed(read.data, message.value_of)

    async def _on_connect(self, client: viser.ClientHandle) -> None:
        wire = self._host.wire_of(client)
        asyncio.get_running_loop().create_task(self._show(client, wire, wire.context))

    async def _show(self, client: viser.ClientHandle, wire: Wire, link: Link) -> None:
        visit = link.visit
        with contextlib.suppress(asyncio.TimeoutError):
            await asyncio.wait_for(asyncio.shield(visit.hello), HELLO_WITHIN)
        if wire.closed.is_set():
            return
        try:
            self._join(client, link)
        except Full:
            self._refusals["full"] += 1
            wire.hang_up()
        except Exception:
            log.exception("showing %s failed", visit.sim.slug)
            wire.hang_up()

    def _join(self, client: viser.ClientHandle, link: Link) -> None:
        """Show the room's session. Raises `Full`."""
        visit = link.visit
        hello = visit.hello.result() if visit.hello.done() else SILENT
        # A page whose first message is late may still bring its state.
        silent = not visit.keyed or not visit.hello.done()
        session = self._sessions.open(visit.sim, visit.room, visit.sim.params(), watching=silent, address=visit.address)
        commands = Commands(session, lambda message: visit.tell(message))
        link.viewer = visit.viewer = Viewer(visit.sim, client, commands, dark=hello.dark, watching=visit.watching)
        session.join(link.viewer)
        session.audience.show(visit)
        link.seen()


def _lead(session: Session, visit: Visit, camera: ViewerCameraMessage) -> None:
    """Let others see from there. Who looks through a camera of the sim does so by its state, which all have."""
    if abs(camera.fov - FIELD) < 1e-3:
        session.audience.looked(visit, Seen(camera.position, camera.look_at, aspect(camera)))
