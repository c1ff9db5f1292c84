"""The column beside the scene: typing, sliding, choosing, highlighting and its layout. Its pages have no scene."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import ViewportSize

from sims import SIMS
from tests.e2e.conftest import Classroom
from tests.e2e.learner import LIT, THUMB, Learner, box, touch

Open = Callable[..., Learner]
PASTE = """([node, text]) => {
    const clipboardData = new DataTransfer();
    clipboardData.setData("text/plain", text);
    node.dispatchEvent(new ClipboardEvent("paste", { clipboardData, bubbles: true, cancelable: true }));
    node.value = text;
    node.dispatchEvent(new InputEvent("input", { bubbles: true }));
}"""
# What can be pressed, typed into or chosen, and how large it is.
TARGETS = """() => [...document.querySelectorAll(".s3-column :is(button, select, input, summary, a)")]
    .filter((node) => node.checkVisibility() && node.type !== "radio")
    .map((node) => [(node.closest("label") ?? node), node])
    .map(([label, node]) => [label.getBoundingClientRect(), node.outerHTML.slice(0, 90)])
    .filter(([{ width, height }]) => width && Math.min(width, height) < LEAST)
    .map(([{ width, height }, html]) => `${width}×${height} ${html}`)"""

# Notes what is chosen of some, frame by frame; what is sent takes a while.
CHOSEN = """(_, name) => {
    const { send } = WebSocket.prototype;
    WebSocket.prototype.send = function (...given) { setTimeout(() => send.apply(this, given), 200); };
    const chosen = (window.chosen = []);
    const look = () => {
        const now = document.querySelector(`[data-choice="${name}"]:checked`).value;
        if (now !== chosen.at(-1)) chosen.push(now);
        requestAnimationFrame(look);
    };
    look();
}"""


@pytest.fixture
def column(classroom: Classroom) -> Open:
    return classroom.open_column


def held(learner: Learner, **expected: Any) -> None:
    """Wait until the state is as expected, and every box shows it."""
    learner.until(lambda: {name: learner.params[name] for name in expected} == expected)


def shown(learner: Learner, name: str) -> str:
    return learner.control("textbox", name).input_value()


def yaw_is(learner: Learner, yaw: float, seen: str) -> None:
    learner.until(lambda: learner.params["yaw"] == pytest.approx(yaw) and shown(learner, "yaw") == seen)


def test_what_is_typed_key_by_key_is_taken_as_it_is_meant(column: Open) -> None:
    learner = column("euler-angles/embed")
    for text, yaw, seen in (
        ("47.5", 47.5, "47.5"), ("70.5", 70.5, "70.5"), ("-0.6", -0.6, "−0.6"), ("−12,25", -12.25, "−12.25"),
        ("1e2", 100, "100"), ("π/3", 60, "60"), ("90°", 90, "90"), ("1 rad", 57.29577951308232, "57.2958"),
    ):  # fmt: skip
        field = learner.control("textbox", "yaw")
        field.click(click_count=3)
        learner.page.keyboard.type(text, delay=2)
        learner.page.keyboard.press("Enter")
        yaw_is(learner, yaw, seen)
        slider = learner.control("slider", "yaw")
        assert float(slider.evaluate("node => node.value")) == pytest.approx(yaw)
        assert slider.get_attribute("aria-valuetext") == f"{seen}°"


def test_what_is_typed_is_taken_when_it_is_left_or_after_a_pause(column: Open) -> None:
    learner = column("camera/embed")
    first = learner.control("textbox", "position.0")
    first.click()
    learner.page.keyboard.type("-0.6")
    learner.page.keyboard.press("Tab")
    held(learner, position=[-0.6, -4, 1.2])
    learner.page.keyboard.type("−3,5")
    held(learner, position=[-0.6, -3.5, 1.2])  # nothing was pressed: it is finished after a pause
    learner.page.keyboard.press("Escape")
    assert shown(learner, "position.1") == "−3.5"


def test_what_cannot_be_taken_stays_with_the_reason(column: Open) -> None:
    learner = column("euler-angles/embed?yaw=12")
    for text in ("400", "ninety"):
        learner.type("yaw", text)
        wrong = learner.frame.locator('[data-control="yaw"] .s3-wrong')
        wrong.wait_for()
        assert "from −180 to 180°" in (wrong.text_content() or "")
        assert shown(learner, "yaw") == text
        assert learner.params["yaw"] == 12
        assert learner.control("textbox", "yaw").get_attribute("aria-invalid") == "true"
    learner.control("textbox", "yaw").press("Escape")
    assert shown(learner, "yaw") == "12"
    wrong.wait_for(state="hidden")
    learner.type("yaw", "13")
    held(learner, yaw=13)


def test_what_was_refused_goes_with_the_next_good_input(column: Open) -> None:
    learner = column("euler-angles/embed?yaw=12")
    wrong = learner.frame.locator('[data-control="yaw"] .s3-wrong')
    inputs: list[Callable[[], None]] = [
        lambda: learner.press_keys("roll", "ArrowRight"),
        lambda: learner.type("pitch", "21"),
        lambda: learner.choose("order", "xyz"),
        lambda: learner.press("Reset"),
    ]
    for go_on in inputs:
        learner.type("yaw", "400")
        wrong.wait_for()
        assert shown(learner, "yaw") == "400"
        go_on()
        wrong.wait_for(state="hidden")
        assert learner.control("textbox", "yaw").get_attribute("aria-invalid") is None
        learner.until(lambda: shown(learner, "yaw") == "12")


def test_three_numbers_are_pasted_at_once(column: Open) -> None:
    learner = column("camera/embed")
    field = learner.control("textbox", "position.0")
    field.click()
    learner.frame.evaluate(PASTE, [field.element_handle(), "(1.5; -2; 3)"])
    held(learner, position=[1.5, -2, 3])
    learner.until(lambda: [shown(learner, f"position.{k}") for k in range(3)] == ["1.5", "−2", "3"])


def test_keys_move_a_slider_by_steps_tens_and_to_its_ends(column: Open) -> None:
    learner = column("euler-angles/embed?yaw=10.5")
    for key, yaw in (
        ("ArrowRight", 11.5), ("ArrowDown", 10.5), ("Shift+ArrowRight", 20.5), ("PageUp", 30.5), ("PageDown", 20.5),
        ("End", 180), ("ArrowRight", 180), ("Home", -180),
    ):  # fmt: skip
        learner.press_keys("yaw", key)
        held(learner, yaw=yaw)
    learner.control("slider", "yaw").dblclick()
    held(learner, yaw=30)


def test_a_dragged_slider_takes_round_numbers_and_sends_no_more_than_is_drawn(column: Open) -> None:
    learner = column("euler-angles/embed")
    before = learner.sockets.column.messages
    learner.slide("yaw", 140)
    learner.until(lambda: learner.params["yaw"] > 100)
    learner.until(lambda: shown(learner, "yaw") == f"{learner.params['yaw']:g}")
    assert learner.params["yaw"] == round(learner.params["yaw"])
    assert learner.sockets.column.messages - before <= 20


def test_what_is_held_stays_under_the_hand_whatever_is_said_above_it(column: Open) -> None:
    """A point that is dragged until the rays part, and a slider into gimbal lock: the numbers above get fewer, or more."""
    learner = column("triangulation/embed", size=ViewportSize(width=390, height=780))
    mouse, picture = learner.page.mouse, learner.frame.locator("svg[data-pane=right]")
    handle = learner.frame.locator("[data-handle=right_uv] .s3-core")
    handle.scroll_into_view_if_needed()
    at, before = box(handle), box(picture)
    x, y = at["x"] + at["width"] / 2, at["y"] + at["height"] / 2
    mouse.move(x, y)
    mouse.down()
    for far, words in ((40, "The rays don’t meet"), (0, "Drag the 3D point onto a corner")):
        mouse.move(x + far, y + far / 4, steps=3)
        learner.until(lambda words=words: words in (learner.frame.locator(".s3-caption").text_content() or ""))  # type: ignore[misc]
        scale = before["width"] / 640
        held(learner, right_uv=pytest.approx([320 + far / scale, 210 + far / 4 / scale], abs=0.02))
        assert box(picture) == pytest.approx(before, abs=1)
    mouse.up()

    learner = column("gimbal-lock/embed", size=ViewportSize(width=700, height=600))
    mouse, slider = learner.page.mouse, learner.control("slider", "pitch")
    slider.scroll_into_view_if_needed()
    track = box(slider)
    mouse.move(track["x"] + track["width"] / 2, track["y"] + 12)
    mouse.down()
    mouse.move(track["x"] + track["width"] / 2 + (track["width"] - THUMB) / 4, track["y"] + 12, steps=3)
    learner.until(lambda: "One lamp is out" in (learner.frame.locator(".s3-caption").text_content() or ""))
    held(learner, pitch=90)
    assert box(slider)["y"] == pytest.approx(track["y"], abs=1)
    mouse.up()


def test_what_is_moved_by_keys_stays_in_sight_whatever_is_said_above_it(column: Open) -> None:
    learner = column("triangulation/embed", size=ViewportSize(width=700, height=600))
    slider, primary = learner.control("slider", "baseline"), learner.frame.locator(".s3-primary")
    slider.focus()
    assert box(slider)["y"] + box(slider)["height"] <= box(primary)["y"]
    before = box(learner.frame.locator(".s3-key"))
    learner.page.keyboard.press("Home")
    held(learner, baseline=0.05)
    learner.until(lambda: "shorter baseline" in (learner.frame.locator(".s3-caption").text_content() or ""))
    after = box(learner.frame.locator(".s3-key"))
    assert after["height"] + after["y"] != before["height"] + before["y"], "the text above is as high as before"
    learner.until(lambda: box(slider)["y"] + box(slider)["height"] <= box(primary)["y"])


def test_what_is_wrong_and_what_is_asked_come_in_sight(column: Open) -> None:
    """Under a control at the foot of the column, where a button lies."""
    learner = column("gimbal-lock/embed", size=ViewportSize(width=390, height=780))
    primary = learner.frame.locator(".s3-primary")
    learner.type("yaw", "1e9")
    wrong = learner.frame.locator('[data-control="yaw"] .s3-wrong')
    wrong.wait_for()
    learner.until(lambda: box(wrong)["y"] + box(wrong)["height"] <= box(primary)["y"])
    learner.frame.locator('[data-control="roll"] .s3-ask').press("Enter")
    why = learner.frame.locator('[data-control="roll"] .s3-why')
    learner.until(lambda: box(why)["y"] + box(why)["height"] <= box(primary)["y"])


def test_a_long_dialog_begins_at_its_beginning(column: Open) -> None:
    learner = column("gimbal-lock/embed", size=ViewportSize(width=390, height=600))
    learner.page.keyboard.press("?")
    keys = learner.page.get_by_role("dialog", name="Keys")
    keys.wait_for()
    assert keys.evaluate("node => [node.scrollTop, node.contains(document.activeElement)]") == [0, True]
    learner.page.keyboard.press("Escape")
    keys.wait_for(state="hidden")


def test_a_finger_on_its_way_past_a_slider_moves_nothing(column: Open) -> None:
    learner = column("euler-angles/embed", size=ViewportSize(width=390, height=780), has_touch=True, is_mobile=True)
    slider = learner.control("slider", "yaw")
    slider.scroll_into_view_if_needed()
    track, before = box(slider), learner.sockets.state["version"]
    x, y = track["x"] + 0.8 * track["width"], track["y"] + track["height"] / 2
    touch(learner, *((x, y - 9 * k) for k in range(14)))
    learner.until(lambda: learner.frame.evaluate("document.querySelector('.s3-column').scrollTop") > 50)
    learner.until(lambda: float(slider.input_value()) == 30)
    assert learner.sockets.state["version"] == before

    slider.scroll_into_view_if_needed()
    track = box(slider)
    x, y = track["x"] + 0.8 * track["width"], track["y"] + track["height"] / 2
    touch(learner, (x, y))
    held(learner, yaw=pytest.approx(116, abs=6))  # a tap leads it there
    touch(learner, *((x - 6 * k, y) for k in range(14)))
    learner.until(lambda: learner.params["yaw"] < 20)


def test_choices_switches_and_lists_answer(column: Open) -> None:
    learner = column("transform-chain/embed")
    learner.choose("axes.0", "x")
    held(learner, axes="xyy")
    learner.choose("swap", "2")
    held(learner, swap=2)
    learner.choose("swap", None)
    held(learner, swap=None)
    learner.press("Add link")
    learner.until(lambda: learner.frame.locator('[data-slide="angles.3"]').count() == 1)
    learner.press_keys("angles.3", "ArrowRight")
    held(learner, angles=[30, 40, -30, 0.5])
    learner = column("camera/embed")
    learner.control("checkbox", "show_rays").press("Space")
    held(learner, show_rays=False)
    learner.choose("projection", "weak")
    held(learner, projection="weak")


def test_what_was_chosen_stays_chosen_while_something_moves(column: Open) -> None:
    learner = column("coordinate-frames/embed")
    learner.choose("convention", "opengl")
    learner.until(lambda: learner.params["turn"])
    learner.frame.locator("body").evaluate(CHOSEN, "handedness")
    learner.choose("handedness", "left")
    held(learner, handedness="left")
    learner.until(lambda: not learner.params["turn"])
    assert learner.frame.locator("body").evaluate("window.chosen") == ["", "left"], "back and forth before"


def test_parts_that_change_keep_the_focus_and_what_is_open(column: Open) -> None:
    learner = column("camera/embed")
    frame = learner.frame
    fold = frame.locator("details", has=frame.locator("summary", has_text="All points"))
    fold.locator("summary").click()
    ask = frame.locator('[data-control="fx"] .s3-ask')
    ask.click()
    frame.get_by_text("In pixel widths.").wait_for()
    row = fold.get_by_role("button", name="Near post, top")
    row.focus()
    learner.page.keyboard.press("Enter")
    held(learner, selected="near-post")
    learner.until(lambda: row.get_attribute("aria-pressed") == "true")
    assert frame.evaluate("document.activeElement.textContent") == "Near post, top"
    assert fold.get_attribute("open") is not None
    assert ask.get_attribute("aria-expanded") == "true"
    assert frame.get_by_text("In pixel widths.").is_visible()


POSED = ("li", "position pan tilt roll")
"""The step of a chain to which position and angles lead."""


def test_a_control_and_what_it_changes_are_highlighted_together(column: Open) -> None:
    learner = column("camera/embed")
    frame = learner.frame

    def lit() -> set[tuple[str, str]]:
        return {(tag, link) for tag, link in frame.evaluate(LIT)}

    frame.locator('[data-control="fx"]').hover()
    learner.until(lambda: lit() == {("div", "fx"), ("mtd", "fx"), ("li", "fx fy cx cy skew")})
    frame.locator('mtd[data-link="position"]').first.hover()
    learner.until(lambda: lit() == {("div", "position"), ("mtd", "position"), POSED})
    learner.control("slider", "tilt").focus()
    learner.page.mouse.move(5, 5)
    learner.until(lambda: lit() == {("div", "tilt"), ("mtd", "pan tilt roll"), POSED})


def test_a_picture_is_enlarged_stays_live_and_goes_back(column: Open) -> None:
    learner = column("triangulation/embed")
    figure = learner.frame.locator("figure", has=learner.frame.locator('svg[data-pane="left"]'))
    small = box(figure)["width"]
    figure.get_by_role("button", name="larger").click()
    learner.until(lambda: box(figure)["width"] > 2 * small)
    learner.frame.locator("[data-handle=left_uv]").press("ArrowRight")
    held(learner, left_uv=[411, 210])
    learner.page.keyboard.press("Escape")
    learner.until(lambda: box(figure)["width"] == small)


def test_only_some_controls_are_there_when_a_link_says_so(column: Open) -> None:
    learner = column("euler-angles/embed?only=yaw,roll&yaw=5")
    inputs = learner.frame.locator("[data-slide], [data-choice]").evaluate_all("all => all.map((n) => n.dataset.slide)")
    assert inputs == ["yaw", "roll"]
    assert learner.frame.locator(".s3-fold").count() == 0
    learner.press_keys("roll", "ArrowRight")
    held(learner, roll=11)
    learner.until(lambda: "only=yaw,roll" in learner.address)


# How the column is laid out: by how much it is too wide, what is cut off (also of boxes with the longest number of six
# digits), units that stand beside no box, what is too small to be hit; and where three things are.
LAID = """() => {
  const seen = (what) => [...document.querySelectorAll(what)].filter((node) => node.checkVisibility({ visibilityProperty: true }));
  const place = (what) => document.querySelector(what).getBoundingClientRect().toJSON();
  const texts = [".s3-formula", "[data-box]", ".s3-caption", "figcaption b", "figcaption span"];
  const narrow = seen("[data-box]").filter((box) => {
    const { value } = box;
    box.value = "−0.176252";
    const cut = !box.closest(".s3-vector") && box.scrollWidth > box.clientWidth;
    box.value = value;
    return cut;
  });
  const stray = seen(".s3-vector > .s3-unit").filter((unit) => {
    const boxes = unit.parentElement.querySelectorAll("input");
    const [beside, at] = [boxes[boxes.length - 1], unit].map((node) => node.getBoundingClientRect());
    return at.left < beside.right || at.left > beside.right + 20 || at.top < beside.top || at.bottom > beside.bottom;
  });
  const { scrollWidth, clientWidth } = document.querySelector(".s3-column");
  return {
    column: scrollWidth - clientWidth,
    cut: texts.filter((what) => seen(what).some((one) => one.scrollWidth > one.clientWidth + 1)),
    narrow: narrow.map((box) => box.dataset.box),
    stray: stray.map((unit) => unit.parentElement.dataset.vector),
    small: (TARGETS)(),
    scene: place(".s3-scene"), beside: place(".s3-column"), primary: place(".s3-primary"),
  };
}""".replace("TARGETS", TARGETS.replace("LEAST", "23.5"))
SIZES: list[tuple[int, int]] = [(1280, 800), (700, 600), (560, 315), (390, 780), (320, 640), (640, 400)]


@pytest.mark.parametrize("slug", [sim.slug for sim in SIMS])
def test_everything_has_its_place_at_every_size(column: Open, slug: str) -> None:
    learner = column(f"{slug}/embed", size=ViewportSize(width=1280, height=800))
    frame = learner.frame
    folds = "open => document.querySelectorAll('details').forEach((fold) => (fold.open = open))"
    for width, height in SIZES:
        learner.page.set_viewport_size({"width": width, "height": height})
        over = frame.evaluate("document.documentElement.scrollWidth - innerWidth")
        assert over <= 0, f"{width}×{height}: the page scrolls sideways by {over}"
        frame.evaluate(folds, True)
        laid = frame.evaluate(LAID)
        assert laid["column"] <= 0, f"{width}×{height}: the column scrolls sideways"
        assert [laid[what] for what in ("cut", "narrow", "stray", "small")] == [[], [], [], []], f"{width}×{height}"
        primary, scene, column_ = laid["primary"], laid["scene"], laid["beside"]
        assert primary["bottom"] <= height, f"{width}×{height}: the first action is out of sight"
        assert scene["width"] * scene["height"] > 0.25 * width * height, f"{width}×{height}: the scene is small"
        assert scene["right"] <= column_["x"] + 1 or scene["bottom"] <= column_["y"] + 1
    frame.evaluate(folds, False)
    learner.page.set_viewport_size({"width": 1280, "height": 800})
    tall = frame.locator(".s3-label:visible").evaluate_all(
        "all => all.filter((l) => l.clientHeight > 27).map((l) => l.innerText)"
    )
    assert tall == [], "labels that take two lines"


def test_the_smallest_frame_shows_its_scene(column: Open) -> None:
    for path in ("euler-angles/embed?controls=0", "triangulation/embed?controls=0", "euler-angles/embed"):
        learner = column(path)
        for width, height in ((640, 300), (400, 300), (320, 240), (160, 120)):
            learner.page.set_viewport_size({"width": width, "height": height})
            scene = box(learner.frame.locator(".s3-scene"))
            assert scene["width"] * scene["height"] > 0.25 * width * height, f"{path} at {width}×{height}"


def test_in_a_low_frame_two_pictures_follow_the_sentence_about_them(column: Open) -> None:
    for slug in ("epipolar", "triangulation"):
        learner = column(f"{slug}/embed", size=ViewportSize(width=560, height=315))
        caption, primary = (box(learner.frame.locator(each)) for each in (".s3-caption", ".s3-primary"))
        for side in ("left", "right"):
            picture = box(learner.frame.locator(f"svg[data-pane={side}]"))
            assert caption["y"] + caption["height"] <= picture["y"], f"{slug}: the {side} picture"
            assert picture["y"] + picture["height"] <= primary["y"], f"{slug}: the {side} picture is out of sight"
        ends = [box(learner.frame.locator(each))["y"] for each in (".s3-wide", ".s3-toolbar", ".s3-about")]
        assert ends == sorted(ends), f"{slug}: what comes after the controls"


def test_a_strip_stands_above_the_rest_and_is_read_to_its_end(column: Open) -> None:
    learner = column("camera/embed?challenge=shift", size=ViewportSize(width=700, height=600))
    tops = [box(learner.frame.locator(each))["y"] for each in (".s3-strip", ".s3-caption", ".s3-panes")]
    assert tops == sorted(tops)
    away = learner.frame.locator(".s3-strip .s3-away", has_text="px to go")
    assert away.evaluate("node => getComputedStyle(node).borderStyle") == "none", "it is no warning"
    learner = column("quaternion/embed?lesson=1", size=ViewportSize(width=560, height=315))
    cut = "all => all.filter((n) => n.scrollWidth > n.clientWidth + 1 || n.scrollHeight > n.clientHeight + 1).length"
    assert learner.frame.locator(".s3-strip :is(b, p)").evaluate_all(cut) == 0


def test_what_is_nearly_wrong_has_the_colour_of_warnings(column: Open) -> None:
    learner = column("gimbal-lock/embed?pitch=80")
    colours = "node => ((style) => [style.color, style.borderTopColor])(getComputedStyle(node))"
    ink, border = learner.frame.locator(".s3-note.s3-near").evaluate(colours)
    assert ink == border


# Of each factor in a chain's strip: how wide its numbers are, and how wide they may be.
FACTORS = """() => [...document.querySelectorAll(".s3-stage:has(math)")].map((stage) =>
    [stage.querySelector("math").getBoundingClientRect().width, stage.clientWidth])"""


def test_the_factors_of_a_chain_show_their_numbers_in_a_narrow_column(column: Open) -> None:
    all_negative = "angles=-150,-140,-130&lengths=1,1.8,0.5&axes=zzz&twists=-40,-50,-30"
    learner = column(f"transform-chain/embed?{all_negative}", size=ViewportSize(width=700, height=600))
    for size in (ViewportSize(width=700, height=600), ViewportSize(width=390, height=780)):
        learner.page.set_viewport_size(size)
        factors = learner.frame.evaluate(FACTORS)
        assert len(factors) == 3
        assert all(0 < wide <= room for wide, room in factors), factors


COVERED = """() => [...document.querySelectorAll(".s3-column :is(input, select, button, summary)")].filter((node) => {
    if (!node.checkVisibility() || node.matches(".s3-primary")) return false;
    node.focus();
    const [one, first] = [node, document.querySelector(".s3-primary")].map((each) => each.getBoundingClientRect());
    return one.bottom > first.top && one.top < first.bottom && one.right > first.left && one.left < first.right;
}).map((node) => node.outerHTML.slice(0, 90))"""


def test_the_button_that_stays_in_sight_covers_nothing_that_has_the_focus(column: Open) -> None:
    learner = column("triangulation/embed", size=ViewportSize(width=700, height=600))
    assert learner.frame.evaluate(COVERED) == []


def test_fingers_have_room(column: Open) -> None:
    learner = column("camera/embed", size=ViewportSize(width=390, height=780), has_touch=True, is_mobile=True)
    small = learner.frame.evaluate(TARGETS.replace("LEAST", "43.5"))
    assert [
        each for each in small if "enlarge" not in each and "data-link" not in each and "aria-pressed" not in each
    ] == []


def test_who_only_watches_has_what_they_see_and_nothing_to_set(column: Open) -> None:
    teacher = column("transform-chain/embed")
    watcher = column(teacher.watch_link)
    locked = ".s3-controls :is(input, select, [data-act], [data-nudge])"
    watcher.until(lambda: all(n.is_disabled() for n in watcher.frame.locator(locked).all()))
    teacher.press("Add link")
    watcher.until(lambda: watcher.frame.locator('[data-slide="angles.3"]').is_disabled())
