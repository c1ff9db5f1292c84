"""From a name and bytes to a cloud."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import PurePosixPath
from typing import Any

import numpy as np

from sims.point_cloud.cloud import Cloud
from sims.point_cloud.files import placing
from sims.point_cloud.files.columns import CloudFileError, Table, floats
from sims.point_cloud.files.las import read_las
from sims.point_cloud.files.meaning import COLORS, NORMALS, taken
from sims.point_cloud.files.pcd import read_pcd
from sims.point_cloud.files.ply import read_ply
from sims.point_cloud.files.text import read_table
from sims.point_cloud.files.units import LABELS, Unit, in_metres, unit_of
from sims.point_cloud.files.values import colors_of, intensity_of, normals_of

FARTHEST = 1e12
"""In any unit: what is farther is a mark for nothing."""
UNPACKED = 8
"""How many times the largest file a compressed one may be when unpacked."""
MOST_SHOWN = 500_000
"""Points: what a browser turns smoothly."""
PREVIEWED_COLUMNS = 40

FORMATS: dict[str, Callable[[bytes, int], Table]] = {
    ".ply": lambda data, _: read_ply(data),
    ".xyz": lambda data, _: read_table(data),
    ".csv": lambda data, _: read_table(data),
    ".txt": lambda data, _: read_table(data),
    ".asc": lambda data, _: read_table(data),
    ".pts": lambda data, _: read_table(data),
    ".pcd": read_pcd,
    ".las": read_las,
    ".laz": read_las,
}


def read(
    name: str, data: bytes, largest: int, columns: Sequence[str] = (), units: str = "auto", most: int = MOST_SHOWN
) -> Cloud:
    """Return the cloud in a file of at most `largest` bytes; the name's ending says in which format it is.

    `columns` are what its columns are to be taken for (`meaning.ROLES`), as far as that isn't to be guessed; `units`
    are those of its coordinates (`units.METRES`), or `auto`. The cloud is in metres, near the origin, and of at most
    `most` points; what was left out of it is counted, and what was taken for what is said in its notes.
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
    table = form(data, UNPACKED * largest)
    if not len(table):
        raise CloudFileError("It has no points.")
    return _cloud(path.name[-80:], table, taken(table, columns), units, most)


def _cloud(name: str, table: Table, roles: Sequence[str], units: str, most: int) -> Cloud:
    by_role = {role: values for role, values in zip(roles, table.values, strict=True) if values is not None}
    points = np.stack([floats(by_role[axis]) for axis in "xyz"], axis=1)
    with np.errstate(invalid="ignore"):
        rows = np.flatnonzero((np.abs(points) < FARTHEST).all(axis=1))
    if not len(rows):
        raise CloudFileError(f"None of its {len(points):,} points has coordinates that are finite, and below 1e12.")
    dropped = len(points) - len(rows)
    unit = unit_of(table, roles, points[rows], units)
    points, sensor, center = in_metres(points[rows], unit, table.sensor)
    far = placing.strays(points)
    farthest = float(np.linalg.norm(points[far] - np.median(points[~far], axis=0), axis=1).max()) if far.any() else 0.0
    kept = np.flatnonzero(~far)
    left_out = max(len(kept) - most, 0)
    if left_out:
        kept = kept[placing.chosen(len(kept), most)]
    points, rows = points[kept], rows[kept]
    origin = placing.origin_of(points)
    if origin is not None:
        points, sensor = points - origin, None if sensor is None else sensor - origin
    points = placing.without_dust(points)
    values, notes, cautions = _values(table, by_role, rows)
    strays = int(np.count_nonzero(far))
    said = f"{strays:,} points" if strays > 1 else "1 point"
    if strays:
        how = f"up to {farthest:,.0f} m" if strays > 1 else f"{farthest:,.0f} m"
        cautions.append(f"{said} far from all others, {how} away, left out: a stray would hide the rest.")
    if left_out:
        cautions.append(f"Too many for a browser: {left_out:,} points, chosen at random, were left out.")
    if dropped:
        cautions.append(f"{dropped:,} points without finite coordinates were left out.")
    if sensor is not None:
        notes.append("It says from where it was seen: normals point towards there.")
    return Cloud(
        name, points, sensor=sensor, dropped=dropped, left_out=left_out, strays=strays, origin=origin, unit=unit.name,
        columns=tuple(table.names[:PREVIEWED_COLUMNS]), roles=tuple(roles[:PREVIEWED_COLUMNS]),
        preview=tuple(tuple(entries) for entries in table.preview[:PREVIEWED_COLUMNS]),
        notes=(_of_unit(unit, center), *notes), cautions=tuple(cautions), **values,
    )  # fmt: skip


def _values(table: Table, by_role: dict[str, Any], rows: Any) -> tuple[dict[str, Any], list[str], list[str]]:
    """What points have beside their place, and what is to be said of it."""
    values: dict[str, Any] = {}
    notes, cautions = list[str](), list[str]()
    if set(COLORS) <= set(by_role):
        colors, scale = colors_of([by_role[channel] for channel in COLORS], table.declared)
        if colors.any():
            values["colors"] = colors[rows]
            notes.append(f"Colours read {scale}.")
        else:
            cautions.append("Its colours are all zero: it counts as one without colours.")
    if "intensity" in by_role:
        intensity, span = intensity_of(by_role["intensity"])
        if not np.isnan(intensity[rows]).all():
            values |= {"intensity": intensity[rows], "intensity_span": span}
            low, high = (f"{value:,.6g}".replace("-", "−") for value in span)
            notes.append(f"Intensities 0 to 1 stand for {low} to {high} in the file.")
    if set(NORMALS) <= set(by_role):
        normals = normals_of([by_role[axis][rows] for axis in NORMALS])
        if normals is None:
            cautions.append("Its normals are all zero: they are worked out from the points.")
        else:
            values["normals"] = normals
            notes.append("The normals are the file's own.")
    return values, notes, cautions


def _of_unit(unit: Unit, center: tuple[float, float] | None) -> str:
    """What unit the coordinates were taken to be in, in words."""
    if not unit.source:
        return "Taken as metres: nothing in the file says in which unit it is."
    if center is not None:
        east, north = center
        where = f"{abs(north):.6f}° {'N' if north >= 0.0 else 'S'}, {abs(east):.6f}° {'E' if east >= 0.0 else 'W'}"
        return f"Longitude and latitude in degrees, {unit.source}, made metres east and north of {where}."
    words = LABELS[unit.name]
    if unit.height != unit.name:
        words += f", heights in {LABELS[unit.height]}"
    return f"In {words}, {unit.source}." if unit.name == "metres" else f"In {words}, {unit.source}; made metres."
