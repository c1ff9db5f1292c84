"""Clouds that aren't built in: those that learners bring, and those in the administrator's folder.

A learner's cloud is known by an unguessable name as long as its session keeps it; nothing here does. An
administrator's is known by its file's name, and read when somebody asks for it.
"""

from __future__ import annotations

import re
import secrets
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any
from weakref import WeakValueDictionary

import numpy as np

from geometry import clouds
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.files import FORMATS, CloudFileError, read

UPLOAD = "upload-"
NAME = r'^[^/\\\x00-\x1f"<>|:*?]{1,120}$'
"""Of a file, without a path."""
FAR = 10_000.0
"""Metres from the origin, from which on coordinates as the browser has them (float32) would lose millimetres."""
MOST_SHOWN = 500_000
"""Points: what a browser turns smoothly."""
NOTHING = Cloud("", np.empty((0, 3)))

_brought: WeakValueDictionary[str, Cloud] = WeakValueDictionary()
_folder: dict[str, Path] = {}
_largest = 100_000_000


def bring(name: str, data: bytes, largest: int) -> tuple[Cloud, Mapping[str, Any]]:
    """Make a cloud of a learner's file; return it, to be kept, and the changes of the state that show it."""
    cloud = placed(read(name, data, largest))
    known_as = UPLOAD + secrets.token_urlsafe(12)
    _brought[known_as] = cloud
    return cloud, {"dataset": "file", "file": known_as}


def offer(folder: Path, largest: int) -> None:
    """Offer the clouds in a folder, not those in folders inside it."""
    global _largest
    _largest = largest
    _folder.clear()
    kept = (path for path in sorted(folder.iterdir()) if path.suffix.lower() in FORMATS and path.is_file())
    _folder.update({path.name: path for path in kept if re.match(NAME, path.name)})
    _from_folder.cache_clear()


def offered(file: str | None) -> dict[str | None, str]:
    """What there is to choose from in a state, with its name for people."""
    offers: dict[str | None, str] = {None: "None", **{name: name for name in _folder}}
    if file and file not in _folder:
        offers[file] = f"Yours: {_brought[file].name}" if file in _brought else "Gone"
    return offers


def find(file: str | None) -> Cloud:
    """The cloud of that name; `NOTHING` if there is none, or it can't be read."""
    if file in _folder:
        return _from_folder(file)[0]
    return _brought.get(file or "", NOTHING)


def trouble(file: str | None) -> str:
    """In words, why there is no cloud of that name; empty if there is one."""
    if not file:
        return "No file yet: bring your own, or choose one."
    if file in _folder:
        return _from_folder(file)[1]
    if file in _brought:
        return ""
    if file.startswith(UPLOAD):
        return "This file is gone: the server keeps it only while its sim is open. Bring it again."
    return f"There is no file named “{file}” here."


@lru_cache(maxsize=4)
def _from_folder(file: str) -> tuple[Cloud, str]:
    try:
        path = _folder[file]
        if path.stat().st_size > _largest:
            raise CloudFileError(f"It is larger than {_largest / 1e6:,.0f} MB.")
        return placed(read(file, path.read_bytes(), _largest)), ""
    except CloudFileError as error:
        return NOTHING, f"“{file}” can't be read. {error}"
    except OSError:
        return NOTHING, f"“{file}” can't be read."


def placed(cloud: Cloud) -> Cloud:
    """The cloud near the origin, and with no more points than a browser can take."""
    every = -(-len(cloud) // MOST_SHOWN)
    if every > 1:
        cloud = replace(cloud.only(np.arange(0, len(cloud), every)), left_out=len(cloud) - -(-len(cloud) // every))
    low, high = clouds.bounds(cloud.points)
    if max(np.abs(low).max(), np.abs(high).max()) < FAR:
        return cloud
    origin = 100.0 * np.floor(low / 100.0)
    return replace(cloud, points=cloud.points - origin, origin=origin)
