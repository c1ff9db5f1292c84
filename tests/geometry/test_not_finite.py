"""NaN and infinity in one row of a batch: nothing finite in that row, no change in the others, and no warning."""

import contextlib
import math
from collections.abc import Callable

import numpy as np
import pytest

from geometry import (
    Array,
    GeometryError,
    epipolar,
    euler,
    gimbal,
    projection,
    quaternion,
    rotations,
    se3,
    triangulation,
)
from geometry.affine_camera import AffineCamera
from geometry.camera import Camera, parallel_rig
from geometry.distortion import Distortion

LEFT, RIGHT = parallel_rig(0.6, 600.0)
CAMERA = Camera.from_intrinsics(600.0, 500.0, 320.0, 240.0, 10.0, T_camera_world=np.eye(4))
F = epipolar.fundamental(LEFT, RIGHT)
q = np.array([0.5, 0.5, -0.5, 0.5])
R = quaternion.to_matrix([0.9, 0.1, -0.2, 0.3])
T = se3.transform(R, [1.0, 2.0, 3.0])
uv = np.array([300.0, 200.0])
point = np.array([0.1, 3.0, 1.2])
in_view = np.array([0.1, 0.2, 3.0])

Function = Callable[[Array], Array]
CASES: dict[str, tuple[Function, Array]] = {
    "axis_rotation": (lambda a: rotations.axis_rotation("x", a), np.array(0.3)),
    "axis_angle_to_matrix, axis": (lambda v: rotations.axis_angle_to_matrix(v, 0.3), point),
    "axis_angle_to_matrix, angle": (lambda a: rotations.axis_angle_to_matrix(point, a), np.array(0.3)),
    "matrix_to_axis_angle": (lambda M: rotations.matrix_to_axis_angle(M)[0], R),
    "rotation_angle": (rotations.rotation_angle, R),
    "unit": (rotations.unit, point),
    "quaternion.normalize": (quaternion.normalize, q),
    "quaternion.from_axis_angle": (lambda a: quaternion.from_axis_angle(point, a), np.array(0.3)),
    "quaternion.to_axis_angle": (lambda p: quaternion.to_axis_angle(p)[0], q),
    "quaternion.from_matrix": (quaternion.from_matrix, R),
    "quaternion.to_matrix": (quaternion.to_matrix, q),
    "quaternion.multiply": (lambda p: quaternion.multiply(p, p), q),
    "quaternion.rotate, q": (lambda p: quaternion.rotate(p, point), q),
    "quaternion.rotate, point": (lambda p: quaternion.rotate(q, p), point),
    "euler_to_matrix": (lambda a: euler.euler_to_matrix(a, "zxz", "extrinsic"), point),
    "matrix_to_euler": (lambda M: euler.matrix_to_euler(M, "zyx", "intrinsic")[0], R),
    "lock_distance": (lambda a: euler.lock_distance(a, "zyx"), np.array(0.3)),
    "gimbal.ring_rates": (lambda v: gimbal.ring_rates(0.3, 0.4, v), point),
    "gimbal.ring_rates, pitch": (lambda a: gimbal.ring_rates(0.3, a, point), np.array(0.4)),
    "se3.transform": (lambda M: se3.transform(M, point)[..., :3, :3], R),
    "se3.apply": (lambda p: se3.apply(T, p), point),
    "se3.from_homogeneous": (lambda h: se3.from_homogeneous(h)[0], q),
    "camera.project": (lambda p: CAMERA.project(p)[0], in_view),
    "camera.pixel_ray": (lambda p: CAMERA.pixel_ray(p)[1], uv),
    "affine_camera.project": (lambda p: AffineCamera(CAMERA, 2.0).project(p)[0], in_view),
    "distortion.apply": (Distortion(-0.2, 0.05, 1e-3, 2e-3).apply, np.array([0.3, -0.2])),
    "distortion.undo": (Distortion(-0.2, 0.05, 1e-3, 2e-3).undo, np.array([0.3, -0.2])),
    "vanishing_points": (lambda d: projection.vanishing_points(CAMERA.P, d)[0], in_view),
    "epipolar_line_right": (lambda p: epipolar.epipolar_line_right(F, p), uv),
    "epipolar_line_left": (lambda p: epipolar.epipolar_line_left(F, p), uv),
    "epipolar_residual": (lambda p: epipolar.epipolar_residual(F, p, [200.0, 210.0]), uv),
    "sampson_distance": (lambda p: epipolar.sampson_distance(F, p, [200.0, 210.0]), uv),
    "triangulate_dlt": (lambda p: triangulation.triangulate_dlt(LEFT, RIGHT, p, [200.0, 200.0]).point, uv),
    "triangulate_midpoint": (lambda p: triangulation.triangulate_midpoint(LEFT, RIGHT, p, [200.0, 200.0]).point, uv),
    "triangulate_optimal": (lambda p: triangulation.triangulate_optimal(LEFT, RIGHT, p, [200.0, 200.0]).point, uv),
    "reprojection_errors": (lambda p: triangulation.reprojection_errors(LEFT, RIGHT, p, uv, uv), point),
    "projection_jacobian": (lambda p: triangulation.projection_jacobian(CAMERA, p), in_view),
    "covariance": (lambda p: triangulation.covariance((LEFT, RIGHT), p, 1.0), point),
    "ellipsoid_axes": (lambda C: triangulation.ellipsoid_axes(C)[0], np.diag([1.0, 4.0, 9.0])),
    "depth_from_disparity": (lambda d: triangulation.depth_from_disparity(d, 0.6, 600.0), np.array(10.0)),
    "depth_sigma": (lambda z: triangulation.depth_sigma(z, 0.6, 600.0, 1.0), np.array(4.0)),
}
cases = pytest.mark.parametrize(("function", "good"), CASES.values(), ids=CASES.keys())


def spoilt(good: Array, value: float) -> list[Array]:
    """The argument with one of its entries replaced, each in turn."""
    copies = [good.copy() for _ in range(max(good.size, 1))]
    for entry, copy in enumerate(copies):
        copy.reshape(-1)[entry] = value
    return copies


@cases
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_only_the_row_is_spoilt(function: Function, good: Array, value: float) -> None:
    expected = function(good)
    assert np.isfinite(expected).all()
    for bad in spoilt(good, value):
        first, second, third = function(np.stack([good, bad, good]))
        np.testing.assert_allclose(first, expected, rtol=1e-12, atol=1e-12)
        np.testing.assert_allclose(third, expected, rtol=1e-12, atol=1e-12)
        assert not np.isfinite(second).any()


@cases
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_one_alone_is_refused_or_nan(function: Function, good: Array, value: float) -> None:
    for bad in spoilt(good, value):
        with contextlib.suppress(GeometryError):
            assert not np.isfinite(function(bad)).any()


@cases
def test_an_empty_batch_has_an_empty_answer(function: Function, good: Array) -> None:
    assert function(np.empty((0, *good.shape))).shape == (0, *function(good).shape)
