"""Writes a lesson's HTML, and finds what is wrong with it on the way."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Sequence
from html import escape, unescape
from itertools import pairwise
from typing import NamedTuple, cast
from urllib.parse import unquote

from markdown_it import MarkdownIt
from markdown_it.renderer import RendererHTML
from markdown_it.token import Token

from app.lessons import boxes, formula
from app.lessons.boxes import Hand, Wrong
from app.lessons.concepts import CONCEPTS
from app.lessons.dialect import LIVE, line, words
from app.lessons.errors import Mistake
from app.lessons.state import AnySim, State, named, setting, shown, solved
from sims.kit.sim import Library

SENTENCE = re.compile(r".+?[.!?:](?=\s|$)")
FORMULA = re.compile(r'\(?<math [^>]*display="inline".*?</math>[,.;:!?)…”’]*', re.DOTALL)
"""One in a sentence, with the marks that belong to it."""
OUTSIDE = ("https://", "http://", "mailto:")


class Step(NamedTuple):
    """A place in the text with a state of the sim."""

    number: int
    """Its place among the steps, from 1."""
    id: str
    title: str
    state: State
    words: str
    """Its first sentence, as plain text."""
    challenges: tuple[str, ...]
    """Those that stand in it, by their ids."""


class Section(NamedTuple):
    """What stands below one heading (none for what comes before the first), as HTML."""

    id: str
    title: str
    html: str
    step: Step | None = None


Links = Callable[[str], None]
"""Looks at a link to another page of this server. Raises LookupError in words."""


class Writer:
    """Makes the sections of one lesson; what is wrong is added to `mistakes`."""

    def __init__(
        self, md: MarkdownIt, sim: AnySim, library: tuple[Library, ...], mistakes: list[Mistake], links: Links
    ) -> None:
        self._md = md
        self._links = links
        self._renderer = cast(RendererHTML, md.renderer)
        self.sim = sim
        self._library = library
        self.mistakes = mistakes
        self._states = {"": named(sim, "", library)}
        """Those that queries name: each is solved once, when something of it is asked for."""
        self._state = self._states[""]
        self._live = True
        """Whether numbers move with the sim."""
        self._line = 1
        self._ids: set[str] = set()
        self._parts: list[tuple[int, str]] = []  # lines and targets of links to a part of this lesson
        self._challenges: list[str] = []
        self._steps = 0
        self.teacher = ""
        self.concepts: list[str] = []
        rules: dict[str, Callable[[Token], str]] = {
            "live": self._of_sim, "link_open": self._link, "math_inline": self._math, "math_inline_double": self._math,
            "math_block": self._math, "math_block_label": self._math,
        }  # fmt: skip
        for name, rule in rules.items():
            md.add_render_rule(name, lambda _, tokens, k, *__, rule=rule: rule(tokens[k]))

    def sections(self, tokens: Sequence[Token]) -> Iterator[Section]:
        """The parts of a lesson by their headings; a heading that is a link to a state begins a step."""
        starts = _headings(tokens)
        if before := tokens[: starts[0] if starts else len(tokens)]:
            yield Section("start", "", self._blocks(before))
        for k, end in pairwise([*starts, len(tokens)]):
            yield self._section(tokens[k + 1], tokens[k + 3 : end])
        self._find_parts()

    def _find_parts(self) -> None:
        """Links to a part of this lesson lead to one that is there."""
        for line_, part in self._parts:
            if part not in self._ids:
                self._line = line_
                self._wrong(f"a link to #{part}", "one of " + ", ".join(f"#{each}" for each in sorted(self._ids)))

    def _section(self, heading: Token, body: Sequence[Token]) -> Section:
        self._line = line(heading)
        title = words(heading)
        slug = self._id(title)
        if (query := _query(heading)) is None:
            return Section(slug, title, self._blocks(body))
        if (state := self._read(query)) is None:
            return Section(slug, title, "")
        self._state = state
        before, wrong = len(self._challenges), len(self.mistakes)
        html = self._blocks(body)
        said = self._sentence(body) if len(self.mistakes) == wrong else ""  # what is wrong in it has been said
        self._steps += 1
        step = Step(self._steps, slug, title, state, said, tuple(self._challenges[before:]))
        return Section(slug, title, html, step)

    def _sentence(self, body: Sequence[Token]) -> str:
        """The first sentence, as plain text with the numbers of the state."""
        first = next((words(token, self._said) for token in body if token.type == "inline"), "")
        said = SENTENCE.match(first)
        return said[0] if said else first

    def _said(self, token: Token) -> str:
        if token.type == "math_inline":
            made = formula.mathml(token.content, block=False, live=lambda what: self._value(what, "mn"))
            return unescape(re.sub(r"<[^>]*>", "", made))
        if token.type != "live":
            return token.content
        kind, what = token.meta["kind"], token.meta["what"]
        if kind == "concept":
            return _named(what)
        number = shown(self.sim, what)
        return number.text(self._state.value(number.path))

    def _id(self, title: str) -> str:
        slug = re.sub(r"[^a-z0-9]+", "-", title.lower()).strip("-") or "part"
        while slug in self._ids:
            slug += "-2"
        self._ids.add(slug)
        return slug

    # ---- blocks

    def _blocks(self, tokens: Sequence[Token]) -> str:
        """Blocks in their order; boxes are made by those who know them."""
        html, k = "", 0
        while k < len(tokens):
            token = tokens[k]
            self._line = line(token) if token.map else self._line
            if not token.type.startswith("container_"):
                end = next((i for i in range(k, len(tokens)) if tokens[i].type.startswith("container_")), len(tokens))
                html += self._plain(tokens[k:end])
                k = end
                continue
            end = next(
                i
                for i in range(k, len(tokens))
                if tokens[i].type == token.type[:-4] + "close" and tokens[i].level == token.level
            )
            html += self._box(token, list(tokens[k + 1 : end]))
            k = end + 1
        return html

    def _plain(self, tokens: Sequence[Token]) -> str:
        html = ""
        for run in _by_line(tokens):
            self._line = next((line(token) for token in run if token.map), self._line)
            html += _together(str(self._renderer.render(list(run), self._md.options, {})))
        return html

    def _inline(self, tokens: Sequence[Token]) -> str:
        return _together(str(self._renderer.renderInline(list(tokens), self._md.options, {})))

    def _box(self, token: Token, inside: list[Token]) -> str:
        self._line = line(token)
        info = token.info.strip()
        kind, *_ = info.split()
        if kind == "teacher":
            self.teacher += self._blocks(inside)
            return ""
        hand = Hand(self._plain, self._inline, self._state_of, self._said_of)
        try:
            if kind == "predict":
                return boxes.predict(self.sim, info, inside, hand)
            if kind == "check":
                return boxes.check(inside, hand)
            html = boxes.challenge(self.sim.challenges, info, inside, hand)
        except Wrong as wrong:
            return self._wrong(wrong.found, wrong.allowed)
        name = info.split()[1]
        if name in self._challenges:
            return self._wrong(f"::: {info}", "each challenge once")
        self._challenges.append(name)
        self._ids.add(f"challenge-{name}")
        return html

    def _said_of(self, state: State, tokens: Sequence[Token]) -> str:
        before, self._state, self._live = self._state, state, False
        try:
            return self._plain(tokens)
        finally:
            self._state, self._live = before, True

    def _state_of(self, query: str) -> State:
        try:
            asked = query.removeprefix("?")
            if asked not in self._states:
                self._states[asked] = named(self.sim, asked, self._library)
            return solved(self._states[asked])
        except LookupError as error:
            raise Wrong(f"the state {query}", str(error.args[0])) from None

    # ---- what stands in the text

    def _of_sim(self, token: Token) -> str:
        kinds: dict[str, Callable[[str], str]] = {"value": self._value, "drag": self._drag, "concept": self._concept}
        self._line = line(token)
        return kinds[token.meta["kind"]](token.meta["what"])

    def _value(self, what: str, tag: str = "span") -> str:
        try:
            value = shown(self.sim, what)
            return value.html(self._state.value(value.path), tag, live=self._live)
        except LookupError as error:
            return self._wrong(f"{{value:{what}}}", str(error.args[0]))

    def _drag(self, name: str) -> str:
        held = self._state.numbers.get(name)
        if held is None:
            return self._wrong(f"{{drag:{name}}}", "one of " + ", ".join(self._state.numbers))
        low, high = held.bounds
        return (
            f'<span class="drag"><input type="text" inputmode="decimal" role="spinbutton" size="1" '
            f'value="{held.value:g}" autocomplete="off" data-drag="{name}" data-step="{held.step:g}" '
            f'aria-valuemin="{low:g}" aria-valuemax="{high:g}" aria-valuenow="{held.value:g}" '
            f'aria-label="{escape(held.label)}">{escape(held.unit)}<span role="alert"></span></span>'
        )

    def _concept(self, what: str) -> str:
        slug = what.partition(":")[0]
        if slug not in CONCEPTS:
            return self._wrong(f"{{concept:{what}}}", "one of " + ", ".join(CONCEPTS))
        if slug in self.concepts:
            return self._wrong(f"{{concept:{what}}}", "each concept once")
        self.concepts.append(slug)
        self._ids.add(f"concept-{slug}")
        return f'<dfn id="concept-{slug}">{escape(_named(what))}</dfn>'

    def _math(self, token: Token) -> str:
        block = token.type != "math_inline"
        self._line = line(token)
        try:
            made = formula.mathml(token.content, block=block, live=lambda what: self._value(what, "mn"))
        except ValueError as error:
            return self._wrong(str(error), "LaTeX that stands in a formula of a textbook, and {value:…}")
        for name in formula.points(token.content):
            if name not in self._state.linked:
                self._wrong(f"\\point{{{name}}}", "one of " + ", ".join(sorted(self._state.linked)))
        return made

    def _link(self, token: Token) -> str:
        href = unquote(str(token.attrs["href"]))
        self._line = line(token)
        if href.startswith("?"):
            state = self._read(href)
            set_ = "" if state is None else escape(json.dumps(setting(state)))
            return f'<a href="{escape(href)}" data-set="{set_}">'
        live = f' data-href="{escape(href)}"' if LIVE.search(href) else ""
        href = LIVE.sub(lambda found: self._spelled(found[2]), href)
        if href.startswith("/"):
            return self._inside(href, live)
        if href.startswith("#"):
            self._parts.append((self._line, href[1:]))
            return f'<a href="{escape(href)}">'
        if not href.startswith(OUTSIDE):
            return self._wrong(f"a link to {href}", "?state, /sims/…, /concepts/…, #part, or https://…")
        return f'<a href="{escape(href)}" rel="noreferrer">'

    def _inside(self, href: str, live: str) -> str:
        """A link to another page of this server."""
        try:
            self._links(href)
        except LookupError as error:
            return self._wrong(f"a link to {href}", str(error.args[0]))
        return f'<a href="..{escape(href)}"{live.replace("/", "../", 1)}>'

    def _spelled(self, what: str) -> str:
        """A value as it stands in a link."""
        try:
            value = shown(self.sim, what)
            found = self._state.value(value.path)
        except LookupError as error:
            return self._wrong(f"{{value:{what}}}", str(error.args[0]))
        numbers = found if isinstance(found, list) else [found]
        if not all(isinstance(each, int | float) for each in numbers):
            return self._wrong(f"{{value:{what}}} in a link", "a number, or a list of numbers")
        return ",".join(f"{each:.{value.digits or 6}g}" for each in numbers)

    # ---- what is wrong

    def _read(self, query: str) -> State | None:
        try:
            return self._state_of(query)
        except Wrong as wrong:
            self._wrong(wrong.found, wrong.allowed)
            return None

    def _wrong(self, found: str, allowed: str) -> str:
        self.mistakes.append(Mistake(self._line, found, allowed))
        return ""


def _together(html: str) -> str:
    """No line ends between a formula and the comma after it: browsers would end one there."""

    def held(found: re.Match[str]) -> str:
        alone = found[0].startswith("<") and found[0].endswith(">")
        return found[0] if alone else f'<span class="together">{found[0]}</span>'

    return FORMULA.sub(held, html)


def queries(tokens: Sequence[Token]) -> list[str]:
    """What names the states of a lesson's steps, before any is looked at."""
    return [query for k in _headings(tokens) if (query := _query(tokens[k + 1])) is not None]


def _headings(tokens: Sequence[Token]) -> list[int]:
    """Where the headings begin that part a lesson."""
    return [
        k for k, token in enumerate(tokens) if token.type == "heading_open" and token.tag == "h2" and not token.level
    ]


def _query(heading: Token) -> str | None:
    """The state that a step's heading is a link to; none where the heading is no step's."""
    link = next((each for each in heading.children or () if each.type == "link_open"), None)
    return None if link is None else unquote(str(link.attrs["href"]))


def _named(concept: str) -> str:
    """What a text calls a concept, as in {concept:quaternion:unit_quaternion}."""
    slug, _, said = concept.partition(":")
    return said.replace("_", " ") or CONCEPTS.get(slug, "")


def _by_line(tokens: Sequence[Token]) -> Iterator[Sequence[Token]]:
    """Blocks one by one, so that what is wrong in one is said with its line."""
    start = 0
    for k, token in enumerate(tokens):
        if (token.level == 0 and token.nesting <= 0) or (k + 1 == len(tokens)):
            yield tokens[start : k + 1]
            start = k + 1
