"""The pinhole camera against OpenCV, and by going there and back."""

import math

import cv2
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from geometry import Array, GeometryError, se3
from geometry.camera import R_WORLD_LEVEL, Camera, parallel_rig
from tests.geometry.strategies import EXACT, cameras, near, vectors

PIXEL = 1e-9  # pixels: rounding at coordinates of some thousand pixels
image_coordinates = st.tuples(st.floats(-1000.0, 2000.0), st.floats(-1000.0, 2000.0)).map(np.array)


def default_camera() -> Camera:
    return Camera.from_intrinsics(600.0, 600.0, 320.0, 240.0, T_camera_world=np.eye(4))


@given(cameras, image_coordinates, st.floats(0.1, 50.0))
def test_a_point_on_a_pixels_ray_projects_to_the_pixel(camera: Camera, uv: Array, distance: float) -> None:
    origin, direction = camera.pixel_ray(uv)
    pixel, depth = camera.project(origin + distance * direction)
    assert depth > 0.0
    assert abs(np.linalg.norm(direction) - 1.0) < EXACT
    np.testing.assert_allclose(pixel, uv, rtol=0, atol=1e-7)
    np.testing.assert_allclose(origin, camera.center)


@given(cameras, st.lists(vectors(3, 10.0), min_size=1, max_size=5))
def test_projection_is_opencvs(camera: Camera, listed: list[Array]) -> None:
    points = np.stack(listed)
    points = points[camera.project(points)[1] > 0.01]
    assume(len(points))
    (fx, _, cx), (_, fy, cy), _ = camera.K.tolist()
    unskewed = Camera.from_intrinsics(fx, fy, cx, cy, T_camera_world=camera.T_camera_world)
    rotation = Rotation.from_matrix(camera.R).as_rotvec()
    expected = cv2.projectPoints(points, rotation, camera.t, unskewed.K, None)[0].reshape(-1, 2)
    np.testing.assert_allclose(unskewed.project(points)[0], expected, rtol=1e-9, atol=1e-6)
    homogeneous = se3.to_homogeneous(points) @ camera.P.T
    divided = homogeneous[:, :2] / homogeneous[:, 2:]
    np.testing.assert_allclose(camera.project(points)[0], divided, rtol=1e-9, atol=1e-6)


@given(cameras)
def test_p_decomposes_to_what_made_it(camera: Camera) -> None:
    K, R, center = cv2.decomposeProjectionMatrix(camera.P)[:3]
    np.testing.assert_allclose(K / K[2, 2], camera.K, rtol=1e-9, atol=1e-8)
    np.testing.assert_allclose(R, camera.R, rtol=0, atol=1e-9)
    np.testing.assert_allclose((center[:3] / center[3]).ravel(), camera.center, rtol=0, atol=1e-9)


@given(cameras)
def test_the_centre_is_the_null_vector_of_p_and_minus_rt_t(camera: Camera) -> None:
    np.testing.assert_allclose(camera.P @ [*camera.center, 1.0], np.zeros(3), rtol=0, atol=1e-9)
    np.testing.assert_allclose(camera.center, -camera.R.T @ camera.t, rtol=0, atol=EXACT)
    np.testing.assert_array_equal(camera.P, camera.K @ camera.T_camera_world[:3])


@given(cameras, image_coordinates)
def test_inverses_of_the_intrinsics(camera: Camera, uv: Array) -> None:
    np.testing.assert_allclose(camera.K @ camera.K_inverse, np.eye(3), rtol=0, atol=EXACT)
    np.testing.assert_allclose(camera.K @ [*camera.normalized(uv), 1.0], [*uv, 1.0], rtol=0, atol=PIXEL)
    direction = camera.back_projection @ [*uv, 1.0]
    np.testing.assert_allclose(camera.K @ camera.R @ direction, [*uv, 1.0], rtol=0, atol=PIXEL)


@given(cameras, st.floats(-5.0, 5.0), st.floats(-5.0, 5.0), near(0.0) | st.floats(-10.0, 10.0))
def test_what_is_not_in_front_has_no_pixel(camera: Camera, x: float, y: float, z: float) -> None:
    assume(not 0.0 < z < 1e-100)  # so near that the pixel would be infinite
    pixel, depth = default_camera().project([x, y, z])
    assert depth == z
    assert np.isnan(pixel).all() == (z <= 0.0)
    behind = camera.center - 2.0 * camera.R[2] + 0.3 * camera.R[0]
    assert np.isnan(camera.project(behind)[0]).all()
    assert camera.project(behind)[1] == pytest.approx(-2.0)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_a_point_that_is_not_finite_has_no_pixel_and_spoils_no_other(value: float) -> None:
    points = np.array([[0.1, 0.2, 2.0], [value, 0.0, 2.0], [0.0, value, 2.0], [0.0, 0.0, value], [0.0, 0.0, -1.0]])
    pixels, depths = default_camera().project(points)
    np.testing.assert_array_equal(np.isnan(pixels).all(axis=-1), [False, True, True, True, True])
    np.testing.assert_allclose(pixels[0], [350.0, 300.0], rtol=0, atol=PIXEL)
    for row, point in enumerate(points):
        one, depth = default_camera().project(point)
        np.testing.assert_array_equal(np.isnan(one), np.isnan(pixels[row]))
        assert depth == depths[row] or math.isnan(depths[row])


@given(cameras, st.lists(vectors(3, 10.0), min_size=2, max_size=4), st.lists(image_coordinates, min_size=2, max_size=4))
def test_a_batch_is_the_same_as_one_by_one(camera: Camera, points: list[Array], pixels: list[Array]) -> None:
    batch, depths = camera.project(np.stack(points)[None])
    assert batch.shape == (1, len(points), 2)
    for row, point in enumerate(points):
        one, depth = camera.project(point)
        assert abs(depth - depths[0, row]) < EXACT * 50
        if abs(depth) > 1e-3:
            np.testing.assert_allclose(batch[0, row], one, rtol=1e-9, atol=1e-6)
    directions = camera.pixel_ray(np.stack(pixels))[1]
    for row, uv in enumerate(pixels):
        np.testing.assert_allclose(directions[row], camera.pixel_ray(uv)[1], rtol=0, atol=EXACT)


@given(cameras, st.floats(0.1, 10.0))
def test_the_frustum_ends_in_the_corners_of_the_picture(camera: Camera, depth: float) -> None:
    corners = camera.frustum_corners(640, 480, depth)
    pixels, depths = camera.project(corners)
    expected = [[-0.5, -0.5], [639.5, -0.5], [639.5, 479.5], [-0.5, 479.5]]
    np.testing.assert_allclose(pixels, expected, rtol=0, atol=1e-7)
    np.testing.assert_allclose(depths, depth, rtol=0, atol=EXACT * 50)


@given(cameras, st.floats(1.0, 2000.0), st.floats(1.0, 2000.0))
def test_the_field_of_view_is_the_angle_between_opposite_edges(camera: Camera, width: float, height: float) -> None:
    level = Camera.from_intrinsics(camera.K[0, 0], camera.K[1, 1], *camera.K[:2, 2], T_camera_world=np.eye(4))
    fov_x, fov_y = level.fov(width, height)
    assert camera.fov(width, height) == (fov_x, fov_y)
    cx, cy = level.K[:2, 2]
    for angle, edges in ((fov_x, [[-0.5, cy], [width - 0.5, cy]]), (fov_y, [[cx, -0.5], [cx, height - 0.5]])):
        a, b = level.pixel_ray(edges)[1]
        assert abs(math.atan2(float(np.linalg.norm(np.cross(a, b))), float(a @ b)) - angle) < EXACT


def test_the_field_of_view_is_opencvs_when_centred() -> None:
    camera = Camera.from_intrinsics(600.0, 500.0, 319.5, 239.5, T_camera_world=np.eye(4))
    shifted = np.array([[600.0, 0.0, 320.0], [0.0, 500.0, 240.0], [0.0, 0.0, 1.0]])  # from the pixel's corner
    fov_x, fov_y = cv2.calibrationMatrixValues(shifted, (640, 480), 1.0, 1.0)[:2]
    np.testing.assert_allclose(np.degrees(camera.fov(640, 480)), [fov_x, fov_y], rtol=0, atol=1e-10)


def test_a_level_camera_looks_along_y() -> None:
    right, down, forward = R_WORLD_LEVEL.T
    np.testing.assert_array_equal([right, down, forward], [[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    assert np.linalg.det(R_WORLD_LEVEL) == pytest.approx(1.0)


@given(st.floats(0.0, 2.0) | near(0.0).map(abs), st.floats(200.0, 1500.0), st.floats(0.0, 3.0))
def test_the_parallel_rig_is_the_contracts(baseline: float, focal: float, height: float) -> None:
    left, right = parallel_rig(baseline, focal, height=height)
    np.testing.assert_allclose(left.center, [-baseline / 2.0, 0.0, height], rtol=0, atol=EXACT)
    np.testing.assert_allclose(right.center, [baseline / 2.0, 0.0, height], rtol=0, atol=EXACT)
    for camera in (left, right):
        np.testing.assert_array_equal(camera.R.T, R_WORLD_LEVEL)
        np.testing.assert_array_equal(camera.K, [[focal, 0, 320], [0, focal, 240], [0, 0, 1]])
    pixel, depth = left.project([-baseline / 2.0, 4.0, height])
    np.testing.assert_allclose(pixel, [320.0, 240.0], rtol=0, atol=PIXEL)
    assert depth == pytest.approx(4.0)
    assert left.project([0.0, 4.0, height + 1.0])[0][1] < 240.0  # what is higher in the world is higher in the picture


def test_the_arrays_of_a_camera_cannot_be_changed() -> None:
    K, T = np.diag([600.0, 600.0, 1.0]), np.eye(4)
    camera = Camera(K, T)
    K[0, 0] = T[0, 3] = 7.0
    assert (camera.K[0, 0], camera.t[0]) == (600.0, 0.0)
    for array in (camera.K, camera.T_camera_world, camera.R, camera.t):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


BAD_K = {
    "zero focal": [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    "negative focal": [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]],
    "not triangular": [[1.0, 0.0, 0.0], [0.1, 1.0, 0.0], [0.0, 0.0, 1.0]],
    "last row": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]],
    "nan": [[1.0, math.nan, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    "inf": [[math.inf, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    "shape": [[1.0, 0.0], [0.0, 1.0]],
    "flat": [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
}


@pytest.mark.parametrize("K", BAD_K.values(), ids=BAD_K.keys())
def test_bad_intrinsics_are_refused(K: list[list[float]]) -> None:
    with pytest.raises(GeometryError, match="K is"):
        Camera(np.array(K), np.eye(4))


@pytest.mark.parametrize(
    "T",
    [
        2.0 * np.eye(4),
        np.diag([1.0, 1.0, -1.0, 1.0]),
        np.eye(3),
        np.full((4, 4), math.nan),
        np.vstack([[1.0, 0.0, 0.0, math.inf], np.eye(4)[1:]]),
    ],
    ids=["scaled", "mirrored", "shape", "nan", "inf"],
)
def test_a_pose_that_is_not_rigid_is_refused(T: Array) -> None:
    with pytest.raises(GeometryError, match="T_camera_world is"):
        Camera(np.eye(3), T)


def test_sizes_that_are_not_positive_are_refused() -> None:
    camera = default_camera()
    for call in (
        lambda: camera.fov(0.0, 480.0),
        lambda: camera.fov(640.0, -1.0),
        lambda: camera.frustum_corners(640.0, 480.0, 0.0),
        lambda: camera.frustum_corners(math.nan, 480.0, 1.0),
        lambda: parallel_rig(-0.1, 600.0),
        lambda: parallel_rig(math.nan, 600.0),
        lambda: parallel_rig(0.5, 0.0),
    ):
        with pytest.raises(GeometryError):
            call()


@given(cameras, vectors(3, 10.0))
def test_depth_is_the_distance_along_the_optical_axis(camera: Camera, point: Array) -> None:
    depth = float(camera.project(point)[1])
    assert abs(depth - camera.R[2] @ (point - camera.center)) < EXACT * 100
    assume(depth > 0.1)
    x, y = camera.normalized(camera.project(point)[0])
    np.testing.assert_allclose(camera.to_camera(point), depth * np.array([x, y, 1.0]), rtol=0, atol=1e-9)
