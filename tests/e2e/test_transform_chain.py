"""transform-chain: hands on sliders, dropdowns, buttons and the arm itself, down to the pixel."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from tests.e2e.conftest import Classroom
from tests.e2e.learner import Learner
from tests.e2e.picture import Picture

Array = npt.NDArray[np.float64]


def agree(learner: Learner, **expected: Any) -> dict[str, Any]:
    """State, address, solution, read-outs and scene come to say the same; the solution."""

    def said() -> dict[str, Any]:
        solution = learner.solution(**expected)
        scene, n = learner.scene, len(learner.params["axes"])
        path = ""
        for i, T in enumerate(solution["composed"], start=1):
            path += f"/link{i}"
            np.testing.assert_allclose(scene.world_pose(path), T, rtol=0, atol=1e-6)
            assert scene.visible(path)
        np.testing.assert_allclose(scene.world_pose("/end_effector"), solution["end_effector"], rtol=0, atol=1e-6)
        assert learner.reads(f"T0{n}", solution["end_effector"])
        assert learner.reads(f"T{n}0", solution["inverse"])
        for i, T in enumerate(solution[learner.params["show"]], start=1):
            first = i - 1 if learner.params["show"] == "individual" else 0
            assert learner.reads(f"T{first}{i}", T)
        return solution

    return learner.until(said)


def test_sliders_and_hands_in_the_scene_turn_the_arm(classroom: Classroom) -> None:
    learner = classroom.open("transform-chain/embed?angles=20,-40,70")
    agree(learner, angles=[20, -40, 70])
    before = tip(learner)
    shown(learner)

    learner.type("angles.0", "50")
    agree(learner, angles=[50, -40, 70], trace=1)
    learner.press_keys("angles.1", "ArrowRight", "ArrowRight")
    agree(learner, angles=[50, -39, 70], trace=2)
    shown(learner)
    assert not Picture(learner).shows("x", before, within=1), "the end effector is still where it was"

    x, y = learner.place_of("/grip")
    learner.pull((x, y), -30, -24)
    learner.until(lambda: learner.params["angles"] != [50, -39, 70])
    learner.until(lambda: np.testing.assert_allclose(learner.place_of("/grip"), [x - 30, y - 24], atol=3))
    solution = agree(learner, pull=None, lengths=[1, 0.8, 0.5])
    assert solution["pull_distance"] is None

    turned = solution["holds"][0]
    u, v = learner.place_of("/turn1")
    learner.pull((u, v), 24, 0)
    learner.until(lambda: learner.params["trace"] == 1)
    held = agree(learner, lengths=[1, 0.8, 0.5])
    assert np.hypot(*np.subtract(held["holds"][0], turned)[:2]) > 0.02
    assert held["holds"][0][2] == 0.0, "it goes round, wherever it is pulled"


def tip(learner: Learner) -> Array:
    """The end of the end effector's x axis, a little inside its head."""
    start, end = learner.scene.points("/end_effector/axes")[0]
    inside: Array = start + 0.94 * (end - start)
    return inside


def shown(learner: Learner) -> None:
    """On the screen: the x axis of the end effector where its frame says."""

    def look() -> None:
        picture = Picture(learner)
        assert picture.shows("x", tip(learner)), f"no x axis: {picture.around(tip(learner))}"

    learner.until(look)


def test_links_come_and_go_and_two_transforms_are_swapped(classroom: Classroom) -> None:
    learner = classroom.open_column("transform-chain/embed?angles=10,20,30&swap=2")
    learner.press("Add link")
    agree(learner, angles=[10, 20, 30, 0], lengths=[1, 0.8, 0.5, 0.4], axes="zyyy", swap=2)
    learner.press_keys("angles.3", "ArrowLeft")
    agree(learner, angles=[10, 20, 30, -0.5])
    learner.choose("swap", "3")
    solution = agree(learner, swap=3)
    pose = learner.scene.world_pose("/swapped_end")
    np.testing.assert_allclose(pose, solution["swapped_end_effector"], rtol=0, atol=1e-6)
    learner.frame.locator('.s3-stage input[value="2"]').check()
    learner.until(lambda: learner.params["stage"] == 2)
    alone = learner.solution(stage=2)
    assert learner.reads("T12", alone["individual"][1])
    assert learner.reads("T02", alone["composed"][1])
    learner.until(lambda: [learner.scene.visible(f"{at}/arrow") for at in ("/link1", "/link1/link2")] == [False, True])
    learner.frame.locator('.s3-stage input[value=""]').check()
    agree(learner, stage=None)

    learner.press("Remove link")
    agree(learner, angles=[10, 20, 30], lengths=[1, 0.8, 0.5], axes="zyy", swap=None)
    learner.until(lambda: learner.frame.locator('[data-slide="angles.3"]').count() == 0)
    learner.press("Planar 2R arm")
    agree(learner, axes="zz", lengths=[1, 0.8])
    learner.type("angles.1", "0")
    agree(learner, angles=[30, 0])
    learner.says("Singular pose: the joints can move")
    learner.until(lambda: "singular pose" in learner.spoken())
    learner.press("Reset")
    agree(learner, angles=[10, 20, 30], axes="zyy", swap=2)


def test_the_arm_is_stretched_and_sent_too_far_and_a_reload_brings_all_back(classroom: Classroom) -> None:
    learner = classroom.open_column("transform-chain/embed")
    agree(learner, angles=[30, 40, -30], lengths=[1, 0.8, 0.5], axes="zyy")
    learner.type("lengths.2", "0.9")
    agree(learner, lengths=[1, 0.8, 0.9])
    learner.choose("axes.2", "z")
    solution = agree(learner, axes="zyz")
    learner.choose("show", "composed")
    agree(learner, show="composed")
    learner.reload()
    assert agree(learner, angles=[30, 40, -30], lengths=[1, 0.8, 0.9], axes="zyz", show="composed") == solution

    learner.type("/grip", "9", box=3)
    learner.until(lambda: learner.params["pull"] is not None)
    assert agree(learner)["pull_outside"]
    learner.says("Out of reach: this is as near")
    assert any("out of reach" in text for text in learner.scene.labels().values())


def test_a_joint_is_swept_and_stops_at_the_first_touch(classroom: Classroom) -> None:
    learner = classroom.open_column("transform-chain/embed?trace=2")
    learner.press("Sweep joint")
    learner.until(lambda: learner.params["angles"][1] != 40)
    learner.press_keys("angles.0", "ArrowRight")
    learner.until(lambda: learner.params["angles"][0] == 30.5)
    stopped = agree(learner, trace=1)
    assert stopped == agree(learner)
    learner.press("Reset")
    agree(learner, angles=[30, 40, -30], trace=2)
