"""Several servers behind a real HAProxy, which is set up as compose.yaml has it."""

from __future__ import annotations

import re
import subprocess
from contextlib import ExitStack
from pathlib import Path
from types import TracebackType
from typing import Self

import httpx

from tests.proxies import find
from tests.server import PATIENCE, ROOT, Server, free_port, wait_for

SETTINGS = {"SIM3_DRAIN_SECONDS": "2", "FORWARDED_ALLOW_IPS": "*"}


def interpolated(text: str) -> str:
    """As compose has it where no variable is set."""
    return re.sub(r"\$\{\w+:-([^}]*)\}", r"\1", text)


def configuration(port: int, servers: list[Server]) -> str:
    """What compose.yaml tells HAProxy, for servers of this machine."""
    compose = (ROOT / "compose.yaml").read_text()
    content = re.search(r"^    content: \|\n((?:      .*\n|\n)+)", compose, re.M)
    assert content, "compose.yaml has no configuration of HAProxy any more"
    text = re.sub(r"^      ", "", content[1], flags=re.M)
    text = re.sub(r"^resolvers docker\n(?:    .*\n)+", "", text, flags=re.M)
    text = text.replace("bind :8080", f"bind 127.0.0.1:{port}").replace("log stdout format raw local0 notice", "")
    text = text.replace("    log global\n", "")
    text = interpolated(text)
    template = re.compile(r"^(\s*)server-template replica \d+ replica:8000 (.*) resolvers docker init-addr none$", re.M)
    found = template.findall(text)
    assert len(found) == 2, "two backends find their servers by a template"

    def named(match: re.Match[str]) -> str:
        lines = [f"{match[1]}server replica{k} 127.0.0.1:{each.port} {match[2]}" for k, each in enumerate(servers)]
        return "\n".join(lines)

    return template.sub(named, text)


class Replicas:
    """Some servers and what balances them, while the context lasts; settings as keyword arguments."""

    def __init__(self, folder: Path, count: int, **settings: str) -> None:
        self.servers = [Server(**SETTINGS, **settings) for _ in range(count)]
        self.port = free_port()
        self._folder = folder
        self._stack = ExitStack()

    @property
    def url(self) -> str:
        """Where the balancer listens."""
        return f"http://127.0.0.1:{self.port}"

    def __enter__(self) -> Self:
        for server in self.servers:
            self._stack.enter_context(server)
        file = self._folder / "haproxy.cfg"
        file.write_text(configuration(self.port, self.servers))
        balancer = subprocess.Popen([str(find("haproxy")), "-f", str(file)], stderr=subprocess.DEVNULL)
        self._stack.callback(balancer.wait, PATIENCE)
        self._stack.callback(balancer.terminate)
        wait_for(lambda: all(self.statuses() for _ in range(4)), "the balancer to find its servers")
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for server in self.servers:
            server.send_end()  # they end beside each other
        self._stack.__exit__(kind, error, trace)

    def statuses(self) -> bool:
        """Whether a page comes through the balancer."""
        try:
            return httpx.get(f"{self.url}/healthz", trust_env=False, timeout=PATIENCE).status_code == 200
        except httpx.TransportError:
            return False

    def rooms(self) -> list[int]:
        """How many sessions each server has."""
        answers = [httpx.get(f"{s.origin}/healthz", trust_env=False, timeout=PATIENCE) for s in self.servers]
        return [answer.json()["sessions"] for answer in answers]
