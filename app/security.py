"""Security headers on every answer."""

from __future__ import annotations

import re

from starlette.datastructures import MutableHeaders
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from sims.kit.paste import LONGEST

ANYWHERE = {"access-control-allow-origin": "*"}
"""For what pages of any site may read, and frames that are sandboxed into an origin of their own."""
NEVER_KEPT = {"cache-control": "no-store"}


class Headers:
    """Adds a content security policy (nothing from other hosts) and its companions."""

    def __init__(self, app: ASGIApp, frame_ancestors: str) -> None:
        self._app = app
        # viser's client is one page with inline scripts and styles that unpack a worker and WebAssembly.
        self._policy = "; ".join(
            [
                "default-src 'self'",
                "script-src 'self' 'unsafe-inline' 'unsafe-eval' 'wasm-unsafe-eval' blob: data:",
                "worker-src 'self' blob: data:",
                "style-src 'self' 'unsafe-inline'",
                "img-src 'self' data: blob:",
                "font-src 'self' data:",
                "connect-src 'self' ws: wss: data: blob:",
                "object-src 'none'",
                "base-uri 'none'",
                "form-action 'self'",
                # "*" would leave out frames within a sandboxed one: those around them have no origin.
                *([] if frame_ancestors == "*" else [f"frame-ancestors {frame_ancestors}"]),
            ]
        )

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return

        async def sender(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                headers.setdefault("content-security-policy", self._policy)
                headers.setdefault("x-content-type-options", "nosniff")
                headers.setdefault("referrer-policy", "no-referrer")
                headers.setdefault("cross-origin-resource-policy", "cross-origin")
                headers.setdefault("permissions-policy", "camera=(), microphone=(), geolocation=()")
            await send(message)

        await self._app(scope, receive, sender)


LARGEST_BODY = LONGEST
"""That of a text of somebody's own; no parameters have more."""


class SmallBodies:
    """Refuses a request whose body is larger than any parameters are, without reading it all.

    But for the addresses that match `files`, which take files and see for themselves how large these are.
    """

    def __init__(self, app: ASGIApp, files: str) -> None:
        self._app = app
        self._files = re.compile(files)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http" or self._files.search(scope["path"]):
            await self._app(scope, receive, send)
            return
        received = 0

        async def receiver() -> Message:
            nonlocal received
            message = await receive()
            received += len(message.get("body", b"")) if message["type"] == "http.request" else 0
            if received > LARGEST_BODY:
                words = f"The body may have {LARGEST_BODY} bytes."
                raise HTTPException(413, words, {"connection": "close"})  # else the rest is read, for nothing
            return message

        await self._app(scope, receiver, send)
