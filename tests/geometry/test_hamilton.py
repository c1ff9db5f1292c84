"""The parts of the algebra add up to the whole."""

import math

import numpy as np
import pytest
from hypothesis import given
from scipy.spatial.transform import Rotation

from geometry import Array, GeometryError, hamilton, quaternion
from tests.geometry.strategies import EXACT, angles, directions, near, units, vectors


@given(vectors(4, 3.0), vectors(4, 3.0))
def test_the_terms_add_up_to_the_product(p: Array, q: Array) -> None:
    terms = hamilton.product_terms(p, q)
    np.testing.assert_allclose(terms.sum(axis=-1), quaternion.multiply(p, q), rtol=0, atol=EXACT)
    np.testing.assert_allclose(np.abs(terms), np.abs(p * q[np.array(hamilton.PARTNERS)]), rtol=0, atol=0)


def test_the_terms_follow_hamilton_s_rules() -> None:
    one, i, j, k = np.eye(4)
    for a, b, c in ((i, j, k), (j, k, i), (k, i, j)):
        np.testing.assert_array_equal(hamilton.product_terms(a, b).sum(axis=-1), c)
        np.testing.assert_array_equal(hamilton.product_terms(b, a).sum(axis=-1), -c)
        np.testing.assert_array_equal(hamilton.product_terms(a, a).sum(axis=-1), -one)


@given(directions(4), vectors(3, 5.0))
def test_the_sandwich_turns_the_point(q: Array, point: Array) -> None:
    steps = hamilton.sandwich(q, point)
    turned = Rotation.from_quat(q, scalar_first=True).apply(point)
    np.testing.assert_allclose(steps.rotated, [0.0, *turned], rtol=0, atol=10 * EXACT)
    np.testing.assert_array_equal(steps.p, [0.0, *point])
    np.testing.assert_allclose(steps.q_p, quaternion.multiply(steps.q, steps.p), rtol=0, atol=EXACT)
    np.testing.assert_allclose(quaternion.multiply(steps.q, steps.q_conjugate), [1.0, 0, 0, 0], rtol=0, atol=EXACT)
    np.testing.assert_allclose(hamilton.sandwich(-q, point).rotated, steps.rotated, rtol=0, atol=EXACT)


@given(units(), angles)
def test_a_turn_is_at_the_tangent_of_its_quarter(axis: Array, angle: float) -> None:
    if abs(math.remainder(angle, 4.0 * math.pi)) < 1.99 * math.pi:
        point, finite = hamilton.to_ball(quaternion.from_axis_angle(axis, angle))
        assert finite
        np.testing.assert_allclose(point, math.tan(0.25 * angle) * axis, rtol=1e-9, atol=EXACT)


@given(units(4))
def test_the_ball_holds_the_whole_quaternion(q: Array) -> None:
    point, finite = hamilton.to_ball(q)
    if finite:
        square = point @ point
        if square < 1e8:
            np.testing.assert_allclose(np.array([1.0 - square, *(2.0 * point)]) / (1.0 + square), q, rtol=0, atol=EXACT)
        assert bool(square <= 1.0 + EXACT) is bool(q[0] >= -EXACT)
    opposite, both = hamilton.to_ball(-q)
    if finite and both and point.any():
        np.testing.assert_allclose(opposite * (point @ point), -point, rtol=0, atol=EXACT * float(1.0 + point @ point))


@given(vectors(3, 9.0))
def test_a_point_of_the_ball_is_scipys_modified_rodrigues_vector(point: Array) -> None:
    q = hamilton.from_ball(point)
    np.testing.assert_allclose(np.linalg.norm(q), 1.0, rtol=0, atol=EXACT)
    assert bool(q[0] >= 0.0) is bool(point @ point <= 1.0)
    theirs = Rotation.from_mrp(point).as_matrix()
    np.testing.assert_allclose(quaternion.to_matrix(q), theirs, rtol=0, atol=10 * EXACT)
    back, finite = hamilton.to_ball(q)
    assert finite
    np.testing.assert_allclose(back, point, rtol=0, atol=EXACT * float(1.0 + point @ point) ** 2)


def test_points_of_the_ball_are_taken_many_at_once_and_must_be_finite() -> None:
    points = np.array([[0.0, 0, 0], [0.0, 1.0, 0], [0.0, 0, -2.0]])
    known = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [-0.6, 0.0, 0.0, -0.8]])
    np.testing.assert_allclose(hamilton.from_ball(points), known, rtol=0, atol=EXACT)
    with pytest.raises(GeometryError, match="points"):
        hamilton.from_ball([0.0, math.nan, 0.0])


@given(units(), near(2.0 * math.pi))
def test_near_minus_one_the_point_keeps_its_digits(axis: Array, angle: float) -> None:
    q = quaternion.from_axis_angle(axis, angle)
    point, finite = hamilton.to_ball(q)
    assert finite
    np.testing.assert_allclose(point * np.linalg.norm(q[1:]) ** 2, 2.0 * q[1:], rtol=1e-9, atol=0)


def test_minus_one_is_at_infinity_and_one_at_the_centre() -> None:
    point, finite = hamilton.to_ball([-1.0, 0.0, 0.0, 0.0])
    assert not finite
    assert np.isnan(point).all()
    points, mask = hamilton.to_ball(
        [[1.0, 0, 0, 0], [-2.0, 0, 0, 0], [0.0, 0, 3.0, 0], [0.0, 0, 0, 0], [-0.6, 0.8, 0, 0]]
    )
    np.testing.assert_array_equal(mask, [True, False, True, False, True])
    np.testing.assert_array_equal(points[[0, 2]], [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    np.testing.assert_allclose(points[4], [2.0, 0.0, 0.0], rtol=EXACT)
    assert np.isnan(points[[1, 3]]).all()


def test_batches_broadcast() -> None:
    q, points = np.arange(1.0, 9.0).reshape(2, 4), np.arange(6.0).reshape(2, 3)
    steps = hamilton.sandwich(q[:, None], points)
    assert steps.rotated.shape == (2, 2, 4)
    np.testing.assert_allclose(steps.rotated[1, 0], hamilton.sandwich(q[1], points[0]).rotated, rtol=0, atol=EXACT)
    np.testing.assert_array_equal(hamilton.product_terms(q, q[0])[1], hamilton.product_terms(q[1], q[0]))


def test_a_zero_quaternion_is_refused() -> None:
    for call in (lambda: hamilton.sandwich([0.0] * 4, [1.0, 0, 0]), lambda: hamilton.to_ball([0.0] * 4)):
        with pytest.raises(GeometryError, match="q is"):
            call()
    assert np.isnan(hamilton.sandwich(np.zeros((2, 4)), [1.0, 0.0, 0.0]).rotated).all()
