"""The state of a sim: one frozen pydantic model, and its two spellings (query string and JSON).

A field's type says its kind (`sims.kit.fields`); the string below it says what it is for.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, ClassVar, Self
from urllib.parse import urlencode

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator
from pydantic.fields import FieldInfo

from sims.kit.fields import Choice, Kind, Letters, Numbers, Numeric, OptionalNumber
from sims.kit.refusals import BadParams, Complaint, refusal, refused
from sims.kit.spelling import clipped, meant, spans, spell

LONGEST_VALUE = 400
"""Characters of one value in a query; a longer one is refused unread."""
MOST_COMPLAINTS = 20
DECIMALS = 9
"""Places after the point in what a hand leads to: degrees, metres or pixels."""


class Params(BaseModel):
    """The whole state of a sim. Frozen; `changed` makes the next state."""

    model_config = ConfigDict(
        frozen=True, extra="forbid", allow_inf_nan=False, validate_default=True, validate_by_name=True,
        use_attribute_docstrings=True,
    )  # fmt: skip
    kinds: ClassVar[Mapping[str, Kind]] = {}
    """What each field is."""
    numeric: ClassVar[Mapping[str, Numeric]] = {}
    """Those with bounds."""
    visible: ClassVar[tuple[str, ...]] = ()
    """Names of those that have a control."""
    opening: ClassVar[Mapping[str, Any]] = {}
    """What differs from the defaults in the state that a link without parameters opens; the link of the defaults
    themselves then names the first of these."""

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        cls.kinds = {name: _kind(cls, name, field) for name, field in cls.model_fields.items()}
        cls.visible = tuple(name for name, kind in cls.kinds.items() if not kind.hidden)
        cls.numeric = {name: kind for name, kind in cls.kinds.items() if isinstance(kind, Numeric)}

    def form(self) -> tuple[Any, ...]:
        """All that labels, bounds and marks may depend on: everything but the plain numbers."""
        return tuple([value for value in self.__dict__.values() if type(value) is not float])

    def bounds(self, name: str) -> tuple[float, float]:
        """Least and greatest value of a numeric field in this state; override where they depend on its `form`."""
        return self.numeric[name].bounds

    def ranges(self, name: str) -> Sequence[tuple[float, float]]:
        """The same for each number of a numeric field; override where those of a vector's entries depend on `form`."""
        return self.numeric[name].ranges(getattr(self, name), self.bounds(name))

    def label(self, name: str) -> str:
        """Words beside the control of a field in this state."""
        return self.kinds[name].label

    def about(self, name: str) -> str:
        """What the control of a field is for in this state, in a sentence without its full stop."""
        return type(self).model_fields[name].description or ""

    @property
    def arranged(self) -> tuple[str, ...]:
        """Those that have a control, in the order in which the controls stand in this state, as its `form` says."""
        return self.visible

    def entry_label(self, name: str, k: int) -> str:
        """Words beside the control of the k-th entry, from 0, of a list."""
        kind = self.kinds[name]
        assert isinstance(kind, Numbers | Letters)
        return kind.entry.format(k + 1)

    def increment(self, name: str) -> float:
        """By how much a step of a slider changes a number in this state."""
        return float(self.numeric[name].step)

    def options(self, name: str) -> Mapping[Any, str]:
        """What a dropdown offers in this state: each value, and how it is shown."""
        match self.kinds[name]:
            case Choice(options=options):
                return options
            case OptionalNumber() as kind:
                return kind.options(self.bounds(name))
        return {}

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
        changes = with_entries(changes, self.__dict__.__getitem__)
        if len(changes) == 1 and (fast := self._number_moved(*next(iter(changes.items())))):
            return fast
        state = self.model_copy(update=dict(changes))
        kept = {name: kind.clamped(getattr(state, name), state.ranges(name)) for name, kind in self.numeric.items()}
        return self.changed({**changes, **kept})

    def _number_moved(self, name: str, value: Any) -> Self | None:
        """The same for one plain number, which within its bounds is always valid."""
        if type(value) is not float or type(self.__dict__.get(name)) is not float or not math.isfinite(value):
            return None
        low, high = self.bounds(name)
        return self.model_copy(update={name: min(max(value, low), high)})

    @model_validator(mode="after")
    def _within_bounds(self) -> Self:
        for name, kind in self.numeric.items():
            value, ranges = getattr(self, name), self.ranges(name)
            if not kind.within(value, ranges):
                raise refusal([name], f"{name} must be {spans(ranges)}, got {spell(value)}")
        return self

    def query(self) -> str:
        """The query string of this state, with default values left out."""
        return urlencode(self.query_items(), safe=",-.:")

    def query_items(self) -> dict[str, str]:
        """Name and spelling of every field that isn't at its default; none at all of the state that is opened with."""
        found = {
            name: spell(value)
            for name, field in type(self).model_fields.items()
            if (value := getattr(self, name)) != field.default and value is not None
        }
        if not self.opening or not found.keys() <= self.opening.keys():
            return found
        if all(getattr(self, name) == value for name, value in self.opening.items()):
            return {}
        first = next(iter(self.opening))
        return found or {first: spell(getattr(self, first))}

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
        state, wrong = cls._read(given)
        complaints += [cls._complaint(name, given.get(name, ""), allowed) for name, allowed in wrong.items()]
        if not given and not complaints:
            return cls(**cls.opening)
        if complaints or state is None:
            while wrong:  # what is left may be wrong without what went
                given = {name: text for name, text in given.items() if name not in wrong}
                _, wrong = cls._read(given)
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
        return Complaint(name, clipped(text), allowed, cls.kinds[name].meant(text))

    @classmethod
    def _read(cls, texts: Mapping[str, str]) -> tuple[Self | None, dict[str, str]]:
        """The state of a link's texts; or what is allowed in place of those that are wrong."""
        try:
            return cls.model_validate({name: cls.kinds[name].unspell(text) for name, text in texts.items()}), {}
        except ValidationError as error:
            return None, dict(_complaints(cls, error))


def with_entries(changes: Mapping[str, Any], entries: Callable[[str], Any]) -> dict[str, Any]:
    """Changes of single entries as changes of their lists, which `entries` finds by their names."""
    whole: dict[str, Any] = {}
    for name, value in changes.items():
        field, _, k = name.partition(".")
        if not k:
            whole[name] = value
        elif int(k) < len(before := whole.get(field, entries(field))):  # else it was taken away meanwhile
            put = value if isinstance(before, str) else (value,)
            whole[field] = before[: int(k)] + put + before[int(k) + 1 :]
    return whole


def by_hand(changes: Mapping[str, Any], decimals: int = DECIMALS) -> dict[str, Any]:
    """What a hand leads to, in numbers that are finer than any hand and still short in a link."""
    return {name: _rounded(value, decimals) for name, value in changes.items()}


def _rounded(value: Any, decimals: int) -> Any:
    if isinstance(value, tuple):
        return tuple(_rounded(each, decimals) for each in value)
    return round(value, decimals) + 0.0 if isinstance(value, float) else value


def _kind(model: type[Params], name: str, field: FieldInfo) -> Kind:
    """What a field was declared as. Raises TypeError."""
    kinds = [note for note in field.metadata if isinstance(note, Kind)]
    if len(kinds) != 1:
        raise TypeError(
            f"{model.__name__}.{name} must be of one kind of sims.kit.fields, as in "
            f"{name}: Annotated[float, Slider(…)] = 1.0; got {len(kinds)}"
        )
    try:
        return kinds[0].of(field.annotation)
    except TypeError as error:
        raise TypeError(f"{model.__name__}.{name}: {error}") from None


def _complaints(model: type[Params], error: ValidationError) -> Iterable[tuple[str, str]]:
    for item in error.errors():
        if item["loc"]:
            name = str(item["loc"][0])
            yield name, model.kinds[name].allowed
        else:
            names, text = refused(item)
            yield from ((name, text) for name in names)
