"""The optimal method: no other point comes nearer to the measured pixels."""

import math

import cv2
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from geometry import Array
from geometry.camera import Camera, parallel_rig
from geometry.epipolar import fundamental
from geometry.triangulation import (
    correct_matches,
    projection_jacobian,
    reprojection_errors,
    triangulate_dlt,
    triangulate_midpoint,
    triangulate_optimal,
)
from tests.geometry.strategies import seen_points, stereo_pairs, vectors

Pair = tuple[Camera, Camera]
Seen = tuple[Camera, Camera, Array]
noises = vectors(4, 20.0)
pixels = st.tuples(st.floats(0.0, 640.0), st.floats(0.0, 480.0)).map(np.array)


def noisy(seen: Seen, noise: Array) -> tuple[Array, Array]:
    left, right, point = seen
    return left.project(point)[0] + noise[:2], right.project(point)[0] + noise[2:]


def correction(pair: Pair, uv_left: Array, uv_right: Array) -> float:
    corrected_left, corrected_right = correct_matches(*pair, uv_left, uv_right)
    return math.hypot(*(corrected_left - uv_left), *(corrected_right - uv_right))


def least_by_scan(pair: Pair, uv_left: Array, uv_right: Array, count: int = 4000) -> float:
    """The least distance over epipolar planes turned about the baseline: an upper bound of the true one."""
    left, right = pair
    across = np.linalg.svd((right.center - left.center)[None])[2][1:]
    turns = np.linspace(0.0, math.pi, count, endpoint=False)[:, None]
    normals = np.cos(turns) * across[0] + np.sin(turns) * across[1]
    squares = np.zeros(count)
    for camera, uv in ((left, uv_left), (right, uv_right)):
        lines = normals @ camera.back_projection
        squares += (lines @ [*uv, 1.0]) ** 2 / (lines[:, :2] ** 2).sum(axis=-1)
    return math.sqrt(squares.min())


@given(seen_points, noises)
def test_no_other_method_reprojects_better(seen: Seen, noise: Array) -> None:
    left, right, _ = seen
    measured = noisy(seen, noise)
    best = triangulate_optimal(left, right, *measured)
    for other in (triangulate_dlt(left, right, *measured), triangulate_midpoint(left, right, *measured)):
        if best.valid and other.valid:
            of_best, of_other = (
                math.hypot(*reprojection_errors(left, right, found.point, *measured)) for found in (best, other)
            )
            assert of_best <= of_other + 1e-9


@given(seen_points, noises)
def test_the_reprojection_error_is_stationary(seen: Seen, noise: Array) -> None:
    left, right, _ = seen
    measured = noisy(seen, noise)
    point = triangulate_optimal(left, right, *measured).point
    if np.isfinite(point).all():
        residuals = [camera.project(point)[0] - uv for camera, uv in zip((left, right), measured, strict=True)]
        slope = sum(
            residual @ projection_jacobian(camera, point)
            for camera, residual in zip((left, right), residuals, strict=True)
        )
        steepest = max(np.abs(projection_jacobian(camera, point)).max() for camera in (left, right))
        assert np.abs(slope).max() <= 1e-7 * steepest


@given(seen_points, noises)
def test_the_point_projects_to_the_corrected_pixels(seen: Seen, noise: Array) -> None:
    left, right, _ = seen
    measured = noisy(seen, noise)
    corrected_left, corrected_right = correct_matches(left, right, *measured)
    found = triangulate_optimal(left, right, *measured)
    if found.valid:
        np.testing.assert_allclose(left.project(found.point)[0], corrected_left, rtol=0, atol=1e-7)
        np.testing.assert_allclose(right.project(found.point)[0], corrected_right, rtol=0, atol=1e-7)


@given(stereo_pairs, pixels, pixels)
def test_any_two_pixels_are_corrected_as_little_as_can_be(pair: Pair, uv_left: Array, uv_right: Array) -> None:
    assert correction(pair, uv_left, uv_right) <= least_by_scan(pair, uv_left, uv_right) + 1e-9
    corrected_left, corrected_right = correct_matches(*pair, uv_left, uv_right)
    F = fundamental(*pair)
    p_left, p_right = np.append(corrected_left, 1.0), np.append(corrected_right, 1.0)
    assert abs(p_right @ F @ p_left) <= 1e-12 * np.linalg.norm(p_left) * np.linalg.norm(p_right)


@given(stereo_pairs, pixels, pixels)
def test_opencv_corrects_no_less(pair: Pair, uv_left: Array, uv_right: Array) -> None:
    F = fundamental(*pair)
    answer = cv2.correctMatches(F, uv_left.reshape(1, 1, 2), uv_right.reshape(1, 1, 2))
    cv_left, cv_right = (np.asarray(pixel, dtype=np.float64).ravel() for pixel in answer)
    assume(np.isfinite(cv_left).all() and np.isfinite(cv_right).all())  # OpenCV fails for some pairs
    moved = math.hypot(*(cv_left - uv_left), *(cv_right - uv_right))
    # OpenCV's pixels satisfy the constraint to its own rounding: what they still miss may be moved as well
    missed = correction(pair, cv_left, cv_right)
    assert correction(pair, uv_left, uv_right) <= moved + missed + 1e-9


@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-6.0, 2.0), st.booleans(), pixels, st.integers(0, 3))
def test_near_an_epipole_too(x: float, y: float, power: float, at_right: bool, uv: Array, seed: int) -> None:
    """Forward motion: both epipoles are in the picture, and there may be several minima."""
    rng = np.random.default_rng(seed)
    left = Camera.from_intrinsics(600.0, 650.0, 320.0, 240.0, T_camera_world=np.eye(4))
    T = np.eye(4)
    T[:3, 3] = -np.array([*rng.uniform(-0.2, 0.2, 2), 1.0])
    right = Camera.from_intrinsics(500.0, 500.0, 300.0, 250.0, 20.0, T_camera_world=T)
    camera, other = (right, left) if at_right else (left, right)
    u, v, w = camera.P @ [*other.center, 1.0]
    beside: Array = np.array([u, v]) / w + 10.0**power * np.array([x, y])
    uv_left, uv_right = (uv, beside) if at_right else (beside, uv)
    assert correction((left, right), uv_left, uv_right) <= least_by_scan((left, right), uv_left, uv_right) + 1e-9


def test_two_epipoles_are_left_where_they_are() -> None:
    left = Camera.from_intrinsics(600.0, 600.0, 320.0, 240.0, T_camera_world=np.eye(4))
    T = np.eye(4)
    T[2, 3] = -1.0
    right = Camera(left.K, T)
    assert correction((left, right), np.array([320.0, 240.0]), np.array([320.0, 240.0])) == 0.0
    assert correction((left, right), np.array([320.0, 240.0]), np.array([400.0, 300.0])) == pytest.approx(0.0)
    found = triangulate_optimal(left, right, [320.0, 240.0], [320.0, 240.0])
    assert not found.valid  # every point of the baseline would do


@given(st.floats(0.05, 2.0), pixels, pixels)
def test_in_a_parallel_rig_each_pixel_moves_half_way_to_the_others_row(
    b: float, uv_left: Array, uv_right: Array
) -> None:
    corrected = correct_matches(*parallel_rig(b, 600.0), uv_left, uv_right)
    row = (uv_left[1] + uv_right[1]) / 2.0
    np.testing.assert_allclose(corrected[0], [uv_left[0], row], rtol=0, atol=1e-9)
    np.testing.assert_allclose(corrected[1], [uv_right[0], row], rtol=0, atol=1e-9)


def test_pixels_that_are_not_finite_stay_so_in_their_row() -> None:
    left, right = parallel_rig(0.6, 600.0)
    corrected = correct_matches(left, right, [[400.0, 240.0], [math.nan, 240.0]], [[320.0, 242.0], [320.0, 240.0]])
    for pixels in corrected:
        np.testing.assert_array_equal(np.isnan(pixels).all(axis=-1), [False, True])


def test_many_pairs_are_corrected_as_one_by_one_where_the_iteration_does_not_settle() -> None:
    left = Camera.from_intrinsics(600.0, 600.0, 320.0, 240.0, T_camera_world=np.eye(4))
    T = np.eye(4)
    T[:3, 3] = -0.1, 0.05, -1.0
    pair = left, Camera(left.K, T)
    rng = np.random.default_rng(1)
    uv_left, uv_right = rng.uniform(0.0, 640.0, (2, 50, 2))
    corrected_left, corrected_right = correct_matches(*pair, uv_left, uv_right)
    for row in range(50):
        one_left, one_right = correct_matches(*pair, uv_left[row], uv_right[row])
        np.testing.assert_allclose(corrected_left[row], one_left, rtol=0, atol=1e-6)
        np.testing.assert_allclose(corrected_right[row], one_right, rtol=0, atol=1e-6)
