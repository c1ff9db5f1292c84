"""The unit that a LAS file's coordinate system is in: as WKT, or as the GeoTIFF keys of older files.

Only the unit is looked for, and no coordinate is projected.
Sources: ASPRS LAS 1.4 R15, "Coordinate reference system VLR"; OGC 19-008r4 (GeoTIFF); OGC 01-009 and 18-010 (WKT).
"""

from __future__ import annotations

import re
import struct
from collections.abc import Sequence
from typing import Any

from sims.point_cloud.files.units import unit_named

_WKT, _KEYS, _WORDS = 2112, 34735, 34737
_MODEL, _CITATIONS, _ANGULAR, _LINEAR, _VERTICAL = 1024, (1026, 2049, 3073), 2054, 3076, 4099
_CODES = {9001: "metres", 9002: "feet", 9003: "us-feet", 9025: "millimetres", 9102: "degrees", 9122: "degrees"}


def units_of(records: Sequence[Any]) -> tuple[str, str, str]:
    """Units of x and y, and of z, empty where nothing says, and where that is from, of a LAS file's records."""
    found = {int(r.record_id): r.record_data_bytes() for r in records if r.user_id.strip("\0 ") == "LASF_Projection"}
    if _WKT in found:
        text = found[_WKT].decode("utf-8", errors="replace").strip("\0 ")
        unit, height = _of_wkt(text)
    elif _KEYS in found:
        unit, height = _of_keys(found[_KEYS], found.get(_WORDS, b""))
        text = "".join(_citation(found[_KEYS], found.get(_WORDS, b"")))
    else:
        return "", "", ""
    name = re.search(r'"([^"]{3,80})"', text)
    said = name[1] if name else text.split("|")[0].strip("\0 ")[:60]
    return unit, height, f"as its coordinate system says{f' ({said})' if said else ''}"


def _of_wkt(text: str) -> tuple[str, str]:
    """The last unit of the horizontal part is that of its axes, and the last of the vertical one that of heights."""
    start = re.search(r"(?:VERT_CS|VERTCRS|VERTICALCRS)\s*\[", text, re.IGNORECASE)
    flat, upright = (text[: start.start()], text[start.start() :]) if start else (text, "")
    projected = re.search(r"(?:PROJCS|PROJCRS|PROJECTEDCRS)\s*\[", flat, re.IGNORECASE)
    unit = _last_unit(flat)
    return ("degrees" if not projected and unit in ("", "degrees") and flat else unit), _last_unit(upright)


def _last_unit(text: str) -> str:
    units = re.findall(r'(?:LENGTHUNIT|ANGLEUNIT|UNIT)\s*\[\s*"([^"]*)"\s*,\s*([-+.\deE]+)', text, re.IGNORECASE)
    if not units:
        return ""
    name, size = units[-1]
    try:
        metres = float(size)
    except ValueError:
        return unit_named(name)
    for unit, exact in (("metres", 1.0), ("us-feet", 1200.0 / 3937.0), ("feet", 0.3048), ("millimetres", 0.001)):
        if abs(metres - exact) < 1e-7 * exact:
            return unit
    return unit_named(name)


def _entries(keys: bytes) -> dict[int, tuple[int, int, int]]:
    """Where each key's value is (0: here), how long it is, and the value or its place."""
    count = min(struct.unpack_from("<H", keys, 6)[0] if len(keys) >= 8 else 0, len(keys) // 8 - 1)
    rows = (struct.unpack_from("<4H", keys, 8 + 8 * k) for k in range(max(count, 0)))
    return {key: (where, length, value) for key, where, length, value in rows}


def _citation(keys: bytes, words: bytes) -> list[str]:
    found = _entries(keys)
    texts = [found[key] for key in _CITATIONS if key in found and found[key][0] == _WORDS]
    return [words[at : at + length].decode("utf-8", errors="replace") for _, length, at in texts]


def _of_keys(keys: bytes, words: bytes) -> tuple[str, str]:
    found = {key: value for key, (where, _, value) in _entries(keys).items() if where == 0}
    height = _CODES.get(found.get(_VERTICAL, 0), "")
    if found.get(_MODEL) == 2:
        return "degrees", height
    said = unit_named(" ".join(_citation(keys, words)))
    return _CODES.get(found.get(_LINEAR, 0), "") or (said if said != "degrees" else ""), height
