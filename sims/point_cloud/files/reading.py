"""From a name and bytes to a cloud."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import PurePosixPath

import numpy as np

from sims.point_cloud.cloud import Cloud
from sims.point_cloud.files.columns import CloudFileError, Columns, colors_of, intensity_of
from sims.point_cloud.files.las import read_las
from sims.point_cloud.files.pcd import read_pcd
from sims.point_cloud.files.ply import read_ply
from sims.point_cloud.files.text import read_table

FARTHEST = 1e9
"""Metres from the origin, from which on a coordinate is no place on earth."""
UNPACKED = 8
"""How many times the largest file a compressed one may be when unpacked."""

FORMATS: dict[str, Callable[[bytes, int], Columns]] = {
    ".ply": lambda data, _: read_ply(data),
    ".xyz": lambda data, _: read_table(data),
    ".csv": lambda data, _: read_table(data),
    ".txt": lambda data, _: read_table(data),
    ".pcd": read_pcd,
    ".las": read_las,
    ".laz": read_las,
}


def read(name: str, data: bytes, largest: int) -> Cloud:
    """Return the cloud in a file of at most `largest` bytes; the name's ending says in which format it is.

    Points without finite coordinates are left out and counted. Coordinates are in metres, whatever the file's origin.
    Raises CloudFileError, for a learner to read, if there is no cloud in it.
    """
    path = PurePosixPath(name.replace("\\", "/"))
    form = FORMATS.get(path.suffix.lower())
    if form is None:
        raise CloudFileError(f"Files that can be read end in {', '.join(FORMATS)}; this one doesn't.")
    if len(data) > largest:
        raise CloudFileError(f"It is {len(data) / 1e6:,.1f} MB; at most {largest / 1e6:,.1f} MB are taken.")
    if not data:
        raise CloudFileError("It is empty.")
    return _cloud(path.name[-80:], form(data, UNPACKED * largest))


def _cloud(name: str, columns: Columns) -> Cloud:
    points = np.stack([columns[axis].astype(np.float64) for axis in "xyz"], axis=1)
    if not len(points):
        raise CloudFileError("It has no points.")
    with np.errstate(invalid="ignore"):
        good = np.asarray((np.abs(points) < FARTHEST).all(axis=1))
    if not good.any():
        raise CloudFileError(f"None of its {len(points):,} points has finite coordinates.")
    cloud = Cloud(name, points, colors_of(columns), intensity_of(columns))
    dropped = len(points) - int(good.sum())
    return Cloud(**{**vars(cloud.only(good)), "dropped": dropped}) if dropped else cloud
