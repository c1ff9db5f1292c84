"""The state of a sim: one frozen pydantic model, and its two spellings (query string and JSON).

A field is declared with `number`, `optional`, `choice`, `switch`, `vector`, `numbers`, `letters` or `text`; what is
said there feeds the live controls, the link, the JSON schema, validation and the tests.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from functools import lru_cache
from typing import Any, Literal, Self, cast, get_args
from urllib.parse import urlencode

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator
from pydantic.fields import FieldInfo
from pydantic_core import PydanticCustomError

LONGEST_VALUE = 400
"""Characters of one value in a query; a longer one is refused unread."""
MOST_COMPLAINTS = 20


class Params(BaseModel):
    """The whole state of a sim. Frozen; `changed` makes the next state."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", allow_inf_nan=False, validate_default=True, validate_by_name=True
    )

    def form(self) -> tuple[Any, ...]:
        """All that labels, bounds and marks may depend on: everything but the plain numbers."""
        return tuple([value for value in self.__dict__.values() if type(value) is not float])

    def bounds(self, name: str) -> tuple[float, float]:
        """Least and greatest value of a numeric field in this state; override where they depend on its `form`."""
        return _declared_bounds(type(self), name)

    def label(self, name: str) -> str:
        """Words beside the control of a field in this state."""
        return _declared_title(type(self), name)

    def entry_label(self, name: str, k: int) -> str:
        """Words beside the control of the k-th entry, from 0, of a list."""
        return str(extra(type(self).model_fields[name])["entry"]).format(k + 1)

    def entries(self, name: str) -> Any:
        """The entries of a list that have a control each in this state."""
        return getattr(self, name)

    def increment(self, name: str) -> float:
        """By how much a step of a slider changes a number in this state."""
        return float(extra(type(self).model_fields[name])["step"])

    def options(self, name: str) -> Mapping[Any, str]:
        """What the dropdown of a choice or an optional number offers in this state: each value, and how it is shown."""
        return _declared_options(type(self), name, self.bounds(name) if name in numeric_fields(type(self)) else None)

    def regions(self) -> dict[str, list[tuple[float, float]]]:
        """Spans of a slider's values that deserve a mark on its track in this state."""
        return {}

    def changed(self, changes: Mapping[str, Any]) -> Self:
        """The state with some fields replaced, validated; raises pydantic's ValidationError."""
        return type(self).model_validate({**self.__dict__, **changes})

    def moved(self, changes: Mapping[str, Any]) -> Self:
        """The state after a live control moved: numbers are kept within their bounds.

        `angles.2` is the entry of `angles` after the first two: a control of one entry leaves the others alone.
        """
        changes = self._whole(changes)
        if len(changes) == 1 and (fast := self._number_moved(*next(iter(changes.items())))):
            return fast
        state = self.model_copy(update=dict(changes))
        clamped = {name: state._clamped(name) for name in numeric_fields(type(self))}
        return self.changed({**changes, **clamped})

    def _number_moved(self, name: str, value: Any) -> Self | None:
        """The same for one plain number, which within its bounds is always valid."""
        if type(value) is not float or type(self.__dict__.get(name)) is not float or not math.isfinite(value):
            return None
        low, high = self.bounds(name)
        return self.model_copy(update={name: min(max(value, low), high)})

    def _whole(self, changes: Mapping[str, Any]) -> dict[str, Any]:
        whole: dict[str, Any] = {}
        for name, value in changes.items():
            field, _, k = name.partition(".")
            if not k:
                whole[name] = value
            elif int(k) < len(entries := whole.get(field, self.entries(field))):  # else it was taken away meanwhile
                put = value if isinstance(entries, str) else (value,)
                whole[field] = entries[: int(k)] + put + entries[int(k) + 1 :]
        return whole

    def _clamped(self, name: str) -> Any:
        value = getattr(self, name)
        if value is None:
            return None
        if isinstance(value, tuple):
            return tuple(
                min(max(v, low), high) for v, (low, high) in zip(value, self._ranges(name, value), strict=False)
            )
        low, high = self.bounds(name)
        return min(max(value, low), high)

    def _ranges(self, name: str, value: tuple[float, ...]) -> Sequence[tuple[float, float]]:
        return _declared_ranges(type(self), name) or (self.bounds(name),) * len(value)

    @model_validator(mode="after")
    def _within_bounds(self) -> Self:
        for name in numeric_fields(type(self)):
            value = getattr(self, name)
            entries = value if isinstance(value, tuple) else () if value is None else (value,)
            ranges = self._ranges(name, entries)
            if not all(low <= v <= high for v, (low, high) in zip(entries, ranges, strict=False)):
                raise refusal([name], f"{name} must be {_spans(ranges)}, got {spell(value)}")
        return self

    def query(self) -> str:
        """The query string of this state, with default values left out."""
        return urlencode(self.query_items(), safe=",-.:")

    def query_items(self) -> dict[str, str]:
        """Name and spelling of every field that isn't at its default."""
        return {
            name: spell(value)
            for name, field in type(self).model_fields.items()
            if (value := getattr(self, name)) != field.default and value is not None
        }

    @classmethod
    def from_query(cls, items: Iterable[tuple[str, str]]) -> Self:
        """The state that a link names; raises `BadParams` with every complaint."""
        given, complaints = dict[str, str](), list[Complaint]()
        for name, texts in cls._by_name(items).items():
            if name not in cls.model_fields:
                known = "one of: " + ", ".join(cls.model_fields)
                complaints.append(Complaint(name[:60], clipped(texts[0]), known, meant(name, cls.model_fields)))
            elif len(texts) > 1:
                complaints.append(Complaint(name, clipped(" and ".join(texts)), "one value"))
            elif len(texts[0]) > LONGEST_VALUE:
                complaints.append(Complaint(name, clipped(texts[0]), f"at most {LONGEST_VALUE} characters"))
            else:
                given[name] = texts[0]
        state, wrong = cls._validated({name: unspell(cls.model_fields[name], text) for name, text in given.items()})
        complaints += [cls._complaint(name, given.get(name, ""), allowed) for name, allowed in wrong.items()]
        if complaints or state is None:
            while wrong:  # what is left may be wrong without what went
                given = {name: text for name, text in given.items() if name not in wrong}
                _, wrong = cls._validated({n: unspell(cls.model_fields[n], t) for n, t in given.items()})
            raise BadParams(complaints[:MOST_COMPLAINTS], given)
        return state

    @classmethod
    def _by_name(cls, items: Iterable[tuple[str, str]]) -> dict[str, list[str]]:
        """All values that each parameter is given, under the name that it has today."""
        aliases = {str(f.alias): n for n, f in cls.model_fields.items() if f.alias}
        given: dict[str, list[str]] = {}
        for name, text in items:
            given.setdefault(aliases.get(name, name), []).append(text)
        return given

    @classmethod
    def _complaint(cls, name: str, text: str, allowed: str) -> Complaint:
        return Complaint(name, clipped(text), allowed, suggestion(cls.model_fields[name], text))

    @classmethod
    def _validated(cls, values: Mapping[str, Any]) -> tuple[Self | None, dict[str, str]]:
        try:
            return cls.model_validate(values), {}
        except ValidationError as error:
            return None, dict(_complaints(cls, error))


class Complaint(tuple[str, str, str]):
    """What was wrong with one parameter: its name, what was received, what is allowed; and what may be meant."""

    meant: str

    def __new__(cls, name: str, received: str, allowed: str, meant: str = "") -> Complaint:
        made = super().__new__(cls, (name, received, allowed))
        made.meant = meant
        return made


class BadParams(ValueError):
    """A link with parameters that the sim can't take; `good` holds the rest, still spelled."""

    def __init__(self, complaints: list[Complaint], good: dict[str, str]) -> None:
        self.complaints = complaints
        self.good = good
        super().__init__(
            "; ".join(f"{name}: got {received!r}, allowed: {allowed}" for name, received, allowed in complaints)
        )


def number(
    default: float | None,
    low: float,
    high: float,
    *,
    title: str,
    description: str,
    step: float,
    unit: str = "",
    symbol: str = "",
    group: str = "",
    control: str = "slider",
) -> Any:
    """A number with bounds (inclusive) in `unit`. `control`: slider, number or none.

    One that may be absent (None) has a number box, in which one step below the least value stands for that.
    """
    return Field(
        default, ge=low, le=high, title=title, description=description,
        json_schema_extra={"step": step, "unit": unit, "symbol": symbol, "group": group, "control": control},
    )  # fmt: skip


def optional(
    low: int, high: int, *, title: str, description: str, words: str, off: str = "Off", group: str = ""
) -> Any:
    """A whole number that may be absent (None). Its dropdown offers `off`, and `words` for each number.

    In `words`, {0} stands for the number and {1} for the next: "{0} ↔ {1}".
    """
    hints: Any = {"step": 1, "group": group, "control": "option", "words": words, "off": off}
    return Field(None, ge=low, le=high, title=title, description=description, json_schema_extra=hints)


def choice(
    default: str | None, *, title: str, description: str, labels: Mapping[str, str], group: str = "", absent: str = ""
) -> Any:
    """One of the words of the field's Literal type; `labels` says how each is shown.

    A field that may be None says in `absent` how that is shown; in a link it is left out.
    """
    hints: Any = {"labels": dict(labels), "group": group, "control": "choice", "absent": absent}
    return Field(default, title=title, description=description, json_schema_extra=hints)


def switch(default: bool, *, title: str, description: str, group: str = "") -> Any:
    """On or off; 1 or 0 in a link."""
    return Field(default, title=title, description=description, json_schema_extra={"group": group, "control": "switch"})


def numbers(
    default: tuple[float, ...],
    low: float,
    high: float,
    *,
    most: int,
    title: str,
    description: str,
    step: float,
    entry: str = "",
    least: int = 1,
    unit: str = "",
    group: str = "",
    control: str = "numbers",
) -> Any:
    """A list of `least` to `most` numbers, each with a slider that is called as `entry` says: "Joint {} angle".

    `control`: numbers or none.
    """
    hints: Any = {
        "step": step, "unit": unit, "group": group, "control": control, "low": low, "high": high, "most": most,
        "least": least, "entry": entry,
    }  # fmt: skip
    return Field(
        default, min_length=least, max_length=most, title=title, description=description, json_schema_extra=hints
    )


def letters(
    default: str, *, most: int, labels: Mapping[str, str], title: str, entry: str, description: str, group: str = "",
    fewest: int = 1,
) -> Any:  # fmt: skip
    """`fewest` to `most` letters, together as in `zyy`, with a dropdown each, called as in `entry`: "Joint {} axis"."""
    hints: Any = {
        "group": group, "control": "letters", "labels": dict(labels), "most": most, "entry": entry, "fewest": fewest,
    }  # fmt: skip
    pattern = f"^[{''.join(labels)}]{{{fewest},{most}}}$"
    return Field(default, pattern=pattern, title=title, description=description, json_schema_extra=hints)


def vector(
    default: tuple[float, ...] | None,
    low: float | tuple[float, ...],
    high: float | tuple[float, ...],
    *,
    title: str,
    description: str,
    step: float,
    unit: str = "",
    group: str = "",
    control: str = "vector",
    presets: Mapping[str, tuple[float, ...]] | None = None,
) -> Any:
    """Two or three numbers that belong together; `1,0.5,2` in a link.

    `low` and `high` bound every entry, or each its own when they are tuples, as they are where the vector may be
    absent (None). `presets` are values to choose from.
    """
    hints: Any = {"step": step, "unit": unit, "group": group, "control": control, "low": low, "high": high}
    if presets:
        hints["presets"] = dict(presets)
    return Field(default, title=title, description=description, json_schema_extra=hints)


def text(
    *, title: str, description: str, pattern: str, allowed: str, control: Literal["none", "choice"] = "none",
    group: str = "",
) -> Any:  # fmt: skip
    """A few characters in a format of their own, or None, the default; `allowed` says the format to people.

    Without a control something else sets it, such as a click on a picture. The state's `options` say what there is
    to choose from.
    """
    hints: Any = {"labels": {}, "allowed": allowed, "group": group, "control": control}
    return Field(None, pattern=pattern, title=title, description=description, json_schema_extra=hints)


def extra(field: FieldInfo) -> dict[str, Any]:
    """What `number`, `choice`, … said about the control."""
    return cast(dict[str, Any], field.json_schema_extra or {})


def title(field: FieldInfo) -> str:
    """Title with its symbol, as in 'Yaw ψ'."""
    symbol = extra(field).get("symbol", "")
    return f"{field.title} {symbol}".strip()


@lru_cache(maxsize=1024)
def _declared_bounds(model: type[Params], name: str) -> tuple[float, float]:
    return field_bounds(model.model_fields[name])


@lru_cache(maxsize=1024)
def _declared_title(model: type[Params], name: str) -> str:
    return title(model.model_fields[name])


@lru_cache(maxsize=1024)
def _declared_options(model: type[Params], name: str, bounds: tuple[float, float] | None) -> Mapping[Any, str]:
    hints = extra(model.model_fields[name])
    if bounds is None:
        return options(model.model_fields[name])
    offered = range(int(bounds[0]), int(bounds[1]) + 1)
    return {None: hints["off"], **{k: hints["words"].format(k, k + 1) for k in offered}}


@lru_cache(maxsize=1024)
def _declared_ranges(model: type[Params], name: str) -> tuple[tuple[float, float], ...] | None:
    hints = extra(model.model_fields[name])
    own = isinstance(hints.get("low"), tuple)
    return tuple(zip(hints["low"], hints["high"], strict=True)) if own else None


def _spans(ranges: Iterable[tuple[float, float]]) -> str:
    spans = dict.fromkeys(f"from {plain(low)} to {plain(high)}" if low <= high else "absent" for low, high in ranges)
    return ", then ".join(spans)


def entry_bounds(field: FieldInfo) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Declared least and greatest values of a vector's entries."""
    low, high = extra(field)["low"], extra(field)["high"]
    return (low, high) if isinstance(low, tuple) else ((low,) * len(field.default), (high,) * len(field.default))


def field_bounds(field: FieldInfo) -> tuple[float, float]:
    """Declared bounds of a numeric field; for vectors, those that all entries are within."""
    if "least" in extra(field):
        return extra(field)["low"], extra(field)["high"]
    if "low" in extra(field):
        lows, highs = entry_bounds(field)
        return min(lows), max(highs)
    found = {type(m).__name__: m for m in field.metadata}
    return found["Ge"].ge, found["Le"].le


@lru_cache(maxsize=64)
def numeric_fields(model: type[Params]) -> tuple[str, ...]:
    """Names of the fields with bounds."""
    return tuple(n for n, f in model.model_fields.items() if extra(f).get("step") is not None)


def choices(field: FieldInfo) -> tuple[str, ...]:
    """The words a choice may take; empty for other fields."""
    kinds = (field.annotation, *get_args(field.annotation))
    return tuple(word for kind in kinds for word in get_args(kind) if isinstance(word, str))


def options(field: FieldInfo) -> dict[str | None, str]:
    """How each value of a choice is shown; None first, where the field may be absent."""
    hints = extra(field)
    return {**({None: hints["absent"]} if hints["absent"] else {}), **hints["labels"]}


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


def unspell(field: FieldInfo, text: str) -> Any:
    """What a link's text stands for, as far as the field's kind says; pydantic judges the rest."""
    kind = extra(field).get("control")
    if kind == "switch":
        return {"1": True, "0": False}.get(text)
    if "low" in extra(field):
        return tuple(number_text(text).split(",")) if text or extra(field).get("least") != 0 else ()
    return number_text(text) if extra(field).get("step") is not None or kind == "option" else text


def number_text(text: str) -> str:
    """A number's text with the minus sign that programs write, where it has the one that books and we do (U+2212)."""
    return text.replace("−", "-")


def meant(text: str, known: Iterable[str]) -> str:
    """Which of some words a text that is none of them may mean: the same but for its letters' case, or one near."""
    by_case = {word.casefold(): word for word in known}
    near = get_close_matches(clipped(text).strip().casefold(), by_case, 1, NEAR)
    return by_case[near[0]] if near else ""


NEAR = 0.7
"""How alike words must be, as difflib has it, for one to be meant by the other."""
ON_OFF = {"true": "1", "yes": "1", "on": "1", "false": "0", "no": "0", "off": "0"}


def suggestion(field: FieldInfo, text: str) -> str:
    """What a field's text in a link may mean that isn't allowed."""
    if extra(field).get("control") == "switch":
        return ON_OFF.get(text.strip().lower(), "")
    return meant(text, choices(field))


def clipped(text: Any, length: int = 80) -> str:
    """Text that is safe to show back: shortened."""
    whole = str(text)
    return whole if len(whole) <= length else whole[: length - 1] + "…"


def allowed_values(field: FieldInfo) -> str:
    """In words: what a field may be."""
    if "allowed" in extra(field):
        return str(extra(field)["allowed"])
    kind = extra(field).get("control")
    if kind == "switch":
        return "1 or 0"
    if words := choices(field):
        return "one of: " + ", ".join(words)
    if kind == "letters":
        hints = extra(field)
        return f"{hints['fewest']} to {hints['most']} letters, each one of: {', '.join(hints['labels'])}"
    if "low" in extra(field):
        ranges = list(zip(*entry_bounds(field), strict=True)) or [field_bounds(field)]
        count = f"{extra(field)['least']} to {extra(field)['most']}" if "least" in extra(field) else f"{len(ranges)}"
        return f"{count} numbers {_spans(ranges)}, separated by commas"
    low, high = field_bounds(field)
    span = f"from {plain(low)} to {plain(high)}"
    return f"a whole number {span}" if field.annotation is int or kind == "option" else f"a number {span}"


def refusal(names: Iterable[str], words: str) -> PydanticCustomError:
    """The error of a model's validator: which fields it is about, and in words what is wrong with them."""
    return PydanticCustomError("refusal", "{words}", {"words": words, "names": ",".join(names)})


def _complaints(model: type[Params], error: ValidationError) -> Iterable[tuple[str, str]]:
    for item in error.errors():
        if item["loc"]:
            name = str(item["loc"][0])
            yield name, allowed_values(model.model_fields[name])
        else:
            names, text = refused(item)
            yield from ((name, text) for name in names)


def refused(item: Mapping[str, Any]) -> tuple[list[str], str]:
    """The fields that a model's validator complains of, and its words."""
    return str(item.get("ctx", {}).get("names", "")).split(","), str(item["msg"])
