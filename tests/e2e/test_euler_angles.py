"""euler-angles, from the hand on a control to the pixel on the screen."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from scipy.spatial.transform import Rotation

from tests.e2e.conftest import Classroom
from tests.e2e.learner import Learner
from tests.e2e.picture import Picture

BODY = "/turn1/turn2/turn3"
Array = npt.NDArray[np.float64]


def drawn(learner: Learner) -> Array:
    """Orientation of the aircraft in the world, from the frames that this browser received."""
    orientation: Array = learner.scene.world_pose(BODY)[:3, :3]
    return orientation


def agree(learner: Learner, **expected: Any) -> Array:
    """State, address, solution, read-outs and scene say the same; the rotation."""
    solution = learner.sees(**expected)
    R = np.array(solution["R"])
    np.testing.assert_allclose(R, expected_rotation(learner.params), rtol=0, atol=1e-12)
    learner.until(lambda: np.testing.assert_allclose(drawn(learner), solution["R_progress"], rtol=0, atol=1e-6))
    learner.until(lambda: learner.reads("R", R))
    return R


def expected_rotation(params: dict[str, Any]) -> Array:
    """What SciPy makes of the parameters: capitals are turns about the body's own axes."""
    order = params["order"]
    if order[0] == order[2]:
        angles = [params["yaw"], params["pitch"], params["roll"]]
    else:
        angles = [params[{"z": "yaw", "y": "pitch", "x": "roll"}[axis]] for axis in order]
    rotation: Array = Rotation.from_euler(
        order.upper() if params["frame"] == "intrinsic" else order, angles, degrees=True
    ).as_matrix()
    return rotation


def tips(learner: Learner) -> Array:
    """Where the body's axes end in the world, a little inside their arrow heads."""
    ends = learner.scene.points(f"{BODY}/arrows")
    inside: Array = ends[:, 0] + 0.94 * (ends[:, 1] - ends[:, 0])
    return inside


def shown_at_tips(learner: Learner, axes: str = "xyz") -> dict[str, Array]:
    """Each axis's colour is on the screen where its tip is; the tips."""
    places = dict(zip("xyz", tips(learner), strict=True))

    def look() -> None:
        picture = Picture(learner)
        for axis in axes:
            assert picture.shows(axis, places[axis]), f"no {axis} axis: {picture.around(places[axis])}"

    learner.until(look)
    return places


def test_a_slider_turns_the_aircraft_from_hand_to_pixel(classroom: Classroom) -> None:
    learner = classroom.open("euler-angles/embed")
    agree(learner, yaw=30, pitch=20, roll=10)
    before = shown_at_tips(learner)

    learner.slide("yaw", 110)
    learner.until(lambda: abs(learner.params["yaw"] - 110) < 8)
    agree(learner, pitch=20, roll=10)
    assert learner.params["yaw"] != 30
    after = shown_at_tips(learner, "xz")
    picture = Picture(learner)
    assert not picture.shows("x", before["x"]), f"the x axis is still where it was: {picture.around(before['x'])}"
    assert np.linalg.norm(after["x"] - before["x"]) > 1
