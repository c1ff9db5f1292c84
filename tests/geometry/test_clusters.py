"""Clusters against all pairs of points, near the distance itself, and where cells are full."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse.csgraph import connected_components
from scipy.spatial.distance import cdist

from geometry import Array, GeometryError
from geometry.clouds import Indices, clusters
from tests.geometry.cloud_shapes import DEGENERATE, blob, clouds


def by_all_pairs(points: Array, distance: float) -> Indices:
    return np.asarray(connected_components(cdist(points, points) <= distance)[1])


def same_partition(a: Indices, b: Indices) -> bool:
    pairs = np.unique(np.stack([a, b]), axis=1)
    return bool(pairs.shape[1] == len(np.unique(a)) == len(np.unique(b)))


@given(clouds, st.floats(-2.0, 0.5))
def test_all_pairs_give_the_same_clusters(points: Array, power: float) -> None:
    distance = 10.0**power
    found = clusters(points, distance)
    assert same_partition(found.labels, by_all_pairs(points, distance))
    np.testing.assert_array_equal(found.sizes, np.bincount(found.labels))
    assert (np.diff(found.sizes) <= 0).all()


@pytest.mark.parametrize("gap", [0.999999, 1.0, 1.000001])
def test_the_distance_itself_still_joins(gap: float) -> None:
    points = np.array([[0.0, 0.0, 0.0], [gap, 0.0, 0.0]])
    assert len(clusters(points, 1.0).sizes) == (1 if gap <= 1.0 else 2)


@pytest.mark.parametrize(("gap", "expected"), [(0.99, 1), (1.01, 2)])
def test_full_cells_that_nearly_touch(gap: float, expected: int) -> None:
    rng = np.random.default_rng(0)
    left = rng.uniform(-0.2, 0.0, (3000, 3))
    right = rng.uniform(0.0, 0.2, (3000, 3)) + np.array([gap, 0.0, 0.0])
    left[:, 1:] *= 3.0
    right[:, 1:] *= 3.0
    left[0], right[0] = 0.0, [gap, 0.0, 0.0]
    found = clusters(np.concatenate([left, right]), 1.0)
    assert len(found.sizes) == expected


@settings(max_examples=12)
@given(st.integers(0, 2**32 - 1))
def test_full_cells_among_each_other(seed: int) -> None:
    rng = np.random.default_rng(seed)
    centers = rng.uniform(0.0, 3.0, (6, 3))
    points = np.concatenate([blob(seed + i, 150, 0.05, tuple(c)) for i, c in enumerate(centers)])
    for distance in (0.8, 1.2):
        assert same_partition(clusters(points, distance).labels, by_all_pairs(points, distance))


def test_small_clusters_are_left_out() -> None:
    points = np.concatenate([blob(0, 30, 0.01), blob(1, 5, 0.01) + 10.0, blob(2, 50, 0.01) - 10.0])
    found = clusters(points, 0.5, least=10)
    assert found.sizes.tolist() == [50, 30]
    np.testing.assert_array_equal(found.labels, np.repeat([1, -1, 0], [30, 5, 50]))


def test_far_clusters_keep_their_own_cells() -> None:
    points = np.concatenate([blob(i, 20, 0.01) + 10.0 ** (i + 1) * np.array([1.0, -1.0, 1.0]) for i in range(8)])
    assert clusters(points, 0.2).sizes.tolist() == [20] * 8


@pytest.mark.parametrize("name", DEGENERATE)
def test_degenerate_clouds_are_answered(name: str) -> None:
    points = DEGENERATE[name]
    found = clusters(points, 0.6)
    assert found.sizes.tolist() == ([len(points)] if len(points) else [])


def test_wrong_distances_are_refused() -> None:
    for distance in (0.0, -1.0, math.nan, 1e-17):
        with pytest.raises(GeometryError, match="distance"):
            clusters(blob(0, 10), distance)
