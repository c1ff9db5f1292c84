"""Normals against NumPy's eigenvectors of brute-force neighbourhoods, and where there are none."""

import math

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.spatial import cKDTree
from scipy.spatial.distance import cdist

from geometry import Array, GeometryError
from geometry.clouds import neighbourhood, normals, spacing
from geometry.clouds.eigen import least_eigenvectors
from tests.geometry.cloud_shapes import DEGENERATE, clouds, wavy
from tests.geometry.strategies import rotations, seeds


def angles(a: Array, b: Array) -> Array:
    """Between lines, in radians, precise near zero."""
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.abs(np.vecdot(a, b))))


def by_brute_force(points: Array, count: int) -> tuple[Array, Array]:
    """Eigenvalues and normals from all distances, by LAPACK."""
    near = np.argsort(cdist(points, points), axis=1)[:, :count]
    covariances = np.stack([np.cov(points[rows].T, bias=True) for rows in near])
    values, vectors = np.linalg.eigh(covariances)
    return values, vectors[:, :, 0]


@given(clouds, st.integers(3, 30))
def test_brute_force_finds_the_same(points: Array, count: int) -> None:
    found = normals(points, count)
    if len(points) < 3:
        assert not found.defined.any()
        return
    values, vectors = by_brute_force(points, min(count, len(points)))
    np.testing.assert_allclose(found.eigenvalues, values, rtol=0, atol=2e-8 * values.max())
    np.testing.assert_allclose(found.eigenvalues[:, 0], values[:, 0], rtol=0, atol=1e-12 * values.max())
    distinct = values[:, 1] - values[:, 0] > 1e-6 * values[:, 2]
    assert found.defined[distinct].all()
    assert angles(found.normals, vectors)[distinct].max(initial=0.0) < 1e-6


@pytest.mark.parametrize("count", [20_000])
def test_chunks_and_threads_change_nothing(count: int) -> None:
    points = wavy(5, count)
    found = normals(points, 12)
    sample = np.random.default_rng(0).integers(count, size=200)
    for index in sample:
        near = np.argsort(((points - points[index]) ** 2).sum(axis=1))[:12]
        expected = np.linalg.eigh(np.cov(points[near].T))[1][:, 0]
        assert angles(found.normals[index], expected) < 1e-6


@given(seeds, rotations)
def test_normals_turn_with_the_cloud(seed: int, R: Array) -> None:
    points = wavy(seed, 200)
    found, turned = normals(points, 10), normals(points @ R.T, 10)
    clear = found.eigenvalues[:, 1] - found.eigenvalues[:, 0] > 1e-3 * found.eigenvalues[:, 2]
    assert angles(turned.normals, found.normals @ R.T)[clear].max() < 1e-6
    np.testing.assert_allclose(turned.variation, found.variation, rtol=0, atol=1e-9)


def test_a_plane_has_no_variation_and_a_ball_has_much() -> None:
    plane = DEGENERATE["on a plane"]
    found = normals(plane, 8)
    assert angles(found.normals, np.array([[0.0, 0.0, 1.0]])).max() < 1e-7
    assert found.variation.max() < 1e-12
    ball = np.random.default_rng(0).normal(size=(500, 3))
    assert 0.2 < normals(ball, 400).variation.mean() <= 1.0 / 3.0


@given(seeds)
def test_normals_point_to_the_sensor_and_up_without_one(seed: int) -> None:
    points = wavy(seed, 150)
    assert (normals(points, 8).normals[:, 2] >= 0.0).all()
    for sensor in (np.array([3.0, 1.0, 2.0]), np.array([3.0, 3.0, -5.0]), points + np.array([0.1, -0.2, 0.3])):
        assert (np.vecdot(normals(points, 8, sensor=sensor).normals, sensor - points) >= 0.0).all()


@pytest.mark.parametrize("name", ["none", "one", "two", "all in one place", "on a line"])
def test_where_there_is_no_normal_there_is_nan(name: str) -> None:
    points = DEGENERATE[name]
    found = normals(points, 8)
    assert found.normals.shape == found.eigenvalues.shape == points.shape
    assert not found.defined.any()
    assert np.isnan(found.normals).all()
    assert np.isfinite(found.variation).all()


def test_only_the_points_without_a_normal_are_nan() -> None:
    far_line = DEGENERATE["on a line"] + 100.0
    found = normals(np.concatenate([wavy(0, 300), far_line]), 8)
    np.testing.assert_array_equal(found.defined, np.arange(340) < 300)
    np.testing.assert_array_equal(np.isfinite(found.normals).all(axis=1), found.defined)


@given(rotations, st.floats(-12.0, 0.0), st.floats(-12.0, 0.0), st.floats(-6.0, 6.0))
@example(np.eye(3), -5.0, -1.0, 0.0)
def test_closed_form_eigenvectors_near_double_roots(R: Array, gap: float, thickness: float, scale: float) -> None:
    low = 10.0**thickness
    values = 10.0**scale * np.array([low, min(low + 10.0**gap, 1.0), 1.0])
    C = (R * values) @ R.T
    found, vectors, defined = least_eigenvectors(
        [np.array([C[i, j]]) for i, j in zip(*np.triu_indices(3), strict=True)]
    )
    assert (np.diff(found[0]) >= -1e-15 * values[2]).all()
    np.testing.assert_allclose(found[0], values, rtol=0, atol=2e-8 * values[2])
    assert abs(found[0, 0] - values[0]) < 1e-12 * values[2]
    assert abs(found[0].sum() - values.sum()) < 1e-14 * values[2]
    relative = (values[1] - values[0]) / values[2]
    if relative > 1e-9:
        assert defined[0]
        assert angles(vectors[0], R[:, 0]) < 1e-12 / relative + 1e-12


def test_progress_rises_to_one_and_can_end_the_work() -> None:
    seen: list[float] = []
    normals(wavy(0, 40_000), 8, progress=seen.append)
    assert seen == sorted(seen)
    assert len(seen) > 3
    assert seen[-1] == 1.0

    def stop(done: float) -> None:
        if done > 0.3:
            raise InterruptedError

    with pytest.raises(InterruptedError):
        normals(wavy(0, 40_000), 8, progress=stop)


@given(clouds, st.integers(1, 30), seeds)
def test_one_neighbourhood_is_that_of_a_tree(points: Array, count: int, seed: int) -> None:
    if not len(points):
        with pytest.raises(GeometryError, match="index"):
            neighbourhood(points, 0)
        return
    index, count = seed % len(points), min(count, len(points))
    found = neighbourhood(points, index, count)
    distances = np.linalg.norm(points[found.rows] - points[index], axis=1)
    wanted = np.atleast_1d(cKDTree(points).query(points[index], count)[0])
    np.testing.assert_allclose(distances, wanted, rtol=1e-12, atol=1e-12 * max(1.0, np.abs(points).max()))
    assert found.rows[0] == index
    assert len(set(found.rows.tolist())) == count
    size = np.abs(points[found.rows] - points[index]).max()
    covariance = np.cov(points[found.rows].T, bias=True) if count > 1 else np.zeros((3, 3))
    np.testing.assert_allclose(found.axes.T * found.eigenvalues @ found.axes, covariance, rtol=0, atol=1e-12 * size**2)
    np.testing.assert_allclose(found.center, points[found.rows].mean(axis=0), atol=1e-12 * np.abs(points).max())


def test_a_neighbourhood_on_a_line_is_not_flat() -> None:
    line = np.outer(np.arange(9.0), [1.0, 2.0, 3.0])
    assert not neighbourhood(line, 4, 5).flat
    assert neighbourhood(wavy(0, 300), 4, 16).flat


def test_spacing_is_the_distance_of_neighbours() -> None:
    grid = np.stack(np.meshgrid(*3 * [np.arange(5.0)]), axis=-1).reshape(-1, 3)
    assert spacing(0.25 * grid) == pytest.approx(0.25, abs=1e-12)
    with pytest.raises(GeometryError, match="at least two"):
        spacing(np.zeros((1, 3)))


@pytest.mark.parametrize("count", [2, math.nan])
def test_too_few_neighbours_are_refused(count: float) -> None:
    with pytest.raises(GeometryError, match="neighbors"):
        normals(wavy(0, 10), count)  # type: ignore[arg-type]
