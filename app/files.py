"""Files: those that learners bring into their sessions, and those that they take from them."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from typing import Any

from fastapi import FastAPI, HTTPException, Request
from fastapi.responses import JSONResponse, Response
from starlette.requests import ClientDisconnect

from app.session import Session, Sessions, room_of
from sims import by_slug

ADDRESS = r"/sims/[a-z-]+/s/[0-9a-f]{20}/[\w-]{1,60}/file$"
"""Of a POST that brings a file."""
AT_ONCE = 4
"""Largest files that may be on their way at once."""
KEPT = 10
"""Largest files that all sessions together may keep."""
ANYWHERE = {
    "access-control-allow-origin": "*", "access-control-allow-methods": "POST",
    "access-control-allow-headers": "content-type",
}  # fmt: skip
"""A sandboxed frame has no origin; the key in the address is the secret."""
STALL = 10.0
"""Seconds without a byte after which a file is given up."""
LATER = 60
"""Seconds after which there may be room for a file."""
BUSY = "The server has as many files as it can hold; try again later."
GONE = "There is no such session."


class Refusal(Exception):
    """What is said, and the status it is said with."""

    def __init__(self, status: int, words: str) -> None:
        super().__init__(words)
        self.status = status


def add_files(app: FastAPI, sessions: Sessions, largest: int) -> None:
    """The addresses of files; `largest` is how many bytes one may have."""
    coming = Coming(AT_ONCE * largest)

    @app.exception_handler(Refusal)
    async def refused(request: Request, refusal: Refusal) -> Response:
        later = {"retry-after": f"{LATER}"} if refusal.status == 503 else {}
        return JSONResponse({"detail": str(refusal)}, refusal.status, headers={**ANYWHERE, **later})

    @app.options("/sims/{slug}/s/{room}/{key}/file", include_in_schema=False)
    async def may(slug: str, room: str, key: str) -> Response:
        return Response(status_code=204, headers=ANYWHERE)

    @app.post("/sims/{slug}/s/{room}/{key}/file", include_in_schema=False)
    async def bring(request: Request, slug: str, room: str, key: str, name: str) -> Response:
        if (session := _session(sessions, slug, room, key)) is None:
            raise Refusal(404, GONE)
        length = _length(request, largest)
        if sessions.uploaded_bytes() + length > KEPT * largest:
            raise Refusal(503, BUSY)
        async with coming.received(request, length) as data:
            known_as, changes = await _read(sessions, session, name[:200], data)
            if await request.is_disconnected() or sessions.find(session.sim, session.room) is not session:
                session.forget(known_as)
            else:
                session.upload(known_as, len(data), changes)
        return JSONResponse({"name": name}, headers=ANYWHERE)

    @app.get("/sims/{slug}/s/{room}/{key}/result/{name}", include_in_schema=False)
    async def take(slug: str, room: str, key: str, name: str) -> Response:
        session = _session(sessions, slug, room, key)
        make = None if session is None else session.sim.downloads.get(name)
        if session is None or make is None:
            raise HTTPException(404, GONE if session is None else "There is no such file.")
        data = await asyncio.get_running_loop().run_in_executor(sessions.aside, make, session.params, *session.given)
        headers = {"content-disposition": f'attachment; filename="{name}"', "cache-control": "no-store"}
        return Response(data, media_type="application/octet-stream", headers=headers)


class Coming:
    """The files that come and are read just now. Only what has come takes room: a slow page holds up nobody."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._bytes = 0

    @asynccontextmanager
    async def received(self, request: Request, length: int) -> AsyncIterator[bytes]:
        """The body of a request, which takes room as long as it is needed. Raises `Refusal`."""
        data = bytearray()
        chunks = request.stream()
        try:
            while chunk := await asyncio.wait_for(anext(chunks, b""), STALL):
                data += chunk
                self._bytes += len(chunk)
                if self._bytes > self._most:
                    raise Refusal(503, BUSY)
            if len(data) != length:
                raise Refusal(400, "The file broke off on its way.")
            yield bytes(data)
        except (TimeoutError, ClientDisconnect):
            raise Refusal(400, "The file broke off on its way.") from None
        finally:
            self._bytes -= len(data)


def _session(sessions: Sessions, slug: str, room: str, key: str) -> Session | None:
    sim = by_slug(slug)
    return None if sim is None or room_of(key) != room else sessions.find(sim, room)


def _length(request: Request, largest: int) -> int:
    try:
        length = int(request.headers["content-length"])
    except (KeyError, ValueError):
        raise Refusal(411, "The length of the file must be told.") from None
    if not 0 <= length <= largest:
        raise Refusal(413, f"It is {length / 1e6:,.1f} MB; at most {largest / 1e6:,.0f} MB are taken.")
    return length


async def _read(sessions: Sessions, session: Session, name: str, data: bytes) -> tuple[str, Mapping[str, Any]]:
    if session.library is None:
        raise Refusal(404, "This sim takes no files.")
    loop = asyncio.get_running_loop()
    try:
        return await loop.run_in_executor(sessions.aside, session.library.add, name, data)
    except ValueError as error:
        raise Refusal(422, str(error)) from None
