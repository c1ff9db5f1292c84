"""Real proxies in front of the server, set up as the README says: with a prefix that they hand on or take away."""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Iterator, Mapping
from html import unescape
from pathlib import Path

import httpx
import pytest
from websockets.exceptions import ConnectionClosed

from app.rooms.keys import new_key, room_of
from tests.app.conftest import PREFIX
from tests.app.page import SLUG, connect
from tests.proxies import find
from tests.replicas import interpolated
from tests.server import PATIENCE, ROOT, Server, free_port, wait_for

README = (ROOT / "README.md").read_text()


def snippet(language: str) -> str:
    """The README's configuration of a proxy."""
    found = re.findall(rf"^```{language}\n(.*?)^```$", README, re.S | re.M)
    assert len(found) == 1, f"one snippet for {language}"
    text: str = found[0]
    return changed(text, {"/sim3": PREFIX})


def changed(text: str, changes: Mapping[str, str]) -> str:
    """A snippet with some of its words replaced; each must be there."""
    for old, new in changes.items():
        assert old in text, f"the README's snippet has no {old!r} any more"
        text = text.replace(old, new)
    return text


def nginx(folder: Path, backend: int, ports: Mapping[str, int]) -> str:
    """Configuration of nginx with a server for each way."""
    port = {"127.0.0.1:8000": f"127.0.0.1:{backend}"}
    told = snippet("nginx")
    the_map, location = re.match(r"(map .*?\n}\n)(.*)", told, re.S).groups()  # type: ignore[union-attr]
    host = "    proxy_set_header Host $http_host;\n"
    ways = {
        "handed on": changed(location, port),
        "taken away": changed(location, {"127.0.0.1:8000;": f"127.0.0.1:{backend}/;"}),
        "own host": changed(location, {**port, host: ""}),
        "forwarded host": changed(location, {**port, host: "    proxy_set_header X-Forwarded-Host $http_host;\n"}),
    }
    servers = "\n".join(f"server {{ listen 127.0.0.1:{ports[way]};\n{text}}}" for way, text in ways.items())
    temporary = "\n".join(
        f"{kind}_temp_path {folder}/{kind};" for kind in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
    )
    return (
        f"daemon off; worker_processes 1; pid {folder}/pid; error_log {folder}/error.log;\n"
        f"events {{ worker_connections 100; }}\nhttp {{ access_log off; {temporary}\n{the_map}\n{servers}\n}}\n"
    )


def haproxy(backend: int, ports: Mapping[str, int]) -> str:
    """Configuration of HAProxy with a frontend and a backend for each way."""
    told = changed(snippet("haproxy"), {"127.0.0.1:8000": f"127.0.0.1:{backend}"})
    bind = re.search(r"bind .*", told)
    assert bind
    told = changed(told, {bind[0]: "bind 127.0.0.1:PORT", "X-Forwarded-Proto https": "X-Forwarded-Proto http"})
    strip = f"    http-request replace-path {PREFIX}(/.*) \\1\n"
    ways = {"handed on": told, "taken away": changed(told, {"backend sim3\n": f"backend sim3\n{strip}"})}
    parts = [
        re.sub(r"\b(frontend |backend )(\w+)", rf"\g<1>\g<2>{k}", text).replace("PORT", str(ports[way]))
        for k, (way, text) in enumerate(ways.items())
    ]
    timeouts = "    mode http\n    timeout connect 5s\n    timeout client 30s\n    timeout server 30s\n"
    return f"global\n    maxconn 100\n\ndefaults\n{timeouts}\n" + "\n".join(
        re.sub(r"use_backend sim3\b", f"use_backend sim3{k}", part) for k, part in enumerate(parts)
    )


@pytest.fixture(scope="module")
def places(server: Server, tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, str]]:
    """Where the sims are reached, by proxy and way."""
    if not (find("nginx") and find("haproxy")):
        pytest.skip("nginx or HAProxy is not installed")
    folder = tmp_path_factory.mktemp("proxies")
    (folder / "nginx").mkdir()
    ports = {
        proxy: {way: free_port() for way in ("handed on", "taken away", "own host", "forwarded host")}
        for proxy in ("nginx", "haproxy")
    }
    (folder / "nginx.conf").write_text(nginx(folder / "nginx", server.port, ports["nginx"]))
    (folder / "haproxy.cfg").write_text(haproxy(server.port, ports["haproxy"]))
    commands = (
        [find("nginx"), "-c", f"{folder}/nginx.conf", "-e", f"{folder}/nginx/error.log"],
        [find("haproxy"), "-f", f"{folder}/haproxy.cfg"],
    )
    running = [subprocess.Popen([str(word) for word in command], stderr=subprocess.PIPE) for command in commands]
    try:
        yield {
            f"{proxy}, {way}": f"http://127.0.0.1:{port}"
            for proxy, ways in ports.items()
            for way, port in ways.items()
            if proxy == "nginx" or way in ("handed on", "taken away")
        }
    finally:
        for process in running:
            process.terminate()
        for process in running:
            process.communicate(timeout=PATIENCE)


WAYS = ["nginx, handed on", "nginx, taken away", "haproxy, handed on", "haproxy, taken away"]


def answers(address: str) -> httpx.Response | None:
    try:
        return httpx.get(address, trust_env=False, timeout=PATIENCE)
    except httpx.TransportError:
        return None


@pytest.mark.parametrize("way", WAYS)
def test_all_of_it_is_reached_through_a_proxy(places: Mapping[str, str], way: str) -> None:
    origin = places[way]
    launcher = wait_for(lambda: answers(f"{origin}{PREFIX}/"), f"{way} to answer")
    assert launcher is not None
    assert launcher.status_code == 200
    with httpx.Client(base_url=origin, trust_env=False, timeout=PATIENCE) as client:
        for page in (f"{PREFIX}/", f"{PREFIX}/sims/{SLUG}", f"{PREFIX}/sims/{SLUG}/embed", f"{PREFIX}/docs"):
            answer = client.get(page)
            assert answer.status_code == 200, page
            used = [unescape(each) for each in re.findall(r'(?:src|href)="(/[^"]+)"', answer.text)]
            assert used
            for address in {*used}:
                assert address.startswith(PREFIX), f"{page} uses {address}"
                assert client.get(address, follow_redirects=True).status_code == 200, address
        key = new_key()
        slash = client.get(f"{PREFIX}/sims/{SLUG}/s/{room_of(key)}/{key}?yaw=5", follow_redirects=True)
        assert slash.status_code == 200
        assert slash.url.path == f"{PREFIX}/sims/{SLUG}/s/{room_of(key)}/{key}/"
        assert client.get(f"{PREFIX}/sims", follow_redirects=True).url.path == f"{PREFIX}/"
        solved = client.post(f"{PREFIX}/api/sims/{SLUG}/solve", json={"yaw": 30})
        assert solved.json()["params"]["yaw"] == 30.0
        (place,) = client.get(f"{PREFIX}/openapi.json").json()["servers"]
        assert place["url"] == PREFIX


def greeting() -> str:
    return json.dumps({"type": "hello", "dark": False, "reduced": True, "query": ""})


@pytest.mark.parametrize("way", [*WAYS, "nginx, forwarded host"])
def test_both_websockets_open_through_a_proxy(places: Mapping[str, str], way: str) -> None:
    origin, key = places[way], new_key()
    wait_for(lambda: answers(f"{origin}{PREFIX}/healthz"), f"{way} to answer")
    room = f"{origin}{PREFIX}/sims/{SLUG}/s/{room_of(key)}/{key}/"
    with connect(f"{room}channel", viser=False, origin=origin) as channel:
        channel.send(greeting())
        assert json.loads(channel.recv(timeout=PATIENCE))["type"] in ("show", "state")
        connect(room, viser=True, origin=origin).close()


def test_a_proxy_that_hides_the_host_is_told_of_in_words(places: Mapping[str, str], server: Server) -> None:
    origin, key = places["nginx, own host"], new_key()
    wait_for(lambda: answers(f"{origin}{PREFIX}/healthz"), "nginx to answer")
    for viser in (False, True):
        path = f"{PREFIX}/sims/{SLUG}/s/{room_of(key)}/{key}/" + ("" if viser else "channel")
        with pytest.raises(ConnectionClosed) as closed:
            connect(origin + path, viser=viser, origin=origin).recv(timeout=PATIENCE)
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 4403
        assert f"saw Host “127.0.0.1:{server.port}”" in closed.value.rcvd.reason
        assert origin in closed.value.rcvd.reason
    (line,) = [line for line in server.log().splitlines() if origin in line]
    assert "README" in line


def test_compose_balancer_is_what_haproxy_takes(tmp_path: Path) -> None:
    """The configuration in compose.yaml; its servers are found by Docker's own names."""
    if not (program := find("haproxy")):
        pytest.skip("HAProxy is not installed")
    found = re.search(r"^    content: \|\n(.*)", (ROOT / "compose.yaml").read_text(), re.S | re.M)
    assert found
    (tmp_path / "haproxy.cfg").write_text(interpolated(re.sub(r"^      ", "", found[1], flags=re.M)))
    subprocess.run([program, "-c", "-f", f"{tmp_path}/haproxy.cfg"], check=True, capture_output=True)
