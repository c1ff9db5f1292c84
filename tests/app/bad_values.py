"""For every parameter of every sim: values that can't be, as JSON and as they stand in a link."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from sims import SIMS
from sims.kit.fields import Choice, Kind, Letters, Numbers, Numeric, Switch, Vector
from sims.kit.sim import Sim
from sims.kit.spelling import plain

AnySim = Sim[Any, Any]
HOSTILE = '<script>alert("1")</script>\'&'
NAN, INFINITE = float("nan"), float("inf")


def may_be_empty(kind: Kind) -> bool:
    """Whether it is a list, of numbers or letters, that need not have an entry."""
    return (isinstance(kind, Numbers) and not kind.least) or (isinstance(kind, Letters) and not kind.fewest)


def for_json(kind: Kind, default: Any) -> Iterator[tuple[str, Any]]:
    """What is wrong, and the value."""
    yield "an object", {"a": 1}
    yield "markup", HOSTILE
    yield "too long", "1" * 5000
    if default is not None:
        yield "null", None
    if isinstance(kind, Choice):
        yield "a number", 1
        yield "capitals", kind.words[0].upper()
        yield "empty", ""
    elif isinstance(kind, Switch):
        yield "a word", "perhaps"
        yield "a number", 2
    elif isinstance(kind, Numbers) and not kind.least:
        low, high = kind.bounds
        yield "a number", 1
        yield "too many", [high] * (kind.most + 1)
        yield "below", [low - 1]
        yield "not a number", [NAN]
        yield "words", ["a"]
    elif isinstance(kind, Numbers | Vector) and default is not None:
        low, high = kind.bounds
        good = list(default)
        yield "a number", 1
        yield "one entry less", good[:-1]
        yield "one entry more", [*good, good[0]]
        yield "below", [low - 1, *good[1:]]
        yield "above", [high + 1, *good[1:]]
        yield "not a number", [NAN, *good[1:]]
        yield "infinite", [INFINITE, *good[1:]]
        yield "words", ["a" for _ in good]
    elif isinstance(kind, Numeric):
        low, high = kind.bounds
        yield "a word", "many"
        yield "a list", [1]
        yield "below", low - 1
        yield "above", high + 1
        yield "not a number", NAN
        yield "infinite", INFINITE
        yield "minus infinite", -INFINITE
        yield "very large", 10**400


def for_link(kind: Kind, default: Any) -> Iterator[tuple[str, str]]:
    """What is wrong, and how it is spelled."""
    if not may_be_empty(kind):
        yield "empty", ""
    yield "markup", HOSTILE
    yield "too long", "1" * 401
    yield "control characters", "1\x00\n2"
    if isinstance(kind, Choice):
        yield "an unknown word", "sideways"
    elif isinstance(kind, Switch):
        yield "a word", "yes"
    elif isinstance(kind, Numbers) and not kind.least:
        low, high = kind.bounds
        yield "too many", ",".join([plain(high)] * (kind.most + 1))
        yield "above", plain(high + 1)
        yield "infinite", "inf"
    elif isinstance(kind, Numbers | Vector) and default is not None:
        low, high = kind.bounds
        rest = ["0"] * (len(default) - 1)
        yield "too few", ",".join(rest)
        yield "below", ",".join([str(low - 1), *rest])
        yield "above", ",".join([str(high + 1), *rest])
        yield "not a number", ",".join(["nan", *rest])
        yield "infinite", ",".join(["inf", *rest])
    elif isinstance(kind, Numeric):
        low, high = kind.bounds
        yield "a word", "many"
        yield "below", str(low - 1)
        yield "above", str(high + 1)
        yield "not a number", "nan"
        yield "infinite", "-inf"
        yield "very large", "1e999"


FIELDS = [
    (sim, name, sim.params.kinds[name], field.default)
    for sim in SIMS
    for name, field in sim.params.model_fields.items()
]
JSON = [(sim, name, value) for sim, name, kind, default in FIELDS for _, value in for_json(kind, default)]
JSON_NAMES = [f"{sim.slug}: {name} {why}" for sim, name, kind, default in FIELDS for why, _ in for_json(kind, default)]
LINK = [(sim, name, text) for sim, name, kind, default in FIELDS for _, text in for_link(kind, default)]
LINK_NAMES = [f"{sim.slug}: {name} {why}" for sim, name, kind, default in FIELDS for why, _ in for_link(kind, default)]
