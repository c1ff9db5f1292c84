"""The page that describes the API in words, made from what the sims declare; /openapi.json is the same for programs."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from typing import Any, get_type_hints

from app.values import allowed
from sims import SIMS
from sims.kit.fields import Kind, Numeric
from sims.kit.schema import solution_schema
from sims.kit.sim import Sim


@cache
def described() -> list[tuple[Sim[Any, Any], list[tuple[str, str, str, str]], dict[str, Any]]]:
    """Each sim, with its parameters (name, default, what is allowed, description) and its solution's fields."""
    return [(sim, _parameters(sim), _solution(sim)) for sim in SIMS]


def _parameters(sim: Sim[Any, Any]) -> list[tuple[str, str, str, str]]:
    return [
        (name, json.dumps(field.default), allowed(sim.params, name), _words(field.description, sim.params.kinds[name]))
        for name, field in sim.params.model_fields.items()
    ]


def _words(description: str | None, kind: Kind) -> str:
    unit = kind.unit if isinstance(kind, Numeric) else ""
    return f"{description or ''}{f' (in {unit})' if unit else ''}"


def _solution(sim: Sim[Any, Any]) -> dict[str, Any]:
    schema = solution_schema(get_type_hints(sim.solve)["return"])
    fields = [(name, kind(one), one.get("description", "")) for name, one in schema["properties"].items()]
    return {"description": schema["description"], "fields": fields}


def kind(schema: Mapping[str, Any]) -> str:
    """A schema's type in a few words."""
    if "anyOf" in schema:
        return " or ".join(dict.fromkeys(kind(one) for one in schema["anyOf"]))
    if "enum" in schema:
        return "one of: " + ", ".join(map(str, schema["enum"]))
    if schema.get("type") == "array":
        return _list(schema)
    names = schema.get("type", "any value")
    words = [names] if isinstance(names, str) else names
    return " or ".join(words)


def _list(schema: Mapping[str, Any]) -> str:
    lengths, inner = [], schema
    while inner.get("type") == "array" and "items" in inner:
        lengths.append(str(inner["minItems"]) if "minItems" in inner else "n")
        inner = inner["items"]
    if "prefixItems" in inner:
        return "list of " + ", ".join(kind(one) for one in inner["prefixItems"])
    return f"list ({' × '.join(lengths)}) of {kind(inner)}"
