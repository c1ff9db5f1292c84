"""The dialog that a state is handed on by, and the pages for those who put a sim into a page of their own."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from urllib.parse import parse_qs, urlsplit

import cv2
import httpx
import numpy as np
import pytest

from tests.e2e.conftest import Classroom
from tests.e2e.course import PAGE, CourseSite
from tests.e2e.learner import Learner

NO_SHIFTS = """window.shifts = 0;
new PerformanceObserver((list) => list.getEntries().forEach((e) => (window.shifts += e.hadRecentInput ? 0 : e.value)))
    .observe({ type: "layout-shift", buffered: true });"""


@pytest.fixture
def course() -> Iterator[CourseSite]:
    with CourseSite() as site:
        yield site


def link(learner: Learner) -> str:
    return learner.frame.get_by_role("textbox", name="Link to exactly this state").input_value()


def test_the_options_change_link_code_preview_and_texts_and_the_keyboard_is_enough(classroom: Classroom) -> None:
    learner = classroom.open_column("euler-angles/embed?yaw=45&view=4,1,2,0,0,0", size={"width": 1280, "height": 800})
    page = learner.page
    learner.find("button", "Share").press("Enter")
    dialog = page.get_by_role("dialog", name="Share Euler angles")
    dialog.wait_for()
    assert page.evaluate("getSelection().toString()") == link(learner), "it can be copied at once"
    assert parse_qs(urlsplit(link(learner)).query)["view"] == ["4,1,2,0,0,0"]

    dialog.get_by_role("checkbox", name="seen from where you look now").press(" ")
    dialog.get_by_role("radio", name="only these").press(" ")
    dialog.get_by_role("checkbox", name="Yaw").press(" ")
    dialog.get_by_role("combobox", name="one challenge").select_option("other-order")
    wanted = f"{learner.url}/sims/euler-angles/embed?yaw=45&challenge=other-order&only=yaw"
    learner.until(lambda: link(learner) == wanted)
    assert escape(wanted) in dialog.get_by_role("textbox", name="For Moodle", include_hidden=True).input_value()
    preview = dialog.locator("iframe")
    assert learner.url + str(preview.get_attribute("src")) == wanted
    inside = preview.content_frame
    inside.get_by_text("Other turns, same end").wait_for()
    assert inside.locator("[data-slide=yaw]").is_visible()
    assert not inside.locator("[data-slide=pitch]").count()

    dialog.get_by_role("button", name="QR code of the link").press("Enter")
    large = page.get_by_role("button", name="QR code of the link, large")
    large.wait_for()
    seen = cv2.imdecode(np.frombuffer(large.locator("img").screenshot(), np.uint8), cv2.IMREAD_COLOR)
    assert seen is not None
    assert cv2.QRCodeDetector().detectAndDecode(seen)[0] == wanted
    large.press("Enter")
    learner.until(lambda: page.evaluate("document.activeElement.className") == "share-qr")
    page.keyboard.press("Escape")
    learner.until(lambda: page.evaluate("document.activeElement.textContent") == "Share")
    assert not dialog.count()


def test_a_lesson_is_shared_with_the_state_and_the_view_of_its_sim(classroom: Classroom) -> None:
    learner = classroom.open_column("euler-angles/embed")
    page = learner.page
    page.goto(f"{learner.url}/sims/euler-angles?yaw=45&view=4,1,2,0,0,0")
    learner.until(lambda: any("/embed" in frame.url for frame in page.frames))
    page.get_by_role("link", name="Share", exact=True).click()
    page.get_by_role("dialog").wait_for()
    assert link(learner).startswith(f"{learner.url}/sims/euler-angles?")
    assert parse_qs(urlsplit(link(learner)).query) == {"yaw": ["45"], "view": ["4,1,2,0,0,0"]}


def test_the_example_for_developers_works_wherever_it_is_put(classroom: Classroom, course: CourseSite) -> None:
    learner = classroom.enter()
    page = learner.page
    page.goto(f"{learner.url}/developers")
    course.page = page.locator("#source").text_content() or ""
    assert course.page == httpx.get(f"{learner.url}/developers/example", trust_env=False).text
    page.goto(course.url)
    learner.enter_frame()
    page.get_by_role("button", name="Solve the challenge").click()
    page.get_by_text("reach-target: solved").wait_for()
    learner.until(lambda: '"yaw": 120' in page.locator("#state").inner_text())
    page.get_by_role("button", name="Make a mistake").click()
    page.locator("#error").get_by_text("yaw").wait_for()


@pytest.mark.parametrize("sandbox", ["", 'sandbox="allow-scripts"'], ids=["of another site", "sandboxed"])
def test_check_says_what_a_frame_allows(classroom: Classroom, course: CourseSite, sandbox: str) -> None:
    learner = classroom.enter()
    learner.page.add_init_script(NO_SHIFTS)
    address = f"{learner.url}/check"
    course.page = PAGE.format(address=address, attributes=sandbox, before="", after="")
    learner.page.goto(course.url)
    frame = learner.until(lambda: next(each for each in learner.page.frames if each.url == address))
    frame.locator(".verdict[data-found=yes]").wait_for()
    found = frame.evaluate(
        "Object.fromEntries([...document.querySelectorAll('.check')].map(e => [e.dataset.check, e.dataset.found]))"
    )
    storage = "no" if sandbox else "yes"
    needed = dict.fromkeys(("scripts", "webgl", "websocket", "worker", "size"), "yes")
    assert found == {**needed, "clipboard": "no", "fullscreen": "no", "storage": storage}
    assert frame.evaluate("window.shifts") == 0


def test_check_says_what_to_ask_for(classroom: Classroom) -> None:
    learner = classroom.enter()
    page = learner.page
    learner.witness.expect("WebSocket")
    page.route_web_socket("**/check/socket", lambda socket: socket.close(code=1011))
    page.goto(f"{learner.url}/check")
    page.locator(".verdict[data-found=no]").wait_for()
    letter = page.get_by_role("textbox", name="To send to the administrator").input_value()
    assert "Upgrade and Connection" in letter
    assert "WebGL" not in letter
