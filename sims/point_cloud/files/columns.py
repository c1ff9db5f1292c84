"""What the formats have in common: a table of columns, and the one error."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from geometry.arrays import Array

Values = npt.NDArray[Any]
PREVIEWED = 3
"""Lines of a file that are shown beside the choice of its columns."""


class CloudFileError(ValueError):
    """A file that gives no cloud, and why, in words for whoever brought it."""


@dataclass(frozen=True, eq=False)
class Table:
    """What a file holds, before anything is taken for something.

    `names` are those of its columns, empty where it has none; `values` (N,) each are of the type that the file
    declares, None for a column of words. Where nothing is `declared`, all numbers are float64. `preview` has the first
    lines' entries of each column. `sensor` (3,) is in the file's coordinates, `unit` and `height_unit` are keys of
    `units.METRES` where the file names them.
    """

    names: Sequence[str]
    values: Sequence[Values | None]
    declared: bool
    preview: Sequence[Sequence[str]]
    sensor: Array | None = None
    unit: str = ""
    height_unit: str = ""
    unit_from: str = ""

    def __len__(self) -> int:
        return next((len(values) for values in self.values if values is not None), 0)


def declared(columns: Mapping[str, Values], **known: Any) -> Table:
    """A table whose file declares names and types."""
    preview = [[_spelled(value) for value in values[:PREVIEWED].tolist()] for values in columns.values()]
    return Table(list(columns), list(columns.values()), True, preview, **known)


def _spelled(value: Any) -> str:
    return f"{value:.9g}" if isinstance(value, float) else str(value)


def enough(claimed: int, size: int, there: int, what: str = "points of {} bytes") -> None:
    """Raise CloudFileError if a header claims more data than the file has, or no points."""
    if claimed <= 0:
        raise CloudFileError("Its header says that it has no points.")
    if claimed * size > there:
        raise CloudFileError(
            f"It is cut off: its header says {claimed:,} {what.format(size)}, and {max(there, 0):,} bytes follow."
        )


def fits(unpacked: int, largest: int) -> None:
    """Raise CloudFileError if a compressed file would become too large."""
    if unpacked > largest:
        raise CloudFileError(f"Unpacked it is {unpacked / 1e6:,.0f} MB; at most {largest / 1e6:,.0f} MB are taken.")


def floats(values: Values) -> Array:
    """Values as floats, also where a NaN of a file is one that signals."""
    with np.errstate(invalid="ignore"):
        return np.asarray(values.astype(np.float64))


def finite(values: Values) -> Array:
    """Values as floats, zero where one isn't finite."""
    return np.nan_to_num(floats(values), nan=0.0, posinf=0.0, neginf=0.0)


def unpacked_colors(bits: npt.NDArray[np.uint32]) -> dict[str, Values]:
    """Red, green and blue of the four bytes that PCD keeps them in."""
    return {name: ((bits >> shift) & 255).astype(np.uint8) for name, shift in (("red", 16), ("green", 8), ("blue", 0))}
