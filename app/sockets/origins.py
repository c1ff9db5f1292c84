"""Origins of pages, and which of them may open a websocket here.

An origin is a scheme, a host and a port, and two are the same when all three are (RFC 6454): a port that is the
scheme's own needn't be written, and the letters of a host have no case.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import dataclass
from ipaddress import IPv6Address
from typing import NamedTuple

from starlette.datastructures import Headers

PORTS = {"http": 80, "https": 443}
HOST = re.compile(r"(?P<name>[a-z0-9._-]+|\[(?P<six>[0-9a-f:.]+)\])(:(?P<port>[0-9]{1,5}))?", re.IGNORECASE)
LONGEST_REASON = 120
"""Bytes of the reason that a websocket is closed with; the protocol allows 123."""


class Origin(NamedTuple):
    """Where a page comes from."""

    scheme: str
    host: str
    port: int


def parse(text: str) -> Origin:
    """The origin that is written as browsers do it. Raises ValueError."""
    scheme, found, host = text.partition("://")
    if not found or scheme.lower() not in PORTS:
        raise ValueError("an origin begins with http:// or https://")
    return at(scheme.lower(), host)


def at(scheme: str, host: str) -> Origin:
    """The origin of what is reached by a scheme at a host, with or without its port. Raises ValueError."""
    found = HOST.fullmatch(host)
    port = PORTS[scheme] if found is None or found["port"] is None else int(found["port"])
    if found is None or port > 65535:
        raise ValueError("an origin is a scheme and a host, and may have a port; nothing else")
    name = f"[{IPv6Address(found['six']).compressed}]" if found["six"] else found["name"].lower()
    return Origin(scheme, name, port)


@dataclass(frozen=True)
class Mismatch:
    """Why a page may not open a websocket: its origin, and what a header said instead; empty: it can't be read."""

    origin: str
    header: str = ""
    value: str = ""
    hint: str = ""

    def reason(self) -> str:
        """For the page, which shows it."""
        room = (LONGEST_REASON - len(self._words("", "").encode())) // 2
        return self._words(_clipped(self.value, room), _clipped(self.origin, room))

    def line(self) -> str:
        """For the log: with what to do about it."""
        return f"{self._words(_clipped(self.value, 200), _clipped(self.origin, 200))} {self.hint}".rstrip()

    def _words(self, value: str, origin: str) -> str:
        if not self.header:
            return f"This server can't read the page's Origin “{origin}”."
        return f"This server saw {self.header} “{value}”, but the page comes from “{origin}”."


def mismatch(headers: Headers, secure: bool, further: Collection[Origin]) -> Mismatch | None:
    """What is wrong with the Origin that a request has, if anything.

    Own pages, those of `further` origins, frames without an origin ('null') and programs may come. `secure` says that
    the request came over TLS. Where it didn't as far as the server knows, a proxy may have ended TLS all the same, and
    the page says what it was: then the host alone is compared, with its port.
    """
    text = headers.get("origin")
    if text is None or text == "null":
        return None
    try:
        page = parse(text)
    except ValueError:
        return Mismatch(text)
    if page in further:
        return None
    host, forwarded = headers.get("host", ""), headers.get("x-forwarded-host", "").split(",")[0].strip()
    if not _is_at(page, host):
        name = "X-Forwarded-Host" if forwarded and host == forwarded else "Host"
        return Mismatch(text, name, host, BELIEVE if _is_at(page, forwarded) else HAND_ON.format(name))
    if secure and page.scheme == "http":
        return Mismatch(text, "X-Forwarded-Proto", "https", HAND_ON.format("X-Forwarded-Proto"))
    return None


HAND_ON = "The proxy in front must hand on the browser's own {} (see README), or SIM3_ORIGINS name the page's."
BELIEVE = "Its X-Forwarded-Host would fit, but is believed only where FORWARDED_ALLOW_IPS names the proxy's address."


def _is_at(page: Origin, host: str) -> bool:
    try:
        return at(page.scheme, host) == page
    except ValueError:
        return False


def _clipped(text: str, length: int) -> str:
    """Printable ASCII of at most so many characters."""
    safe = "".join(c if " " <= c <= "~" else "?" for c in text)
    return safe if len(safe) <= length else safe[: length - 3] + "..."
