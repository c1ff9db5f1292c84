"""The server is killed and started again: open pages come back by themselves, with their state."""

from __future__ import annotations

import numpy as np
from playwright.sync_api import ViewportSize, expect

from tests.column import ColumnModel
from tests.e2e.conftest import Classroom
from tests.e2e.course import CourseSite
from tests.e2e.learner import Learner
from tests.e2e.test_lessons import entered, read, state
from tests.server import Server

SMALL: ViewportSize = {"width": 640, "height": 480}
# What a channel says on each of its sockets. A step of what happens is what is put in, as "yaw=5", or a
# press, as "apply". The connection "opens" to a room that goes on, or "begins" anew, or is "full"; it "breaks"; a number
# is milliseconds that pass.
SAID = """async (story) => {
  const { Channel } = await import(sim3.main.replace("main.js", "channel.js"));
  const [clock, wait, Socket] = [performance.now, setTimeout, WebSocket];
  const sockets = [];
  let [now, again] = [0, null];
  performance.now = () => now;
  window.setTimeout = (does) => { again = does; };
  window.WebSocket = class {
    static OPEN = 1;
    said = [];
    constructor() { sockets.push(this); }
    send(text) {
      const { type, name, value } = JSON.parse(text);
      if (type !== "hello") this.said.push(type === "slide" ? `${name}=${value}` : name);
    }
  };
  const channel = new Channel(() => ({}), () => {}, () => {}, () => {});
  const open = (answer) => {
    if (sockets.length) again();
    else channel.open();
    const socket = sockets.at(-1);
    socket.readyState = 1;
    socket.onopen();
    if (answer) socket.onmessage({ data: JSON.stringify({ type: "state", ...answer }) });
  };
  const does = {
    opens: () => open({ begins: false }), begins: () => open({ begins: true }), full: () => open(null),
    breaks: () => sockets.at(-1).onclose({ code: 1006, reason: "" }),
  };
  for (const step of story.split(" ")) {
    const [name, value] = step.split("=");
    if (Number(step)) now += Number(step);
    else if (does[step]) does[step]();
    else channel.send(value ? { type: "slide", name, value: Number(value) } : { type: "action", name });
  }
  [performance.now, window.setTimeout, window.WebSocket] = [clock, wait, Socket];
  return sockets.map(({ said }) => said.join(" "));
}"""
STORIES = {
    "opens breaks apply 100 opens 400 breaks begins": ["", "apply", ""],
    "opens breaks yaw=9 3000 full 10 breaks 500 opens 10 breaks begins": ["", "", "yaw=9", "yaw=9"],
    "opens yaw=5 500 breaks 30000 opens": ["yaw=5", ""],
    "opens yaw=5 500 breaks 30000 roll=1 begins": ["yaw=5", "yaw=5 roll=1"],
    "opens yaw=5 2000 breaks begins": ["yaw=5", ""],
    "opens yaw=5 apply breaks begins": ["yaw=5 apply", ""],
    "opens breaks yaw=1 yaw=2 apply yaw=3 opens": ["", "yaw=2 apply yaw=3"],
}
"""What happens, and what is then said on each of the sockets that were opened."""


def came_back(learner: Learner, before: ColumnModel, **state: object) -> None:
    """Wait until somebody's page has begun anew, and shows and draws their state."""
    learner.until(lambda: learner.sockets.column is not before)
    learner.wait_live()
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


def test_what_is_put_in_while_the_connection_breaks_is_neither_lost_nor_said_twice(classroom: Classroom) -> None:
    frame = classroom.open_column("euler-angles/embed").frame
    assert {story: frame.evaluate(SAID, story) for story in STORIES} == STORIES


def test_open_pages_survive_a_crash_of_the_server(classroom: Classroom, server: Server) -> None:
    with CourseSite() as course:
        learner = classroom.open("euler-angles/embed?yaw=45", size=SMALL)
        learner.type("roll", "-66")
        learner.sees(yaw=45, roll=-66)
        watcher = classroom.open_column(learner.watch_link)
        watcher.sees(roll=-66)
        framed = classroom.enter(size={"width": 720, "height": 640})
        course.show(framed, "euler-angles/embed?pitch=-35")
        framed.enter_frame()
        framed.sees(pitch=-35)

        reader = in_a_lesson(classroom)

        everybody = (learner, watcher, framed)
        before = [each.sockets.column for each in everybody]
        connected = learner.sockets.connected
        for each in (*everybody, reader):
            each.witness.expect("WebSocket connection to", "net::ERR_", "Tried to send", "WebSocket error")
        server.kill()
        learner.press_keys("roll", "ArrowRight", "ArrowRight")  # what is put in meanwhile isn't lost
        server.start()
        goes_on(reader)
        came_back(learner, before[0], yaw=45, roll=-64)
        assert learner.sockets.connected > connected, "the scene that it draws is the old one"
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
