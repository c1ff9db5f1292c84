"""The equations and tables on the page of the frames, both sides at random states."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from geometry import frames
from geometry.arrays import Array
from sims import coordinate_frames
from sims.coordinate_frames import FramesParams, solve
from sims.coordinate_frames.conventions import NAMES

LESSON = (Path(coordinate_frames.__file__).parent / "lesson.md").read_text("utf-8")
ROWS = {
    "opengl": "Computer graphics (OpenGL)", "directx": "Games (DirectX, Unity)", "ros": "Robots (ROS)",
    "aviation": "Aviation", "camera": "Cameras (OpenCV)", "enu": "Maps (ENU), Blender", "unreal": "Unreal",
}  # fmt: skip
RANDOM = np.random.default_rng(6)
STATES = [
    FramesParams(
        convention=one, to=other, point=tuple(RANDOM.uniform(-3, 3, 3)), origin=tuple(RANDOM.uniform(-2, 2, 3)),
        w=RANDOM.uniform(0.3, 2.0),
    )
    for one, other in (("ros", "camera"), ("opengl", "directx"), ("aviation", "enu"), ("unreal", "ros"))
]  # fmt: skip
each_state = pytest.mark.parametrize("p", STATES, ids=lambda p: f"{p.convention} to {p.to}")


def place(found: Array | None) -> Array:
    assert found is not None
    return found


@each_state
def test_numbers_are_turned_and_shifted(p: FramesParams) -> None:
    s = solve(p)
    np.testing.assert_allclose(
        place(s.cartesian_to), s.matrix[:3, :3] @ place(s.cartesian) + s.matrix[:3, 3], atol=1e-12
    )
    apart = frames.to_world(place(s.cartesian), p.axes.basis) - frames.to_world(p.origin, p.axes.basis)
    np.testing.assert_allclose(place(s.cartesian_to), frames.coordinates(apart, p.axes_to.basis), atol=1e-12)


@each_state
def test_one_matrix_of_four_rows_does_both(p: FramesParams) -> None:
    s = solve(p)
    np.testing.assert_allclose(s.homogeneous_to, s.matrix @ (*p.point, p.w), atol=1e-12)
    np.testing.assert_array_equal(s.matrix[3], (0, 0, 0, 1))
    np.testing.assert_allclose(place(s.cartesian), np.divide(p.point, p.w), atol=1e-12)


@each_state
def test_a_direction_does_not_care_where_a_frame_begins(p: FramesParams) -> None:
    np.testing.assert_array_equal(solve(p).direction_to, solve(p.changed({"origin": (1, 2, 3)})).direction_to)
    assert solve(p).direction_to[3] == 0.0


@each_state
def test_hand_is_the_sign_of_the_triple_product(p: FramesParams) -> None:
    x, y, z = p.axes.basis.T
    assert np.cross(x, y) @ z == np.linalg.det(p.axes.basis) == p.axes.drawn.side
    assert solve(p).determinant == p.axes.drawn.side * p.axes_to.drawn.side


def test_table_says_where_the_axes_point() -> None:
    assert ROWS.keys() == NAMES.keys()
    for name, title in ROWS.items():
        row = next(line for line in LESSON.splitlines() if line.startswith(f"| {title} |"))
        cells = [cell.strip() for cell in row.strip("|").split("|")]
        pointing = [next(way for way in frames.DIRECTIONS if re.search(rf"\b{way}\b", cell)) for cell in cells[1:4]]
        assert (*pointing, cells[5]) == (*frames.axis_directions(name), frames.handedness(frames.basis(name)))


def test_readings_that_the_text_tells() -> None:
    start = FramesParams(convention="ros", to="camera", point=(1, 0.5, 0.8))
    np.testing.assert_allclose(place(solve(start).cartesian_to), (-0.5, -0.8, 1))
    np.testing.assert_array_equal(solve(start).matrix[:3, :2].T, [(0, 0, 1), (-1, 0, 0)])
    screw = FramesParams(convention="camera", to="ros", point=(0.2, 0.1, 0.5))
    np.testing.assert_allclose(place(solve(screw).cartesian_to), (0.5, -0.2, -0.1))
    assert solve(FramesParams(point=(0.6, 0.3, 0.8))).distance == pytest.approx(1.04, abs=0.005)
    assert [frames.handedness(frames.basis(name)) for name in NAMES].count("left") == 2
