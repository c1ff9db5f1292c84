"""Files: those that learners upload into their sessions, and those that they take from them."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import Any

from fastapi import APIRouter, HTTPException, Request
from fastapi.responses import JSONResponse, Response
from pydantic import ValidationError

from app import metrics, security
from app.rooms.keys import room_of
from app.rooms.registry import Sessions
from app.rooms.session import Session
from app.routes.coming import BUSY, Refusal
from app.routes.services import Given
from app.trouble import error_message
from geometry import GeometryError
from sims import by_slug

ADDRESS = r"/sims/[a-z-]+/s/[0-9a-f]{20}/[\w-]{1,60}/file$"
"""Address of a POST that uploads a file."""
AT_ONCE = 4
"""Largest files that may be on their way at once."""
KEPT = 10
"""Largest files that all sessions together may keep."""
ANYWHERE = {
    **security.ANYWHERE, "access-control-allow-methods": "POST",
    "access-control-allow-headers": "content-type",
}  # fmt: skip
"""A sandboxed frame has no origin; the key in the address is the secret."""
LATER = 60
"""Seconds after which there may be room for a file."""
GONE = "There is no such session."
router = APIRouter(include_in_schema=False)


async def refused(_: Request, refusal: Exception) -> Response:
    """The answer to a `Refusal`."""
    assert isinstance(refusal, Refusal)
    later = {"retry-after": f"{LATER}"} if refusal.status == 503 else {}
    return JSONResponse({"detail": str(refusal)}, refusal.status, headers={**ANYWHERE, **later})


@router.options("/sims/{slug}/s/{room}/{key}/file")
@router.options("/sims/{slug}/s/{room}/{key}/paste")
async def may(slug: str, room: str, key: str) -> Response:
    return Response(status_code=204, headers=ANYWHERE)


@router.post("/sims/{slug}/s/{room}/{key}/file")
async def upload(request: Request, given: Given, slug: str, room: str, key: str, name: str) -> Response:
    sessions, largest = given.sessions, given.largest
    if (session := _session(sessions, slug, room, key)) is None:
        raise Refusal(404, GONE)
    length = _length(request, largest)
    if sessions.uploaded_bytes() + length > KEPT * largest:
        raise Refusal(503, BUSY)
    async with given.coming.received(request, length) as data:
        known_as, changes = await _read(sessions, session, name[:200], data)
        if await request.is_disconnected() or sessions.find(session.sim, session.room) is not session:
            session.forget(known_as)  # it was given up meanwhile
        else:
            session.upload(known_as, len(data), changes)
            metrics.UPLOADS.inc()
    return JSONResponse({"name": name}, headers=ANYWHERE)


@router.post("/sims/{slug}/s/{room}/{key}/paste")
async def paste(request: Request, given: Given, slug: str, room: str, key: str) -> Response:
    if (session := _session(given.sessions, slug, room, key)) is None:
        raise Refusal(404, GONE)
    if session.sim.paste is None:
        raise Refusal(404, "This sim takes no text.")
    try:
        text = (await request.body()).decode("utf-8-sig")
        loop = asyncio.get_running_loop()
        found = await loop.run_in_executor(given.sessions.aside, session.sim.paste.found, text)
        session.take(found)
    except UnicodeDecodeError:
        raise Refusal(422, "This isn’t text in UTF-8. Nothing has changed.") from None
    except (ValidationError, GeometryError) as error:
        raise Refusal(422, f"{error_message(session.sim, error)['message']}. Nothing has changed.") from None
    except ValueError as error:
        raise Refusal(422, f"{error} Nothing has changed.") from None
    return JSONResponse({"said": session.sim.paste.says(session.params, found)}, headers=ANYWHERE)


@router.get("/sims/{slug}/s/{room}/{key}/result/{name}")
async def download(given: Given, slug: str, room: str, key: str, name: str) -> Response:
    session = _session(given.sessions, slug, room, key)
    make = None if session is None else session.sim.downloads.get(name)
    if session is None or make is None:
        raise HTTPException(404, GONE if session is None else "There is no such file.")
    loop = asyncio.get_running_loop()
    data = await loop.run_in_executor(given.sessions.aside, make, session.params, *session.given)
    headers = {"content-disposition": f'attachment; filename="{name}"', **security.NEVER_KEPT}
    return Response(data, media_type="application/octet-stream", headers=headers)


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
