"""For everybody: axe finds nothing, the keyboard reaches everything and shows where it is, and changes are spoken."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Frame, Page

from sims import SIMS
from sims.kit.palette import DARK
from tests.axe import findings
from tests.e2e.conftest import Classroom
from tests.e2e.picture import Picture

INPUTS = ":is([data-slide], [data-box], [data-choice], [data-switch], [data-act]):visible"
INPUT = "({ dataset: d }) => d.slide ?? d.box ?? d.choice ?? d.switch ?? d.act"
# Tab through the page: of each stop its name, and what its looks are with the focus, as the next key comes down.
TABBED = """() => {
  document.body.tabIndex = -1;
  document.body.focus();
  document.body.removeAttribute("tabindex");
  const seen = (node) => {
    const { outlineStyle, outlineWidth, outlineColor, boxShadow, borderColor, backgroundColor, fill } = getComputedStyle(node);
    return [outlineStyle === "none" ? "" : outlineStyle + outlineWidth + outlineColor, boxShadow, borderColor, backgroundColor, fill];
  };
  window.stops = [];
  window.round = false;
  const note = () => {
    const stop = document.activeElement;
    if (window.round || stop === document.body) return;
    const looks = () => JSON.stringify([stop, ...stop.querySelectorAll(".s3-ring, span"), stop.nextElementSibling ?? stop].map(seen));
    if (stops.some((other) => other.stop === stop)) window.round = true;
    else stops.push({ stop, looks, focused: looks() });
  };
  addEventListener("keydown", note, { capture: true });
  window.walked = () => removeEventListener("keydown", note, { capture: true });
}"""
STOPS = """() => {
  walked();
  document.activeElement.blur();
  return stops.map(({ stop, looks, focused }) => ({
    role: stop.getAttribute("role") ?? stop.tagName.toLowerCase(),
    name: stop.getAttribute("aria-label") ?? stop.labels?.[0]?.textContent.trim() ?? stop.textContent.trim(),
    handle: stop.dataset.handle ?? "",
    input: stop.dataset.slide ?? stop.dataset.box ?? stop.dataset.choice ?? stop.dataset.switch ?? stop.dataset.act ?? "",
    seen: looks() !== focused,
    html: stop.outerHTML.slice(0, 300),
  }));
}"""


def axe(page: Page) -> list[str]:
    """What axe finds, with the column at its end, where the button that stays in sight covers nothing."""
    page.evaluate("document.querySelector('.s3-column')?.scrollTo(0, 1e6)")
    return findings(page)


def walk(frame: Frame, page: Page) -> list[dict[str, Any]]:
    """Where the Tab key leads, once round."""
    frame.evaluate(TABBED)
    for _ in range(20):
        for _ in range(8):
            page.keyboard.press("Tab")
        if frame.evaluate("round"):
            break
    stops: list[dict[str, Any]] = frame.evaluate(STOPS)
    return stops


def unfold(frame: Frame) -> None:
    """Open every fold by keyboard."""
    for head in frame.locator("summary:visible, [data-s3=more]").all():
        head.press("Enter")


@pytest.mark.parametrize("slug", [sim.slug for sim in SIMS])
def test_a_sim_is_for_everybody(classroom: Classroom, slug: str) -> None:
    learner = classroom.open_column(f"{slug}/embed")
    assert axe(learner.page) == []

    unfold(learner.frame)
    stops = walk(learner.frame, learner.page)
    reached = {stop["name"] for stop in stops}
    inputs = learner.frame.locator(INPUTS).evaluate_all(f"all => all.map({INPUT})")
    assert {*inputs} <= {stop["input"] for stop in stops}, "the keyboard doesn't reach every control"
    assert {"Share", "Save picture"} <= reached
    handles = learner.frame.locator("[data-handle]").evaluate_all("all => all.map((one) => one.dataset.handle)")
    assert {*handles} <= {stop["handle"] for stop in stops}
    assert [stop for stop in stops if not stop["name"]] == [], "controls without a name"
    assert [stop["html"] for stop in stops if not stop["seen"]] == [], "focus can't be seen"

    before = learner.until(learner.spoken)
    learner.frame.locator("[data-slide]:visible").first.press("ArrowRight")
    learner.until(lambda: learner.spoken() not in ("", before))


def test_a_scene_is_for_everybody(classroom: Classroom) -> None:
    learner = classroom.open("quaternion/embed")
    assert axe(learner.page) == []
    canvas = learner.frame.locator("canvas[role]")
    learner.until(lambda: learner.spoken() in (canvas.get_attribute("aria-label") or ""))
    before = learner.spoken()
    learner.press_keys("angle", "ArrowRight")
    learner.until(lambda: learner.spoken() != before and learner.spoken() in str(canvas.get_attribute("aria-label")))
    assert "canvas" in {stop["html"][1:7] for stop in walk(learner.frame, learner.page)}


def test_a_sim_in_the_dark_is_for_everybody(classroom: Classroom) -> None:
    assert axe(classroom.open_column("triangulation/embed?theme=dark&right_uv=410,210").page) == []
    learner = classroom.open("euler-angles/embed?theme=dark&pitch=90", device_scale_factor=1)
    assert axe(learner.page) == []

    def lettered() -> bool:  # light ink on a dark plate; labels come last
        pixels = Picture(learner, DARK).patch(learner.scene.world_pose("/world/letter_y")[:3, 3], 7).min(axis=1)
        return bool(pixels.max() > 120 and np.median(pixels) < 80)

    learner.until(lettered)
