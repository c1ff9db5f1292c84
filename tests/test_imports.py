"""Imports point one way (`app → sims → geometry`), and viser's private names stay in one module."""

from __future__ import annotations

import ast
import functools
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("geometry", "sims", "app")
OWN = {*PACKAGES, "tests", "benchmarks"}

# What each package may not import; geometry has a list of what it may.
FORBIDDEN = {
    "sims": {"app", "tests", "benchmarks", "fastapi", "starlette", "uvicorn"},
    "app": {"tests", "benchmarks"},
}
GEOMETRY_ALLOWED = {"geometry", "numpy", "scipy", *sys.stdlib_module_names}
INPUT_OUTPUT = {"asyncio", "http", "io", "os", "pathlib", "shutil", "socket", "subprocess", "urllib"}

MAY_USE_PRIVATE_NAMES = {
    "sims/kit/viser_internals.py",
    "tests/sims/test_viser_internals.py",
    "tests/sims/test_outbox.py",
}
PUBLIC_ALL_THE_SAME = {"_asdict", "_exit", "_fields", "_make", "_replace"}


def sources(*folders: str) -> list[Path]:
    return sorted(path for folder in folders for path in (ROOT / folder).rglob("*.py"))


def name_of(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


@functools.cache
def parse(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


for _path in sources("geometry", "sims", "app", "tests"):
    parse(_path)  # now: after deep recursion in other tests, CPython 3.11's parser may fail


def imports(tree: ast.AST, package: tuple[str, ...]) -> Iterator[tuple[int, str]]:
    """Line and full dotted name of each import, relative ones resolved against `package`.

    `from a import b` counts as `a.b`: b may be a module.
    """
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            parents = package[: len(package) - node.level + 1] if node.level else ()
            module = ".".join((*parents, *(node.module or "").split("."))).strip(".")
            yield from ((node.lineno, f"{module}.{alias.name}") for alias in node.names)


def imports_of(path: Path) -> list[tuple[int, str]]:
    return list(imports(parse(path), path.relative_to(ROOT).parts[:-1]))


def is_private(name: str) -> bool:
    return name.startswith("_") and not (name.startswith("__") and name.endswith("__"))


def own_names(tree: ast.AST) -> Iterator[str]:
    """Names that a module defines itself: functions, classes, variables, fields, attributes of self."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            yield node.name
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store) and is_self(node.value):
            yield node.attr


@functools.cache
def all_own_names() -> set[str]:
    return {name for path in sources(*sorted(OWN)) for name in own_names(parse(path))}


def is_self(node: ast.expr) -> bool:
    return isinstance(node, ast.Name) and node.id in ("self", "cls")


def foreign_private_attributes(tree: ast.AST, own: set[str]) -> Iterator[tuple[int, str]]:
    """Line and name of each `x._name` where no module of ours defines `_name`."""
    attributes = (node for node in ast.walk(tree) if isinstance(node, ast.Attribute))
    for node in attributes:
        if is_private(node.attr) and not is_self(node.value) and node.attr not in own | PUBLIC_ALL_THE_SAME:
            yield node.lineno, node.attr


def uses_viser_internals(module: str) -> bool:
    first, *rest = module.split(".")
    return first == "viser" and (rest[:1] == ["infra"] or any(map(is_private, rest)))


@pytest.mark.parametrize("path", sources("geometry"), ids=name_of)
def test_geometry_imports_only_numpy_scipy_and_the_standard_library(path: Path) -> None:
    tops = {(line, module.split(".")[0]) for line, module in imports_of(path)}
    wrong = [(line, top) for line, top in tops if top not in GEOMETRY_ALLOWED - INPUT_OUTPUT]
    assert not wrong, (
        f"{name_of(path)} may import NumPy, SciPy and the standard library without input or output: {wrong}"
    )


@pytest.mark.parametrize("path", sources(*FORBIDDEN), ids=name_of)
def test_imports_point_one_way(path: Path) -> None:
    package = path.relative_to(ROOT).parts[0]
    wrong = [(line, module) for line, module in imports_of(path) if module.split(".")[0] in FORBIDDEN[package]]
    assert not wrong, f"{name_of(path)} may not import {sorted(FORBIDDEN[package])}: {wrong}"


@pytest.mark.parametrize("path", sources(*sorted(OWN)), ids=name_of)
def test_private_names_of_viser_stay_in_one_module(path: Path) -> None:
    if name_of(path) in MAY_USE_PRIVATE_NAMES:
        return
    modules = [(line, module) for line, module in imports_of(path) if uses_viser_internals(module)]
    attributes = list(foreign_private_attributes(parse(path), all_own_names()))
    assert not modules + attributes, (
        f"{name_of(path)} uses private names; only sims/kit/viser_internals.py may: {modules + attributes}"
    )


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("import viser._messages", ["viser._messages"]),
        ("from viser import _messages as m", ["viser._messages"]),
        ("from viser.infra import Server", ["viser.infra.Server"]),
        ("from .. import app", ["sims.app"]),
        ("from ..kit.stage import Stage", ["sims.kit.stage.Stage"]),
        ("from . import palette", ["sims.kit.palette"]),
    ],
)
def test_imports_are_read_as_full_names(source: str, expected: list[str]) -> None:
    assert [module for _, module in imports(ast.parse(source), ("sims", "kit"))] == expected


@pytest.mark.parametrize(
    ("module", "internal"),
    [
        ("viser.ViserServer", False),
        ("viser.transforms.SO3", False),
        ("viser.infra.Server", True),
        ("viser._messages", True),
        ("numpy._core", False),
    ],
)
def test_internals_of_viser_are_recognised(module: str, internal: bool) -> None:
    assert uses_viser_internals(module) is internal


def test_private_attributes_of_others_are_recognised() -> None:
    tree = ast.parse("node._impl\nself._mine\nother._mine\nrow._asdict()\nx.__dict__\nviser._client.f")
    assert list(foreign_private_attributes(tree, {"_mine"})) == [(1, "_impl"), (6, "_client")]
