"""Quaternions against SciPy, and by their algebra."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from geometry import Array, GeometryError, quaternion
from geometry.rotations import axis_rotation
from tests.geometry.strategies import EXACT, angles, axis_letters, directions, near, rotations, units, vectors

quaternions = directions(4)
unit_quaternions = units(4)


def distance(p: Array, q: Array) -> float:
    """How far two quaternions are as rotations: q and −q are the same."""
    p, q = p / np.linalg.norm(p), q / np.linalg.norm(q)
    return float(min(np.abs(p - q).max(), np.abs(p + q).max()))


def scipys(q: Array) -> Rotation:
    return Rotation.from_quat(q, scalar_first=True)


@given(quaternions)
def test_the_matrix_is_scipys(q: Array) -> None:
    np.testing.assert_allclose(quaternion.to_matrix(q), scipys(q).as_matrix(), rtol=0, atol=EXACT)


@given(quaternions)
def test_q_and_minus_q_are_one_rotation(q: Array) -> None:
    np.testing.assert_array_equal(quaternion.to_matrix(q), quaternion.to_matrix(-q))


@given(rotations)
def test_matrix_round_trip(R: Array) -> None:
    q = quaternion.from_matrix(R)
    np.testing.assert_allclose(quaternion.to_matrix(q), R, rtol=0, atol=EXACT)
    assert abs(np.linalg.norm(q) - 1.0) < EXACT
    assert q[np.flatnonzero(q)[0]] > 0.0


@given(units(), near(0.0, math.pi, -math.pi, 2.0 * math.pi))
def test_matrix_round_trip_at_the_identity_and_at_half_turns(axis: Array, angle: float) -> None:
    q = quaternion.from_axis_angle(axis, angle)
    assert distance(quaternion.from_matrix(quaternion.to_matrix(q)), q) < EXACT


def test_half_turns_about_the_coordinate_axes_are_exact() -> None:
    for i in range(3):
        R = -np.eye(3)
        R[i, i] = 1.0
        np.testing.assert_array_equal(quaternion.from_matrix(R), np.eye(4)[i + 1])
    np.testing.assert_array_equal(quaternion.from_matrix(np.eye(3)), np.eye(4)[0])


@given(units(), angles)
def test_axis_and_angle_make_the_half_angle_quaternion(axis: Array, angle: float) -> None:
    q = quaternion.from_axis_angle(3.0 * axis, angle)
    expected = [math.cos(angle / 2.0), *(math.sin(angle / 2.0) * axis)]
    np.testing.assert_allclose(q, expected, rtol=0, atol=EXACT)
    np.testing.assert_allclose(quaternion.from_axis_angle(axis, angle + 2.0 * math.pi), -q, rtol=0, atol=EXACT)


@given(unit_quaternions)
def test_axis_and_angle_rebuild_the_quaternion_with_its_sign(q: Array) -> None:
    axis, angle = quaternion.to_axis_angle(q)
    np.testing.assert_allclose(quaternion.from_axis_angle(axis, float(angle)), q, rtol=0, atol=EXACT)
    assert 0.0 <= angle <= 2.0 * math.pi
    assert abs(np.linalg.norm(axis) - 1.0) < EXACT


@given(units(), st.floats(1e-9, 1e-6))
def test_the_smallest_turns_keep_axis_and_angle(axis: Array, angle: float) -> None:
    found_axis, found_angle = quaternion.to_axis_angle(quaternion.from_axis_angle(axis, angle))
    np.testing.assert_allclose(found_axis, axis, rtol=0, atol=EXACT)
    assert abs(float(found_angle) / angle - 1.0) < EXACT


def test_no_turn_has_axis_z() -> None:
    for q, turn in (
        ([1.0, 0.0, 0.0, 0.0], 0.0),
        ([1.0, 5e-324, 5e-324, 0.0], 1e-323),
        ([-1.0, 0.0, 0.0, 0.0], 2.0 * math.pi),
    ):
        axis, angle = quaternion.to_axis_angle(q)
        assert (axis.tolist(), float(angle)) == ([0.0, 0.0, 1.0], turn)


@given(axis_letters, angles)
def test_axis_quaternion_turns_about_a_coordinate_axis(axis: str, angle: float) -> None:
    q = quaternion.axis_quaternion(axis, angle)
    assert all(type(component) is float for component in q)
    np.testing.assert_allclose(quaternion.to_matrix(q), axis_rotation(axis, angle), rtol=0, atol=EXACT)


@given(unit_quaternions, unit_quaternions)
def test_the_product_composes_rotations(p: Array, q: Array) -> None:
    product = quaternion.multiply(p, q)
    expected = quaternion.to_matrix(p) @ quaternion.to_matrix(q)
    np.testing.assert_allclose(quaternion.to_matrix(product), expected, rtol=0, atol=EXACT)
    assert distance(product, (scipys(p) * scipys(q)).as_quat(scalar_first=True)) < EXACT


@given(quaternions, quaternions, quaternions)
def test_the_product_is_associative_and_keeps_length(p: Array, q: Array, r: Array) -> None:
    left = quaternion.multiply(quaternion.multiply(p, q), r)
    right = quaternion.multiply(p, quaternion.multiply(q, r))
    np.testing.assert_allclose(left, right, rtol=0, atol=EXACT)
    lengths = np.linalg.norm(p) * np.linalg.norm(q)
    assert abs(np.linalg.norm(quaternion.multiply(p, q)) - lengths) < EXACT


def test_hamiltons_rule() -> None:
    one, i, j, k = np.eye(4)
    for a, b, product in ((i, j, k), (j, k, i), (k, i, j), (j, i, -k), (i, i, -one), (one, k, k)):
        np.testing.assert_array_equal(quaternion.multiply(a, b), product)


@given(unit_quaternions, unit_quaternions)
def test_the_conjugate_inverts_and_reverses_products(p: Array, q: Array) -> None:
    np.testing.assert_allclose(
        quaternion.multiply(q, quaternion.conjugate(q)), [1.0, 0.0, 0.0, 0.0], rtol=0, atol=EXACT
    )
    reverse = quaternion.multiply(quaternion.conjugate(q), quaternion.conjugate(p))
    np.testing.assert_allclose(quaternion.conjugate(quaternion.multiply(p, q)), reverse, rtol=0, atol=EXACT)


@given(quaternions, vectors(3, 10.0))
def test_rotate_is_the_sandwich_of_the_unit_quaternion(q: Array, point: Array) -> None:
    u = q / np.linalg.norm(q)
    sandwich = quaternion.multiply(quaternion.multiply(u, [0.0, *point]), quaternion.conjugate(u))
    turned = quaternion.rotate(q, point)
    np.testing.assert_allclose(turned, sandwich[1:], rtol=0, atol=10.0 * EXACT)
    np.testing.assert_allclose(turned, quaternion.to_matrix(q) @ point, rtol=0, atol=10.0 * EXACT)
    assert abs(np.linalg.norm(turned) - np.linalg.norm(point)) < 10.0 * EXACT


@given(quaternions)
def test_normalize_keeps_direction_and_sign(q: Array) -> None:
    unit = quaternion.normalize(q)
    assert abs(np.linalg.norm(unit) - 1.0) < EXACT
    np.testing.assert_allclose(unit * np.linalg.norm(q), q, rtol=0, atol=EXACT)


ZERO = [0.0, 0.0, 0.0, 0.0]
NOT_FINITE = [math.nan, 0.0, 0.0, 1.0]


@pytest.mark.parametrize("q", [ZERO, NOT_FINITE, [math.inf, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
def test_what_is_no_rotation_is_refused(q: list[float]) -> None:
    for function in (quaternion.normalize, quaternion.to_matrix, quaternion.to_axis_angle):
        with pytest.raises(GeometryError, match="q is"):
            function(q)
    with pytest.raises(GeometryError, match="q is"):
        quaternion.rotate(q, [1.0, 0.0, 0.0])


def test_a_zero_axis_an_unknown_axis_and_a_bad_matrix_are_refused() -> None:
    with pytest.raises(GeometryError, match="axis"):
        quaternion.from_axis_angle([0.0, 0.0, 0.0], 1.0)
    with pytest.raises(GeometryError, match="axis"):
        quaternion.axis_quaternion("w", 1.0)
    with pytest.raises(GeometryError, match="angle"):
        quaternion.axis_quaternion("x", math.nan)
    with pytest.raises(GeometryError, match="R is"):
        quaternion.from_matrix(np.diag([1.0, 1.0, -1.0]))


def test_a_failing_row_of_a_batch_is_nan() -> None:
    batch = np.array([[1.0, 0.0, 0.0, 0.0], ZERO, NOT_FINITE, [0.0, 2.0, 0.0, 0.0]])
    bad = np.array([False, True, True, False])
    np.testing.assert_array_equal(np.isnan(quaternion.normalize(batch)).all(axis=-1), bad)
    np.testing.assert_array_equal(np.isnan(quaternion.to_axis_angle(batch)[1]), bad)
    np.testing.assert_array_equal(np.isnan(quaternion.to_matrix(batch)).any(axis=(-2, -1)), bad)
    matrices = np.stack([np.eye(3), np.zeros((3, 3))])
    np.testing.assert_array_equal(np.isnan(quaternion.from_matrix(matrices)).all(axis=-1), [False, True])


@given(st.lists(unit_quaternions, min_size=2, max_size=4), vectors(3))
def test_a_batch_is_the_same_as_one_by_one(listed: list[Array], point: Array) -> None:
    batch = np.stack(listed)
    matrices = quaternion.to_matrix(batch)
    for row, q in enumerate(listed):
        np.testing.assert_allclose(matrices[row], quaternion.to_matrix(q), rtol=0, atol=EXACT)
        np.testing.assert_allclose(quaternion.from_matrix(matrices)[row], quaternion.from_matrix(matrices[row]))
        np.testing.assert_allclose(
            quaternion.multiply(batch, listed[0])[row], quaternion.multiply(q, listed[0]), rtol=0, atol=EXACT
        )
        np.testing.assert_allclose(
            quaternion.rotate(batch, point)[row], quaternion.rotate(q, point), rtol=0, atol=EXACT
        )
