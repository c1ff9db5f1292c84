"""Rotation matrices against SciPy and OpenCV, and by their group laws."""

import math

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from geometry import Array, GeometryError
from geometry.rotations import (
    AXES,
    axis_angle_to_matrix,
    axis_rotation,
    is_rotation,
    matrix_to_axis_angle,
    nearest_rotation,
    orbit,
    rotation_angle,
    shortest_turn,
    skew,
    unit,
)
from tests.geometry.strategies import EXACT, angles, axis_letters, directions, near, rotations, units, vectors

half_turns = near(math.pi, -math.pi)
tiny_turns = near(0.0)


@given(axis_letters, angles)
def test_axis_rotation_is_scipys(axis: str, angle: float) -> None:
    expected = Rotation.from_euler(axis, angle).as_matrix()
    np.testing.assert_allclose(axis_rotation(axis, angle), expected, rtol=0, atol=EXACT)


def test_axis_rotation_is_active_and_right_handed() -> None:
    for axis, turned, into in (("z", 0, 1), ("x", 1, 2), ("y", 2, 0)):
        np.testing.assert_allclose(axis_rotation(axis, math.pi / 2)[:, turned], np.eye(3)[into], atol=EXACT)


@given(axis_letters, angles, angles)
def test_turns_about_one_axis_add_up(axis: str, a: float, b: float) -> None:
    both = axis_rotation(axis, a) @ axis_rotation(axis, b)
    np.testing.assert_allclose(both, axis_rotation(axis, a + b), rtol=0, atol=EXACT)


def test_a_batch_of_angles_gives_a_batch_with_nan_where_an_angle_is_not_finite() -> None:
    batch = axis_rotation("y", np.array([[0.1, math.nan], [math.inf, -2.0]]))
    assert batch.shape == (2, 2, 3, 3)
    np.testing.assert_array_equal(is_rotation(batch), [[True, False], [False, True]])
    np.testing.assert_allclose(batch[1, 1], axis_rotation("y", -2.0), atol=EXACT)


@pytest.mark.parametrize("axis", ["", "X", "xy", "w"])
def test_another_axis_is_refused(axis: str) -> None:
    with pytest.raises(GeometryError, match="axis") as caught:
        axis_rotation(axis, 0.0)
    assert caught.value.allowed == ", ".join(AXES)


@pytest.mark.parametrize("angle", [math.nan, math.inf, -math.inf])
def test_an_angle_that_is_not_finite_is_refused(angle: float) -> None:
    with pytest.raises(GeometryError, match="angle"):
        axis_rotation("x", angle)
    with pytest.raises(GeometryError, match="angle"):
        axis_angle_to_matrix([0.0, 0.0, 1.0], angle)


@given(directions(), angles)
def test_axis_angle_is_rodrigues_of_scipy_and_opencv(axis: Array, angle: float) -> None:
    R = axis_angle_to_matrix(axis, angle)
    vector = angle * axis / np.linalg.norm(axis)
    np.testing.assert_allclose(R, Rotation.from_rotvec(vector).as_matrix(), rtol=0, atol=EXACT)
    np.testing.assert_allclose(R, cv2.Rodrigues(vector)[0], rtol=0, atol=EXACT)


@given(units(), angles | tiny_turns | half_turns)
def test_axis_and_angle_rebuild_the_matrix(axis: Array, angle: float) -> None:
    R = axis_angle_to_matrix(axis, angle)
    found_axis, found_angle = matrix_to_axis_angle(R)
    np.testing.assert_allclose(axis_angle_to_matrix(found_axis, float(found_angle)), R, rtol=0, atol=EXACT)
    assert abs(np.linalg.norm(found_axis) - 1.0) < EXACT
    assert 0.0 <= found_angle <= math.pi


@given(units(), st.floats(1e-9, math.pi - 1e-9) | near(math.pi / 2) | st.floats(1e-9, 1e-6))
def test_axis_and_angle_below_a_half_turn_are_recovered(axis: Array, angle: float) -> None:
    found_axis, found_angle = matrix_to_axis_angle(axis_angle_to_matrix(axis, angle))
    assert abs(float(found_angle) - angle) < EXACT
    # the smaller the rotation, the less its matrix knows about its axis
    np.testing.assert_allclose(found_axis, axis, rtol=0, atol=EXACT + 1e-15 / angle)


@given(units())
def test_an_axis_turns_nothing_on_itself(axis: Array) -> None:
    np.testing.assert_allclose(axis_angle_to_matrix(axis, 1.0) @ axis, axis, rtol=0, atol=EXACT)


def test_a_turn_too_small_for_floats_to_hold_has_axis_z() -> None:
    axis, angle = matrix_to_axis_angle(axis_angle_to_matrix([0.0, 1.0, 1.0], 5e-324))
    assert axis.tolist() == [0.0, 0.0, 1.0]
    assert 0.0 < angle < 1e-300


def test_the_identity_has_axis_z_and_a_half_turn_the_positive_axis() -> None:
    axis, angle = matrix_to_axis_angle(np.eye(3))
    assert (axis.tolist(), float(angle)) == ([0.0, 0.0, 1.0], 0.0)
    for signs in ((1, 0, 0), (0, 1, 0), (0, 0, 1)):
        axis, angle = matrix_to_axis_angle(2.0 * np.diag(signs) - np.eye(3))
        assert (axis.tolist(), float(angle)) == (list(map(float, signs)), math.pi)


@given(rotations, rotations)
def test_rotation_angle_is_a_distance(A: Array, B: Array) -> None:
    between = float(rotation_angle(A.T @ B))
    assert abs(between - float(rotation_angle(B.T @ A))) < EXACT
    assert between <= float(rotation_angle(A)) + float(rotation_angle(B)) + EXACT
    assert float(rotation_angle(A.T @ A)) < EXACT


@given(angles)
def test_rotation_angle_is_what_was_turned(angle: float) -> None:
    turned = abs(math.remainder(angle, 2.0 * math.pi))
    assert abs(float(rotation_angle(axis_rotation("x", angle))) - turned) < EXACT


@given(rotations)
def test_rotations_are_recognised(R: Array) -> None:
    assert is_rotation(R)
    assert not is_rotation(-R)
    assert not is_rotation(R * 1.001)
    assert not is_rotation(R[::-1])
    assert not is_rotation(R + np.outer([1e-3, 0.0, 0.0], R[1]))


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_matrix_that_is_not_finite_is_no_rotation(value: float) -> None:
    for i, j in np.ndindex(3, 3):
        R = np.eye(3)
        R[i, j] = value
        assert not is_rotation(R)
        with pytest.raises(GeometryError, match="R"):
            matrix_to_axis_angle(R)


def test_a_row_of_a_batch_that_is_no_rotation_is_nan() -> None:
    axis, angle = matrix_to_axis_angle(np.stack([np.eye(3), 2.0 * np.eye(3), axis_rotation("x", 1.0)]))
    np.testing.assert_array_equal(np.isnan(angle), [False, True, False])
    np.testing.assert_array_equal(np.isnan(axis).all(axis=-1), [False, True, False])
    assert matrix_to_axis_angle(np.empty((0, 3, 3)))[0].shape == (0, 3)


@given(rotations, vectors(9, 0.1))
def test_the_nearest_rotation_is_the_orthogonal_polar_factor(R: Array, noise: Array) -> None:
    M = R + noise.reshape(3, 3)
    Q = nearest_rotation(M)
    assert is_rotation(Q, EXACT)
    stretch = Q.T @ M
    np.testing.assert_allclose(stretch, stretch.T, rtol=0, atol=EXACT)
    np.testing.assert_allclose(nearest_rotation(R), R, rtol=0, atol=EXACT)


@given(rotations, rotations)
def test_no_other_rotation_is_nearer(R: Array, other: Array) -> None:
    M = R @ np.diag([3.0, 2.0, -0.5])
    assert np.linalg.norm(nearest_rotation(M) - M) <= np.linalg.norm(other - M) + EXACT


@pytest.mark.parametrize("M", [np.zeros((3, 3)), np.diag([1.0, 0.0, 0.0]), -np.eye(3), np.full((3, 3), np.nan)])
def test_a_matrix_with_many_nearest_rotations_is_refused(M: Array) -> None:
    with pytest.raises(GeometryError, match="M"):
        nearest_rotation(M)


@given(vectors(3), vectors(3))
def test_skew_is_the_cross_product(a: Array, b: Array) -> None:
    np.testing.assert_allclose(skew(a) @ b, np.cross(a, b), rtol=0, atol=EXACT)
    np.testing.assert_array_equal(skew(np.stack([a, b]))[1], skew(b))


@given(directions(), st.floats(-140.0, 140.0))
def test_a_vector_of_any_length_but_zero_has_a_direction(v: Array, power: float) -> None:
    direction = v / np.linalg.norm(v)
    np.testing.assert_allclose(unit(v * 10.0**power), direction, rtol=0, atol=EXACT)
    batch = unit(np.stack([v * 10.0**power, np.zeros(3), np.full(3, np.nan)]))
    np.testing.assert_allclose(batch[0], direction, rtol=0, atol=EXACT)
    assert np.isnan(batch[1:]).all()


@pytest.mark.parametrize(
    "axis", [[0.0, 0.0, 0.0], [math.nan, 0.0, 1.0], [math.inf, 0.0, 0.0], [1.0, 0.0], [0.0, 1e-310, 0.0]]
)
def test_a_zero_axis_is_refused(axis: list[float]) -> None:
    with pytest.raises(GeometryError, match="axis"):
        axis_angle_to_matrix(axis, 1.0)


@given(units(), angles)
def test_a_batch_is_the_same_as_one_by_one(axis: Array, angle: float) -> None:
    batch = axis_angle_to_matrix(np.stack([axis, -axis]), np.array([angle, 1.0]))
    np.testing.assert_allclose(batch[0], axis_angle_to_matrix(axis, angle), rtol=0, atol=EXACT)
    np.testing.assert_allclose(batch[1], axis_angle_to_matrix(-axis, 1.0), rtol=0, atol=EXACT)


@given(units(), vectors(3), st.lists(angles, min_size=1, max_size=5))
def test_orbit_is_where_rotations_lead(axis: Array, point: Array, turns: list[float]) -> None:
    expected = [axis_angle_to_matrix(axis, turn) @ point for turn in turns]
    scale = 1.0 + float(np.abs(point).max())
    np.testing.assert_allclose(orbit(axis, point, turns), expected, rtol=0, atol=4 * EXACT * scale)


def test_orbit_refuses_a_zero_axis_and_what_is_not_finite() -> None:
    for axis, point, turns, wrong in (
        ([0, 0, 0], [1, 0, 0], [0.1], "axis"),
        ([0, 0, 1], [math.nan, 0, 0], [0.1], "point"),
        ([0, 0, 1], [1, 0, 0], [math.inf], "angles"),
    ):
        with pytest.raises(GeometryError, match=wrong):
            orbit(axis, point, turns)


@given(units(), units())
def test_the_shortest_turn_brings_one_direction_to_another(start: Array, end: Array) -> None:
    R = shortest_turn(3.0 * start, 0.5 * end)
    sine = float(np.linalg.norm(np.cross(start, end)))
    if sine > 1e-6 or start @ end > 0.0:
        np.testing.assert_allclose(R @ start, end, rtol=0, atol=1e-9)
        angle = math.atan2(sine, float(start @ end))
        assert Rotation.from_matrix(R).magnitude() == pytest.approx(angle, abs=1e-7)
    np.testing.assert_allclose(shortest_turn(start, -start), np.eye(3))
