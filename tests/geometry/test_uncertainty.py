"""How sure the point is: the propagated covariance, against differences and against noisy samples."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geometry import Array, GeometryError
from geometry.camera import Camera, parallel_rig
from geometry.triangulation import (
    covariance,
    depth_from_disparity,
    depth_sigma,
    disparity,
    ellipsoid_axes,
    monte_carlo,
    pixel_noise,
    projection_jacobian,
    triangulate_optimal,
)
from tests.geometry.strategies import near, seen_points

Seen = tuple[Camera, Camera, Array]
rigs = st.tuples(st.floats(0.05, 2.0), st.floats(200.0, 1500.0))
depths = st.floats(0.5, 50.0)


@given(seen_points)
def test_the_jacobian_is_what_small_steps_give(seen: Seen) -> None:
    left, _, point = seen
    step = 1e-6
    differences = [
        (left.project(point + step * axis)[0] - left.project(point - step * axis)[0]) / (2.0 * step)
        for axis in np.eye(3)
    ]
    J = projection_jacobian(left, point)
    np.testing.assert_allclose(J, np.transpose(differences), rtol=1e-5, atol=1e-5 * np.abs(J).max())


@given(seen_points, st.floats(0.01, 5.0))
def test_the_covariance_is_the_inverse_of_the_information(seen: Seen, sigma: float) -> None:
    left, right, point = seen
    C = covariance((left, right), point, sigma)
    J = np.concatenate([projection_jacobian(left, point), projection_jacobian(right, point)])
    np.testing.assert_allclose(C @ (J.T @ J) / sigma**2, np.eye(3), rtol=0, atol=1e-6)
    np.testing.assert_allclose(C, C.T, rtol=1e-12, atol=0)
    np.testing.assert_allclose(C, sigma**2 * covariance((left, right), point, 1.0), rtol=1e-9)


@given(seen_points)
def test_a_third_camera_never_hurts(seen: Seen) -> None:
    left, right, point = seen
    shrink = covariance((left, right), point, 1.0) - covariance((left, right, left), point, 1.0)
    assert np.linalg.eigvalsh(shrink).min() >= -1e-9 * np.abs(shrink).max() - 1e-15


@given(seen_points)
def test_the_axes_are_those_of_the_ellipsoid(seen: Seen) -> None:
    left, right, point = seen
    C = covariance((left, right), point, 1.0)
    lengths, axes = ellipsoid_axes(C)
    assert lengths[0] >= lengths[1] >= lengths[2] > 0.0
    np.testing.assert_allclose(axes.T @ axes, np.eye(3), rtol=0, atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    np.testing.assert_allclose(axes * lengths**2 @ axes.T, C, rtol=0, atol=1e-12 * C.max())


@given(rigs, depths, st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(0.1, 5.0))
def test_depth_sigma_is_the_covariances_wherever_the_point_is(
    rig: tuple[float, float], depth: float, x: float, y: float, sigma: float
) -> None:
    C = covariance(parallel_rig(*rig), [x * depth, depth, 1.0 + y * depth], sigma)
    np.testing.assert_allclose(depth_sigma(depth, *rig, sigma), math.sqrt(C[1, 1]), rtol=1e-9)


@given(rigs, depths, st.floats(-0.5, 0.5))
def test_halving_the_baseline_doubles_the_depth_sigma(rig: tuple[float, float], depth: float, x: float) -> None:
    baseline, focal = rig
    point = [x, depth, 1.2]
    wide, narrow = (math.sqrt(covariance(parallel_rig(b, focal), point, 1.0)[1, 1]) for b in (baseline, baseline / 2.0))
    assert abs(narrow / wide / 2.0 - 1.0) < 1e-9
    plot = depth_sigma(depth, baseline / 2.0, focal, 1.0) / depth_sigma(depth, baseline, focal, 1.0)
    assert abs(plot / 2.0 - 1.0) < 1e-9
    # the ellipsoid's long axis points along the depth as far as the point is straight ahead
    long = [
        ellipsoid_axes(covariance(parallel_rig(b, focal), [0.0, 10.0 * baseline, 1.0], 1.0))[0][0]
        for b in (baseline, baseline / 2.0)
    ]
    assert abs(long[1] / long[0] / 2.0 - 1.0) < 0.02


def test_samples_scatter_as_the_covariance_says() -> None:
    left, right = parallel_rig(0.6, 600.0)
    point = np.array([0.3, 4.0, 1.2])
    C = covariance((left, right), point, 0.5)
    samples = monte_carlo(left, right, left.project(point)[0], right.project(point)[0], 0.5, 20_000, 7)
    whiten = np.linalg.inv(np.linalg.cholesky(C))
    np.testing.assert_allclose(whiten @ np.cov(samples.T) @ whiten.T, np.eye(3), rtol=0, atol=0.1)
    np.testing.assert_allclose(np.cov(samples.T), C, rtol=0.1, atol=0.1 * C.max())
    np.testing.assert_allclose(whiten @ (samples.mean(axis=0) - point), np.zeros(3), rtol=0, atol=0.1)


def test_the_same_seed_gives_the_same_samples_and_they_move_smoothly_with_sigma() -> None:
    left, right = parallel_rig(0.6, 600.0)
    pixels = [400.0, 240.0], [320.0, 240.0]
    first = monte_carlo(left, right, *pixels, 1.0, 300, 3)
    np.testing.assert_array_equal(first, monte_carlo(left, right, *pixels, 1.0, 300, 3))
    assert np.abs(first - monte_carlo(left, right, *pixels, 1.0, 300, 4)).max() > 0.01
    assert np.abs(first - monte_carlo(left, right, *pixels, 1.0 + 1e-9, 300, 3)).max() < 1e-6
    point = triangulate_optimal(left, right, *pixels).point
    np.testing.assert_allclose(monte_carlo(left, right, *pixels, 0.0, 5, 3), np.tile(point, (5, 1)), atol=1e-12)


def test_noise_is_standard_normal_and_its_first_draws_do_not_depend_on_the_count() -> None:
    noise = pixel_noise(10_000, 5)
    assert noise.shape == (10_000, 2, 2)
    np.testing.assert_allclose(noise.mean(axis=0), np.zeros((2, 2)), atol=0.05)
    np.testing.assert_allclose(np.cov(noise.reshape(-1, 4).T), np.eye(4), atol=0.05)
    np.testing.assert_array_equal(pixel_noise(3, 5), noise[:3])


def test_samples_without_a_point_are_nan() -> None:
    left, right = parallel_rig(0.6, 600.0)
    samples = monte_carlo(left, right, [320.5, 240.0], [320.0, 240.0], 1.0, 300, 0)
    missing = np.isnan(samples)
    np.testing.assert_array_equal(missing.any(axis=-1), missing.all(axis=-1))
    assert 0 < missing.all(axis=-1).sum() < 300


@given(near(0.0).map(abs).filter(bool), st.floats(1.0, 10.0))
def test_the_covariance_holds_for_the_smallest_parallax(parallax: float, depth: float) -> None:
    C = covariance(parallel_rig(parallax * depth, 600.0), [0.0, depth, 1.0], 1.0)
    expected = depth_sigma(depth, parallax * depth, 600.0, 1.0)
    np.testing.assert_allclose(math.sqrt(C[1, 1]), expected, rtol=1e-5)


def test_points_that_the_cameras_do_not_fix_have_no_covariance() -> None:
    left, right = parallel_rig(0.6, 600.0)
    points = np.array([[0.0, 4.0, 1.0], [0.0, -4.0, 1.0], [0.0, 0.0, 1.0], [math.nan, 4.0, 1.0]])
    C = covariance((left, right), points, 1.0)
    np.testing.assert_array_equal(np.isnan(C).all(axis=(-2, -1)), [False, True, True, True])
    lengths, axes = ellipsoid_axes(C)
    np.testing.assert_array_equal(np.isnan(lengths).all(axis=-1), [False, True, True, True])
    np.testing.assert_array_equal(np.isnan(axes).all(axis=(-2, -1)), [False, True, True, True])
    np.testing.assert_allclose(C[0], covariance((left, right), points[0], 1.0), rtol=1e-12)
    assert np.isnan(covariance(parallel_rig(0.0, 600.0), points[0], 1.0)).all()
    between = Camera(left.K, np.diag([-1.0, 1.0, -1.0, 1.0]))
    ahead = Camera(left.K, np.eye(4))
    assert np.isnan(covariance((ahead, between), [0.0, 0.0, 2.0], 1.0)).all()


@given(rigs, depths, st.floats(-0.4, 0.4))
def test_depth_from_disparity_is_the_depth(rig: tuple[float, float], depth: float, x: float) -> None:
    left, right = parallel_rig(*rig)
    point = [x * depth, depth, 1.1]
    found = depth_from_disparity(disparity(left.project(point)[0], right.project(point)[0]), *rig)
    np.testing.assert_allclose(found, depth, rtol=1e-9)


@given(near(0.0))
def test_only_a_disparity_above_zero_has_a_depth(d: float) -> None:
    depth = depth_from_disparity([d, -d], 0.6, 600.0)
    np.testing.assert_array_equal(np.isnan(depth), [d <= 0.0, d >= 0.0])
    assert np.isnan(depth_from_disparity(math.nan, 0.6, 600.0))
    np.testing.assert_array_equal(np.isnan(depth_sigma([d, -d, math.nan], 0.6, 600.0, 1.0)), [d <= 0.0, d >= 0.0, True])


@pytest.mark.parametrize("bad", [0.0, -1.0, math.nan, math.inf])
def test_scales_that_are_not_above_zero_are_refused(bad: float) -> None:
    rig = parallel_rig(0.6, 600.0)
    point = [0.0, 4.0, 1.0]
    calls: list[tuple[str, Callable[[], Array]]] = [
        ("baseline", lambda: depth_from_disparity(10.0, bad, 600.0)),
        ("focal", lambda: depth_from_disparity(10.0, 0.6, bad)),
        ("baseline", lambda: depth_sigma(4.0, bad, 600.0, 1.0)),
        ("focal", lambda: depth_sigma(4.0, 0.6, bad, 1.0)),
        ("sigma", lambda: depth_sigma(4.0, 0.6, 600.0, bad)),
        ("sigma_px", lambda: covariance(rig, point, bad)),
    ]
    for argument, call in calls:
        with pytest.raises(GeometryError) as caught:
            call()
        assert caught.value.argument == argument


@pytest.mark.parametrize("bad", [-1.0, math.nan, math.inf])
def test_samples_of_a_bad_sigma_are_refused(bad: float) -> None:
    with pytest.raises(GeometryError, match="sigma"):
        monte_carlo(*parallel_rig(0.6, 600.0), [400.0, 240.0], [320.0, 240.0], bad, 10, 0)


def test_one_camera_is_not_enough() -> None:
    with pytest.raises(GeometryError, match="cameras"):
        covariance(parallel_rig(0.6, 600.0)[:1], [0.0, 4.0, 1.0], 1.0)
