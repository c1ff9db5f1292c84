"""Connects browsers to sessions, by two kinds of websocket, and counts what is refused."""

from __future__ import annotations

from collections import Counter

from app.rooms.registry import Sessions
from app.sockets.channel import ChannelSockets
from app.sockets.inbox import Strangers
from app.sockets.scene import SceneSockets
from app.sockets.visits import Visits
from sims.kit.viser_internals import ViserHost


class Bridge:
    """The websockets of a server. Pages of `further` origins, with blanks between, may open some too."""

    def __init__(self, host: ViserHost, sessions: Sessions, further: str) -> None:
        self.refusals: Counter[str] = Counter()
        self.visits = Visits(self.refusals, further)
        self.strangers = strangers = Strangers(self.refusals)
        self.scene = SceneSockets(host, sessions, self.visits, self.refusals, strangers)
        self.channel = ChannelSockets(sessions, self.visits, self.refusals, strangers)
