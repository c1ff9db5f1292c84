"""The two servers under test, each a process of its own on one core and a free loopback port."""

from __future__ import annotations

import http.client
import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from urllib.parse import urlsplit

ROOT = Path(__file__).resolve().parent.parent
CORES = sorted(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else [0]
SERVER_CORE, LOAD_CORE = CORES[0], CORES[-1]
START_WITHIN = 60.0
SLUG = "euler-angles"


@contextmanager
def pinned(core: int) -> Iterator[None]:
    """Processes that start in here run on one core."""
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {core})
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


def cpu_seconds(pid: int) -> float:
    """CPU time of a process and all its threads so far, in nanosecond resolution.

    Linux makes the clock's number from the process's, as clock_getcpuclockid(3) does; /proc counts in 10 ms.
    """
    return time.clock_gettime(~pid << 3 | 2)


def resident(pid: int) -> float:
    """Resident memory of a process in MB."""
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGESIZE") / 1e6


class Server:
    """A running server process."""

    def __init__(self, module: str, ready: str) -> None:
        self.port = _free_port()
        environment = os.environ | {
            "SIM3_HOST": "127.0.0.1", "SIM3_PORT": str(self.port), "SIM3_MAX_SESSIONS": "5000",
        }  # fmt: skip
        with pinned(SERVER_CORE):
            self._process = subprocess.Popen(
                [sys.executable, "-m", module], cwd=ROOT, env=environment, stdout=subprocess.DEVNULL
            )
        self.pid = self._process.pid
        self._wait_for(ready)

    def _wait_for(self, path: str) -> None:
        end = time.monotonic() + START_WITHIN
        while self._process.poll() is None and time.monotonic() < end:
            with suppress(OSError):
                self.get(path)
                return
            time.sleep(0.05)
        self.stop()
        raise SystemExit(f"The server to measure did not start (exit code {self._process.returncode}).")

    def get(self, path: str) -> tuple[str, bytes]:
        """The `location` header and body of the answer to a GET."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=10)
        try:
            connection.request("GET", path)
            answer = connection.getresponse()
            return answer.headers.get("location", ""), answer.read()
        finally:
            connection.close()

    def address(self) -> str:
        """Path of a page for one more learner."""
        return "/"

    def stop(self) -> None:
        """End the process."""
        self._process.terminate()
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


class Sim3(Server):
    """The server of this repository: `python -m app`."""

    way = "sim3"

    def __init__(self) -> None:
        super().__init__("app", "/healthz")

    def address(self) -> str:
        return urlsplit(self.get(f"/sims/{SLUG}/embed")[0]).path


class Plain(Server):
    """The plain viser way: `python -m benchmarks.plain`."""

    way = "plain"

    def __init__(self) -> None:
        super().__init__("benchmarks.plain", "/healthz")


@contextmanager
def running(kind: type[Sim3] | type[Plain]) -> Iterator[Sim3 | Plain]:
    """A server of its kind, ended afterwards."""
    server = kind()
    try:
        yield server
    finally:
        server.stop()


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
