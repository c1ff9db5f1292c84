"""The words of the house: docstrings say what a thing is."""

from __future__ import annotations

import pytest

from tests.test_imports import name_of, said, sources


@pytest.mark.parametrize("folder", ["geometry", "sims", "app", "tests", "benchmarks"])
def test_no_docstring_begins_with_of(folder: str) -> None:
    found = [
        f"{name_of(path)}:{line}"
        for path in sources(folder)
        for line, text in said(path).texts
        if text.lstrip().startswith("Of ")
    ]
    assert not found
