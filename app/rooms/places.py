"""Who has how many of a server's rooms: one address, which may be a whole school's, doesn't take all of them."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable
from dataclasses import dataclass
from ipaddress import IPv6Address, ip_address
from time import monotonic
from typing import Protocol

REMEMBERED = 10_000
"""Addresses whose openings are remembered."""
MINUTE = 60.0


class Full(RuntimeError):
    """No more sessions fit; `wait` are the seconds after which it is worth another try."""

    def __init__(self, words: str = "All places on this server are taken.", wait: int = 20) -> None:
        super().__init__(words)
        self.wait = wait


class Place(Protocol):
    """What is known of a room that is open."""

    opener: str


def neighbourhood(address: str) -> str:
    """The part of an address that one household or school has: of IPv6, the first half. Empty for what is none."""
    try:
        ip = ip_address(address.partition("%")[0])
    except ValueError:
        return ""
    if not isinstance(ip, IPv6Address):
        return str(ip)
    if (v4 := ip.ipv4_mapped) is not None:
        return str(v4)
    return str(IPv6Address(int(ip) >> 64 << 64))


@dataclass
class Openings:
    """The rooms that one address may still open just now."""

    left: float
    at: float


class Fairness:
    """At most `each` rooms for an address at once, and `a_minute` new ones a minute, all at once if need be.

    Who has no address, as on a socket of this machine, always may. `what` people call them.
    """

    def __init__(self, each: int, a_minute: int, what: str = "sims") -> None:
        self._each = each
        self._a_minute = a_minute
        self._what = what
        self._openings: OrderedDict[str, Openings] = OrderedDict()

    def may_open(self, opener: str, places: Iterable[Place]) -> None:
        """Count one in. Raises `Full` in words."""
        self.may_have(opener, places)
        self.count(opener)

    def may_have(self, opener: str, places: Iterable[Place]) -> None:
        """Whether an address may have one more. Raises `Full` in words."""
        if opener and sum(place.opener == opener for place in places) >= self._each:
            raise Full(f"Your network has {self._each} {self._what} open on this server already, as many as one may.")

    def count(self, opener: str) -> None:
        """Count one of this minute. Raises `Full` in words."""
        if not opener:
            return
        now, rate = monotonic(), self._a_minute / MINUTE
        known = self._openings.pop(opener, None) or Openings(self._a_minute, now)
        known.left = min(known.left + (now - known.at) * rate, self._a_minute)
        known.at = now
        self._openings[opener] = known
        if len(self._openings) > REMEMBERED:
            self._openings.popitem(last=False)
        if known.left < 1.0:
            words = f"Your network has opened {self._a_minute} {self._what} within a minute, as many as one may."
            raise Full(words, wait=max(1, round((1.0 - known.left) / rate)))
        known.left -= 1.0
