"""A sim in a frame of a course page on another site: it works, and the two talk as the contract says."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from tests.e2e.conftest import Classroom
from tests.e2e.course import CourseSite, heard, say
from tests.e2e.learner import Learner

# What a course page may get wrong, and a word of the answer that says what it was.
MISTAKES: list[tuple[Any, str]] = [
    ({"type": "sim3:set", "params": {"yaw": 999}}, "yaw"),
    ({"type": "sim3:set", "params": {"yaw": "north"}}, "yaw"),
    ({"type": "sim3:set", "params": {"yaw": None}}, "yaw"),
    ({"type": "sim3:set", "params": {"pitch": 20, "colour": "red"}}, "colour"),
    ({"type": "sim3:set", "params": {"order": "zyy"}}, "order"),
    ({"type": "sim3:set", "params": 5}, "params"),
    ({"type": "sim3:set"}, "params"),
    ({"type": "sim3:action", "name": "dance"}, "dance"),
    ({"type": "sim3:action"}, "name"),
]


@pytest.fixture
def course() -> Iterator[CourseSite]:
    with CourseSite() as site:
        yield site


def in_frame(learner: Learner) -> None:
    learner.enter_frame()
    size = learner.frame.evaluate("[innerWidth, innerHeight, document.documentElement.scrollWidth]")
    assert size == [700, 600, 700]


def answers(learner: Learner, kind: str, more_than: int) -> Any:
    """The newest message of a kind, once there are more than a number."""
    return learner.until(lambda: heard(learner, kind)[more_than:][-1])


def test_a_course_page_and_a_sim_talk_to_each_other(classroom: Classroom, course: CourseSite) -> None:
    learner = classroom.enter(painted=False)
    course.show(learner, "euler-angles/embed?yaw=45")
    in_frame(learner)
    first = answers(learner, "sim3:state", 0)
    assert first["from"] == learner.url
    assert (first["params"]["yaw"], first["query"]) == (45, "yaw=45")

    learner.press_keys("yaw", "ArrowRight")
    learner.sees(yaw=46)
    assert learner.until(lambda: heard(learner, "sim3:state")[-1]["query"] == "yaw=46")

    say(learner, {"type": "sim3:set", "params": {"yaw": -50, "order": "xyz"}})
    solution = learner.sees(yaw=-50, order="xyz", pitch=20)
    learner.until(
        lambda: np.testing.assert_allclose(
            learner.scene.world_pose("/turn1/turn2/turn3")[:3, :3], solution["R"], atol=1e-6
        )
    )
    count = len(heard(learner, "sim3:state"))
    say(learner, {"type": "sim3:get"})
    assert answers(learner, "sim3:state", count)["params"] == learner.params

    for mistake, word in MISTAKES:
        count = len(heard(learner, "sim3:error"))
        say(learner, mistake)
        error = answers(learner, "sim3:error", count)
        assert error["slug"] == "euler-angles"
        assert word in error["message"], (mistake, error)
    for nonsense in ({"type": "sim3:launch"}, "sim3:get", 7, None, {"params": {"yaw": 3}}):
        say(learner, nonsense)
    learner.frame.evaluate("postMessage({ type: 'sim3:set', params: { yaw: 3 } }, '*')")  # not from the page around
    version = learner.sockets.state["version"]
    say(learner, {"type": "sim3:set", "params": {"roll": -5}})
    learner.sees(yaw=-50, order="xyz", pitch=20, roll=-5)
    assert learner.sockets.state["version"] == version + 1, "the mistakes changed something"

    say(learner, {"type": "sim3:action", "name": "reset"})
    learner.sees(yaw=45, order="zyx", roll=10)


def test_a_sandboxed_frame_works_too(classroom: Classroom, course: CourseSite) -> None:
    learner = classroom.enter()
    learner.witness.expect("The Clipboard API has been blocked", "Blocked autofocusing")  # then the link is shown
    course.show(learner, "triangulation/embed?noise=1", 'sandbox="allow-scripts"')
    in_frame(learner)
    assert answers(learner, "sim3:state", 0)["from"] == "null"
    assert answers(learner, "sim3:ready", 0)["slug"] == "triangulation"

    learner.press_keys("baseline", "End")
    learner.sees(baseline=2, noise=1)
    learner.frame.locator("[data-handle=left_uv]").press("ArrowRight")
    learner.sees(left_uv=[516, 210])  # the baseline held the 3D point
    say(learner, {"type": "sim3:set", "params": {"left_uv": [400.5, 212], "method": "optimal"}})
    learner.sees(left_uv=[400.5, 212], method="optimal")
    say(learner, {"type": "sim3:action", "name": "new-sample"})
    learner.sees(seed=1, left_uv=[400.5, 212])
    assert learner.until(lambda: heard(learner, "sim3:state")[-1]["query"] == learner.sockets.state["query"])

    learner.press("Share")
    link = learner.frame.get_by_role("textbox", name="Link to exactly this state")
    assert link.input_value() == f"{learner.url}/sims/triangulation/embed?{learner.query()}"
    learner.frame.get_by_role("button", name="Copy link").press("Enter")
    learner.frame.get_by_role("status").get_by_text(re.compile("Copied|It is selected")).wait_for()
    assert link.evaluate("field => document.activeElement === field && field.selectionEnd === field.value.length")
    learner.page.keyboard.press("Escape")
    learner.until(lambda: learner.frame.evaluate("document.activeElement.textContent === 'Share'"))
    learner.press_keys("baseline", "Home")
    learner.sees(baseline=0.05)
    learner.witness.expect("Download is disallowed")
    learner.press("Save picture")
    learner.says("the page around doesn’t allow it")


def test_a_bad_link_in_a_frame_tells_the_page(classroom: Classroom, course: CourseSite) -> None:
    learner = classroom.enter(size={"width": 720, "height": 640}, painted=False)
    learner.witness.expect("status of 422")
    course.show(learner, "euler-angles/embed?yaw=999&pitch=45")
    error = answers(learner, "sim3:error", 0)
    assert error["slug"] == "euler-angles"
    assert "yaw" in error["message"]
    assert "999" in error["message"]
    frame = learner.page.frames[-1]
    frame.get_by_role("link", name="Open the sim with the rest of the link").click()
    in_frame(learner)
    learner.sees(yaw=30, pitch=45)
