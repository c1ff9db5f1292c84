"""Ray casting: distances and normals that are known, and points that are on the body they hit."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geometry import Array, GeometryError
from geometry.ray_casting import SHAPES, Body, cast
from tests.geometry.strategies import pose, poses, seeds

HALF = np.array([0.5, 0.8, 1.2])


def level(shape: str, center: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Body:
    return Body(shape, HALF, pose(np.eye(3), np.array(center)))


def outside(shape: str, local: Array) -> Array:
    """Above 0 outside of the body, 0 on it: coordinates in its own frame, scaled by its half extents."""
    if shape == "box":
        return np.asarray(np.abs(local).max(axis=1) - 1.0)
    if shape == "ellipsoid":
        return np.asarray(np.linalg.norm(local, axis=1) - 1.0)
    return np.asarray(np.maximum(np.linalg.norm(local[:, :2], axis=1), np.abs(local[:, 2])) - 1.0)


def rays(seed: int, count: int = 200) -> tuple[Array, Array]:
    rng = np.random.default_rng(seed)
    origins, targets = rng.normal(0.0, 3.0, (count, 3)), rng.uniform(-1.2, 1.2, (count, 3))
    directions = targets - origins
    return origins, directions / np.linalg.norm(directions, axis=1, keepdims=True)


@given(st.sampled_from(SHAPES), poses, seeds)
def test_hits_are_on_the_body_and_nothing_of_it_is_nearer(shape: str, T: Array, seed: int) -> None:
    body = Body(shape, HALF, T)
    origins, directions = rays(seed)
    o, d = origins @ T[:3, :3].T + T[:3, 3], directions @ T[:3, :3].T
    hits = cast(o, d, [body])
    hit = np.isfinite(hits.distance)
    np.testing.assert_array_equal(hits.body, np.where(hit, 0, -1))
    points = origins[hit] + hits.distance[hit, None] * directions[hit]
    np.testing.assert_allclose(outside(shape, points / HALF), 0.0, atol=1e-9)
    inside_first = outside(shape, origins[hit] / HALF) < 0.0
    for share in np.linspace(0.01, 0.99, 23):
        between = origins[hit] + share * hits.distance[hit, None] * directions[hit]
        assert ((outside(shape, between / HALF) > -1e-9) | inside_first).all()
    missed_o, missed_d = origins[~hit], directions[~hit]
    for along in np.linspace(0.0, 12.0, 60):
        assert (outside(shape, (missed_o + along * missed_d) / HALF) > -1e-3).all()


@given(st.sampled_from(SHAPES), poses, seeds)
def test_normals_are_unit_and_point_out(shape: str, T: Array, seed: int) -> None:
    origins, directions = rays(seed)
    o, d = origins @ T[:3, :3].T + T[:3, 3], directions @ T[:3, :3].T
    hits = cast(o, d, [Body(shape, HALF, T)])
    hit = np.isfinite(hits.distance)
    normals = hits.normals[hit] @ T[:3, :3]
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-12)
    points = origins[hit] + hits.distance[hit, None] * directions[hit]
    assert (outside(shape, (points + 1e-6 * normals) / HALF) > 0.0).all()
    assert (outside(shape, (points - 1e-6 * normals) / HALF) < 0.0).all()


@pytest.mark.parametrize(("shape", "expected"), [("box", 4.5), ("cylinder", 4.5), ("ellipsoid", 4.5)])
def test_a_known_distance(shape: str, expected: float) -> None:
    hits = cast([-5.0, 0.0, 0.0], [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], [level(shape)])
    assert hits.distance.tolist() == [expected, math.inf, math.inf]
    np.testing.assert_array_equal(hits.normals[0], [-1.0, 0.0, 0.0])


@pytest.mark.parametrize("shape", SHAPES)
def test_straight_down_on_the_top_and_out_from_inside(shape: str) -> None:
    hits = cast([[0.0, 0.0, 4.0], [0.0, 0.0, 0.0]], [[0.0, 0.0, -1.0], [0.0, 0.0, -1.0]], [level(shape)])
    np.testing.assert_allclose(hits.distance, [2.8, 1.2], atol=1e-12)
    np.testing.assert_allclose(hits.normals[:, 2], [1.0, -1.0], atol=1e-12)


def test_the_nearest_of_several_is_hit() -> None:
    bodies = [level("box", (8.0, 0.0, 0.0)), level("ellipsoid", (4.0, 0.0, 0.0)), level("cylinder", (6.0, 0.0, 0.0))]
    assert cast(np.zeros(3), [[1.0, 0.0, 0.0]], bodies).body.tolist() == [1]
    assert cast(np.zeros(3), np.empty((0, 3)), bodies).distance.shape == (0,)
    assert cast(np.zeros(3), [[1.0, 0.0, 0.0]], []).distance.tolist() == [math.inf]


@pytest.mark.parametrize("half", [[1.0, 1.0, 0.0], [1.0, 1.0], [1.0, 1.0, math.nan]])
def test_wrong_bodies_are_refused(half: list[float]) -> None:
    with pytest.raises(GeometryError, match="half"):
        Body("box", np.array(half), np.eye(4))
    with pytest.raises(GeometryError, match="shape"):
        Body("cone", HALF, np.eye(4))
