"""Read-outs: numbers and matrices as native MathML, warnings as an icon with words."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from html import escape
from itertools import cycle
from typing import Any, NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

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


def mathml(
    value: Any, digits: int | tuple[int, ...] = 3, *, roles: tuple[str, ...] = (), links: Links = (),
    rows: tuple[str, ...] = (),
) -> str:  # fmt: skip
    """A number, vector (as a column) or matrix in MathML, with as many digits in all columns, or in each its own.

    `roles` are colours of the palette for a matrix's columns, with lines like those of the axes as a second cue.
    `rows` are cameras' for its rows, with their letters before them.
    """
    array = np.asarray(value, dtype=float)
    columns = (digits,) if isinstance(digits, int) else digits
    return _lettered(rows) + _mathml(array.shape, array.tobytes(), columns, roles, links, rows)


@lru_cache(maxsize=8)
def _lettered(rows: tuple[str, ...]) -> str:
    """The letters of rows, such as L for `left`, under each other."""
    letters = "".join(f'<mtr><mtd class="s3-{row}"><mi>{row[0].upper()}</mi></mtd></mtr>' for row in rows)
    return f"<mtable>{letters}</mtable>" if rows else ""


@lru_cache(maxsize=512)
def _mathml(
    shape: tuple[int, ...], numbers: bytes, digits: tuple[int, ...], roles: tuple[str, ...], links: Links,
    rows: tuple[str, ...],
) -> str:  # fmt: skip
    """As `mathml`; most matrices of a state were in the state before it too."""
    values = zip(np.frombuffer(numbers).tolist(), cycle(digits), strict=False)
    return _layout(shape, roles, links, rows) % tuple([figure(value, each) for value, each in values])


@lru_cache(maxsize=128)
def _layout(shape: tuple[int, ...], roles: tuple[str, ...], links: Links, of_rows: tuple[str, ...]) -> str:
    """MathML with a place for each figure of a number (), column (n,) or matrix (n, m)."""
    if not shape:
        return "<mn>%s</mn>"
    rows, columns = (*shape, 1)[:2]
    body = ""
    for i in range(rows):
        of_row = f"s3-{of_rows[i]}" if of_rows else ""
        kinds = [of_row or _of_column(k, roles, last=i == rows - 1) for k in range(columns)]
        entries = [_entry(kind, links[i][k] if links else "") for k, kind in enumerate(kinds)]
        body += f"<mtr>{''.join(entries)}</mtr>"
    return f'<mtable class="s3-matrix">{body}</mtable>'


def _of_column(k: int, roles: tuple[str, ...], *, last: bool) -> str:
    """The class of an entry for the role of its column, whose line is under the last row."""
    return f"s3-{roles[k]}{' s3-foot' if last else ''}" if k < len(roles) and roles[k] else ""


def _entry(kind: str, link: str) -> str:
    """The place of a matrix's entry, of a class and with a link."""
    marked = (f' class="{kind}"' if kind else "") + (f' data-link="{escape(link)}"' if link else "")
    return f"<mtd{marked}><mn>%s</mn></mtd>"


def significant(value: npt.ArrayLike, digits: int = 5) -> str:
    """A matrix in MathML whose entries differ by powers of ten: each with its own, and as many digits as the others.

    What is below 1e-14 of the largest is rounding: 0.
    """
    array = np.asarray(value, dtype=float)
    least = 1e-14 * np.abs(array).max()
    body = "".join(
        f"<mtr>{''.join([f'<mtd>{_scientific(v, digits, least)}</mtd>' for v in entries])}</mtr>"
        for entries in array.tolist()
    )
    return f'<mtable class="s3-matrix s3-long">{body}</mtable>'


def _scientific(value: float, digits: int, least: float) -> str:
    if abs(value) <= least:
        return "<mn>0</mn>"
    mantissa, _, power = f"{value:.{digits - 1}e}".partition("e")
    number = f"<mn>{mantissa.replace('-', MINUS)}</mn>"
    if not int(power):
        return number
    exponent = f"<mn>{power.lstrip('+0')}</mn>" if int(power) > 0 else f"<mn>{MINUS}{power[1:].lstrip('0')}</mn>"
    return f"<mrow>{number}<mo>·</mo><msup><mn>10</mn>{exponent}</msup></mrow>"


def spelled(matrix: npt.ArrayLike) -> str:
    """A matrix with all its digits, as Python, JavaScript and others read it."""
    return json.dumps((np.asarray(matrix, dtype=float) + 0.0).tolist())


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


def under(value: str, words: str) -> str:
    """MathML with words below it."""
    return f"<munder>{value}<mtext>{escape(words)}</mtext></munder>"


def copy_button(text: str, what: str) -> str:
    """Copies a text, which is as other programs write `what`."""
    return (
        f'<button type="button" class="s3-copy" data-s3="copy" value="{escape(text)}"'
        f' aria-label="Copy: {escape(what)}">Copy</button>'
    )


@dataclass(frozen=True)
class Formula:
    """`name = value`, where the value is MathML; `note` says in words what it is."""

    note: str
    name: str
    value: str
    unit: str = ""
    link: str = ""
    """What it is highlighted with."""
    copy: str = ""
    """What a button copies: the whole number, for other programs."""

    def html(self) -> str:
        unit = f"<mtext>{THIN if self.unit != '°' else ''}{escape(self.unit)}</mtext>" if self.unit else ""
        left = f"{self.name}<mo>=</mo>" if self.name else ""
        link = f' data-link="{escape(self.link)}"' if self.link else ""
        name = escape(self.note)
        button = copy_button(self.copy, self.note) if self.copy else ""
        return f'<div class="s3-formula"{link}><span>{name}</span>{button}{math(left, self.value, unit)}</div>'


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


class Link(NamedTuple):
    """One step of a chain: what leads to it (none for the first), what it is, its numbers, and what highlights it."""

    by: str
    what: str
    value: str
    link: str = ""


@dataclass(frozen=True)
class Chain:
    """A calculation on one line, step after step."""

    note: str
    links: Sequence[Link]

    def html(self) -> str:
        inside = "".join([self._link(*map(escape, link)) for link in self.links])
        return f'<ol class="s3-chain" aria-label="{escape(self.note)}">{inside}</ol>'

    def _link(self, by: str, what: str, value: str, link: str) -> str:
        lit = f' data-link="{link}"' if link else ""
        arrow = f"<i>{by}</i>" if by else ""
        return f"<li{lit}>{arrow}<span>{what}</span><b>{value}</b></li>"


@dataclass(frozen=True)
class Note:
    """A sentence; `level` is info, near or warn (the last two carry an icon)."""

    text: str
    level: str = "info"

    def html(self) -> str:
        icon = "" if self.level == "info" else '<span aria-hidden="true">⚠</span> '
        return f'<p class="s3-note s3-{self.level}">{icon}{escape(self.text)}</p>'


@dataclass(frozen=True)
class Lamps:
    """Words with a row of lamps, each of which glows by so much, 0 (out) to 1."""

    text: str
    glow: Sequence[float]

    def html(self) -> str:
        lamps = "".join(
            f'<i class="s3-lamp" style="--glow:{each:.3f}"></i>' if each else '<i class="s3-lamp s3-out">×</i>'
            for each in self.glow
        )
        lit = f"{sum(each > 0 for each in self.glow)} of {len(self.glow)} lamps lit"
        return f'<p class="s3-lamps"><span role="img" aria-label="{lit}">{lamps}</span> <b>{escape(self.text)}</b></p>'


@dataclass(frozen=True)
class Copied:
    """A text to be copied, as others write what `note` names."""

    note: str
    text: str

    def html(self) -> str:
        button = copy_button(self.text, self.note)
        return f'<div class="s3-copied"><span>{escape(self.note)}</span><code>{escape(self.text)}</code>{button}</div>'


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
