"""What the lesson on point clouds computes, on clouds small enough to check by hand."""

from __future__ import annotations

import numpy as np
import pytest

from geometry import clouds, rotations, se3

RNG = np.random.default_rng(3)
PATCH = RNG.uniform(-1.0, 1.0, (200, 3)) * (1.0, 0.5, 0.01)


def test_the_normal_is_the_direction_of_least_scatter_and_the_fraction_says_how_flat() -> None:
    near = clouds.neighbourhood(PATCH, 0, 16)
    around = PATCH[near.rows]
    values, directions = np.linalg.eigh(np.cov(around.T, bias=True))
    np.testing.assert_allclose(near.eigenvalues, values, atol=1e-12)
    assert abs(near.axes[0] @ directions[:, 0]) == pytest.approx(1.0)
    found = clouds.normals(PATCH, 16)
    assert abs(found.normals[0] @ directions[:, 0]) == pytest.approx(1.0)
    assert found.variation[0] == pytest.approx(values[0] / values.sum())


def test_all_points_of_a_voxel_become_their_mean() -> None:
    cells = clouds.voxels(PATCH, 0.3)
    for k in range(len(cells.points)):
        np.testing.assert_allclose(cells.points[k], PATCH[cells.labels == k].mean(axis=0))


def test_twice_the_edge_leaves_about_a_quarter_of_a_surface() -> None:
    wall = RNG.uniform(0.0, 4.0, (40_000, 3)) * (1.0, 1.0, 0.0)
    fine, coarse = (len(clouds.voxels(wall, edge).points) for edge in (0.1, 0.2))
    assert fine / coarse == pytest.approx(4.0, rel=0.1)


def test_the_error_of_a_registration_is_the_sum_of_squares_that_the_lesson_has() -> None:
    target = RNG.uniform(-1.0, 1.0, (300, 3))
    T = se3.transform(rotations.axis_rotation("z", 0.02), np.array([0.02, -0.01, 0.01]))
    source = se3.apply(se3.inverse(T), target)
    steps = list(clouds.icp(source, clouds.Target(target), 0.5, method="point"))
    for step in steps:
        moved, paired = se3.apply(step.T_target_source, source), step.target >= 0
        R, t = step.T_target_source[:3, :3], step.T_target_source[:3, 3]
        q = target[step.target[paired]]
        assert step.error == pytest.approx(float(((source[paired] @ R.T + t - q) ** 2).sum()), abs=1e-12)
        nearest = ((moved[:, None] - target) ** 2).sum(axis=2).argmin(axis=1)
        np.testing.assert_array_equal(step.target[paired], nearest[paired])
    np.testing.assert_allclose(steps[-1].T_target_source, T, atol=1e-6)
