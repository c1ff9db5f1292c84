"""SLERP against SciPy, and by what each way must be: its ends, its speed, its arc, its ties."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation, Slerp

from geometry import Array, GeometryError, quaternion
from geometry import interpolation as ip
from tests.geometry.strategies import EXACT, angles, directions, near, units, vectors

Way = Callable[..., Array]
arcs = pytest.mark.parametrize("way", [ip.slerp, ip.nlerp])
every_way = pytest.mark.parametrize("way", [ip.slerp, ip.nlerp, ip.euler_interpolation])
unit_quaternions = units(4)
progress = st.floats(0.0, 1.0) | near(0.5) | st.sampled_from((0.0, 1.0))
Z_TURN = np.array([0.0, 0.0, 0.0, 1.0])


@st.composite
def pairs(draw: st.DrawFn) -> tuple[Array, Array]:
    """Unit quaternions everywhere on the sphere, and nearly equal, opposite and perpendicular ones."""
    start = draw(unit_quaternions)
    turn = quaternion.from_axis_angle(draw(units()), draw(angles))
    return start, np.asarray(draw(unit_quaternions | st.just(quaternion.multiply(turn, start))))


def between(p: Array, q: Array) -> float:
    """Angle on the sphere of quaternions, accurate everywhere."""
    return 2.0 * math.atan2(float(np.linalg.norm(p - q)), float(np.linalg.norm(p + q)))


@given(pairs(), progress)
def test_the_short_way_is_scipys(pair: tuple[Array, Array], t: float) -> None:
    start, end = pair
    assume(abs(start @ end) > 1e-6)  # the two ways are equally long there
    expected = Slerp([0.0, 1.0], Rotation.from_quat(np.stack(pair), scalar_first=True))(t)
    found = Rotation.from_quat(ip.slerp(start, end, t), scalar_first=True)
    np.testing.assert_allclose(found.as_matrix(), expected.as_matrix(), rtol=0, atol=EXACT)


@given(pairs(), st.booleans())
@arcs
def test_the_ends_are_exact(way: Way, pair: tuple[Array, Array], long_way: bool) -> None:
    start, end = map(quaternion.normalize, pair)
    np.testing.assert_array_equal(way(*pair, 0.0, long_way=long_way), start)
    last = way(*pair, 1.0, long_way=long_way)
    np.testing.assert_array_equal(last * np.sign(last @ end), end)
    assert (last @ start > EXACT) <= (not long_way)
    assert (last @ start < -EXACT) <= long_way


@given(pairs())
@arcs
def test_the_two_ways_end_at_opposite_quaternions(way: Way, pair: tuple[Array, Array]) -> None:
    np.testing.assert_array_equal(way(*pair, 1.0), -way(*pair, 1.0, long_way=True))


@given(pairs(), progress, st.booleans())
def test_slerp_keeps_its_speed(pair: tuple[Array, Array], t: float, long_way: bool) -> None:
    start, last = (ip.slerp(*pair, end, long_way=long_way) for end in (0.0, 1.0))
    here, whole = ip.slerp(*pair, t, long_way=long_way), between(start, last)
    assert np.linalg.norm(here) == pytest.approx(1.0, abs=EXACT)
    assert between(start, here) == pytest.approx(t * whole, abs=EXACT)
    assert between(here, last) == pytest.approx((1.0 - t) * whole, abs=EXACT)


@given(pairs(), progress, st.booleans())
def test_nlerp_is_the_chord_at_length_one(pair: tuple[Array, Array], t: float, long_way: bool) -> None:
    start, last = (ip.nlerp(*pair, end, long_way=long_way) for end in (0.0, 1.0))
    chord = (1.0 - t) * start + t * last
    length = float(np.linalg.norm(chord))
    here = ip.nlerp(*pair, t, long_way=long_way)
    assert np.linalg.norm(here) == pytest.approx(1.0, abs=EXACT)
    np.testing.assert_allclose(here * length, chord, rtol=0, atol=EXACT)


@given(pairs(), progress, st.booleans())
def test_slerp_and_nlerp_go_along_one_arc_and_meet_in_its_middle(
    pair: tuple[Array, Array], t: float, long_way: bool
) -> None:
    start, last = (ip.slerp(*pair, end, long_way=long_way) for end in (0.0, 1.0))
    for way in (ip.slerp, ip.nlerp):
        here = way(*pair, t, long_way=long_way)
        assert between(start, here) + between(here, last) == pytest.approx(between(start, last), abs=EXACT)
    middle = ip.slerp(*pair, 0.5, long_way=long_way)
    np.testing.assert_allclose(ip.nlerp(*pair, 0.5, long_way=long_way), middle, rtol=0, atol=EXACT)


@given(pairs(), unit_quaternions, unit_quaternions, progress)
def test_slerp_doesn_t_depend_on_the_frame(pair: tuple[Array, Array], a: Array, b: Array, t: float) -> None:
    start, end = pair
    assume(abs(start @ end) > 1e-9)
    left, right = (quaternion.multiply(quaternion.multiply(a, q), b) for q in pair)
    expected = quaternion.multiply(quaternion.multiply(a, ip.slerp(start, end, t)), b)
    np.testing.assert_allclose(ip.slerp(left, right, t), expected, rtol=0, atol=EXACT)


@given(pairs(), progress, st.booleans())
@arcs
def test_backwards_is_the_same_arc(way: Way, pair: tuple[Array, Array], t: float, long_way: bool) -> None:
    start, end = pair
    assume(1e-6 < abs(start @ end) < 1.0 - 1e-9)  # elsewhere ties, or arcs that rounding has set, apart
    there, back = way(start, end, t, long_way=long_way), way(end, start, 1.0 - t, long_way=long_way)
    np.testing.assert_allclose(np.abs(there @ back), 1.0, rtol=0, atol=EXACT)


@given(unit_quaternions, units(), st.floats(1e-9, 1e-6), progress)
def test_nearly_one_rotation(start: Array, axis: Array, angle: float, t: float) -> None:
    turn = quaternion.from_axis_angle(axis, angle)
    for end in (quaternion.multiply(turn, start), -quaternion.multiply(turn, start)):
        short = quaternion.multiply(quaternion.from_axis_angle(axis, t * angle), start)
        np.testing.assert_allclose(ip.slerp(start, end, t), short, rtol=0, atol=EXACT)
        long = quaternion.multiply(quaternion.from_axis_angle(-axis, t * (2.0 * math.pi - angle)), start)
        # The axis is known as well as rounding leaves it in so small a turn.
        np.testing.assert_allclose(ip.slerp(start, end, t, long_way=True), long, rtol=0, atol=1e-15 / angle)


@given(unit_quaternions, progress)
@arcs
def test_the_long_way_to_itself_is_a_whole_turn_about_the_world_s_z(way: Way, start: Array, t: float) -> None:
    for end in (start, -start):
        np.testing.assert_allclose(way(start, end, t), start, rtol=0, atol=EXACT)
    here = ip.slerp([1.0, 0, 0, 0], [1.0, 0, 0, 0], t, long_way=True)
    np.testing.assert_allclose(here, [math.cos(math.pi * t), 0.0, 0.0, math.sin(math.pi * t)], rtol=0, atol=EXACT)


@arcs
def test_half_of_a_whole_turn_is_a_half_turn(way: Way) -> None:
    one, other = [1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]
    np.testing.assert_allclose(way(one, one, 0.5, long_way=True), Z_TURN, rtol=0, atol=EXACT)
    np.testing.assert_allclose(way(other, other, 0.5, long_way=True), [0.0, 0.0, 1.0, 0.0], rtol=0, atol=EXACT)


@given(unit_quaternions, units(), st.floats(-1e-13, 1e-13))
@arcs
def test_of_two_half_turns_the_short_way_takes_the_one_to_end(way: Way, start: Array, axis: Array, off: float) -> None:
    end = quaternion.multiply(quaternion.from_axis_angle(axis, math.pi + off), start)
    np.testing.assert_array_equal(way(start, end, 1.0), quaternion.normalize(end))
    np.testing.assert_array_equal(way(start, -end, 1.0), -quaternion.normalize(end))
    np.testing.assert_array_equal(way(start, end, 1.0, long_way=True), -quaternion.normalize(end))


@given(directions(4), directions(4), vectors(5).map(np.abs), st.booleans())
@arcs
def test_a_batch_is_the_single_ones(way: Way, start: Array, end: Array, t: Array, long_way: bool) -> None:
    t[:2] = 0.0, 1.0
    assume(abs(start @ end) < (1.0 - 1e-6) * np.linalg.norm(start) * np.linalg.norm(end))
    found = way(start, end, t, long_way=long_way)
    for row, moment in zip(found, t.tolist(), strict=True):
        np.testing.assert_allclose(row, way(start, end, moment, long_way=long_way), rtol=0, atol=EXACT)
    starts = np.stack([start, end, start])
    found = way(starts, end, np.array([0.2, 0.5, 1.0]), long_way=long_way)
    np.testing.assert_allclose(found[0], way(start, end, 0.2, long_way=long_way), rtol=0, atol=EXACT)
    np.testing.assert_array_equal(way(starts, end, 1.0, long_way=long_way)[0], way(start, end, 1.0, long_way=long_way))


@every_way
def test_bad_rows_are_nan_and_bad_input_is_refused(way: Way) -> None:
    good = np.array([1.0, 2.0, 3.0, 4.0])
    found = way(np.stack([good, np.zeros(4)]), good, 0.5)
    assert np.isfinite(found[0]).all()
    assert np.isnan(found[1]).all()
    assert np.isnan(way(good, [4.0, 3.0, 2.0, 1.0], np.array([math.nan, 0.5]))[0]).all()
    for start, end, t in ((np.zeros(4), good, 0.5), (good, np.zeros(4), 0.5), (good, good, math.nan)):
        with pytest.raises(GeometryError):
            way(start, end, t)
    with pytest.raises(GeometryError, match="t is inf"):
        way(good, good, math.inf)


# ---- Euler angles


@given(pairs())
def test_euler_angles_lead_from_start_to_end(pair: tuple[Array, Array]) -> None:
    start, end = pair
    np.testing.assert_allclose(ip.euler_interpolation(start, end, 0.0), start, rtol=0, atol=EXACT)
    last = ip.euler_interpolation(start, end, 1.0)
    np.testing.assert_allclose(quaternion.to_matrix(last), quaternion.to_matrix(end), rtol=0, atol=EXACT)


@given(vectors(2, 3.0), vectors(2, 3.0), st.floats(-1.5, 1.5), st.floats(-1.5, 1.5), progress)
def test_each_euler_angle_goes_the_short_way(a: Array, b: Array, p: float, q: float, t: float) -> None:
    first, last = np.array([a[0], p, a[1]]), np.array([b[0], q, b[1]])
    start, end = (Rotation.from_euler("ZYX", yaw_pitch_roll) for yaw_pitch_roll in (first, last))
    found = ip.euler_interpolation(start.as_quat(scalar_first=True), end.as_quat(scalar_first=True), t)
    turn = (last - first + math.pi) % (2.0 * math.pi) - math.pi
    assume((np.abs(turn) < math.pi - 1e-6).all())
    expected = Rotation.from_euler("ZYX", first + t * turn).as_matrix()
    np.testing.assert_allclose(quaternion.to_matrix(found), expected, rtol=0, atol=1e-10)


@given(pairs())
def test_the_euler_way_doesn_t_jump(pair: tuple[Array, Array]) -> None:
    path = ip.euler_interpolation(*pair, np.linspace(0.0, 1.0, 65))
    assert (np.linalg.norm(np.diff(path, axis=0), axis=-1) < 0.15).all()


@given(vectors(3, 7.0), vectors(3, 7.0), near(-math.pi, 0.0, math.pi))
def test_angles_go_the_short_way_round(start: Array, turn: Array, last: float) -> None:
    turn[0] = last
    expected = np.remainder(turn + math.pi, 2.0 * math.pi) - math.pi
    assume((np.abs(np.abs(expected) - math.pi) > 1e-10).all())
    found = ip.interpolate_angles(start, start + turn + 2.0 * math.pi, 0.5)
    np.testing.assert_allclose(found, start + 0.5 * expected, rtol=0, atol=1e-11)


def test_an_angle_with_half_a_turn_to_go_goes_up() -> None:
    for end in (math.pi, -math.pi, 3.0 * math.pi, math.pi + 1e-14, math.pi - 1e-14):
        np.testing.assert_allclose(ip.interpolate_angles([0.0], [end], 0.5), [0.5 * math.pi], rtol=0, atol=EXACT)
    found = ip.interpolate_angles([0.0, 1.0], [[1.0, 1.0], [2.0, 3.0]], np.array([0.5, 1.0]))
    np.testing.assert_allclose(found, [[0.5, 1.0], [2.0, 3.0]], rtol=0, atol=EXACT)


# ---- speed


@given(pairs(), st.booleans())
def test_the_angular_speed_of_slerp_is_even_and_adds_up(pair: tuple[Array, Array], long_way: bool) -> None:
    t = np.linspace(0.0, 1.0, 9)
    path = ip.slerp(*pair, t, long_way=long_way)
    expected = 2.0 * between(path[0], path[-1])
    np.testing.assert_allclose(ip.angular_speed(path, t), expected, rtol=0, atol=1e-11)
    signs = np.where(np.arange(9) % 2, -1.0, 1.0)[:, None]
    np.testing.assert_allclose(ip.angular_speed(signs * path, t), expected, rtol=0, atol=1e-11)


def test_nlerp_is_fastest_in_the_middle() -> None:
    t = np.linspace(0.0, 1.0, 11)
    speed = ip.angular_speed(ip.nlerp([1.0, 0, 0, 0], Z_TURN, t), t)
    np.testing.assert_allclose(speed, speed[::-1], rtol=1e-9)
    assert (np.diff(speed[:5]) > 0.0).all()
    assert speed.mean() == pytest.approx(math.pi)


@pytest.mark.parametrize("t", [[0.0, 1.0], [0.0, 1.0, 1.0], [0.0, 2.0, 1.0], [0.0, math.nan, 1.0], [[0.0, 1.0, 2.0]]])
def test_speed_needs_growing_moments(t: list[float]) -> None:
    with pytest.raises(GeometryError, match="t is"):
        ip.angular_speed(np.ones((3, 4)), t)
    with pytest.raises(GeometryError, match="t is"):
        ip.angular_speed(np.ones((1, 4)), [0.0])


@given(pairs(), st.booleans(), progress)
def test_turn_between_is_the_turn_of_both_arcs(pair: tuple[Array, Array], long_way: bool, t: float) -> None:
    axis, angle = ip.turn_between(*pair, long_way=long_way)
    start = quaternion.normalize(pair[0])
    for way, turned in ((ip.slerp, t * angle), (ip.nlerp, ip.nlerp_angle(float(angle), t))):
        expected = quaternion.multiply(quaternion.from_axis_angle(axis, float(turned)), start)
        np.testing.assert_allclose(way(*pair, t, long_way=long_way), expected, rtol=0, atol=EXACT)


@given(pairs(), st.booleans())
def test_turned_by_gives_many_moments_of_slerp(pair: tuple[Array, Array], long_way: bool) -> None:
    t = np.linspace(0.0, 1.0, 7)
    axis, angle = ip.turn_between(*pair, long_way=long_way)
    expected = ip.slerp(*pair, t, long_way=long_way)
    np.testing.assert_allclose(ip.turned_by(pair[0], axis, t * angle), expected, rtol=0, atol=EXACT)


def test_turned_by_refuses_what_has_no_direction() -> None:
    with pytest.raises(GeometryError, match="axis"):
        ip.turned_by([1, 0, 0, 0], [0, 0, 0], [0.1])
    with pytest.raises(GeometryError, match="q is"):
        ip.turned_by([0, 0, 0, 0], [0, 0, 1], [0.1])
    with pytest.raises(GeometryError, match="angles"):
        ip.turned_by([1, 0, 0, 0], [0, 0, 1], [math.inf])
