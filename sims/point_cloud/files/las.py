"""LAS and its compressed form LAZ, of airborne and mobile scanners: by laspy, after a look at the header."""

from __future__ import annotations

import io
import logging
import struct

import laspy
import numpy as np

from sims.point_cloud.files.columns import CloudFileError, Columns, enough, fits

logging.getLogger("laspy").setLevel(logging.CRITICAL)  # whoever brought the file is told, not the administrator
_HEADER, _RECORD = 227, 54  # bytes, of the oldest header and of the smallest variable length record
_CHUNK = 2_000
"""Points that are read at once: some milliseconds, while which everybody else's sim waits."""


def read_las(data: bytes, largest: int) -> Columns:
    """Return coordinates, intensity and perhaps colours. Raises CloudFileError if it isn't LAS or LAZ or is cut off."""
    if not data.startswith(b"LASF") or len(data) < _HEADER:
        raise CloudFileError("It isn't a LAS file, or is cut off within its header.")
    (records,) = struct.unpack_from("<I", data, 100)
    if records * _RECORD > len(data):
        raise CloudFileError("It is cut off within its header's records.")
    try:
        with laspy.open(io.BytesIO(data), read_evlrs=False, laz_backend=laspy.LazBackend.Lazrs) as file:
            header = file.header
            _check(header, len(data), largest)
            parts = [_columns(points) for points in file.chunk_iterator(_CHUNK)]
    except CloudFileError:
        raise
    except Exception as error:  # laspy's own, lazrs's and what a broken header leads to
        raise CloudFileError("It is damaged or cut off: what follows its header can't be read.") from error
    columns = {name: np.concatenate([part[name] for part in parts]) for name in (parts[0] if parts else ())}
    if not parts or len(columns["x"]) != header.point_count:
        raise CloudFileError(f"It is cut off: its header says {header.point_count:,} points.")
    return columns


def _check(header: laspy.LasHeader, there: int, largest: int) -> None:
    size = header.point_format.size
    if not header.are_points_compressed:
        enough(header.point_count, size, there - header.offset_to_point_data)
    enough(header.point_count, 0, there)
    fits(header.point_count * size, largest)


def _columns(points: laspy.ScaleAwarePointRecord) -> dict[str, np.ndarray]:
    names = set(points.point_format.dimension_names)
    columns = {name: np.asarray(getattr(points, name), dtype=np.float64) for name in "xyz"}
    columns |= {name: np.array(points[name]) for name in ("intensity", "red", "green", "blue") if name in names}
    return columns
