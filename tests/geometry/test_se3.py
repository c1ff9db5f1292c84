"""Rigid transforms: the group laws, and homogeneous coordinates."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geometry import Array, GeometryError, se3
from tests.geometry.strategies import near, poses, rotations, vectors

TOLERANCE = 1e-12 * 50  # for coordinates of some tens of metres


@given(rotations, vectors(3, 5.0))
def test_a_transform_has_its_rotation_and_translation(R: Array, t: Array) -> None:
    T = se3.transform(R, t)
    np.testing.assert_array_equal(se3.rotation(T), R)
    np.testing.assert_array_equal(se3.translation(T), t)
    np.testing.assert_array_equal(T[3], [0.0, 0.0, 0.0, 1.0])


@given(poses, vectors(3, 5.0))
def test_apply_turns_then_moves(T: Array, point: Array) -> None:
    expected = T[:3, :3] @ point + T[:3, 3]
    np.testing.assert_allclose(se3.apply(T, point), expected, rtol=0, atol=TOLERANCE)
    homogeneous = T @ se3.to_homogeneous(point)
    np.testing.assert_allclose(se3.from_homogeneous(homogeneous)[0], expected, rtol=0, atol=TOLERANCE)


@given(poses)
def test_the_inverse_undoes_on_both_sides(T: Array) -> None:
    np.testing.assert_allclose(T @ se3.inverse(T), np.eye(4), rtol=0, atol=TOLERANCE)
    np.testing.assert_allclose(se3.inverse(T) @ T, np.eye(4), rtol=0, atol=TOLERANCE)
    np.testing.assert_allclose(se3.inverse(T), np.linalg.inv(T), rtol=0, atol=TOLERANCE)


@given(poses, poses, poses, vectors(3, 5.0))
def test_composition_is_associative_and_applies_from_the_right(A: Array, B: Array, C: Array, point: Array) -> None:
    np.testing.assert_allclose(
        se3.compose(se3.compose(A, B), C), se3.compose(A, se3.compose(B, C)), rtol=0, atol=TOLERANCE
    )
    stepwise = se3.apply(A, se3.apply(B, se3.apply(C, point)))
    np.testing.assert_allclose(se3.apply(se3.compose(A, B, C), point), stepwise, rtol=0, atol=TOLERANCE)
    np.testing.assert_array_equal(se3.compose(A), A)


@given(poses, poses)
def test_the_inverse_of_a_product_is_the_product_of_inverses_reversed(A: Array, B: Array) -> None:
    reverse = se3.compose(se3.inverse(B), se3.inverse(A))
    np.testing.assert_allclose(se3.inverse(se3.compose(A, B)), reverse, rtol=0, atol=TOLERANCE)


@given(poses, vectors(3, 5.0), vectors(3, 5.0))
def test_distances_are_kept(T: Array, a: Array, b: Array) -> None:
    moved = np.linalg.norm(se3.apply(T, a) - se3.apply(T, b))
    assert abs(moved - np.linalg.norm(a - b)) < TOLERANCE


@given(st.lists(poses, min_size=2, max_size=3), st.lists(vectors(3, 5.0), min_size=2, max_size=4))
def test_batches_broadcast(transforms: list[Array], points: list[Array]) -> None:
    T, p = np.stack(transforms), np.stack(points)
    grid = se3.apply(T[:, None], p)
    assert grid.shape == (len(transforms), len(points), 3)
    for i, j in np.ndindex(grid.shape[:2]):
        np.testing.assert_allclose(grid[i, j], se3.apply(T[i], p[j]), rtol=0, atol=TOLERANCE)
    np.testing.assert_allclose(se3.inverse(T)[1], se3.inverse(T[1]), rtol=0, atol=TOLERANCE)
    np.testing.assert_allclose(se3.compose(T, T[0])[1], T[1] @ T[0], rtol=0, atol=TOLERANCE)
    rebuilt = se3.transform(se3.rotation(T), se3.translation(T))
    np.testing.assert_array_equal(rebuilt, T)
    assert se3.transform(np.eye(3), p).shape == (len(points), 4, 4)


def test_what_is_no_rotation_is_refused_and_nan_in_a_batch() -> None:
    with pytest.raises(GeometryError, match="R is"):
        se3.transform(2.0 * np.eye(3), np.zeros(3))
    T = se3.transform(np.stack([np.eye(3), 2.0 * np.eye(3)]), np.zeros(3))
    np.testing.assert_array_equal(np.isnan(T).any(axis=(-2, -1)), [False, True])


@given(vectors(4, 5.0), st.floats(0.5, 3.0))
def test_homogeneous_points_are_the_same_at_any_scale(h: Array, scale: float) -> None:
    h[3] = math.copysign(max(abs(h[3]), 0.1), h[3])
    point, finite = se3.from_homogeneous(h)
    assert finite
    np.testing.assert_allclose(se3.from_homogeneous(-scale * h)[0], point, rtol=1e-14, atol=1e-300)
    np.testing.assert_allclose(se3.to_homogeneous(point) * h[3], h, rtol=0, atol=TOLERANCE)


@given(near(0.0), st.sampled_from((2, 3)))
def test_only_w_equal_to_zero_is_at_infinity(w: float, size: int) -> None:
    point, finite = se3.from_homogeneous([1.0] * size + [w])
    assert bool(finite) == (w != 0.0)
    assert point.shape == (size,)
    if finite:
        np.testing.assert_allclose(point, 1.0 / w, rtol=1e-15, atol=0)
    else:
        assert np.isnan(point).all()


def test_points_at_infinity_are_nan_in_their_row_only() -> None:
    h = np.array([[2.0, 4.0, 6.0, 2.0], [1.0, 2.0, 3.0, 0.0], [math.nan, 0.0, 0.0, 1.0], [1.0, 1.0, 1.0, math.inf]])
    points, finite = se3.from_homogeneous(h)
    np.testing.assert_array_equal(finite, [True, False, False, False])
    np.testing.assert_array_equal(points[0], [1.0, 2.0, 3.0])
    assert np.isnan(points[1:]).all()
