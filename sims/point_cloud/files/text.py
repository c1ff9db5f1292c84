"""XYZ, CSV and other tables of numbers, with or without a line of names."""

from __future__ import annotations

import io
import warnings
from typing import IO

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


def read_table(data: bytes) -> Columns:
    """Return the columns of a table. Raises CloudFileError if it isn't one, or has fewer than three columns."""
    if b"\0" in data[:4096]:
        raise CloudFileError("It isn't text.")
    text = data.removeprefix(b"\xef\xbb\xbf").lstrip().translate(_SPACES)
    line = text[:4096].split(b"\n", 1)[0].decode("utf-8", errors="replace")
    names = [word.strip("\"'") for word in line.lstrip("#/ ").split()]
    comment = line.startswith(("#", "//")) and not {"x", "y", "z"} <= {name.lower() for name in names}
    has_names = not comment and not all(map(_is_number, names))
    table = numbers(io.BytesIO(text), int(comment or has_names), None)
    width = table.shape[1]
    if width < 3:
        raise CloudFileError(f"Its lines have {width} numbers; a point needs three.")
    if not has_names:
        names = UNNAMED.get(width, "x y z").split()
    elif len(names) != width:
        raise CloudFileError(f"It names {len(names)} columns, and its lines have {width}.")
    return named({name: table[:, column] for column, name in enumerate(names)})


def numbers(lines: IO[bytes], skip: int, count: int | None) -> Array:
    """Return a table (N, columns) of at most `count` lines of numbers; empty ones and # comments don't count."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # of no data: told as zero points
            return np.loadtxt(lines, np.float64, skiprows=skip, max_rows=count, ndmin=2, encoding="latin-1")
    except ValueError as error:
        raise CloudFileError(f"It has a line that isn't numbers like the others: {str(error)[:100]}") from None


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
