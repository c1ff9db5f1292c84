"""What proxies in front do to a request, undone: everything behind sees it as the browser sent it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from starlette.requests import HTTPConnection
from starlette.types import ASGIApp, Receive, Scope, Send
from uvicorn.middleware.proxy_headers import ProxyHeadersMiddleware


def address_of(connection: HTTPConnection) -> str:
    """The address of who asks, as far as trusted proxies tell; empty where there is none."""
    return connection.client.host if connection.client else ""


class Forwarded(ProxyHeadersMiddleware):
    """Believes the X-Forwarded-Host of a trusted proxy, as uvicorn does its X-Forwarded-Proto and -For.

    Of several hosts, each proxy's own, the first is the one that the browser asked for.
    """

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        client = scope.get("client")
        if scope["type"] != "lifespan" and (client[0] if client else None) in self.trusted_hosts:
            told = [value for name, value in scope["headers"] if name == b"x-forwarded-host"]
            if told and (host := told[0].split(b",")[0].strip()):
                rest = [(name, value) for name, value in scope["headers"] if name != b"host"]
                scope = {**scope, "headers": [(b"host", host), *rest]}
        await super().__call__(scope, receive, send)


class Prefix:
    """Puts the prefix before every path, whether or not the proxy took it away: as ASGI has it, the path is whole.

    The prefix is a setting, and not taken from X-Forwarded-Prefix: not every proxy says it, and which one a page is
    asked through shouldn't decide where its links lead. A path that goes on after the prefix with what one of the
    application's own addresses begins with has it already; so the prefix may be called like one of these, as in /sims.
    """

    def __init__(self, app: ASGIApp, prefix: str, addresses: Iterable[str]) -> None:
        self._app = app
        self._prefix = prefix
        self._own = {address.split("/")[1] for address in addresses}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "lifespan" and self._prefix:
            scope = {**scope, "root_path": self._prefix}
            if not self._is_whole(scope["path"]):
                scope["path"] = self._prefix + scope["path"]
                scope["raw_path"] = self._prefix.encode() + (scope.get("raw_path") or b"")
            elif scope["path"] == self._prefix:
                scope["path"] += "/"
        await self._app(scope, receive, send)

    def _is_whole(self, path: str) -> bool:
        rest = path.removeprefix(self._prefix)
        return rest != path and (not rest or (rest[0] == "/" and rest.split("/")[1] in self._own))
