"""Writes the boxes in which a learner answers."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from html import escape
from typing import Any, NamedTuple

from markdown_it.token import Token

from app.lessons import questions
from app.lessons.state import AnySim, State, setting, shown
from sims.kit.challenge import Challenge

# A form by the method "dialog" leads nowhere, before the page's script has come and without it.
NBSP = "\u00a0"
"""Keeps the line on which it is said how near one is."""
COMMIT = '<button class="button" type="submit">That is my prediction</button>'


class Hand(NamedTuple):
    """What writes the text in a box."""

    blocks: Callable[[Sequence[Token]], str]
    inline: Callable[[Sequence[Token]], str]
    read: Callable[[str], State]
    """The state that a query names."""
    said_of: Callable[[State, Sequence[Token]], str]
    """Blocks whose numbers are those of a state, wherever the sim goes."""


class Wrong(Exception):
    """Something can't be: what was found, and what is allowed."""

    def __init__(self, found: str, allowed: str) -> None:
        super().__init__(found)
        self.found = found
        self.allowed = allowed


def predict(sim: AnySim, info: str, inside: Sequence[Token], hand: Hand) -> str:
    """A question whose answer is worked out from a state, or from two. Raises Wrong."""
    _not_empty(info, inside)
    found = questions.PREDICT.fullmatch(info)
    if found is None:
        raise Wrong(f"::: {info}", questions.WRITTEN)
    to, before = hand.read(found["at"] or found["to"]), hand.read(found["before"]) if found["before"] else None
    try:
        answer = questions.answer(found["path"], to, before)
    except LookupError as error:
        raise Wrong(found["path"], error.args[0]) from None
    box = questions.opened(inside)
    if not box.answer:
        raise Wrong("a prediction without its why", "after the question a line of --- and why it is so")
    kind = "set" if found["set"] else "number" if found["within"] else "choice"
    if kind == "choice":
        _one_fits(box.items, answer)
    elif isinstance(answer, bool) or not isinstance(answer, int | float):
        raise Wrong(f"{found['path']}, which is {answer!r}", "a number, where one is typed or set")
    within = float(found["within"] or 0)
    data = {
        "kind": kind, "path": found["path"], "within": within, "answer": answer,
        "said": "" if kind == "choice" else _said(sim, found["path"], answer, within),
        "to": setting(to), "from": None if before is None else setting(before),
    }  # fmt: skip
    asks = {"set": _set, "number": _number, "choice": _choices}[kind](sim, found["path"], box.items, answer, hand)
    return (
        f'<form method="dialog" class="box predict" data-predict="{escape(json.dumps(data))}">'
        f'<fieldset><legend>Predict</legend>{hand.blocks(box.question)}{asks}</fieldset><p role="status"></p>'
        f'<p class="room">Your answer:</p><div class="why">{hand.said_of(to, box.answer)}</div></form>'
    )


def _said(sim: AnySim, path: str, answer: float, within: float) -> str:
    """A number with a digit more than it is asked for, no more."""
    number = shown(sim, path)
    if number.boxed or isinstance(answer, int) or not within:
        return number.text(answer)
    return replace(number, digits=max(0, 1 - math.floor(math.log10(within)))).text(answer)


def _not_empty(info: str, inside: Sequence[Token]) -> None:
    if not inside:
        raise Wrong(
            f"::: {info}, an empty box", "a question, the choices if there are any, a line of --- and the answer"
        )


def _one_fits(items: Sequence[questions.Item], answer: Any) -> None:
    right = [item for item in items if questions.fits(item.value, answer)]
    if len(right) != 1:
        said = "no choice is right" if not right else f"{len(right)} choices are right"
        raise Wrong(said, f"exactly one that says {answer!r}; or a number to be typed, by `within 0.5`")


def _set(*_: Any) -> str:
    return f'<p class="row"><span>Set the sim to what you expect, then press</span> {COMMIT}</p>'


def _number(sim: AnySim, path: str, *_: Any) -> str:
    return (
        '<p class="row"><label>Your number <input type="text" inputmode="decimal" name="answer" size="8" '
        f'autocomplete="off"> {escape(shown(sim, path).unit)}</label> {COMMIT}</p>'
    )


def _choices(_: AnySim, __: str, items: Sequence[questions.Item], answer: Any, hand: Hand) -> str:
    choices = "".join(
        _choice(hand.inline(item.words), str(k), right=questions.fits(item.value, answer))
        for k, item in enumerate(items)
    )
    return f'{choices}<p class="row">{COMMIT}</p>'


def _choice(words: str, value: str, *, right: bool) -> str:
    mark = " data-right" if right else ""
    if not re.sub(r"<math.*?</math>", "", words).strip():  # a formula alone has no words by which it is called
        words = f'<span class="unseen">Answer {int(value) + 1}: </span>{words}'
    return (
        f'<label class="choice"><input type="radio" name="answer" value="{value}"{mark}> <span>{words}</span></label>'
    )


def check(inside: Sequence[Token], hand: Hand) -> str:
    """A question with its choices, each with the reason why somebody picks it, and a worked answer. Raises Wrong."""
    _not_empty("check", inside)
    box = questions.opened(inside)
    if [item.right for item in box.items].count(True) != 1 or any(item.right is None for item in box.items):
        raise Wrong("::: check", "choices as - [ ] wrong and exactly one - [x] right")
    if any(not item.why for item in box.items):
        raise Wrong("a choice without a reason", "below each choice a line that says why it is right or wrong")
    if not box.answer:
        raise Wrong("a check without its answer", "after the choices a line of --- and the worked answer")
    choices = "".join(
        _choice(hand.inline(item.words), str(k), right=bool(item.right))
        + f'<p class="reason" hidden>{hand.inline(item.why)}</p>'
        for k, item in enumerate(box.items)
    )
    return (
        f'<form method="dialog" class="box check" data-check><fieldset><legend>Check yourself</legend>'
        f'{hand.blocks(box.question)}{choices}</fieldset><p role="status"></p>'
        f"<details><summary>Worked answer</summary>{hand.blocks(box.answer)}</details></form>"
    )


def challenge(known: Sequence[Challenge[Any, Any]], info: str, inside: Sequence[Token], hand: Hand) -> str:
    """A challenge of the sim, with a hint if there is one. Raises Wrong."""
    _, *names = re.split(r"\s+", info)
    each = next((each for each in known if [each.id] == names), None)
    if each is None:
        raise Wrong(f"::: {info}", "challenge and one of " + ", ".join(each.id for each in known))
    hint = f"<details><summary>A hint</summary>{hand.blocks(inside)}</details>" if inside else ""
    return (
        f'<div class="box challenge" data-challenge="{escape(each.id)}" id="challenge-{escape(each.id)}">'
        f'<p class="label">Challenge</p><p><strong>{escape(each.title)}</strong></p><p>{escape(each.goal)}</p>'
        f'<progress max="1" value="0" aria-label="How near"></progress><p class="near">{NBSP}</p>{hint}'
        '<p class="room">Your answer:</p></div>'
    )
