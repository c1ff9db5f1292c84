"""LAS and its compressed form LAZ, of airborne and mobile scanners: by laspy, after a look at the header."""

from __future__ import annotations

import io
import logging
import struct
from typing import TYPE_CHECKING

import numpy as np

from sims.point_cloud.files.columns import CloudFileError, Table, Values, declared, enough, fits
from sims.point_cloud.files.crs import units_of

if TYPE_CHECKING:  # it takes long to load, and a server has its children read files
    import laspy

logging.getLogger("laspy").setLevel(logging.CRITICAL)  # whoever brought the file is told, not the administrator
_HEADER, _RECORD = 227, 54  # bytes, of the oldest header and of the smallest variable length record
_CHUNK = 100_000
"""Points that are read at once."""
_FIRST = ("x", "y", "z", "intensity", "red", "green", "blue")
_RAW = ("X", "Y", "Z", "bit_fields", "raw_classification", "classification_flags")
"""Dimensions that are others, before they are scaled or taken apart."""


def read_las(data: bytes, largest: int) -> Table:
    """Return coordinates and whatever else points have. Raises CloudFileError if it isn't LAS or LAZ or is cut off."""
    import laspy

    if not data.startswith(b"LASF") or len(data) < _HEADER:
        raise CloudFileError("It isn't a LAS file, or is cut off within its header.")
    (records,) = struct.unpack_from("<I", data, 100)
    if records * _RECORD > len(data):
        raise CloudFileError("It is cut off within its header's records.")
    try:
        with laspy.open(io.BytesIO(data), read_evlrs=False, laz_backend=laspy.LazBackend.Lazrs) as file:
            header = file.header
            _check(header, data, largest)
            parts = [_columns(points) for points in file.chunk_iterator(_CHUNK)]
    except CloudFileError:
        raise
    except BaseException as error:  # laspy's own, lazrs's, which may be no Exception, and what a broken header leads to
        if not isinstance(error, Exception) and type(error).__name__ != "PanicException":
            raise
        raise CloudFileError("It is damaged or cut off: what follows its header can't be read.") from error
    columns = {name: np.concatenate([part[name] for part in parts]) for name in (parts[0] if parts else ())}
    if not parts or len(columns["x"]) != header.point_count:
        raise CloudFileError(f"It is cut off: its header says {header.point_count:,} points.")
    unit, height_unit, source = units_of([*header.vlrs])
    return declared(columns, unit=unit, height_unit=height_unit, unit_from=source)


def _check(header: laspy.LasHeader, data: bytes, largest: int) -> None:
    size, start = header.point_format.size, header.offset_to_point_data
    if header.are_points_compressed:
        _check_chunks(data, start, size)
    else:
        enough(header.point_count, size, len(data) - start)
    enough(header.point_count, 0, len(data))
    fits(header.point_count * size, largest)


def _check_chunks(data: bytes, start: int, size: int) -> None:
    """lazrs makes room for as many chunks as the table claims; in each, one point stands uncompressed."""
    at = data.find(b"laszip encoded", 0, start)
    (compressor,) = struct.unpack_from("<H", data, at + 52) if 0 <= at < len(data) - 54 else (0,)
    if compressor == 1:
        raise CloudFileError(
            "It is LAZ of the first kind, without chunks, which can't be read: open it in another program, and save it"
            " as LAS, or as LAZ once more."
        )
    (table,) = struct.unpack_from("<q", data, start) if start + 8 <= len(data) else (0,)
    if table == -1:  # written as a stream: where the table is stands at the end
        (table,) = struct.unpack_from("<q", data, len(data) - 8)
    if not start < table <= len(data) - 8:
        raise CloudFileError("It is damaged or cut off: the table of its chunks isn't there.")
    _, chunks = struct.unpack_from("<II", data, table)
    if chunks * size > len(data):
        raise CloudFileError(f"It is damaged: it can't have {chunks:,} chunks.")


def _columns(points: laspy.ScaleAwarePointRecord) -> dict[str, Values]:
    dimensions = list(points.point_format.dimension_names)
    names = [*_FIRST, *points.point_format.extra_dimension_names, *dimensions]
    kept = [name for name in dict.fromkeys(names) if name in (*"xyz", *dimensions) and name not in _RAW]
    columns = {name: np.asarray(getattr(points, name) if name in "xyz" else points[name]) for name in kept}
    return {name: values for name, values in columns.items() if values.ndim == 1}
