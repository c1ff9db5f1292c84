"""The server is killed and started again: open pages come back by themselves, with their state."""

from __future__ import annotations

import numpy as np
from playwright.sync_api import ViewportSize, expect

from tests.e2e.conftest import Classroom
from tests.e2e.course import CourseSite
from tests.e2e.learner import Learner
from tests.e2e.test_lessons import entered, read, state
from tests.server import Server

SMALL: ViewportSize = {"width": 640, "height": 480}


def came_back(learner: Learner, connections: int, **state: object) -> None:
    learner.until(lambda: learner.sockets.connected > connections)
    solution = learner.sees(**state)
    learner.until(
        lambda: np.testing.assert_allclose(
            learner.scene.world_pose("/turn1/turn2/turn3")[:3, :3], solution["R"], atol=1e-6
        )
    )


def in_a_lesson(classroom: Classroom) -> Learner:
    """Somebody who has moved the sim in the middle of a lesson."""
    reader = entered(classroom, "gimbal-lock")
    read(reader, "the-last-degree")
    state(reader, pitch=89)
    reader.type("yaw", "33")
    state(reader, yaw=33)
    reader.sockets.forget()
    return reader


def goes_on(reader: Learner) -> None:
    """State and place are as they were, what was moved is still theirs, and the text moves the sim again."""
    reader.until(lambda: bool(reader.sockets.states))
    state(reader, pitch=89, yaw=33)
    expect(reader.page.locator(".current")).to_have_id("the-last-degree")
    reader.page.locator(".current").get_by_role("button", name="Show this").click()
    state(reader, pitch=89, yaw=0)


def test_open_pages_survive_a_crash_of_the_server(classroom: Classroom, server: Server) -> None:
    with CourseSite() as course:
        learner = classroom.open("euler-angles/embed?yaw=45", size=SMALL)
        learner.type("roll", "-66")
        learner.sees(yaw=45, roll=-66)
        watcher = classroom.open(learner.watch_link, size=SMALL)
        watcher.sees(roll=-66)
        framed = classroom.enter(size={"width": 720, "height": 640})
        course.show(framed, "euler-angles/embed?pitch=-35")
        framed.enter_frame()
        framed.sees(pitch=-35)

        reader = in_a_lesson(classroom)

        everybody = (learner, watcher, framed)
        before = [each.sockets.connected for each in everybody]
        for each in (*everybody, reader):
            each.witness.expect("WebSocket connection to", "net::ERR_", "Tried to send", "WebSocket error")
        server.kill()
        learner.press_keys("roll", "ArrowRight", "ArrowRight")  # what is put in meanwhile isn't lost
        server.start()
        goes_on(reader)
        came_back(learner, before[0], yaw=45, roll=-64)
        came_back(watcher, before[1], yaw=45, roll=-64)
        came_back(framed, before[2], pitch=-35)
        assert not framed.page.evaluate("document.querySelector('iframe') === document.activeElement")

        learner.type("pitch", "5")
        learner.sees(yaw=45, roll=-64, pitch=5)
        watcher.sees(yaw=45, roll=-64, pitch=5)
        framed.press_keys("pitch", "ArrowLeft")
        framed.sees(pitch=-36)
        learner.press("Reset")
        learner.sees(yaw=45, pitch=20, roll=10)
