"""How a lesson is written: Markdown with formulas, live numbers and boxes, and nothing else that does something.

What a teacher writes is text: HTML in it is shown as it stands, and pictures aren't taken from elsewhere.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

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
CLOSED = ":::"


@dataclass
class Written:
    """A file taken apart: the lines at its head, where each of these stands, and what follows."""

    head: dict[str, str]
    tokens: list[Token]
    mistakes: list[Mistake] = field(default_factory=list)
    lines: dict[str, int] = field(default_factory=dict)


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
    md.validateLink = _refused_in_words  # type: ignore[method-assign]
    return md


def _refused_in_words(url: str) -> bool:
    """Whether a link is one: each of them is looked at later."""
    return True


def written(md: MarkdownIt, text: str) -> Written:
    """Take a file apart; what is no box though it looks like one is a mistake, as is a box that isn't closed."""
    tokens = md.parse(text)
    found = Written({}, [token for token in tokens if token.type != "front_matter"])
    for token in tokens:
        if token.type == "front_matter":
            _head(token.content, found)
        elif token.type == "inline":
            _place(token)
    found.mistakes += [*_no_boxes(tokens), *_left_open(tokens, text.splitlines()), *_no_headings(tokens)]
    return found


def _no_boxes(tokens: Sequence[Token]) -> Iterator[Mistake]:
    boxes = ", ".join(f"::: {name}" for name in BOXES)
    for token in tokens:
        if token.type == "inline" and token.content.startswith(CLOSED):
            yield Mistake(line(token), token.content.partition("\n")[0], f"one of {boxes}, closed by :::")


def _left_open(tokens: Sequence[Token], lines: Sequence[str]) -> Iterator[Mistake]:
    """Boxes that end with the file, or hold another box or a heading: somebody has forgotten to close them."""
    around: list[Token] = []
    for token in tokens:
        if token.type.startswith("container_") and token.nesting == 1:
            assert token.map is not None
            end = lines[token.map[1]].strip() if token.map[1] < len(lines) else ""
            if not end.startswith(CLOSED):
                yield _open(token, "the end of the file")
            if around:
                yield _open(around[-1], f"::: {token.info.strip()} in line {line(token)}")
            around.append(token)
        elif token.type.startswith("container_"):
            around.pop()
        elif token.type == "heading_open" and token.tag == "h2" and token.markup == "##" and around:
            yield _open(around[-1], f"the heading in line {line(token)}")


def _open(token: Token, before: str) -> Mistake:
    return Mistake(line(token), f"::: {token.info.strip()} isn't closed before {before}", "a line of ::: at its end")


def _no_headings(tokens: Sequence[Token]) -> Iterator[Mistake]:
    for token in tokens:
        if token.type == "heading_open" and token.markup in ("-", "="):
            marks = token.markup * 3
            yield Mistake(line(token), f"a text directly above a line of {marks}", "an empty line between the two")
        elif token.type == "heading_open" and token.tag == "h1":
            yield Mistake(line(token), "a heading with one #", "## and ###; the title stands at the head of the file")


def _place(inline: Token) -> None:
    """Each piece of a text is told its line."""
    at = line(inline)
    for child in inline.children or ():
        child.meta = {**child.meta, "line": at}
        at += child.type in ("softbreak", "hardbreak") or child.content.count("\n")


def _head(text: str, found: Written) -> None:
    for k, each in enumerate(text.splitlines(), 2):
        if not each.strip():
            continue
        if (pair := HEADED.fullmatch(each)) is None or pair[1] in found.head:
            allowed = "lines of a name, a colon and a text, as in title: Three rings; each name once"
            found.mistakes.append(Mistake(k, each, allowed))
        else:
            found.head[pair[1]] = pair[2].strip()
            found.lines[pair[1]] = k


def line(token: Token) -> int:
    """Where a token begins, from 1."""
    return token.map[0] + 1 if token.map else int(token.meta.get("line", 1))


def words(token: Token, said: Callable[[Token], str] = lambda token: token.content) -> str:
    """The plain text of an inline token; `said` tells that of each of its pieces."""
    breaks = ("softbreak", "hardbreak")
    return "".join(" " if each.type in breaks else said(each) for each in token.children or ()).strip()
