"""coordinate-frames: the axes change, the point is held, w goes to zero, from the hand to the pixel."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from sims.kit.readout import figure
from tests.e2e.conftest import Classroom
from tests.e2e.learner import Learner
from tests.e2e.picture import Picture

Array = npt.NDArray[np.float64]
AXES = ("/axes/x", "/axes/y", "/axes/third/z")
POINT = (1.0, -0.6, 0.8)
"""Where the point of the defaults is in the world."""


def agree(learner: Learner, **expected: Any) -> dict[str, Any]:
    """State, address, solution, read-outs and scene come to say the same; the solution."""

    def said() -> dict[str, Any]:
        solution = learner.solution(**expected)
        tips = np.column_stack([learner.scene.points(path)[0, 1] for path in AXES])
        np.testing.assert_allclose(tips / np.linalg.norm(tips, axis=0), solution["basis"], rtol=0, atol=1e-6)
        assert learner.reads("h", solution["homogeneous"], 2)
        assert product(learner)[4:] == [figure(v, 2) for name in VECTORS for v in vector(solution, name)]
        assert learner.reads("detT", solution["determinant"], 0)
        place = solution["point_world"] or solution["tip"]
        np.testing.assert_allclose(held(learner), place, rtol=0, atol=1e-6)
        return solution

    return learner.until(said)


def product(learner: Learner) -> list[str]:
    """The numbers of T's last column and of the vectors in its product, as the column shows them."""
    shown: list[str] = learner.frame.evaluate(
        "() => [...document.querySelector('.s3-key math').querySelectorAll('mn')].map(each => each.textContent)"
    )
    return [*shown[3:16:4], *shown[16:]]


VECTORS = ("homogeneous", "direction", "homogeneous_to", "direction_to")


def vector(solution: dict[str, Any], name: str) -> list[float]:
    """One of them; the direction is the point's three numbers with w = 0."""
    found: list[float] = [*solution["homogeneous"][:3], 0.0] if name == "direction" else solution[name]
    return found


def held(learner: Learner) -> Array:
    place: Array = learner.scene.world_pose("/point")[:3, 3]
    return place


def shown(learner: Learner) -> None:
    """On the screen: each axis in its colour, a little inside its head, and the point."""

    def look() -> None:
        picture = Picture(learner)
        for axis, path in zip("xyz", AXES, strict=True):
            tip = 0.95 * learner.scene.points(path)[0, 1]
            assert picture.shows(axis, tip), f"no {axis} axis: {picture.around(tip)}"
        assert picture.shows("held", held(learner), within=6), f"nothing to hold: {picture.around(held(learner))}"

    learner.until(look)


def test_axes_change_and_the_point_stays(classroom: Classroom) -> None:
    learner = classroom.open_column("coordinate-frames/embed?convention=opengl&show_rule=0")
    agree(learner, convention="opengl", handedness=None)

    learner.choose("convention", "ros")
    solution = agree(learner, convention="ros", point=[-0.6, -1, 0.8])
    np.testing.assert_allclose(solution["basis"], [[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    np.testing.assert_allclose(held(learner), POINT, atol=1e-12)

    learner.choose("handedness", "left")
    solution = agree(learner, handedness="left", point=[-0.6, -1, -0.8])
    np.testing.assert_allclose(solution["coordinates"]["opengl"], [1, 0.8, 0.6], atol=1e-12)
    np.testing.assert_allclose(held(learner), POINT, atol=1e-12)
    learner.until(lambda: "left-handed: X forward, Y left, Z down" in learner.spoken())

    learner.choose("to", "camera")
    assert agree(learner, to="camera")["determinant"] == -1
    learner.says("improper (a reflection)")
    come_round(learner)
    learner.choose("handedness", None)
    assert agree(learner, handedness=None, point=[-0.6, -1, 0.8])["determinant"] == 1
    assert "handedness" not in learner.address

    come_round(learner)
    learner.reload()
    agree(learner, convention="ros", to="camera", point=[-0.6, -1, 0.8])


def come_round(learner: Learner) -> None:
    """Wait until the axes that turn have come round: what is chosen just before a frame of theirs is shown as it was."""
    learner.until(lambda: (learner.params["turn"], learner.params["turn_to"]) == (None, None))


def test_the_second_frame_and_the_point_are_pulled_in_axes_of_either_hand(classroom: Classroom) -> None:
    learner = classroom.open(
        "coordinate-frames/embed?convention=ros&point=-0.6,-1,0.8&to=camera&origin=0.2,-1.2,0&show_rule=0"
    )
    first = agree(learner)
    shown(learner)
    learner.pull(learner.place(first["origin_world"]), 40, 30)
    learner.until(lambda: learner.params["origin"] != [0.2, -1.2, 0])
    pulled = agree(learner)
    np.testing.assert_allclose(pulled["point_world"], first["point_world"], atol=1e-12)
    assert pulled["direction_to"] == first["direction_to"]
    assert np.abs(np.subtract(pulled["homogeneous_to"], first["homogeneous_to"])).max() > 0.05

    def drawn() -> None:
        picture = Picture(learner)
        assert picture.shows("held", pulled["origin_world"], within=6), picture.around(pulled["origin_world"])

    learner.until(drawn)

    learner.choose("convention", "unreal")
    before = np.array(agree(learner, convention="unreal", point=[-0.6, 1, 0.8])["point_world"])
    np.testing.assert_allclose(before, POINT, atol=1e-12)
    shown(learner)
    camera = dict(learner.sockets.camera)

    x, y = learner.place(before)
    learner.pull((x, y), -60, 35)
    learner.until(lambda: learner.params["point"] != [-0.6, 1, 0.8])
    aim = (x - 60, y + 35)
    learner.until(lambda: np.testing.assert_allclose(learner.place(held(learner)), aim, atol=3))
    after = np.array(agree(learner)["point_world"])
    forward = np.subtract(camera["look_at"], camera["position"])
    assert abs((after - before) @ forward) / np.linalg.norm(forward) < 0.02, (
        "it moves in the plane that faces the viewer"
    )
    np.testing.assert_allclose(learner.sockets.camera["position"], camera["position"], atol=1e-9)
    shown(learner)


def test_each_control_of_coordinate_frames_answers(classroom: Classroom) -> None:
    learner = classroom.open_column("coordinate-frames/embed?to=opengl")
    learner.type("point", "-0.5", box=1)
    learner.type("point", "0.25", box=3)
    agree(learner, point=[-0.5, 0.8, 0.25])

    learner.press_keys("rule", "Home")
    agree(learner, rule=0)
    assert learner.scene.visible("/rule/right/near")
    learner.control("checkbox", "show_rule").click()
    agree(learner, show_rule=False)
    learner.until(lambda: not learner.scene.visible("/rule/right/near"))
    for name in ("grid_xy", "grid_xz", "grid_yz"):
        learner.control("checkbox", name).click()
        agree(learner, **{name: True})
    learner.until(lambda: all(learner.scene.visible(f"/axes/{name}") for name in ("grid_xy", "grid_xz", "grid_yz")))

    learner.press("Animate the rule")
    learner.until(lambda: learner.params["show_rule"] and 0 < learner.params["rule"] < 1)
    learner.says("Curl them towards Y.")
    agree(learner, show_rule=True, rule=1, lit=None)
    learner.type("origin", "0.5", box=2)
    solution = agree(learner, origin=[0, 0.5, 0])
    assert product(learner)[:4] == [figure(-v, 2) for v in solution["origin_world"][:1]] + ["−0.50", "0.00", "1.00"]
    learner.press("Reset")
    agree(learner, origin=[0, 0, 0], point=[1, 0.8, 0.6], rule=1, grid_xy=False, show_rule=True)


def test_w_goes_to_zero(classroom: Classroom) -> None:
    learner = classroom.open_column("coordinate-frames/embed?point=0,0,1")
    learner.type("w", "0.5")
    np.testing.assert_allclose(agree(learner, w=0.5)["point_world"], [0, -2, 0], atol=1e-12)
    learner.type("w", "0.1")
    assert agree(learner, w=0.1)["distance"] == 10
    learner.says("Out of view: the point is 10.0")
    learner.press_keys("w", "Home")
    solution = agree(learner, w=0)
    assert solution["cartesian"] is None
    np.testing.assert_allclose(solution["direction"], [0, -1, 0], atol=1e-12)
    learner.says("w = 0: no point, but a direction")
    learner.until(lambda: "direction (0.00, 0.00, 1.00)" in learner.spoken())
    learner.type("point", "0", box=3)
    learner.says("neither a point nor a direction")
    assert not learner.scene.visible("/point")


def test_it_opens_with_two_frames_whose_product_is_beside_the_scene(classroom: Classroom) -> None:
    learner = classroom.open_column("coordinate-frames/embed")
    solution = agree(learner, convention="ros", to="camera")
    assert np.linalg.norm(np.subtract(solution["homogeneous_to"], solution["direction_to"])[:3]) > 0.5
    assert "to=" not in learner.address
    learner.says("Pull X′ Y′ Z′ by their ring")
    for width, height in ((1280, 800), (700, 600), (560, 315)):
        learner.page.set_viewport_size({"width": width, "height": height})
        shown = learner.frame.evaluate(
            "() => (({right, bottom}) => [right, bottom])"
            "(document.querySelector('.s3-key math').lastElementChild.getBoundingClientRect())"
        )
        assert 0 < shown[0] <= width
        assert 0 < shown[1] <= height
