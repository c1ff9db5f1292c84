"""How quick a sim feels: from a hand on a real control in headless Chromium to the numbers and to the frame.

Each input is timed from its own event: until a number beside the scene has changed, and until a scene that was drawn
after it is on the screen (two animation frames later). Beside them stand what the page's main thread does for one
input, how often it lays the page out and how long that takes with its styles; the same sim's sliders as viser alone has
them; and, where `npm install p5` was run here, a sketch of it as the chapter writes them (benchmarks/sketch.html), lit
and not.

The browser is left to find out by itself whether there is a GPU, as a learner's is: without one the processor draws the
scene and puts the page together.
"""

from __future__ import annotations

import contextlib
import statistics
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, CDPSession, Locator, Page, TimeoutError, sync_playwright

from benchmarks.servers import ROOT, SLUG, Plain, Sim3
from sims import SIMS
from tests.browser import launch_options

# Notes the time of each input, and of the first number and the first drawing after it.
WATCH = """
(() => {
  const felt = (window.felt = { at: 0, numbers: 0, frame: 0 });
  for (const kind of ["keydown", "pointermove", "touchmove"]) addEventListener(kind, (event) => {
    if (felt.armed) Object.assign(felt, { armed: false, at: event.timeStamp, numbers: 0, frame: 0 });
  }, { capture: true, passive: true });
  const words = () => document.querySelector(".s3-column, .numbers")?.textContent ?? "";
  let last = "";
  new MutationObserver(() => {
    if (!felt.at || felt.numbers) last = words();
    else if (words() !== last) felt.numbers = performance.now();
  }).observe(document, { subtree: true, childList: true, characterData: true });
  const { prototype } = WebGL2RenderingContext;
  for (const name of ["drawElements", "drawArrays", "drawElementsInstanced", "drawArraysInstanced"]) {
    const draw = prototype[name];
    prototype[name] = function (...given) {
      if (felt.at && !felt.frame) {
        felt.frame = -1;
        requestAnimationFrame(() => requestAnimationFrame((now) => (felt.frame = performance.now())));
      }
      return draw.apply(this, given);
    };
  }
})();
"""
LIVE = "window.sim3?.live || document.querySelector('.numbers td')"
SIZE: Any = {"width": 1280, "height": 800}
REST = 700
"""Milliseconds between two inputs, in which all comes to rest."""
PATIENCE = 60_000
SLOW = 10_000
"""Milliseconds after which an input counts as one that led to no frame."""
LAYING_OUT = "LayoutDuration", "RecalcStyleDuration"
"""What the browser counts as time for places and for styles, in seconds."""
FEW = 3
"""Inputs that viser alone has, which may need ten seconds for each where the processor draws."""
P5 = ROOT / "node_modules" / "p5" / "lib" / "p5.min.js"
SKETCH = "http://sketch.test/"
FILES = {SKETCH: Path(__file__).with_name("sketch.html"), f"{SKETCH}p5.min.js": P5}


class Hand:
    """One page, and what is moved on it."""

    def __init__(self, page: Page, address: str) -> None:
        self.page = page
        page.set_default_timeout(PATIENCE)
        page.add_init_script(WATCH)
        page.goto(address, wait_until="commit")
        page.wait_for_function(LIVE, polling=100)
        page.wait_for_timeout(2500)
        self.slider = page.locator("[data-slide], [role=slider]").first
        self._cdp: CDPSession = page.context.new_cdp_session(page)
        self._cdp.send("Performance.enable")

    def measure(self, inputs: Iterator[Callable[[], object]], count: int) -> dict[str, float]:
        """Medians of what `count` inputs took, in milliseconds; the first doesn't count."""
        numbers, frames = [], []
        next(inputs)()
        self.page.wait_for_timeout(REST)
        before = self._metrics()
        for _ in range(count):
            self.page.evaluate("felt.at = 0, felt.numbers = 0, felt.armed = true")
            next(inputs)()
            self.page.wait_for_timeout(REST)
            self._wait_for_frame()
            at, number, frame = self.page.evaluate("[felt.at, felt.numbers, felt.frame]")
            if at and number and frame > 0:
                numbers.append(number - at)
                frames.append(frame - at)
        after = self._metrics()
        return {
            "numbers": statistics.median(numbers) if numbers else float("nan"),
            "frame": statistics.median(frames) if frames else float("nan"),
            "main": 1e3 * (after["TaskDuration"] - before["TaskDuration"]) / count,
            "layouts": (after["LayoutCount"] - before["LayoutCount"]) / count,
            "laying_out": 1e3 * sum(after[each] - before[each] for each in LAYING_OUT) / count,
        }

    def _wait_for_frame(self) -> None:
        """Give a page that draws one frame in seconds the time for it."""
        with contextlib.suppress(TimeoutError):
            self.page.wait_for_function("felt.frame > 0", timeout=SLOW, polling=100)

    def _metrics(self) -> dict[str, float]:
        return {each["name"]: each["value"] for each in self._cdp.send("Performance.getMetrics")["metrics"]}

    def keys(self) -> Iterator[Callable[[], object]]:
        """An arrow key on the first slider, there and back."""
        self.slider.focus()
        while True:
            yield lambda: self.page.keyboard.press("ArrowRight")
            yield lambda: self.page.keyboard.press("ArrowLeft")

    def mouse(self, held: Locator) -> Iterator[Callable[[], object]]:
        """The mouse holds something and moves it a little."""
        at = self._middle(held)
        self.page.mouse.move(*at)
        self.page.mouse.down()
        while True:
            for dx in (9, 18, 9, 0):
                yield partial(self.page.mouse.move, at[0] + dx, at[1])

    def finger(self, held: Locator) -> Iterator[Callable[[], object]]:
        """A finger does the same."""
        x, y = self._middle(held)
        self._touch("touchStart", x, y)
        while True:
            for dx in (9, 18, 27, 18):
                yield partial(self._touch, "touchMove", x + dx, y)

    def _touch(self, kind: str, x: float, y: float) -> None:
        self._cdp.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y}]})

    def _middle(self, held: Locator) -> tuple[float, float]:
        box = held.evaluate("n => (n.scrollIntoView({ block: 'nearest' }), n.getBoundingClientRect().toJSON())")
        share = held.evaluate("n => n.dataset.slide ? (n.value - n.min) / (n.max - n.min) : 0.5")
        inset = 8.0 if held.evaluate("n => !!n.dataset.slide") else 0.0
        return box["x"] + inset + (box["width"] - 2 * inset) * share, box["y"] + box["height"] / 2


def measure(count: int) -> Iterator[tuple[str, dict[str, float]]]:
    """Each sim and way of moving something, and what it took."""
    with Sim3() as sim3, Plain() as plain, sync_playwright() as playwright:
        browser = playwright.chromium.launch(**launch_options(windows=True))
        for sim in SIMS:
            address = f"http://127.0.0.1:{sim3.port}/sims/{sim.slug}/embed"
            ways = ["key"]
            if sim.slug == SLUG:
                ways += ["mouse", "finger"]
            if sim.panes is not None and any(not name.startswith("/") for name in sim.handles):
                ways.append("picture")
            for way in ways:
                yield f"{sim.slug}, {way}", _one(browser, address, way, count)
        if P5.exists():
            for query, kind in (("", "flat"), ("?lit", "lit")):
                yield f"p5.js, {kind}, mouse", _one(browser, SKETCH + query, "mouse", count)
        yield "plain viser, mouse", _one(browser, f"http://127.0.0.1:{plain.port}/", "mouse", FEW)
        browser.close()


def _one(browser: Browser, address: str, way: str, count: int) -> dict[str, float]:
    context = browser.new_context(viewport=SIZE, has_touch=way == "finger")
    context.route(SKETCH + "**", lambda route: route.fulfill(path=FILES[route.request.url.partition("?")[0]]))
    try:
        hand = Hand(context.new_page(), address)
        picture = hand.page.locator("[data-handle] .s3-core").first
        inputs: dict[str, Callable[[], Iterator[Callable[[], object]]]] = {
            "key": hand.keys, "mouse": lambda: hand.mouse(hand.slider), "finger": lambda: hand.finger(hand.slider),
            "picture": lambda: hand.mouse(picture),
        }  # fmt: skip
        return hand.measure(inputs[way](), count)
    finally:
        context.close()
