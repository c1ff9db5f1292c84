"""camera: a learner's hands on the camera, on its points wherever they are shown, and on its motions."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from scipy.spatial.transform import Rotation

from sims.camera.solution import LIFT
from sims.kit.world import PLACES, SUBJECT
from tests.e2e.conftest import Classroom
from tests.e2e.learner import Learner, box, touch

Array = npt.NDArray[np.float64]
MARKS = """() => Object.fromEntries([...document.querySelectorAll("svg [data-link]")].map(
    (mark) => [mark.dataset.link, mark.getAttribute("transform").match(/[-\\d.]+/g).map(Number)]))"""


def agree(learner: Learner, **expected: Any) -> dict[str, Any]:
    """State, address, solution, read-outs, picture and scene come to say the same; the solution."""

    def said() -> dict[str, Any]:
        solution = learner.solution(**expected)
        drawn = learner.scene.world_pose("/camera")
        np.testing.assert_allclose(drawn[:3, :3], np.transpose(solution["R"]), rtol=0, atol=1e-6)
        np.testing.assert_allclose(drawn[:3, 3], solution["center"], rtol=0, atol=1e-6)
        assert learner.reads("K", solution["K"], 1)
        assert solution["P"] is None or learner.reads("P", solution["P"], 2)
        marks = learner.frame.evaluate(MARKS)
        for point in solution["points"]:
            if point["in_image"]:
                np.testing.assert_allclose(marks[point["name"]], point["pixel"], rtol=0, atol=0.006)
        selected = PLACES[learner.params["selected"]]
        np.testing.assert_allclose(learner.scene.world_pose("/selected")[:3, 3], selected, rtol=0, atol=1e-9)
        return solution

    return learner.until(said)


def test_controls_of_the_camera_answer_and_a_reload_brings_all_back(classroom: Classroom) -> None:
    learner = classroom.open_column("camera/embed?fy=300")
    learner.press_keys("fx", "ArrowRight")
    agree(learner, fx=610, fy=305)
    learner.choose("projection", "orthographic")
    flat = agree(learner, projection="orthographic")
    assert flat["P"][2] == [0, 0, 0, 1]
    assert flat["scale"] == 100
    learner.type("position", "-18,36", box=2)
    assert agree(learner, position=[0, -18.36, 1.2])["scale"] == 100
    assert learner.control("textbox", "position.1").input_value() == "−18.36"
    learner.choose("projection", "weak")
    learner.type("position", "20", box=2)
    agree(learner, position=[0, 20, 1.2])
    learner.says("No picture: its scale comes from")
    learner.press("Reset")
    agree(learner, fx=600, fy=300, position=[0, -4, 1.2], projection="perspective")
    learner.press_keys("tilt", "ArrowLeft", "ArrowLeft")
    agree(learner, tilt=-2)
    learner.choose("projection", "weak")
    before = agree(learner, tilt=-2, projection="weak")
    learner.reload()
    assert agree(learner, fx=600, fy=300, tilt=-2, projection="weak") == before


def test_a_point_lights_up_and_is_selected_in_table_and_picture(classroom: Classroom) -> None:
    learner = classroom.open_column("camera/embed")
    frame = learner.frame
    agree(learner, selected="roof-near")
    button = learner.find("button", "Left cube, corner")
    button.scroll_into_view_if_needed()
    button.hover()
    learner.until(lambda: learner.lights("cube-left", "g tr"))
    learner.until(lambda: learner.scene.visible("/lit"))
    np.testing.assert_allclose(learner.scene.world_pose("/lit")[:3, 3], PLACES["cube-left"])
    assert learner.params["selected"] == "roof-near", "pointing selects nothing"

    button.focus()
    learner.page.keyboard.press("Enter")
    agree(learner, selected="cube-left")
    focused = "document.activeElement.closest('[data-link]')?.dataset.link"
    learner.until(lambda: frame.evaluate(focused) == "cube-left")

    frame.locator('svg [data-link="roof-far"] .s3-spot').click()
    agree(learner, selected="roof-far")
    learner.until(lambda: learner.pressed("roof-far"))
    handle = frame.locator("[data-handle=principal]")
    handle.focus()
    learner.page.keyboard.press("Shift+ArrowRight")
    agree(learner, cx=330)


def test_picture_matrices_controls_and_actions_are_seen_together(classroom: Classroom) -> None:
    learner = classroom.open_column("camera/embed", size={"width": 1280, "height": 800})
    agree(learner, fx=600)
    seen = {name: box(learner.frame.locator(selector)) for name, selector in {
        "chain": ".s3-chain", "picture": "svg[data-pane=picture]", "K": ".s3-key .s3-formula >> nth=0",
        "pose": ".s3-key .s3-formula >> nth=1", "focal length": "[data-control=fx]", "tilt": "[data-control=tilt]",
        "dolly zoom": "[data-act=dolly-zoom]",
    }.items()}  # fmt: skip
    assert seen["picture"]["width"] >= 480
    tops = [place["y"] for name, place in seen.items() if name != "pose"]
    assert tops == sorted(tops), "the matrices stand between the picture and the controls that change them"
    assert seen["pose"]["y"] == seen["K"]["y"]
    assert seen["chain"]["height"] < 40, "the chain is one line with its words above it"
    assert max(place["y"] + place["height"] for place in seen.values()) <= 800
    learner.frame.locator("[data-slide=tilt]").hover()
    lit = "[...document.querySelectorAll('.s3-key mtd.s3-highlighted')].length"
    learner.until(lambda: learner.frame.evaluate(lit) == 9, patience=5)


def test_in_the_scene_a_point_is_selected_the_camera_is_held_and_the_view_follows_it(classroom: Classroom) -> None:
    learner = classroom.open("camera/embed?tilt=-10&roll=25")
    agree(learner, pan=0, selected="roof-near")
    start = np.array(learner.until(lambda: at_rest(learner)))
    learner.click_on("/points/far-post")
    agree(learner, selected="far-post")
    learner.until(lambda: learner.pressed("far-post"))
    touch(learner, learner.place_of("/points/cube-left"))
    agree(learner, selected="cube-left")

    x, y = learner.place_of("/eye")
    learner.pull((x, y), -20, -16)
    learner.until(lambda: np.testing.assert_allclose(learner.place_of("/eye"), [x - 20, y - 16], atol=3))
    solution = agree(learner, pan=0, tilt=-10)
    assert np.linalg.norm(np.subtract(solution["center"], [0, -4, 1.2])) > 0.1
    np.testing.assert_allclose(
        learner.scene.world_pose("/eye")[:3, 3] - (0, 0, LIFT), solution["center"], rtol=0, atol=1e-6
    )
    center = solution["center"]
    x, y = learner.place_of("/look")
    learner.pull((x, y), -25, -10)
    learner.until(lambda: learner.params["pan"] != 0)
    solution = agree(learner, position=center, roll=25)
    assert learner.params["pan"] > 0.0
    grip = learner.scene.world_pose("/look")[:3, 3] - center
    np.testing.assert_allclose(grip / np.linalg.norm(grip), solution["R"][2], rtol=0, atol=1e-9)
    learner.press("Reset")
    agree(learner, pan=0, selected="roof-near")
    learner.until(lambda: np.testing.assert_allclose(learner.sockets.camera["position"], start, atol=1e-4))

    learner.find("switch", "Look through the camera").click()

    def through(**expected: Any) -> None:
        solution = learner.solution(through=True, **expected)
        camera = learner.sockets.camera
        np.testing.assert_allclose(camera["position"], solution["center"], rtol=0, atol=1e-5)
        turned = Rotation.from_quat(camera["wxyz"], scalar_first=True).as_matrix()
        np.testing.assert_allclose(turned, np.transpose(solution["R"]), rtol=0, atol=1e-5)
        frustum = solution["frustum"]
        assert np.tan(camera["fov"] / 2) >= abs(frustum["corners"][2][1]) / frustum["depth"]

    learner.until(through)
    learner.press_keys("pan", "PageUp")
    learner.until(lambda: through(pan=10))
    learner.until(lambda: "view" not in learner.address)  # the view that the sim has itself comes after the camera
    learner.find("switch", "Look through the camera").click()
    learner.until(lambda: np.testing.assert_allclose(learner.sockets.camera["position"], start, atol=1e-4))
    assert learner.sockets.camera["fov"] == pytest.approx(0.7, abs=1e-6)
    assert not learner.params["through"]

    def away() -> float:
        camera = learner.sockets.camera
        return float(np.linalg.norm(np.subtract(camera["position"], camera["look_at"])))

    first = away()
    learner.type("position", "-9", box=2)
    learner.until(lambda: away() > 1.2 * first)
    farther = away()
    x, y = learner.place_of("/camera")
    assert x > 0
    assert y > 0
    learner.until(lambda: "view" not in learner.address)  # the view that the sim has itself comes after the camera
    learner.press("Reset")
    learner.until(lambda: away() < 1.01 * first)

    canvas = box(learner.frame.locator("canvas[data-engine]"))
    learner.pull((canvas["x"] + 30, canvas["y"] + 30), 60, 10)
    learner.until(lambda: "view" in learner.address)
    chosen = learner.until(lambda: at_rest(learner))
    learner.type("position", "-9", box=2)
    agree(learner, position=[0, -9, 1.2])
    np.testing.assert_allclose(at_rest(learner), chosen, atol=1e-6)
    learner.press("Home view")
    learner.until(lambda: abs(away() - farther) < 0.01)
    learner.until(lambda: "view" not in learner.address)


def at_rest(learner: Learner) -> Array:
    """The viewpoint, which glides on after a hand has let go."""
    before = np.array(learner.sockets.camera["position"])
    learner.page.wait_for_timeout(400)
    np.testing.assert_allclose(learner.sockets.camera["position"], before, atol=1e-9)
    return before


def test_dolly_zoom_keeps_the_house_as_tall_in_every_state_on_the_way(classroom: Classroom) -> None:
    learner = classroom.open_column("camera/embed")
    wanted = agree(learner)["subject"]["height"]
    since = len(learner.sockets.told)
    learner.press("Dolly zoom")
    learner.until(lambda: learner.params["fx"] < 301)
    end = agree(learner)
    told = [m["params"] for m in learner.sockets.told[since:] if m["type"] == "state"]
    assert len({params["fx"] for params in told}) > 2, "it moves through many states"
    for params in told:
        assert abs(height(params) - wanted) < 0.5
    assert end["center"][1] > -1.5
    learner.press("Look at the house")
    learner.until(lambda: np.testing.assert_allclose(agree(learner)["subject"]["pixel"], [320, 240], atol=1e-6))


def height(params: dict[str, Any]) -> float:
    """Pixels between ground and ridge of the house, seen by a level camera."""
    _, y, z = params["position"]
    assert params["pan"] == params["tilt"] == params["roll"] == 0
    rows = [params["fy"] * (z - end[2]) / (end[1] - y) for end in SUBJECT]
    return float(rows[0] - rows[1])
