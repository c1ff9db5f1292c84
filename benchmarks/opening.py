"""How long a sim takes to open: until the still picture is on the screen, and until it is live.

Each opening has a new headless browser, whose processor draws nothing else and whose cache is empty.
"""

from __future__ import annotations

from typing import Any

from playwright.sync_api import BrowserType, sync_playwright

from benchmarks.servers import SLUG, Plain, Sim3
from tests.browser import launch_options

# Times from the start of the navigation, redirects included. What is put into the page counts as painted with the
# frame after next; a picture only once its file is there.
WATCH = """
(() => {
  const seen = (window.seen = {});
  const note = (name) => {
    seen[name] = -1;
    requestAnimationFrame(() => requestAnimationFrame(() => (seen[name] = performance.now())));
  };
  const look = () => {
    if (!seen.still && document.querySelector(".s3-still")) {
      const files = performance.getEntriesByType("resource").filter((e) => e.name.includes("/thumbs/"));
      if (files.some((file) => file.responseEnd)) note("still");
    }
    if (window.sim3 ? window.sim3.live : document.querySelector("canvas") && document.querySelector(".numbers"))
      note("live");
    else setTimeout(look, 5);
  };
  look();
})();
"""
SIZE: Any = {"width": 1280, "height": 800}
PATIENCE = 60_000


def measure(repeats: int, warm_up: int) -> dict[str, dict[str, list[float]]]:
    """Seconds until `live` and `still`, for each way, turn by turn; the first `warm_up` don't count."""
    found: dict[str, dict[str, list[float]]] = {}
    with Sim3() as sim3, Plain() as plain, sync_playwright() as playwright:
        addresses = {
            sim3.way: f"http://127.0.0.1:{sim3.port}/sims/{SLUG}/embed",
            plain.way: f"http://127.0.0.1:{plain.port}/",
        }
        for turn in range(warm_up + repeats):
            for way, address in addresses.items():
                times = open_once(playwright.chromium, address)
                if turn >= warm_up:
                    for name, seconds in times.items():
                        found.setdefault(way, {}).setdefault(name, []).append(seconds)
    return found


def open_once(chromium: BrowserType, address: str) -> dict[str, float]:
    """Open a page in a new browser."""
    browser = chromium.launch(**launch_options(windows=True))
    try:
        page = browser.new_page(viewport=SIZE)
        page.add_init_script(WATCH)
        page.goto(address, wait_until="commit", timeout=PATIENCE)
        page.wait_for_function("window.seen?.live > 0", timeout=PATIENCE, polling=100)
        seen: dict[str, float] = page.evaluate("window.seen")
        return {name: at / 1e3 for name, at in seen.items() if at > 0}
    finally:
        browser.close()
