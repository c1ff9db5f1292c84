"""The channel: JSON both ways, for what viser's client doesn't do."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Callable
from typing import Any
from urllib.parse import parse_qsl

from starlette.websockets import WebSocket

from app.rooms.places import Full
from app.rooms.registry import Sessions
from app.rooms.session import Session
from app.sockets.channel_messages import (
    Act,
    Cancel,
    Enter,
    Follow,
    Get,
    Handle,
    Hello,
    Hover,
    Lend,
    Over,
    Select,
    Set,
    Slide,
    View,
    decoder,
)
from app.sockets.commands import Commands
from app.sockets.inbox import Ended, Inbox, Read, Strangers
from app.sockets.outgoing import Outgoing
from app.sockets.visits import Visit, Visits, close
from app.trouble import error_message, refused
from sims.kit.params import Params
from sims.kit.refusals import BadParams
from sims.kit.sim import Sim

GREETED_WITHIN = 10.0
"""Seconds until a page has said what it looks like."""
FOR_ONESELF = (Follow, Get, Hover, View)
"""Messages that change nothing for others; who only watches may send these."""


class Conversation:
    """What one page says to its session, and what it is answered."""

    def __init__(self, session: Session, visit: Visit) -> None:
        self._session = session
        self._visit = visit
        self._commands = Commands(session, visit.tell)
        self._does: dict[type, Callable[[Any], None]] = {
            Act: lambda act: self._commands.act(act.name),
            Slide: lambda slide: self._commands.slide(slide.name, slide.value),
            Enter: lambda enter: self._commands.enter(enter.name, enter.text),
            Cancel: lambda _: self._commands.attempt(session.cancel),
            Follow: lambda follow: session.audience.follow(visit, follow.on),
            Get: self._get,
            Handle: lambda handle: self._commands.hold(handle.name, (handle.x, handle.y)),
            Hover: self._hover,
            Lend: lambda lend: (session.audience.hand_over if lend.on else session.audience.take_back)(),
            Over: lambda over: self._commands.pass_over(over.ray),
            Select: lambda select: self._commands.select(select.name),
            Set: lambda given: self._commands.set(given.params, given.seconds),
            View: self._view,
        }

    def may(self, message: Any) -> bool:
        """Whether the page may say that: a second greeting means nothing, and who only watches changes nothing."""
        if isinstance(message, Lend):
            return self._visit.keyed
        return not self._visit.watching or isinstance(message, FOR_ONESELF)

    def hear(self, message: Any) -> None:
        """Do what a message says."""
        self._session.touch()
        if (do := self._does.get(type(message))) is not None:
            do(message)

    def _get(self, message: Get) -> None:
        if message.solution:
            self._ask()
        else:
            self._visit.tell(self._session.state())

    def _ask(self) -> None:
        """Answer with the solution as soon as there is one; who asks again meanwhile gets the same answer."""
        visit = self._visit

        async def told() -> None:
            visit.tell(await self._session.solved_state())

        if visit.asking is None or visit.asking.done():
            visit.asking = asyncio.create_task(told())

    def _view(self, message: View) -> None:
        """Move this page's own view."""
        if self._visit.viewer is not None:
            self._commands.attempt(self._visit.viewer.look_from, message.view)

    def _hover(self, message: Hover) -> None:
        """For the whole room; where somebody only watches, for their own eyes."""
        if not self._visit.watching:
            self._commands.attempt(self._session.hover, message.name, self._visit.tell)
        elif self._visit.viewer is not None:
            self._commands.attempt(self._visit.viewer.highlight, message.name)


class ChannelSockets:
    """The channels of all pages."""

    def __init__(self, sessions: Sessions, visits: Visits, refusals: Counter[str], strangers: Strangers) -> None:
        self._sessions = sessions
        self._visits = visits
        self._refusals = refusals
        self._strangers = strangers

    async def serve(self, ws: WebSocket, sim: Sim[Any, Any], room: str, *, watching: bool) -> None:
        """Serve one page."""
        if await self._visits.may(ws):
            with self._visits.enter(ws, sim, room, watching) as visit:
                await ws.accept()
                code = await self._serve(ws, visit)
            await close(ws, code)

    async def _serve(self, ws: WebSocket, visit: Visit) -> int:
        """Serve until the page goes; the code to close with."""
        outgoing = Outgoing(ws)
        sending = asyncio.create_task(outgoing.send())
        tell = visit.tell = outgoing.put
        session: Session | None = None
        try:
            inbox = Inbox(ws, "text", decoder, self._refusals, "channel")
            session = await self._greet(inbox, visit)
            session.listen(tell)
            session.audience.enter(visit)
            answer = {"room": visit.room, "watching": visit.watching, "begins": visit.begins}
            tell({**session.state(), **answer})
            conversation = Conversation(session, visit)
            while True:
                self._hear(await inbox.next(), conversation, visit)
        except Full:
            self._refusals["full"] += 1
            return 1013
        except Ended as end:
            return end.code
        finally:
            sending.cancel()
            await asyncio.gather(sending, return_exceptions=True)
            if session is not None:
                session.leave(listener=tell)
                if visit.tell is tell:  # no newer channel of the page
                    session.audience.leave(visit)
            if visit.asking is not None:
                visit.asking.cancel()

    async def _greet(self, inbox: Inbox, visit: Visit) -> Session:
        """Take the page's first message; a room that isn't running goes on from the state that the page holds."""
        hello = await self._strangers.greeting(inbox, Hello, GREETED_WITHIN)
        visit.ticket, visit.follows = hello.ticket, hello.follows
        running = self._sessions.find(visit.sim, visit.room)
        visit.begins = visit.keyed and (running is None or running.waiting)
        session = self._open(visit, *((hello.query, hello.opened) if visit.keyed else ("", "")))
        session.motion.reduced = session.motion.reduced or hello.reduced
        if not visit.hello.done():
            visit.hello.set_result(hello)
        return session

    def _open(self, visit: Visit, held: str, opened: str) -> Session:
        """The session of a state that a page holds; of the sim's first one, if that state can't be solved."""
        sim, room, watching = visit.sim, visit.room, not visit.keyed
        try:
            return self._sessions.open(
                sim, room, _state(sim, held), opened=_state(sim, opened), watching=watching, address=visit.address
            )
        except Full:
            raise
        except Exception as error:
            visit.tell(error_message(sim, error))
            return self._sessions.open(sim, room, sim.params(), watching=watching, address=visit.address)

    def _hear(self, read: Read, conversation: Conversation, visit: Visit) -> None:
        if read.trouble:
            visit.tell(refused(f"not understood: {read.trouble}"))
        elif conversation.may(read.message):
            conversation.hear(read.message)
        else:
            self._refusals["watching"] += 1


def _state(sim: Sim[Any, Any], query: str) -> Params:
    """The state that a page says it holds; the first one of the sim where that is none."""
    try:
        state: Params = sim.params.from_query(parse_qsl(query, keep_blank_values=True))
    except BadParams:
        state = sim.params()
    return state
