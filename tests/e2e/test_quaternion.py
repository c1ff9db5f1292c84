"""quaternion: hands on the axis in the scene and on the panel, composition and its undoing, down to the pixel."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from scipy.spatial.transform import Rotation

from sims.quaternion.dial import RADIUS
from sims.quaternion.params import BALL, MATRIX, ORDER, PATH
from tests.e2e.conftest import Classroom
from tests.e2e.learner import Learner, box
from tests.e2e.picture import Picture

Array = npt.NDArray[np.float64]


def turn(params: dict[str, Any]) -> Rotation:
    """The turn by SciPy."""
    axis = np.array(params["axis"])
    return Rotation.from_rotvec(params["angle"] * axis / np.linalg.norm(axis), degrees=True)


def agree(learner: Learner, **expected: Any) -> dict[str, Any]:
    """State, address, solution, read-outs and scene come to say the same; the solution."""

    def said() -> dict[str, Any]:
        solution = learner.solution(**expected)
        start = Rotation.from_quat(learner.params["start"], scalar_first=True)
        total = (turn(learner.params) * start).as_matrix()
        np.testing.assert_allclose(solution["R_total"], total, rtol=0, atol=1e-9)
        object_now = learner.scene.world_pose("/object")[:3, :3]
        np.testing.assert_allclose(object_now, solution["interpolated"]["R"], rtol=0, atol=1e-6)
        if learner.scene.visible("/image"):
            image = learner.scene.world_pose("/image")[:3, 3]
            np.testing.assert_allclose(image, solution["rotated_point"], rtol=0, atol=1e-6)
        assert learner.reads("q" if solution["orders"] is None else "A", solution["q"])
        assert learner.reads("R", solution["R_total"])
        return solution

    return learner.until(said)


def orientation(learner: Learner) -> Array:
    R: Array = learner.scene.world_pose("/object")[:3, :3]
    return R


def test_the_axis_is_dragged_in_the_scene_and_the_object_turns_with_it(classroom: Classroom) -> None:
    learner = classroom.open("quaternion/embed")
    agree(learner, axis=[0, 0, 1], angle=90)
    wrong = learner.frame.locator('[data-control="axis"] .s3-wrong')
    learner.type("axis", "0", box=3)
    wrong.wait_for()
    at = learner.scene.world_pose("/tip")[:3, 3]
    learner.until(lambda: Picture(learner).shows("held", at, within=8))
    camera = dict(learner.sockets.camera)

    x, y = learner.place_of("/tip")
    mouse = learner.page.mouse
    mouse.move(x - 3, y - 3)
    mouse.move(x, y)
    mouse.down()
    mouse.move(x + 60, y + 20, steps=6)
    control = learner.frame.locator('[data-control="axis"].s3-highlighted')
    control.wait_for()  # what the hand moves in the scene
    mouse.up()
    control.wait_for(state="detached")
    learner.until(lambda: learner.params["axis"] != [0, 0, 1])
    agree(learner, angle=90)
    wrong.wait_for(state="hidden")  # the hand in the scene went on with a good axis
    np.testing.assert_allclose(np.linalg.norm(learner.params["axis"]), 1.0, atol=2e-3)
    about = Rotation.from_matrix(orientation(learner)).as_rotvec()
    drawn = np.array(learner.scene.world_pose("/tip")[:3, 3])
    np.testing.assert_allclose(about / np.linalg.norm(about), drawn / np.linalg.norm(drawn), atol=1e-6)
    assert learner.place_of("/tip")[0] > x + 20, "the tip followed the pointer"
    np.testing.assert_allclose(learner.sockets.camera["position"], camera["position"], atol=1e-9)


def test_turns_are_composed_and_undone(classroom: Classroom) -> None:
    learner = classroom.open_column("quaternion/embed?axis=1,0,0")
    learner.press_keys("angle", "ArrowRight", "ArrowLeft", "ArrowRight")
    agree(learner, angle=91)
    learner.type("angle", "90")
    agree(learner, angle=90)
    before = orientation(learner)

    learner.press("Make this turn")
    agree(learner, angle=0, t=1, history=[1, 0, 0, 90])
    np.testing.assert_allclose(orientation(learner), before, atol=1e-9)

    learner.choose("axis:preset", "y")
    agree(learner, axis=[0, 1, 0], angle=0)
    learner.type("angle", "120")
    solution = agree(learner, angle=120)
    expected = Rotation.from_euler("xy", [90, 120], degrees=True).as_matrix()
    np.testing.assert_allclose(solution["R_total"], expected, atol=1e-9)

    learner.press("Make this turn")
    agree(learner, axis=[0, 1, 0], angle=0, history=[1, 0, 0, 90, 0, 1, 0, 120])
    learner.press("Make this turn")  # by nothing
    learner.reload()
    agree(learner, axis=[0, 1, 0], angle=0, history=[1, 0, 0, 90, 0, 1, 0, 120])

    learner.press("Undo last turn")
    agree(learner, axis=[0, 1, 0], angle=120, history=[1, 0, 0, 90])
    learner.press("Undo last turn")
    agree(learner, axis=[1, 0, 0], angle=90, history=[], start=[1, 0, 0, 0])
    np.testing.assert_allclose(orientation(learner), before, atol=1e-9)


def test_a_zero_axis_is_refused_and_the_picture_stays(classroom: Classroom) -> None:
    learner = classroom.open_column("quaternion/embed?axis=0,0,2&angle=60")
    solution = agree(learner, axis=[0, 0, 2])
    learner.says("has length 2.00")
    learner.type("axis", "0", box=3)
    learner.says("The axis must not be zero: zero has no direction.")
    assert agree(learner, axis=[0, 0, 2]) == solution
    third = learner.control("textbox", "axis.2")
    assert (third.input_value(), third.get_attribute("aria-invalid")) == ("0", "true")

    learner.type("angle", "60.5")
    agree(learner, axis=[0, 0, 2], angle=60.5)
    learner.until(lambda: (third.input_value(), third.get_attribute("aria-invalid")) == ("2", None))
    learner.type("angle", "130")

    learner.choose("interpolation", "nlerp")
    learner.control("checkbox", "long_way").click()
    learner.type("t", "0.5")
    solution = agree(learner, interpolation="nlerp", long_way=True, t=0.5)
    assert solution["way_angle"] == pytest.approx(230)
    learner.control("checkbox", "show_euler").click()
    agree(learner, show_euler=True)
    learner.until(lambda: "yaw 130°, pitch 0°, roll 0°" in learner.scene.labels().values())
    learner.press("Play")
    agree(learner, t=1)


def pull(learner: Learner, handle: str, *way: tuple[float, float]) -> None:
    """Take a handle of the picture and lead it by so many pixels, from where it is, one place after the other."""
    held = box(learner.frame.locator(f'[data-handle="{handle}"] .s3-core'))
    x, y = held["x"] + held["width"] / 2, held["y"] + held["height"] / 2
    learner.page.mouse.move(x, y)
    learner.page.mouse.down()
    for dx, dy in way:
        learner.page.mouse.move(x + dx, y + dy, steps=4)
    learner.page.mouse.up()


def test_the_dial_is_led_past_a_whole_turn_and_q_is_held_in_the_ball(classroom: Classroom) -> None:
    learner = classroom.open_column("quaternion/embed?angle=0")
    radius = RADIUS * learner.frame.locator('svg[data-pane="dial"]').evaluate("svg => svg.getScreenCTM().a")
    round_ = [(radius * (math.cos(a) - 1), -radius * math.sin(a)) for a in np.linspace(0, 2.25 * math.pi, 19)[1:]]
    pull(learner, "theta", *round_)
    learner.until(lambda: 400 < learner.params["angle"] < 410)
    angle = learner.params["angle"]
    agree(learner, angle=angle)
    learner.says("a whole turn and 45°")
    learner.frame.locator('[data-handle="half"]').press("ArrowRight")
    learner.until(lambda: learner.params["angle"] != angle)

    learner.type("angle", "100")
    learner.frame.get_by_text(BALL).click()
    agree(learner, show="ball", angle=100)
    before = learner.solved()
    pull(learner, "q", (40, 0))
    learner.until(lambda: learner.params["axis"] != [0, 0, 1])
    after = agree(learner, show="ball")
    moved = np.array(after["ball_q"]) - before["ball_q"]
    assert moved @ [0.74, 0.67, 0.0] > 0.8 * np.linalg.norm(moved) > 0.1, "to the right, as the scene is seen at first"


def test_a_fold_brings_what_belongs_to_it_and_takes_it_away(classroom: Classroom) -> None:
    learner = classroom.open_column("quaternion/embed")

    def opened() -> list[str]:
        return learner.frame.locator("details[open] > summary").all_inner_texts()

    learner.frame.get_by_text(ORDER).click()
    agree(learner, show="order", angle=90)
    learner.until(lambda: learner.scene.visible("/orders/left") and not learner.scene.visible("/object"))
    learner.frame.get_by_text(PATH).click()
    agree(learner, show="path", angle=170, t=0.25)
    learner.until(lambda: opened() == [PATH] and learner.scene.visible("/ways/nlerp"))
    learner.reload()
    learner.until(lambda: opened() == [PATH])
    learner.frame.get_by_text(PATH).click()
    agree(learner, show="turn", angle=170, t=1)
    learner.until(lambda: not opened() and learner.scene.visible("/object"))
    learner.frame.get_by_text(MATRIX).click()
    learner.press_keys("angle", "ArrowRight")
    agree(learner, show="turn", angle=171)
    assert opened() == [MATRIX], "other folds are one's own"
