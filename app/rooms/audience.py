"""Who is in a room: who steers it, how many watch, and whose viewpoint the others follow."""

from __future__ import annotations

import asyncio
import time
from hmac import compare_digest
from typing import Protocol

from app.rooms.keys import new_key
from app.rooms.telling import Listener, Message, Shared
from sims.kit.scene.view import Seen
from sims.kit.viewer import Viewer

VIEW_INTERVAL = 0.1
"""Seconds between two viewpoints that are handed on: the newest wins, and pages glide from each to the next."""


class Guest(Protocol):
    """One page in a room."""

    keyed: bool
    """It came with the room's key."""
    ticket: str
    """What it was handed to steer with."""
    watching: bool
    """It may only watch."""
    follows: bool
    """It lets its viewpoint be led, where somebody leads."""
    viewer: Viewer | None
    seen: Seen | None
    """From where it looks."""

    @property
    def tell(self) -> Listener:
        """Takes what it is told."""
        ...


class Audience:
    """The guests of one room.

    Who has the key steers, and may hand over: a ticket, in a link, with which others steer until it is taken back.
    Whoever steers and moves the view leads it. Each guest is told its part when that changes.
    """

    def __init__(self) -> None:
        self._ticket = ""
        self._told: dict[Guest, Message] = {}
        """Everybody who is here, with what they know of their part."""
        self._leader: Guest | None = None
        self._begun = False
        self._shown_at = 0.0
        self._waiting: asyncio.TimerHandle | None = None

    def enter(self, guest: Guest) -> None:
        """Let a page in. The first one with the key brings the ticket along, if a server before this one had one."""
        if guest.keyed and not self._begun:
            self._begun, self._ticket = True, guest.ticket
        self._told[guest] = {}
        self._assign()

    def leave(self, guest: Guest) -> None:
        """Forget a page."""
        self._told.pop(guest, None)
        _may(guest, steer=guest.keyed)
        self._assign()

    def hand_over(self) -> None:
        """Make a new ticket; one that was made before is worth nothing more."""
        self._give(new_key())

    def take_back(self) -> None:
        """Have only those steer who have the key."""
        self._give("")

    def _give(self, ticket: str) -> None:
        self._ticket = ticket
        for guest in self._told:
            guest.follows = guest.follows or not guest.watching
        self._assign()

    def _steers(self, guest: Guest) -> bool:
        return guest.keyed or (self._ticket != "" and compare_digest(guest.ticket.encode(), self._ticket.encode()))

    # ---- viewpoints

    def looked(self, guest: Guest, seen: Seen) -> None:
        """A page looks from somewhere else. Who steers leads by that, unless they follow somebody themselves."""
        before, guest.seen = guest.seen, seen
        if guest not in self._told:
            return
        if self._follows(guest):
            if before is None:  # a scene that has just begun, by its own view
                self.show(guest)
        elif not guest.watching and (self._leader in (None, guest) or before not in (None, seen)):
            self._lead(guest)

    def follow(self, guest: Guest, on: bool) -> None:
        """A page lets its viewpoint be led, or goes its own way; who steers leads from then on."""
        guest.follows = on
        if not on and not guest.watching and guest.seen is not None:
            self._lead(guest)
        self._assign()
        if on:
            self.show(guest)

    def show(self, guest: Guest) -> None:
        """Tell a page from where it is led to look, if it is."""
        if (led := self._led()) is not None and self._follows(guest):
            guest.tell(led)

    def _led(self) -> Message | None:
        """What those who follow are told, who see the same through pages of other shapes."""
        if self._leader is None or (seen := self._leader.seen) is None:
            return None
        return Shared(type="led", view=[*seen.position, *seen.look_at], aspect=seen.aspect)

    def _follows(self, guest: Guest) -> bool:
        """Those who share a room's key each have their own view, as long as nothing is handed over."""
        led = self._leader is not None and guest is not self._leader
        return led and guest.follows and (not guest.keyed or self._ticket != "")

    def _lead(self, guest: Guest) -> None:
        if guest is not self._leader:
            self._leader = guest
            self._assign()
        self._show_soon()

    def _show_soon(self) -> None:
        if self._waiting is None:
            wait = self._shown_at + VIEW_INTERVAL - time.monotonic()
            self._waiting = asyncio.get_running_loop().call_later(max(wait, 0.0), self._show_all)

    def _show_all(self) -> None:
        self._waiting = None
        self._shown_at = time.monotonic()
        if (led := self._led()) is not None:
            for guest in [each for each in self._told if self._follows(each)]:
                guest.tell(led)

    # ---- parts

    def _assign(self) -> None:
        """Everybody's part anew: what they may, and what they are told of it."""
        for guest in self._told:
            _may(guest, steer=self._steers(guest))
        if self._leader not in (leaders := [each for each in self._told if each.seen and not each.watching]):
            self._leader = leaders[0] if leaders else None
            self._show_soon()
        for guest in list(self._told):
            self._tell(guest)

    def _tell(self, guest: Guest) -> None:
        led = self._leader is not None and guest is not self._leader
        part: Message = {"type": "room", "steers": not guest.watching, "follows": self._follows(guest), "led": led}
        if not guest.watching:
            part["watchers"] = sum(other.watching for other in self._told)
        if guest.keyed:
            part["ticket"] = self._ticket
            part["helpers"] = sum(not (other.watching or other.keyed) for other in self._told)
        if self._told[guest] != part:
            self._told[guest] = part
            guest.tell(part)

    def end(self) -> None:
        """Show nothing more by itself."""
        if self._waiting is not None:
            self._waiting.cancel()


def _may(guest: Guest, *, steer: bool) -> None:
    guest.watching = not steer
    if guest.viewer is not None:
        guest.viewer.watching = guest.watching
