"""A file that was taken home, opened from a folder with the network off: what is shown is what was solved."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import httpx
import numpy as np
import pytest
from playwright.sync_api import Browser, Page, Request, expect
from scipy.spatial.transform import Rotation

from sims.euler_angles import SIM, EulerParams
from sims.kit.readout import figure
from tests.browser import COARSE
from tests.e2e.conftest import Classroom
from tests.e2e.learner import PATIENCE, VISERS_OWN_WORDS
from tests.server import Server

POSE = "(name) => window.__viserMutable.nodePoseData[name]?.wxyz"
VERSION = "(frame) => window.__viserMutable?.nodePoseData['/version']?.position[0] === frame"
TURNS = ("/turn1", "/turn1/turn2", "/turn1/turn2/turn3")
LAST = 8


@pytest.fixture
def file(server: Server, tmp_path: Path) -> Path:
    answer = httpx.get(f"{server.url}/sims/euler-angles/home?sweep=pitch&from=-60&to=60&frames=9", timeout=PATIENCE)
    assert answer.status_code == 200, answer.text
    path = tmp_path / "pitch.html"
    path.write_bytes(answer.content)
    return path


@pytest.fixture
def alone(browser: Browser, file: Path) -> Iterator[Page]:
    """The file, in a browser without a network; nothing may be asked for or complained of."""
    asked: list[str] = []
    said: list[str] = []

    def note(request: Request) -> None:
        if not request.url.startswith(("data:", "blob:")) and request.url != file.as_uri():
            asked.append(request.url)

    with browser.new_context(
        offline=True, viewport={"width": 880, "height": 600}, device_scale_factor=COARSE
    ) as context:
        context.on("request", note)
        context.on("weberror", lambda error: said.append(str(error.error)))
        context.on("console", lambda m: said.append(m.text) if m.type in ("error", "warning") else None)
        page = context.new_page()
        page.goto(file.as_uri())
        yield page
        assert not asked
        assert not [words for words in said if not any(own in words for own in VISERS_OWN_WORDS)]


def shows(page: Page, frame: int) -> None:
    """Wait until a frame is drawn: the aircraft and the matrix are those of its state, by SciPy."""
    page.wait_for_function(VERSION, arg=frame, timeout=1000 * PATIENCE)
    params = EulerParams(pitch=-60.0 + 120.0 * frame / LAST)
    matrix = SIM.solve(params).R
    drawn = Rotation.identity()
    for name in TURNS:
        w, x, y, z = page.evaluate(POSE, name)
        drawn *= Rotation.from_quat([x, y, z, w])
    np.testing.assert_allclose(drawn.as_matrix(), matrix, rtol=0, atol=1e-9)
    numbers = page.locator('[data-part="read:"] .s3-matrix').first.locator("mn").all_text_contents()
    assert numbers == [figure(entry) for entry in matrix.ravel()]


def test_every_frame_of_the_file_is_the_solution_of_its_state(alone: Page) -> None:
    shows(alone, 0)
    slider = alone.get_by_role("slider", name="Pitch")
    for frame in (LAST, 2, 3):
        slider.fill(str(frame))
        shows(alone, frame)
    expect(slider).to_have_attribute("aria-valuetext", alone.locator("#value").inner_text())
    link = alone.get_by_role("link", name="In the live sim").get_attribute("href") or ""
    assert link.endswith("?pitch=-15")
    alone.get_by_role("button", name="Play").click()
    alone.wait_for_function("Number(document.getElementById('at').value) > 4")
    alone.get_by_role("button", name="Pause").click()
    shows(alone, int(slider.input_value()))
    before = alone.evaluate("window.__viserMutable.camera.position.toArray()")
    alone.get_by_role("button", name="Top").click()
    alone.wait_for_function(
        "(b) => window.__viserMutable.camera.position.toArray().some((v, i) => Math.abs(v - b[i]) > 0.1)", arg=before
    )


def test_the_dialog_saves_a_file(classroom: Classroom) -> None:
    learner = classroom.open_column("euler-angles/embed?yaw=40")
    learner.witness.expect("status of 422")  # what can't be taken is said in the dialog
    learner.press("Take it home")
    dialog = learner.page.get_by_role("dialog", name="Take it home")
    dialog.get_by_role("combobox").select_option("roll")
    expect(dialog.get_by_role("textbox", name="From")).to_have_value("-180")
    dialog.get_by_role("textbox", name="To").fill("500")
    dialog.get_by_role("button", name="Save the file").click()
    expect(dialog.get_by_role("status")).to_contain_text("to: got '500', allowed: a number from -180 to 180")
    dialog.get_by_role("radio", name="This state").check()
    with learner.page.expect_download() as download:
        dialog.get_by_role("button", name="Save the file").click()
    assert download.value.suggested_filename.startswith("sim3-euler-angles-20")
    assert "yaw=40" in Path(download.value.path()).read_text(encoding="utf-8")
