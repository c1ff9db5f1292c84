"""The dialog that a state is handed on by, and the pages for those who put a sim into a page of their own."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from urllib.parse import parse_qs, urlsplit

import httpx
import pytest
from playwright.sync_api import Frame

from tests.e2e.conftest import Classroom
from tests.e2e.course import PAGE, CourseSite
from tests.e2e.learner import Learner

NO_SHIFTS = """window.shifts = 0;
const painted = () => performance.getEntriesByName("first-paint")[0]?.startTime ?? Infinity;
new PerformanceObserver((list) => list.getEntries().forEach((e) => (window.shifts += e.hadRecentInput || e.startTime < painted() ? 0 : e.value)))
    .observe({ type: "layout-shift", buffered: true });"""
"""What is laid out before anything is painted, as Chromium does with a frame whose style is still on its way, is seen by
nobody."""
PRINTING = """import(document.querySelector("script[src$='/main.js']").src.replace("main.js", "handout.js"))
    .then(({ Handout }) => new Handout({ steps: [], embed: "" }).print())"""
SANDBOX = 'sandbox="allow-scripts"'


@pytest.fixture
def course() -> Iterator[CourseSite]:
    with CourseSite() as site:
        yield site


def framed(learner: Learner, course: CourseSite, path: str, sandbox: str) -> Frame:
    """A page of ours in a frame of a page of another site."""
    course.page = PAGE.format(address=f"{learner.url}{path}", attributes=sandbox, before="", after="")
    learner.page.goto(course.url)
    return learner.until(lambda: next(each for each in learner.page.frames if each.url.startswith(learner.url)))


def link(learner: Learner) -> str:
    return learner.frame.get_by_role("textbox", name="Link to exactly this state").input_value()


def test_the_dialog_follows_its_options_and_gives_the_focus_back(classroom: Classroom) -> None:
    learner = classroom.open_column("euler-angles/embed?yaw=45&view=4,1,2,0,0,0", size={"width": 1280, "height": 800})
    page = learner.page
    page.evaluate("Object.defineProperty(document, 'fullscreenEnabled', { value: false })")
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
    assert learner.url + str(dialog.locator("iframe").get_attribute("src")) == wanted

    dialog.get_by_role("button", name="QR code of the link").press("Enter")
    large = page.get_by_role("button", name="QR code of the link, large")
    assert large.locator("span").inner_text() == wanted
    large.press("Enter")
    learner.until(lambda: page.evaluate("document.activeElement.className") == "share-qr")
    page.keyboard.press("Escape")
    learner.until(lambda: page.evaluate("document.activeElement.textContent") == "Share")
    assert not dialog.count()


def test_the_dialog_fits_a_phone(classroom: Classroom) -> None:
    learner = classroom.open_column("quaternion/embed", size={"width": 390, "height": 780})
    learner.find("button", "Share").press("Enter")
    dialog = learner.page.get_by_role("dialog", name="Share Quaternions")
    dialog.wait_for()
    assert dialog.evaluate("node => node.scrollWidth - node.clientWidth") == 0


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
    learner = classroom.enter(painted=False)
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


@pytest.mark.parametrize("sandbox", ["", SANDBOX], ids=["of another site", "sandboxed"])
def test_check_says_what_a_frame_allows(classroom: Classroom, course: CourseSite, sandbox: str) -> None:
    learner = classroom.enter_alone()
    learner.page.add_init_script(NO_SHIFTS)
    frame = framed(learner, course, "/check", sandbox)
    frame.locator(".verdict[data-found=yes]").wait_for()
    found = frame.evaluate(
        "Object.fromEntries([...document.querySelectorAll('.check')].map(e => [e.dataset.check, e.dataset.found]))"
    )
    needed = dict.fromkeys(("scripts", "webgl", "websocket", "worker", "size"), "yes")
    assert found == {**needed, "clipboard": "no", "fullscreen": "no", "storage": "no"}
    assert frame.evaluate("window.shifts") == 0


@pytest.mark.parametrize("sandbox", ["", SANDBOX], ids=["of another site", "sandboxed"])
def test_a_lesson_in_a_frame_moves_its_sim_and_takes_answers(
    classroom: Classroom, course: CourseSite, sandbox: str
) -> None:
    learner = classroom.enter(painted=False)
    learner.witness.expect("Blocked form submission")
    frame = framed(learner, course, "/sims/euler-angles?yaw=45", sandbox)
    learner.until(lambda: "yaw=45" in frame.child_frames[0].url)
    frame.locator("[data-show]").nth(1).evaluate("(button) => button.click()")
    learner.until(lambda: "yaw=45" not in frame.child_frames[0].url and "yaw=45" not in frame.url)
    predict = frame.locator("[data-predict]").first
    predict.locator(".choice").first.click()
    predict.get_by_role("button").click()
    learner.until(lambda: predict.get_attribute("data-answered") in ("right", "wrong"))
    if sandbox:
        learner.witness.expect("Ignored call to 'print()'")
        frame.evaluate(PRINTING)
        frame.locator("[data-handout-status]").get_by_text("open it in a tab of its own").wait_for()


def test_a_class_in_a_frame_is_joined_and_one_that_cant_be_opened_there_says_so(
    classroom: Classroom, course: CourseSite
) -> None:
    teacher = classroom.enter(painted=False)
    frame = framed(teacher, course, "/class?sim=euler-angles&yaw=45", "")
    frame.get_by_role("button", name="Open the class").click()
    teacher.until(lambda: "yaw=45" in frame.child_frames[0].url)
    code = frame.locator(".invite .code").inner_text()

    learner = classroom.enter(painted=False)
    learner.witness.expect("Blocked form submission")
    frame = framed(learner, course, "/class", SANDBOX)
    frame.get_by_role("button", name="Open the class").click()
    frame.get_by_role("alert").get_by_text("in a tab of its own").wait_for()
    frame.get_by_role("button", name="Open the class").click()
    join = frame.get_by_role("button", name="Join")
    frame.get_by_role("textbox").fill(code)
    join.evaluate("(button) => { Object.assign(button, { name: 'by', value: 'hand' }).form.action += '?old=1'; }")
    with learner.page.expect_request("**/class?*") as asked:
        assert frame.get_by_role("alert").count() == 1, "what can't be sent is said once"
        join.click()
    assert parse_qs(urlsplit(asked.value.url).query) == {"code": [code], "by": ["hand"]}, "as the browser would send it"
    learner.until(lambda: "yaw=45" in frame.child_frames[0].url)
    learner.until(lambda: learner.sockets.state["params"]["yaw"] == 45)
    sim = frame.child_frames[0]
    sim.locator("[data-slide=yaw]").press("ArrowRight")
    learner.until(lambda: "yaw=46" in sim.url)
    teacher.page.frames[1].get_by_role("button", name="All eyes here").click()
    learner.until(lambda: "yaw=45" in sim.url)
    teacher.page.frames[1].get_by_role("button", name="Go on").click()
    learner.until(lambda: "yaw=46" in sim.url)


def test_check_says_what_to_ask_for(classroom: Classroom) -> None:
    learner = classroom.enter_alone()
    page = learner.page
    learner.witness.expect("WebSocket")
    page.route_web_socket("**/check/socket", lambda socket: socket.close(code=1011))
    page.goto(f"{learner.url}/check")
    page.locator(".verdict[data-found=no]").wait_for()
    letter = page.get_by_role("textbox", name="To send to the administrator").input_value()
    assert "Upgrade and Connection" in letter
    assert "WebGL" not in letter


# Pixels of each line that stand empty, kept for the other answer.
EMPTY = """() => [...document.querySelectorAll(".check .either")].map((line) => {
    const said = new Range();
    said.selectNodeContents([...line.children].find((each) => getComputedStyle(each).visibility === "visible"));
    return line.clientHeight - said.getBoundingClientRect().height;
})"""


def test_check_on_a_phone_has_no_gaps_and_still_says_what_to_ask_for(classroom: Classroom) -> None:
    learner = classroom.enter_alone()
    page = learner.page
    learner.witness.expect("WebSocket")
    page.set_viewport_size({"width": 390, "height": 780})
    page.goto(f"{learner.url}/check")
    page.locator(".verdict[data-found=yes]").wait_for()
    assert max(page.evaluate(EMPTY)) < 3 * 24, "three lines"
    page.route_web_socket("**/check/socket", lambda socket: socket.close(code=1011))
    page.reload()
    page.locator(".verdict[data-found=no]").wait_for()
    assert "Upgrade" in page.get_by_role("textbox", name="To send to the administrator").input_value()
