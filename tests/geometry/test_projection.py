"""Parts of P against OpenCV, vanishing points and clipping against their definitions, cameras without perspective."""

import math

import cv2
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from geometry import Array, GeometryError
from geometry.affine_camera import AffineCamera, weak_perspective
from geometry.camera import R_WORLD_LEVEL, Camera, aim, pan_tilt_roll
from geometry.projection import clip_segments, decompose, frame_planes, vanishing_points
from geometry.rotations import axis_rotation
from tests.geometry.strategies import EXACT, angles, cameras, directions, near, vectors

scales = st.floats(0.01, 100.0) | st.floats(-100.0, -0.01)
depths = st.floats(0.05, 50.0)
turns = st.floats(-math.pi, math.pi) | near(-math.pi, -math.pi / 2, 0.0, math.pi / 2, math.pi)


def level() -> Camera:
    return Camera.from_intrinsics(600.0, 500.0, 320.0, 240.0, 20.0, T_camera_world=np.eye(4))


# ---- P taken apart


@given(cameras, scales)
def test_p_gives_back_what_made_it_whatever_its_scale_and_sign(camera: Camera, scale: float) -> None:
    parts = decompose(scale * camera.P)
    np.testing.assert_allclose(parts.K, camera.K, rtol=1e-9, atol=1e-8)
    np.testing.assert_allclose(parts.R, camera.R, rtol=0, atol=1e-9)
    np.testing.assert_allclose(parts.t, camera.t, rtol=0, atol=1e-8)
    np.testing.assert_allclose(parts.center, camera.center, rtol=0, atol=1e-8)
    assert np.linalg.det(parts.R) == pytest.approx(1.0)
    assert 0.0 < parts.conditioning <= 1.0


@given(st.lists(st.floats(-10.0, 10.0), min_size=12, max_size=12))
def test_any_finite_p_is_taken_apart_as_by_opencv(entries: list[float]) -> None:
    P = np.reshape(entries, (3, 4))
    values = np.linalg.svd(P[:, :3], compute_uv=False)
    assume(values[2] > 1e-2)
    parts = decompose(P)
    np.testing.assert_allclose(parts.R @ parts.R.T, np.eye(3), rtol=0, atol=1e-10)
    rebuilt = parts.K @ np.column_stack([parts.R, parts.t])
    factor = np.vdot(rebuilt, P) / np.vdot(rebuilt, rebuilt)
    np.testing.assert_allclose(factor * rebuilt, P, rtol=0, atol=1e-8 * np.abs(P).max())
    K, R, center = cv2.decomposeProjectionMatrix(P)[:3]
    signs = np.diag(np.sign(np.diag(K)))  # OpenCV leaves them open
    theirs = K @ signs
    np.testing.assert_allclose(parts.K, theirs / theirs[2, 2], rtol=1e-6, atol=1e-6)
    turned = signs @ R
    np.testing.assert_allclose(parts.R, turned * np.sign(np.linalg.det(turned)), rtol=0, atol=1e-7)
    np.testing.assert_allclose(parts.center, (center[:3] / center[3]).ravel(), rtol=1e-6, atol=1e-6)


@given(cameras, depths)
def test_an_affine_p_has_no_centre_to_find(camera: Camera, depth: float) -> None:
    with pytest.raises(GeometryError, match="finite camera"):
        decompose(AffineCamera(camera, depth).P)


@pytest.mark.parametrize(
    "P", [np.zeros((3, 4)), np.ones((3, 4)), np.full((3, 4), math.nan), np.eye(4), np.ones((2, 3, 4))]
)
def test_what_is_no_camera_is_refused(P: Array) -> None:
    with pytest.raises(GeometryError):
        decompose(P)


# ---- vanishing points


@given(cameras, directions())
def test_a_vanishing_point_is_the_limit_of_points_far_along_the_line(camera: Camera, direction: Array) -> None:
    point, pixel = vanishing_points(camera.P, direction)
    ahead = camera.R @ direction
    assert np.linalg.norm(point) == pytest.approx(1.0)
    assume(abs(ahead[2]) > 1e-2 * np.linalg.norm(direction))
    far = camera.center + 1e9 * np.sign(ahead[2]) * direction
    np.testing.assert_allclose(pixel, camera.project(far)[0], rtol=1e-6, atol=1e-3)
    np.testing.assert_allclose(point[:2] / point[2], pixel, rtol=1e-9)
    other = vanishing_points(camera.P, -3.0 * direction)[1]
    np.testing.assert_allclose(other, pixel, rtol=1e-9, atol=1e-9)


@given(cameras, st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_lines_parallel_to_the_picture_vanish_at_infinity(camera: Camera, x: float, y: float) -> None:
    assume(math.hypot(x, y) > 0.01)
    point, pixel = vanishing_points(camera.P, x * camera.R[0] + y * camera.R[1])
    assert point[2] == 0.0
    assert np.isnan(pixel).all()
    image = camera.K[:2, :2] @ [x, y]
    assert abs(point[0] * image[1] - point[1] * image[0]) < 1e-9 * np.linalg.norm(image)


@given(cameras, depths, directions())
def test_without_perspective_nothing_vanishes_in_reach(camera: Camera, depth: float, direction: Array) -> None:
    assume(np.linalg.norm((camera.R @ direction)[:2]) > 1e-3)
    point, pixel = vanishing_points(AffineCamera(camera, depth).P, direction)
    assert point[2] == 0.0
    assert np.isnan(pixel).all()
    assert np.isfinite(point).all()


def test_directions_that_lead_nowhere_are_nan_and_spoil_no_other() -> None:
    points, pixels = vanishing_points(level().P, [[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [math.nan, 0.0, 1.0]])
    np.testing.assert_allclose(pixels[0], [320.0, 240.0], rtol=0, atol=1e-9)
    assert np.isnan(points[1:]).all()
    assert np.isnan(pixels[1:]).all()
    along, _ = vanishing_points(AffineCamera(level(), 2.0).P, [0.0, 0.0, 1.0])
    assert np.isnan(along).all()


# ---- clipping

segments = st.lists(st.tuples(vectors(3, 10.0), vectors(3, 10.0)).map(np.stack), min_size=1, max_size=6).map(np.stack)


def inside(planes: Array, points: Array) -> Array:
    return np.asarray((points @ planes[:, :3].T + planes[:, 3]).min(axis=-1))


@given(cameras, segments)
def test_what_is_kept_is_the_part_inside(camera: Camera, given_segments: Array) -> None:
    planes = np.vstack([frame_planes(camera.P, 640, 480), [*camera.R[2], camera.t[2] - 1e-3]])
    parts, exist = clip_segments(given_segments, planes)
    size = np.abs(planes).max() * 20.0
    assert np.isnan(parts[~exist]).all()
    assert (inside(planes, parts[exist]) >= -1e-12 * size).all()
    fractions = np.linspace(0.0, 1.0, 51)[:, None]
    for segment, part, exists in zip(given_segments, parts, exist, strict=True):
        samples = segment[0] + fractions * (segment[1] - segment[0])
        kept = samples[inside(planes, samples) > 1e-9 * size]
        if len(kept):
            assert exists
            along, length = part[1] - part[0], max(math.dist(part[1], part[0]), 1e-12)
            at = (kept - part[0]) @ along / length**2
            assert at.min() > -1e-6 / length
            assert at.max() < 1 + 1e-6 / length


@given(cameras, segments)
def test_ends_that_are_inside_stay_exactly_where_they_are(camera: Camera, given_segments: Array) -> None:
    planes = frame_planes(camera.P, 640, 480)
    parts, exist = clip_segments(given_segments, planes)
    kept = (inside(planes, given_segments) >= 0.0) & exist[:, None]
    np.testing.assert_array_equal(parts[kept], given_segments[kept])


def test_a_segment_through_the_cameras_plane_ends_there() -> None:
    both = np.array([[[0.0, 0.0, -1.0], [0.0, 1.0, 3.0]], [[0.0, 0.0, -2.0], [0.0, 0.0, -1.0]]])
    parts, exist = clip_segments(both, [[0.0, 0.0, 1.0, 0.0]])
    np.testing.assert_allclose(parts[0], [[0.0, 0.25, 0.0], [0.0, 1.0, 3.0]], rtol=0, atol=EXACT)
    assert exist.tolist() == [True, False]


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_segment_that_is_not_finite_is_left_out_alone(value: float) -> None:
    good = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 2.0]])
    for k in range(3):
        bad = good.copy()
        bad[1, k] = value
        parts, exist = clip_segments(np.stack([good, bad]), [[0.0, 0.0, 1.0, 0.0]])
        assert exist.tolist() == [True, False]
        np.testing.assert_array_equal(parts[0], good)
        assert np.isnan(parts[1]).all()


def test_no_segments_and_no_planes_are_answered() -> None:
    parts, exist = clip_segments(np.empty((0, 2, 3)), [[0.0, 0.0, 1.0, 0.0]])
    assert (parts.shape, exist.shape) == ((0, 2, 3), (0,))
    parts, exist = clip_segments([[[0, 0, 0], [1, 1, 1]]], np.empty((0, 4)))
    assert exist.all()


@given(cameras, vectors(3, 10.0))
def test_the_frames_planes_part_pixels_inside_from_those_outside(camera: Camera, point: Array) -> None:
    pixel, depth = camera.project(point)
    assume(depth > 0.01)
    distances = frame_planes(camera.P, 640, 480) @ [*point, 1.0]
    margins = np.array([pixel[0] + 0.5, pixel[1] + 0.5, 639.5 - pixel[0], 479.5 - pixel[1]])
    np.testing.assert_allclose(distances, margins * depth, rtol=1e-9, atol=1e-8)


# ---- cameras without perspective


@given(cameras, depths, st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))
def test_at_its_depth_an_affine_camera_agrees_with_perspective(
    camera: Camera, depth: float, x: float, y: float
) -> None:
    point = camera.center + camera.R.T @ [x, y, depth]
    affine = AffineCamera(camera, depth)
    size = 1.0 + np.abs(camera.project(point)[0]).max()
    np.testing.assert_allclose(affine.project(point)[0], camera.project(point)[0], rtol=0, atol=1e-11 * size)
    nearer = camera.center + camera.R.T @ [x, y, 0.5 * depth]
    np.testing.assert_allclose(affine.project(nearer)[0], camera.project(point)[0], rtol=0, atol=1e-11 * size)


@given(cameras, depths, vectors(3, 10.0))
def test_the_affine_p_says_the_same(camera: Camera, depth: float, point: Array) -> None:
    affine = AffineCamera(camera, depth)
    pixel, z = affine.project(point)
    assert z == pytest.approx(camera.project(point)[1], abs=1e-12)
    assert np.isnan(pixel).all() == (z <= 0.0)
    np.testing.assert_array_equal(affine.P[2], [0.0, 0.0, 0.0, 1.0])
    if z > 0.0:
        np.testing.assert_allclose((affine.P @ [*point, 1.0])[:2], pixel, rtol=1e-9, atol=1e-7)


@given(cameras, st.lists(vectors(3, 1.0), min_size=1, max_size=6))
def test_weak_perspective_divides_by_the_mean_depth_and_nears_perspective_far_away(
    camera: Camera, listed: list[Array]
) -> None:
    offsets = np.stack(listed)
    axis = camera.R[2]
    gaps = []
    for distance in (20.0, 200.0):
        points = camera.center + distance * axis + offsets
        weak = weak_perspective(camera, points)
        assert weak.depth == pytest.approx(float(((points - camera.center) @ axis).mean()))
        gaps.append(np.abs(weak.project(points)[0] - camera.project(points)[0]).max())
    assert gaps[1] <= gaps[0] / 50.0 + 1e-8


def test_a_scale_that_does_not_exist_is_refused() -> None:
    with pytest.raises(GeometryError, match="mean depth"):
        weak_perspective(level(), [[0.0, 0.0, -1.0]])
    with pytest.raises(GeometryError, match="one point or more"):
        weak_perspective(level(), np.empty((0, 3)))
    for depth in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(GeometryError, match="depth"):
            AffineCamera(level(), depth)


# ---- pan, tilt and roll


@given(angles, angles, angles)
def test_pan_tilt_and_roll_are_turns_about_z_x_and_the_optical_axis(pan: float, tilt: float, roll: float) -> None:
    expected = axis_rotation("z", pan) @ R_WORLD_LEVEL @ axis_rotation("x", tilt) @ axis_rotation("z", roll)
    np.testing.assert_allclose(pan_tilt_roll(pan, tilt, roll), expected, rtol=0, atol=EXACT)


def test_signs_of_pan_tilt_and_roll() -> None:
    forward = [pan_tilt_roll(*turn)[:, 2] for turn in ((0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.0, 0.1, 0.0))]
    np.testing.assert_array_equal(forward[0], [0.0, 1.0, 0.0])
    assert forward[1][0] < 0.0, "a positive pan looks left"
    assert forward[2][2] > 0.0, "a positive tilt looks up"
    right = pan_tilt_roll(0.0, 0.0, 0.1)[:, 0]
    assert right[2] < 0.0, "a positive roll turns right side down"


@given(vectors(3, 10.0), vectors(3, 10.0), turns)
def test_a_camera_that_is_aimed_sees_its_target_on_the_axis(center: Array, target: Array, roll: float) -> None:
    distance = float(np.linalg.norm(target - center))
    assume(distance > 1e-3)
    pan, tilt = aim(center, target)
    R = pan_tilt_roll(pan or 0.0, tilt, roll)
    np.testing.assert_allclose(R.T @ (target - center), [0.0, 0.0, distance], rtol=0, atol=1e-9)
    assert -math.pi / 2 <= tilt <= math.pi / 2


def test_straight_up_any_pan_does_and_at_the_place_itself_none() -> None:
    assert aim([0.0, 0.0, 1.0], [0.0, 0.0, 3.0]) == (None, math.pi / 2)
    assert aim([1.0, 2.0, 3.0], [1.0, 2.0, 0.0]) == (None, -math.pi / 2)
    with pytest.raises(GeometryError, match="other than"):
        aim([1.0, 2.0, 3.0], [1.0, 2.0, 3.0])
