"""The two servers under test, each a process of its own on one core and a free loopback port."""

from __future__ import annotations

import http.client
import json
import os
import re
import subprocess
import sys
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from benchmarks.process import CORES, pinned
from tests.server import camera_message, free_port, wait_for

ROOT = Path(__file__).resolve().parent.parent
SLUG = "euler-angles"
SETTINGS = {
    "SIM3_HOST": "127.0.0.1", "SIM3_MAX_SESSIONS": "5000", "SIM3_MAX_SESSIONS_PER_ADDRESS": "5000",
    "SIM3_MAX_OPENINGS": "5000",
}  # fmt: skip


class Server:
    """A server in a process of its own, while the context lasts."""

    way: str
    module: str

    def __enter__(self) -> Self:
        self.port = free_port()
        own = {**SETTINGS, "SIM3_PORT": str(self.port)}
        with pinned(CORES[0]):
            self._process = subprocess.Popen(
                [sys.executable, "-m", self.module], cwd=ROOT, env={**os.environ, **own},
                stdout=subprocess.DEVNULL,
            )  # fmt: skip
        self.pid = self._process.pid
        try:
            wait_for(self._answers, f"{self.module} to answer", patience=60.0)
        except BaseException:
            self._process.kill()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._process.terminate()
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def get(self, path: str) -> http.client.HTTPResponse:
        """The answer to a GET; a redirect isn't followed."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=10)
        connection.request("GET", path, headers={"connection": "close"})
        return connection.getresponse()

    def page(self) -> str:
        """Path of a page for one more learner."""
        return "/"

    def load(self, kind: str, learners: int, **options: Any) -> dict[str, float]:
        """Have the load generator do a job with so many learners; what it measured."""
        job = {
            "kind": kind, "host": f"127.0.0.1:{self.port}", "pid": self.pid, "core": CORES[-1],
            "camera": camera_message(), "paths": [self.page() for _ in range(learners)], **options,
        }  # fmt: skip
        done = subprocess.run(
            [sys.executable, "-m", "benchmarks.load"], cwd=ROOT, input=json.dumps(job), stdout=subprocess.PIPE,
            text=True, check=True, timeout=300,
        )  # fmt: skip
        result: dict[str, float] = json.loads(done.stdout)
        return result

    def _answers(self) -> bool:
        if self._process.poll() is not None:
            raise RuntimeError(f"{self.module} ended with exit code {self._process.returncode}")
        try:
            return self.get("/healthz").status == 200
        except OSError:
            return False


class Sim3(Server):
    """The server of this repository."""

    way, module = "sim3", "app"

    def page(self, slug: str = SLUG) -> str:
        path = re.search(r'"path": "([^"]+)"', self.get(f"/sims/{slug}/embed").read().decode())
        assert path is not None
        return path[1]

    def sessions(self) -> int:
        """How many sessions it keeps."""
        return int(json.load(self.get("/healthz"))["sessions"])


class Plain(Server):
    """The plain viser way."""

    way, module = "plain viser", "benchmarks.plain"
