"""XYZ, CSV, PTS and other tables of numbers, from any program and country.

What parts the numbers, and whether their decimals follow a point or a comma, is found out from the first lines; NumPy
reads the rest. No CSV reader among the dependencies finds out either, and Python's own sniffer takes decimal commas
for separators.
"""

from __future__ import annotations

import codecs
import csv
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from sims.point_cloud.files.columns import PREVIEWED, CloudFileError, Table
from sims.point_cloud.files.meaning import named_roles
from sims.point_cloud.files.numbers import NUMBER, WIDEST, is_number, rows

LOOKED_AT = 262_144
"""Bytes, from the start, in which the format must show."""
SAMPLE = 200
"""Lines from which the format is found out."""
_COMMENT = re.compile(r"\s*(?:#|//|%|!)")
_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?$")
_BOMS = (
    (codecs.BOM_UTF8, "utf-8"), (codecs.BOM_UTF32_LE, "utf-32-le"), (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"), (codecs.BOM_UTF16_BE, "utf-16-be"),
)  # fmt: skip


@dataclass(frozen=True)
class Form:
    """How a table is written: what parts its cells (nothing: blanks), and what stands before its decimals."""

    delimiter: str
    decimal_comma: bool = False
    thousands: str = ""
    mixed: bool = False
    """Commas, semicolons and blanks in one line."""
    quoted: bool = False

    def cells(self, line: str) -> list[str]:
        """The cells of one line, without quotes; the numbers as Python spells them."""
        if self.mixed:
            return line.replace(",", " ").replace(";", " ").split()
        if not self.quoted:
            found = line.split(self.delimiter) if self.delimiter else line.split()
        else:
            found = next(csv.reader([line.strip()], delimiter=self.delimiter or " ", skipinitialspace=True), [])
        return [self._number(cell.strip()) for cell in found]

    def _number(self, cell: str) -> str:
        if self.thousands:
            cell = cell.replace(self.thousands, "")
        return cell.replace(",", ".") if self.decimal_comma and NUMBER.match(cell.replace(",", ".")) else cell

    def plain(self, text: bytes) -> bytes:
        """The same text with decimal points, and only `delimiter` or blanks between the cells."""
        if self.mixed:
            return text.translate(bytes.maketrans(b",;", b"  "))
        if self.thousands:
            text = text.replace(self.thousands.encode(), b"")
        if self.decimal_comma and self.delimiter != ",":
            return text.replace(b",", b".")
        return re.sub(rb'"\s*([+-]?\d*),(\d+)\s*"', rb'"\1.\2"', text) if self.decimal_comma else text


def read_table(data: bytes) -> Table:
    """Return the columns of a table. Raises CloudFileError if it isn't one, or has fewer than three columns."""
    text = decoded(data)
    start, line, names, count = _beginning(text)
    body = _without_comments(text[start:])
    lines = [words for words in _lines(body) if words.strip()][:SAMPLE]
    form = form_of(lines)
    sample = [form.cells(words) for words in lines]
    width = len(sample[0])
    if width > WIDEST:
        raise CloudFileError(f"Its lines have {width:,} numbers; at most {WIDEST} columns are read.")
    kept = [k for k in range(width) if all(is_number(cells[k]) for cells in sample if len(cells) == width)]
    if count is not None:  # PTS: each of its scans begins with the number of its points
        body = re.sub(rb"(?m)^[ \t]*\d+[ \t]*$", b"", body)
    table = rows(
        form.plain(body), line, delimiter=form.delimiter, quoted=form.quoted,
        columns=None if len(kept) == width else kept,
    )  # fmt: skip
    if count is not None and len(table) < count:
        raise CloudFileError(f"It is cut off: its first line says {count:,} points, and {len(table):,} are there.")
    values = dict(zip(kept, table.T, strict=True))
    if form.delimiter and width - 1 in values and width > 3 and np.isnan(values[width - 1]).all():
        width -= 1  # there is a delimiter at the end of each line
    said = _fitting(form.cells(names) if names else [], width)
    preview = [[cells[k][:24] for cells in sample[:PREVIEWED] if k < len(cells)] for k in range(width)]
    return Table(said, [values.get(k) for k in range(width)], False, preview)


def decoded(data: bytes) -> bytes:
    """A text file in UTF-8 or the like, its lines ending in one line feed each, blank lines before it taken away."""
    coding = next((name for mark, name in _BOMS if data.startswith(mark)), "")
    first, second = data[:200:2], data[1:200:2]  # of ASCII in UTF-16 without a mark, every second byte is zero
    if not coding and second and not any(second) and all(first):
        coding = "utf-16-le"
    elif not coding and second and not any(first) and all(second):
        coding = "utf-16-be"
    if coding not in ("", "utf-8"):
        data = data.decode(coding, errors="replace").encode()
    data = data.removeprefix(codecs.BOM_UTF8)
    if b"\0" in data[:4096]:
        raise CloudFileError("It isn't text.")
    return data.replace(b"\r\n", b"\n").replace(b"\r", b"\n") if b"\r" in data else data


def _lines(text: bytes) -> list[str]:
    """The first lines, the last of them whole unless it is longer than all that is looked at."""
    end = len(text) if len(text) <= LOOKED_AT else max(text.rfind(b"\n", 0, LOOKED_AT), 0) or LOOKED_AT
    return text[:end].decode("utf-8", errors="replace").split("\n")


def _beginning(text: bytes) -> tuple[int, int, str, int | None]:
    """Where the numbers begin (byte, line), the line of names before them, and the number of points if it is told."""
    names, count, offset = "", None, 0
    for number, raw in enumerate(text[:LOOKED_AT].split(b"\n"), 1):
        line = raw.decode("utf-8", errors="replace")
        comment = _COMMENT.match(line)
        words = line.strip().lstrip("#/%! \t") if comment else line.strip()
        if words and (comment or not (cells := form_of([line]).cells(line)) or not all(map(_given, cells[:3]))):
            if not comment or len(set(named_roles(form_of([words]).cells(words))) & set("xyz")) == 3:
                names = words
        elif words and len(cells) == 1 and cells[0].isdecimal() and len(cells[0]) < 16:
            count = int(cells[0])
        elif words and len(cells) < 3:
            raise CloudFileError(f"Its lines have {len(cells)} numbers; a point needs three.")
        elif words:
            return offset, number, names, count
        offset += len(raw) + 1
    raise CloudFileError("It has no line of three numbers.")


def _given(cell: str) -> bool:
    return bool(cell) and is_number(cell)


def _without_comments(text: bytes) -> bytes:
    """Their lines stay, empty. Within a number, as in Microsoft's 1.#QNAN, # begins none."""
    if b"#" in text:
        text = re.sub(rb"(?m)(?:^|(?<=[ \t]))#.*$", b"", text)
    return re.sub(rb"(?m)^[ \t]*//.*$", b"", text) if b"//" in text else text


def form_of(lines: Sequence[str]) -> Form:
    """Find out how lines are written."""
    quoted = any('"' in line for line in lines)
    for mark in (";", "\t", "|", ","):
        if not all(mark in line for line in lines):
            continue
        form = Form(mark, quoted=quoted)
        cells = [cell for line in lines for cell in form.cells(line)]
        if mark == "," and not quoted and _decimal_commas_only(lines):
            return Form("", decimal_comma=True)
        if mark in ",;" and any(re.match(r"\S+\s+\S", c) for c in cells) and _all_numbers(lines, Form("", mixed=True)):
            if any(_DECIMAL_COMMA.match(word) for line in lines for word in line.split()):
                raise CloudFileError(
                    "A comma may part two of its numbers, or begin decimals: which is meant isn't sure."
                )
            return Form("", mixed=True)
        if mark == "\t" and not any(map(_empty, cells)) and len(form.cells(lines[0])) < len(lines[0].split()):
            break  # tabs and blanks both part cells
        return _with_decimals(form, cells)
    form = Form("", quoted=quoted)
    return _with_decimals(form, [cell for line in lines for cell in form.cells(line)])


def _empty(cell: str) -> bool:
    return not cell


def _all_numbers(lines: Sequence[str], form: Form) -> bool:
    return all(map(is_number, (cell for line in lines for cell in form.cells(line))))


def _decimal_commas_only(lines: Sequence[str]) -> bool:
    """Numbers between blanks, whose decimals follow commas."""
    words = [line.split() for line in lines]
    return all(
        len(cells) >= 3 and all(_DECIMAL_COMMA.match(cell) or NUMBER.match(cell) for cell in cells) for cells in words
    ) and not any("." in line for line in lines)


def _with_decimals(form: Form, cells: Sequence[str]) -> Form:
    """The form with what its numbers say of commas and points."""
    both = next((cell for cell in cells if "," in cell and "." in cell and re.match(r"[+-]?[\d.,]+$", cell)), None)
    if both is not None:
        comma = both.rfind(",") > both.rfind(".")
        return Form(form.delimiter, comma, "." if comma else ",", quoted=form.quoted)
    comma = any(map(_DECIMAL_COMMA.match, cells))
    if comma and any("." in cell and NUMBER.match(cell) for cell in cells):
        raise CloudFileError(
            "It writes some decimals after a comma and some after a point: which are meant isn't sure."
        )
    return Form(form.delimiter, comma, quoted=form.quoted)


def _fitting(names: Sequence[str], width: int) -> list[str]:
    """One name for each column, empty where there is none."""
    cleaned = [name.strip("\"' ") for name in names]
    if len(cleaned) == width - 1 and not cleaned[0][:1].isdigit():
        roles = named_roles(cleaned)
        if roles[0] == "x" and roles[-1] != "-":
            cleaned = ["", *cleaned]  # R's write.table: the column of row numbers has no name
    while len(cleaned) > width and not cleaned[-1]:
        cleaned.pop()
    if len(cleaned) > width:
        known = list(_known(cleaned))
        if named_roles(known)[:3] != ["x", "y", "z"]:
            raise CloudFileError(f"It names {len(cleaned)} columns, and its lines have {width}.")
        cleaned = known[:width]  # names with blanks in them, as of scalar fields, come last
    return [*cleaned, *[""] * (width - len(cleaned))]


def _known(names: Sequence[str]) -> Iterator[str]:
    """Names up to the first one that means nothing."""
    for name in names:
        if named_roles([name]) == ["-"]:
            return
        yield name
