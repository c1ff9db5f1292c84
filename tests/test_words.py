"""The words of the house: docstrings say what a thing is."""

from __future__ import annotations

import ast

import pytest

from tests.server import ROOT


@pytest.mark.parametrize("folder", ["geometry", "sims", "app", "tests", "benchmarks"])
def test_no_docstring_begins_with_of(folder: str) -> None:
    found = [
        f"{path.relative_to(ROOT)}:{node.lineno}"
        for path in sorted((ROOT / folder).rglob("*.py"))
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        if isinstance(node.value.value, str) and node.value.value.lstrip().startswith("Of ")
    ]
    assert not found
