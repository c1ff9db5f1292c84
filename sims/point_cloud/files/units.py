"""In which unit coordinates are: as the file's coordinate system says, as their size gives away, or as chosen."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from geometry.arrays import Array
from sims.point_cloud.files.columns import CloudFileError, Table

METRES = {"metres": 1.0, "millimetres": 0.001, "feet": 0.3048, "us-feet": 1200.0 / 3937.0, "degrees": math.nan}
"""Units of coordinates; of degrees no number of metres."""
LABELS = {"metres": "metres", "millimetres": "millimetres", "feet": "feet", "us-feet": "US survey feet"}
NO_PLACE_IN_METRES = 5e7
"""Farther from the origin no map projection's coordinates in metres or feet are: they are millimetres."""
_EQUATOR, _SQUARED_ECCENTRICITY = 6_378_137.0, 0.006_694_38
"""Equatorial radius in metres, and eccentricity squared, of the ellipsoid WGS 84."""
_WORDS = (
    ("us-feet", r"us[ _-]*survey[ _-]*f|us[ _]?ft|ft[ _]?us|foot[ _]us|us[ _]f(oo|ee)t"),
    ("feet", r"\bf(oo|ee)t\b|\bft\b"),
    ("millimetres", r"millimet|\bmm\b"),
    ("degrees", r"\bdegrees?\b|\bdeg\b"),
    ("metres", r"\bmet(re|er)s?\b|\bm\b"),
)


@dataclass(frozen=True)
class Unit:
    """The unit of x and y, that of z, and where it is known from, in words."""

    name: str
    height: str
    source: str


def unit_named(words: str) -> str:
    """The unit that some words speak of; empty for none."""
    lower = words.lower()
    return next((unit for unit, pattern in _WORDS if re.search(pattern, lower)), "")


def unit_of(table: Table, roles: Sequence[str], points: Array, chosen: str) -> Unit:
    """Which unit finite points (N, 3) are in."""
    if chosen != "auto":
        return Unit(chosen, "metres" if chosen == "degrees" else chosen, "as chosen")
    if table.unit:
        return Unit(
            table.unit, table.height_unit or ("metres" if table.unit == "degrees" else table.unit), table.unit_from
        )
    name = table.names[roles.index("x")].lower()
    if re.match(r"lon|lng", name):
        return Unit("degrees", "metres", "as its columns are called")
    if found := re.search(r"[_ \[(](mm|ft|feet)[\])]?$", name):
        unit = unit_named(found[1])
        return Unit(unit, unit, "as its columns are called")
    middle = np.abs(np.median(points, axis=0))
    if middle.max() > NO_PLACE_IN_METRES:
        return Unit("millimetres", "millimetres", "guessed: in metres no place on earth has such coordinates")
    if _looks_geographic(points):
        return Unit("degrees", "metres", "guessed: narrow as they are, x and y can only be longitude and latitude")
    return Unit("metres", "metres", "")


def _looks_geographic(points: Array) -> bool:
    """So far from 0, 0 and so much narrower than high is no scan in metres."""
    low, high = np.percentile(points, (5, 95), axis=0)
    middle, size = np.abs(0.5 * (low + high)), high - low
    inside = middle[0] <= 180.0 and middle[1] <= 90.0
    wide = max(size[0], size[1])
    return bool(inside and 0.0 < wide < 0.2 and middle[:2].min() > 100.0 * wide and size[2] > 20.0 * wide)


def in_metres(
    points: Array, unit: Unit, sensor: Array | None
) -> tuple[Array, Array | None, tuple[float, float] | None]:
    """Points (N, 3) and a sensor (3,) in metres; of degrees also the longitude and latitude that became x = y = 0."""
    height = METRES[unit.height]
    if unit.name != "degrees":
        scale = np.array([METRES[unit.name], METRES[unit.name], height])
        return points * scale, None if sensor is None else sensor * scale, None
    longitude, latitude = np.median(points[:, :2], axis=0).tolist()
    if not (abs(longitude) <= 360.0 and abs(latitude) <= 90.0):
        raise CloudFileError(
            f"Its x and y, about {longitude:,.6g} and {latitude:,.6g}, can't be longitude and latitude in degrees."
        )
    sine = math.sin(math.radians(latitude))
    bend = 1.0 - _SQUARED_ECCENTRICITY * sine * sine
    east = math.radians(1.0) * _EQUATOR / math.sqrt(bend) * math.cos(math.radians(latitude))
    north = math.radians(1.0) * _EQUATOR * (1.0 - _SQUARED_ECCENTRICITY) / bend**1.5
    scale, start = np.array([east, north, height]), np.array([longitude, latitude, 0.0])
    placed = None if sensor is None else (sensor - start) * scale
    return (points - start) * scale, placed, (longitude, latitude)
