"""LaTeX to MathML, with live numbers and with symbols that point at what they are in the scene."""

from __future__ import annotations

import re
from collections.abc import Callable
from html import escape, unescape
from xml.etree.ElementTree import Element, tostring

from latex2mathml.converter import convert_to_element

from app.lessons.dialect import LIVE

POINT = re.compile(r"\\point\{([^{}]+)\}\{((?:[^{}]|\{[^{}]*\})*)\}")
"""A symbol and what it points at, as in \\point{yaw}{\\psi}."""
MATRIX = re.compile(r"\\(begin|end)\{[pb]matrix\}")
"""Brackets are drawn as borders, as in the column of a sim: few machines have a font whose brackets stretch."""
NOT_MATHEMATICS = frozenset({"class", "href", "id", "style"})
"""Attributes that LaTeX commands could give, and that would do something to the page."""
ENTRIES = {"mfrac": 2, "msub": 2, "msup": 2, "munder": 2, "mover": 2, "mroot": 2, "msubsup": 3, "munderover": 3}
"""How many parts an element of MathML must have."""
_COLOUR = "#5133{:02x}"  # marks what points, for MathML has nothing that LaTeX could say it by
_COLOURED = re.compile(r'<mstyle mathcolor="#5133(..)">')
_MOST = 256


def mathml(latex: str, *, block: bool, live: Callable[[str], str]) -> str:
    """A formula in MathML; `live` makes the element of {value:…}. Raises ValueError in words."""
    values: list[str] = []
    names: list[str] = []

    def value(found: re.Match[str]) -> str:
        if found[1] != "value":
            raise ValueError(f"{found[0]} in a formula; there are only {{value:…}} in formulas")
        values.append(found[2])
        return rf"\text{{@{len(values) - 1}@}}"

    def pointed(found: re.Match[str]) -> str:
        names.append(found[1])
        return rf"{{\color{{{_COLOUR.format(len(names) - 1)}}}{{{found[2]}}}}}"  # without braces, all that follows

    plain = MATRIX.sub(r"\\\1{matrix}", LIVE.sub(value, POINT.sub(pointed, latex)))
    made = _converted(plain, latex, block=block)
    if unknown := re.search(r"\\[A-Za-z]+", made):
        raise ValueError(f"{unknown[0]} in {latex!r}")
    if len(names) > _MOST:
        raise ValueError(f"{len(names)} symbols that point in one formula")
    if MATRIX.search(latex):
        made = made.replace("<mtable>", '<mtable class="matrix">')
    made = re.sub(r"<mtext>@(\d+)@</mtext>", lambda found: live(values[int(found[1])]), made)
    return _COLOURED.sub(lambda found: f'<mstyle data-point="{escape(names[int(found[1], 16)])}">', made)


def _converted(plain: str, latex: str, *, block: bool) -> str:
    """MathML in which all that is text is escaped: the converter's own words for that would let markup through."""
    try:
        tree = convert_to_element(plain, display="block" if block else "inline")
    except Exception as error:  # whatever the converter stumbles over
        raise ValueError(f"{latex[:200]!r} ({type(error).__name__})") from None
    for element in tree.iter():
        _clean(element, latex)
    return tostring(tree, encoding="unicode")


def _clean(element: Element, latex: str) -> None:
    if wrong := NOT_MATHEMATICS & element.attrib.keys():
        raise ValueError(f"{min(wrong)} in {latex!r}")
    if len(element) != ENTRIES.get(element.tag, len(element)):
        raise ValueError(f"{len(element)} of {ENTRIES[element.tag]} parts of a fraction, index or power in {latex!r}")
    element.text = unescape(element.text or "")
    for name, value in element.attrib.items():
        element.set(name, unescape(value))


def points(latex: str) -> list[str]:
    """Names of all that a formula points at."""
    return [name for name, _ in POINT.findall(latex)]
