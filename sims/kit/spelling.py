"""Values as text, and text as values: links, and the words in which they are refused."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from difflib import get_close_matches
from typing import Any

NEAR = 0.7
"""How alike words must be, as difflib has it, for one to be meant by the other."""


def spell(value: Any) -> str:
    """A value as it stands in a link."""
    if isinstance(value, bool):
        return "1" if value else "0"
    if isinstance(value, tuple):
        return ",".join(spell(v) for v in value)
    return str(value) if isinstance(value, str) else plain(value)


def plain(value: float) -> str:
    """Shortest decimal spelling that reads back as the same number: 30, 0.5, -1e-09."""
    value = float(value) + 0.0
    return str(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)


def number_text(text: str) -> str:
    """A number's text with the minus sign that programs write, where it has the one that books and we do (U+2212)."""
    return text.replace("−", "-")


NUMBER = r"(?:\d+(?:[.,]\d*)?|[.,]\d+)(?:e[+-]?\d+)?"
TYPED = re.compile(
    rf"(?P<sign>[+-]?)(?P<times>{NUMBER})?[*·]?(?P<pi>pi|π)?(?:/(?P<by>{NUMBER}))?(?P<unit>°|deg|rad|mm|cm|m|km|px|%)?",
    re.IGNORECASE | re.ASCII,
)
IN_METRES = {"mm": 0.001, "cm": 0.01, "m": 1.0, "km": 1000.0}


def typed(text: str, unit: str = "") -> float:
    """The number that a person means who types into a box of that unit. Raises ValueError.

    47.5, 45,5, −0.6, 1e2, 3/4, π/3 (which in a box of degrees is 60), 90°, 1.2 rad, 30 cm.
    """
    found = TYPED.fullmatch(re.sub(r"\s", "", number_text(text)))
    if found is None or not (found["times"] or found["pi"]):
        raise ValueError(text)
    value = _decimal(found["times"] or "1") * (math.pi if found["pi"] else 1.0)
    value = -value if found["sign"] == "-" else value
    if found["by"]:
        value /= _decimal(found["by"]) or math.nan
    given = (found["unit"] or ("rad" if found["pi"] and unit == "°" else unit)).lower()
    if unit == "°" and given in ("°", "deg", "rad"):
        value = math.degrees(value) if given == "rad" else value
        value = round(value, 12)
    elif unit in IN_METRES and given in IN_METRES:
        value = round(value * IN_METRES[given] / IN_METRES[unit], 12)
    elif given != unit.lower():
        raise ValueError(text)
    if not math.isfinite(value):
        raise ValueError(text)
    return value + 0.0


def typed_row(text: str) -> list[str]:
    """The texts of several numbers that were typed or pasted together, with blanks, commas, semicolons or brackets."""
    inside = text.strip().strip("()[]{}").strip()
    for separator in (r"\s*;\s*", r"\s*,\s+|\s+", r"\s*,\s*"):
        if len(parts := [part for part in re.split(separator, inside) if part]) > 1:
            return parts
    return [inside]


def _decimal(text: str) -> float:
    return float(text.replace(",", "."))


def shown_number(value: float) -> str:
    """A number as a box shows it: exact up to six digits, with a true minus sign."""
    text = f"{value + 0.0:.6g}"
    if "e" in text:
        mantissa, _, power = text.partition("e")
        text = f"{mantissa}e{int(power)}"
    return text.replace("-", "−")


def spans(ranges: Iterable[tuple[float, float]]) -> str:
    """In words: between which numbers each of some values may be."""
    words = dict.fromkeys(f"from {plain(low)} to {plain(high)}" if low <= high else "absent" for low, high in ranges)
    return ", then ".join(words)


def meant(text: str, known: Iterable[str]) -> str:
    """Which of some words a text that is none of them may mean: the same but for its letters' case, or one near."""
    by_case = {word.casefold(): word for word in known}
    near = get_close_matches(clipped(text).strip().casefold(), by_case, 1, NEAR)
    return by_case[near[0]] if near else ""


def clipped(text: Any, length: int = 80) -> str:
    """Text that is safe to show back: shortened."""
    whole = str(text)
    return whole if len(whole) <= length else whole[: length - 1] + "…"
