"""The rings against the singular value decomposition, and at lock against the rotation itself."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from geometry import Array, GeometryError, gimbal
from tests.geometry.strategies import EXACT, angles, near

LOCKS = (-1.5 * math.pi, -0.5 * math.pi, 0.5 * math.pi, 1.5 * math.pi)
locks = st.sampled_from(LOCKS)
near_lock = near(*LOCKS)


def rotation(yaw: float, pitch: float, roll: float) -> Array:
    return np.asarray(Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_matrix())


@given(angles, angles, angles)
def test_columns_are_the_axes_about_which_the_rings_turn(yaw: float, pitch: float, roll: float) -> None:
    axes = gimbal.ring_axes(yaw, pitch)
    R, step = rotation(yaw, pitch, roll), 1e-6
    for i in range(3):
        ahead, behind = (np.array([yaw, pitch, roll]) + sign * step * np.eye(3)[i] for sign in (1.0, -1.0))
        spin = (rotation(*ahead) - rotation(*behind)) / (2.0 * step) @ R.T
        np.testing.assert_allclose([spin[2, 1], spin[0, 2], spin[1, 0]], axes[:, i], rtol=0, atol=1e-8)


def test_rings_are_perpendicular_at_zero() -> None:
    np.testing.assert_array_equal(gimbal.ring_axes(0.0, 0.0), [[0, 0, 1], [0, 1, 0], [1, 0, 0]])


@given(angles, locks)
def test_outer_and_inner_ring_are_parallel_at_lock(yaw: float, pitch: float) -> None:
    axes = gimbal.ring_axes(yaw, pitch)
    np.testing.assert_allclose(axes[:, 2], -math.copysign(1.0, math.sin(pitch)) * axes[:, 0], rtol=0, atol=EXACT)
    np.testing.assert_allclose(axes[:, 1] @ axes[:, 0], 0.0, rtol=0, atol=EXACT)


@given(angles, angles | near_lock)
def test_singular_values_and_ellipsoid_are_those_of_the_axes(yaw: float, pitch: float) -> None:
    axes = gimbal.ring_axes(yaw, pitch)
    values, (directions, lengths) = gimbal.singular_values(pitch), gimbal.ellipsoid(yaw, pitch)
    np.testing.assert_allclose(values, np.linalg.svd(axes, compute_uv=False), rtol=0, atol=EXACT)
    np.testing.assert_array_equal(lengths, values)
    assert (np.diff(values) <= 0.0).all()
    np.testing.assert_allclose(directions.T @ directions, np.eye(3), rtol=0, atol=EXACT)
    np.testing.assert_allclose(np.linalg.det(directions), 1.0, rtol=0, atol=EXACT)
    np.testing.assert_allclose(directions * lengths**2 @ directions.T, axes @ axes.T, rtol=0, atol=EXACT)


@given(near_lock)
def test_the_smallest_singular_value_keeps_its_digits_at_lock(pitch: float) -> None:
    off = abs(math.remainder(pitch - 0.5 * math.pi, math.pi))
    assert gimbal.singular_values(pitch)[2] == pytest.approx(math.sqrt(2.0) * math.sin(0.5 * off), rel=1e-6, abs=1e-15)


@given(angles, angles | near_lock)
def test_conditioning_is_the_determinant(yaw: float, pitch: float) -> None:
    axes = gimbal.ring_axes(yaw, pitch)
    assert gimbal.conditioning(pitch) == pytest.approx(abs(np.linalg.det(axes)), rel=0, abs=EXACT)
    assert gimbal.conditioning(pitch) == pytest.approx(gimbal.singular_values(pitch).prod(), rel=0, abs=EXACT)


velocities = st.tuples(*[st.floats(-10.0, 10.0)] * 3)


@given(angles, angles, velocities)
def test_ring_rates_are_those_of_the_pseudoinverse(yaw: float, pitch: float, velocity: tuple[float, ...]) -> None:
    axes, values = gimbal.ring_axes(yaw, pitch), gimbal.singular_values(pitch)
    if abs(values[2] / values[0] - gimbal.RANK) > 1e-9:
        rates = gimbal.ring_rates(yaw, pitch, velocity)
        expected = np.linalg.pinv(axes, rcond=gimbal.RANK) @ velocity
        np.testing.assert_allclose(rates, expected, rtol=1e-9, atol=1e-12 * (1.0 + np.abs(expected).max()))


@given(angles, near(*LOCKS), velocities)
def test_ring_rates_grow_towards_lock_and_turn_as_wanted(yaw: float, pitch: float, velocity: tuple[float, ...]) -> None:
    axes, (directions, lengths) = gimbal.ring_axes(yaw, pitch), gimbal.ellipsoid(yaw, pitch)
    rates = gimbal.ring_rates(yaw, pitch, velocity)
    kept = directions[:, : gimbal.degrees_of_freedom(lengths)]
    np.testing.assert_allclose(kept.T @ axes @ rates, kept.T @ velocity, rtol=0, atol=1e-6)


@given(angles, locks)
def test_no_ring_rates_turn_about_the_lost_axis(yaw: float, pitch: float) -> None:
    rates = gimbal.ring_rates(yaw, pitch, gimbal.ellipsoid(yaw, pitch).directions[:, 2])
    np.testing.assert_allclose(rates, 0.0, rtol=0, atol=EXACT)


def test_ring_rates_of_a_batch() -> None:
    yaw, pitch = np.array([0.3, -1.0, 2.0]), np.array([0.5, math.pi / 2, math.nan])
    velocity = np.array([[1.0, 2.0, 3.0], [0.0, 1.0, -1.0], [1.0, 0.0, 0.0]])
    rates = gimbal.ring_rates(yaw, pitch, velocity)
    for i in range(2):
        np.testing.assert_allclose(rates[i], gimbal.ring_rates(yaw[i], pitch[i], velocity[i]), rtol=0, atol=EXACT)
    assert np.isnan(rates[2]).all()
    with pytest.raises(GeometryError, match="velocity"):
        gimbal.ring_rates(0.0, 0.0, [1.0, 2.0])


@given(angles, angles | near_lock)
def test_degrees_of_freedom_are_the_rank(yaw: float, pitch: float) -> None:
    axes = gimbal.ring_axes(yaw, pitch)
    values = gimbal.singular_values(pitch)
    if abs(values[2] / values[0] - gimbal.RANK) > 1e-12:
        assert gimbal.degrees_of_freedom(values) == np.linalg.matrix_rank(axes, rtol=gimbal.RANK)


@pytest.mark.parametrize(("degrees", "freedom"), [(0, 3), (45, 3), (89.999, 3), (90, 2), (-90, 2), (180, 3), (-180, 3)])
def test_degrees_of_freedom_at_the_slider_s_values(degrees: float, freedom: int) -> None:
    assert gimbal.degrees_of_freedom(gimbal.singular_values(math.radians(degrees))) == freedom


def test_degrees_of_freedom_of_any_singular_values() -> None:
    values = [[3.0, 2.0, 1.0], [1.0, 1.1e-6, 0.0], [1.0, 1e-6, 0.0], [0.0, 0.0, 0.0], [math.nan] * 3]
    np.testing.assert_array_equal(gimbal.degrees_of_freedom(values), [3, 2, 1, 0, 0])


@given(angles, near_lock | angles)
def test_no_ring_turns_about_the_lost_axis(yaw: float, pitch: float) -> None:
    lost = gimbal.lost_axis(yaw, pitch)
    assert (lost is None) is bool(gimbal.degrees_of_freedom(gimbal.singular_values(pitch)) == 3)
    if lost is not None:
        assert np.linalg.norm(lost) == pytest.approx(1.0, rel=0, abs=EXACT)
        np.testing.assert_allclose(lost @ gimbal.ring_axes(yaw, pitch), 0.0, rtol=0, atol=3e-6)
        np.testing.assert_allclose(lost, [math.cos(yaw), math.sin(yaw), 0.0], rtol=0, atol=2e-6)


@given(angles, near_lock)
def test_the_thinnest_axis_doesn_t_flip_through_lock(yaw: float, pitch: float) -> None:
    thin = gimbal.ellipsoid(yaw, pitch).directions[:, 2]
    beyond = gimbal.ellipsoid(yaw + 1e-6, 2.0 * math.pi * round(pitch / math.pi) + math.pi - pitch).directions[:, 2]
    np.testing.assert_allclose(thin, beyond, rtol=0, atol=1e-5)


@given(angles, angles, near_lock)
def test_at_lock_the_reduced_form_is_the_rotation(yaw: float, roll: float, pitch: float) -> None:
    lock = gimbal.at_lock(yaw, pitch, roll)
    assert (lock is None) is (gimbal.lost_axis(yaw, pitch) is None)
    if lock is not None:
        np.testing.assert_allclose(lock.R, rotation(yaw, pitch, roll), rtol=0, atol=3e-6)
        assert np.count_nonzero(lock.R[[0, 1, 2, 2], [0, 0, 1, 2]]) == 0
        assert -math.pi <= lock.angle <= math.pi


@given(angles, angles, angles, locks)
def test_at_lock_only_one_combination_counts(yaw: float, roll: float, more: float, pitch: float) -> None:
    lock = gimbal.at_lock(yaw, pitch, roll)
    assert lock is not None
    np.testing.assert_allclose(lock.R, rotation(yaw, pitch, roll), rtol=0, atol=EXACT)
    other = gimbal.at_lock(yaw + more, pitch, roll + lock.end * more)
    assert other is not None
    np.testing.assert_allclose(lock.R, other.R, rtol=0, atol=EXACT)
    assert math.remainder(lock.angle - other.angle, 2.0 * math.pi) == pytest.approx(0.0, abs=EXACT)


def test_the_signs_of_the_reduced_form() -> None:
    for end in (1, -1):
        lock = gimbal.at_lock(0.7, end * 0.5 * math.pi, 0.4)
        assert lock is not None
        a = 0.7 - end * 0.4
        assert lock.end == end
        assert lock.angle == pytest.approx(a)
        expected = np.array(
            [[0.0, -math.sin(a), end * math.cos(a)], [0.0, math.cos(a), end * math.sin(a)], [-end, 0.0, 0.0]]
        )
        np.testing.assert_allclose(lock.R, expected, rtol=0, atol=EXACT)


def test_batches_are_the_single_ones() -> None:
    yaw, pitch = np.array([0.0, 1.0, -2.0, 0.3, math.nan]), np.array([0.0, 0.5 * math.pi, -0.5 * math.pi, 4.0, 0.0])
    ball, lost = gimbal.ellipsoid(yaw, pitch), gimbal.lost_axis(yaw, pitch)
    assert lost is not None
    for i, (y, p) in enumerate(zip(yaw[:4].tolist(), pitch[:4].tolist(), strict=True)):
        np.testing.assert_allclose(gimbal.ring_axes(yaw, pitch)[i], gimbal.ring_axes(y, p), rtol=0, atol=1e-15)
        np.testing.assert_allclose(ball.directions[i], gimbal.ellipsoid(y, p).directions, rtol=0, atol=1e-15)
        np.testing.assert_allclose(ball.lengths[i], gimbal.singular_values(p), rtol=0, atol=1e-15)
        one = gimbal.lost_axis(y, p)
        np.testing.assert_allclose(lost[i], [math.nan] * 3 if one is None else one, rtol=0, atol=1e-15)
    assert np.isnan(gimbal.ring_axes(yaw, pitch)[4]).all()
    assert np.isnan(lost[4]).all()
    assert gimbal.ring_axes(yaw, 0.2).shape == (5, 3, 3)
    assert gimbal.ellipsoid(0.1, pitch).directions.shape == (5, 3, 3)
    np.testing.assert_array_equal(gimbal.conditioning(pitch), np.abs(np.cos(pitch)))


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_an_angle_that_isn_t_finite_is_refused(bad: float) -> None:
    with pytest.raises(GeometryError, match="pitch"):
        gimbal.singular_values(bad)
    with pytest.raises(GeometryError, match="yaw"):
        gimbal.ring_axes(bad, 0.0)
    with pytest.raises(GeometryError, match="roll"):
        gimbal.at_lock(0.0, 0.5 * math.pi, bad)
