"""Read-outs: numbers and matrices as native MathML, warnings as an icon with words."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from html import escape
from typing import Any, Protocol

import numpy as np

MINUS = "−"
THIN = "\u2009"


def figure(value: float, digits: int = 3) -> str:
    """A number for people: fixed decimals, a true minus sign, no negative zero."""
    text = f"{value:.{digits}f}"
    if text[0] != "-":
        return text
    return MINUS + text[1:] if text.strip("-0.") else text[1:]


def quantity(value: float, unit: str = "", digits: int = 3) -> str:
    """A number with its unit after a thin space (none before a degree sign)."""
    gap = "" if unit in ("", "°", "%") else THIN
    return f"{figure(value, digits)}{gap}{unit}"


def _number(value: float, digits: int) -> str:
    return f"<mn>{figure(value, digits)}</mn>"


Links = tuple[tuple[str, ...], ...]
"""By rows: what each entry of a matrix is highlighted with, several names with blanks between; empty for nothing."""


def mathml(value: Any, digits: int = 3, *, roles: tuple[str, ...] = (), links: Links = ()) -> str:
    """A number, vector (as a column) or matrix in MathML.

    `roles` are colours of the palette for a matrix's columns, with lines like those of the axes as a second cue.
    """
    array = np.asarray(value, dtype=float)
    return _mathml(array.shape, array.tobytes(), digits, roles, links)


@lru_cache(maxsize=512)
def _mathml(shape: tuple[int, ...], numbers: bytes, digits: int, roles: tuple[str, ...], links: Links) -> str:
    """As `mathml`; most matrices of a state were in the state before it too."""
    return _layout(shape, roles, links) % tuple([figure(v, digits) for v in np.frombuffer(numbers).tolist()])


@lru_cache(maxsize=128)
def _layout(shape: tuple[int, ...], roles: tuple[str, ...], links: Links) -> str:
    """MathML with a place for each figure of a number (), column (n,) or matrix (n, m)."""
    if not shape:
        return "<mn>%s</mn>"
    rows, columns = (*shape, 1)[:2]
    body = ""
    for i in range(rows):
        entries = [f"<mtd{_entry(i, k, rows, roles, links)}><mn>%s</mn></mtd>" for k in range(columns)]
        body += f"<mtr>{''.join(entries)}</mtr>"
    return f'<mtable class="s3-matrix">{body}</mtable>'


def _entry(i: int, k: int, rows: int, roles: tuple[str, ...], links: Links) -> str:
    """Attributes of a matrix's entry."""
    role = roles[k] if k < len(roles) else ""
    link = links[i][k] if links else ""
    end = " s3-foot" if role and i == rows - 1 else ""
    return (f' class="s3-{role}{end}"' if role else "") + (f' data-link="{escape(link)}"' if link else "")


def row(values: Sequence[float], digits: int = 3) -> str:
    """A tuple (a, b, c) in MathML."""
    inner = "<mo>,</mo>".join(_number(v, digits) for v in values)
    return f"<mrow><mo>(</mo>{inner}<mo>)</mo></mrow>"


def math(*parts: str) -> str:
    """One formula; the parts are MathML."""
    return f"<math>{''.join(parts)}</math>"


def symbol(name: str, sub: str = "") -> str:
    """An identifier, upright when it is longer than a letter, with an optional subscript."""
    base = f"<mi>{escape(name)}</mi>"
    return f"<msub>{base}<mi>{escape(sub)}</mi></msub>" if sub else base


@dataclass(frozen=True)
class Formula:
    """`name = value`, where the value is MathML; `note` says in words what it is."""

    note: str
    name: str
    value: str
    unit: str = ""
    link: str = ""
    """What it is highlighted with."""

    def html(self) -> str:
        unit = f"<mtext>{THIN if self.unit != '°' else ''}{escape(self.unit)}</mtext>" if self.unit else ""
        left = f"{self.name}<mo>=</mo>" if self.name else ""
        link = f' data-link="{escape(self.link)}"' if self.link else ""
        return f'<div class="s3-formula"{link}><span>{escape(self.note)}</span>{math(left, self.value, unit)}</div>'


@dataclass(frozen=True)
class Table:
    """A small table of words and numbers; the first row is its head.

    `links` names what each further row stands for: it is highlighted with its mark in the pictures, and is `selected`
    by a click or by the button that its first cell becomes. `lights` does so for the rows after these, which only light
    up.
    """

    note: str
    rows: Sequence[Sequence[str]]
    links: Sequence[str] = ()
    selected: str = ""
    lights: Sequence[str] = ()

    def html(self) -> str:
        head, *body = self.rows
        top = "".join(f'<th scope="col">{escape(cell)}</th>' if cell else "<td></td>" for cell in head)
        rest = "".join([self._row(k, cells) for k, cells in enumerate(body)])
        return f'<table class="s3-table"><caption>{escape(self.note)}</caption><tr>{top}</tr>{rest}</table>'

    def _row(self, k: int, cells: Sequence[str]) -> str:
        name, *rest = escape("\n".join(cells)).split("\n")  # in one go: a table has many cells
        numbers = "".join([f"<td>{cell}</td>" for cell in rest])
        if k >= len(self.links):
            further = k - len(self.links)
            light = f' data-link="{escape(self.lights[further])}"' if further < len(self.lights) else ""
            return f'<tr{light}><th scope="row">{name}</th>{numbers}</tr>'
        chosen = self.links[k] == self.selected
        button = f'<button type="button" aria-pressed="{"true" if chosen else "false"}">{name}</button>'
        kind = ' class="s3-selected"' if chosen else ""
        return f'<tr data-link="{escape(self.links[k])}"{kind}><th scope="row">{button}</th>{numbers}</tr>'


@dataclass(frozen=True)
class Note:
    """A sentence; `level` is info, near or warn (the last two carry an icon)."""

    text: str
    level: str = "info"

    def html(self) -> str:
        icon = "" if self.level == "info" else '<span aria-hidden="true">⚠</span> '
        return f'<p class="s3-note s3-{self.level}">{icon}{escape(self.text)}</p>'


@dataclass(frozen=True)
class Fold:
    """What follows stands in the fold of that title, closed at first; what stands before any is always seen."""

    title: str

    def html(self) -> str:
        return f"<h3>{escape(self.title)}</h3>"


class Readout(Protocol):
    """What stands beside the scene: one of these, or of a sim's own."""

    def html(self) -> str: ...


def folded(readouts: Iterable[Readout]) -> dict[str, list[Readout]]:
    """Read-outs by the titles of their folds; those that are always seen by an empty one."""
    found: dict[str, list[Readout]] = {"": []}
    title = ""
    for each in readouts:
        if isinstance(each, Fold):
            title = each.title
        else:
            found.setdefault(title, []).append(each)
    return found


def render(readouts: Iterable[Readout]) -> str:
    """Read-outs as one piece of HTML, with the titles of folds as headings."""
    return "".join([each.html() for each in readouts])


def still(readouts: Iterable[Readout]) -> str:
    """The same for a page on which nothing in them can be chosen."""
    return re.sub(r'<input type="radio"[^>]*/>', "", render(readouts))
