"""gimbal-lock, from the hand on a control to the rings on the screen."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from playwright.sync_api import ViewportSize
from scipy.spatial.transform import Rotation

from tests.e2e.conftest import Classroom
from tests.e2e.learner import Learner
from tests.e2e.picture import Picture

Array = npt.NDArray[np.float64]
INNER = "/outer/middle/inner"
HOLDERS = ("", "/outer", "/outer/middle")
SMALL: ViewportSize = {"width": 640, "height": 480}


def agree(learner: Learner, **expected: Any) -> dict[str, Any]:
    """State, address, solution, read-outs and scene come to say the same; the solution."""

    def said() -> dict[str, Any]:
        solution = learner.solution(**expected)
        turns = [learner.params[name] for name in ("yaw", "pitch", "roll")]
        R = Rotation.from_euler("ZYX", turns, degrees=True).as_matrix()
        np.testing.assert_allclose(solution["R"], R, rtol=0, atol=1e-12)
        np.testing.assert_allclose(learner.scene.world_pose(INNER)[:3, :3], R, rtol=0, atol=1e-6)
        np.testing.assert_allclose(
            np.linalg.norm(np.cross(axes(learner), np.transpose(solution["axes"])), axis=1), 0.0, atol=1e-6
        )
        assert learner.reads("R", R)
        assert learner.reads("J", solution["axes"])
        assert learner.reads("σ", solution["singular_values"])
        assert learner.reads("dof", solution["dof"], 0)
        return solution

    return learner.until(said)


def axes(learner: Learner) -> Array:
    """The rings' axes in the world as they are drawn, in rows: outer, middle, inner."""
    pieces = [learner.scene.points(f"{holder}/tip")[0] for holder in HOLDERS]
    return np.array([(tip - tail) / np.linalg.norm(tip - tail) for tail, tip in pieces])


def test_sliders_turn_the_rings_and_colours_are_where_their_axes_are(classroom: Classroom) -> None:
    learner = classroom.open("gimbal-lock/embed")
    agree(learner, yaw=0, pitch=0, roll=0)
    np.testing.assert_allclose(axes(learner), np.eye(3)[::-1], rtol=0, atol=1e-6)
    learner.slide("yaw", 14)
    learner.until(lambda: learner.params["yaw"] > 5)
    learner.press_keys("pitch", "ArrowRight", "ArrowRight")
    learner.until(lambda: learner.params["pitch"] == 2)  # viser's page drops what another control overtakes in 50 ms
    learner.type("roll", "40")
    agree(learner, pitch=2, roll=40)

    def colours() -> None:
        picture = Picture(learner)
        for holder, role in zip(HOLDERS, "zyx", strict=True):
            tail, tip = learner.scene.points(f"{holder}/tip")[0]
            place = tail + 0.5 * (tip - tail)
            assert picture.shows(role, place), f"{role} {picture.around(place)}"

    learner.until(colours)

    for name, grip, (dx, dy) in (("yaw", "/grip_outer", (60, 10)), ("pitch", "/grip_middle", (-10, 70))):
        before, (x, y) = dict(learner.params), learner.place_of(grip)
        learner.pull((x, y), dx, dy)
        learner.until(lambda: learner.params[name] != before[name])  # noqa: B023
        agree(learner, **{other: before[other] for other in {"yaw", "pitch", "roll"} - {name}})
        np.testing.assert_allclose(learner.place_of(grip)[0], x + dx, atol=25.0, err_msg="it isn't under the hand")


def test_lock_is_shown_said_and_left(classroom: Classroom) -> None:
    learner = classroom.open_column("gimbal-lock/embed?yaw=30&roll=10")
    learner.type("pitch", "80")
    agree(learner, pitch=80)
    learner.says("Near gimbal lock")
    assert learner.scene.visible("/reach/weak")
    learner.press("Go to gimbal lock")
    learner.says("The middle ring turns")
    solution = agree(learner, pitch=90)
    assert solution["dof"] == 2
    np.testing.assert_allclose(np.array(solution["axes"]).T @ solution["lost_axis"], 0.0, rtol=0, atol=1e-12)
    assert "⚠ no ring turns about this" in learner.scene.labels().values()
    outer, _, inner = axes(learner)
    np.testing.assert_allclose(inner, -outer, rtol=0, atol=1e-6)
    learner.says("Gimbal lock: outer and inner ring turn about one line")
    learner.until(lambda: "gimbal lock, 2 degrees of freedom" in learner.spoken())
    assert learner.reads("ψ−φ", 20.0, 1)
    learner.press("Reset")
    assert agree(learner, yaw=30, pitch=0, roll=10)["dof"] == 3
    assert not learner.scene.visible("/reach/lost")


def test_the_same_motion_plays_and_the_aircraft_returns(classroom: Classroom) -> None:
    learner = classroom.open_column("gimbal-lock/embed?pitch=90&show_reach=1", size=SMALL)
    start = learner.scene.world_pose(INNER)[:3, :3]
    gaps: list[float] = []
    learner.press("Show the same motion")

    def played() -> bool:
        pose = learner.scene.world_pose(INNER)[:3, :3]
        gaps.append(float(np.degrees(Rotation.from_matrix(start.T @ pose).magnitude())))
        return bool(learner.params["yaw"] == 40 and learner.params["roll"] == 40 and learner.params["show_reach"])

    learner.until(played)
    agree(learner, yaw=40, pitch=90, roll=40, show_ghost=True, ghost=[0, 90, 0])
    np.testing.assert_allclose(learner.scene.world_pose(INNER)[:3, :3], start, rtol=0, atol=1e-9)
    assert max(gaps) > 30.0, "it was turned away before"
    learner.says("Same orientation as the ghost, which has other ring angles")


def test_trying_the_lost_axis_steps_under_reduced_motion_and_stops_at_a_touch(classroom: Classroom) -> None:
    learner = classroom.open_column("gimbal-lock/embed?pitch=90&show_reach=1", size=SMALL, reduced_motion="reduce")
    learner.press("Try to turn about the lost axis")
    learner.until(lambda: learner.params["ghost"] == [90, 60, 90])
    assert (learner.params["yaw"], learner.params["pitch"], learner.params["roll"]) == (0, 90, 0), "no ring moves"
    learner.says("No ring rates turn the aircraft towards it")
    learner.sees(yaw=90, pitch=90, roll=90)
    learner.sees(yaw=90, pitch=60, roll=90, show_reach=True)
    told = [message["params"]["ghost"][1] for message in learner.sockets.states]
    assert set(told) == {0, 90, 60}, "the ghost moved by steps"

    learner.press("Reset")
    learner.sees(pitch=90, show_ghost=False)
    learner.press("Try to turn about the lost axis")
    learner.until(lambda: learner.params["show_ghost"])
    learner.type("roll", "5")
    learner.until(lambda: learner.params["roll"] == 5)
    version = learner.sockets.state["version"]
    learner.type("roll", "6")
    learner.until(lambda: learner.params["roll"] == 6)
    assert learner.sockets.state["version"] == version + 1, "it went on after the touch"
