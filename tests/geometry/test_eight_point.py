"""F from matching pixels: against the F they came from, against OpenCV, and where they don't fix it."""

import math

import cv2
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from geometry import Array, GeometryError
from geometry.camera import Camera
from geometry.eight_point import eight_point
from geometry.epipolar import fundamental, sampson_distance
from tests.geometry.strategies import pose, seeds, stereo_pair

Matches = tuple[Camera, Camera, Array, Array]


def matches(seed: int, count: int, *, flat: bool = False) -> Matches:
    """Two cameras of any pose and the pixels of points in front of both, all on one plane if `flat`."""
    left, right = stereo_pair(seed)
    rng = np.random.default_rng(seed + 2)
    found: list[Array] = []
    while len(found) < count:
        x, y, z = rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5), rng.uniform(2.0, 8.0)
        z = 4.0 + x - 2.0 * y if flat else z
        point = left.center + left.R.T @ ([x, y, z] if flat else [x * z, y * z, z])
        if min(left.project(point)[1], right.project(point)[1]) > 0.5:
            found.append(point)
    return left, right, left.project(np.array(found))[0], right.project(np.array(found))[0]


counts = st.integers(8, 30)


@given(seeds, counts)
def test_exact_pixels_give_the_f_they_came_from(seed: int, count: int) -> None:
    left, right, u, v = matches(seed, count)
    found = eight_point(u, v)
    assume(found.conditioning > 1e-4)
    F = fundamental(left, right)
    sign = np.sign((found.F * F).sum())
    np.testing.assert_allclose(found.F, sign * F, rtol=0, atol=1e-8)
    assert sampson_distance(found.F, u, v).max() < 1e-7
    assert found.singular_values[2] < 1e-8


@given(seeds, counts, st.floats(0.01, 3.0))
def test_noisy_pixels_give_opencvs_f_of_rank_two(seed: int, count: int, sigma: float) -> None:
    _, _, u, v = matches(seed, count)
    noise = np.random.default_rng(seed).normal(0.0, sigma, (2, count, 2))
    u, v = (picture.astype(np.float32).astype(float) for picture in (u + noise[0], v + noise[1]))  # OpenCV's
    found = eight_point(u, v)
    assert abs(np.linalg.norm(found.F) - 1.0) < 1e-12
    assert np.linalg.svd(found.F)[1][2] < 1e-12
    assume(found.conditioning > 1e-3)
    expected, _ = cv2.findFundamentalMat(u, v, cv2.FM_8POINT)
    expected = expected / np.linalg.norm(expected)
    # OpenCV solves the normal equations, which squares the conditioning.
    np.testing.assert_allclose(found.F, np.sign((found.F * expected).sum()) * expected, rtol=0, atol=1e-9)


@given(seeds, st.floats(0.1, 10.0), st.floats(-3.0, 3.0), st.floats(-500.0, 500.0))
def test_the_answer_does_not_depend_on_where_pixels_are_counted_from(
    seed: int, scale: float, angle: float, shift: float
) -> None:
    """Similarities of a picture change F as they must; without normalisation they wouldn't."""
    _, _, u, v = matches(seed, 12)
    u = u + np.random.default_rng(seed).normal(0.0, 0.5, u.shape)
    found = eight_point(u, v)
    assume(found.conditioning > 1e-3)
    T = np.array(
        [
            [scale * math.cos(angle), -scale * math.sin(angle), shift],
            [scale * math.sin(angle), scale * math.cos(angle), -shift],
            [0.0, 0.0, 1.0],
        ]
    )
    moved = eight_point(u @ T[:2, :2].T + T[:2, 2], v)
    back = moved.F @ T
    back *= np.sign((back * found.F).sum()) / np.linalg.norm(back)
    np.testing.assert_allclose(back, found.F, rtol=0, atol=1e-7)
    assert moved.conditioning == pytest.approx(found.conditioning, rel=1e-6)


def turned(camera: Camera, seed: int) -> Camera:
    R = Rotation.from_rotvec(np.random.default_rng(seed).uniform(-0.2, 0.2, 3)).as_matrix() @ camera.R
    return Camera(camera.K, pose(R, -R @ camera.center))


@given(seeds, counts)
def test_points_on_a_plane_and_cameras_that_only_turn_fix_no_f(seed: int, count: int) -> None:
    left, _, u, v = matches(seed, count, flat=True)
    points = left.center + (left.normalized(u) @ left.R[:2] + left.R[2]) * 5.0
    w = turned(left, seed).project(points)[0]
    assume(np.isfinite(w).all())
    for found in (eight_point(u, v), eight_point(u, w)):
        assert not found.unique
        assert found.conditioning == 0.0
        assert np.isnan(found.F).all()


@pytest.mark.parametrize("count", [8, 9, 20])
def test_pixels_that_coincide_fix_no_f(count: int) -> None:
    one = np.full((count, 2), 320.0)
    other = np.random.default_rng(0).uniform(0.0, 480.0, (count, 2))
    for u, v in ((one, one), (one, other), (other, one), (np.zeros((count, 2)), other)):
        assert not eight_point(u, v).unique


@pytest.mark.parametrize(
    ("u", "v", "argument"),
    [
        (np.zeros((7, 2)), np.zeros((7, 2)), "uv_left"),
        (np.zeros(2), np.zeros(2), "uv_left"),
        (np.zeros((8, 3)), np.zeros((8, 2)), "uv_left"),
        (np.zeros((8, 2)), np.zeros((9, 2)), "uv_right"),
        (np.full((8, 2), math.nan), np.zeros((8, 2)), "uv_left"),
        (np.zeros((8, 2)), np.full((8, 2), math.inf), "uv_right"),
    ],
)
def test_input_that_is_wrong_as_a_whole_is_refused(u: Array, v: Array, argument: str) -> None:
    with pytest.raises(GeometryError) as caught:
        eight_point(u, v)
    assert caught.value.argument == argument
