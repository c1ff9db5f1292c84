"""Checks of the HTML that a sim makes: well-formed, and only numbers that a person should see."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from xml.etree import ElementTree

VOID = {"br", "hr", "img", "input", "link", "meta", "wbr"}
NO_NUMBER = re.compile(r"\b(nan|inf|none|null|undefined)\b", re.IGNORECASE)
NEGATIVE_ZERO = re.compile(r"[-−]0(\.0+)?(?![\d.])")
HYPHEN_MINUS = re.compile(r"(?<![\w\d])-\d")


def xml(html: str) -> ElementTree.Element:
    """Parse it as XML; raises ParseError where it isn't well-formed."""
    return ElementTree.fromstring(f"<all>{html}</all>")


def words(html: str) -> str:
    """What a person reads of it, one space between pieces."""
    return " ".join(" ".join(xml(html).itertext()).split())


def without_code(html: str) -> str:
    """What is there for people: code to be copied is for programs."""
    return re.sub(r"<code>.*?</code>", "", html)


def bad_numbers(text: str) -> list[str]:
    """What stands in a text for people that isn't a number for people."""
    found = [pattern.search(text) for pattern in (NO_NUMBER, NEGATIVE_ZERO, HYPHEN_MINUS)]
    return [text[max(m.start() - 20, 0) : m.end() + 20] for m in found if m]


def bad_attributes(html: str) -> list[str]:
    """Attributes that hold a number which isn't one."""
    return [
        f"{element.tag} {name}={value!r}"
        for element in xml(html).iter()
        for name, value in element.attrib.items()
        if NO_NUMBER.search(value) and name not in ("class", "fill")
    ]


class _Nesting(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.ids: list[str] = []
        self.wrong: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.ids += [value for name, value in attrs if name == "id" and value]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.ids += [value for name, value in attrs if name == "id" and value]

    def handle_endtag(self, tag: str) -> None:
        if not self.open or self.open.pop() != tag:
            self.wrong.append(f"</{tag}> closes nothing")


def mistakes(html: str) -> list[str]:
    """Tags that aren't closed or closed twice, ids given twice."""
    nesting = _Nesting()
    nesting.feed(html)
    nesting.close()
    twice = sorted({i for i in nesting.ids if nesting.ids.count(i) > 1})
    return [*nesting.wrong, *(f"<{t}> stays open" for t in nesting.open), *(f"id {i} twice" for i in twice)]
