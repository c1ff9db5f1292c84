"""PLY, as text and as binary of either byte order. Of its elements only the points are read.

Source: Turk 1994, "The PLY polygon file format". No library checks the header's claims before it makes room.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from sims.point_cloud.cloud import Cloud
from sims.point_cloud.files.columns import CloudFileError, Columns, enough, named
from sims.point_cloud.files.text import numbers

TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
    "float": "f4", "double": "f8",
    "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "float32": "f4", "float64": "f8",
}  # fmt: skip
ORDERS = {"ascii": "=", "binary_little_endian": "<", "binary_big_endian": ">"}
_LONGEST_HEADER = 65_536


@dataclass
class _Element:
    name: str
    count: int
    properties: list[tuple[str, str]] = field(default_factory=list)

    def dtype(self, order: str) -> np.dtype[np.void]:
        if any(kind == "list" for _, kind in self.properties):
            raise CloudFileError(f"Its element {self.name[:40]} has lists, which can't be read before or as points.")
        return np.dtype([(name, order + kind) for name, kind in self.properties])


def read_ply(data: bytes) -> Columns:
    """Return the columns of the element `vertex`. Raises CloudFileError if there aren't any, or the data end early."""
    header, start = _header(data)
    form, elements = _elements(header)
    names = [element.name for element in elements]
    if "vertex" not in names:
        raise CloudFileError("Its header has no element vertex, so no points.")
    before, points = elements[: names.index("vertex")], elements[names.index("vertex")]
    if form == "ascii":
        return _from_text(data, start, sum(element.count for element in before), points)
    start += sum(element.count * element.dtype(ORDERS[form]).itemsize for element in before)
    dtype = points.dtype(ORDERS[form])
    enough(points.count, dtype.itemsize, len(data) - start)
    table = np.frombuffer(data, dtype, points.count, start)
    return named({name: table[name] for name in dtype.names or ()})


def ply_bytes(cloud: Cloud) -> bytes:
    """Return the cloud as binary PLY: coordinates as doubles, with colours and intensity if it has them."""
    fields: list[tuple[str, str]] = [("x", "<f8"), ("y", "<f8"), ("z", "<f8")]
    fields += [(name, "u1") for name in ("red", "green", "blue")] if cloud.colors is not None else []
    fields += [("intensity", "<f4")] if cloud.intensity is not None else []
    table = np.empty(len(cloud), np.dtype(fields))
    for index, name in enumerate("xyz"):
        table[name] = cloud.points[:, index]
    if cloud.colors is not None:
        for index, name in enumerate(("red", "green", "blue")):
            table[name] = cloud.colors[:, index]
    if cloud.intensity is not None:
        table["intensity"] = cloud.intensity
    kinds = {"<f8": "double", "<f4": "float", "u1": "uchar"}
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(cloud)}"]
    lines += [f"property {kinds[kind]} {name}" for name, kind in fields]
    return "\n".join([*lines, "end_header", ""]).encode() + table.tobytes()


def _header(data: bytes) -> tuple[list[list[str]], int]:
    """The header's lines as words, and where the data start."""
    if not data.startswith(b"ply"):
        raise CloudFileError("It isn't a PLY file: it doesn't start with “ply”.")
    end = data.find(b"end_header", 0, _LONGEST_HEADER)
    behind = data.find(b"\n", end) + 1
    if end < 0 or behind == 0:
        raise CloudFileError("Its header has no end.")
    text = data[:end].decode("ascii", errors="replace")
    return [line.split() for line in text.splitlines() if line.strip()], behind


def _elements(header: Sequence[Sequence[str]]) -> tuple[str, list[_Element]]:
    form, elements = "", list[_Element]()
    for words in header[1:]:
        match words:
            case ["format", name, _] if name in ORDERS:
                form = name
            case ["element", name, count] if count.isdecimal() and len(count) < 16:
                elements.append(_Element(name, int(count)))
            case ["property", "list", _, _, name] if elements:
                elements[-1].properties.append((name, "list"))
            case ["property", kind, name] if elements and kind in TYPES:
                elements[-1].properties.append((name, TYPES[kind]))
            case ["comment" | "obj_info", *_]:
                pass
            case _:
                raise CloudFileError(f"Its header has a line that PLY doesn't: {' '.join(words)[:60]}")
    if not form:
        raise CloudFileError("Its header doesn't say in which format it is.")
    if any(len({name for name, _ in element.properties}) < len(element.properties) for element in elements):
        raise CloudFileError("Its header has two properties of one name.")
    return form, elements


def _from_text(data: bytes, start: int, skip: int, points: _Element) -> Columns:
    width = len(points.properties)
    enough(points.count, 2 * width, len(data) - start)
    points.dtype("=")
    table = numbers(data[start:], skip, points.count, 1 + data.count(b"\n", 0, start))
    if len(table) < points.count:
        raise CloudFileError(f"It is cut off: its header says {points.count:,} points, and {len(table):,} are there.")
    if table.shape[1] < width:
        raise CloudFileError(f"Its header says {width} numbers for each point, its lines have {table.shape[1]}.")
    return named({name: table[:, column] for column, (name, _) in enumerate(points.properties)})
