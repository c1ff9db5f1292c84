"""Conventions for axes: as the contract words them, handed as their determinant says, one point in all of them."""

import math
from collections.abc import Callable
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import RigidTransform, Rotation

from geometry import Array, GeometryError, frames
from geometry.rotations import is_rotation
from tests.geometry.strategies import EXACT, directions, near, rotations, vectors

NAMES = tuple(frames.CONVENTIONS)
LEFT = {"directx", "unreal"}
names = st.sampled_from(NAMES)
handed = st.sampled_from((None, "right", "left"))
bases = st.builds(frames.basis, names, handed)


def test_the_seven_conventions_as_right_forward_up_words() -> None:
    assert frames.CONVENTIONS == {
        "opengl": ("right", "up", "back"),
        "directx": ("right", "up", "forward"),
        "ros": ("forward", "left", "up"),
        "camera": ("right", "down", "forward"),
        "aviation": ("forward", "right", "down"),
        "enu": ("right", "forward", "up"),
        "unreal": ("forward", "right", "up"),
    }


def test_enu_is_the_world() -> None:
    np.testing.assert_array_equal(frames.basis("enu"), np.eye(3))


@pytest.mark.parametrize("name", NAMES)
def test_columns_are_the_axes_in_the_world(name: str) -> None:
    axes = frames.basis(name)
    for column, word in zip(axes.T, frames.axis_directions(name), strict=True):
        np.testing.assert_array_equal(column, frames.DIRECTIONS[word])
    assert not np.signbit(axes[axes == 0.0]).any()


@pytest.mark.parametrize("name", NAMES)
def test_handedness_is_the_sign_of_the_determinant(name: str) -> None:
    axes = frames.basis(name)
    own = "left" if name in LEFT else "right"
    assert frames.handedness(axes) == own
    assert np.linalg.det(axes) == (-1.0 if own == "left" else 1.0)
    x, y, z = axes.T
    assert np.dot(np.cross(x, y), z) == np.linalg.det(axes)


@pytest.mark.parametrize(("name", "hand"), list(product(NAMES, frames.HANDEDNESS)))
def test_the_other_handedness_mirrors_z_alone(name: str, hand: str) -> None:
    own, asked = frames.basis(name), frames.basis(name, hand)
    assert frames.handedness(asked) == hand
    np.testing.assert_array_equal(asked[:, :2], own[:, :2])
    np.testing.assert_array_equal(asked[:, 2], own[:, 2] if hand == frames.handedness(own) else -own[:, 2])


@given(directions(), directions(), directions())
def test_handedness_of_any_axes(x: Array, y: Array, z: Array) -> None:
    axes = np.column_stack([x, y, z])
    determinant = float(np.dot(np.cross(x, y), z))
    if abs(determinant) > 1e-9:
        assert frames.handedness(axes) == ("right" if determinant > 0.0 else "left")
        assert frames.handedness(axes[:, [1, 0, 2]]) != frames.handedness(axes)


@given(directions(), directions(), vectors(2))
def test_axes_in_one_plane_have_no_handedness(x: Array, y: Array, weights: Array) -> None:
    with pytest.raises(GeometryError, match="axes"):
        frames.handedness(np.column_stack([x, y, weights[0] * x + weights[1] * y]))


@given(bases, bases)
def test_change_of_basis_is_a_rotation_only_between_bases_of_one_handedness(a: Array, b: Array) -> None:
    T = frames.change_of_basis(a, b)
    np.testing.assert_array_equal(T[:3, :3], np.linalg.inv(b) @ a)
    np.testing.assert_array_equal([T[3], T[:, 3]], [[0.0, 0.0, 0.0, 1.0]] * 2)
    same = frames.handedness(a) == frames.handedness(b)
    assert np.linalg.det(T) == (1.0 if same else -1.0)
    assert bool(is_rotation(T[:3, :3])) is same


@given(st.one_of(bases, rotations), st.one_of(bases, rotations), vectors(3, 10.0), vectors(3, 10.0), st.integers(0, 1))
def test_the_other_frame_begins_at_its_origin(a: Array, b: Array, origin: Array, place: Array, w: int) -> None:
    """Both frames as matrices to the world, and NumPy's general inverse of one of them."""
    first, second = np.eye(4), np.eye(4)
    first[:3, :3], second[:3, :3], second[:3, 3] = a, b, a @ origin
    T = frames.change_of_basis(a, b, origin)
    np.testing.assert_allclose(T, np.linalg.solve(second, first), rtol=0, atol=100 * EXACT)
    moved = frames.coordinates(a @ (place - w * origin), b)
    np.testing.assert_allclose(T @ [*place, w], [*moved, w], rtol=0, atol=100 * EXACT)
    np.testing.assert_array_equal(frames.change_of_basis(a, b, (0, 0, 0)), frames.change_of_basis(a, b))


@given(rotations, rotations, vectors(3, 10.0), vectors(3, 10.0))
def test_a_frame_of_its_own_origin_is_scipys_rigid_transform(a: Array, b: Array, origin: Array, point: Array) -> None:
    first = RigidTransform.from_rotation(Rotation.from_matrix(a))
    second = RigidTransform.from_components(a @ origin, Rotation.from_matrix(b))
    moved = frames.change_of_basis(a, b, origin) @ [*point, 1.0]
    np.testing.assert_allclose(moved[:3], (second.inv() * first).apply(point), rtol=0, atol=1e-12)


def test_a_batch_of_origins_gives_a_matrix_each() -> None:
    a, b, origins = frames.basis("ros"), frames.basis("camera"), np.array([(1.0, 2.0, 3.0), (0.0, -1.0, 0.5)])
    T = frames.change_of_basis(a, b, origins)
    assert T.shape == (2, 4, 4)
    np.testing.assert_array_equal(T[..., :3, 3], [(2, 3, -1), (-1, 0.5, 0)])
    with pytest.raises(GeometryError, match="origin"):
        frames.change_of_basis(a, b, (1.0, 2.0))


@given(bases, bases, bases)
def test_changes_of_basis_are_a_groupoid(a: Array, b: Array, c: Array) -> None:
    through = frames.change_of_basis(b, c) @ frames.change_of_basis(a, b)
    np.testing.assert_array_equal(through, frames.change_of_basis(a, c))
    np.testing.assert_array_equal(frames.change_of_basis(a, a), np.eye(4))
    np.testing.assert_array_equal(frames.change_of_basis(a, b), frames.change_of_basis(b, a).T)


@given(bases, bases, vectors(3, 10.0))
def test_one_point_reads_alike_by_either_way(a: Array, b: Array, point: Array) -> None:
    reading = frames.coordinates(point, a)
    np.testing.assert_array_equal(frames.to_world(reading, a), point)
    moved = frames.change_of_basis(a, b) @ [*reading, 1.0]
    np.testing.assert_array_equal(moved[:3], frames.coordinates(point, b))


@given(rotations, vectors(3, 10.0))
def test_tilted_bases_too(R: Array, point: Array) -> None:
    np.testing.assert_allclose(frames.coordinates(point, R), np.linalg.solve(R, point), rtol=0, atol=10 * EXACT)
    np.testing.assert_allclose(frames.to_world(frames.coordinates(point, R), R), point, rtol=0, atol=10 * EXACT)


def test_a_point_ahead_right_and_above_in_words() -> None:
    right, forward, up = 2.0, 3.0, 5.0
    readings = {
        "opengl": (2, 5, -3),
        "directx": (2, 5, 3),
        "ros": (3, -2, 5),
        "camera": (2, -5, 3),
        "aviation": (3, 2, -5),
        "enu": (2, 3, 5),
        "unreal": (3, 2, 5),
    }
    for name, reading in readings.items():
        np.testing.assert_array_equal(frames.coordinates([right, forward, up], frames.basis(name)), reading)


def test_one_point_in_all_bases_and_many_points_in_one() -> None:
    every = np.stack([frames.basis(name) for name in NAMES])
    points = np.arange(12.0).reshape(4, 3)
    np.testing.assert_array_equal(
        frames.coordinates(points[1], every), [frames.coordinates(points[1], axes) for axes in every]
    )
    np.testing.assert_array_equal(
        frames.coordinates(points, every[0]), [frames.coordinates(point, every[0]) for point in points]
    )
    assert frames.change_of_basis(every, every[2]).shape == (7, 4, 4)


@pytest.mark.parametrize("bad", [np.zeros((3, 3)), 2.0 * np.eye(3), np.full((3, 3), math.nan), np.ones((3, 3))])
def test_what_is_no_basis_is_refused_and_nan_in_a_batch(bad: Array) -> None:
    calls: list[Callable[[], Array]] = [
        lambda: frames.change_of_basis(bad, np.eye(3)),
        lambda: frames.change_of_basis(np.eye(3), bad),
        lambda: frames.coordinates([1.0, 2.0, 3.0], bad),
        lambda: frames.to_world([1.0, 2.0, 3.0], bad),
    ]
    for call in calls:
        with pytest.raises(GeometryError, match="perpendicular axes of length one"):
            call()
    readings = frames.coordinates([1.0, 2.0, 3.0], np.stack([np.eye(3), bad]))
    np.testing.assert_array_equal(readings[0], [1.0, 2.0, 3.0])
    assert np.isnan(readings[1]).all()


def test_unknown_names_are_refused_with_what_is_allowed() -> None:
    with pytest.raises(GeometryError, match="opengl, directx, ros"):
        frames.basis("OpenGL")
    with pytest.raises(GeometryError, match="right, left"):
        frames.basis("ros", "both")
    with pytest.raises(GeometryError, match="one matrix"):
        frames.handedness(np.stack([np.eye(3)] * 2))


# ---- homogeneous points


@given(vectors(3, 5.0), st.floats(0.01, 2.0), st.sampled_from((-1.0, 1.0)))
def test_a_finite_point_is_divided_by_w(point: Array, w: float, sign: float) -> None:
    found, finite = frames.point_or_direction([*point, sign * w])
    assert finite
    np.testing.assert_allclose(found, point / (sign * w), rtol=EXACT, atol=0)


@given(directions())
def test_at_w_zero_it_is_a_direction(direction: Array) -> None:
    found, finite = frames.point_or_direction([*direction, 0.0])
    assert not finite
    np.testing.assert_allclose(found, direction / np.linalg.norm(direction), rtol=0, atol=EXACT)


@given(directions(), near(0.0))
def test_towards_w_zero_the_point_runs_away_along_its_direction(direction: Array, w: float) -> None:
    found, finite = frames.point_or_direction([*direction, w])
    assert bool(finite) is (w != 0.0)
    toward = direction / np.linalg.norm(direction) * (-1.0 if w < 0.0 else 1.0)
    np.testing.assert_allclose(found / np.linalg.norm(found), toward, rtol=0, atol=EXACT)


def test_too_far_for_a_float_is_a_direction() -> None:
    for w, sign in ((1e-310, 1.0), (-1e-310, -1.0)):
        found, finite = frames.point_or_direction([0.0, 1.0, 0.0, w])
        assert not finite
        np.testing.assert_array_equal(found, [0.0, sign, 0.0])


@pytest.mark.parametrize("bad", [[0, 0, 0, 0], [1, math.nan, 0, 1], [math.inf, 0, 0, 0], [1, 0, 0, math.inf]])
def test_what_is_no_homogeneous_point_is_refused_and_nan_in_a_batch(bad: list[float]) -> None:
    with pytest.raises(GeometryError, match="not all of them zero"):
        frames.point_or_direction(bad)
    found, finite = frames.point_or_direction(
        [[1.0, 2.0, 3.0, 2.0], bad, [0.0, 0.0, 3.0, 0.0], [0.0, 2.0, 0.0, -1e-320]]
    )
    np.testing.assert_array_equal(finite, [True, False, False, False])
    np.testing.assert_array_equal(found, [[0.5, 1.0, 1.5], [math.nan] * 3, [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
