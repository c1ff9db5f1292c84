"""Voxel grid: against a dictionary of cells, at faces of cells, far from the origin, and without points."""

import math
from collections import defaultdict

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geometry import Array, GeometryError
from geometry.clouds import bounds, voxels
from geometry.clouds.points import MANY
from tests.geometry.cloud_shapes import DEGENERATE, blob, clouds, wavy

sizes = st.floats(-2.5, 1.0).map(lambda power: 10.0**power)


def by_dictionary(points: Array, size: float) -> dict[tuple[int, ...], list[int]]:
    """The cells as Open3D numbers them, and the points in each."""
    start = points.min(axis=0) - 0.5 * size
    cells: dict[tuple[int, ...], list[int]] = defaultdict(list)
    for index, point in enumerate(points):
        cells[tuple(math.floor(c) for c in ((point - start) / size).tolist())].append(index)
    return dict(sorted(cells.items()))


@given(clouds, sizes)
def test_each_cell_gives_the_mean_of_its_points(points: Array, size: float) -> None:
    cells = by_dictionary(points, size)
    found = voxels(points, size)
    np.testing.assert_array_equal(found.counts, [len(members) for members in cells.values()])
    expected = [points[members].mean(axis=0) for members in cells.values()]
    np.testing.assert_allclose(found.points, expected, rtol=0, atol=1e-12)
    for label, members in enumerate(cells.values()):
        assert set(np.flatnonzero(found.labels == label)) == set(members)


@pytest.mark.parametrize("size", [3.0, 0.2, 0.003, 1e-7, 1e-12])
def test_table_sorting_and_ranking_agree_with_the_dictionary(size: float) -> None:
    points = wavy(3, 3000)
    cells = by_dictionary(points, size)
    found = voxels(points, size)
    np.testing.assert_array_equal(found.counts, [len(members) for members in cells.values()])
    assert [found.labels[members[0]] for members in cells.values()] == list(range(len(cells)))


@given(clouds, sizes)
def test_the_centre_of_all_points_stays(points: Array, size: float) -> None:
    found = voxels(points, size)
    assert found.counts.sum() == len(points)
    np.testing.assert_allclose(found.counts @ found.points / len(points), points.mean(axis=0), rtol=0, atol=1e-12)


@given(clouds, sizes)
def test_attributes_are_averaged_like_the_points(points: Array, size: float) -> None:
    found = voxels(points, size)
    np.testing.assert_allclose(found.mean(points), found.points, rtol=0, atol=1e-11)
    np.testing.assert_allclose(found.mean(points[:, 2]), found.points[:, 2], rtol=0, atol=1e-11)


def test_chunks_and_threads_change_nothing() -> None:
    points = wavy(2, MANY + 10_000)
    found = voxels(points, 0.1)
    np.testing.assert_array_equal(bounds(points), [points.min(axis=0), points.max(axis=0)])
    cells = np.floor((points - found.origin) / 0.1)
    _, labels, counts = np.unique(cells, axis=0, return_inverse=True, return_counts=True)
    np.testing.assert_array_equal(found.labels, labels)
    np.testing.assert_array_equal(found.counts, counts)
    sums = np.zeros_like(found.points)
    np.add.at(sums, labels, points)
    np.testing.assert_allclose(found.points, sums / counts[:, None], rtol=0, atol=1e-12)


def test_a_given_origin_makes_the_same_cells_for_other_points() -> None:
    points = wavy(0, 2000)
    whole = voxels(points, 0.25, origin=np.zeros(3))
    part = voxels(points[points[:, 0] < 3.0], 0.25, origin=np.zeros(3))
    np.testing.assert_allclose(part.points, whole.points[whole.points[:, 0] < 3.0], rtol=0, atol=1e-12)


def test_a_point_on_a_face_belongs_to_the_cell_above() -> None:
    points = np.array([[0.0, 0.0, 0.0], [0.999, 0.0, 0.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    np.testing.assert_array_equal(voxels(points, 1.0, origin=np.zeros(3)).labels, [1, 1, 2, 0])


def test_a_cell_in_far_coordinates_keeps_millimetres() -> None:
    points = wavy(1, 2000)
    far = np.array([4.5e5, 5.4e6, 300.0])
    near = voxels(points, 0.5)
    np.testing.assert_allclose(voxels(points + far, 0.5, origin=near.origin + far).points - far, near.points, atol=1e-8)


@pytest.mark.parametrize("name", DEGENERATE)
def test_degenerate_clouds_are_answered(name: str) -> None:
    points = DEGENERATE[name]
    found = voxels(points, 0.05)
    assert found.counts.sum() == len(points) == len(found.labels)
    one = voxels(points, 1e3)
    assert len(one.points) == min(len(points), 1)


def test_one_far_outlier_is_a_cell_of_its_own() -> None:
    points = np.concatenate([blob(0, 50), [[1e6, -1e6, 1e6]]])
    found = voxels(points, 1e-4)
    assert len(found.points) == 51
    np.testing.assert_allclose(found.points[found.labels], points, rtol=0, atol=1e-9)


@pytest.mark.parametrize("size", [0.0, -1.0, math.nan, math.inf, 1e-17])
def test_wrong_sizes_are_refused(size: float) -> None:
    with pytest.raises(GeometryError, match="size"):
        voxels(wavy(0, 10), size)


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_points_that_are_not_finite_are_refused(bad: float) -> None:
    points = wavy(0, 10)
    points[3, 1] = bad
    with pytest.raises(GeometryError, match="1 of 10 points"):
        voxels(points, 0.1)


@pytest.mark.parametrize("points", [np.zeros(3), np.zeros((2, 2)), np.zeros((2, 2, 3)), "abc"])
def test_wrong_shapes_are_refused(points: object) -> None:
    with pytest.raises(GeometryError, match="points"):
        voxels(points, 0.1)  # type: ignore[arg-type]
    with pytest.raises(GeometryError, match="values"):
        voxels(np.zeros((4, 3)), 0.1).mean(np.zeros(3))
