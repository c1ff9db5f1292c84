"""Numbers that are written as text: in lines of equal length, or one after the other."""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Sequence

import numpy as np

from geometry.arrays import Array
from sims.point_cloud.files.columns import CloudFileError

NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?$")
NOT_A_NUMBER = re.compile(
    r"[+-]?(?:nan(?:\([^)]*\))?|1\.#\w+|inf(?:inity)?)$|(?:null|none|n/?a|#n/?a|-+|\*+|\?)?$", re.IGNORECASE
)
"""How programs write that there is no number: C, Microsoft's C, databases and spreadsheets; also nothing at all."""
_ODD = re.compile(
    rb"""(?<![^\s;,|"])(?:[+-]?1\.\#\w+|[+-]?nan\([^)\s]*\)|null|none|n/?a|\#n/?a|-+|\*+|\?)(?![^\s;,|"])""",
    re.IGNORECASE,
)
WIDEST = 400
"""Columns, from which on a line is no row of a table of points."""


def is_number(cell: str) -> bool:
    """Whether a cell is a number, or says that there is none."""
    return bool(NUMBER.match(cell) or NOT_A_NUMBER.match(cell))


def rows(
    text: bytes, line: int = 1, *, delimiter: str = "", quoted: bool = False, columns: Sequence[int] | None = None
) -> Array:
    """Return a table (N, columns) of lines of numbers, between blanks where there is no delimiter.

    Empty lines don't count. `line` is the number of the first line, `columns` are those to read where others hold
    words. What says that it is no number becomes NaN. Raises CloudFileError that quotes the first line that isn't like
    the others.
    """
    try:
        return _loaded(text, delimiter, quoted, columns)
    except ValueError:
        pass  # numbers that aren't spelled as NumPy's are worth a second reading, but no other file should pay for it
    try:
        return _loaded(spelled_out(text, delimiter), delimiter, quoted, columns)
    except ValueError:
        raise _odd_line(text, line, delimiter, columns) from None


def _loaded(text: bytes, delimiter: str, quoted: bool, columns: Sequence[int] | None) -> Array:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # of no data: told as zero points
        return np.loadtxt(
            io.BytesIO(text), np.float64, comments=None, delimiter=delimiter or None, quotechar='"' if quoted else None,
            usecols=columns, ndmin=2, encoding="latin-1",
        )  # fmt: skip


def spelled_out(text: bytes, delimiter: str = "") -> bytes:
    """The same text with `nan` for all that says that it is no number."""
    if delimiter:
        mark = re.escape(delimiter.encode())
        empty = rb'^[ ]*(?:"")?[ ]*(?=' + mark + rb")|(?<=" + mark + rb')[ ]*(?:"")?[ ]*(?=' + mark + rb"|$)"
        text = re.sub(rb"(?m)" + empty, b"nan", text)
    return _ODD.sub(b"nan", text)


def _odd_line(text: bytes, line: int, delimiter: str, columns: Sequence[int] | None) -> CloudFileError:
    """What to say of the first line that isn't so many numbers as the first one."""
    width = 0
    for number, words in enumerate(text.decode("latin-1").split("\n"), line):
        cells = [cell.strip().strip('"') for cell in (words.split(delimiter) if delimiter else words.split())]
        width = width or (len(cells) if words.strip() else 0)
        odd = len(cells) != width or not all(map(is_number, cells if columns is None else [cells[k] for k in columns]))
        if words.strip() and odd:
            return CloudFileError(f"Line {number:,} isn't {width} numbers like the others: “{words.strip()[:40]}”.")
    return CloudFileError("It has a line that isn't numbers like the others.")


def stream(text: bytes) -> Array:
    """Return the numbers (n,) that stand one after the other, however many are on a line.

    Raises CloudFileError that quotes the first word that is no number.
    """
    try:
        return _streamed(text)
    except ValueError:
        pass
    text = _ODD.sub(b"nan", text)
    try:
        return _streamed(text)
    except ValueError:
        odd = next((word for word in text.split() if not is_number(word.decode("latin-1"))), b"")
        said = odd[:40].decode("utf-8", errors="replace")
        raise CloudFileError(f"There is something else among its numbers: “{said}”.") from None


def _streamed(text: bytes) -> Array:
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)  # so older NumPys say what newer ones raise
        try:
            return np.fromstring(text, np.float64, sep=" ") if text.strip() else np.empty(0)
        except DeprecationWarning as error:
            raise ValueError(str(error)) from None
