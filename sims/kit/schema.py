"""JSON Schemas of solutions, from their dataclasses: types, shapes of arrays, and what the docstrings say."""

from __future__ import annotations

import ast
import inspect
import textwrap
import types
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from functools import cache
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

import numpy as np

Schema = dict[str, Any]
PLAIN: dict[Any, Schema] = {
    bool: {"type": "boolean"}, int: {"type": "integer"}, float: {"type": "number"}, str: {"type": "string"},
    type(None): {"type": "null"}, Any: {},
}  # fmt: skip


@dataclass(frozen=True)
class Shape:
    """The lengths of an array's dimensions, for `Annotated`; None is any length."""

    lengths: tuple[int | None, ...]

    def __init__(self, *lengths: int | None) -> None:
        object.__setattr__(self, "lengths", lengths)


@cache
def solution_schema(solution: type) -> Schema:
    """The schema of what `jsonable` makes of a solution."""
    return _object(solution)


def _object(kind: type) -> Schema:
    hints, words = get_type_hints(kind, include_extras=True), _docstrings(kind)
    out = [field.name for field in fields(kind) if not field.metadata.get("drawn")]
    properties = {name: _described(_schema(hints[name]), words.get(name, "")) for name in out}
    return {
        "type": "object", "title": kind.__name__, "description": inspect.getdoc(kind) or "",
        "properties": properties, "required": out, "additionalProperties": False,
    }  # fmt: skip


def _described(schema: Schema, words: str) -> Schema:
    return {**schema, "description": words} if words else schema


def _schema(kind: Any) -> Schema:
    if kind in PLAIN:
        return PLAIN[kind]
    if is_dataclass(kind) and isinstance(kind, type):
        return _object(kind)
    origin, arguments = get_origin(kind), get_args(kind)
    if origin is Annotated:
        shape = next(note for note in arguments[1:] if isinstance(note, Shape))
        return _array(arguments[0], shape.lengths)
    if origin is np.ndarray:
        return _array(kind, None)
    if origin is Literal:
        return {"enum": list(arguments)}
    if origin in (Union, types.UnionType):
        return {"anyOf": [_schema(one) for one in arguments]}
    if isinstance(origin, type) and issubclass(origin, Mapping):
        return _mapping(*arguments)
    if origin is tuple and arguments[-1] is not ...:
        return {"type": "array", "prefixItems": [_schema(one) for one in arguments], **_long(len(arguments))}
    if isinstance(origin, type) and issubclass(origin, Sequence):
        return {"type": "array", "items": _schema(arguments[0])}
    raise TypeError(f"a solution may not hold {kind}: nobody has said how that looks in JSON")


def _mapping(key: Any, value: Any) -> Schema:
    if get_origin(key) is not Literal:
        return {"type": "object", "additionalProperties": _schema(value)}
    names = list(get_args(key))
    properties = {name: _schema(value) for name in names}
    return {"type": "object", "properties": properties, "required": names, "additionalProperties": False}


def _array(kind: Any, lengths: tuple[int | None, ...] | None) -> Schema:
    """Nested lists by rows; where an array holds a number that doesn't exist, there is null."""
    number = get_args(get_args(kind)[1])[0]
    schema: Schema = {"type": ["number", "null"]} if issubclass(number, np.floating) else {"type": "integer"}
    if lengths is None:
        return {"type": "array", "items": {"type": [*np.atleast_1d(schema["type"]).tolist(), "array"]}}
    for length in reversed(lengths):
        schema = {"type": "array", "items": schema, **({} if length is None else _long(length))}
    return schema


def _long(length: int) -> Schema:
    return {"minItems": length, "maxItems": length}


def _docstrings(kind: type) -> dict[str, str]:
    """The string below each field."""
    (made,) = ast.parse(textwrap.dedent(inspect.getsource(kind))).body
    assert isinstance(made, ast.ClassDef)
    found = {}
    for before, after in zip(made.body, made.body[1:], strict=False):
        if isinstance(before, ast.AnnAssign) and isinstance(before.target, ast.Name):
            match after:
                case ast.Expr(ast.Constant(str(words))):
                    found[before.target.id] = " ".join(words.split())
    return found
