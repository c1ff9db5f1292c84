"""quaternion: hands on the axis in the scene and on the panel, composition and its undoing, down to the pixel."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from tests.e2e.conftest import Classroom
from tests.e2e.learner import Learner
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
        image = learner.scene.world_pose("/image")[:3, 3]
        np.testing.assert_allclose(image, solution["rotated_point"], rtol=0, atol=1e-6)
        assert learner.reads("q", solution["q"])
        assert learner.reads("R", solution["R_total"])
        return solution

    return learner.until(said)


def orientation(learner: Learner) -> Array:
    R: Array = learner.scene.world_pose("/object")[:3, :3]
    return R


def test_the_axis_is_dragged_in_the_scene_and_the_object_turns_with_it(classroom: Classroom) -> None:
    learner = classroom.open("quaternion/embed")
    agree(learner, axis=[0, 0, 1], angle=90)
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

    learner.press("Apply rotation")
    agree(learner, angle=0, t=1, history=[1, 0, 0, 90])
    np.testing.assert_allclose(orientation(learner), before, atol=1e-9)

    learner.choose("axis:preset", "y")
    agree(learner, axis=[0, 1, 0], angle=0)
    learner.type("angle", "120")
    solution = agree(learner, angle=120)
    expected = Rotation.from_euler("xy", [90, 120], degrees=True).as_matrix()
    np.testing.assert_allclose(solution["R_total"], expected, atol=1e-9)

    learner.press("Compose with previous")
    agree(learner, axis=[0, 1, 0], angle=120, history=[1, 0, 0, 90, 0, 1, 0, 120])
    learner.reload()
    agree(learner, axis=[0, 1, 0], angle=120, history=[1, 0, 0, 90, 0, 1, 0, 120])

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
    learner.says("axis must not be zero")
    assert agree(learner, axis=[0, 0, 2]) == solution
    third = learner.control("textbox", "axis.2")
    assert (third.input_value(), third.get_attribute("aria-invalid")) == ("0", "true")

    learner.choose("interpolation", "nlerp")
    learner.control("checkbox", "long_way").click()
    learner.type("t", "0.5")
    solution = agree(learner, interpolation="nlerp", long_way=True, t=0.5)
    assert solution["way_angle"] == 300
    learner.control("checkbox", "show_euler").click()
    agree(learner, show_euler=True)
    learner.until(lambda: "yaw 60°, pitch 0°, roll 0°" in learner.scene.labels().values())
    learner.press("Play interpolation")
    agree(learner, t=1)
