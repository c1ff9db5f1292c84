"""The fundamental matrix and its lines, by what they are for and against OpenCV."""

import math

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geometry import Array, GeometryError
from geometry.camera import Camera, parallel_rig
from geometry.epipolar import (
    baseline,
    epipolar_line_left,
    epipolar_line_right,
    epipolar_residual,
    epipole_pixel,
    epipoles,
    essential,
    fundamental,
    sampson_distance,
)
from tests.geometry.strategies import EXACT, cameras, near, rotations, seen_points, stereo_pairs

Pair = tuple[Camera, Camera]
Seen = tuple[Camera, Camera, Array]
pixels = st.tuples(st.floats(0.0, 640.0), st.floats(0.0, 480.0)).map(np.array)


def epipole(camera: Camera, other: Camera) -> Array:
    """The other camera's centre as a homogeneous pixel of unit norm."""
    homogeneous = camera.P @ [*other.center, 1.0]
    return np.asarray(homogeneous / np.linalg.norm(homogeneous))


@given(stereo_pairs)
def test_f_is_scaled_as_in_the_contract(pair: Pair) -> None:
    F = fundamental(*pair)
    assert abs(np.linalg.norm(F) - 1.0) < EXACT
    assert F.max() >= -F.min() * (1.0 - 1e-9)
    assert np.linalg.svd(F)[1][2] < EXACT


@given(seen_points)
def test_matching_pixels_satisfy_the_epipolar_constraint(seen: Seen) -> None:
    left, right, point = seen
    p_left, p_right = np.append(left.project(point)[0], 1.0), np.append(right.project(point)[0], 1.0)
    F = fundamental(left, right)
    assert abs(p_right @ F @ p_left) <= EXACT * np.linalg.norm(p_left) * np.linalg.norm(p_right)


@given(stereo_pairs)
def test_the_epipoles_are_the_null_vectors(pair: Pair) -> None:
    left, right = pair
    F = fundamental(left, right)
    np.testing.assert_allclose(F @ epipole(left, right), np.zeros(3), rtol=0, atol=EXACT)
    np.testing.assert_allclose(F.T @ epipole(right, left), np.zeros(3), rtol=0, atol=EXACT)


@given(stereo_pairs)
def test_exchanging_the_cameras_transposes_f(pair: Pair) -> None:
    left, right = pair
    F, exchanged = fundamental(left, right), fundamental(right, left)
    sign = np.sign((F.T * exchanged).sum())  # of two entries equally large, each takes its own first
    np.testing.assert_allclose(exchanged, sign * F.T, rtol=0, atol=EXACT)


@given(stereo_pairs)
def test_e_has_two_equal_singular_values_and_belongs_to_f(pair: Pair) -> None:
    left, right = pair
    E = essential(left, right)
    np.testing.assert_allclose(np.linalg.svd(E)[1], [1.0, 1.0, 0.0], rtol=0, atol=EXACT)
    of_f = right.K.T @ fundamental(left, right) @ left.K
    of_f *= np.sqrt(2.0) / np.linalg.norm(of_f)
    np.testing.assert_allclose(E, np.sign((E * of_f).sum()) * of_f, rtol=0, atol=1e-9)


@given(stereo_pairs)
def test_e_decomposes_to_the_relative_pose(pair: Pair) -> None:
    left, right = pair
    R_right_left = right.R @ left.R.T
    first, second, _ = cv2.decomposeEssentialMat(essential(left, right))
    assert min(np.abs(R - R_right_left).max() for R in (first, second)) < 1e-9


@given(seen_points, st.floats(-50.0, 50.0))
def test_lines_run_through_the_match_and_the_epipole(seen: Seen, beside: float) -> None:
    left, right, point = seen
    F = fundamental(left, right)
    uv_left, uv_right = left.project(point)[0], right.project(point)[0]
    for line, uv, pole in (
        (epipolar_line_right(F, uv_left), uv_right, epipole(right, left)),
        (epipolar_line_left(F, uv_right), uv_left, epipole(left, right)),
    ):
        assert abs(math.hypot(line[0], line[1]) - 1.0) < EXACT
        assert abs(line @ [*uv, 1.0]) < 1e-6
        assert abs(line @ pole) <= 1e-9 * np.linalg.norm(line)
        away = uv + beside * line[:2]
        assert abs(line @ [*away, 1.0] - beside) < 1e-6


@given(stereo_pairs, pixels)
def test_lines_are_opencvs(pair: Pair, uv: Array) -> None:
    F = fundamental(*pair)
    for which, line in ((1, epipolar_line_right(F, uv)), (2, epipolar_line_left(F, uv))):
        expected = cv2.computeCorrespondEpilines(uv.reshape(1, 1, 2), which, F).ravel()
        np.testing.assert_allclose(line, expected, rtol=1e-5, atol=1e-4)  # OpenCV answers in single precision


def test_a_batch_of_lines_has_nan_at_the_epipole_only() -> None:
    left = Camera.from_intrinsics(600.0, 600.0, 320.0, 240.0, T_camera_world=np.eye(4))
    ahead = np.eye(4)
    ahead[2, 3] = -1.0
    F = fundamental(left, Camera(left.K, ahead))
    pixels = np.array([[320.0, 240.0], [330.0, 240.0], [math.nan, 0.0]])
    lines = epipolar_line_right(F, pixels)
    np.testing.assert_array_equal(np.isnan(lines).all(axis=-1), [True, False, True])
    np.testing.assert_allclose(np.abs(lines[1]), [0.0, 1.0, 240.0], rtol=0, atol=1e-9)
    np.testing.assert_array_equal(lines[1], epipolar_line_right(F, pixels[1]))
    assert np.isnan(epipolar_line_left(F, pixels[0])).all()


@given(st.floats(0.05, 2.0), st.floats(200.0, 1500.0), pixels)
def test_a_parallel_rig_has_level_lines_and_one_f_whatever_the_rounding(b: float, focal: float, uv: Array) -> None:
    left, right = parallel_rig(b, focal)
    F = fundamental(left, right)
    half = math.sqrt(0.5)
    np.testing.assert_allclose(F, [[0.0, 0.0, 0.0], [0.0, 0.0, half], [0.0, -half, 0.0]], rtol=0, atol=EXACT)
    expected = np.array([0.0, 1.0, uv[1]])
    np.testing.assert_allclose(np.abs(epipolar_line_right(F, uv)), expected, rtol=0, atol=1e-9)


@given(cameras, rotations)
def test_without_a_baseline_there_is_no_f(camera: Camera, R: Array) -> None:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, -R @ camera.center
    turned = Camera(camera.K, T)
    for function in (baseline, essential, fundamental):
        with pytest.raises(GeometryError) as caught:
            function(camera, turned)
        assert caught.value.argument == "right"


@given(near(0.0).map(abs).filter(bool))
def test_the_shortest_baselines_have_an_f(b: float) -> None:
    np.testing.assert_allclose(baseline(*parallel_rig(b, 600.0)), [b, 0.0, 0.0], rtol=0, atol=1e-16)
    np.testing.assert_allclose(fundamental(*parallel_rig(b, 600.0))[1, 2], math.sqrt(0.5), rtol=1e-6)


# ---- epipoles and distances


@given(stereo_pairs)
def test_epipoles_are_the_other_cameras_centres(pair: Pair) -> None:
    left, right = pair
    for found, expected in zip(epipoles(fundamental(*pair)), (epipole(left, right), epipole(right, left)), strict=True):
        assert abs(np.linalg.norm(found) - 1.0) < EXACT
        assert found[np.abs(found).argmax()] > 0.0
        np.testing.assert_allclose(found, np.sign(found @ expected) * expected, rtol=0, atol=1e-9)


@given(seen_points)
def test_lines_run_through_the_pixel_of_the_epipole(seen: Seen) -> None:
    left, right, point = seen
    F = fundamental(left, right)
    e_left, e_right = (epipole_pixel(e) for e in epipoles(F))
    for line, pole in (
        (epipolar_line_right(F, left.project(point)[0]), e_right),
        (epipolar_line_left(F, right.project(point)[0]), e_left),
    ):
        if np.hypot(*pole) < 1e5:
            assert abs(line @ [*pole, 1.0]) < 1e-6


@given(st.floats(0.05, 2.0), st.floats(200.0, 1500.0), near(0.0))
def test_epipoles_of_a_parallel_rig_are_at_infinity_and_of_a_turned_one_are_not(
    b: float, focal: float, a: float
) -> None:
    left, right = parallel_rig(b, focal)
    for e in epipoles(fundamental(left, right)):
        np.testing.assert_allclose(e, [1.0, 0.0, 0.0], rtol=0, atol=EXACT)
        assert np.isnan(epipole_pixel(e)).all()
    turn = np.array([[math.cos(a), 0, -math.sin(a)], [0, 1, 0], [math.sin(a), 0, math.cos(a)]])
    T = right.T_camera_world.copy()
    T[:3] = turn @ T[:3]
    _, e = epipoles(fundamental(left, Camera(right.K, T)))
    expected = turn @ [-b, 0.0, 0.0]
    seen = epipole_pixel(e)
    if abs(a) > 1e-9:
        np.testing.assert_allclose(seen[0], 320 + focal * expected[0] / expected[2], rtol=1e-6)


def test_a_matrix_without_rank_two_has_no_epipoles() -> None:
    for F in (np.eye(3), np.zeros((3, 3)), np.ones((3, 3)), np.full((3, 3), math.nan)):
        with pytest.raises(GeometryError) as caught:
            epipoles(F)
        assert caught.value.argument == "F"


@given(stereo_pairs, pixels, pixels)
def test_sampson_distance_is_the_root_of_opencvs(pair: Pair, left: Array, right: Array) -> None:
    F = fundamental(*pair)
    p, q = np.append(left, 1.0), np.append(right, 1.0)
    np.testing.assert_allclose(epipolar_residual(F, left, right), q @ F @ p, rtol=1e-9, atol=1e-12)
    expected = cv2.sampsonDistance(p.reshape(3, 1), q.reshape(3, 1), F)
    np.testing.assert_allclose(sampson_distance(F, left, right) ** 2, expected, rtol=1e-6, atol=1e-12)


@given(seen_points, st.floats(-2.0, 2.0), st.floats(-2.0, 2.0))
def test_sampson_distance_is_zero_for_matches_and_about_the_error_otherwise(seen: Seen, d: float, e: float) -> None:
    left, right, point = seen
    F = fundamental(left, right)
    u, v = left.project(point)[0], right.project(point)[0]
    assert sampson_distance(F, u, v) < 1e-6
    moved = v + np.array([d, e])
    apart = abs(epipolar_line_right(F, u) @ [*moved, 1.0])
    assert sampson_distance(F, u, moved) <= apart + 1e-9, "both pixels may give way"


def test_a_pair_of_epipoles_has_no_sampson_distance() -> None:
    left = Camera.from_intrinsics(600.0, 600.0, 320.0, 240.0, T_camera_world=np.eye(4))
    ahead = np.eye(4)
    ahead[2, 3] = -1.0
    F = fundamental(left, Camera(left.K, ahead))
    distances = sampson_distance(F, [[320.0, 240.0], [320.0, 240.0]], [[320.0, 240.0], [330.0, 240.0]])
    assert math.isnan(distances[0])
    assert distances[1] == pytest.approx(0.0, abs=1e-9)
