"""Picking: against a loop over all points, in front only, and not through the nearest surface."""

import math

import numpy as np
import pytest
from hypothesis import given

from geometry import Array, GeometryError
from geometry.clouds import pick
from tests.geometry.cloud_shapes import blob, wavy
from tests.geometry.strategies import rotations, seeds, units


@given(seeds, units())
def test_a_ray_through_a_point_picks_it_or_one_before_it(seed: int, direction: Array) -> None:
    points = blob(seed, 200)
    origin = points[17] - 5.0 * direction
    found = pick(points, origin, direction)
    assert found is not None
    assert found.along <= 5.0 + 1e-9
    offset = points[found.index] - origin
    assert found.along == pytest.approx(offset @ direction, abs=1e-12)
    assert found.off == pytest.approx(np.linalg.norm(np.cross(offset, direction)), abs=1e-9)
    if found.index == 17:
        assert found.off < 1e-9


@given(seeds, units())
def test_a_loop_picks_the_same(seed: int, direction: Array) -> None:
    points, origin, cone = blob(seed, 300), -3.0 * direction, 0.05
    inside: list[tuple[float, float, int]] = []
    for index, point in enumerate(points):
        along = float((point - origin) @ direction)
        off = float(np.linalg.norm(point - origin - along * direction))
        if along > 0.0 and off <= cone * along:
            inside.append((along, off, index))
    found = pick(points, origin, 7.0 * direction, cone=cone)
    if not inside:
        assert found is None
        return
    nearest = min(inside)[0]
    front = [entry for entry in inside if entry[0] <= nearest * (1.0 + 4.0 * cone)]
    assert found is not None
    assert found.index == min(front, key=lambda entry: entry[1] / entry[0])[2]


def test_nothing_behind_and_nothing_beside_is_picked() -> None:
    points = np.array([[0.0, 0.0, -1.0], [0.0, 3.0, 3.0]])
    assert pick(points, np.zeros(3), [0.0, 0.0, 1.0]) is None
    assert pick(points, np.zeros(3), [0.0, 0.0, -1.0]) is not None
    assert pick(np.empty((0, 3)), np.zeros(3), [0.0, 0.0, 1.0]) is None


def test_a_wall_in_front_hides_what_the_ray_meets_exactly_behind_it() -> None:
    grid = np.stack(np.meshgrid(np.arange(-5, 5) + 0.5, np.arange(-5, 5) + 0.5), axis=-1).reshape(-1, 2) * 0.02
    wall = np.concatenate([grid, np.full((100, 1), 2.0)], axis=1)
    points = np.concatenate([[[0.0, 0.0, 4.0]], wall])
    found = pick(points, np.zeros(3), [0.0, 0.0, 1.0])
    assert found is not None
    assert found.index > 0
    assert found.off == pytest.approx(0.01 * math.sqrt(2.0), abs=1e-12)


@given(seeds, rotations)
def test_turning_everything_picks_the_same(seed: int, R: Array) -> None:
    points, origin, direction = wavy(seed, 300), np.array([3.0, -4.0, 3.0]), np.array([0.1, 1.0, -0.4])
    first, second = pick(points, origin, direction), pick(points @ R.T, R @ origin, R @ direction)
    assert (first and first.index) == (second and second.index)


def test_many_points_are_all_looked_at() -> None:
    points = np.full((100_000, 3), [0.0, 5.0, 0.0])
    points[-1] = [0.0, 0.0, 3.0]
    found = pick(points, np.zeros(3), [0.0, 0.0, 1.0])
    assert found is not None
    assert found.index == 99_999


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_points_that_are_not_finite_are_never_picked(bad: float) -> None:
    points = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 2.0]])
    points[0, 2] = bad
    found = pick(points, np.zeros(3), [0.0, 0.0, 1.0])
    assert found is not None
    assert found.index == 1


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        ((np.zeros((2, 3)), np.zeros(3), np.zeros(3)), "direction"),
        ((np.zeros((2, 3)), np.zeros(3), [0.0, math.nan, 1.0]), "direction"),
        ((np.zeros((2, 3)), [math.inf, 0.0, 0.0], [0.0, 0.0, 1.0]), "origin"),
        ((np.zeros(3), np.zeros(3), [0.0, 0.0, 1.0]), "points"),
    ],
)
def test_wrong_arguments_are_refused(arguments: tuple[Array, Array, Array], name: str) -> None:
    with pytest.raises(GeometryError, match=name):
        pick(*arguments)
