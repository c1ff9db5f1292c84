"""PCD, the Point Cloud Library's format of versions .5 to .7, as text, binary and compressed.

Its header is read here: pypcd4 refuses the older versions and what else PCL itself writes and reads (no VIEWPOINT, no
COUNT, aligned columns), and takes what a header claims on trust. The compression, LZF, is python-lzf's.
Source: PCL's documentation, "The PCD (Point Cloud Data) file format".
"""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence

import lzf
import numpy as np

from geometry.arrays import Array
from sims.point_cloud.files.columns import (
    CloudFileError,
    Table,
    Values,
    declared,
    enough,
    finite,
    fits,
    unpacked_colors,
)
from sims.point_cloud.files.numbers import WIDEST, stream

_LONGEST_HEADER = 65_536
_KINDS = {"F": "f", "I": "i", "U": "u"}
_SIZES = {"f": (4, 8), "i": (1, 2, 4, 8), "u": (1, 2, 4, 8)}
_BITS_OF_A_FLOAT = 1e-30
"""Below it a packed colour in text is a float of its bits, above it the whole number that they are."""


def read_pcd(data: bytes, largest: int) -> Table:
    """Return the columns of a PCD file. Raises CloudFileError if its header is wrong or its data end early."""
    header, start = _header(data)
    dtype = _dtype(header)
    count, form = _count(header), (header["DATA"] or [""])[0].lower()
    if form == "ascii":
        columns = _from_text(data[start:], dtype, count)
    elif form == "binary":
        count = (len(data) - start) // dtype.itemsize if count is None else count
        enough(count, dtype.itemsize, len(data) - start)
        table = np.frombuffer(data, dtype, count, start)
        columns = {name: table[name] for name in _single(dtype)}
    elif form == "binary_compressed":
        columns = _from_packed(data, start, dtype, count, largest)
    else:
        raise CloudFileError(f"Its header says DATA {form[:40]}; ascii, binary and binary_compressed can be read.")
    return declared(_with_colors(columns, as_text=form == "ascii"), sensor=_sensor(header))


def _header(data: bytes) -> tuple[Mapping[str, Sequence[str]], int]:
    """The words behind each of the header's, and where the data start."""
    header: dict[str, Sequence[str]] = {}
    start = 0
    while "DATA" not in header:
        end = data.find(b"\n", start, _LONGEST_HEADER)
        if end < 0:
            raise CloudFileError("It isn't a PCD file, or its header has no end.")
        words = data[start:end].decode("utf-8", errors="replace").split()
        if words and not words[0].startswith("#"):
            header.setdefault(words[0].upper(), words[1:])
        start = end + 1
    return header, start


def _dtype(header: Mapping[str, Sequence[str]]) -> np.dtype[np.void]:
    """What stands of each point in a binary file; without SIZE, TYPE and COUNT, floats of 4 bytes."""
    names = header.get("FIELDS", header.get("COLUMNS", []))
    sizes, kinds, counts = (header.get(w, [d] * len(names)) for w, d in (("SIZE", "4"), ("TYPE", "F"), ("COUNT", "1")))
    if not names or not len(names) == len(sizes) == len(kinds) == len(counts):
        raise CloudFileError("Its header is wrong: FIELDS, SIZE, TYPE and COUNT aren't equally many.")
    fields = []
    for k, (name, size, kind, count) in enumerate(zip(names, sizes, kinds, counts, strict=True)):
        letter = _KINDS.get(kind.upper(), "")
        if not (size.isdecimal() and count.isdecimal() and len(count) < 7 and int(size) in _SIZES.get(letter, ())):
            raise CloudFileError(
                f"Its header is wrong: {name[:40]} of type {kind[:9]}, size {size[:9]}, {count[:9]} each."
            )
        shape = () if count == "1" else (int(count),)
        fields.append((f"{k} {name}", f"<{letter}{size}", shape))  # names such as _ stand there more than once
    dtype = np.dtype(fields)
    if not dtype.itemsize:
        raise CloudFileError("Its header is wrong: its points have no numbers.")
    return dtype


def _single(dtype: np.dtype[np.void]) -> list[str]:
    """Fields that are one number; paddings and histograms are none."""
    return [f for f in dtype.names or () if dtype[f].shape == () and f.split(" ", 1)[1] != "_"]


def _count(header: Mapping[str, Sequence[str]]) -> int | None:
    """How many points there are to be; None where the header doesn't say."""
    told: dict[str, int] = {}
    for word in ("POINTS", "WIDTH", "HEIGHT"):
        text = (header.get(word) or [""])[0]
        if word in header and not (text.isdecimal() and len(text) < 16):
            raise CloudFileError(f"Its header is wrong: {word} {text[:40]}.")
        if text:
            told[word] = int(text)
    points, width, height = told.get("POINTS"), told.get("WIDTH"), told.get("HEIGHT", 1)
    if points is not None and width is not None and points != width * height:
        raise CloudFileError(f"Its header says {points} points, but {width} × {height}.")
    return width * height if points is None and width is not None else points


def _from_text(text: bytes, dtype: np.dtype[np.void], count: int | None) -> dict[str, Values]:
    widths = [int(np.prod(dtype[name].shape)) for name in dtype.names or ()]
    width = sum(widths)
    if width > 100 * WIDEST:
        raise CloudFileError(f"Its header says {width:,} numbers for each point.")
    if count is not None:
        enough(count, 2 * width, len(text) + 1)
    numbers = stream(text)
    there = len(numbers) // width
    if len(numbers) % width or (count is not None and there < count):
        more = f" and {len(numbers) % width} numbers" if len(numbers) % width else ""
        raise CloudFileError(
            f"It is cut off, or a number is missing: its header says {there if count is None else count:,} points of"
            f" {width} numbers, and {there:,}{more} are there."
        )
    table: Array = numbers.reshape(-1, width)[:count]
    starts = dict(zip(dtype.names or (), np.cumsum([0, *widths[:-1]]).tolist(), strict=True))
    return {name: _typed(table[:, starts[name]], dtype[name].base) for name in _single(dtype)}


def _typed(values: Array, dtype: np.dtype[np.generic]) -> Values:
    """Numbers of a text as their header declares them, where nothing is lost by it."""
    if dtype.kind == "f" or not np.isfinite(values).all():
        return values
    limits = np.iinfo(dtype)  # type: ignore[type-var]
    return values.astype(dtype) if ((values >= limits.min) & (values <= limits.max)).all() else values


def _from_packed(
    data: bytes, start: int, dtype: np.dtype[np.void], count: int | None, largest: int
) -> dict[str, Values]:
    """Compressed are first all values of the first field, then all of the second."""
    if len(data) < start + 8:
        raise CloudFileError("It is cut off behind its header.")
    packed, unpacked = struct.unpack_from("<II", data, start)
    enough(packed, 1, len(data) - start - 8, "bytes of points")
    count = unpacked // dtype.itemsize if count is None else count
    enough(count, 0, 0)
    if unpacked != count * dtype.itemsize:
        raise CloudFileError(f"Its points need {count * dtype.itemsize:,} bytes, and it holds {unpacked:,}.")
    fits(unpacked, largest)
    body = data[start + 8 : start + 8 + packed]
    try:  # what doesn't get smaller is stored as it is
        plain = body if packed == unpacked else lzf.decompress(body, unpacked)
    except ValueError:
        plain = None
    if plain is None or len(plain) != unpacked:
        raise CloudFileError("It is damaged or cut off: its points can't be unpacked.")
    columns, at = {}, 0
    for name in dtype.names or ():
        if name in _single(dtype):
            columns[name] = np.frombuffer(plain, dtype[name].base, count, at)
        at += count * dtype[name].itemsize
    return columns


def _with_colors(columns: Mapping[str, Values], *, as_text: bool) -> dict[str, Values]:
    """The columns by their names alone, and colours that are packed into one number as three."""
    named = dict[str, Values]()
    for field, values in columns.items():
        name = field.split(" ", 1)[1]
        if name.lower() in ("rgb", "rgba") and (as_text or values.dtype.itemsize == 4):
            named |= unpacked_colors(_bits(values))
        elif name not in named:
            named[name] = values
    return named


def _bits(values: Values) -> np.ndarray[tuple[int, ...], np.dtype[np.uint32]]:
    if values.dtype.itemsize == 4:
        return np.ascontiguousarray(values).view(np.uint32)
    numbers = finite(values)
    if (np.abs(numbers) < _BITS_OF_A_FLOAT).all():
        return numbers.astype(np.float32).view(np.uint32)
    return np.asarray((numbers.astype(np.int64) & 0xFFFFFFFF).astype(np.uint32))


def _sensor(header: Mapping[str, Sequence[str]]) -> Array | None:
    """Where the points were seen from; None for the origin, unturned, which every program writes that doesn't know."""
    try:
        pose = np.array([float(word) for word in header.get("VIEWPOINT", [])])
    except ValueError:
        return None
    if len(pose) != 7 or not np.isfinite(pose).all() or pose.tolist() == [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]:
        return None
    return pose[:3]
