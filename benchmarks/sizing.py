"""What a class server needs: `python -m benchmarks.sizing [--quick]`. The figures of docs/administrators.md.

Memory is that of the server's process, processor time that which it has used: who else uses the machine matters little.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import sys
from collections.abc import Iterator
from importlib.metadata import distribution
from time import perf_counter, sleep

from playwright.sync_api import Browser, Page, sync_playwright

from benchmarks.learner import Learner
from benchmarks.process import cpu_seconds, resident
from benchmarks.servers import ROOT, SLUG, Sim3
from sims import SIMS
from tests.browser import launch_options
from tests.server import camera_message

CLOUD = "point-cloud"
COUNT, FEWER = 20, 5
"""Rooms that are opened of each sim."""
SETTLING = 1.0
"""Seconds in which a server uses next to nothing once it has nothing to do."""


def starting() -> Iterator[str]:
    """From nothing to an answer."""
    begin = perf_counter()
    with Sim3() as server:
        took, cpu, fresh = perf_counter() - begin, cpu_seconds(server.pid), resident(server.pid)
        yield f"start: {took:.1f} s, {cpu:.1f} s of a core; then {fresh:.0f} MB"
        server.get(f"/sims/{SLUG}").read()
        quiet(server)  # it reads all lessons, now that somebody has asked for one
        yield f"with all lessons read: {resident(server.pid):.0f} MB, {cpu_seconds(server.pid) - cpu:.1f} s of a core"


def quiet(server: Sim3) -> None:
    """Wait until a server has nothing to do."""
    used = -1.0
    while cpu_seconds(server.pid) - used > 0.02:
        used = cpu_seconds(server.pid)
        sleep(SETTLING)


async def _opened(server: Sim3, slug: str, count: int) -> list[Learner]:
    learners = [Learner(f"127.0.0.1:{server.port}", server.page(slug), camera_message()) for _ in range(count)]
    for each in learners:
        await each.connect()
    await asyncio.to_thread(quiet, server)
    return learners


async def _of_rooms(server: Sim3, slug: str, count: int) -> float:
    """MB that a room takes, each with one page; the first ones, with what all share, don't count."""
    first = await _opened(server, slug, FEWER)
    before = resident(server.pid)
    rest = await _opened(server, slug, count)
    each = (resident(server.pid) - before) / count
    for learner in (*first, *rest):
        await learner.close()
    return each


def rooms(less: bool) -> Iterator[str]:
    """Memory of a room that nobody moves."""
    found: dict[str, float] = {}
    for sim in SIMS:
        with Sim3() as server:
            found[sim.slug] = asyncio.run(_of_rooms(server, sim.slug, FEWER if less else COUNT))
    cloud = found.pop(CLOUD)
    yield "a room: " + ", ".join(f"{slug} {each:.1f}" for slug, each in found.items()) + f", {CLOUD} {cloud:.1f} MB"


def dragging(less: bool) -> Iterator[str]:
    """Processor time of a learner who drags without a pause."""
    for count in (1, 30):
        with Sim3() as server:
            row = server.load("drag", count, seconds=3 if less else 8)
        each = row["cpu_ms_per_update"]
        yield f"{count} dragging 20 times a second: {each:.2f} ms of a core each time, {2.0 * each:.1f} % of it each"


def first_load(slug: str, *, packed: bool) -> tuple[int, int]:
    """Bytes that came, and in how many files, until a sim is live in a browser that has never been there."""
    with Sim3() as server, sync_playwright() as playwright:
        browser = playwright.chromium.launch(**launch_options(windows=True))
        try:
            return _loaded(browser, f"http://127.0.0.1:{server.port}/sims/{slug}/embed", packed)
        finally:
            browser.close()


def _loaded(browser: Browser, address: str, packed: bool) -> tuple[int, int]:
    context = browser.new_context(extra_http_headers={} if packed else {"accept-encoding": "identity"})
    page: Page = context.new_page()
    sizes: list[float] = []
    seen = context.new_cdp_session(page)
    seen.send("Network.enable")
    seen.on("Network.loadingFinished", lambda event: sizes.append(event["encodedDataLength"]))
    page.goto(address)
    page.wait_for_function("window.sim3?.live", timeout=120_000, polling=100)
    return int(sum(sizes)), len(sizes)


def loading(less: bool) -> Iterator[str]:
    """What comes over the wire for a first look."""
    for slug in (SLUG,) if less else (SLUG, CLOUD):
        for packed in (True, False):
            size, files = first_load(slug, packed=packed)
            yield f"first load of {slug}, {'' if packed else 'not '}compressed: {size / 1e3:.0f} kB in {files} files"


def disk() -> Iterator[str]:
    """What is installed."""
    code = sum(_size(str(ROOT / name)) for name in ("geometry", "sims", "app", "static"))
    names = [
        line.split("==")[0] for line in (ROOT / "requirements.lock").read_text("utf-8").splitlines() if "==" in line
    ]
    libraries = 0
    for name in names:
        try:
            found = distribution(name)
        except ModuleNotFoundError:  # for another system
            continue
        libraries += sum(os.path.getsize(path) for f in found.files or () if os.path.isfile(path := str(f.locate())))
    yield f"disk: {code / 1e6:.0f} MB of our own, {libraries / 1e6:.0f} MB of libraries, beside Python"


def _size(folder: str) -> int:
    return sum(os.path.getsize(os.path.join(at, name)) for at, _, names in os.walk(folder) for name in names)


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.sizing", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="fewer rooms and seconds")
    less = parser.parse_args().quick
    print(f"Python {sys.version.split()[0]}, load average {os.getloadavg()[0]:.1f} before the start")
    for part in (starting(), rooms(less), dragging(less), loading(less), disk()):
        for line in part:
            print(line, flush=True)


if __name__ == "__main__":
    main()
