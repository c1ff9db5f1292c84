"""Formulas of lessons: what points, and how matrices are bracketed."""

from __future__ import annotations

import re

from app.lessons.formula import mathml


def made(latex: str) -> str:
    return mathml(latex, block=False, live=lambda path: f"<mn>{path}</mn>")


def test_a_symbol_that_points_does_not_take_along_what_follows() -> None:
    found = made(r"\point{yaw}{\psi} + \phi")
    pointing = re.search(r'<mstyle data-point="yaw">(.*?)</mstyle>', found)
    assert pointing
    assert "&#x003C8;" in pointing[1] or "ψ" in pointing[1]
    assert "&#x003D5;" not in pointing[1]
    assert "ϕ" not in pointing[1]


def test_a_matrix_has_brackets_on_machines_without_a_mathematical_font() -> None:
    for kind in ("pmatrix", "bmatrix"):
        found = made(rf"\begin{{{kind}}} {{value:R.0.0}} \\ 0 \end{{{kind}}}")
        assert found.count('<mtable class="matrix">') == 1
        assert "<mn>R.0.0</mn>" in found
        assert not re.search(r"&#x00028;|&#x0005B;|[(\[]", found)
