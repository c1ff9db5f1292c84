"""On a phone: everything is on the screen, by touch."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from playwright.sync_api import ViewportSize

from tests.e2e.conftest import Classroom
from tests.e2e.course import CourseSite
from tests.e2e.learner import Learner, box
from tests.e2e.picture import Picture

PHONE: ViewportSize = {"width": 390, "height": 780}
TOUCH = {"has_touch": True, "is_mobile": True, "device_scale_factor": 1}


def touch(learner: Learner, *path: tuple[float, ...]) -> None:
    """Put a finger down, draw it along a path, and lift it; two fingers where there are x, y of both."""
    cdp = learner.page.context.new_cdp_session(learner.page)
    for k, places in enumerate(path):
        points = [{"x": x, "y": y, "id": n} for n, (x, y) in enumerate(zip(places[::2], places[1::2], strict=True))]
        cdp.send("Input.dispatchTouchEvent", {"type": "touchMove" if k else "touchStart", "touchPoints": points})
        learner.page.wait_for_timeout(16)
    cdp.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    cdp.detach()


def fits(learner: Learner) -> None:
    width, scroll = learner.frame.evaluate("[innerWidth, document.documentElement.scrollWidth]")
    assert width == 390
    assert scroll <= width, "the page scrolls sideways"


def column_top(learner: Learner) -> float:
    """Where the column below the scene begins."""
    return box(learner.frame.locator(".s3-column"))["y"]


def test_euler_angles_on_a_phone(classroom: Classroom) -> None:
    learner = classroom.open("euler-angles/embed?yaw=60&pitch=-30", size=PHONE, **TOUCH)
    fits(learner)
    ends = learner.scene.points("/turn1/turn2/turn3/arrows")
    tips = ends[:, 0] + 0.94 * (ends[:, 1] - ends[:, 0])
    top = column_top(learner)

    def look() -> None:
        picture = Picture(learner)
        for axis, tip in zip("xyz", tips, strict=True):
            x, y = picture.place(tip)
            assert 0 < x < 390, f"the {axis} axis is off the screen"
            assert 0 < y < top, f"the {axis} axis isn't above the column"
        assert picture.shows("x", tips[0])
        assert picture.shows("z", tips[2])

    learner.until(look)

    slider = learner.control("slider", "roll")
    slider.scroll_into_view_if_needed()
    track = box(slider)
    x, y = track["x"] + track["width"] * (0.5 + 10 / 360), track["y"] + track["height"] / 2
    touch(learner, *((x + 4 * k, y) for k in range(13)))
    learner.until(lambda: learner.params["roll"] > 40)
    learner.until(  # the last of the drag may still be on its way
        lambda: np.testing.assert_allclose(
            learner.scene.world_pose("/turn1/turn2/turn3")[:3, :3],
            learner.solution(yaw=60, pitch=-30)["R"],
            atol=1e-6,
        )
    )
    learner.choose("frame", "extrinsic")
    learner.sees(frame="extrinsic")

    before = learner.sockets.camera["position"]
    touch(learner, (100, 100), (130, 110), (160, 120), (190, 130))
    learner.until(lambda: not np.allclose(learner.sockets.camera["position"], before, atol=0.05))
    fits(learner)


def test_triangulation_on_a_phone(classroom: Classroom) -> None:
    learner = classroom.open("triangulation/embed", size=PHONE, **TOUCH)
    fits(learner)
    handle = learner.frame.locator("[data-handle=left_uv] .s3-core")
    handle.scroll_into_view_if_needed()
    at = box(handle)
    scale = box(learner.frame.locator("svg[data-pane=left]"))["width"] / 640
    x, y = at["x"] + at["width"] / 2, at["y"] + at["height"] / 2
    assert learner.frame.evaluate("([x, y]) => !!document.elementFromPoint(x, y).closest('[data-handle]')", [x, y]), (
        "something covers the left point"
    )
    touch(learner, *((x + 4 * k / 3, y + k / 3) for k in range(13)))
    learner.until(lambda: learner.params["left_uv"][0] > 410 + 8 / scale)
    goal = [410 + 16 / scale, 210 + 4 / scale]
    learner.until(lambda: np.testing.assert_allclose(learner.params["left_uv"], goal, atol=2 / scale))
    learner.sees(right_uv=[320, 210])
    fits(learner)


@pytest.mark.parametrize(
    ("path", "node", "name", "chosen"),
    [
        ("camera", "/points/far-post", "selected", "far-post"),
        ("epipolar", "/points/5", "selected", 5),
        ("triangulation", "/closeup/midpoint", "method", "midpoint"),
        ("point-cloud", None, "selected", None),
    ],
)
def test_a_tap_in_the_scene_selects(classroom: Classroom, path: str, node: str | None, name: str, chosen: Any) -> None:
    query = {"triangulation": "right_uv=320,230&baseline=0.2", "point-cloud": "voxel_size=0.3&point_size=8&show_box=0"}
    learner = classroom.open(f"{path}/embed?{query.get(path, '')}", size=PHONE, **TOUCH)
    before = learner.params[name]
    camera = learner.sockets.camera["position"]
    if node is None:
        learner.until(lambda: learner.scene.points("/cloud/points").size > 0)
        points = learner.scene.points("/cloud/points")
        aim = points[np.argmin(np.linalg.norm(points - [0.6, -1.6, 0.0], axis=1))]
        x, y = learner.place(aim)
    else:
        x, y = learner.place_of(node)
    touch(learner, (x, y))
    learner.until(lambda: learner.params[name] != before)
    if node is None:
        np.testing.assert_allclose(learner.solved()["selected"]["position"], aim, atol=0.35)
    else:
        assert learner.params[name] == chosen
    np.testing.assert_allclose(learner.sockets.camera["position"], camera, atol=1e-6)


def test_two_fingers_come_nearer_and_one_turns(classroom: Classroom) -> None:
    learner = classroom.open("euler-angles/embed", size=PHONE, **TOUCH)

    def away() -> float:
        camera = learner.sockets.camera
        return float(np.linalg.norm(np.subtract(camera["position"], camera["look_at"])))

    far, before = away(), learner.sockets.camera["position"]
    touch(learner, (60, 60), *((60 + 8 * k, 60) for k in range(1, 13)))
    learner.until(lambda: not np.allclose(learner.sockets.camera["position"], before, atol=0.05))
    assert away() == pytest.approx(far, rel=0.01)
    focus = learner.frame.evaluate("['canvas', 'canvas:focus-visible'].map((s) => document.activeElement.matches(s))")
    assert focus == [True, False], "a finger that turns the scene draws no frame round it"
    touch(learner, *((180 - 8 * k, 100, 210 + 8 * k, 100) for k in range(13)))
    learner.until(lambda: away() < 0.95 * far)


def test_a_finger_scrolls_the_course_page_past_a_frame_until_the_scene_is_tapped(classroom: Classroom) -> None:
    learner = classroom.enter(size=ViewportSize(width=760, height=700), has_touch=True)
    with CourseSite() as course:
        course.show(learner, "euler-angles/embed", after="<p>After</p>" * 60)
        learner.enter_frame()
        learner.frame.locator(".s3-still").wait_for(state="detached")
        camera = learner.sockets.camera["position"]
        at = box(learner.page.locator("iframe"))
        x, y = at["x"] + 80, at["y"] + 200
        touch(learner, *((x, y - 12 * k) for k in range(13)))
        learner.until(lambda: learner.page.evaluate("scrollY") > 60)
        np.testing.assert_allclose(learner.sockets.camera["position"], camera, atol=1e-9)
        learner.frame.get_by_text("Tap the scene to turn it").wait_for()
        assert learner.params["pitch"] == 20, "what the finger passes isn't held"

        learner.page.wait_for_timeout(500)  # it glides on
        x = at["x"] + 16  # beside the aircraft
        scrolled = learner.page.evaluate("scrollY")
        touch(learner, (x, 200))
        learner.until(lambda: learner.frame.locator(".s3-scene[data-shared]").count() == 0)
        touch(learner, *((x, 200 + 8 * k) for k in range(13)))
        learner.until(lambda: not np.allclose(learner.sockets.camera["position"], camera, atol=0.05))
        assert learner.page.evaluate("scrollY") == scrolled
