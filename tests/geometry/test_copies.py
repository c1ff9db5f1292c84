"""Clouds with very many points in one place: the answers are those of SciPy's tree of all points, and come at once."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from geometry import Array
from geometry.clouds import Neighbours, normals, outliers
from geometry.clouds.points import CHUNK
from tests.geometry.cloud_shapes import wavy

RNG = np.random.default_rng(5)
CLOUDS: dict[str, Array] = {
    "all in one place": np.full((3000, 3), 1.5),
    "some in one place": np.concatenate([wavy(1, 2000), np.full((1500, 3), 0.25)]),
    "in a few places": np.repeat(RNG.random((4, 3)), 900, axis=0),
    "two clumps far apart": np.repeat([[0.0, 0.0, 0.0], [1e6, 0.0, 0.0]], 1200, axis=0),
    "copies and a stray": np.concatenate([np.zeros((2000, 3)), [[5e6, 0.0, 0.0]], wavy(2, 500)]),
    "zeros of both signs": np.concatenate([np.zeros((700, 3)), np.full((700, 3), -0.0), wavy(3, 500)]),
}


@pytest.mark.parametrize("points", CLOUDS.values(), ids=CLOUDS.keys())
@pytest.mark.parametrize("count", [1, 2, 16, 256, 257])
def test_neighbours_are_as_near_as_those_of_the_whole_tree(points: Array, count: int) -> None:
    near = Neighbours(points)
    asked = np.concatenate([points[::97], points[:3] + 0.01])
    distances, places = near.query(asked, count)
    expected, _ = cKDTree(points).query(asked, count)
    np.testing.assert_array_equal(distances, expected)
    found = near.ordered[places.reshape(len(asked), -1)] - asked[:, None]
    np.testing.assert_allclose(np.linalg.norm(found, axis=2), expected.reshape(len(asked), -1), rtol=1e-12)


def test_none_within_reach_has_the_place_behind_the_last() -> None:
    near = Neighbours(CLOUDS["some in one place"])
    distances, places = near.query(np.array([[1e3, 0.0, 0.0]]), 2, distance_upper_bound=1.0)
    assert np.isinf(distances).all()
    assert (places == len(near)).all()


@pytest.mark.parametrize("name", ["all in one place", "in a few places"])
def test_work_on_copies_asks_after_each_chunk_whether_it_is_wanted(name: str) -> None:
    points = np.repeat(CLOUDS[name], 20, axis=0)
    asked: list[float] = []
    normals(points, 16, progress=asked.append)
    assert len(asked) >= len(points) // CHUNK
    asked.clear()
    outliers(points, 16, 2.0, progress=asked.append)
    assert len(asked) >= len(points) // CHUNK

    def enough(done: float) -> None:
        raise TimeoutError

    with pytest.raises(TimeoutError):
        normals(points, 16, progress=enough)
