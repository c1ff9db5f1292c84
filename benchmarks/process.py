"""What the system says about a process, and which core it may run on. Linux only."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

CORES = sorted(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else []
"""The server runs on the first of them, the load generator on the last."""


@contextmanager
def pinned(core: int) -> Iterator[None]:
    """Processes that start in here run on one core."""
    os.sched_setaffinity(0, {core})
    try:
        yield
    finally:
        os.sched_setaffinity(0, CORES)


def cpu_seconds(pid: int) -> float:
    """CPU time that a process and all its threads have used.

    Linux makes the clock's number from the process's, as clock_getcpuclockid(3) does; /proc counts in 10 ms.
    """
    return time.clock_gettime(~pid << 3 | 2)


def resident(pid: int) -> float:
    """Resident memory of a process in MB."""
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGESIZE") / 1e6
