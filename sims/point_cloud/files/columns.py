"""What the formats have in common: named columns of numbers, and the one error."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from geometry.arrays import Array
from sims.point_cloud.cloud import Colors

Columns = Mapping[str, npt.NDArray[Any]]
"""`x`, `y`, `z`, and perhaps `red`, `green`, `blue` and `intensity`, each (N,)."""

NAMES = {
    "x": "x", "y": "y", "z": "z",
    "r": "red", "g": "green", "b": "blue", "red": "red", "green": "green", "blue": "blue",
    "diffuse_red": "red", "diffuse_green": "green", "diffuse_blue": "blue",
    "intensity": "intensity", "i": "intensity", "scalar_intensity": "intensity", "reflectance": "intensity",
}  # fmt: skip
"""What files call them, in lower case."""


class CloudFileError(ValueError):
    """A file that gives no cloud, and why, in words for whoever brought it."""


def named(columns: Mapping[str, npt.NDArray[Any]]) -> Columns:
    """The columns that mean something, under one name each."""
    known = {NAMES[name.lower()]: values for name, values in columns.items() if name.lower() in NAMES}
    missing = [name for name in "xyz" if name not in known]
    if missing:
        raise CloudFileError(f"It has no coordinate {', '.join(missing)}; its columns are {', '.join(columns)[:120]}.")
    return known


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


def colors_of(columns: Columns) -> Colors | None:
    """Colours (N, 3) as 0–255, from that, from 0–65535 or from 0–1."""
    if not {"red", "green", "blue"} <= set(columns):
        return None
    channels = np.stack([columns[name] for name in ("red", "green", "blue")], axis=1)
    rgb = np.nan_to_num(channels.astype(np.float64), nan=0.0, posinf=0.0, neginf=0.0)
    largest = float(rgb.max(initial=0.0))
    if largest > 255.0:
        rgb *= 255.0 / 65535.0
    elif largest <= 1.0 and np.issubdtype(channels.dtype, np.floating):
        rgb *= 255.0
    return np.clip(np.round(rgb), 0.0, 255.0).astype(np.uint8)


def intensity_of(columns: Columns) -> Array | None:
    """Intensities (N,) as shares of the largest, if they aren't between 0 and 1."""
    if "intensity" not in columns:
        return None
    values = np.nan_to_num(columns["intensity"].astype(np.float64), nan=0.0, posinf=0.0, neginf=0.0)
    values = np.maximum(values, 0.0)
    largest = float(values.max(initial=0.0))
    return values / largest if largest > 1.0 else values
