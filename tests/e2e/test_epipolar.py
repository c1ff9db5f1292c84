"""epipolar: hands on cameras and points, in the scene, in the pictures and on the plan; picking a pixel; presets."""

from __future__ import annotations

import json
import re
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from sims.epipolar.params import OTHERS
from sims.kit.readout import significant
from tests.e2e.conftest import Classroom
from tests.e2e.learner import Learner, box, touch
from tests.e2e.picture import Picture

Array = npt.NDArray[np.float64]
RECTIFIED = "left=-0.6,0,1"
"""A link of the state that has all defaults: one without parameters opens another."""


def agree(learner: Learner, **expected: Any) -> dict[str, Any]:
    """State, address, solution, read-outs, pictures and scene come to say the same; the solution."""

    def said() -> dict[str, Any]:
        solution = learner.solution(**expected)
        scene, params = learner.scene, learner.params
        np.testing.assert_allclose(scene.world_pose("/point")[:3, 3], params["point"], rtol=0, atol=1e-6)
        for side in ("left", "right"):
            np.testing.assert_allclose(scene.world_pose(f"/{side}")[:3, 3], params[side], rtol=0, atol=1e-6)
        assert (
            solution["F"] is None
            or ["F", *re.findall("<mn>(.*?)</mn>", significant(solution["F"]))] in learner.formulas()
        )
        assert solution["line_right"] is None or learner.reads("l′", solution["line_right"])
        assert handle(learner, "left_pixel") == solution["pixel_left"]
        return solution

    return learner.until(said)


def handle(learner: Learner, name: str) -> list[float] | None:
    """Where a handle of a picture says that it is."""
    place: list[float] | None = learner.frame.evaluate(
        "(name) => { const d = document.querySelector(`[data-handle=${name}]`)?.dataset; return d ? [Number(d.x), Number(d.y)] : null; }",
        name,
    )
    return place


def middle(learner: Learner, name: str) -> tuple[float, float]:
    at = box(learner.frame.locator(f"[data-handle={name}] .s3-ring"))
    return at["x"] + at["width"] / 2, at["y"] + at["height"] / 2


def test_a_click_in_a_picture_and_arrow_keys_pick_a_pixel_whose_line_appears_in_the_other(classroom: Classroom) -> None:
    learner = classroom.open_column("epipolar/embed?left_pan=-18&right_pan=18&left=-1.2,0.4,1&right=1.2,0.4,1")
    agree(learner)
    frame = box(learner.frame.locator('svg[data-pane="right"]'))
    learner.page.mouse.click(frame["x"] + frame["width"] * 0.25, frame["y"] + frame["height"] * 0.75)
    learner.until(lambda: learner.params["pick"] is not None)
    solution = agree(learner)
    picked = solution["picked"]
    assert picked["side"] == "right"
    np.testing.assert_allclose(picked["pixel"], [160, 360], atol=8)
    learner.until(lambda: handle(learner, "pick_right") == picked["pixel"])
    drawn = learner.frame.locator('svg[data-pane="left"] line[stroke="var(--held)"]')
    ends = [float(drawn.get_attribute(k) or "nan") for k in ("x1", "y1", "x2", "y2")]
    for u, v in (ends[:2], ends[2:]):
        assert abs(np.dot(picked["line"], [u, v, 1])) < 0.05
    assert learner.scene.visible("/left/picked_line")

    u, v = picked["pixel"]
    focus = learner.frame.locator("[data-handle=pick_right]:focus")
    focus.wait_for()
    learner.page.keyboard.press("ArrowRight")
    learner.until(lambda: handle(learner, "pick_right") == pytest.approx([u + 1, v]))
    focus.wait_for()
    agree(learner)

    learner.frame.locator("[data-pick=pick_left]").press("Enter")
    agree(learner, pick="left:319.5,239.5")
    learner.frame.locator("[data-handle=pick_left]:focus").wait_for()
    learner.until(lambda: handle(learner, "pick_right") is None)
    learner.press("Clear marks")
    agree(learner, pick=None)


def test_the_insight_is_performed_by_keyboard_and_f_is_copied(classroom: Classroom) -> None:
    learner = classroom.open_column("epipolar/embed", permissions=["clipboard-read", "clipboard-write"])
    before = agree(learner, trail=None)
    learner.press_keys("depth", "PageUp")
    learner.until(lambda: learner.params["trail"] is not None)
    after = agree(learner)
    assert after["pixel_left"] == pytest.approx(before["pixel_left"])
    assert after["pixel_right"] != pytest.approx(before["pixel_right"], abs=3)

    learner.press("Free p′")
    held = learner.frame.locator("[data-handle=candidate]")
    held.wait_for()
    learner.until(lambda: abs(learner.sees()["candidate"]["distance"]) == pytest.approx(60))
    held.press("Shift+ArrowDown")
    learner.says("No point in space gives this pair")
    learner.until(lambda: abs(learner.sees()["candidate"]["distance"]) != pytest.approx(60))

    learner.find("button", "Copy: Fundamental matrix, of norm 1").click()
    copied = learner.until(lambda: json.loads(learner.page.evaluate("navigator.clipboard.readText()")))
    assert copied == learner.sees()["F"]


def test_both_pictures_are_made_large_together(classroom: Classroom) -> None:
    learner = classroom.open_column("epipolar/embed")
    agree(learner)
    pictures = [learner.frame.locator(f'svg[data-pane="{side}"]') for side in ("left", "right")]
    small = [box(picture)["width"] for picture in pictures]
    learner.find("button", "Right picture: larger").click()
    assert all(box(picture)["width"] > 1.3 * width for picture, width in zip(pictures, small, strict=True))
    learner.find("button", "Left picture: larger").click()
    assert [box(picture)["width"] for picture in pictures] == small


def test_the_point_is_held_in_a_picture_and_a_camera_on_the_plan(classroom: Classroom) -> None:
    learner = classroom.open_column(f"epipolar/embed?{RECTIFIED}")
    before = agree(learner, point=[0.3, 4, 1.2])
    learner.pull(middle(learner, "left_pixel"), -12, 8)
    learner.until(lambda: learner.params["point"] != [0.3, 4, 1.2])
    after = agree(learner)
    assert after["pixel_left"][0] < before["pixel_left"][0] - 10
    assert after["pixel_left"][1] > before["pixel_left"][1] + 10, "rows count downwards"
    assert learner.params["point"][1] == pytest.approx(4.0), "its depth stays"
    assert after["residual"] == pytest.approx(0.0, abs=1e-9)

    held = learner.frame.locator("[data-handle=plan_left]")
    held.scroll_into_view_if_needed()
    held.press("ArrowUp")
    learner.until(lambda: learner.params["left"] != [-0.6, 0, 1])
    agree(learner)
    x, y, z = learner.params["left"]
    assert (x, z) == (pytest.approx(-0.6), 1)
    assert 0.01 < y < 0.05, "up on the plan is forward"


def test_a_camera_is_pulled_and_a_point_selected_in_the_scene(classroom: Classroom) -> None:
    learner = classroom.open(f"epipolar/embed?{RECTIFIED}")
    agree(learner, selected=1)
    place = learner.scene.world_pose("/right_center")[:3, 3]
    learner.until(lambda: Picture(learner).shows("held", place, within=8))
    learner.click_on("/points/5")
    agree(learner, selected=5, pick=None)
    learner.until(lambda: learner.pressed("5"))
    touch(learner, learner.place_of("/points/4"))
    agree(learner, selected=4)
    learner.pull(learner.place(place), 30, -6)
    learner.until(lambda: learner.params["right"] != [0.6, 0, 1])
    agree(learner)


def test_presets_and_controls_answer(classroom: Classroom) -> None:
    learner = classroom.open_column("epipolar/embed?theme=light", reduced_motion="reduce")
    learner.press("Forward motion")
    solution = agree(learner, left=[0, -0.6, 1], right=[0, 0.9, 1])
    assert solution["epipole_left_pixel"] == pytest.approx([320, 240])
    assert learner.scene.visible("/left/epipole")
    assert learner.reads("e", solution["epipole_left_pixel"], 1)
    learner.press("Vertical pair")
    assert agree(learner, left=[0, 0, 0.65], right=[0, 0, 1.45])["epipole_left_pixel"] is None
    learner.press_keys("left_pan", "ArrowRight")
    agree(learner, left_pan=0.5)
    learner.control("checkbox", "show_all_lines").click()
    agree(learner, show_all_lines=True)
    learner.until(lambda: learner.scene.visible("/left/all_lines"))
    learner.control("checkbox", "show_plane").click()
    agree(learner, show_plane=False)
    learner.until(lambda: not learner.scene.visible("/plane"))
    learner.says("To estimate F takes 8 points")
    learner.press("Estimate F, new noise")
    noisy = agree(learner, points=12, noise=1, seed=0)
    learner.press("Estimate F, new noise")
    assert agree(learner, seed=1)["estimate"]["F"] != noisy["estimate"]["F"]
    learner.press("Reset")
    agree(learner, left=[-0.4, 0.9, 0.9], points=6, noise=0)


def test_without_a_baseline_it_is_said_and_nothing_else_breaks(classroom: Classroom) -> None:
    learner = classroom.open_column("epipolar/embed?left=0,0,1&right=0.01,0,1")
    learner.type("right", "0", box=1)
    solution = agree(learner, right=[0, 0, 1])
    assert solution["F"] is None
    assert solution["pixel_left"] is not None
    assert any("no baseline" in text for text in learner.scene.labels().values())
    learner.says("without a baseline there is no epipolar plane")
    learner.until(lambda: "no F" in learner.spoken())
    learner.type("right", "0.5", box=1)
    assert agree(learner, right=[0.5, 0, 1])["rank"] == 2


def test_a_point_lights_up_and_is_selected_in_pictures_plan_and_table(classroom: Classroom) -> None:
    learner = classroom.open_column(f"epipolar/embed?{RECTIFIED}")
    frame = learner.frame
    agree(learner, selected=1)
    everywhere = "g g g tr"
    frame.locator('svg[data-pane="left"] [data-link="3"] .s3-spot').hover()
    learner.until(lambda: learner.lights("3", everywhere))
    learner.until(lambda: learner.scene.visible("/lit"))
    np.testing.assert_allclose(learner.scene.world_pose("/lit/ball")[:3, 3], OTHERS[1])

    row = learner.find("button", "4")
    row.scroll_into_view_if_needed()
    row.hover()
    learner.until(lambda: learner.lights("4", everywhere))
    learner.until(lambda: np.testing.assert_allclose(learner.scene.world_pose("/lit/ball")[:3, 3], OTHERS[2]))
    row.press("Enter")
    agree(learner, selected=4, pick=None)
    learner.until(lambda: learner.pressed("4"))
    learner.until(lambda: learner.lights("4", everywhere))  # also in what was drawn anew
    learner.until(lambda: frame.locator("svg .s3-selected").count() == 3)
    np.testing.assert_allclose(learner.scene.world_pose("/selected/ball")[:3, 3], OTHERS[2])

    frame.locator("[data-handle=right_pixel] .s3-core").hover()
    learner.until(lambda: learner.lights("1", "g g g tr line line"))
    learner.page.mouse.down()
    learner.page.mouse.up()
    agree(learner, selected=1, point=[0.3, 4, 1.2])


def test_a_click_on_a_point_in_a_picture_picks_its_very_pixel_and_selects_it(classroom: Classroom) -> None:
    learner = classroom.open_column("epipolar/embed?left_pan=-18&right_pan=18&left=-1.2,0.4,1&right=1.2,0.4,1")
    before = agree(learner, pick=None)
    spot = box(learner.frame.locator('svg[data-pane="left"] [data-link="2"] .s3-reach'))
    learner.page.mouse.click(spot["x"] + 0.7 * spot["width"], spot["y"] + 0.6 * spot["height"])
    learner.until(lambda: learner.params["pick"] is not None)
    solution = agree(learner, selected=2)
    assert solution["picked"]["side"] == "left"
    np.testing.assert_allclose(solution["picked"]["pixel"], before["pixels_left"][1], rtol=0, atol=0.011)
    assert abs(np.dot(solution["picked"]["line"], [*before["pixels_right"][1], 1])) < 0.03, "its line goes through it"
    learner.until(lambda: learner.pressed("2"))
