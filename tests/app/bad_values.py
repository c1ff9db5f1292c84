"""For every parameter of every sim: values that can't be, as JSON and as they stand in a link."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic.fields import FieldInfo

from sims import SIMS
from sims.kit.params import choices, extra, field_bounds, plain
from sims.kit.sim import Sim

AnySim = Sim[Any, Any]
HOSTILE = '<script>alert("1")</script>\'&'
NAN, INFINITE = float("nan"), float("inf")


def may_be_empty(field: FieldInfo) -> bool:
    """Whether it is a list that need not have an entry."""
    return extra(field).get("least") == 0


def for_json(field: FieldInfo) -> Iterator[tuple[str, Any]]:
    """What is wrong, and the value."""
    yield "an object", {"a": 1}
    yield "markup", HOSTILE
    yield "too long", "1" * 5000
    if field.default is not None:
        yield "null", None
    if choices(field):
        yield "a number", 1
        yield "capitals", choices(field)[0].upper()
        yield "empty", ""
    elif extra(field).get("control") == "switch":
        yield "a word", "perhaps"
        yield "a number", 2
    elif may_be_empty(field):
        low, high = field_bounds(field)
        yield "a number", 1
        yield "too many", [high] * (extra(field)["most"] + 1)
        yield "below", [low - 1]
        yield "not a number", [NAN]
        yield "words", ["a"]
    elif isinstance(field.default, tuple):
        low, high = field_bounds(field)
        good = list(field.default)
        yield "a number", 1
        yield "one entry less", good[:-1]
        yield "one entry more", [*good, good[0]]
        yield "below", [low - 1, *good[1:]]
        yield "above", [high + 1, *good[1:]]
        yield "not a number", [NAN, *good[1:]]
        yield "infinite", [INFINITE, *good[1:]]
        yield "words", ["a" for _ in good]
    elif extra(field).get("step") is not None:
        low, high = field_bounds(field)
        yield "a word", "many"
        yield "a list", [1]
        yield "below", low - 1
        yield "above", high + 1
        yield "not a number", NAN
        yield "infinite", INFINITE
        yield "minus infinite", -INFINITE
        yield "very large", 10**400


def for_link(field: FieldInfo) -> Iterator[tuple[str, str]]:
    """What is wrong, and how it is spelled."""
    if not may_be_empty(field) and extra(field).get("fewest") != 0:
        yield "empty", ""
    yield "markup", HOSTILE
    yield "too long", "1" * 401
    yield "control characters", "1\x00\n2"
    if choices(field):
        yield "an unknown word", "sideways"
    elif extra(field).get("control") == "switch":
        yield "a word", "yes"
    elif may_be_empty(field):
        low, high = field_bounds(field)
        yield "too many", ",".join([plain(high)] * (extra(field)["most"] + 1))
        yield "above", plain(high + 1)
        yield "infinite", "inf"
    elif isinstance(field.default, tuple):
        low, high = field_bounds(field)
        rest = ["0"] * (len(field.default) - 1)
        yield "too few", ",".join(rest)
        yield "below", ",".join([str(low - 1), *rest])
        yield "above", ",".join([str(high + 1), *rest])
        yield "not a number", ",".join(["nan", *rest])
        yield "infinite", ",".join(["inf", *rest])
    elif extra(field).get("step") is not None:
        low, high = field_bounds(field)
        yield "a word", "many"
        yield "below", str(low - 1)
        yield "above", str(high + 1)
        yield "not a number", "nan"
        yield "infinite", "-inf"
        yield "very large", "1e999"


FIELDS = [(sim, name, field) for sim in SIMS for name, field in sim.params.model_fields.items()]
JSON = [(sim, name, value) for sim, name, field in FIELDS for _, value in for_json(field)]
JSON_NAMES = [f"{sim.slug}: {name} {why}" for sim, name, field in FIELDS for why, _ in for_json(field)]
LINK = [(sim, name, text) for sim, name, field in FIELDS for _, text in for_link(field)]
LINK_NAMES = [f"{sim.slug}: {name} {why}" for sim, name, field in FIELDS for why, _ in for_link(field)]
