"""Checks of the HTML that a sim makes: well-formed, and only numbers that a person should see."""

from __future__ import annotations

import functools
import re
from html.parser import HTMLParser
from xml.etree import ElementTree

VOID = {"br", "hr", "img", "input", "link", "meta", "wbr"}
CLOSED_VOID = re.compile(rf"</({'|'.join(VOID)})\b")
NO_NUMBER = re.compile(r"\b(nan|inf|none|null|undefined)\b", re.IGNORECASE)
NEGATIVE_ZERO = re.compile(r"[-−]0(\.0+)?(?![\d.])")
HYPHEN_MINUS = re.compile(r"(?<![\w\d])-\d")


@functools.lru_cache(8)  # several checks look at the same
def xml(html: str) -> ElementTree.Element:
    """Parse it as XML; raises ParseError where it isn't well-formed. For reading only: others get the same."""
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
    found = [
        (element.tag, name, value)
        for element in xml(html).iter()
        for name, value in element.attrib.items()
        if name not in ("class", "fill")
    ]
    if not NO_NUMBER.search("\n".join(value for _, _, value in found)):
        return []
    return [f"{tag} {name}={value!r}" for tag, name, value in found if NO_NUMBER.search(value)]


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
    return [] if _sound(html) else _told(html)


def _sound(html: str) -> bool:
    """Whether there are none: told by a parser of XML, which is much faster than one of HTML."""
    try:
        ids = [each for element in xml(html).iter() if (each := element.get("id"))]
    except ElementTree.ParseError:
        return False
    return len(set(ids)) == len(ids) and not CLOSED_VOID.search(html)


def _told(html: str) -> list[str]:
    nesting = _Nesting()
    nesting.feed(html)
    nesting.close()
    twice = sorted({i for i in nesting.ids if nesting.ids.count(i) > 1})
    return [*nesting.wrong, *(f"<{t}> stays open" for t in nesting.open), *(f"id {i} twice" for i in twice)]
