"""Links as pictures that a phone's camera reads: dark on light, whatever the theme."""

from __future__ import annotations

import io
from functools import lru_cache

import segno

COLOURS = {"dark": "#000", "light": "#fff", "omitsize": True}


@lru_cache(maxsize=64)
def inline(link: str) -> str:
    """For a page: as large as its place there."""
    return str(segno.make(link, error="m", micro=False).svg_inline(**COLOURS))


def svg(link: str) -> bytes:
    """By itself."""
    drawn = io.BytesIO()
    code = segno.make(link, error="l", micro=False, boost_error=True)
    code.save(drawn, kind="svg", border=4, title="QR code of the link", **COLOURS)
    return drawn.getvalue()
