"""Frames as course pages have them: hidden at first, small, resized, behind a proxy that lets no websocket through."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import ViewportSize

from tests.e2e.conftest import Classroom
from tests.e2e.course import CourseSite, heard, say
from tests.e2e.learner import Learner, box, touch

RESIZE = "([width, height]) => Object.assign(document.querySelector('iframe'), { width, height })"


@pytest.fixture
def course() -> Iterator[CourseSite]:
    with CourseSite() as site:
        yield site


def looks_as_it_should(learner: Learner) -> bool:
    """Whether viser's own camera is where the page works out that it should be."""
    camera = learner.sockets.camera
    view = np.array(
        learner.frame.evaluate("import(sim3.main.replace('main.js', 'view.js')).then((view) => view.fit())")
    )
    assert np.isfinite(view).all()
    return bool(np.allclose([*camera["position"], *camera["look_at"]], view, atol=0.02))


def resize(learner: Learner, width: int, height: int) -> None:
    learner.page.evaluate(RESIZE, [width, height])


def test_a_frame_that_is_shown_later_looks_at_its_scene_at_any_size(classroom: Classroom, course: CourseSite) -> None:
    learner = classroom.enter()
    course.show(learner, "camera/embed", before="<details><summary>More</summary>")
    learner.page.wait_for_timeout(1500)
    assert not heard(learner, "sim3:ready"), "nothing begins while there is no size"
    resize(learner, 560, 315)
    learner.page.get_by_text("More").click()
    learner.enter_frame()
    learner.until(lambda: looks_as_it_should(learner))
    assert learner.control("combobox", "projection").is_visible()
    at = learner.control("combobox", "projection").bounding_box()
    frame = learner.page.locator("iframe").bounding_box()
    assert at is not None
    assert frame is not None
    assert at["y"] + at["height"] <= frame["y"] + frame["height"], "the first control is in sight"

    for size in ((700, 600), (390, 600)):
        resize(learner, *size)
        learner.until(lambda: looks_as_it_should(learner))

    canvas = learner.frame.locator("canvas[data-engine]").bounding_box()
    assert canvas is not None
    learner.pull((canvas["x"] + 30, canvas["y"] + 30), 60, 10)
    learner.until(lambda: not looks_as_it_should(learner))
    distance = away(learner)
    resize(learner, 700, 600)
    learner.page.wait_for_timeout(1000)
    assert not looks_as_it_should(learner), "a view that somebody chose stays"
    assert away(learner) == pytest.approx(distance, rel=1e-3)


def away(learner: Learner) -> float:
    """Metres from the viewpoint to what is looked at: turning the view keeps them."""
    camera = learner.sockets.camera
    return float(np.linalg.norm(np.subtract(camera["position"], camera["look_at"])))


def test_a_course_page_sets_the_page_of_a_sim_and_hears_what_it_needs(classroom: Classroom, course: CourseSite) -> None:
    learner = classroom.enter()
    course.show(learner, "euler-angles/embed?yaw=45")
    learner.enter_frame()

    def answer(kind: str, message: Any) -> Any:
        count = len(heard(learner, kind))
        say(learner, message)
        return learner.until(lambda: heard(learner, kind)[count:][-1])

    told = answer("sim3:state", {"type": "sim3:get", "solution": True})
    assert told["solution"] == learner.solved()
    assert "solution" not in answer("sim3:state", {"type": "sim3:get"})
    (error,) = answer("sim3:error", {"type": "sim3:set", "params": {"yaw": 999}})["errors"]
    assert (error["parameter"], error["received"]) == ("yaw", "999")
    assert "-180 to 180" in error["allowed"]
    for name, wrong in (("theme", "blue"), ("controls", "no"), ("view", [1, 2, 3])):
        (error,) = answer("sim3:error", {"type": "sim3:set", name: wrong})["errors"]
        assert error["parameter"] == name

    view = [4.0, 1.0, 2.0, 0.0, 0.5, 0.0]
    say(learner, {"type": "sim3:set", "view": view, "params": {"yaw": 60}})
    learner.sees(yaw=60)
    learner.until(lambda: near(learner, view))
    learner.until(lambda: "view=4,1,2,0,0.5,0" in learner.address)

    height = learner.until(lambda: heard(learner, "sim3:height")[-1]["height"])
    assert 480 <= height <= 900
    posted = learner.page.evaluate("heard")
    assert {"subject": "lti.capabilities"}.items() <= next(m for m in posted if m.get("subject")).items()
    assert any(m.get("context") == "h5p" and m["action"] == "hello" for m in posted)
    say(learner, {"subject": "lti.capabilities.response", "supported_messages": [{"subject": "lti.frameResize"}]})
    say(learner, {"context": "h5p", "action": "hello"})
    learner.until(lambda: said(learner, subject="lti.frameResize", height=height))
    learner.until(lambda: said(learner, context="h5p", action="resize", scrollHeight=height))

    say(learner, {"type": "sim3:set", "theme": "dark", "controls": False, "params": {"roll": -20}})
    learner.until(lambda: len(heard(learner, "sim3:ready")) == 2)
    learner.enter_frame()
    learner.sees(yaw=60, roll=-20)
    assert learner.frame.evaluate("document.documentElement.dataset.theme") == "dark"
    assert not learner.frame.get_by_role("slider").count()
    learner.until(lambda: near(learner, view))


def near(learner: Learner, view: list[float]) -> bool:
    camera = learner.sockets.camera
    return bool(np.allclose([*camera["position"], *camera["look_at"]], view, atol=1e-3))


def said(learner: Learner, **words: Any) -> bool:
    """Whether the course page was told something of that kind."""
    return any(words.items() <= message.items() for message in learner.page.evaluate("heard"))


def test_a_finger_or_wheel_scrolls_the_course_page_past_a_frame_until_the_scene_is_meant(
    classroom: Classroom, course: CourseSite
) -> None:
    learner = classroom.enter(size=ViewportSize(width=760, height=700), has_touch=True)
    course.show(learner, "euler-angles/embed", after="<p>After</p>" * 60)
    learner.enter_frame()
    learner.frame.locator(".s3-still").wait_for(state="detached")
    camera = learner.sockets.camera["position"]
    at = box(learner.page.locator("iframe"))
    x, y = at["x"] + 80, at["y"] + 200
    touch(learner, *((x, y - 18 * k) for k in range(9)))
    learner.until(lambda: learner.page.evaluate("scrollY") > 60)
    np.testing.assert_allclose(learner.sockets.camera["position"], camera, atol=1e-9)
    learner.frame.get_by_text("Tap the scene to turn it").wait_for()
    assert learner.params["pitch"] == 20, "what the finger passes isn't held"

    scrolled = learner.until(lambda: come_to_rest(lambda: learner.page.evaluate("scrollY"), learner))
    beside = at["x"] + 16  # the aircraft
    touch(learner, (beside, 200))
    shared = learner.frame.locator(".s3-scene[data-shared]")
    shared.wait_for(state="detached")
    touch(learner, *((beside, 200 + 24 * k) for k in range(5)))
    learner.until(lambda: not np.allclose(learner.sockets.camera["position"], camera, atol=0.05))
    assert learner.page.evaluate("scrollY") == scrolled

    mouse = learner.page.mouse
    mouse.move(x, 300)
    mouse.move(750, 300)
    shared.wait_for()
    distance = learner.until(lambda: come_to_rest(lambda: away(learner), learner))
    mouse.move(x, 300)
    mouse.wheel(0, 60)
    learner.until(lambda: learner.page.evaluate("scrollY") == scrolled + 60)
    learner.frame.get_by_text("Click the scene, or hold Ctrl").wait_for()
    assert away(learner) == pytest.approx(distance)
    learner.page.keyboard.down("Control")
    mouse.wheel(0, -200)
    learner.page.keyboard.up("Control")
    learner.until(lambda: away(learner) < 0.99 * distance)
    nearer = away(learner)
    mouse.click(x, 300)
    mouse.wheel(0, 200)
    learner.until(lambda: away(learner) > 1.01 * nearer)
    assert learner.page.evaluate("scrollY") == scrolled + 60


def come_to_rest(what: Callable[[], float], learner: Learner) -> float:
    """A number, once it glides no more."""
    before = what()
    learner.page.wait_for_timeout(300)
    assert what() == before
    return before


def test_a_page_without_its_websocket_says_what_to_tell(classroom: Classroom) -> None:
    learner = classroom.enter_alone()
    learner.painted = False
    learner.witness.expect("WebSocket")
    for reason in ("This server saw Host “backend:8000”, but the page comes from elsewhere.", ""):
        learner.page.route_web_socket(
            re.compile("/s/"),
            lambda socket: socket.close(code=4403 if reason else 1011, reason=reason),  # noqa: B023
        )
        learner.page.goto(f"{learner.url}/sims/quaternion/embed")
        trouble = learner.page.get_by_role("alert").filter(has_text="can’t reach its server")
        trouble.wait_for()
        assert (reason or "Upgrade and Connection") in (trouble.text_content() or "")


BLIND = """(() => {
    const ask = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...options) {
        return kind.startsWith("webgl") ? null : ask.call(this, kind, ...options);
    };
    delete window.WebGL2RenderingContext;
})()"""


def test_without_webgl_all_but_the_scene_works(classroom: Classroom) -> None:
    learner = classroom.enter_alone()
    learner.witness.expect("WebGL", "THREE.")
    learner.witness.failures = ("Error creating WebGL context",)
    learner.page.add_init_script(BLIND)
    trouble = learner.page.get_by_role("alert").filter(has_text="can’t draw 3D")
    for theme in ("light", "dark"):
        learner.page.goto(f"{learner.url}/sims/quaternion/embed?theme={theme}")
        trouble.wait_for()
        learner.page.wait_for_function("window.sim3.live === true")
        learner.type("angle", "120")
        learner.until(lambda: learner.params["angle"] == 120)
        learner.sockets.forget()
    trouble.get_by_role("link").click()
    learner.page.get_by_role("heading", name="Quaternions, without the scene").wait_for()
