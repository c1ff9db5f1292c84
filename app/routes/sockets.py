"""The addresses of the websockets: viser's at the page's own, the channel's below it."""

from __future__ import annotations

from fastapi import APIRouter, WebSocket

from app.rooms.keys import is_room, room_of
from app.routes.services import Given, Services
from app.sockets.channel import ChannelSockets
from app.sockets.scene import SceneSockets
from sims import by_slug

router = APIRouter()


@router.websocket("/sims/{slug}/s/{room}/channel")
@router.websocket("/sims/{slug}/s/{room}/{key}/channel")
async def channel(ws: WebSocket, given: Given) -> None:
    await _enter(ws, given, given.bridge.channel)


@router.websocket("/sims/{slug}/s/{room}")
@router.websocket("/sims/{slug}/s/{room}/")
@router.websocket("/sims/{slug}/s/{room}/{key}")
@router.websocket("/sims/{slug}/s/{room}/{key}/")
async def scene(ws: WebSocket, given: Given) -> None:
    await _enter(ws, given, given.bridge.scene)


async def _enter(ws: WebSocket, given: Services, sockets: ChannelSockets | SceneSockets) -> None:
    slug, room, key = (ws.path_params.get(name) for name in ("slug", "room", "key"))
    sim = by_slug(slug or "")
    if sim is None or room is None or not is_room(room) or (key is not None and room_of(key) != room):
        given.bridge.refusals["address"] += 1
        await ws.close(1008)
    else:
        await sockets.serve(ws, sim, room, watching=key is None)
