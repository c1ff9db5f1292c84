"""What a person means by what was typed into a control, or chosen."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeVar

from sims.kit import fields
from sims.kit.controls import key
from sims.kit.offers import Offers
from sims.kit.spelling import clipped, shown_number, typed, typed_row

T = TypeVar("T")


class NotMeant(ValueError):
    """What was entered can't be taken: in words for whoever did."""


def entered(offers: Offers[Any], name: str, text: str) -> dict[str, Any]:
    """The changes of the state that an input's text means. Raises NotMeant; LookupError for no such input."""
    field, _, part = name.partition(".")
    field, _, preset = field.partition(":")
    kind = offers.params.kinds[field]
    if kind.hidden:
        raise KeyError(name)
    if preset:
        return {field: kind.presets[text]} if isinstance(kind, fields.Vector) and kind.presets and text else {}
    match kind:
        case fields.Switch() if not part:
            return {name: {"1": True, "0": False}[text]}
        case fields.Letters():
            _of(offers.entries(field), part)
            if text not in kind.labels:
                raise KeyError(text)
            return {name: text}
        case fields.Vector() | fields.Numbers():
            ranges = offers.params.ranges(field)
            if part:
                return {name: number(text, _of(ranges, part), kind.unit)}
            return {field: row(text, ranges, kind.unit)}
        case fields.Slider() | fields.NumberBox() if not part:
            absent = type(offers.params).model_fields[field].default is None
            if absent and text.strip().lower() in ("", "none", "–", "-", "−"):
                return {name: None}
            found = number(text, offers.bounds(field), kind.unit, whole=kind.whole)
            return {name: int(found) if kind.whole else found}
    known = {key(value): value for value in offers.options(name)}
    return {name: known[text]}


def _of(entries: Sequence[T], part: str) -> T:
    """The entry of a number in a name. Raises LookupError."""
    if not (part.isascii() and part.isdigit()):
        raise KeyError(part)
    return entries[int(part)]


def row(text: str, ranges: Sequence[tuple[float, float]], unit: str) -> tuple[float, ...]:
    """As many numbers as there are ranges, from one text. Raises NotMeant."""
    texts = typed_row(text)
    if len(texts) != len(ranges):
        raise NotMeant(f"Here go {len(ranges)} numbers; these are {len(texts)}.")
    return tuple(number(each, bounds, unit) for each, bounds in zip(texts, ranges, strict=True))


def number(text: str, bounds: tuple[float, float], unit: str, *, whole: bool = False) -> float:
    """A number within bounds, from what was typed. Raises NotMeant."""
    low, high = (shown_number(bound) for bound in bounds)
    gap = "" if unit in ("", "°") else " "
    what = f"a {'whole ' if whole else ''}number from {low} to {high}{gap}{unit}"
    try:
        value = typed(text, unit)
    except (ValueError, OverflowError, ZeroDivisionError):
        raise NotMeant(f"This needs {what}; “{clipped(text, 30)}” isn’t one.") from None
    if not bounds[0] <= value <= bounds[1] or (whole and value != int(value)):
        raise NotMeant(f"This needs {what}; {shown_number(value)} isn’t.")
    return value
