"""LaTeX to MathML, with live numbers and with symbols that point at what they are in the scene."""

from __future__ import annotations

import re
from collections.abc import Callable

from latex2mathml.converter import convert

from app.lessons.dialect import LIVE

POINT = re.compile(r"\\point\{([^{}]+)\}\{((?:[^{}]|\{[^{}]*\})*)\}")
"""A symbol and what it points at, as in \\point{yaw}{\\psi}."""
_COLOUR = "#5133{:02x}"  # marks what points, for MathML has nothing that LaTeX could say it by
_COLOURED = re.compile(r'<mstyle mathcolor="#5133(..)">')


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
        return rf"{{\color{{{_COLOUR.format(len(names) - 1)}}}{{{found[2]}}}}}"  # in braces: else it goes on to the end

    plain = LIVE.sub(value, POINT.sub(pointed, latex))
    try:
        made = convert(plain, display="block" if block else "inline")
    except Exception as error:  # whatever the converter stumbles over
        raise ValueError(f"{latex!r} ({type(error).__name__})") from None
    if unknown := re.search(r"\\[A-Za-z]+", made):
        raise ValueError(f"{unknown[0]} in {latex!r}")
    made = re.sub(r"<mtext>@(\d+)@</mtext>", lambda found: live(values[int(found[1])]), made)
    return _COLOURED.sub(lambda found: f'<mstyle data-point="{names[int(found[1], 16)]}">', made)


def points(latex: str) -> list[str]:
    """Names of all that a formula points at."""
    return [name for name, _ in POINT.findall(latex)]
