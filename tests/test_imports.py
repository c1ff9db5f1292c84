"""Imports point one way (`app → sims → geometry`), and viser's private names stay in one module."""

from __future__ import annotations

import ast
import functools
import sys
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple, TypeVar

import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("geometry", "sims", "app")
OWN = {*PACKAGES, "tests", "benchmarks"}
T = TypeVar("T")

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


def in_a_new_thread(work: Callable[[], T]) -> T:
    """After deep recursion in other tests, CPython 3.11's parser may fail in their thread."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(work).result()


def imports(nodes: Iterable[ast.AST], package: tuple[str, ...]) -> Iterator[tuple[int, str]]:
    """Line and full dotted name of each import, relative ones resolved against `package`.

    `from a import b` counts as `a.b`: b may be a module.
    """
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            parents = package[: len(package) - node.level + 1] if node.level else ()
            module = ".".join((*parents, *(node.module or "").split("."))).strip(".")
            yield from ((node.lineno, f"{module}.{alias.name}") for alias in node.names)


class Said(NamedTuple):
    """What the tests ask of a module."""

    imports: list[tuple[int, str]]
    own: set[str]
    """Names that it defines itself."""
    private: list[tuple[int, str]]
    """Line and name of each `x._name`, whoever defines that."""
    texts: list[tuple[int, str]]
    """Line and text of what stands alone, as docstrings do."""
    at_root: list[tuple[int, str]]
    """Line and name of each `ROOT / "name"`."""


@functools.cache
def said(path: Path) -> Said:
    """Read once for all tests. The trees aren't kept: all of them slow every collection of garbage down."""
    text = path.read_text(encoding="utf-8")
    nodes = in_a_new_thread(lambda: list(ast.walk(ast.parse(text))))
    return Said(
        list(imports(nodes, path.relative_to(ROOT).parts[:-1])),
        set(own_names(nodes)),
        list(private_attributes(nodes)),
        list(texts(nodes)),
        list(at_root(nodes)),
    )


def imports_of(path: Path) -> list[tuple[int, str]]:
    return said(path).imports


def is_private(name: str) -> bool:
    return name.startswith("_") and not (name.startswith("__") and name.endswith("__"))


def own_names(nodes: Iterable[ast.AST]) -> Iterator[str]:
    """Names that a module defines itself: functions, classes, variables, fields, attributes of self."""
    for node in nodes:
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            yield node.name
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store) and is_self(node.value):
            yield node.attr


@functools.cache
def all_own_names() -> set[str]:
    return {name for path in sources(*sorted(OWN)) for name in said(path).own}


def is_self(node: ast.expr) -> bool:
    return isinstance(node, ast.Name) and node.id in ("self", "cls")


def texts(nodes: Iterable[ast.AST]) -> Iterator[tuple[int, str]]:
    """Line and text of each string that is a statement."""
    for node in nodes:
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            yield node.lineno, node.value.value


def at_root(nodes: Iterable[ast.AST]) -> Iterator[tuple[int, str]]:
    """Line and name of each `ROOT / "name"`."""
    for node in nodes:
        match node:
            case ast.BinOp(left=ast.Name(id="ROOT"), right=ast.Constant(value=str(name))):
                yield node.lineno, name


def private_attributes(nodes: Iterable[ast.AST]) -> Iterator[tuple[int, str]]:
    """Line and name of each `x._name`, but of `self._name`."""
    attributes = (node for node in nodes if isinstance(node, ast.Attribute))
    for node in attributes:
        if is_private(node.attr) and not is_self(node.value) and node.attr not in PUBLIC_ALL_THE_SAME:
            yield node.lineno, node.attr


def foreign(attributes: list[tuple[int, str]], own: set[str]) -> list[tuple[int, str]]:
    """Those that no module of ours defines."""
    return [(line, name) for line, name in attributes if name not in own]


def uses_viser_internals(module: str) -> bool:
    first, *rest = module.split(".")
    return first == "viser" and (rest[:1] == ["infra"] or any(map(is_private, rest)))


def test_geometry_imports_only_numpy_scipy_and_the_standard_library() -> None:
    allowed = GEOMETRY_ALLOWED - INPUT_OUTPUT
    wrong = [
        f"{name_of(path)}:{line} {module}"
        for path in sources("geometry")
        for line, module in imports_of(path)
        if module.split(".")[0] not in allowed
    ]
    assert not wrong, f"geometry may import NumPy, SciPy and the standard library without input or output: {wrong}"


@pytest.mark.parametrize("package", FORBIDDEN)
def test_imports_point_one_way(package: str) -> None:
    wrong = [
        f"{name_of(path)}:{line} {module}"
        for path in sources(package)
        for line, module in imports_of(path)
        if module.split(".")[0] in FORBIDDEN[package]
    ]
    assert not wrong, f"{package} may not import {sorted(FORBIDDEN[package])}: {wrong}"


@pytest.mark.parametrize("folder", sorted(OWN))
def test_private_names_of_viser_stay_in_one_module(folder: str) -> None:
    wrong = []
    for path in sources(folder):
        modules = [(line, module) for line, module in imports_of(path) if uses_viser_internals(module)]
        found = modules + foreign(said(path).private, all_own_names())
        if name_of(path) not in MAY_USE_PRIVATE_NAMES:
            wrong += [f"{name_of(path)}:{line} {name}" for line, name in found]
    assert not wrong, f"private names, which only sims/kit/viser_internals.py may use: {wrong}"


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
    assert [module for _, module in imports(ast.walk(ast.parse(source)), ("sims", "kit"))] == expected


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
    assert foreign(list(private_attributes(ast.walk(tree))), {"_mine"}) == [(1, "_impl"), (6, "_client")]
