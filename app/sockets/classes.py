"""The websockets of classes: one for each learner, and one for each page of a teacher."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any

from pydantic import ValidationError
from starlette.websockets import WebSocket

from app.classes.live import Class, Learner
from app.classes.registry import Classes, Wrong
from app.classes.subject import Subject
from app.proxies import address_of
from app.rooms.places import Full
from app.rooms.telling import Listener, encode
from app.sockets.class_messages import (
    Answer,
    Ask,
    At,
    End,
    Guess,
    Join,
    Look,
    Open,
    Show,
    learner_decoder,
    teacher_decoder,
)
from app.sockets.inbox import Decoder, Ended, Inbox, Strangers
from app.sockets.outgoing import Outgoing
from app.sockets.visits import Visits, close
from app.values import strict
from sims.kit.params import Params

GREETED_WITHIN = 10.0
"""Seconds until a page has said who it is."""
NO_CLASS = 4404
"""Code for a learner's page whose class isn't there: not yet, not any more, or not here after a restart."""
NOT_YOURS = 4403
"""Code for a page whose key leads no such class."""
OVER = 4410
"""Code for a page whose class has ended."""
FULL = 1013


class ClassSockets:
    """The websockets of all classes. `subject` says what a teacher's page and query are about, or raises ValueError."""

    def __init__(
        self, classes: Classes, visits: Visits, refusals: Counter[str], strangers: Strangers,
        subject: Callable[[str, str], Subject],
    ) -> None:  # fmt: skip
        self._classes = classes
        self._visits = visits
        self._refusals = refusals
        self._strangers = strangers
        self._subject = subject

    async def learn(self, ws: WebSocket, code: str) -> None:
        """Serve a learner's page."""
        await self._serve(ws, learner_decoder, lambda inbox, tell: self._learn(inbox, tell, code))

    async def teach(self, ws: WebSocket, code: str, key: str) -> None:
        """Serve a teacher's page."""
        await self._serve(ws, teacher_decoder, lambda inbox, tell: self._teach(inbox, tell, code, key, address_of(ws)))

    async def _serve(self, ws: WebSocket, decoder: Decoder, talk: Callable[[Inbox, Listener], Any]) -> None:
        """Let a page talk until it goes, and close with a code that says why."""
        if not await self._visits.may(ws):
            return
        await ws.accept()
        outgoing = Outgoing(ws)
        sending = asyncio.create_task(outgoing.send())
        try:
            code = await talk(Inbox(ws, "text", decoder, self._refusals, "class"), outgoing.put)
        except Ended as end:
            code = end.code
        except Full as full:
            self._refusals["class full"] += 1
            await ws.send_text(encode({"type": "full", "words": str(full)}))
            code = FULL
        finally:
            sending.cancel()
            await asyncio.gather(sending, return_exceptions=True)
        await close(ws, code)

    # ---- a learner

    async def _learn(self, inbox: Inbox, tell: Listener, code: str) -> int:
        join = await self._strangers.greeting(inbox, Join, GREETED_WITHIN)
        found = self._classes.find(code)
        if found is None:
            self._refusals["no class"] += 1
            return NO_CLASS
        learner = found.enter(join.me, join.animal, tell)
        try:
            while not found.over:
                self._hear_learner(found, learner, (await inbox.next()).message)
            return OVER
        finally:
            found.leave(learner, tell)

    def _hear_learner(self, found: Class, learner: Learner, message: Any) -> None:
        if isinstance(message, At):
            self._with(found, message.params, lambda params: found.reached(learner, params))
        elif isinstance(message, Guess):
            found.guess(learner, message.box, message.value)
        elif isinstance(message, Answer):
            if message.params is None:
                found.answer(learner, None)
            else:
                self._with(found, message.params, lambda params: found.answer(learner, params))

    # ---- a teacher

    async def _teach(self, inbox: Inbox, tell: Listener, code: str, key: str, address: str) -> int:
        first = await self._strangers.greeting(inbox, Open, GREETED_WITHIN)
        try:
            subject = self._subject(first.page, first.query)
            found = await self._classes.open(code, key, subject, first.ends, address)
        except (Wrong, ValueError):
            self._refusals["class key"] += 1
            return NOT_YOURS
        if first.params is not None and found.shown is None:  # a class that was brought back
            self._with(found, first.params, found.show)
            found.look(first.eyes)
        found.listen(tell)
        try:
            while not found.over:
                self._hear_teacher(found, (await inbox.next()).message)
            return OVER
        finally:
            found.teachers.discard(tell)

    def _hear_teacher(self, found: Class, message: Any) -> None:
        if isinstance(message, Show):
            self._with(found, message.params, found.show)
        elif isinstance(message, Look):
            found.look(message.eyes)
        elif isinstance(message, Ask):
            found.ask(message.animal)
        elif isinstance(message, End):
            self._classes.end(found.code)

    def _with(self, found: Class, given: Mapping[str, Any], take: Callable[[Params], None]) -> None:
        """Take a state, if it is one of the class's sim."""
        try:
            params = strict(found.subject.sim.params, given)
        except ValidationError:
            self._refusals["class state"] += 1
        else:
            take(params)
