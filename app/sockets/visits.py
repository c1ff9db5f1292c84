"""Pages that look at rooms: each by two websockets, viser's own and the channel.

Both carry the viewer's name in their query, which pairs them: the channel says what the page looks like and which
state it holds (so that a restarted server can go on), and only then is the scene drawn.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

from app.proxies import address_of
from app.sockets import origins
from app.sockets.channel_messages import Hello
from app.sockets.commands import Answer
from sims.kit.scene.view import Seen
from sims.kit.sim import Sim
from sims.kit.viewer import Viewer

log = logging.getLogger("sim3")
WRONG_ORIGIN = 4403
"""Code with which a websocket is closed whose page comes from elsewhere, as far as the server can see."""
IDLE = 4408
"""Code for a page in whose room nobody has done anything for long."""
RESTARTS = 1012
"""Code for a page whose server ends."""
MOST_WARNINGS = 100
"""Different refusals that the log tells of."""


@dataclass(eq=False)
class Visit:
    """One page looking at one room, by its two websockets; they share what the channel said first."""

    sim: Sim[Any, Any]
    room: str
    keyed: bool
    """It came with the room's key."""
    name: str = ""
    address: str = ""
    """The page's machine, as far as proxies tell."""
    ticket: str = ""
    """What it was handed to steer the room with."""
    watching: bool = True
    """It may only watch."""
    follows: bool = True
    """It lets its viewpoint be led."""
    begins: bool = False
    """The room began with the state that it holds: nobody with control was there before."""
    sockets: set[WebSocket] = field(default_factory=set)
    viewer: Viewer | None = None
    seen: Seen | None = None
    """From where it looks."""
    tell: Answer = lambda message: None
    """Says something on the channel, once there is one."""
    asking: asyncio.Task[None] | None = None
    """Waits for a solution that the page wants."""
    hello: asyncio.Future[Hello] = field(default_factory=lambda: asyncio.get_running_loop().create_future())


class Visits:
    """The pages that are open. Refusals are counted; those for a page's origin are logged, each once."""

    def __init__(self, refusals: Counter[str], further: str) -> None:
        self._refusals = refusals
        self._further = {origins.parse(text) for text in further.split()}
        self._open: dict[str, Visit] = {}
        self.warned: set[str] = set()
        self._closing: set[asyncio.Future[None]] = set()

    def __len__(self) -> int:
        return len(self._open)

    @contextlib.contextmanager
    def enter(self, ws: WebSocket, sim: Sim[Any, Any], room: str, watching: bool) -> Iterator[Visit]:
        """The visit that a socket belongs to; the first of its two sockets begins it, the last one ends it."""
        name = ws.query_params.get("viewer", "")
        name = f"{sim.slug}/{room}/{watching}/{name}" if re.fullmatch(r"[a-z0-9]{8,40}", name) else ""
        visit = self._open.get(name) or Visit(sim, room, not watching, name, address_of(ws), watching=watching)
        self._open[name or str(id(visit))] = visit
        visit.sockets.add(ws)
        try:
            yield visit
        finally:
            visit.sockets.discard(ws)
            if not visit.sockets:
                self._open.pop(name or str(id(visit)), None)

    def put_away(self, sim: Sim[Any, Any], room: str) -> None:
        """Close the pages of a room in which nobody does anything; they wait until somebody does."""
        self._hang_up([each for each in self._open.values() if each.sim is sim and each.room == room], IDLE)

    def send_elsewhere(self) -> None:
        """Close all pages, which then look for another server, or for this one begun anew."""
        self._hang_up([*self._open.values()], RESTARTS)

    def _hang_up(self, visits: list[Visit], code: int) -> None:
        for ws in [ws for visit in visits for ws in visit.sockets]:
            closing = asyncio.ensure_future(close(ws, code))
            self._closing.add(closing)
            closing.add_done_callback(self._closing.discard)

    async def may(self, ws: WebSocket, protocol: str | None = None) -> bool:
        """Whether the page may open a websocket; if not, it is told why. The key in the path is the secret.

        A browser shows a page nothing of a websocket that isn't accepted, so it is, and closed with a reason.
        """
        wrong = origins.mismatch(ws.headers, ws.url.scheme == "wss", self._further)
        if wrong is None:
            return True
        self._refusals["origin"] += 1
        if (line := wrong.line()) not in self.warned and len(self.warned) < MOST_WARNINGS:
            self.warned.add(line)  # once: pages try again every second
            log.warning("a websocket was refused. %s", line)
        with contextlib.suppress(WebSocketDisconnect, RuntimeError):
            await ws.accept(subprotocol=protocol)
            await ws.close(WRONG_ORIGIN, wrong.reason())
        return False


async def close(ws: WebSocket, code: int) -> None:
    """Close a websocket that may be closed already."""
    with contextlib.suppress(WebSocketDisconnect, RuntimeError):
        await ws.close(code)
