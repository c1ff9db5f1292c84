"""Checks JSON against a JSON Schema, as far as the schemas of solutions go."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

KINDS: dict[str, type | tuple[type, ...]] = {
    "object": dict, "array": list, "string": str, "boolean": bool, "null": type(None), "integer": int,
    "number": (int, float),
}  # fmt: skip
KNOWN = {
    "type", "enum", "anyOf", "properties", "required", "additionalProperties", "items", "prefixItems", "minItems",
    "maxItems", "title", "description",
}  # fmt: skip


def wrong(value: Any, schema: Mapping[str, Any], where: str = "$") -> Iterator[str]:
    """What in a value isn't as the schema says. Raises KeyError for a schema with other keywords."""
    if unknown := schema.keys() - KNOWN:
        raise KeyError(f"{unknown} at {where}")
    if "type" in schema and not any(_is(value, kind) for kind in _kinds(schema["type"])):
        yield f"{where} is {value!r:.80}, not {schema['type']}"
        return
    if "enum" in schema and value not in schema["enum"]:
        yield f"{where} is {value!r:.80}, not one of {schema['enum']}"
    if "anyOf" in schema:
        found = [list(wrong(value, one, where)) for one in schema["anyOf"]]
        if all(found):
            yield from min(found, key=len)
    if isinstance(value, dict):
        yield from _in_object(value, schema, where)
    if isinstance(value, list):
        yield from _in_array(value, schema, where)


def _kinds(kinds: str | list[str]) -> list[str]:
    return [kinds] if isinstance(kinds, str) else kinds


def _is(value: Any, kind: str) -> bool:
    return isinstance(value, KINDS[kind]) and (kind == "boolean" or not isinstance(value, bool))


def _in_object(value: dict[str, Any], schema: Mapping[str, Any], where: str) -> Iterator[str]:
    properties, rest = schema.get("properties", {}), schema.get("additionalProperties", {})
    yield from (f"{where} has no {name}" for name in schema.get("required", ()) if name not in value)
    for name, one in value.items():
        if name not in properties and rest is False:
            yield f"{where} has a {name}"
        else:
            yield from wrong(one, properties.get(name, rest), f"{where}.{name}")


def _in_array(value: list[Any], schema: Mapping[str, Any], where: str) -> Iterator[str]:
    if not schema.get("minItems", 0) <= len(value) <= schema.get("maxItems", len(value)):
        yield f"{where} has {len(value)} entries"
    first = schema.get("prefixItems", [])
    for k, one in enumerate(value):
        yield from wrong(one, first[k] if k < len(first) else schema.get("items", {}), f"{where}[{k}]")
