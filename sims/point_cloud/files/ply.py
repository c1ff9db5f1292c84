"""PLY, as text and as binary of either byte order. Of its elements only the points are read.

Source: Turk 1994, "The PLY polygon file format". trimesh reads PLY too, but a text by its lines, where PLY counts
numbers, no header that ends its lines in CR, and lists only where all are as long as the first.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from geometry.arrays import Array
from geometry.clouds import Indices
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.files.columns import CloudFileError, Table, Values, declared, enough
from sims.point_cloud.files.numbers import rows, stream
from sims.point_cloud.files.units import unit_named

TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "long": "i8", "ulong": "u8",
    "float": "f4", "double": "f8",
    "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4", "int64": "i8",
    "uint64": "u8", "float32": "f4", "float64": "f8",
}  # fmt: skip
ORDERS = {"ascii": "=", "binary_little_endian": "<", "binary_big_endian": ">"}
_LONGEST_HEADER = 262_144
_LONGEST_LIST = 65_536


@dataclass(frozen=True)
class _Property:
    """A number, or, with the type of its `length`, a list of numbers."""

    name: str
    kind: str
    length: str = ""


@dataclass
class _Element:
    name: str
    count: int
    properties: list[_Property] = field(default_factory=list)

    @property
    def has_lists(self) -> bool:
        return any(one.length for one in self.properties)

    def dtype(self, order: str, lengths: Sequence[int] = ()) -> np.dtype[np.void]:
        """How one of them stands in a binary file, with lists of these lengths."""
        left, fields = list(lengths), list[tuple[Any, ...]]()
        for one in self.properties:
            if one.length:
                fields += [(f"length of {one.name}", order + one.length), (one.name, order + one.kind, (left.pop(0),))]
            else:
                fields.append((one.name, order + one.kind))
        return np.dtype(fields)

    def shortest(self) -> int:
        """Bytes of one whose lists are empty."""
        return sum(np.dtype(one.length or one.kind).itemsize for one in self.properties)

    def numbers(self) -> list[str]:
        return [one.name for one in self.properties if not one.length]


def read_ply(data: bytes) -> Table:
    """Return the columns of the element `vertex`. Raises CloudFileError if there aren't any, or the data end early."""
    header, start = _header(data)
    form, elements = _elements(header)
    names = [element.name for element in elements]
    if "vertex" not in names:
        raise CloudFileError("Its header has no element vertex, so no points.")
    before, points = elements[: names.index("vertex")], elements[names.index("vertex")]
    enough(points.count, 0, 0)
    if form == "ascii":
        behind = elements[len(before) + 1 :]
        columns = _from_text(data[start:], before, points, behind, 1 + len(header))
    else:
        for element in before:
            start = _table(data, start, element, ORDERS[form])[1]
        columns = _table(data, start, points, ORDERS[form])[0]
    comments = " ".join(" ".join(words[1:]) for words in header if words and words[0] in ("comment", "obj_info"))
    unit = unit_named(comments) if "unit" in comments.lower() else ""
    return declared(columns, unit=unit, unit_from="as a comment in the file says")


def ply_bytes(cloud: Cloud, labels: Indices | None = None, meaning: str = "", faces: Indices | None = None) -> bytes:
    """Return the cloud as binary PLY: coordinates as doubles, and the colours, intensities and normals that it has.

    Of each point a `label` (N,) may follow, a whole number with its `meaning`; and triangles (T, 3) between the points.
    """
    columns: dict[str, Values] = {name: cloud.points[:, k].astype("<f8") for k, name in enumerate("xyz")}
    if cloud.normals is not None:
        columns |= {name: cloud.normals[:, k].astype("<f4") for k, name in enumerate(("nx", "ny", "nz"))}
    if cloud.colors is not None:
        columns |= {name: cloud.colors[:, k].astype("u1") for k, name in enumerate(("red", "green", "blue"))}
    if cloud.intensity is not None:
        low, high = cloud.intensity_span or (0.0, 1.0)
        columns["intensity"] = (low + (high - low) * cloud.intensity).astype("<f4")
    if labels is not None:
        columns["label"] = labels.astype("<i4")
    table = np.empty(len(cloud), np.dtype([(name, values.dtype.str) for name, values in columns.items()]))
    for name, values in columns.items():
        table[name] = values
    kinds = {"<f8": "double", "<f4": "float", "|u1": "uchar", "<i4": "int"}
    lines = ["ply", "format binary_little_endian 1.0", *([f"comment label: {meaning}"] if labels is not None else [])]
    lines.append(f"element vertex {len(cloud)}")
    lines += [f"property {kinds[values.dtype.str]} {name}" for name, values in columns.items()]
    triangles = np.empty(0 if faces is None else len(faces), [("count", "u1"), ("corners", "<i4", 3)])
    if faces is not None:
        lines += [f"element face {len(faces)}", "property list uchar int vertex_indices"]
        triangles["count"], triangles["corners"] = 3, faces
    return "\n".join([*lines, "end_header", ""]).encode() + table.tobytes() + triangles.tobytes()


def _header(data: bytes) -> tuple[list[list[str]], int]:
    """The header's lines as words, empty ones too, and where the data start."""
    if not data.startswith(b"ply"):
        raise CloudFileError("It isn't a PLY file: it doesn't start with “ply”.")
    ending = b"\r\n" if data[3:5] == b"\r\n" else data[3:4] if data[3:4] in (b"\r", b"\n") else b"\n"
    end = data.find(ending + b"end_header", 0, _LONGEST_HEADER)
    behind = data.find(ending, end + len(ending)) if end >= 0 else -1
    if end < 0 or behind < 0:
        raise CloudFileError("Its header has no end.")
    text = data[:behind].decode("utf-8", errors="replace")
    return [line.split() for line in text.split(ending.decode())], behind + len(ending)


def _elements(header: Sequence[Sequence[str]]) -> tuple[str, list[_Element]]:
    form, elements = "", list[_Element]()
    for words in header[1:-1]:
        match words:
            case ["format", name, *_] if name in ORDERS:
                form = name
            case ["element", name, count] if count.isdecimal() and len(count) < 16:
                elements.append(_Element(name, int(count)))
            case ["property", "list", length, kind, name] if elements and TYPES.keys() >= {length, kind}:
                elements[-1].properties.append(_Property(name, TYPES[kind], TYPES[length]))
            case ["property", kind, name] if elements and kind in TYPES:
                elements[-1].properties.append(_Property(name, TYPES[kind]))
            case ["comment" | "obj_info", *_] | []:
                pass
            case _:
                raise CloudFileError(f"Its header has a line that PLY doesn't: {' '.join(words)[:60]}")
    if not form:
        raise CloudFileError("Its header doesn't say in which format it is.")
    if any(len({one.name for one in element.properties}) < len(element.properties) for element in elements):
        raise CloudFileError("Its header has two properties of one name.")
    return form, elements


def _table(data: bytes, start: int, element: _Element, order: str) -> tuple[dict[str, Values], int]:
    """The numbers of an element in a binary file, without its lists, and where it ends."""
    if not element.count or not element.properties:
        return {}, start
    enough(element.count, element.shortest(), len(data) - start)
    lengths = _lengths(data, start, element, order)
    dtype = element.dtype(order, lengths)
    if dtype.itemsize * element.count <= len(data) - start:
        table = np.frombuffer(data, dtype, element.count, start)
        lists = [one.name for one in element.properties if one.length]
        if all((table[f"length of {n}"] == length).all() for n, length in zip(lists, lengths, strict=True)):
            return {name: table[name] for name in element.numbers()}, start + table.nbytes
    elif not element.has_lists:
        enough(element.count, dtype.itemsize, len(data) - start)
    return _walked(data, start, element, order)


def _lengths(data: bytes, start: int, element: _Element, order: str) -> list[int]:
    """Lengths of the lists of the first of an element."""
    lengths = list[int]()
    for one in element.properties:
        if one.length:
            length, start = _one(data, start, order + one.length)
            lengths.append(_as_length(length))
            start += lengths[-1] * np.dtype(one.kind).itemsize
        else:
            start += np.dtype(one.kind).itemsize
    return lengths


def _walked(data: bytes, start: int, element: _Element, order: str) -> tuple[dict[str, Values], int]:
    """The same one by one, since their lists are of different lengths."""
    columns: dict[str, list[float]] = {name: [] for name in element.numbers()}
    parts = [
        (
            struct.Struct(order + np.dtype(one.length or one.kind).char),
            one.name,
            one.length and np.dtype(one.kind).itemsize,
        )
        for one in element.properties
    ]
    try:
        for _ in range(element.count):
            for part, name, size in parts:
                (value,) = part.unpack_from(data, start)
                start += part.size
                if size:
                    start += size * _as_length(value)
                else:
                    columns[name].append(value)
    except struct.error:
        raise _cut_off(element) from None
    kinds = {one.name: one.kind for one in element.properties}
    return {name: np.array(values, kinds[name]) for name, values in columns.items()}, start


def _one(data: bytes, start: int, kind: str) -> tuple[float, int]:
    size = np.dtype(kind).itemsize
    if start + size > len(data):
        raise CloudFileError("It is cut off: its lists end early.")
    return np.frombuffer(data, kind, 1, start)[0].item(), start + size


def _as_length(value: float) -> int:
    if not (0 <= value <= _LONGEST_LIST and value == int(value)):
        raise CloudFileError(f"It is damaged: it has a list of {value:,.6g} numbers.")
    return int(value)


def _cut_off(element: _Element) -> CloudFileError:
    what = "points" if element.name == "vertex" else f"of its element {element.name[:40]}"
    return CloudFileError(f"It is cut off: its header says {element.count:,} {what}, and fewer are there.")


def _from_text(
    text: bytes, before: Sequence[_Element], points: _Element, behind: Sequence[_Element], line: int
) -> dict[str, Values]:
    """Columns of the points in a text: one on each line if there are as many lines, else as one row of numbers."""
    enough(points.count, 2 * len(points.properties), len(text) + 1)
    text = text.replace(b"\r\n", b"\n").replace(b"\r", b"\n") if b"\r" in text else text
    ends = np.flatnonzero(np.frombuffer(text, np.uint8) == ord("\n"))
    skipped = sum(element.count for element in before)
    every = skipped + points.count + sum(element.count for element in behind)
    in_lines = len(ends) + (not text.endswith(b"\n")) == every or (not before and not behind and len(ends) > every / 2)
    if in_lines and not points.has_lists:
        start = ends[skipped - 1] + 1 if skipped else 0
        end = ends[skipped + points.count - 1] if skipped + points.count <= len(ends) else len(text)
        table = rows(text[start:end], line + skipped)
        if len(table) < points.count:
            raise _cut_off(points)
        if table.shape[1] != len(points.properties):
            width = len(points.properties)
            raise CloudFileError(f"Its header says {width} numbers for each point, its lines have {table.shape[1]}.")
    else:
        table = _from_stream(text, before, points)
    kinds = {one.name: one.kind for one in points.properties}
    return {name: _typed(table[:, k], kinds[name]) for k, name in enumerate(points.numbers())}


def _from_stream(text: bytes, before: Sequence[_Element], points: _Element) -> Array:
    """The points' numbers (N, columns), without their lists, from a text whose lines mean nothing."""
    plain = not any(element.has_lists for element in (*before, points))
    width = len(points.properties)
    start = sum(element.count * len(element.properties) for element in before)
    if plain:
        enough(start + points.count * width, 2, len(text) + 1, "numbers")
    numbers = stream(text)
    if plain:
        if len(numbers) < start + points.count * width:
            raise _cut_off(points)
        return numbers[start : start + points.count * width].reshape(points.count, width)
    values, at = numbers.tolist(), 0
    table = np.empty((points.count, len(points.numbers())))
    try:
        for element in (*before, points):
            for row in range(element.count):
                column = 0
                for one in element.properties:
                    value = values[at]
                    at += 1
                    if one.length:
                        at += _as_length(value)
                    elif element is points:
                        table[row, column] = value
                        column += 1
    except IndexError:
        raise _cut_off(points) from None
    if at > len(values):
        raise _cut_off(points)
    return table


def _typed(values: Array, kind: str) -> Values:
    """Numbers of a text as the header declares them, where nothing is lost by it."""
    if kind.startswith("f") or not np.isfinite(values).all():
        return values
    limits = np.iinfo(kind)
    return values.astype(kind) if ((values >= limits.min) & (values <= limits.max)).all() else values
