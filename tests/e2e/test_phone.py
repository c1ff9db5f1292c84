"""On a phone: everything is on the screen, by touch."""

from __future__ import annotations

import numpy as np
import pytest
from playwright.sync_api import ViewportSize

from tests.e2e.conftest import Classroom
from tests.e2e.learner import Learner, box, touch
from tests.e2e.picture import Picture

PHONE: ViewportSize = {"width": 390, "height": 780}
TOUCH = {"has_touch": True, "is_mobile": True, "device_scale_factor": 1}


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

    def away() -> float:
        camera = learner.sockets.camera
        return float(np.linalg.norm(np.subtract(camera["position"], camera["look_at"])))

    far, before = away(), learner.sockets.camera["position"]
    touch(learner, *((60 + 24 * k, 60) for k in range(5)))
    learner.until(lambda: not np.allclose(learner.sockets.camera["position"], before, atol=0.05))
    assert away() == pytest.approx(far, rel=0.01), "one finger turns"
    focus = learner.frame.evaluate("['canvas', 'canvas:focus-visible'].map((s) => document.activeElement.matches(s))")
    assert focus == [True, False], "a finger that turns the scene draws no frame round it"
    touch(learner, *((180 - 24 * k, 100, 210 + 24 * k, 100) for k in range(5)))
    learner.until(lambda: away() < 0.95 * far)
    fits(learner)


def test_triangulation_on_a_phone(classroom: Classroom) -> None:
    learner = classroom.open("triangulation/embed?right_uv=320,230&baseline=0.2", size=PHONE, **TOUCH)
    fits(learner)
    camera = learner.sockets.camera["position"]
    touch(learner, learner.place_of("/closeup/midpoint"))
    learner.sees(method="midpoint")
    np.testing.assert_allclose(learner.sockets.camera["position"], camera, atol=1e-6)

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
    learner.sees(right_uv=[320, 230])
    fits(learner)
