"""RANSAC planes: found again in noise and clutter, the same for a seed, and refused where there are none."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geometry import Array, GeometryError
from geometry.clouds import fit_plane, ransac_plane
from tests.geometry.cloud_shapes import blob
from tests.geometry.strategies import rotations, seeds


def flat(seed: int, count: int, noise: float) -> Array:
    rng = np.random.default_rng(seed)
    return np.concatenate([rng.uniform(-4.0, 4.0, (count, 2)), rng.normal(0.0, noise, (count, 1))], axis=1)


@given(seeds, rotations, st.floats(-10.0, 10.0), st.floats(0.0, 0.5))
def test_a_plane_is_found_in_clutter(seed: int, R: Array, height: float, clutter: float) -> None:
    points = flat(seed, 600, 0.01)
    others = np.random.default_rng(seed + 1).uniform(-4.0, 4.0, (int(600 * clutter), 3))
    placed = (np.concatenate([points, others]) + np.array([0.0, 0.0, height])) @ R.T
    found = ransac_plane(placed, 0.04, seed=seed)
    normal = R[:, 2] * np.sign(R[2, 2] or 1.0)
    assert abs(found.normal @ normal) > math.cos(0.005)
    assert abs(abs(found.offset) - abs(height)) < 0.02
    assert found.inliers[:600].mean() > 0.99
    assert 0.005 < found.rms < 0.02
    assert found.spread == pytest.approx(8.0 / math.sqrt(12.0), rel=0.15)
    np.testing.assert_array_equal(found.inliers, np.abs(found.distance(placed)) <= 0.04)


@given(seeds, rotations, st.floats(-100.0, 100.0))
def test_points_on_a_plane_give_that_plane(seed: int, R: Array, height: float) -> None:
    points = (flat(seed, 50, 0.0) + np.array([0.0, 0.0, height])) @ R.T
    found = ransac_plane(points, 1e-6, seed=seed)
    assert found.inliers.all()
    assert np.linalg.norm(np.cross(found.normal, R[:, 2])) < 1e-12 * 10
    assert abs(found.offset + found.normal @ (height * R[:, 2])) < 1e-12 * 1e3


def test_the_fit_is_least_squares() -> None:
    points = flat(0, 300, 0.05)
    normal, center, variances = fit_plane(points)
    residual = ((points - center) @ normal).std()
    assert residual == pytest.approx(math.sqrt(variances[0]), rel=1e-9)
    for axis in np.eye(3)[:2]:
        for tilt in (-1e-3, 1e-3):
            other = normal + tilt * axis
            assert ((points - center) @ (other / np.linalg.norm(other))).std() > residual


def test_the_same_seed_gives_the_same_plane() -> None:
    points = np.concatenate([flat(0, 500, 0.02), blob(1, 500)])
    first, second = (ransac_plane(points, 0.05, seed=7) for _ in range(2))
    assert first.normal.tolist() == second.normal.tolist()
    assert first.offset == second.offset


def test_with_up_walls_are_no_ground() -> None:
    wall = flat(0, 2000, 0.01)[:, [2, 0, 1]]
    points = np.concatenate([wall, flat(1, 500, 0.01) - [0.0, 0.0, 4.0]])
    assert abs(ransac_plane(points, 0.05).normal[0]) > 0.999
    ground = ransac_plane(points, 0.05, up=[0.0, 0.0, 2.0], tilt=0.3)
    assert ground.normal[2] > 0.999
    assert ground.offset == pytest.approx(4.0, abs=0.01)


@pytest.mark.parametrize(
    ("points", "message"),
    [
        (np.zeros((0, 3)), "at least three"),
        (np.eye(3)[:2], "at least three"),
        (np.zeros((10, 3)), "on a line"),
        (np.outer(np.arange(9.0), [1.0, 2.0, 3.0]), "on a line"),
    ],
)
def test_what_spans_no_plane_is_refused(points: Array, message: str) -> None:
    with pytest.raises(GeometryError, match=message):
        ransac_plane(points, 0.1)
    with pytest.raises(GeometryError, match=message):
        fit_plane(points)


def test_a_tilt_that_nothing_has_is_refused() -> None:
    with pytest.raises(GeometryError, match="tilt"):
        ransac_plane(flat(0, 50, 0.0)[:, [2, 0, 1]], 0.1, up=[0.0, 0.0, 1.0], tilt=0.1)
    with pytest.raises(GeometryError, match="up"):
        ransac_plane(flat(0, 50, 0.0), 0.1, up=[0.0, 0.0, 0.0])


def test_three_points_are_enough() -> None:
    found = ransac_plane(np.eye(3), 1e-9)
    np.testing.assert_allclose(found.normal, np.full(3, 1.0 / math.sqrt(3.0)), atol=1e-12)
    assert found.offset == pytest.approx(-1.0 / math.sqrt(3.0), abs=1e-12)


def test_points_over_hundreds_of_powers_of_ten_that_no_plane_holds_are_refused_in_words() -> None:
    points = 10.0 ** np.random.default_rng(1).uniform(-300.0, 3.0, (2000, 3))
    with pytest.raises(GeometryError, match="no plane"):
        ransac_plane(points, 1e-200, up=np.array([0.0, 0.0, 1.0]), tilt=0.35)
