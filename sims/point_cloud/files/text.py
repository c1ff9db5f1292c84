"""XYZ, CSV and other tables of numbers, with or without a line of names."""

from __future__ import annotations

import io
import warnings
from collections.abc import Iterator

import numpy as np

from geometry.arrays import Array
from sims.point_cloud.files.columns import CloudFileError, Columns, named

UNNAMED = {
    3: "x y z",
    4: "x y z intensity",
    6: "x y z red green blue",
    7: "x y z intensity red green blue",
}
"""Columns of files without names, by their number; of other numbers only the first three are read."""
_SPACES = bytes.maketrans(b",;", b"  ")
_PIECE = 65_536
"""Bytes that are read at once: some milliseconds."""


def read_table(data: bytes) -> Columns:
    """Return the columns of a table. Raises CloudFileError if it isn't one, or has fewer than three columns."""
    if b"\0" in data[:4096]:
        raise CloudFileError("It isn't text.")
    text = data.removeprefix(b"\xef\xbb\xbf").lstrip().translate(_SPACES)
    line = text[:4096].split(b"\n", 1)[0].decode("utf-8", errors="replace")
    names = [word.strip("\"'") for word in line.lstrip("#/ ").split()]
    comment = line.startswith(("#", "//")) and not {"x", "y", "z"} <= {name.lower() for name in names}
    has_names = not comment and not all(map(_is_number, names))
    table = numbers(text, int(comment or has_names))
    width = table.shape[1]
    if width < 3:
        raise CloudFileError(f"Its lines have {width} numbers; a point needs three.")
    if not has_names:
        names = UNNAMED.get(width, "x y z").split()
    elif len(names) != width:
        raise CloudFileError(f"It names {len(names)} columns, and its lines have {width}.")
    return named({name: table[:, column] for column, name in enumerate(names)})


def numbers(text: bytes, skip: int = 0, most: int | None = None, line: int = 1) -> Array:
    """Return a table (N, columns) of at most `most` lines of numbers; empty ones and # comments don't count.

    The first `skip` lines are left out, `line` is the number of the first one. It is read piece by piece: NumPy keeps
    Python's lock while it reads, and everybody else's sim would wait.
    """
    tables, there = list[Array](), 0
    for piece in _pieces(text):
        width = tables[0].shape[1] if tables else None
        table = _numbers(piece, skip, None if most is None else most - there, line, width)
        lines = piece.count(b"\n")
        line, skip = line + lines, max(skip - lines, 0)
        if len(table):
            tables.append(table)
            there += len(table)
        if there == most:
            break
    return np.concatenate(tables) if tables else np.empty((0, 0))


def _pieces(text: bytes) -> Iterator[bytes]:
    """Whole lines."""
    start = 0
    while start < len(text):
        end = text.find(b"\n", start + _PIECE) + 1 or len(text)
        yield text[start:end]
        start = end


def _numbers(piece: bytes, skip: int, most: int | None, line: int, width: int | None) -> Array:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # of no data: told as zero points
            table = np.loadtxt(io.BytesIO(piece), np.float64, skiprows=skip, max_rows=most, ndmin=2, encoding="latin-1")
    except ValueError:
        raise _odd(piece, skip, line, width) from None
    if len(table) and width not in (None, table.shape[1]):
        raise _odd(piece, skip, line, width)
    return table


def _odd(piece: bytes, skip: int, line: int, width: int | None) -> CloudFileError:
    """What to say of the first line that isn't so many numbers, or as many as the one before it."""
    for number, text in enumerate(piece.decode("latin-1").splitlines()[skip:], line + skip):
        words = text.split("#")[0].split()
        width = width or len(words)
        if words and (len(words) != width or not all(map(_is_number, words))):
            return CloudFileError(f"Line {number:,} isn't {width} numbers like the others: “{text.strip()[:40]}”.")
    return CloudFileError("It has a line that isn't numbers like the others.")


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
