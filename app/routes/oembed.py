"""oEmbed 1.0: what a page editor asks when somebody pastes a link of this server's (https://oembed.com)."""

from __future__ import annotations

import re
from typing import Any
from urllib.parse import parse_qsl

from fastapi import APIRouter, Request
from fastapi.responses import JSONResponse, Response

from app.routes import links
from app.routes.own import Place, place_of
from app.routes.rendering import fingerprint
from app.routes.services import Given, Services
from app.routes.snippets import HEIGHT, iframe
from app.security import ANYWHERE
from sims import by_slug
from sims.kit.refusals import BadParams
from sims.kit.sim import Sim

router = APIRouter(include_in_schema=False)
WIDTH = 800
PICTURE = (800, 600)
"""Pixels of a sim's still picture."""
A_DAY = 86400
HEADERS = {**ANYWHERE, "cache-control": f"public, max-age={A_DAY}"}
SHOWN = re.compile(r"sims/(?P<slug>[a-z-]+)(/embed)?/?|lessons/(?P<name>[a-z0-9-]+)/?")
"""What can be shown by its address: never a room, whose link may share control of it."""


class Refused(Exception):
    """What isn't answered: the status that the standard gives it, and why, in words."""

    def __init__(self, status: int, words: str) -> None:
        self.status = status
        super().__init__(words)


@router.api_route("/oembed", methods=["GET", "HEAD"])
async def oembed(request: Request, given: Given) -> Response:
    try:
        return JSONResponse(_answer(request, given), headers=HEADERS)
    except Refused as refused:
        return JSONResponse({"detail": str(refused)}, refused.status, ANYWHERE)


def _answer(request: Request, given: Services) -> dict[str, Any]:
    asked = request.query_params
    if asked.get("format", "json") != "json":
        raise Refused(501, "The answer is there as json only.")
    place = place_of(request, asked.get("url", ""))
    if place is None:
        raise Refused(404, "The url is no address of this server.")
    sim, title = _shown(place, given)
    width, height = _bound(asked.get("maxwidth"), WIDTH), _bound(asked.get("maxheight"), HEIGHT)
    embed = f"{place.root}sims/{sim.slug}/embed{_search(sim, place.query)}"
    answer = {
        "version": "1.0", "type": "rich", "title": title, "provider_name": "Sim3", "provider_url": place.root,
        "cache_age": A_DAY, "width": width, "height": height, "html": iframe(embed, sim.title, width, height),
    }  # fmt: skip
    if width >= PICTURE[0] and height >= PICTURE[1]:  # within the same bounds
        answer |= {
            "thumbnail_url": picture(place.root, sim), "thumbnail_width": PICTURE[0], "thumbnail_height": PICTURE[1],
        }  # fmt: skip
    return answer


def picture(root: str, sim: Sim[Any, Any]) -> str:
    """Whole address of a sim's still picture, as other sites fetch it."""
    name = f"thumbs/{sim.slug}-light.webp"
    return f"{root}static/{name}?v={fingerprint(name)}"


def _shown(place: Place, given: Services) -> tuple[Sim[Any, Any], str]:
    """The sim that an address shows, and what the page there is called."""
    found = SHOWN.fullmatch(place.path)
    lesson = given.lessons.own.get(found["name"] or "") if found else None
    if lesson is not None:
        return lesson.sim, lesson.title
    sim = by_slug(found["slug"] or "") if found else None
    if sim is None:
        raise Refused(404, "No sim or lesson is at this address.")
    return sim, sim.title


def _search(sim: Sim[Any, Any], query: str) -> str:
    items = parse_qsl(query, keep_blank_values=True)
    try:
        links.read(sim, items)
    except BadParams as error:
        raise Refused(404, f"The url names no state of the sim. {error}") from None
    own = links.own(items)
    return f"?{own}" if own else ""


def _bound(text: str | None, usual: int) -> int:
    """At most what the consumer has room for."""
    if text is None:
        return usual
    if not text.isdecimal() or not int(text[:9]):
        raise Refused(400, "maxwidth and maxheight are whole numbers of pixels, from 1.")
    return min(usual, int(text[:9]))
