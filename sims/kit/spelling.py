"""Values as text, and text as values: links, and the words in which they are refused."""

from __future__ import annotations

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
