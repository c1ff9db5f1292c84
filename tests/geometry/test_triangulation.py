"""The three methods: exact where the rays meet, each true to its own definition where they miss."""

import math
from collections.abc import Callable

import cv2
import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geometry import Array, GeometryError, se3
from geometry.camera import Camera, parallel_rig
from geometry.triangulation import (
    Status,
    Triangulation,
    covariance,
    depth_from_disparity,
    disparity,
    dlt_equations,
    reprojection_errors,
    triangulate_dlt,
    triangulate_midpoint,
    triangulate_optimal,
)
from tests.geometry.strategies import near, poses, seen_points, vectors

Seen = tuple[Camera, Camera, Array]
Method = Callable[[Camera, Camera, npt.ArrayLike, npt.ArrayLike], Triangulation]
METHODS: tuple[Method, ...] = (triangulate_dlt, triangulate_midpoint, triangulate_optimal)
each_method = pytest.mark.parametrize("method", METHODS)
noises = vectors(4, 5.0)


def measured(seen: Seen, noise: Array | float = 0.0) -> tuple[Array, Array]:
    left, right, point = seen
    pair = np.concatenate([left.project(point)[0], right.project(point)[0]]) + noise
    return pair[:2], pair[2:]


def angle_at(left: Camera, right: Camera, point: Array) -> float:
    a, b = point - left.center, point - right.center
    return math.atan2(float(np.linalg.norm(np.cross(a, b))), float(a @ b))


@each_method
@given(seen=seen_points)
def test_rays_that_meet_give_their_point(method: Method, seen: Seen) -> None:
    left, right, point = seen
    uv_left, uv_right = measured(seen)
    found = method(left, right, uv_left, uv_right)
    assert found.valid
    assert found.status == Status.FOUND
    # a rounding in a pixel of a thousand moves the point by its depth over the parallax
    parallax = angle_at(left, right, point)
    np.testing.assert_allclose(found.point, point, rtol=0, atol=1e-12 * 20.0 / parallax**2)
    assert abs(float(found.parallax) - parallax) < 1e-9
    assert reprojection_errors(left, right, found.point, uv_left, uv_right).max() < 1e-7


@given(seen_points, noises)
def test_dlt_is_opencvs(seen: Seen, noise: Array) -> None:
    left, right, _ = seen
    uv_left, uv_right = measured(seen, noise)
    P_left, P_right = left.T_camera_world[:3], right.T_camera_world[:3]
    x_left, x_right = left.normalized(uv_left).reshape(2, 1), right.normalized(uv_right).reshape(2, 1)
    expected = cv2.triangulatePoints(P_left, P_right, x_left, x_right).ravel()
    found = triangulate_dlt(left, right, uv_left, uv_right)
    if found.valid:
        np.testing.assert_allclose(found.point, expected[:3] / expected[3], rtol=1e-8, atol=1e-8)


@given(seen_points, noises)
def test_midpoint_is_half_way_along_the_common_perpendicular(seen: Seen, noise: Array) -> None:
    left, right, _ = seen
    uv_left, uv_right = measured(seen, noise)
    found = triangulate_midpoint(left, right, uv_left, uv_right)
    on_left, on_right = found.closest
    across = on_right - on_left
    assert abs(np.linalg.norm(across) - found.gap) < 1e-9
    for camera, uv, on_line in ((left, uv_left, on_left), (right, uv_right, on_right)):
        origin, direction = camera.pixel_ray(uv)
        assert np.linalg.norm(np.cross(on_line - origin, direction)) < 1e-9
        assert abs(across @ direction) < 1e-9
    if found.valid:
        np.testing.assert_allclose(found.point, (on_left + on_right) / 2.0, rtol=0, atol=1e-12)


@pytest.mark.parametrize("method", [triangulate_midpoint, triangulate_optimal])
@given(seen=seen_points, noise=noises, move=poses, scale=st.floats(0.1, 10.0))
def test_the_point_moves_with_the_cameras(method: Method, seen: Seen, noise: Array, move: Array, scale: float) -> None:
    left, right, _ = seen
    pixels = measured(seen, noise)
    before = method(left, right, *pixels)
    moved = []
    for camera in (left, right):
        T = se3.compose(camera.T_camera_world, se3.inverse(move))
        T[:3, 3] *= scale
        moved.append(Camera(camera.K, T))
    after = method(moved[0], moved[1], *pixels)
    assert before.status == after.status
    if before.valid:
        expected = scale * se3.apply(move, before.point)
        np.testing.assert_allclose(after.point, expected, rtol=1e-7, atol=1e-7)
        assert abs(before.parallax - after.parallax) < 1e-9


@each_method
@given(seen=seen_points, noise=noises)
def test_it_does_not_matter_which_camera_is_called_left(method: Method, seen: Seen, noise: Array) -> None:
    left, right, _ = seen
    uv_left, uv_right = measured(seen, noise)
    one, other = method(left, right, uv_left, uv_right), method(right, left, uv_right, uv_left)
    assert one.status == other.status
    np.testing.assert_allclose(one.point, other.point, rtol=1e-6, atol=1e-6)


@each_method
@given(seen=seen_points, noise=noises)
def test_a_batch_is_the_same_as_one_by_one(method: Method, seen: Seen, noise: Array) -> None:
    left, right, _ = seen
    uv_left = np.stack([measured(seen, k * noise)[0] for k in range(3)])
    uv_right = np.stack([measured(seen, -k * noise)[1] for k in range(3)])
    batch = method(left, right, uv_left[:, None], uv_right[:, None])
    assert (batch.point.shape, batch.valid.shape, batch.parallax.shape) == ((3, 1, 3), (3, 1), (3, 1))
    for row in range(3):
        one = method(left, right, uv_left[row], uv_right[row])
        assert one.status == batch.status[row, 0]
        np.testing.assert_allclose(batch.point[row, 0], one.point, rtol=1e-8, atol=1e-8)
        np.testing.assert_allclose(batch.parallax[row, 0], one.parallax, rtol=1e-8, atol=1e-10)


@each_method
def test_one_pixel_broadcasts_against_many(method: Method) -> None:
    left, right = parallel_rig(0.6, 600.0)
    many = np.array([[300.0, 240.0], [310.0, 240.0]])
    points = method(left, right, [400.0, 240.0], many).point
    np.testing.assert_allclose(points[1], method(left, right, [400.0, 240.0], many[1]).point, atol=1e-12)


# Parallel rays: disparities around zero, from far below what rounding lets through to 1e-6.


@each_method
@given(parallax=near(0.0), focal=st.floats(200.0, 1500.0), v=st.floats(0.0, 480.0))
def test_nearly_parallel_rays_have_a_far_point_a_point_behind_or_none(
    method: Method, parallax: float, focal: float, v: float
) -> None:
    left, right = parallel_rig(0.6, focal)
    uv_left = np.array([320.0 + parallax * focal, v])
    uv_right = np.array([320.0, v])
    found = method(left, right, uv_left, uv_right)
    expected = Status.FOUND if parallax > 0.0 else Status.BEHIND if parallax < 0.0 else Status.PARALLEL
    assert found.status == expected
    assert found.valid == (parallax > 0.0)
    assert found.in_front == (parallax >= 0.0)
    assert np.isnan(found.point).all() == (parallax <= 0.0)
    if found.valid:
        depth = depth_from_disparity(disparity(uv_left, uv_right), 0.6, focal)
        np.testing.assert_allclose(found.point[1], depth, rtol=1e-4)
        assert reprojection_errors(left, right, found.point, uv_left, uv_right).max() < 1e-7


@each_method
@given(seen=seen_points)
def test_parallel_rays_of_any_two_cameras_have_no_point(method: Method, seen: Seen) -> None:
    left, right, point = seen
    direction = point - left.center
    pixels = []
    for camera in (left, right):
        x, y, z = camera.R @ direction
        if z < 0.1 * np.linalg.norm(direction):
            return
        pixels.append((camera.K @ [x / z, y / z, 1.0])[:2])
    found = method(left, right, *pixels)
    # rounding leaves an angle of some 1e-16, so a point beyond 1e12 baselines if any at all
    assert found.status == Status.PARALLEL
    assert np.isnan(found.point).all()
    assert found.parallax < 1e-12


def test_parallel_rays_have_the_gap_of_their_lines() -> None:
    left, right = parallel_rig(0.6, 600.0)
    level = triangulate_midpoint(left, right, [400.0, 240.0], [400.0, 240.0])
    assert np.isnan(level.closest).all()
    assert level.gap == pytest.approx(0.6 * 600.0 / math.hypot(600.0, 80.0))


@each_method
def test_rays_that_part_meet_behind(method: Method) -> None:
    left, right = parallel_rig(0.6, 600.0)
    found = method(left, right, [300.0, 240.0], [340.0, 240.0])
    assert found.status == Status.BEHIND
    assert not found.valid
    assert not found.in_front
    assert np.isnan(found.point).all()
    assert found.parallax == pytest.approx(math.atan2(40.0 / 600.0, 1.0 - (20.0 / 600.0) ** 2))


@each_method
@given(seen=seen_points)
def test_a_point_behind_one_camera_is_no_point(method: Method, seen: Seen) -> None:
    left, right, point = seen
    T = right.T_camera_world.copy()
    T[:3] = np.diag([1.0, -1.0, -1.0]) @ T[:3]  # turned to look the other way
    turned = Camera(right.K, T)
    x, y, z = turned.T_camera_world[:3] @ [*point, 1.0]
    assert z < 0.0
    uv_right = (turned.K @ [x / z, y / z, 1.0])[:2]
    found = method(left, turned, left.project(point)[0], uv_right)
    assert found.status == Status.BEHIND
    assert np.isnan(found.point).all()


@each_method
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1e10, 1e300])
def test_a_pixel_that_is_not_finite_spoils_its_row_only(method: Method, value: float) -> None:
    left, right = parallel_rig(0.6, 600.0)
    uv_left = np.array([[400.0, 240.0], [value, 240.0], [400.0, 240.0], [400.0, value]])
    uv_right = np.array([[320.0, 240.0], [320.0, 240.0], [320.0, value], [320.0, 240.0]])
    found = method(left, right, uv_left, uv_right)
    np.testing.assert_array_equal(found.status, [Status.FOUND] + 3 * [Status.UNDEFINED])
    np.testing.assert_array_equal(found.in_front, [True, False, False, False])
    np.testing.assert_array_equal(np.isnan(found.point).all(axis=-1), [False, True, True, True])
    np.testing.assert_array_equal(np.isnan(found.parallax), [False, True, True, True])
    one = method(left, right, uv_left[1], uv_right[1])
    assert one.status == Status.UNDEFINED
    assert np.isnan(one.point).all()


def test_undefined_pixels_have_no_gap_and_no_closest_points() -> None:
    left, right = parallel_rig(0.6, 600.0)
    found = triangulate_midpoint(left, right, [[400.0, 240.0], [math.nan, 240.0]], [320.0, 241.0])
    np.testing.assert_array_equal(np.isnan(found.gap), [False, True])
    np.testing.assert_array_equal(np.isnan(found.closest).all(axis=(-2, -1)), [False, True])


@each_method
def test_without_a_baseline_there_is_no_depth(method: Method) -> None:
    left, right = parallel_rig(0.0, 600.0)
    with pytest.raises(GeometryError) as caught:
        method(left, right, [400.0, 240.0], [320.0, 240.0])
    assert caught.value.argument == "right"
    assert np.isnan(covariance((left, right), [0.0, 4.0, 1.0], 1.0)).all()


@each_method
@given(baseline=st.floats(-9.0, -6.0).map(lambda power: 10.0**power))
def test_the_shortest_baselines_have_a_depth(method: Method, baseline: float) -> None:
    left, right = parallel_rig(baseline, 600.0)
    found = method(left, right, [400.0, 240.0], [320.0, 240.0])
    depth = 600.0 * baseline / 80.0
    np.testing.assert_allclose(found.point, [depth * 80.0 / 600.0 - baseline / 2.0, depth, 1.0], rtol=1e-6, atol=0)


@each_method
def test_pixels_of_a_wrong_shape_are_refused(method: Method) -> None:
    with pytest.raises(GeometryError, match="uv_left is"):
        method(*parallel_rig(0.6, 600.0), [400.0, 240.0, 1.0], [320.0, 240.0])
    with pytest.raises(GeometryError, match="uv_right is"):
        method(*parallel_rig(0.6, 600.0), [400.0, 240.0], 320.0)


@given(seen_points, noises)
def test_reprojection_errors_are_distances_to_the_measured_pixels(seen: Seen, noise: Array) -> None:
    left, right, point = seen
    errors = reprojection_errors(left, right, point, *measured(seen, noise))
    expected = [math.hypot(*noise[:2]), math.hypot(*noise[2:])]
    np.testing.assert_allclose(errors, expected, rtol=0, atol=1e-9)
    batch = reprojection_errors(left, right, np.stack([point, left.center - left.R[2]]), *measured(seen, noise))
    np.testing.assert_allclose(batch[0], errors, rtol=0, atol=1e-9)
    assert np.isnan(batch[1, 0])


# A rig whose principal points differ, as those of rectified pictures do: that of Middlebury's Adirondack.

ADIRONDACK = {"baseline": 0.176252, "focal": 4161.221, "doffs": 209.059}


@given(d=st.floats(-200.0, 1500.0), v=st.floats(0.0, 1987.0), u=st.floats(0.0, 2879.0))
def test_depth_with_differing_principal_points_is_opencvs(d: float, u: float, v: float) -> None:
    b, f, doffs = ADIRONDACK["baseline"], ADIRONDACK["focal"], ADIRONDACK["doffs"]
    cx, cy = 1445.577, 984.686
    # OpenCV's Q, with Tx = -b and the right principal point at cx + doffs
    Q = np.array([[1.0, 0, 0, -cx], [0, 1, 0, -cy], [0, 0, 0, f], [0, 0, 1 / b, doffs / b]])
    ((expected,),) = cv2.perspectiveTransform(np.array([[[u, v, d]]]), Q)
    assert depth_from_disparity(d, b, f, doffs) == pytest.approx(expected[2], rel=1e-12)
    left, right = parallel_rig(b, f, (cx, cy), 0.0, doffs)
    x, y, z = expected
    for method in METHODS:
        point = method(left, right, [u, v], [u - d, v]).point
        np.testing.assert_allclose(point, [x - b / 2, z, -y], rtol=1e-7, atol=1e-9)


def test_no_depth_where_disparity_and_offset_make_zero_or_less() -> None:
    depths = depth_from_disparity([-209.059, -300.0, 0.0], **ADIRONDACK)
    assert np.isnan(depths[:2]).all()
    assert depths[2] == pytest.approx(3.508, abs=1e-3), "no disparity isn't infinitely far there"
    with pytest.raises(GeometryError, match="doffs"):
        depth_from_disparity(10.0, 0.1, 600.0, math.nan)
    with pytest.raises(GeometryError, match="doffs"):
        parallel_rig(0.1, 600.0, doffs=math.inf)


@given(seen=seen_points, noise=noises)
def test_the_equations_of_the_linear_method_are_those_of_the_projections(seen: Seen, noise: Array) -> None:
    left, right, point = seen
    uv = measured(seen, noise)
    A = dlt_equations(left, right, *uv)
    for k, camera in enumerate((left, right)):
        x, y = (np.linalg.inv(camera.K) @ [*uv[k], 1.0])[:2]
        P = camera.T_camera_world[:3]
        np.testing.assert_allclose(A[2 * k : 2 * k + 2], [x * P[2] - P[0], y * P[2] - P[1]], rtol=1e-9, atol=1e-9)
    X = np.linalg.svd(A)[2][3]
    found = triangulate_dlt(left, right, *uv)
    if found.valid:
        np.testing.assert_allclose(found.point, X[:3] / X[3], rtol=1e-9)
    if not noise.any():
        assert np.abs(A @ [*point, 1.0]).max() < 1e-9 * max(1.0, np.abs(point).max())
    assert np.isnan(dlt_equations(left, right, [np.nan, 0.0], uv[1])).all()
