"""Clouds that aren't built in: those that learners bring, and those in the administrator's folder.

A learner's file is known by an unguessable name as long as its session keeps it; nothing here does. An
administrator's is known by its file's name, and read when somebody asks for it. Both are read by the child process,
and once more when somebody says what else its columns or its unit are.
"""

from __future__ import annotations

import re
import secrets
import threading
import time
from collections.abc import Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple
from weakref import WeakValueDictionary

import numpy as np

from geometry import clouds
from sims.kit import child
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.files import FORMATS, CloudFileError, read
from sims.point_cloud.files.meaning import ROLES

UPLOAD = "upload-"
NAME = r'^[^/\\\x00-\x1f"<>|:*?]{1,120}$'
"""Of a file, without a path."""
LETTERS = dict(zip("xyzrgbiuvw-", ROLES, strict=True))
"""What a column may be taken for, in one letter each: as a state and a link spell it."""
NOTHING = Cloud("", np.empty((0, 3)))
FIELDS = f"{__name__}:fields"
KEPT = 4
"""Clouds of the folder that are kept when nobody looks at them."""
KEPT_OF_ONE = 2
"""Ways in which a learner's file was read that are kept."""
AGAIN = 60.0
"""Seconds after which a file is tried again over which the child process failed; one that was refused stays so."""


class Asked(NamedTuple):
    """Which file, and what its columns (`LETTERS`, for the first of them) and its unit are to be taken for."""

    file: str | None
    columns: str = ""
    units: str = "auto"


@dataclass(eq=False)
class _Reading:
    """A file as it was at some time, and what the child process makes of it for all who ask."""

    stamp: tuple[int, int]
    found: Future[child.Values]
    cloud: Cloud | None = None
    across: float | None = None
    """Of the cloud, in metres."""
    failed_at: float | None = None

    def holds(self, stamp: tuple[int, int]) -> bool:
        """Whether the file is still the same, and nothing is gained by reading it again."""
        return self.stamp == stamp and (self.failed_at is None or time.monotonic() < self.failed_at + AGAIN)

    def wait(self) -> Cloud:
        """The cloud, once it is read. Raises ChildRefusal or ChildFailed, in words for the learner."""
        try:
            values = child.result(self.found)
        except child.ChildFailed:
            self.failed_at = self.failed_at or time.monotonic()
            raise
        with _lock:
            if self.cloud is None:
                self.cloud = Cloud(**values)
                low, high = clouds.bounds(self.cloud.points)
                self.across = float(np.linalg.norm(high - low))
        return self.cloud


class _Readings(dict[Asked, _Reading]):
    """Readings by what was asked for, the last one at the end; the oldest ones that are done are forgotten."""

    def __init__(self, kept: int) -> None:
        super().__init__()
        self._kept = kept

    def begun(self, asked: Asked, data: bytes | Path, stamp: tuple[int, int], largest: int, name: str) -> _Reading:
        """The reading of what is asked for, begun if nobody has."""
        with _lock:
            reading = self.pop(asked, None)
            if reading is None or not reading.holds(stamp):
                columns = [LETTERS[letter] for letter in asked.columns]
                allowed = limits(stamp[1], largest)
                found = child.begin(
                    FIELDS, name, data, limits=allowed, largest=largest, columns=columns, units=asked.units
                )
                reading = _Reading(stamp, found)
            self[asked] = reading
            done = [key for key, one in self.items() if one.found.done() and one.found.exception() is None]
            for key in done[: -self._kept]:
                del self[key]
        return reading


@dataclass(eq=False)
class Upload:
    """A learner's file."""

    name: str
    data: bytes
    largest: int
    readings: _Readings = field(default_factory=lambda: _Readings(KEPT_OF_ONE))

    def begun(self, asked: Asked) -> _Reading:
        """The file, read as it is asked for."""
        return self.readings.begun(asked, self.data, (0, len(self.data)), self.largest, self.name)


_brought: WeakValueDictionary[str, Upload] = WeakValueDictionary()
_folder: dict[str, Path] = {}
_readings = _Readings(KEPT)
_lock = threading.Lock()
_largest = 100_000_000


def fields(name: str, data: bytes, largest: int, columns: list[str], units: str) -> dict[str, Any]:
    """The fields of the cloud in a file, as it is shown. Runs in the child process: see `sims.kit.child`."""
    return vars(read(name, data, largest, columns, units))


def limits(size: int, largest: int) -> child.Limits:
    """What reading a file of some bytes may take, on a server that takes `largest`: its text as numbers, and copies."""
    return child.Limits(memory=500_000_000 + 12 * largest, seconds=20.0 + size / 2e6)


def bring(name: str, data: bytes, largest: int) -> tuple[Upload, Mapping[str, Any]]:
    """Read a learner's file; return it, to be kept, and the changes of the state that show it.

    Raises ChildRefusal or ChildFailed, in words for the learner.
    """
    upload = Upload(name, data, largest)
    known_as = UPLOAD + secrets.token_urlsafe(12)
    upload.name = upload.begun(Asked(known_as)).wait().name
    _brought[known_as] = upload
    return upload, {"dataset": "file", "file": known_as}


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


def find(asked: Asked) -> Cloud:
    """The cloud that is asked for; `NOTHING` if there is none, or it can't be read so."""
    return _look_up(asked)[0]


def trouble(asked: Asked) -> str:
    """In words, why there is no cloud that is asked for; empty if there is one."""
    return _look_up(asked)[1]


def across(asked: Asked) -> float | None:
    """How large a cloud is, in metres, as soon as somebody has read it."""
    reading = _done(asked)
    return None if reading is None else reading.across


def roles(asked: Asked) -> tuple[str, ...]:
    """What the columns of a file are taken for, as soon as somebody has read it."""
    reading = _done(asked)
    return () if reading is None or reading.cloud is None else tuple(reading.cloud.roles)


def _done(asked: Asked) -> _Reading | None:
    upload = _brought.get(asked.file or "")
    return (_readings if upload is None else upload.readings).get(asked)


def _look_up(asked: Asked) -> tuple[Cloud, str]:
    file = asked.file
    if not file:
        return NOTHING, "No file yet: bring your own, or choose one."
    upload = _brought.get(file)
    if upload is None and file not in _folder:
        gone = "This file is gone: the server keeps it only while its sim is open. Bring it again."
        return NOTHING, gone if file.startswith(UPLOAD) else f"There is no file named “{file}” here."
    name = file if upload is None else upload.name
    try:
        return (_from_folder(asked) if upload is None else upload.begun(asked)).wait(), ""
    except OSError:
        return NOTHING, f"“{name}” can't be read."
    except ValueError as error:
        return NOTHING, f"“{name}” can't be read{' so' if asked.columns else ''}. {error}"


def _from_folder(asked: Asked) -> _Reading:
    """The reading of a file of the folder as it is now."""
    path = _folder[str(asked.file)]
    status = path.stat()
    if status.st_size > _largest:
        raise CloudFileError(f"It is larger than {_largest / 1e6:,.0f} MB.")
    return _readings.begun(asked, path, (status.st_mtime_ns, status.st_size), _largest, path.name)
