"""How a lesson is written: Markdown with formulas, live numbers and boxes, and nothing else that does something.

What a teacher writes is text: HTML in it is shown as it stands, and pictures aren't taken from elsewhere.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

from markdown_it import MarkdownIt
from markdown_it.rules_inline import StateInline
from markdown_it.token import Token
from mdit_py_plugins.container import container_plugin
from mdit_py_plugins.dollarmath import dollarmath_plugin
from mdit_py_plugins.front_matter import front_matter_plugin

from app.lessons.errors import Mistake

BOXES = ("predict", "challenge", "check", "teacher")
"""Names of what may stand between `:::` and `:::`."""
LIVE = re.compile(r"\{(value|drag|concept):([^{}\s]+?)\}")
"""A number of the state in the text, one that is dragged there, or the place where a concept is learnt."""
HEADED = re.compile(r"(\w+):\s*(.*)")


@dataclass
class Written:
    """A file taken apart: the lines at its head, and what follows."""

    head: dict[str, str]
    tokens: list[Token]
    mistakes: list[Mistake] = field(default_factory=list)


def _live(state: StateInline, silent: bool) -> bool:
    """Markdown's rule for {kind:what}."""
    found = LIVE.match(state.src, state.pos)
    if found is None:
        return False
    if not silent:
        token = state.push("live", "", 0)
        token.meta = {"kind": found[1], "what": found[2]}
    state.pos = found.end()
    return True


def parser() -> MarkdownIt:
    """The Markdown of lessons."""
    md = MarkdownIt("commonmark", {"html": False}).enable("table").disable("image")
    md.use(front_matter_plugin).use(dollarmath_plugin, double_inline=True)
    for name in BOXES:
        md.use(container_plugin, name, validate=lambda info, *_, name=name: info.split()[:1] == [name])
    md.inline.ruler.before("link", "live", _live)
    return md


def written(md: MarkdownIt, text: str) -> Written:
    """Take a file apart; what is no box though it looks like one is a mistake."""
    tokens = md.parse(text)
    found = Written({}, [token for token in tokens if token.type != "front_matter"])
    for token in tokens:
        if token.type == "front_matter":
            _head(token.content, found)
        elif token.type == "inline" and token.content.startswith(":::"):
            boxes = ", ".join(f"::: {name}" for name in BOXES)
            found.mistakes.append(
                Mistake(line(token), token.content.partition("\n")[0], f"one of {boxes}, closed by :::")
            )
    return found


def _head(text: str, found: Written) -> None:
    for k, each in enumerate(text.splitlines(), 2):
        if not each.strip():
            continue
        if (pair := HEADED.fullmatch(each)) is None:
            found.mistakes.append(Mistake(k, each, "lines of a name, a colon and a text, as in title: Three rings"))
        else:
            found.head[pair[1]] = pair[2].strip()


def line(token: Token) -> int:
    """Where a token begins, from 1."""
    return token.map[0] + 1 if token.map else 1


def words(token: Token) -> str:
    """The plain text of an inline token."""
    return "".join(_said(each) for each in token.children or ()).strip()


def _said(token: Token) -> str:
    said: dict[str, Any] = {"softbreak": " ", "hardbreak": " "}
    return str(said.get(token.type, token.content))
