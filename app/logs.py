"""The log: lines for people, or JSON for machines. Neither addresses of learners nor keys of rooms come into it."""

from __future__ import annotations

import json
import logging
import math
import time
from collections import OrderedDict
from datetime import UTC, datetime
from traceback import walk_tb
from types import TracebackType

SELDOM = 60.0
"""Seconds between two lines of the same kind."""
REMEMBERED = 1000
"""Kinds of lines."""


class Json(logging.Formatter):
    """One object a line."""

    def format(self, record: logging.LogRecord) -> str:
        """The line of a record."""
        said = {
            "time": datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds"),
            "level": record.levelname.lower(), "logger": record.name, "message": record.getMessage(),
        }  # fmt: skip
        if record.exc_info:
            said["traceback"] = self.formatException(record.exc_info)
        return json.dumps(said)


class Seldom(logging.Filter):
    """Lets what is said again and again pass once a minute, with how often it wasn't: a drag that fails fills no disk.

    Lines are of a kind whose words, first argument (the sim, mostly), kind of exception and line that raised it are
    the same.
    """

    def __init__(self) -> None:
        super().__init__()
        self._said: OrderedDict[object, tuple[float, int]] = OrderedDict()
        """When a kind was said last, and how often it was left out since."""

    def filter(self, record: logging.LogRecord) -> bool:
        """Whether the line is written."""
        first = str(record.args[0]) if isinstance(record.args, tuple) and record.args else ""
        kind = record.name, record.msg, first, *_raised(record)
        now = time.monotonic()
        at, left_out = self._said.pop(kind, (-math.inf, 0))
        passes = now - at >= SELDOM
        self._said[kind] = (now, 0) if passes else (at, left_out + 1)
        if len(self._said) > REMEMBERED:
            self._said.popitem(last=False)
        if passes and left_out:
            record.msg = f"{record.msg} ({left_out} more like it before)"
        return passes


def _raised(record: logging.LogRecord) -> tuple[object, ...]:
    """The kind of a record's exception, and the file and line that raised it."""
    if record.exc_info is None:
        return ()
    kind, _, where = record.exc_info
    return kind, raised_at(where)


def raised_at(where: TracebackType | None) -> tuple[str, int]:
    """File and line of the innermost frame."""
    frames = [(frame.f_code.co_filename, line) for frame, line in walk_tb(where)]
    return frames[-1] if frames else ("", 0)


def begin(how: str) -> None:
    """Write the log to the standard error, as `text` or `json`."""
    handler = logging.StreamHandler()
    handler.setFormatter(Json() if how == "json" else logging.Formatter("%(levelname)s %(name)s: %(message)s"))
    handler.addFilter(Seldom())
    logging.basicConfig(level=logging.INFO, handlers=[handler], force=True)
