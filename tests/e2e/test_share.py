"""The dialog that a state is handed on by, and the pages for those who put a sim into a page of their own."""

from __future__ import annotations

from collections.abc import Iterator
from urllib.parse import parse_qs, urlsplit

import httpx
import pytest

from tests.e2e.conftest import Classroom
from tests.e2e.course import PAGE, CourseSite
from tests.e2e.learner import Learner

NO_SHIFTS = """window.shifts = 0;
const painted = () => performance.getEntriesByName("first-paint")[0]?.startTime ?? Infinity;
new PerformanceObserver((list) => list.getEntries().forEach((e) => (window.shifts += e.hadRecentInput || e.startTime < painted() ? 0 : e.value)))
    .observe({ type: "layout-shift", buffered: true });"""
"""What is laid out before anything is painted, as Chromium does with a frame whose style is still on its way, is seen by
nobody."""


@pytest.fixture
def course() -> Iterator[CourseSite]:
    with CourseSite() as site:
        yield site


def link(learner: Learner) -> str:
    return learner.frame.get_by_role("textbox", name="Link to exactly this state").input_value()


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


def test_check_says_what_a_sandboxed_frame_of_another_site_allows(classroom: Classroom, course: CourseSite) -> None:
    learner = classroom.enter()
    learner.page.add_init_script(NO_SHIFTS)
    address = f"{learner.url}/check"
    course.page = PAGE.format(address=address, attributes='sandbox="allow-scripts"', before="", after="")
    learner.page.goto(course.url)
    frame = learner.until(lambda: next(each for each in learner.page.frames if each.url == address))
    frame.locator(".verdict[data-found=yes]").wait_for()
    found = frame.evaluate(
        "Object.fromEntries([...document.querySelectorAll('.check')].map(e => [e.dataset.check, e.dataset.found]))"
    )
    needed = dict.fromkeys(("scripts", "webgl", "websocket", "worker", "size"), "yes")
    assert found == {**needed, "clipboard": "no", "fullscreen": "no", "storage": "no"}
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
