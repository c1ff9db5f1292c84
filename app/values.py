"""Parameters as JSON: read strictly, and what is wrong with them.

A link spells its values as text; JSON has types, so there a number is a number: not text, and not true or false.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any, TypeVar

from pydantic import ValidationError

from sims.kit.fields import Choice
from sims.kit.params import Params
from sims.kit.refusals import Complaint, refused
from sims.kit.spelling import clipped, meant

P = TypeVar("P", bound=Params)
LARGEST_WHOLE = 2**53
"""Up to here a whole number is the same one as a float."""


def strict(model: type[P], given: Mapping[str, Any], base: Mapping[str, Any] | None = None) -> P:
    """The state of values from JSON, the others at their defaults or those of `base`. Raises ValidationError.

    30.0 is a whole number as 30 is, for JavaScript can't tell them apart.
    """
    return model.model_validate({**(base or {}), **{name: _value(value) for name, value in given.items()}}, strict=True)


def _value(value: Any) -> Any:
    if isinstance(value, list):
        return tuple(map(_whole, value))
    return _whole(value)


def _whole(value: Any) -> Any:
    return int(value) if isinstance(value, float) and value.is_integer() and abs(value) <= LARGEST_WHOLE else value


def complaints(
    model: type[Params], given: Mapping[str, Any], error: ValidationError
) -> Iterator[tuple[Mapping[str, Any], Complaint]]:
    """What is wrong: each of pydantic's items, with the parameters that it is about."""
    for item in error.errors(include_url=False):
        for name, allowed in _named(model, item):
            received = _received(name, given, item["input"])
            yield item, Complaint(clipped(name), shown(received), allowed, _meant(model, name, received))


def _meant(model: type[Params], name: str, received: Any) -> str:
    field = model.model_fields.get(name)
    if field is None:
        return meant(name, model.model_fields)
    kind = model.kinds[name]
    return kind.meant(received) if isinstance(received, str) and isinstance(kind, Choice) else ""


def _received(name: str, given: Mapping[str, Any], value: Any) -> Any:
    if name in given:
        return given[name]
    return value.get(name) if isinstance(value, Mapping) else value


def _named(model: type[Params], item: Mapping[str, Any]) -> list[tuple[str, str]]:
    if item["loc"]:
        return [(name := str(item["loc"][0]), allowed(model, name))]
    names, words = refused(item)
    return [(name, words) for name in names if name in model.model_fields] or [("", _names(model))]


def allowed(model: type[Params], name: str) -> str:
    """In words: what a parameter may be in JSON."""
    field = model.model_fields.get(name)
    if field is None:
        return _names(model)
    words = model.kinds[name].allowed_in_json
    return words if field.default is not None else f"{words}; or null"


def _names(model: type[Params]) -> str:
    return "one of: " + ", ".join(model.model_fields)


def shown(value: Any) -> str:
    """A value as JSON spells it, shortened; nothing but ASCII, so that it can go wherever words can."""
    try:
        return clipped(json.dumps(value, default=str))
    except (ValueError, RecursionError):
        return "something nested too deeply"
