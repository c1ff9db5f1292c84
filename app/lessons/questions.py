"""The boxes in which a learner answers: predictions, whose answers the sim's mathematics gives, and checks."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any, NamedTuple

from markdown_it.token import Token

from app.lessons.state import State

NUMBER = r"\d+(?:\.\d+)?"
PREDICT = re.compile(
    rf"predict (?P<path>\S+)(?P<set> set)?(?: within (?P<within>{NUMBER}))?"
    r"(?: at (?P<at>\?\S*)| from (?P<before>\?\S*) to (?P<to>\?\S*))"
)
WRITTEN = (
    "::: predict path at ?state, ::: predict path within 0.5 at ?state, ::: predict path set within 0.5 at ?state, "
    "or ::: predict path from ?state to ?state"
)
CLOSE = 1e-6
"""How near a choice's number must be to the computed one, of its size."""


class Item(NamedTuple):
    """One of a box's choices: what it is, where it stands for a value, and why somebody picks it."""

    value: str
    words: list[Token]
    why: list[Token]
    right: bool | None


class Box(NamedTuple):
    """What stands in a box: the question, the choices, and what follows a line across."""

    question: list[Token]
    items: list[Item]
    answer: list[Token]


def opened(tokens: Sequence[Token]) -> Box:
    """A box's tokens by what they are."""
    rule = next(
        (k for k, token in enumerate(tokens) if token.type == "hr" and token.level == tokens[0].level), len(tokens)
    )
    asked, answer = list(tokens[:rule]), list(tokens[rule + 1 :])
    start = next((k for k, token in enumerate(asked) if token.type == "bullet_list_open"), None)
    if start is None:
        return Box(asked, [], answer)
    end = max(k for k, token in enumerate(asked) if token.type == "bullet_list_close")
    return Box(asked[:start] + asked[end + 1 :], _items(asked[start + 1 : end]), answer)


def _items(tokens: Sequence[Token]) -> list[Item]:
    """The entries of a list; of each, the first line is the choice and the rest the reason."""
    found = []
    for token in tokens:
        if token.type == "inline" and token.children is not None:
            found.append(_item(token.children))
    return found


def _item(children: list[Token]) -> Item:
    cut = next((k for k, each in enumerate(children) if each.type == "softbreak"), len(children))
    words, why = children[:cut], children[cut + 1 :]
    right = None
    if words and words[0].type == "text" and (mark := re.match(r"\[([ xX])\]\s*", words[0].content)):
        right = mark[1] in "xX"
        words = [words[0].copy(content=words[0].content[mark.end() :]), *words[1:]]
    value = ""
    if words and (
        words[0].type == "code_inline" or (len(words) > 1 and not words[0].content and words[1].type == "code_inline")
    ):
        at = 0 if words[0].type == "code_inline" else 1
        value, rest = words[at].content, words[at + 1 :]
        words = rest if any(each.content.strip() for each in rest) else [Token("text", "", 0, content=value)]
    return Item(value or "".join(each.content for each in words).strip(), words, why, right)


def changed(before: Any, after: Any) -> str:
    """What became of a number between two states."""
    if not all(isinstance(each, (int, float)) for each in (before, after)):
        raise LookupError("a number in both states")
    if math.isclose(before, after, rel_tol=CLOSE, abs_tol=1e-9):
        return "same"
    return "larger" if after > before else "smaller"


def fits(text: str, value: Any) -> bool:
    """Whether a choice says a computed value: a number, yes or no, none, or a word."""
    if value is None or isinstance(value, bool):
        return text.lower() == {None: "none", True: "yes", False: "no"}[value]
    if isinstance(value, (int, float)):
        number = re.match(r"[−-]?\d+(?:\.\d+)?", text)
        return number is not None and _close(float(number[0].replace("−", "-")), value, number[0])
    return text.lower() == str(value).lower()


def _close(written: float, value: float, text: str) -> bool:
    """As near as the digits that are written."""
    _, _, decimals = text.partition(".")
    return (
        abs(written - value) <= 0.5 * 10.0 ** -len(decimals) + CLOSE
        if decimals
        else abs(written - value) <= 0.5 + CLOSE
    )


def answer(path: str, to: State, before: State | None) -> Any:
    """What a prediction is compared with: a value, or what becomes of it between two states. Raises LookupError."""
    value = to.value(path)
    return value if before is None else changed(before.value(path), value)
