"""Reaching a target: from near and from far, from singular postures, and for targets out of reach."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from geometry import Array, GeometryError
from geometry.inverse_kinematics import InverseKinematics, inverse_kinematics
from geometry.kinematics import Chain
from tests.geometry.strategies import near, units, vectors

TOLERANCE = 1e-5
postures = st.floats(-math.pi, math.pi) | near(-math.pi, 0.0, math.pi)


@st.composite
def arms(draw: st.DrawFn) -> tuple[Chain, Array]:
    """An arm of two to eight joints that can move every way, or in a plane, and its angles; straight ones too."""
    axes = draw(st.sampled_from(("zz", "zzz", "zyy", "zyyx", "zyyxyx", "zyyzyyzy", "zzzzzzzz", "yyzyx")))
    n = len(axes)
    chain = Chain(axes, tuple(draw(st.lists(st.floats(0.2, 1.0), min_size=n, max_size=n))))
    return chain, np.array(draw(st.lists(postures, min_size=n, max_size=n)))


def end(chain: Chain, turns: Array) -> Array:
    return np.asarray(chain.forward(turns).positions[-1])


def consistent(chain: Chain, target: Array, found: InverseKinematics) -> None:
    assert np.isfinite(found.angles).all()
    assert found.residual == pytest.approx(float(np.linalg.norm(target - end(chain, found.angles))), abs=1e-9)
    assert found.reached is (found.residual <= TOLERANCE)


@given(arms(), st.data())
def test_a_drag_is_followed_by_small_turns(arm: tuple[Chain, Array], data: st.DataObject) -> None:
    chain, start = arm
    J = chain.forward(start).jacobian[:3]
    size = sum(chain.lengths)
    values = np.linalg.svd(J, compute_uv=False)[: chain.mobility]
    assume(values[-1] > 0.1 * size)
    move = J @ data.draw(vectors(len(start))) * 0.05
    target = end(chain, start) + move
    found = inverse_kinematics(chain, target, start)
    consistent(chain, target, found)
    assert found.reached
    shortest = np.linalg.lstsq(J, move, rcond=1e-9)[0]
    assert np.linalg.norm(found.angles - start) <= 1.5 * np.linalg.norm(shortest) + 1e-4


@given(arms())
def test_where_it_is_already_nothing_turns(arm: tuple[Chain, Array]) -> None:
    chain, start = arm
    found = inverse_kinematics(chain, end(chain, start), start)
    np.testing.assert_array_equal(found.angles, start)
    assert found.reached


@given(arms(), vectors(3, 6.0))
def test_any_target_from_any_posture_comes_nearer_or_stays(arm: tuple[Chain, Array], target: Array) -> None:
    chain, start = arm
    found = inverse_kinematics(chain, target, start)
    consistent(chain, target, found)
    assert found.residual <= np.linalg.norm(target - end(chain, start)) + 1e-12
    again = inverse_kinematics(chain, target, start)
    np.testing.assert_array_equal(found.angles, again.angles)
    distance = float(np.linalg.norm(target))
    out = max(distance - chain.reach.greatest, chain.reach.least - distance)
    assert found.residual >= out - 1e-9
    if out > 2.0 * TOLERANCE:
        assert not found.reached


@given(st.sampled_from(("zz", "zzz", "zzzzzz")), st.floats(1.001, 20.0), st.floats(-math.pi, math.pi), st.data())
def test_out_of_reach_a_planar_arm_points_at_the_target(
    axes: str, far: float, bearing: float, data: st.DataObject
) -> None:
    chain = Chain(axes, tuple(data.draw(st.floats(0.3, 1.0)) for _ in axes))
    greatest = chain.reach.greatest
    target = far * greatest * np.array([math.cos(bearing), math.sin(bearing), 0.0])
    found = inverse_kinematics(chain, target, [bearing + 0.5, *(0.3 for _ in axes[1:])])
    assert not found.reached
    assert found.residual == pytest.approx((far - 1.0) * greatest, abs=1e-6 * greatest)
    still = inverse_kinematics(chain, target, found.angles)
    np.testing.assert_allclose(still.angles, found.angles, rtol=0, atol=1e-3)


@pytest.mark.parametrize("elbow", [0.0, math.pi, 1e-9, -1e-7, math.pi - 1e-8])
@pytest.mark.parametrize("radius", [0.4, 0.9, 1.5, 1.79])
def test_a_straight_or_folded_arm_bends_for_a_target_along_it(elbow: float, radius: float) -> None:
    chain = Chain("zz", (1.0, 0.8))
    for target in ([radius, 0.0, 0.0], [-radius, 0.0, 0.0]):
        found = inverse_kinematics(chain, target, [0.0, elbow])
        assert found.reached


def test_a_straight_arm_swings_round_to_a_target_behind_it() -> None:
    found = inverse_kinematics(Chain("zz", (1.0, 0.8)), [-5.0, 0.0, 0.0], [0.0, 0.0])
    assert found.residual == pytest.approx(3.2, abs=1e-6)


@given(st.floats(-6.0, -3.0), st.sampled_from((-1.0, 1.0)), st.floats(-math.pi, math.pi))
def test_across_the_edge_of_the_reach(power: float, side: float, bearing: float) -> None:
    chain = Chain("zz", (1.0, 0.8))
    radius = 1.8 + side * 10.0**power
    target = radius * np.array([math.cos(bearing), math.sin(bearing), 0.0])
    found = inverse_kinematics(chain, target, [bearing - 0.3, 0.6])
    assert found.residual == pytest.approx(max(radius - 1.8, 0.0), abs=TOLERANCE)
    assert found.reached is (found.residual <= TOLERANCE)


@given(st.floats(0.05, 0.3), units(2))
def test_off_its_plane_a_planar_arm_comes_to_the_nearest_point(height: float, bearing: Array) -> None:
    found = inverse_kinematics(Chain("zzz", (1.0, 0.8, 0.5)), [*(1.4 * bearing), height], [0.2, 0.5, 0.5])
    assert not found.reached
    assert found.residual == pytest.approx(height, abs=1e-6)


def test_a_dragged_path_is_followed_without_jumps() -> None:
    chain = Chain("zyyzyyzy", (1.0, 0.8, 0.5, 0.6, 0.7, 0.3, 0.4, 0.2))
    turns = np.array([0.3, 0.4, -0.5, 0.3, 0.6, -0.4, 0.5, 0.2])
    centre = end(chain, turns)
    for moment in np.linspace(0.0, 4.0 * math.pi, 200):
        target = centre + 0.6 * np.array([math.cos(moment) - 1.0, math.sin(moment), 0.3 * math.sin(2.0 * moment)])
        found = inverse_kinematics(chain, target, turns)
        assert found.reached
        assert np.abs(found.angles - turns).max() < 0.15
        turns = found.angles


def test_a_drag_out_of_reach_and_back_is_smooth() -> None:
    chain = Chain("zyy", (1.0, 0.8, 0.5))
    turns = inverse_kinematics(chain, [1.8, 0.3, 0.2], [0.2, 0.4, 0.5]).angles
    for x in [*np.linspace(1.8, 3.5, 60), *np.linspace(3.5, 1.8, 60)]:
        found = inverse_kinematics(chain, [x, 0.3, 0.2], turns)
        assert np.abs(found.angles - turns).max() < 0.35
        turns = found.angles
    assert found.reached


def test_an_arm_without_length_stays() -> None:
    found = inverse_kinematics(Chain("zy", (0.0, 0.0)), [1.0, 0.0, 0.0], [0.1, 0.2])
    np.testing.assert_array_equal(found.angles, [0.1, 0.2])
    assert not found.reached


def test_bad_input_is_refused() -> None:
    chain, inf = Chain("zy", (1.0, 1.0)), math.inf
    bad: list[tuple[str, list[float], list[float], float]] = [
        ("target", [inf, 0.0, 0.0], [0.0, 0.0], 1e-3),
        ("target", [0.0, 0.0], [0.0, 0.0], 1e-3),
        ("start", [1.0, 0.0, 0.0], [0.0], 1e-3),
        ("start", [1.0, 0.0, 0.0], [0.0, math.nan], 1e-3),
        ("tolerance", [1.0, 0.0, 0.0], [0.0, 0.0], 0.0),
    ]
    for argument, target, start, tolerance in bad:
        with pytest.raises(GeometryError, match=argument):
            inverse_kinematics(chain, target, start, tolerance=tolerance)
    with pytest.raises(GeometryError, match="start"):
        inverse_kinematics(chain, [1.0, 0.0, 0.0], np.zeros((3, 2)))


def scara() -> Chain:
    """Two turns, a slide downwards, a turn."""
    return Chain("zzzz", (0.425, 0.375, 0.0, 0.0), (0.0, math.pi, 0.0, 0.0), (0.3, 0.0, 0.0, 0.0), joints="rrpr")


@given(st.floats(-2.0, 2.0), st.floats(0.4, 2.5), st.floats(0.0, 0.2), st.floats(-0.2, 0.2), st.floats(-0.1, 0.1))
def test_a_joint_that_slides_takes_part(first: float, elbow: float, down: float, more: float, lower: float) -> None:
    chain = scara()
    target = end(chain, np.array([first + more, elbow - more, down + lower, 0.0]))
    found = inverse_kinematics(chain, target, [first, elbow, down, 0.0])
    consistent(chain, target, found)
    assert found.reached
    assert found.angles[2] == pytest.approx(down + lower, abs=TOLERANCE)
