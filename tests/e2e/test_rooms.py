"""Rooms: learners on the same sim don't see each other; those with a room's link see the same, and may only watch."""

from __future__ import annotations

import re

import numpy as np
from playwright.sync_api import expect

from tests.e2e.conftest import Classroom
from tests.e2e.learner import Learner, box
from tests.frames import differences

# Panel widths and the names of sessions and connections aside, viewers of a room receive the same.
PRIVATE = """async (viewer) => {
  const socket = new WebSocket(`${sim3.socket}channel?viewer=${viewer}`);
  const answers = [];
  socket.onmessage = (event) => answers.push(JSON.parse(event.data));
  await new Promise((done) => (socket.onopen = done));
  const say = (message) => socket.send(JSON.stringify(message));
  say({ type: "hello", dark: false, reduced: false, query: "yaw=-7" });
  say({ type: "set", params: { yaw: -170 } });
  say({ type: "action", name: "animate" });
  say({ type: "handle", name: "left_uv", x: 1, y: 1 });
  say({ type: "get" });
  while (answers.filter((answer) => answer.type === "state").length < 2) await new Promise((done) => setTimeout(done, 20));
  socket.close();
  return answers.filter((answer) => answer.type === "state");
}"""


def same_scene(a: Learner, b: Learner) -> None:
    """Both browsers received the same scene (not the same panel: a watcher's is disabled)."""

    def compare() -> None:
        scenes = [{k: v for k, v in x.scene.snapshot().items() if k.startswith("scene ")} for x in (a, b)]
        for scene in scenes:
            for thing in scene.values():
                thing.pop("drags"), thing.pop("clicks")
        assert differences(*scenes, within=1e-9) == []

    a.until(compare)


def test_two_browsers_on_the_same_sim_do_not_see_each_other(classroom: Classroom) -> None:
    ada = classroom.open_column("euler-angles/embed?yaw=45")
    bob = classroom.open_column("euler-angles/embed?yaw=45")
    assert ada.room != bob.room
    before = bob.scene.messages

    ada.type("pitch", "-60")
    ada.sees(yaw=45, pitch=-60)
    bob.type("roll", "-33")
    bob.sees(yaw=45, pitch=20, roll=-33)
    ada.type("yaw", "12")
    ada.sees(yaw=12, pitch=-60, roll=10)
    assert [state["params"]["pitch"] for state in bob.sockets.states] == [20] * len(bob.sockets.states)
    assert bob.scene.messages > before
    assert not np.allclose(ada.scene.world_pose("/turn1"), bob.scene.world_pose("/turn1"))


def test_viewers_of_a_room_see_the_same_and_a_watcher_changes_nothing(classroom: Classroom) -> None:
    teacher = classroom.open("euler-angles/embed?yaw=70")
    helper = classroom.open_column(teacher.room)
    watcher = classroom.open_column(teacher.watch_link)
    helper.sees(yaw=70)
    watcher.sees(yaw=70)

    helper.type("pitch", "-40")
    for learner in (teacher, helper, watcher):
        learner.sees(yaw=70, pitch=-40)
    teacher.choose("order", "zxz")
    for learner in (teacher, helper, watcher):
        learner.sees(order="zxz", yaw=70)
    same_scene(teacher, helper)
    same_scene(teacher, watcher)

    version = teacher.sockets.state["version"]
    for control in watcher.frame.locator(".s3-controls :is(input, select, [data-act], [data-nudge])").all():
        assert control.is_disabled(), control.evaluate("e => e.outerHTML")
    track = box(watcher.frame.locator("[data-slide]").first)
    watcher.page.mouse.click(track["x"] + 10, track["y"] + track["height"] / 2)
    watcher.press("Reset", force=True)
    answers = watcher.frame.evaluate(PRIVATE, "0123456789abcdef")
    assert {answer["params"]["yaw"] for answer in answers} == {70}

    teacher.type("roll", "5")
    for learner in (teacher, helper, watcher):
        learner.sees(yaw=70, roll=5)
        assert learner.sockets.state["version"] == version + 1, "the watcher changed something"
    assert watcher.sockets.state["version"] == version + 1


def test_a_room_sees_what_its_teacher_points_at_and_a_watcher_points_for_themselves(classroom: Classroom) -> None:
    teacher = classroom.open("camera/embed")
    watcher = classroom.open_column(teacher.watch_link)

    def lit(learner: Learner, name: str) -> None:
        learner.until(lambda: learner.lights(name, "g tr" if name else ""))
        learner.until(lambda: learner.scene.visible("/lit") == (name != ""))

    teacher.find("button", "Left cube, corner").hover()
    for learner in (teacher, watcher):
        lit(learner, "cube-left")
    teacher.page.mouse.move(*teacher.place((0, 0, 0)))
    for learner in (teacher, watcher):
        lit(learner, "")

    row = watcher.find("button", "Near post, top")
    row.hover()
    lit(watcher, "near-post")
    row.click()
    teacher.press("Look at the house")
    watcher.until(lambda: watcher.params["pan"] != 0)
    watcher.sees(selected="roof-near")
    lit(watcher, "near-post")
    lit(teacher, "")


def test_a_teacher_presents_hands_over_takes_back_and_a_watcher_takes_a_copy(classroom: Classroom) -> None:
    teacher = classroom.open_column("euler-angles/embed?yaw=70")
    teacher.press("Present")
    dialog = teacher.frame.get_by_role("dialog", name="Present")
    watch_link = dialog.get_by_label("Link to watch").input_value()
    assert watch_link == teacher.watch_link

    watcher = classroom.open_column(watch_link)
    expect(dialog.get_by_text("1 person is watching.")).to_be_visible()
    bar = watcher.frame.get_by_role("region", name="Live room")
    expect(bar.get_by_role("status")).to_contain_text("You are watching")
    assert watcher.find("button", "Present").is_hidden()

    dialog.get_by_role("button", name="Make a link to steer").press("Enter")
    expect(dialog.get_by_label("Link to steer")).to_have_value(re.compile(r"#steer=[\w-]{10,}$"))
    steer_link = dialog.get_by_label("Link to steer").input_value()
    assert steer_link.startswith(f"{watch_link}#steer=")
    helper = classroom.open_column(steer_link)
    expect(helper.frame.get_by_role("status").get_by_text("You steer this sim")).to_be_visible()
    assert "#" not in helper.address
    helper.type("pitch", "-40")
    for learner in (teacher, helper, watcher):
        learner.sees(yaw=70, pitch=-40)

    dialog.get_by_role("button", name="Take it back").press("Enter")
    expect(helper.frame.get_by_role("status").get_by_text("Control was taken back.")).to_be_visible()
    expect(helper.control("textbox", "pitch")).to_be_disabled()
    teacher.page.keyboard.press("Escape")
    expect(dialog).to_be_hidden()

    bar.get_by_role("button", name="Make my own copy").click()
    expect(bar.get_by_role("status")).to_have_text("This is your own copy.")
    assert "/embed?yaw=70&pitch=-40" in watcher.address
    assert "#" not in watcher.address
    expect(watcher.control("textbox", "pitch")).to_be_enabled()
    bar.get_by_role("button", name="Back to the live room").click()
    expect(bar.get_by_role("status")).to_contain_text("You are watching")
    assert watcher.address.startswith(watch_link)
