"""Rooms: learners on the same sim don't see each other; those with a room's link see the same, and may only watch."""

from __future__ import annotations

import re

import numpy as np
from playwright.sync_api import expect

from sims.kit.scene.view import FIELD
from tests.app.page import Page
from tests.e2e.conftest import Classroom
from tests.e2e.learner import Learner, box
from tests.frames import differences
from tests.server import camera_message

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

# The views of one who is led to another at 50 ms a frame, until the view is let go with the frame of a number.
LED = """async ([told, letGo]) => {
  const { Lead } = await import(sim3.main.replace("main.js", "lead.js"));
  const { matches } = matchMedia("(prefers-reduced-motion: reduce)");
  let now = 1000, next = null;
  const [clock, ask] = [performance.now, requestAnimationFrame];
  performance.now = () => now;
  window.requestAnimationFrame = (step) => ((next = step), 1);
  sim3.liveAt = 1;
  const view = { led: true, camera: [0, -4, 0, 0, 0, 0] };
  const lead = new Lead(view);
  const seen = [];
  lead.hear(told);
  for (let frame = 0; next && frame < 50; frame++) {
    const step = next;
    [next, view.led] = [null, frame < letGo];
    now += 50;
    step();
    if (view.led) seen.push(lead.at);
  }
  [performance.now, window.requestAnimationFrame] = [clock, ask];
  return { seen: seen.length ? seen : [lead.at], gliding: lead.gliding, reduced: matches };
}"""

# The application's address under a path that is called as the one of its sims.
SITE = """async () => {
  const { Address } = await import(sim3.main.replace("main.js", "address.js"));
  const { place } = sim3;
  sim3.place = place.replace("/sims/", "/sims/sims/");
  const { site } = new Address();
  sim3.place = place;
  return site.replace(new URL(place).origin, "");
}"""

# Of a view that is led, what the server is told before a hand comes down on the scene (x is 1, then 2), while it is down
# (3), and after that (4).
TOLD = """async () => {
  const { Lead } = await import(sim3.main.replace("main.js", "lead.js"));
  const own = Object.getOwnPropertyDescriptor(Lead.prototype, "gliding");
  Object.defineProperty(Lead.prototype, "gliding", { configurable: true, get: () => true });
  const told = [];
  const canvas = document.querySelector(".s3-scene").appendChild(document.createElement("canvas"));
  const root = { getState: () => ({ viewport: {}, setDpr() {}, invalidate() {} }), subscribe() {} };
  window.__viserMutable = {
    canvas, nodePoseData: {}, scene: { __r3f: { root } }, requestRender() {}, sendMessage: ({ position }) => told.push(position[0]),
  };
  const look = (x) => window.__viserMutable.sendMessage({ type: "ViewerCameraMessage", position: [x, 0, 0], look_at: [0, 0, 0] });
  const hand = (kind) => canvas.dispatchEvent(new PointerEvent(kind, { bubbles: true, pointerId: 9 }));
  look(1);
  look(2);
  hand("pointerdown");
  look(3);
  hand("pointerup");
  look(4);
  Object.defineProperty(Lead.prototype, "gliding", own);
  canvas.remove();
  return told;
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
    teacher = classroom.open_column("euler-angles/embed?yaw=70")
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
    teacher = classroom.open_column("camera/embed")
    watcher = classroom.open_column(teacher.watch_link)

    def lit(learner: Learner, name: str) -> None:
        learner.until(lambda: learner.lights(name, "g tr" if name else ""))
        learner.until(lambda: learner.scene.visible("/lit") == (name != ""))

    teacher.find("button", "Left cube, corner").hover()
    for learner in (teacher, watcher):
        lit(learner, "cube-left")
    teacher.page.mouse.move(0, 0)
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
    teacher.until(lambda: dialog.get_by_role("img").evaluate("(code) => code.naturalWidth > 0"))
    assert teacher.frame.evaluate(SITE) == "/sims"

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


def test_a_view_that_is_led_glides_round_what_it_looks_at(classroom: Classroom) -> None:
    watcher = classroom.open_column("euler-angles/embed")
    shape = watcher.frame.evaluate(
        "document.querySelector('.s3-scene').clientWidth / document.querySelector('.s3-scene').clientHeight"
    )
    told = {"view": [4, 0, 0, 0, 0, 0], "aspect": shape}
    seen = np.array(watcher.frame.evaluate(LED, [told, 99])["seen"])
    assert len(seen) > 3
    assert np.allclose(seen[-1], told["view"])
    assert np.allclose(np.linalg.norm(seen[:, :3], axis=1), 4.0), "no nearer on the way"
    assert (np.diff(seen[:, 0]) > 0).all(), "never back"
    let_go = watcher.frame.evaluate(LED, [told, 2])
    assert (len(let_go["seen"]), let_go["gliding"]) == (2, False), "a hand has it at once"

    wide = watcher.frame.evaluate(LED, [{"view": [0, -6, 0, 0, 0, 0], "aspect": shape / 3}, 99])["seen"][-1]
    half = np.arctan(np.tan(FIELD / 2) * np.minimum(1, [shape, shape / 3]))
    assert np.allclose(wide, [0, -6 * np.sin(half[1]) / np.sin(half[0]), 0, 0, 0, 0]), "what fits there fits here"

    calm = classroom.open_column("euler-angles/embed", reduced_motion="reduce")
    at_once = calm.frame.evaluate(LED, [told, 99])
    assert at_once["reduced"]
    assert at_once["seen"] == [told["view"]]

    assert calm.frame.evaluate(TOLD) == [2, 3], "what a hand drags is worked out from the view that it sees"


def test_a_watcher_looks_from_where_the_teacher_does_until_their_own_hand_turns_the_view(classroom: Classroom) -> None:
    with Page(classroom.server.url) as teacher:

        def look(x: float, y: float, z: float) -> None:
            size = box(watcher.frame.locator("canvas[data-engine]"))
            shape = {"image_width": int(size["width"]), "image_height": int(size["height"])}
            teacher.send({**camera_message(), **shape, "position": (x, y, z), "fov": FIELD})

        def looks(x: float, y: float, z: float) -> bool:
            return bool(np.allclose(watcher.sockets.camera["position"], (x, y, z), atol=0.02))

        watcher = classroom.open(teacher.address.replace(f"{teacher.key}/", ""))
        bar = watcher.frame.get_by_role("region", name="Live room")
        for place in ((1.0, -2.0, 6.0), (5.0, 1.0, 2.0)):
            look(*place)
            watcher.until(lambda at=place: looks(*at))  # type: ignore[misc]
        expect(bar.get_by_role("status")).to_have_text("You are watching, and your view follows.")

        at = box(watcher.frame.locator("canvas[data-engine]"))
        watcher.pull((at["x"] + 40, at["y"] + 200), 60, 10)
        expect(bar.get_by_role("status")).to_have_text("You are watching, from your own view.")
        led = [message for message in watcher.sockets.told if message["type"] == "led"]
        with Page(classroom.server.url, room=teacher.room) as other:
            look(1.0, -2.0, 6.0)
            other.until(lambda: np.allclose(other.led.get("view", [9])[:3], (1.0, -2.0, 6.0)), "who follows to be led")
        teacher.slide("yaw", 33)
        watcher.until(lambda: watcher.params["yaw"] == 33)
        assert [message for message in watcher.sockets.told if message["type"] == "led"] == led
        assert not looks(1.0, -2.0, 6.0)
        bar.get_by_role("button", name="Follow the view").click()
        watcher.until(lambda: looks(1.0, -2.0, 6.0))
