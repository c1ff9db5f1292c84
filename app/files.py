"""Files: those that learners bring into their sessions, and those that they take from them."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from fastapi import FastAPI, HTTPException, Request
from fastapi.responses import JSONResponse, Response

from app.session import Session, Sessions, room_of
from sims import by_slug

ADDRESS = r"/sims/[a-z-]+/s/[0-9a-f]{20}/[\w-]{1,60}/file$"
"""Of a POST that brings a file."""
AT_ONCE = 4
"""Largest files that may be on their way at once."""
KEPT = 10
"""Largest files that all sessions together may keep."""
ANYWHERE = {"access-control-allow-origin": "*", "access-control-allow-methods": "POST"}
"""A sandboxed frame has no origin; the key in the address is the secret."""
BUSY = "The server has as many files as it can hold; try again later."


def add_files(app: FastAPI, sessions: Sessions, largest: int) -> None:
    """The addresses of files; `largest` is how many bytes one may have."""
    coming = Coming(AT_ONCE * largest)

    @app.options("/sims/{slug}/s/{room}/{key}/file", include_in_schema=False)
    async def may(slug: str, room: str, key: str) -> Response:
        return Response(status_code=204, headers=ANYWHERE)

    @app.post("/sims/{slug}/s/{room}/{key}/file", include_in_schema=False)
    async def bring(request: Request, slug: str, room: str, key: str, name: str) -> Response:
        session = _session(sessions, slug, room, key)
        length = _length(request, largest)
        if sessions.kept_bytes() + length > KEPT * largest:
            return _refused(503, BUSY)
        with coming.room_for(length) as fits:
            if not fits:
                return _refused(503, BUSY)
            data = await _received(request, length)
            if data is None:
                return _refused(400, "The file broke off on its way.")
            return await _read(sessions, session, name[:200], data, largest)

    @app.get("/sims/{slug}/s/{room}/{key}/result/{name}", include_in_schema=False)
    async def take(slug: str, room: str, key: str, name: str) -> Response:
        session = _session(sessions, slug, room, key)
        make = session.sim.downloads.get(name)
        if make is None:
            raise HTTPException(404, "There is no such file.")
        data = await asyncio.get_running_loop().run_in_executor(sessions.reading, make, session.params)
        headers = {"content-disposition": f'attachment; filename="{name}"', "cache-control": "no-store"}
        return Response(data, media_type="application/octet-stream", headers=headers)


class Coming:
    """How many bytes of files are on their way."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._bytes = 0

    @contextmanager
    def room_for(self, length: int) -> Iterator[bool]:
        """Whether that many more fit, and room for them as long as they are on their way."""
        if self._bytes + length > self._most:
            yield False
            return
        self._bytes += length
        try:
            yield True
        finally:
            self._bytes -= length


def _session(sessions: Sessions, slug: str, room: str, key: str) -> Session:
    sim = by_slug(slug)
    session = None if sim is None or room_of(key) != room else sessions.find(sim, room)
    if session is None:
        raise HTTPException(404, "There is no such session.")
    return session


def _length(request: Request, largest: int) -> int:
    try:
        length = int(request.headers["content-length"])
    except (KeyError, ValueError):
        raise HTTPException(411, "The length of the file must be told.") from None
    if not 0 <= length <= largest:
        raise HTTPException(413, f"It is {length / 1e6:,.1f} MB; at most {largest / 1e6:,.0f} MB are taken.")
    return length


async def _received(request: Request, length: int) -> bytes | None:
    data = bytearray()
    async for chunk in request.stream():
        data += chunk
        if len(data) > length:
            return None
    return bytes(data) if len(data) == length else None


async def _read(sessions: Sessions, session: Session, name: str, data: bytes, largest: int) -> Response:
    files = session.sim.files
    if files is None:
        return _refused(404, "This sim takes no files.")
    loop = asyncio.get_running_loop()
    try:
        kept, changes = await loop.run_in_executor(sessions.reading, files.read, name, data, largest)
    except ValueError as error:
        return _refused(422, str(error))
    session.keep(kept, len(data), changes)
    return JSONResponse({"name": name}, headers=ANYWHERE)


def _refused(status: int, words: str) -> Response:
    told: dict[str, Any] = {"detail": words}
    return JSONResponse(told, status, headers=ANYWHERE)
