"""Outliers against all distances, and the clouds that have none."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.distance import cdist

from geometry import Array, GeometryError
from geometry.clouds import outliers
from tests.geometry.cloud_shapes import DEGENERATE, clouds, wavy


@given(clouds, st.integers(2, 20), st.floats(0.5, 3.0))
def test_brute_force_finds_the_same(points: Array, count: int, deviations: float) -> None:
    count = min(count, len(points))
    distance = np.sort(cdist(points, points), axis=1)[:, 1:count].sum(axis=1) / max(count - 1, 1)
    found = outliers(points, max(count, 2), deviations)
    np.testing.assert_allclose(found.distance, distance, rtol=0, atol=1e-12)
    threshold = distance.mean() + deviations * (distance.std(ddof=1) if len(points) > 1 else 0.0)
    assert found.threshold == pytest.approx(threshold, abs=1e-12)
    clear = np.abs(distance - threshold) > 1e-9
    np.testing.assert_array_equal(found.keep[clear], (distance <= threshold)[clear])


def test_the_mean_is_over_the_others() -> None:
    """Four points a metre apart on a line: the ends have theirs at 1 and 2, the middle ones at 1 and 1."""
    found = outliers(np.outer(np.arange(4.0), [1.0, 0.0, 0.0]), 3)
    np.testing.assert_allclose(found.distance, [1.5, 1.0, 1.0, 1.5])


def test_points_thrown_far_off_are_found() -> None:
    good = wavy(0, 2000)
    far = good[:20] - np.outer(np.arange(1, 21), [0.0, 0.0, 3.0])
    found = outliers(np.concatenate([good, far]), 12, 2.0)
    assert not found.keep[-20:].any()
    assert found.keep[:2000].mean() > 0.95


@pytest.mark.parametrize("name", DEGENERATE)
def test_degenerate_clouds_lose_nothing_they_should_keep(name: str) -> None:
    points = DEGENERATE[name]
    found = outliers(points, 8, 2.0)
    assert found.keep.shape == (len(points),)
    assert found.keep.mean() > 0.85 if len(points) else not len(found.keep)


def test_wrong_arguments_are_refused() -> None:
    with pytest.raises(GeometryError, match="neighbors"):
        outliers(wavy(0, 10), 1)
    with pytest.raises(GeometryError, match="deviations"):
        outliers(wavy(0, 10), 4, -1.0)
