"""Clouds that aren't built in: those that learners bring, and those in the administrator's folder.

A learner's cloud is known by an unguessable name as long as its session keeps it; nothing here does. An
administrator's is known by its file's name, and read when somebody asks for it.
"""

from __future__ import annotations

import re
import secrets
import threading
import time
from collections.abc import Mapping
from concurrent.futures import Future
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any
from weakref import WeakValueDictionary

import numpy as np

from geometry import clouds
from sims.kit import child
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
FIELDS = f"{__name__}:fields"
KEPT = 4
"""Clouds of the folder that are kept when nobody looks at them."""
AGAIN = 60.0
"""Seconds after which a file is tried again over which the child process failed; one that was refused stays so."""

_brought: WeakValueDictionary[str, Cloud] = WeakValueDictionary()
_folder: dict[str, Path] = {}
_readings: dict[str, _Reading] = {}
"""Of the folder's files, the one that was asked for last at the end."""
_lock = threading.Lock()
_largest = 100_000_000


def fields(name: str, data: bytes, largest: int) -> dict[str, Any]:
    """The fields of the cloud in a file, as it is shown. Runs in the child process: see `sims.kit.child`."""
    return vars(placed(read(name, data, largest)))


def limits(size: int, largest: int) -> child.Limits:
    """What reading a file of some bytes may take, on a server that takes `largest`: its text as numbers, and copies."""
    return child.Limits(memory=500_000_000 + 12 * largest, seconds=20.0 + size / 2e6)


def bring(name: str, data: bytes, largest: int) -> tuple[Cloud, Mapping[str, Any]]:
    """Make a cloud of a learner's file; return it, to be kept, and the changes of the state that show it.

    Raises ChildRefusal or ChildFailed, in words for the learner.
    """
    cloud = Cloud(**child.read(FIELDS, name, data, limits=limits(len(data), largest), largest=largest))
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
    with _lock:
        _readings.clear()


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


@dataclass(eq=False)
class _Reading:
    """A file of the folder as it was at some time, and what the child process makes of it for all who ask."""

    stamp: tuple[int, int]
    found: Future[child.Values]
    cloud: Cloud | None = None
    failed_at: float | None = None

    def holds(self, stamp: tuple[int, int]) -> bool:
        """Whether the file is still the same, and nothing is gained by reading it again."""
        return self.stamp == stamp and (self.failed_at is None or time.monotonic() < self.failed_at + AGAIN)


def _from_folder(file: str) -> tuple[Cloud, str]:
    try:
        reading = _begun(file)
        try:
            values = child.result(reading.found)
        except child.ChildFailed:
            reading.failed_at = reading.failed_at or time.monotonic()
            raise
    except OSError:
        return NOTHING, f"“{file}” can't be read."
    except ValueError as error:
        return NOTHING, f"“{file}” can't be read. {error}"
    with _lock:
        reading.cloud = reading.cloud or Cloud(**values)
    return reading.cloud, ""


def _begun(file: str) -> _Reading:
    """The reading of a file as it is now, begun if nobody has; the oldest ones that are done are forgotten."""
    path = _folder[file]
    status = path.stat()
    if status.st_size > _largest:
        raise CloudFileError(f"It is larger than {_largest / 1e6:,.0f} MB.")
    stamp = status.st_mtime_ns, status.st_size
    with _lock:
        reading = _readings.pop(file, None)
        if reading is None or not reading.holds(stamp):
            allowed = limits(status.st_size, _largest)
            reading = _Reading(stamp, child.begin(FIELDS, file, path, limits=allowed, largest=_largest))
        _readings[file] = reading
        done = [name for name, one in _readings.items() if one.found.done() and one.found.exception() is None]
        for name in done[:-KEPT]:
            del _readings[name]
    return reading


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
