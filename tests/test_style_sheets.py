"""The style sheets keep to CSS: no rule or declaration that a browser would drop, and no variable that nobody sets."""

from __future__ import annotations

import functools
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import tinycss2

ROOT = Path(__file__).resolve().parents[1]
SHEETS = sorted((ROOT / "static").glob("*.css"))
GROUPS = {"media", "container", "supports", "layer"}
"""At-rules that hold rules, not declarations."""
each_sheet = pytest.mark.parametrize("sheet", SHEETS, ids=lambda path: path.name)


def blocks(rules: list[Any]) -> Iterator[list[Any]]:
    """What stands between the braces of each rule, parsed, also within @media and the like; and errors before them."""
    for rule in rules:
        if rule.type == "error":
            yield [rule]
            continue
        yield [x for x in rule.prelude if x.type == "error"]
        if rule.type == "at-rule" and rule.lower_at_keyword in GROUPS:
            yield from blocks(tinycss2.parse_rule_list(rule.content, skip_comments=True, skip_whitespace=True))
        elif rule.content is not None:
            yield tinycss2.parse_blocks_contents(rule.content, skip_comments=True, skip_whitespace=True)


@functools.cache
def parsed(sheet: Path) -> list[list[Any]]:
    text = sheet.read_text(encoding="utf-8")
    return list(blocks(tinycss2.parse_stylesheet(text, skip_comments=True, skip_whitespace=True)))


@each_sheet
def test_no_rule_is_broken(sheet: Path) -> None:
    wrong = [x for block in parsed(sheet) for x in block if x.type == "error"]
    assert not [f"{sheet.name}:{x.source_line}: {x.message}" for x in wrong]


@each_sheet
def test_no_rule_says_a_property_twice(sheet: Path) -> None:
    for block in parsed(sheet):
        names = Counter(x.name for x in block if x.type == "declaration")
        assert not [f"{sheet.name}:{block[0].source_line}: {name}" for name, n in names.items() if n > 1]


@each_sheet
def test_a_selector_has_one_rule(sheet: Path) -> None:
    """Two things of one name would take each other's looks."""
    text = sheet.read_text(encoding="utf-8")
    rules = tinycss2.parse_stylesheet(text, skip_comments=True, skip_whitespace=True)
    selectors = Counter(tinycss2.serialize(rule.prelude).strip() for rule in rules if rule.type == "qualified-rule")
    assert not [selector for selector, n in selectors.items() if n > 1]


@each_sheet
def test_every_variable_is_set_somewhere(sheet: Path) -> None:
    scripts = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "static").rglob("*.js"))
    known = {x.name for path in SHEETS for block in parsed(path) for x in block if x.type == "declaration"}
    known |= set(re.findall(r'setProperty\("(--[\w-]+)"', scripts))
    used = set(re.findall(r"var\((--[\w-]+)", sheet.read_text(encoding="utf-8")))
    assert not used - known
