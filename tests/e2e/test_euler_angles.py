"""euler-angles, from the hand on a control to the pixel on the screen."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
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
    """State, address, solution, read-outs and scene come to say the same; the rotation."""

    def said() -> Array:
        solution = learner.solution(**expected)
        R = np.array(solution["R"])
        np.testing.assert_allclose(R, expected_rotation(learner.params), rtol=0, atol=1e-12)
        np.testing.assert_allclose(drawn(learner), solution["R_progress"], rtol=0, atol=1e-6)
        assert learner.reads("R", R)
        return R

    return learner.until(said)


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
    learner = classroom.open("euler-angles/embed?yaw=60&pitch=-30")
    agree(learner, yaw=60, pitch=-30, roll=10)
    before = shown_at_tips(learner)

    learner.slide("yaw", 110)
    learner.until(lambda: abs(learner.params["yaw"] - 110) < 8)
    agree(learner, pitch=-30, roll=10)
    shown_at_tips(learner, "xz")
    picture = Picture(learner)
    assert not picture.shows("x", before["x"]), f"the x axis is still where it was: {picture.around(before['x'])}"

    learner.slide("progress", 1.5)
    learner.until(lambda: abs(learner.params["progress"] - 1.5) < 0.2)
    agree(learner, pitch=-30, roll=10)
    shown_at_tips(learner, "z")

    learner.press("Reset")
    agree(learner, yaw=60, pitch=-30, progress=3)
    for grip, name, (dx, dy) in (("/held_first", "yaw", (40, -10)), ("/held_second", "pitch", (5, 40))):
        start, place = dict(learner.params), learner.place_of(grip)
        learner.pull(place, dx, dy)
        learner.until(lambda: learner.params[name] != start[name])  # noqa: B023
        agree(learner, **{other: start[other] for other in {"yaw", "pitch", "roll"} - {name}})
    x, y = learner.place_of("/held_nose")
    learner.pull((x, y), -20, -30)
    learner.until(lambda: abs(learner.place_of("/held_nose")[1] - (y - 30)) < 15)
    agree(learner)

    learner.type("pitch", "90")
    agree(learner, pitch=90)
    shown_at_tips(learner, "z")


def test_each_control_answers_to_keyboard_pointer_and_typing(classroom: Classroom) -> None:
    learner = classroom.open_column("euler-angles/embed?yaw=45")

    learner.press_keys("pitch", "ArrowRight", "ArrowRight", "ArrowLeft", "ArrowRight")
    agree(learner, pitch=22)
    learner.press_keys("roll", "Home")
    agree(learner, roll=-180)
    learner.press_keys("roll", "End", "ArrowLeft")
    agree(learner, roll=179)
    for text, yaw in (("47.5", 47.5), ("−0.6", -0.6), ("45,5", 45.5), ("1e2", 100), ("-π/3", -60), ("-120°", -120)):
        learner.control("textbox", "yaw").click(click_count=3)
        learner.page.keyboard.type(text)
        learner.page.keyboard.press("Enter")
        agree(learner, yaw=yaw)

    assert sliders(learner) == ["yaw", "pitch", "roll", "progress"]
    learner.control("combobox", "order").focus()
    learner.choose("order", "xyz")
    agree(learner, order="xyz", yaw=-120, pitch=22, roll=179)
    assert sliders(learner) == ["roll", "pitch", "yaw", "progress"], "they don't stand in the order of the turns"
    assert learner.control("combobox", "order").evaluate("node => node === document.activeElement")
    learner.choose("frame", "extrinsic")
    agree(learner, frame="extrinsic")
    learner.choose("order", "zxz")
    agree(learner, order="zxz")
    for label in ("First α · Z", "Second β · X", "Third γ · Z"):
        learner.frame.get_by_role("slider", name=label, exact=True).wait_for()
    low, high = (float(learner.control("slider", "pitch").get_attribute(end) or "nan") for end in ("min", "max"))
    assert (low, high) == (0, 180), "a proper Euler order's second angle goes from 0° to 180°"

    learner.press("Reset")
    agree(learner, order="zyx", frame="intrinsic", yaw=45, pitch=20, roll=10, progress=3)

    assert sliders(learner) == ["yaw", "pitch", "roll", "progress"]
    learner.slide("progress", 1.5)
    learner.until(lambda: abs(learner.params["progress"] - 1.5) < 0.2)
    agree(learner, yaw=45)
    assert learner.reads("RzRy", learner.solved()["R_progress"])


def sliders(learner: Learner) -> list[str]:
    """The sliders from top to bottom, by their parameters."""
    found: list[str] = learner.frame.evaluate(
        "() => [...document.querySelectorAll('[data-slide]')].map((node) => node.dataset.slide)"
    )
    return found


def test_a_pasted_rotation_is_recognised_asked_about_and_copied(classroom: Classroom) -> None:
    learner = classroom.open_column("euler-angles/embed", permissions=["clipboard-read", "clipboard-write"])
    learner.witness.expect("422")
    text = learner.frame.locator("#paste")
    learner.unfold(text)
    text.fill("0.5 0.5 0.5 0.5")
    learner.press("Use this")
    learner.says("is w the first of these four numbers or the last?")
    agree(learner, yaw=30, pitch=20, roll=10)
    text.fill("wxyz 0.5 0.5 -0.5 0.5")
    learner.press("Use this")
    learner.says("Read as a quaternion, w first.")
    assert text.input_value() == "wxyz 0.5 0.5 -0.5 0.5", "what was pasted is lost"
    wanted = Rotation.from_quat([0.5, -0.5, 0.5, 0.5]).as_matrix()
    found = learner.until(lambda: turned(learner))
    assert found is not None
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-9)
    learner.press("Copy: Quaternion, w first (Eigen, Blender)")
    learner.says("Copied.")
    assert learner.frame.evaluate("() => navigator.clipboard.readText()") == "wxyz 0.5, 0.5, -0.5, 0.5"


def turned(learner: Learner) -> Array | None:
    """The rotation, once it isn't that of the start."""
    return None if learner.params["yaw"] == 30 else agree(learner)


def test_gimbal_lock_is_said_and_shown(classroom: Classroom) -> None:
    learner = classroom.open_column("euler-angles/embed?yaw=40&roll=-25")
    learner.type("pitch", "90")
    R = agree(learner, pitch=90)
    np.testing.assert_allclose(R[2], [-1, 0, 0], atol=1e-12)
    assert learner.solved()["locked"]
    learner.says("Gimbal lock: the first and third axes coincide")
    learner.until(lambda: "at gimbal lock" in learner.spoken())

    for text in ("100", "not a number"):
        learner.type("pitch", text)
        learner.says(
            f"This needs a number from −90 to 90°; {'100 isn’t.' if text == '100' else f'“{text}” isn’t one.'}"
        )
        assert learner.control("textbox", "pitch").input_value() == text, "what was typed is lost"
        agree(learner, pitch=90)
    learner.type("yaw", "41")
    agree(learner, yaw=41, pitch=90)
