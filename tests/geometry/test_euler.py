"""Euler angles: all 24 conventions, at every distance from lock."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from geometry import Array, GeometryError
from geometry.euler import (
    FRAMES,
    ORDERS,
    euler_to_matrix,
    factors,
    is_proper,
    lock_distance,
    lock_sign,
    matrix_to_euler,
    other_triple,
)
from geometry.rotations import axis_rotation, is_rotation
from tests.geometry.strategies import EXACT, angles, rotations

CONVENTIONS = list(itertools.product(ORDERS, FRAMES))
Triple = tuple[float, float, float]

triples = st.tuples(angles, angles, angles)

# How far from lock: exactly there, within rounding, within 1e-9 to 1e-6, and on to where it no longer matters.
offsets = st.builds(
    lambda sign, size: sign * size,
    st.sampled_from((-1.0, 1.0)),
    st.just(0.0) | st.floats(-17.0, -9.0).map(lambda e: 10.0**e) | st.floats(-9.0, -1.0).map(lambda e: 10.0**e),
)


def scipys(triple: Triple, order: str, frame: str) -> Array:
    return np.asarray(Rotation.from_euler(order.upper() if frame == "intrinsic" else order, triple).as_matrix())


def locks(order: str) -> tuple[float, float]:
    return (0.0, math.pi) if is_proper(order) else (math.pi / 2.0, -math.pi / 2.0)


def test_the_twelve_orders() -> None:
    assert ORDERS[:3] == ("zyx", "xyz", "zxz")
    triples = ("".join(letters) for letters in itertools.product("xyz", repeat=3))
    assert set(ORDERS) == {order for order in triples if order[0] != order[1] != order[2]}
    assert len(ORDERS) == 12


def assert_rebuilt(R: Array, order: str, frame: str) -> tuple[Array, bool]:
    """Check that the angles of R rebuild it and lie in their ranges; return them, and whether they are locked."""
    found, locked = matrix_to_euler(R, order, frame)
    np.testing.assert_allclose(euler_to_matrix(found, order, frame), R, rtol=0, atol=EXACT, err_msg=f"{order} {frame}")
    low, high = (0.0, math.pi) if is_proper(order) else (-math.pi / 2.0, math.pi / 2.0)
    assert low <= found[1] <= high
    assert max(abs(found[0]), abs(found[2])) <= math.pi
    return found, bool(locked)


@given(triples)
def test_the_matrix_is_scipys(triple: Triple) -> None:
    for order, frame in CONVENTIONS:
        R, expected = euler_to_matrix(triple, order, frame), scipys(triple, order, frame)
        np.testing.assert_allclose(R, expected, rtol=0, atol=EXACT, err_msg=f"{order} {frame}")


@given(rotations)
def test_any_rotation_is_rebuilt(R: Array) -> None:
    for order, frame in CONVENTIONS:
        assert_rebuilt(R, order, frame)


@given(angles, angles, offsets, st.integers(0, 1))
def test_rotations_near_lock_are_rebuilt(first: float, third: float, offset: float, which: int) -> None:
    for order, frame in CONVENTIONS:
        R = scipys((first, locks(order)[which] + offset, third), order, frame)
        found, locked = assert_rebuilt(R, order, frame)
        assert locked or abs(offset) > 1e-15, (order, frame)
        assert not locked or (found[2] == 0.0 and abs(offset) < 1e-12), (order, frame)


@given(angles, angles, st.integers(0, 1))
def test_at_lock_the_third_angle_is_zero(first: float, third: float, which: int) -> None:
    for order, frame in CONVENTIONS:
        R = euler_to_matrix((first, locks(order)[which], third), order, frame)
        found, locked = assert_rebuilt(R, order, frame)
        assert locked, (order, frame)
        assert found[2] == 0.0, (order, frame)


@given(triples)
def test_the_factors_multiply_to_the_rotation(triple: Triple) -> None:
    for order, frame in CONVENTIONS:
        a, b, c = factors(triple, order, frame)
        np.testing.assert_allclose(a.R @ b.R @ c.R, scipys(triple, order, frame), rtol=0, atol=EXACT)
        written = list(zip(order, triple, strict=True))
        multiplied = [(factor.axis, factor.angle) for factor in (a, b, c)]
        assert multiplied == (written if frame == "intrinsic" else written[::-1])
        for factor in (a, b, c):
            np.testing.assert_array_equal(factor.R, axis_rotation(factor.axis, factor.angle))


@given(triple=triples, order=st.sampled_from(ORDERS))
def test_extrinsic_is_intrinsic_read_backwards(triple: Triple, order: str) -> None:
    extrinsic = euler_to_matrix(triple, order, "extrinsic")
    np.testing.assert_array_equal(extrinsic, euler_to_matrix(triple[::-1], order[::-1], "intrinsic"))


@given(triple=triples)
def test_yaw_pitch_roll_is_the_product_in_the_textbook(triple: Triple) -> None:
    yaw, pitch, roll = triple
    expected = axis_rotation("z", yaw) @ axis_rotation("y", pitch) @ axis_rotation("x", roll)
    np.testing.assert_array_equal(euler_to_matrix(triple, "zyx", "intrinsic"), expected)


@given(yaw=angles, roll=angles, end=st.sampled_from((1.0, -1.0)))
def test_the_matrix_at_gimbal_lock(yaw: float, roll: float, end: float) -> None:
    left = yaw - end * roll
    sin, cos = math.sin(left), math.cos(left)
    expected = [[0.0, -sin, end * cos], [0.0, cos, end * sin], [-end, 0.0, 0.0]]
    R = euler_to_matrix((yaw, end * math.pi / 2.0, roll), "zyx", "intrinsic")
    np.testing.assert_allclose(R, expected, rtol=0, atol=EXACT)


@given(st.integers(-3, 3), st.floats(1e-9, math.pi / 2.0), st.sampled_from((-1.0, 1.0)))
def test_lock_distance_is_to_the_nearest_lock(turns: int, offset: float, sign: float) -> None:
    for order in ORDERS:
        middle = locks(order)[0] + turns * math.pi + sign * offset
        assert abs(float(lock_distance(middle, order)) - offset) < EXACT
        np.testing.assert_allclose(lock_distance(np.array([middle] * 2), order), offset, rtol=0, atol=EXACT)


@pytest.mark.parametrize("order", ORDERS)
def test_no_middle_angle_is_further_from_lock_than_a_right_angle(order: str) -> None:
    distances = lock_distance(np.linspace(-10.0, 10.0, 2001), order)
    assert distances.min() >= 0.0
    assert distances.max() <= math.pi / 2.0
    assert float(lock_distance(0.0, order)) == pytest.approx(0.0 if is_proper(order) else math.pi / 2.0)


@pytest.mark.parametrize(("order", "frame"), CONVENTIONS)
def test_a_batch_is_the_same_as_one_by_one(order: str, frame: str) -> None:
    triples = np.random.default_rng(0).uniform(-math.pi, math.pi, (4, 2, 3))
    triples[0, 0, 1] = locks(order)[0]
    R = euler_to_matrix(triples, order, frame)
    found, locked = matrix_to_euler(R, order, frame)
    assert (found.shape, locked.shape) == ((4, 2, 3), (4, 2))
    assert locked.sum() == 1
    for index in np.ndindex(4, 2):
        one, one_locked = matrix_to_euler(R[index], order, frame)
        np.testing.assert_array_equal(found[index], one)
        assert locked[index] == one_locked
        np.testing.assert_allclose(R[index], euler_to_matrix(triples[index], order, frame), rtol=0, atol=EXACT)


def test_a_failing_row_of_a_batch_is_nan_and_not_locked() -> None:
    R = euler_to_matrix([[0.1, 0.2, 0.3], [0.1, math.nan, 0.3], [math.inf, 0.2, 0.3]], "zyx", "intrinsic")
    np.testing.assert_array_equal(is_rotation(R), [True, False, False])
    found, locked = matrix_to_euler(R, "zyx", "intrinsic")
    np.testing.assert_array_equal(np.isnan(found).all(axis=-1), [False, True, True])
    assert not locked.any()


@pytest.mark.parametrize(
    ("order", "frame", "argument"),
    [
        ("zyy", "intrinsic", "order"),
        ("ZYX", "intrinsic", "order"),
        ("", "intrinsic", "order"),
        ("zyx", "body", "frame"),
    ],
)
def test_an_unknown_convention_is_refused(order: str, frame: str, argument: str) -> None:
    for call in (
        lambda: euler_to_matrix((0.0, 0.0, 0.0), order, frame),
        lambda: factors((0.0, 0.0, 0.0), order, frame),
        lambda: matrix_to_euler(np.eye(3), order, frame),
    ):
        with pytest.raises(GeometryError) as caught:
            call()
        assert caught.value.argument == argument


def test_bad_numbers_are_refused() -> None:
    for triple in ((0.0, math.nan, 0.0), (math.inf, 0.0, 0.0)):
        with pytest.raises(GeometryError, match="angle is"):
            euler_to_matrix(triple, "zyx", "intrinsic")
    with pytest.raises(GeometryError, match="angles is"):
        euler_to_matrix((0.0, 0.0), "zyx", "intrinsic")
    for R in (np.zeros((3, 3)), -np.eye(3), np.full((3, 3), math.nan)):
        with pytest.raises(GeometryError, match="R is"):
            matrix_to_euler(R, "zyx", "intrinsic")


@given(triples)
def test_at_lock_one_combination_of_first_and_third_is_left(triple: Triple) -> None:
    """It alone counts, by SciPy: moving both so that it stays moves nothing, and it stays only with that sign."""
    first, move, third = triple
    for order, frame in CONVENTIONS:
        for lock in locks(order):
            sign = lock_sign(lock, order, frame)
            R = scipys((first, lock, third), order, frame)
            same = scipys((first - sign * move, lock, third + move), order, frame)
            np.testing.assert_allclose(same, R, rtol=0, atol=1e-9, err_msg=f"{order} {frame} {lock}")
            other = scipys((first + 0.1 * sign, lock, third + 0.1), order, frame)
            assert np.abs(other - R).max() > 0.01, f"{order} {frame} {lock}"


def test_the_sign_at_lock_is_the_textbooks() -> None:
    assert lock_sign(math.pi / 2, "zyx", "intrinsic") == -1  # ψ − φ
    assert lock_sign(-math.pi / 2, "zyx", "intrinsic") == 1
    assert lock_sign(0.0, "zxz", "intrinsic") == 1
    with pytest.raises(GeometryError):
        lock_sign(0.0, "zzz", "intrinsic")


@given(triples)
def test_two_triples_give_one_rotation(triple: Triple) -> None:
    for order, frame in CONVENTIONS:
        other = other_triple(triple, order)
        np.testing.assert_allclose(
            scipys(tuple(other.tolist()), order, frame), scipys(triple, order, frame), rtol=0, atol=1e-9
        )
        assert max(abs(other[0]), abs(other[2])) <= math.pi + 1e-12
    batch = other_triple([triple, triple], "zyx")
    np.testing.assert_array_equal(batch[0], batch[1])
