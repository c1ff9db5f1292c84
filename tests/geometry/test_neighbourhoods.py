"""Covariances of neighbourhoods against those of the tree's own answers, one point at a time."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geometry import Array
from geometry.clouds import Indices, Neighbours, neighbourhoods
from geometry.clouds.neighbourhoods import covariances
from tests.geometry.cloud_shapes import DEGENERATE, blob, wavy
from tests.geometry.strategies import seeds

lattice = np.stack(np.meshgrid(*3 * [np.arange(11.0)]), axis=-1).reshape(-1, 3)
CLOUDS: dict[str, Array] = {
    "on surfaces": wavy(1, 3000),
    "in a volume": blob(2, 3000),
    "dense and sparse": np.concatenate([blob(3, 1500, 1e-4), blob(4, 1500, 10.0), [[1e6, 0.0, 0.0]]]),
    "far from the origin": wavy(5, 3000) + 1e6,
    "small beyond float32": 1e-30 * blob(6, 2000),
    "large beyond float32": 1e60 * blob(7, 2000),
    "on a plane": np.random.default_rng(8).random((2000, 3)) * [1.0, 1.0, 0.0],
    "on a line": np.random.default_rng(9).random((2000, 1)) * [1.0, 2.0, 3.0],
    "a lattice, all ties": lattice,
    "every point twice": np.repeat(wavy(10, 1000), 2, axis=0),
    "all in one place": np.full((1000, 3), 0.1),
} | {f"few: {name}": points for name, points in DEGENERATE.items() if name != "none"}


def one_at_a_time(near: Neighbours, rows: slice, count: int) -> tuple[Array, Array]:
    """Covariances (6, n) of what the tree finds for each point, and how far off the last of it is (n,)."""
    distance, places = near.nearest(rows, count)
    offsets = near.ordered[places] - near.ordered[rows][:, None]
    offsets -= offsets.mean(axis=1, keepdims=True)
    C = offsets.transpose(0, 2, 1) @ offsets / count
    return C[:, *np.triu_indices(3)].T, distance[:, -1]


@pytest.mark.parametrize("name", CLOUDS)
@pytest.mark.parametrize("count", [3, 16, 40])
def test_groups_find_what_each_point_finds_alone(name: str, count: int) -> None:
    near = Neighbours(CLOUDS[name])
    count = min(count, len(near))
    for rows in (slice(0, len(near)), slice(len(near) // 3, len(near) - 1)):
        expected, reach = one_at_a_time(near, rows, count)
        found = covariances(near, rows, count)
        assert (np.abs(found - expected) <= 1e-12 * reach * reach).all()


@settings(max_examples=15)
@given(seeds, st.integers(3, 50), st.integers(100, 2000), st.floats(0.0, 3.0))
def test_flat_and_thick_clouds_of_any_size(seed: int, count: int, length: int, thickness: float) -> None:
    near = Neighbours(blob(seed, length) * [1.0, 1.0, thickness])
    rows = slice(0, length)
    expected, reach = one_at_a_time(near, rows, count)
    assert (np.abs(covariances(near, rows, count) - expected) <= 1e-12 * reach * reach).all()


def test_on_a_surface_few_points_ask_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []
    alone = neighbourhoods._alone

    def counted(near: Neighbours, rows: Indices, count: int) -> Array:
        asked.append(len(rows))
        return alone(near, rows, count)

    monkeypatch.setattr(neighbourhoods, "_alone", counted)
    covariances(Neighbours(wavy(0, 8192)), slice(0, 8192), 16)
    assert 0 < sum(asked) < 800
