"""A lesson in a browser: its text moves the sim, and whoever takes over isn't overruled."""

from __future__ import annotations

import pytest
from playwright.sync_api import Locator, ViewportSize, expect

from tests.e2e.conftest import Classroom
from tests.e2e.learner import Learner
from tests.e2e.test_accessibility import axe

DESK = ViewportSize(width=1280, height=800)
BACK_AND_FORTH = """async (steps) => {
    for (const step of steps) {
        document.getElementById(step).scrollIntoView({ behavior: "instant" });
        for (let k = 0; k < 2; k++) await new Promise(requestAnimationFrame);
    }
}"""
# The text has moved the sim there and back, and somebody takes over before the sim tells of either.
OVERTAKEN = """async ([here, there]) => {
    const main = document.querySelector("script[src$='/main.js']").src;
    const { Steps } = await import(main.replace("main.js", "steps.js"));
    const takers = {};
    const steps = new Steps({ on: (type, taker) => (takers[type] = taker), set() {} },
        [{ id: here, query: "here" }, { id: there, query: "there" }]);
    Object.assign(steps, { at: 0, query: "here" });
    steps.go(steps.steps[1]);
    steps.go(steps.steps[0]);
    takers.touched();
    return ["there", "here", "here", "mine", "here"].map((query) => (takers.state({ params: {}, query }), steps.taken));
}"""
# From now on `passes()` does at once what a page waits for.
NOTED = """() => {
    const [wait, stop, noted] = [setTimeout, clearTimeout, new Map()];
    window.setTimeout = (does, after) => {
        const once = () => noted.delete(id) && does();
        const id = wait(once, after + 60_000);
        noted.set(id, once);
        return id;
    };
    window.clearTimeout = (id) => { noted.delete(id); stop(id); };
    window.passes = () => { for (const once of [...noted.values()]) once(); };
}"""
FILLED = """async (given) => {
    const main = document.querySelector("script[src$='/main.js']").src;
    return (await import(main.replace("main.js", "spelling.js"))).filled(...given);
}"""


@pytest.fixture
def reader(classroom: Classroom) -> Learner:
    """Somebody who reads the lesson on gimbal lock beside its sim, without viser's client."""
    return entered(classroom, "gimbal-lock")


def entered(classroom: Classroom, path: str) -> Learner:
    return opened(classroom.enter(size=DESK, painted=False, reduced_motion="reduce"), path)


def opened(learner: Learner, path: str) -> Learner:
    learner.sockets.forget()
    learner.page.goto(f"{learner.url}/sims/{path}")
    return at_lesson(learner)


def at_lesson(learner: Learner) -> Learner:
    """Wait until the lesson before the learner is live."""
    learner.frame = learner.until(lambda: next(f for f in learner.page.frames if "/embed" in f.url))
    learner.until(lambda: bool(learner.sockets.states))
    expect(learner.page.get_by_role("button", name="Print a handout")).to_be_visible()
    return learner


def read(learner: Learner, step: str) -> None:
    """Scroll to a step."""
    learner.page.locator(f"#{step}").evaluate("node => node.scrollIntoView({ behavior: 'instant' })")


def state(learner: Learner, **expected: object) -> None:
    """Wait until the sim is in a state."""
    learner.until(lambda: {name: learner.params[name] for name in expected} == expected)


def number(learner: Learner, name: str) -> Locator:
    return learner.page.locator(f"[data-drag={name}]").first


def test_the_step_that_is_read_moves_the_sim_until_somebody_takes_over(reader: Learner) -> None:
    page = reader.page
    show, mine = page.get_by_role("button", name="Show this"), page.get_by_role("button", name="Back to mine")
    box = page.locator("iframe").first.bounding_box()
    assert box is not None
    assert box["y"] + box["height"] <= DESK["height"], "the sim's lower end isn't in sight as the page opens"
    read(reader, "the-last-degree")
    state(reader, pitch=89, yaw=0)
    expect(show).to_be_hidden()
    page.evaluate(BACK_AND_FORTH, ["the-other-end", "the-last-degree"])  # before the sim is there
    reader.frame.locator("[data-slide=yaw]").press("ArrowRight")
    state(reader, pitch=89, yaw=1)
    expect(show).to_be_visible()
    read(reader, "the-other-end")
    expect(page.locator(".current")).to_have_id("the-other-end")
    state(reader, pitch=89, yaw=1)
    show.click()
    state(reader, pitch=-90, yaw=0)
    mine.click()
    state(reader, pitch=89, yaw=1, roll=0)
    expect(show).to_be_visible()


def test_what_the_text_did_before_somebody_took_over_is_not_taken_for_theirs(reader: Learner) -> None:
    taken = reader.page.evaluate(OVERTAKEN, ["the-last-degree", "the-other-end"])
    assert taken == [True, True, True, True, False], "until they are back at the step by themselves"


def test_a_number_in_the_text_is_moved_and_typed(reader: Learner) -> None:
    pitch = number(reader, "pitch")
    told = pitch.locator("xpath=..").get_by_role("alert")
    pitch.press("ArrowUp")
    state(reader, pitch=1)
    pitch.fill("π/3")
    pitch.press("Enter")
    state(reader, pitch=60)
    expect(pitch).to_have_value("60")
    pitch.fill("999")
    pitch.press("Enter")
    expect(told).to_contain_text("999")
    expect(pitch).to_have_value("999")
    state(reader, pitch=60)
    pitch.press("Escape")
    expect(pitch).to_have_value("60")
    expect(told).to_be_empty()
    place = pitch.bounding_box()
    assert place is not None
    x, y = place["x"] + place["width"] / 2, place["y"] + place["height"] / 2
    mouse = reader.page.mouse
    mouse.move(x, y)
    mouse.down()
    mouse.move(x + 40, y, steps=5)
    state(reader, pitch=70)
    mouse.up()
    expect(pitch).to_have_value("70")

    states = {"params": {"a": 1.5, "b": [1, 2]}, "solution": {"c": None, "d": [None, 1]}}
    links = {
        "/x?c={value:c}&a={value:a}&d={value:d}&b={value:b}": "/x?a=1.5&b=1,2",
        "/x?process=none&a={value:a}&c={value:c}#part": "/x?process=none&a=1.5#part",
        "/x?c={value:c}": "/x",
        "/x?a={value:a}&e=none&c={value:c}": "/x?a=1.5&e=none",
    }
    found = {link: reader.page.evaluate(FILLED, [link, states]) for link in links}
    assert found == links, "what isn't there can't be carried on"


def test_questions_and_challenges_are_answered(reader: Learner) -> None:
    page = reader.page
    read(reader, "the-last-degree")
    state(reader, pitch=89)
    predict = page.locator("#the-last-degree [data-predict]")
    predict.get_by_role("button").click()
    expect(predict.get_by_role("status")).to_have_text("Choose one first.")
    predict.locator("[data-right]").check()
    predict.get_by_role("button").click()
    expect(predict.get_by_role("status")).to_contain_text("You saw that coming.")
    expect(predict.locator(".why")).to_be_visible()
    state(reader, pitch=90)
    page.locator(".current").get_by_role("button", name="Show this").click()
    state(reader, pitch=89)

    check = page.locator("[data-check]").first
    check.locator("input:not([data-right])").first.check()
    expect(check.get_by_role("status")).to_have_text("Not this one.")
    expect(check.locator(".reason:visible")).to_have_count(1)

    box = page.locator("[data-challenge=same-orientation]")
    read(reader, "two-rings-one-turn")
    state(reader, pitch=90, yaw=0)
    reader.type("yaw", "60")
    state(reader, yaw=60)
    reader.type("roll", "60")
    expect(box).to_have_attribute("data-solved", "1")
    expect(page.locator("[data-live]")).to_contain_text("solved.")
    reader.type("roll", "20")
    state(reader, roll=20)
    expect(box).to_have_attribute("data-solved", "1")


def test_a_lesson_opened_in_a_state_is_not_overruled(classroom: Classroom) -> None:
    reader = entered(classroom, "gimbal-lock?pitch=33")
    expect(reader.page.get_by_role("button", name="Show this")).to_be_visible()
    read(reader, "the-last-degree")
    expect(reader.page.locator(".current")).to_have_id("the-last-degree")
    state(reader, pitch=33)
    reader.page.get_by_role("button", name="Show this").click()
    state(reader, pitch=89)
    reader.page.wait_for_url(lambda url: "pitch=89" in url)
    reader.sockets.forget()
    reader.page.reload()
    reader.until(lambda: bool(reader.sockets.states))
    state(reader, pitch=89)
    read(reader, "the-other-end")
    state(reader, pitch=-90)


def test_a_link_to_a_step_the_ways_of_the_browser_and_another_tab(classroom: Classroom) -> None:
    reader = entered(classroom, "gimbal-lock#the-last-degree")
    page = reader.page
    state(reader, pitch=89)
    page.evaluate("location.hash = 'the-other-end'")
    state(reader, pitch=-90)
    page.go_back()
    state(reader, pitch=89)
    page.go_forward()
    state(reader, pitch=-90)
    between = {told["params"]["pitch"] for told in reader.sockets.states} - {0, 89, -90}
    assert not between, "under reduced motion nothing glides"

    tab = Learner(page.context.new_page(), reader.witness, reader.url)
    opened(tab, "gimbal-lock#the-last-degree")
    state(tab, pitch=89)
    reader.frame.locator("[data-slide=yaw]").press("ArrowRight")
    state(reader, pitch=-90, yaw=1)
    assert tab.params["yaw"] == 0, "each tab has a sim of its own"
    tab.page.close()

    page.goto(f"{reader.url}/concepts")
    reader.sockets.forget()
    page.go_back()
    at_lesson(reader)
    expect(page.locator(".current")).to_have_id("the-other-end")
    state(reader, pitch=-90, yaw=1)


def test_beside_a_lesson_the_sim_leaves_the_word_to_the_text(reader: Learner) -> None:
    caption, yaw = reader.frame.locator(".s3-caption"), reader.frame.locator("[data-slide=yaw]")
    expect(caption).to_be_hidden()
    expect(yaw).to_be_in_viewport()
    expect(reader.frame.locator(".s3-lamps")).to_be_in_viewport()
    reader.press("Try to turn about the lost axis")
    expect(caption).to_be_visible()


def test_a_symbol_points_as_long_as_it_is_pointed_at(reader: Learner) -> None:
    """Also where a glide has lit the same, and would put it out."""
    lit = reader.frame.locator(".s3-control.s3-highlighted[data-control=pitch]")
    set_ = {"type": "sim3:set", "params": {"pitch": 12}, "seconds": 0.01}
    reader.frame.evaluate(NOTED)
    reader.page.evaluate("(set) => document.querySelector('iframe').contentWindow.postMessage(set)", set_)
    expect(lit).to_be_visible()
    reader.page.locator("[data-point=pitch]").first.focus()
    reader.frame.evaluate("passes()")
    expect(lit).to_be_visible()
    reader.page.locator("[data-point=pitch]").first.blur()
    expect(lit).to_be_hidden()


def test_a_lesson_is_for_everybody(reader: Learner) -> None:
    """Whatever it holds, and where its tables and formulas are wider than the page."""
    unfold = "document.querySelectorAll('details').forEach((details) => (details.open = true))"
    reader.page.evaluate(unfold)
    assert axe(reader.page) == []
    opened(reader, "camera")
    reader.page.set_viewport_size({"width": 390, "height": 780})
    reader.page.evaluate(unfold)
    table = reader.page.locator("#other-ways-to-flatten-the-world > table")
    expect(table).to_have_attribute("tabindex", "0")
    assert axe(reader.page) == []
    reader.page.set_viewport_size(DESK)
    expect(table).not_to_have_attribute("tabindex", "0")


def test_where_the_scripts_of_a_lesson_fail_its_answers_are_read_all_the_same(classroom: Classroom) -> None:
    reader = classroom.enter()
    reader.witness.failures = ("no lesson",)
    why = reader.page.locator(".predict .why").first
    for failing in (False, True):
        if failing:
            reader.page.route(
                "**/lesson/*/main.js", lambda r: r.fulfill(content_type="text/javascript", body="throw 'no lesson'")
            )
        reader.page.route("**/embed*", lambda route: route.fulfill(body=""))
        reader.page.goto(f"{reader.url}/sims/gimbal-lock")
        expect(why).to_be_visible(visible=failing)


def test_a_frame_leads_through_the_steps(classroom: Classroom) -> None:
    learner = classroom.open_column("gimbal-lock/embed?lesson=1", reduced_motion="reduce")
    strip = learner.frame.locator(".s3-strip")
    expect(strip).to_contain_text("1 of 7: Three rings, three ways to turn")
    for pitch in (30, 60, 89, 90, -90, 90):
        strip.get_by_role("button", name="Next").click()
        state(learner, pitch=pitch)
    expect(strip.get_by_role("button", name="Next")).to_be_disabled()
    assert axe(learner.page) == []


def test_a_frame_holds_one_challenge(classroom: Classroom) -> None:
    learner = classroom.open_column("gimbal-lock/embed?challenge=half-reach", reduced_motion="reduce")
    strip = learner.frame.locator(".s3-strip")
    expect(strip).to_contain_text("Half of it left")
    learner.type("pitch", "48.59")
    expect(strip.locator(".s3-tick")).to_have_attribute("data-solved", "")
    expect(strip.get_by_role("status")).to_contain_text("solved")
    learner.type("pitch", "0")
    state(learner, pitch=0)
    expect(strip.locator(".s3-tick")).to_have_attribute("data-solved", "")
