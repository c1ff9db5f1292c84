"""The equations on the page of the three turns, both sides at random states."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest

from geometry.euler import ORDERS, euler_to_matrix, is_proper, matrix_to_euler, other_triple
from geometry.rotations import axis_rotation, rotation_angle
from sims.euler_angles import EulerParams, solve

ANGLES = [tuple(each) for each in np.random.default_rng(5).uniform(-np.pi, np.pi, (5, 3)).tolist()]
each_triple = pytest.mark.parametrize("angles", ANGLES, ids=str)
Triple = tuple[float, float, float]


def on_page(angles: Triple) -> tuple[npt.NDArray[np.float64], ...]:
    """R_z, R_y and R_x as they are written there."""
    (cz, cy, cx), (sz, sy, sx) = np.cos(angles), np.sin(angles)
    return (
        np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]]),
        np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]]),
        np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]]),
    )


@each_triple
def test_the_three_matrices_and_their_product(angles: Triple) -> None:
    Rz, Ry, Rx = on_page(angles)
    for axis, angle, R in zip("zyx", angles, (Rz, Ry, Rx), strict=True):
        np.testing.assert_allclose(R, axis_rotation(axis, angle), atol=1e-12)
    np.testing.assert_allclose(Rz @ Ry @ Rx, euler_to_matrix(angles, "zyx", "intrinsic"), atol=1e-12)


@each_triple
def test_own_axes_from_the_left_are_fixed_axes_from_the_right(angles: Triple) -> None:
    own = euler_to_matrix(angles, "zyx", "intrinsic")
    np.testing.assert_allclose(own, euler_to_matrix(angles[::-1], "xyz", "extrinsic"), atol=1e-12)


@each_triple
def test_the_second_triple_gives_the_same_rotation(angles: Triple) -> None:
    yaw, pitch, roll = angles
    other = (yaw + math.pi, math.pi - pitch, roll + math.pi)
    R = euler_to_matrix(angles, "zyx", "intrinsic")
    np.testing.assert_allclose(euler_to_matrix(other, "zyx", "intrinsic"), R, atol=1e-12)
    np.testing.assert_allclose(np.cos(np.subtract(other, other_triple(angles, "zyx"))), 1.0, atol=1e-12)


@pytest.mark.parametrize("order", ["zyx", "xyz", "zxz", "xyx"])
@pytest.mark.parametrize("frame", ["intrinsic", "extrinsic"])
def test_the_product_with_the_numbers_of_the_sim_holds_in_every_order(order: str, frame: str) -> None:
    p = EulerParams().moved({"order": order, "frame": frame}).changed({"yaw": -50, "pitch": 40, "roll": 130})
    s = solve(p)
    product = np.eye(3)
    for factor in s.factors:
        product = product @ axis_rotation(factor["axis"], math.radians(factor["angle"]))
    np.testing.assert_allclose(product, s.R, atol=1e-12)


def test_swapped_quarter_turns_end_120_degrees_apart() -> None:
    yaw, roll = axis_rotation("z", math.pi / 2), axis_rotation("x", math.pi / 2)
    assert math.degrees(rotation_angle((roll @ yaw).T @ (yaw @ roll))) == pytest.approx(120.0)


@pytest.mark.parametrize("order", ORDERS)
def test_every_order_locks_where_the_page_says(order: str) -> None:
    for middle in (0.0, math.pi) if is_proper(order) else (math.pi / 2, -math.pi / 2):
        assert matrix_to_euler(euler_to_matrix((0.3, middle, 0.5), order, "intrinsic"), order, "intrinsic")[1]
    assert len(ORDERS) == 12
    assert sum(map(is_proper, ORDERS)) == 6


def test_positive_angles_do_what_the_page_says() -> None:
    nose, left = 0, 1
    assert solve(EulerParams(yaw=30, pitch=0, roll=0)).R[1, nose] > 0.0, "yaw takes the nose to the left"
    assert solve(EulerParams(yaw=0, pitch=30, roll=0)).R[2, nose] < 0.0, "pitch lowers it"
    assert solve(EulerParams(yaw=0, pitch=0, roll=30)).R[2, left] > 0.0, "roll lifts the left wing"
    assert solve(EulerParams(yaw=90, pitch=0, roll=0)).R[0, left] == pytest.approx(-1.0), "the wing points backwards"
