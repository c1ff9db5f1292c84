"""Pictures of the sims: thumbnails for the pages, and screenshots for people to look at.

`python -m tests.shots [--out DIR] [--states] [--no-thumbs] [slug …]` writes `static/thumbs/{slug}-{theme}.webp`, and
into DIR (`build/shots`) each sim and page at three sizes in both themes. Without slugs: every sim, and the pages.
"""

from __future__ import annotations

import argparse
import io
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Literal

from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright

from sims import SIMS
from sims.kit.sim import Sim
from tests.browser import launch_options
from tests.server import Server

ROOT = Path(__file__).resolve().parent.parent
THUMBS = ROOT / "static" / "thumbs"
THUMB = (640, 480)
THUMB_SCALE = 1.25
THUMB_BYTES = 40_000
SIZES = ((1280, 800), (700, 600), (390, 780))
THEMES: tuple[Literal["light", "dark"], ...] = ("light", "dark")
PAGES = {
    "launcher": "/",
    "page": f"/sims/{SIMS[0].slug}",
    "bad-link": f"/sims/{SIMS[0].slug}?colour=red&view=1,2&controls=0",
    "bad-link-framed": f"/sims/{SIMS[0].slug}/embed?colour=red",
    "missing": "/sims/nothing",
}
PATIENCE = 90_000


def main() -> None:
    args = arguments()
    args.out.mkdir(parents=True, exist_ok=True)
    THUMBS.mkdir(parents=True, exist_ok=True)
    with Server() as server, sync_playwright() as playwright:
        address = server.url
        browser = playwright.chromium.launch(**launch_options())
        for sim in (sim for sim in SIMS if not args.slugs or sim.slug in args.slugs):
            for theme in THEMES:
                if args.thumbs:
                    thumbnail(browser, address, sim, theme)
                review(browser, address, sim, theme, args.out)
            if args.states:
                states(browser, address, sim, args.out)
        if not args.slugs:
            pages(browser, address, args.out)
        browser.close()


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.shots", description=__doc__)
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "shots", help="folder of the screenshots")
    parser.add_argument("--states", action="store_true", help="also each sim at its singular states")
    parser.add_argument("--no-thumbs", dest="thumbs", action="store_false", help="leave the thumbnails alone")
    parser.add_argument("slugs", nargs="*", metavar="slug", help="sims; without, all of them and the pages")
    args = parser.parse_args()
    if unknown := {*args.slugs} - {sim.slug for sim in SIMS}:
        parser.error(f"there is no sim {', '.join(sorted(unknown))}")
    return args


@contextmanager
def opened(
    browser: Browser, address: str, size: tuple[int, int], theme: Literal["light", "dark"], scale: float = 1.0
) -> Iterator[Page]:
    """A page of that size and theme, closed afterwards."""
    width, height = size
    context = browser.new_context(
        viewport={"width": width, "height": height}, device_scale_factor=scale, color_scheme=theme,
        reduced_motion="reduce",
    )  # fmt: skip
    context.set_default_timeout(PATIENCE)
    try:
        page = context.new_page()
        page.goto(address)
        yield page
    finally:
        context.close()


def wait_live(page: Page) -> None:
    """Wait until every sim on the page, itself or in a frame, is drawn."""
    for frame in page.frames:
        if frame.url.split("?")[0].endswith("/embed"):
            frame.wait_for_function("!window.sim3 || sim3.live === true")  # a refused link has a page without a sim
            frame.wait_for_selector(".s3-still", state="detached")
    settled(page)


def settled(page: Page) -> None:
    """Wait until two pictures in a row are the same: viser draws what has arrived, and goes on loading labels."""
    before = b""
    for _ in range(20):
        page.wait_for_timeout(600)
        after = page.screenshot()
        if after == before:
            return
        before = after


def thumbnail(browser: Browser, address: str, sim: Sim[Any, Any], theme: Literal["light", "dark"]) -> None:
    """The bare scene; the window grows by what pictures beside it take."""
    bare = f"{address}/sims/{sim.slug}/embed?controls=0&theme={theme}"
    with opened(browser, bare, THUMB, theme, THUMB_SCALE) as page:
        wait_live(page)
        fit(page, THUMB)
        page.add_style_tag(content=".s3-looks { display: none !important }")
        settled(page)
        x, y, *_ = canvas(page)
        picture = page.screenshot(clip={"x": x, "y": y, "width": THUMB[0], "height": THUMB[1]})
    path = THUMBS / f"{sim.slug}-{theme}.webp"
    path.write_bytes(as_webp(picture))
    print(f"{path.relative_to(ROOT)}  {path.stat().st_size / 1000:.0f} kB")


def fit(page: Page, scene: tuple[int, int]) -> None:
    """Make the window so large that the scene has a size, to a pixel; what is beside it may grow with the window."""
    width, height = scene
    for _ in range(20):
        more, taller = (wanted - got for wanted, got in zip(scene, canvas(page)[2:], strict=True))
        if abs(more) < 1.0 and abs(taller) < 1.0:
            return
        width, height = round(width + more), round(height + taller)
        page.set_viewport_size({"width": width, "height": height})
        page.wait_for_timeout(200)
    raise AssertionError(f"the scene can't be made {scene}")


def canvas(page: Page) -> tuple[float, float, float, float]:
    """Left, top, width and height of the scene on the page."""
    box = page.locator("canvas[data-engine]").bounding_box()
    assert box is not None
    return box["x"], box["y"], box["width"], box["height"]


def as_webp(png: bytes) -> bytes:
    """The best quality that keeps a thumbnail light."""
    image = Image.open(io.BytesIO(png)).convert("RGB")
    for quality in range(90, 30, -5):
        out = io.BytesIO()
        image.save(out, "webp", quality=quality, method=6)
        if out.tell() < THUMB_BYTES:
            break
    return out.getvalue()


def review(browser: Browser, address: str, sim: Sim[Any, Any], theme: Literal["light", "dark"], out: Path) -> None:
    """A sim as it opens, at every size."""
    for size in SIZES:
        with opened(browser, f"{address}/sims/{sim.slug}/embed", size, theme) as page:
            wait_live(page)
            save(page, out / f"{sim.slug}-{size[0]}x{size[1]}-{theme}.png")


def states(browser: Browser, address: str, sim: Sim[Any, Any], out: Path) -> None:
    """A sim at each of its named states."""
    for name, changes in sim.states.items():
        query = sim.params().changed(changes).query()
        with opened(browser, f"{address}/sims/{sim.slug}/embed?{query}", SIZES[0], "light") as page:
            wait_live(page)
            save(page, out / f"{sim.slug}-{name.replace(' ', '-')}.png")


def pages(browser: Browser, address: str, out: Path) -> None:
    """The pages around the sims, in full length."""
    for name, path in PAGES.items():
        for theme in THEMES:
            for size in SIZES:
                with opened(browser, address + path, size, theme) as page:
                    wait_live(page)
                    save(page, out / f"{name}-{size[0]}x{size[1]}-{theme}.png", full_page=True)


def save(page: Page, path: Path, *, full_page: bool = False) -> None:
    page.screenshot(path=path, full_page=full_page)
    print(path)


if __name__ == "__main__":
    main()
