"""A class in the browser: a teacher and two learners, from the link to the end."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import cv2
import numpy as np
from playwright.sync_api import Frame, Page, ViewportSize, expect

from sims import by_slug
from tests.e2e.conftest import Classroom
from tests.e2e.learner import Learner

SLUG = "euler-angles"
DESK = ViewportSize(width=1280, height=800)
PHONE = ViewportSize(width=390, height=780)


def seat(classroom: Classroom, size: ViewportSize) -> Learner:
    """A browser of somebody's own, whose scenes aren't painted."""
    return classroom.enter(size=size, painted=False)


def inside(frame: Frame, selector: str) -> Frame:
    """The frame in a frame."""
    found = frame.wait_for_selector(selector)
    assert found is not None
    content = found.content_frame()
    assert content is not None
    return content


def sim_of(page: Page) -> Frame:
    """The frame of the sim in the lesson of somebody's page."""
    return inside(inside(page.main_frame, "iframe"), "iframe[data-slug]")


def put(page: Page, params: Mapping[str, Any]) -> None:
    """Bring somebody's sim into a state, as if they had done it."""
    lesson = sim_of(page).parent_frame
    assert lesson is not None
    message = {"type": "sim3:set", "params": dict(params)}
    lesson.evaluate("(message) => document.querySelector('iframe').contentWindow.postMessage(message, '*')", message)


def shows(page: Page, query: str) -> None:
    """Wait until somebody's sim is in a state."""
    sim_of(page).wait_for_function("(query) => location.search.includes(query)", arg=query)


def test_a_class_from_its_link_to_its_end(classroom: Classroom) -> None:
    sim = by_slug(SLUG)
    assert sim is not None
    challenge = next(each for each in sim.challenges if not each.path)
    solves = sim.params().changed(challenge.solves).model_dump(mode="json")

    desk = seat(classroom, DESK)
    teacher = desk.page
    teacher.goto(f"{desk.url}/class?sim={SLUG}&yaw=45")
    teacher.select_option("#page", f"sims/{SLUG}")
    teacher.select_option("#challenge", challenge.id)
    teacher.get_by_role("button", name="Open the class").click()
    teacher.wait_for_url(re.compile(r"/class/\w{6}$"))  # without the key
    shows(teacher, "yaw=45")
    link = teacher.url

    teacher.get_by_role("button", name="QR code").click()
    picture = cv2.imdecode(np.frombuffer(teacher.locator("dialog.large svg").screenshot(), np.uint8), cv2.IMREAD_COLOR)
    assert picture is not None
    assert cv2.QRCodeDetector().detectAndDecode(picture)[0] == link
    teacher.get_by_role("button", name="Close").click()

    ada, bob = (seat(classroom, PHONE).page for _ in range(2))
    for learner in (ada, bob):
        learner.goto(link)
        shows(learner, "yaw=45")
    names = [learner.locator(".me").inner_text().removeprefix("You are ") for learner in (ada, bob)]
    expect(teacher.locator(".grid .animal")).to_have_text(sorted(names))

    lesson = sim_of(ada).parent_frame
    assert lesson is not None
    expect(lesson.locator(".neighbours a, .top a, .end a").filter(visible=True)).to_have_count(0)  # nothing leads away
    question = lesson.locator("[data-predict]").first
    question.locator(".choice").nth(1).click()
    question.get_by_role("button").click()
    expect(teacher.locator(".bars").first.locator("b")).to_have_text(["0", "1", "0"])

    put(bob, solves)
    cell = teacher.locator(".grid li", has_text=names[1])
    expect(cell).to_contain_text("Solved")
    his = sim_of(bob).evaluate("location.search")

    put(teacher, {"yaw": 70})
    shows(teacher, "yaw=70")
    teacher.get_by_role("button", name="All eyes here").click()
    for learner in (ada, bob):
        shows(learner, "yaw=70")
        assert learner.locator(".frame iframe").evaluate("(frame) => frame.inert")
    put(teacher, {"yaw": 75})
    shows(ada, "yaw=75")
    teacher.get_by_role("button", name="Go on").click()
    shows(bob, his)

    cell.get_by_role("button").click()
    assert "yaw=75" in sim_of(teacher).evaluate("location.search"), "nothing is shown before a yes"
    bob.get_by_role("button", name="Yes, show it").click()
    expect(teacher.locator(".banner")).to_contain_text(names[1])
    shows(teacher, his)
    teacher.get_by_role("button", name="Back to mine").click()
    shows(teacher, "yaw=75")

    teacher.reload()
    expect(teacher.locator(".grid .animal")).to_have_text(sorted(names))
    shows(teacher, "yaw=75")
    bob.reload()
    expect(bob.locator(".me")).to_have_text(f"You are {names[1]}")
    teacher.get_by_role("button", name="End", exact=True).click()
    teacher.get_by_role("button", name="End it").click()
    expect(teacher.locator(".over")).to_be_visible()
    for learner in (ada, bob):
        expect(learner.locator(".says")).to_contain_text("The class is over")
