"""Makes pages from templates."""

from __future__ import annotations

import functools
import gzip
import hashlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

import zstandard
from fastapi import HTTPException, Request
from fastapi.responses import Response, StreamingResponse
from starlette.templating import Jinja2Templates

from app import scripts
from app.security import NEVER_KEPT
from app.settings import ROOT
from sims import SIMS, by_slug
from sims.kit import viser_client
from sims.kit.challenge import told
from sims.kit.palette import DARK
from sims.kit.paste import LONGEST
from sims.kit.scene.view import FIELD
from sims.kit.sim import Sim
from sims.kit.view import View

AnySim = Sim[Any, Any]

templates = Jinja2Templates(ROOT / "app" / "templates")


def base(request: Request) -> str:
    """The path prefix under which the application is reached."""
    return str(request.scope.get("root_path", "")).rstrip("/")


@functools.cache
def fingerprint(name: str) -> str:
    """A short hash of a static file, so that browsers may keep it for ever; empty while there is no such file."""
    path = ROOT / "static" / name
    return hashlib.sha256(path.read_bytes()).hexdigest()[:10] if path.is_file() else ""


def static(request: Request, name: str) -> str:
    """Address of a static file."""
    return f"{base(request)}/static/{name}?v={fingerprint(name)}"


@functools.cache
def modules(folder: str = "viewer") -> dict[str, bytes]:
    """The scripts of a page by their names, of a sim's or a lesson's: those that begin, and what these import."""
    return {path.name: path.read_bytes() for path in sorted((ROOT / "static" / folder).glob("*.js"))}


@functools.cache
def modules_fingerprint(folder: str = "viewer") -> str:
    """Changes when any of them does; it stands in their addresses, so that what they import is as new as they are."""
    return hashlib.sha256(b"".join(modules(folder).values())).hexdigest()[:10]


def module(request: Request, name: str, folder: str = "viewer") -> str:
    """Address of such a script."""
    return f"{base(request)}/{folder}/{modules_fingerprint(folder)}/{name}"


def render(request: Request, template: str, status: int = 200, **context: Any) -> Response:
    """An HTML page from a template."""
    return templates.TemplateResponse(request, template, _shared(request, status) | context, status_code=status)


def in_parts(request: Request, template: str, **context: Any) -> Response:
    """The same, sent section by section: what stands in the first can be read while the last is still made."""
    context = {"request": request, **_shared(request, 200), **context}
    return StreamingResponse(by_section(templates.get_template(template).generate(context)), media_type="text/html")


def by_section(pieces: Iterable[str]) -> Iterator[str]:
    """Pieces of a page put together up to the end of each section."""
    part: list[str] = []
    for piece in pieces:
        part.append(piece)
        if "</section>" in piece:
            yield "".join(part)
            part.clear()
    yield "".join(part)


def _shared(request: Request, status: int) -> dict[str, Any]:
    """What every template may use."""
    return {
        "base": base(request),
        "static": functools.partial(static, request),
        "module": functools.partial(module, request),
        "sims": SIMS,
        "status": status,
    }


def viewer(
    request: Request, sim: AnySim, column: str, view: View, options: dict[str, str], largest: int,
    steps: Sequence[Mapping[str, Any]], room: str, key: str = "",
) -> Response:  # fmt: skip
    """The page of a session in a state: viser's scene beside a column of ours. Without its key it only watches.

    The page alone holds the key: its address bar shows where anybody gets a room of their own in the same state.
    """
    place = f"{base(request)}/sims/{sim.slug}"
    path = f"{place}/s/{room}/{key}/" if key else f"{place}/s/{room}/"
    client = f"{base(request)}/viser/{viser_client.fingerprint()}"
    data = {
        "slug": sim.slug, "title": sim.title, "watching": not key,
        "text": f"{place}/text", "path": path, "address": f"{place}/embed" if key else path,
        "view": [*view.position, *view.look_at], "radius": view.radius, "field": FIELD,
        "under": sim.under is not None,
        "code": f"{place}/code" if scripts.script(sim, "numpy") else "",
        "files": None if sim.files is None else {"largest": largest},
        "steps": steps,
        "challenges": told(sim.challenges),
        "paste": None if sim.paste is None else {"longest": LONGEST},
        "label": {"ink": DARK.ink, "plate": DARK.page},
        "share": static(request, "share.js"), "main": module(request, "main.js"), "client": f"{client}/loader.js",
        "still": {theme: static(request, f"thumbs/{sim.slug}-{theme}.webp") for theme in ("light", "dark")},
    }  # fmt: skip
    response = render(
        request, "viewer.html", sim=sim, data=data, client=client, modules=modules(), text=f"{place}/text",
        column=column, bare=options.get("controls") == "0",
    )  # fmt: skip
    response.headers.update(NEVER_KEPT)
    return response


COMPRESSIONS: dict[str, Callable[[bytes], bytes]] = {
    "zstd": zstandard.ZstdCompressor(level=12).compress, "gzip": functools.partial(gzip.compress, compresslevel=9),
}  # fmt: skip
"""For files that never change, the best first; browsers take zstd over TLS.

Of viser's client it leaves 652 kB where gzip leaves 763, in 0.16 s, for which all rooms wait once; level 19 would leave
613, and take over a second.
"""


@functools.cache
def compressed(data: bytes, coding: str) -> bytes:
    """Such a file, compressed once."""
    return COMPRESSIONS[coding](data)


def sim_or_404(slug: str) -> AnySim:
    """The sim of an address."""
    sim = by_slug(slug)
    if sim is None:
        raise HTTPException(404, f"There is no sim named {slug[:60]!r}.")
    return sim
