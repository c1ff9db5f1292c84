"""Clouds that aren't built in: those that learners bring, and those in the administrator's folder.

A learner's file is known by an unguessable name as long as its session keeps it; nothing here does. An
administrator's is known by its file's name, and read when somebody asks for it. Both may be read in more than one way:
what is guessed of columns and units can be chosen instead.
"""

from __future__ import annotations

import re
import secrets
import threading
import time
from collections.abc import Mapping
from concurrent.futures import Future
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any
from weakref import WeakValueDictionary

import numpy as np

from sims.kit import child
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.files import FORMATS, CloudFileError, read
from sims.point_cloud.files.meaning import roles_of

UPLOAD = "upload-"
NAME = r'^[^/\\\x00-\x1f"<>|:*?]{1,120}$'
"""Of a file, without a path."""
GUESSED = ("", "auto")
"""The columns and units of a file of which nothing was chosen."""
NOTHING = Cloud("", np.empty((0, 3)))
FIELDS = f"{__name__}:fields"
KEPT = 4
"""Clouds of the folder that are kept when nobody looks at them, and ways in which a learner's file was read."""
AGAIN = 60.0
"""Seconds after which a file is tried again over which the child process failed; one that was refused stays so."""
Choice = tuple[str, str]
"""What columns and units are taken for: a letter for each of the first columns (`files.meaning.LETTERS`), a unit."""
_brought: WeakValueDictionary[str, Brought] = WeakValueDictionary()
_folder: dict[str, Path] = {}
_readings: dict[tuple[str, Choice], _Reading] = {}
"""Of the folder's files, the one that was asked for last at the end."""
_lock = threading.Lock()
_largest = 100_000_000


def fields(name: str, data: bytes, largest: int, columns: str, units: str) -> dict[str, Any]:
    """The fields of the cloud in a file, as it is shown. Runs in the child process: see `sims.kit.child`."""
    return vars(read(name, data, largest, roles_of(columns), units))


def limits(size: int, largest: int) -> child.Limits:
    """What reading a file of some bytes may take, on a server that takes `largest`: its text as numbers, and copies."""
    return child.Limits(memory=500_000_000 + 12 * largest, seconds=20.0 + size / 2e6)


@dataclass(eq=False)
class _Reading:
    """A file as it was at some time, and what the child process makes of it for all who ask."""

    stamp: tuple[int, int]
    found: Future[child.Values]
    cloud: Cloud | None = None
    failed_at: float | None = None

    def holds(self, stamp: tuple[int, int]) -> bool:
        """Whether the file is still the same, and nothing is gained by reading it again."""
        return self.stamp == stamp and (self.failed_at is None or time.monotonic() < self.failed_at + AGAIN)

    def wait(self) -> Cloud:
        """The cloud, when it is there. Raises what `child.result` does."""
        try:
            values = child.result(self.found)
        except child.ChildFailed:
            self.failed_at = self.failed_at or time.monotonic()
            raise
        with _lock:
            self.cloud = self.cloud or Cloud(**values)
        return self.cloud


@dataclass(eq=False)
class Brought:
    """A learner's file, and what was made of it. Its bytes are kept: other columns may be chosen."""

    name: str
    data: bytes
    largest: int
    readings: dict[Choice, _Reading] = field(default_factory=dict)

    def reading(self, choice: Choice) -> _Reading:
        """The reading in that way, begun if it hasn't been; of those that were chosen, the newest few are kept."""
        with _lock:
            reading = self.readings.pop(choice, None)
            if reading is None or not reading.holds((0, 0)):
                reading = _Reading((0, 0), _asked(self.name, self.data, len(self.data), self.largest, choice))
            self.readings[choice] = reading
            for old in [one for one in self.readings if one != GUESSED][:-KEPT]:
                del self.readings[old]
        return reading


def bring(name: str, data: bytes, largest: int) -> tuple[Brought, Mapping[str, Any]]:
    """Make a cloud of a learner's file; return what is to be kept, and the changes of the state that show it.

    Raises ChildRefusal or ChildFailed, in words for the learner.
    """
    brought = Brought(PurePosixPath(name.replace("\\", "/")).name[-80:], data, largest)
    brought.reading(GUESSED).wait()
    known_as = UPLOAD + secrets.token_urlsafe(12)
    _brought[known_as] = brought
    return brought, {"dataset": "file", "file": known_as}


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


def find(file: str | None, choice: Choice = GUESSED) -> Cloud:
    """The cloud of that name, read as chosen; `NOTHING` if there is none, or it can't be read."""
    return _found(file, choice)[0]


def known(file: str | None, choice: Choice = GUESSED) -> Cloud:
    """The same as far as somebody has read it already: without waiting, and `NOTHING` if nobody has."""
    brought = _brought.get(file or "")
    reading = brought.readings.get(choice) if brought else _readings.get((file or "", choice))
    return (reading and reading.cloud) or NOTHING


def trouble(file: str | None, choice: Choice = GUESSED) -> str:
    """In words, why there is no cloud of that name; empty if there is one."""
    return _found(file, choice)[1]


def _found(file: str | None, choice: Choice) -> tuple[Cloud, str]:
    if not file:
        return NOTHING, "No file yet: bring your own, or choose one."
    brought = _brought.get(file)
    if brought is None and file not in _folder:
        if file.startswith(UPLOAD):
            return NOTHING, "This file is gone: the server keeps it only while its sim is open. Bring it again."
        return NOTHING, f"There is no file named “{file}” here."
    name = brought.name if brought else file
    try:
        return (brought.reading(choice) if brought else _from_folder(file, choice)).wait(), ""
    except OSError:
        return NOTHING, f"“{name}” can't be read."
    except ValueError as error:
        return NOTHING, f"“{name}” can't be read{' so' if choice != GUESSED else ''}. {error}"


def _from_folder(file: str, choice: Choice) -> _Reading:
    """The reading of a file as it is now, begun if nobody has; the oldest ones that are done are forgotten."""
    path = _folder[file]
    status = path.stat()
    if status.st_size > _largest:
        raise CloudFileError(f"It is larger than {_largest / 1e6:,.0f} MB.")
    stamp = status.st_mtime_ns, status.st_size
    with _lock:
        reading = _readings.pop((file, choice), None)
        if reading is None or not reading.holds(stamp):
            reading = _Reading(stamp, _asked(file, path, status.st_size, _largest, choice))
        _readings[file, choice] = reading
        done = [key for key, one in _readings.items() if one.found.done() and one.found.exception() is None]
        for key in done[:-KEPT]:
            del _readings[key]
    return reading


def _asked(name: str, data: bytes | Path, size: int, largest: int, choice: Choice) -> Future[child.Values]:
    columns, units = choice
    allowed = limits(size, largest)
    return child.begin(FIELDS, name, data, limits=allowed, largest=largest, columns=columns, units=units)
