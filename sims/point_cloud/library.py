"""Clouds that aren't built in: those that learners upload, and those in the administrator's folder.

A learner's file has an unguessable name, and is there as long as its session keeps it. An administrator's is known by
its file's name, and read when somebody asks for it. Both may be read differently: what is guessed of columns
and units can be chosen instead.
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

import numpy as np

from sims.kit import child
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.files import FORMATS, CloudFileError, read
from sims.point_cloud.files.meaning import roles_of
from sims.point_cloud.params import NAME, UPLOAD, Chosen

GUESSED: Chosen = ("", "auto")
"""The columns and units of a file of which nothing was chosen."""
NOTHING = Cloud("", np.empty((0, 3)))
FIELDS = f"{__name__}:fields"
KEPT = 4
"""Clouds of the folder that are kept when nobody looks at them, and readings of a learner's file."""
AGAIN = 60.0
"""Seconds after which a file is tried again over which the child process failed; one that was refused stays so."""
LARGEST = 100_000_000


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
    lock: threading.Lock = field(default_factory=threading.Lock)
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
        with self.lock:  # all who wait get the same cloud
            self.cloud = self.cloud or Cloud(**values)
        return self.cloud


@dataclass(eq=False)
class Upload:
    """A learner's file, and what was made of it. Its bytes are kept: other columns may be chosen."""

    name: str
    data: bytes
    largest: int
    readings: dict[Chosen, _Reading] = field(default_factory=dict)
    lock: threading.Lock = field(default_factory=threading.Lock)

    def reading(self, choice: Chosen) -> _Reading:
        """The reading as chosen, begun if it hasn't been; of those that were chosen, the newest few are kept."""
        with self.lock:
            reading = self.readings.pop(choice, None)
            if reading is None or not reading.holds((0, 0)):
                reading = _Reading((0, 0), _asked(self.name, self.data, len(self.data), self.largest, choice))
            self.readings[choice] = reading
            for old in [one for one in self.readings if one != GUESSED][:-KEPT]:
                del self.readings[old]
        return reading


class Library:
    """The files that a server's sessions can show; any thread may ask.

    Offers the clouds in the administrator's folder, not those in folders inside it, and takes files of at most
    `largest` bytes.
    """

    def __init__(self, folder: Path | None = None, largest: int = LARGEST) -> None:
        self.largest = largest
        kept = [] if folder is None else sorted(folder.iterdir())
        self._folder = {
            path.name: path
            for path in kept
            if path.suffix.lower() in FORMATS and path.is_file() and re.match(NAME, path.name)
        }
        self._uploads: dict[str, Upload] = {}
        self._readings: dict[tuple[str, Chosen], _Reading] = {}
        """Readings of the folder's files; the one that was asked for last is at the end."""
        self._lock = threading.Lock()

    def add(self, name: str, data: bytes) -> tuple[str, Mapping[str, Any]]:
        """Make a cloud of a learner's file; return what it is known as, and the changes of the state that show it.

        It stays until it is removed. Raises ChildRefusal or ChildFailed, in words for the learner.
        """
        upload = Upload(PurePosixPath(name.replace("\\", "/")).name[-80:], data, self.largest)
        upload.reading(GUESSED).wait()
        known_as = UPLOAD + secrets.token_urlsafe(12)
        self._uploads[known_as] = upload
        return known_as, {"dataset": "file", "file": known_as}

    def remove(self, known_as: str) -> None:
        """Forget a learner's file."""
        self._uploads.pop(known_as, None)

    def offered(self, file: str | None) -> dict[str | None, str]:
        """What there is to choose from in a state, with its name for people."""
        offers: dict[str | None, str] = {None: "None", **{name: name for name in self._folder}}
        if file and file not in self._folder:
            upload = self._uploads.get(file)
            offers[file] = f"Yours: {upload.name}" if upload else "Gone"
        return offers

    def find(self, file: str | None, choice: Chosen = GUESSED) -> Cloud:
        """The cloud of that name, read as chosen; `NOTHING` if there is none, or it can't be read."""
        return self._found(file, choice)[0]

    def known(self, file: str | None, choice: Chosen = GUESSED) -> Cloud:
        """The same as far as somebody has read it already: without waiting, and `NOTHING` if nobody has."""
        upload = self._uploads.get(file or "")
        reading = upload.readings.get(choice) if upload else self._readings.get((file or "", choice))
        return (reading and reading.cloud) or NOTHING

    def trouble(self, file: str | None, choice: Chosen = GUESSED) -> str:
        """In words, why there is no cloud of that name; empty if there is one."""
        return self._found(file, choice)[1]

    def _found(self, file: str | None, choice: Chosen) -> tuple[Cloud, str]:
        if not file:
            return NOTHING, "No file yet: bring your own, or choose one."
        upload = self._uploads.get(file)
        if upload is None and file not in self._folder:
            if file.startswith(UPLOAD):
                return NOTHING, "This file is gone: the server keeps it only while its sim is open. Bring it again."
            return NOTHING, f"There is no file named “{file}” here."
        name = upload.name if upload else file
        try:
            return (upload.reading(choice) if upload else self._from_folder(file, choice)).wait(), ""
        except OSError:
            return NOTHING, f"“{name}” can't be read."
        except ValueError as error:
            return NOTHING, f"“{name}” can't be read{' so' if choice != GUESSED else ''}. {error}"

    def _from_folder(self, file: str, choice: Chosen) -> _Reading:
        """The reading of a file as it is now, begun if nobody has; the oldest ones that are done are forgotten."""
        path = self._folder[file]
        status = path.stat()
        if status.st_size > self.largest:
            raise CloudFileError(f"It is larger than {self.largest / 1e6:,.0f} MB.")
        stamp = status.st_mtime_ns, status.st_size
        with self._lock:
            reading = self._readings.pop((file, choice), None)
            if reading is None or not reading.holds(stamp):
                reading = _Reading(stamp, _asked(file, path, status.st_size, self.largest, choice))
            self._readings[file, choice] = reading
            done = [key for key, one in self._readings.items() if one.found.done() and one.found.exception() is None]
            for key in done[:-KEPT]:
                del self._readings[key]
        return reading


def _asked(name: str, data: bytes | Path, size: int, largest: int, choice: Chosen) -> Future[child.Values]:
    columns, units = choice
    allowed = limits(size, largest)
    return child.begin(FIELDS, name, data, limits=allowed, largest=largest, columns=columns, units=units)


NO_FILES = Library()
"""The library where there is no server: its folder is empty."""
