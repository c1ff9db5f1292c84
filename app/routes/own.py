"""Addresses of this server's own, as others hand them in: whichever proxy and prefix it is reached through."""

from __future__ import annotations

from typing import NamedTuple
from urllib.parse import urlsplit

from fastapi import Request

from app.routes.rendering import base
from app.sockets import origins


class Place(NamedTuple):
    """Where an address of this server's leads."""

    root: str
    """Scheme, host and prefix, with a slash at the end."""
    path: str
    """What follows."""
    query: str


def place_of(request: Request, address: str) -> Place | None:
    """What an address names on this server; None for what is elsewhere or can't be read.

    A proxy may have ended TLS without saying so: then the host is what counts, with the port that its scheme has.
    """
    try:
        parts = urlsplit(address)
        there, here = (origins.parse(f"{parts.scheme}://{host}") for host in (parts.netloc, request.url.netloc))
    except ValueError:
        return None
    prefix = f"{base(request)}/"
    if there != here or not f"{parts.path}/".startswith(prefix):
        return None
    return Place(f"{parts.scheme}://{parts.netloc}{prefix}", parts.path[len(prefix) :], parts.query)
