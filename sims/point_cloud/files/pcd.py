"""PCD, the Point Cloud Library's format, as text, binary and compressed: by pypcd4, after a look at the header."""

from __future__ import annotations

import io
import struct

import numpy as np
import numpy.typing as npt
from pypcd4.pypcd4 import MetaData, PointCloud

from sims.point_cloud.files.columns import CloudFileError, Columns, enough, fits, named

_LONGEST_HEADER = 8192


def read_pcd(data: bytes, largest: int) -> Columns:
    """Return the columns of a PCD file. Raises CloudFileError if its header is wrong or its data end early."""
    lines, start = _header(data)
    try:
        header = MetaData.parse_header(lines)
        size = header.build_dtype().itemsize
    except (KeyError, ValueError, TypeError, IndexError) as error:
        raise CloudFileError(f"Its header is wrong: {str(error).splitlines()[0][:100]}") from None
    if header.points != header.width * header.height:
        raise CloudFileError(f"Its header says {header.points} points, but {header.width} × {header.height}.")
    form = header.data.value
    if form == "ascii":
        enough(header.points, 2 * len(header.fields), len(data) - start + 1)
    elif form == "binary":
        enough(header.points, size, len(data) - start)
    else:
        _check_compressed(data, start, header.points * size, largest)
    cloud = _decoded(data)
    if len(cloud.pc_data) != header.points:
        raise CloudFileError(
            f"It is cut off: its header says {header.points:,} points, {len(cloud.pc_data):,} are there."
        )
    return named(_columns(cloud.pc_data))


def _header(data: bytes) -> tuple[list[str], int]:
    end = data.find(b"\nDATA", 0, _LONGEST_HEADER)
    behind = data.find(b"\n", end + 1) + 1
    if end < 0 or behind == 0:
        raise CloudFileError("It isn't a PCD file, or its header has no end.")
    text = data[:behind].decode("ascii", errors="replace")
    return [line for line in text.splitlines() if line.strip() and not line.startswith("#")], behind


def _check_compressed(data: bytes, start: int, whole: int, largest: int) -> None:
    if len(data) < start + 8:
        raise CloudFileError("It is cut off behind its header.")
    packed, unpacked = struct.unpack_from("<II", data, start)
    enough(packed, 1, len(data) - start - 8, "bytes of points")
    if unpacked != whole:
        raise CloudFileError(f"Its points need {whole:,} bytes, and it holds {unpacked:,}.")
    fits(unpacked, largest)


def _decoded(data: bytes) -> PointCloud:
    try:
        return PointCloud.from_fileobj(io.BufferedReader(io.BytesIO(data)))
    except (ValueError, RuntimeError, KeyError, struct.error) as error:
        raise CloudFileError("It is damaged or cut off: its points aren't as its header says.") from error


def _columns(table: npt.NDArray[np.void]) -> dict[str, npt.NDArray[np.generic]]:
    columns = {name: np.atleast_1d(table[name]) for name in table.dtype.names or ()}
    for packed in ("rgb", "rgba"):
        if packed in columns and columns[packed].dtype.itemsize == 4:
            bits = np.ascontiguousarray(columns.pop(packed)).view(np.uint32)
            columns |= {name: (bits >> shift) & 255 for name, shift in (("red", 16), ("green", 8), ("blue", 0))}
    return columns
