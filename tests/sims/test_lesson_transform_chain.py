"""What the lesson on transform chains says in formulas, against `geometry` and the sim."""

from __future__ import annotations

import math

import numpy as np
import pytest

from geometry import se3
from geometry.rotations import axis_rotation, is_rotation
from sims.transform_chain.params import ChainParams
from sims.transform_chain.solution import solve

dice = np.random.default_rng(29)
states = pytest.mark.parametrize(
    "p",
    [
        ChainParams(
            axes="".join(dice.choice([*"xyz"], 3)), angles=tuple(dice.uniform(-180, 180, 3)),
            lengths=tuple(dice.uniform(0.2, 1.5, 3)), point=tuple(dice.uniform(-1, 1, 3)),
        )
        for _ in range(4)
    ],
    ids=range(4),
)  # fmt: skip


@states
def test_a_link_turns_and_steps_and_its_matrix_does_both(p: ChainParams) -> None:
    for T, axis, angle, length in zip(solve(p).individual, p.axes, p.angles, p.lengths, strict=True):
        R, t = T[:3, :3], T[:3, 3]
        assert pytest.approx(axis_rotation(axis, math.radians(angle))) == R
        assert pytest.approx(R @ [length, 0, 0]) == t
        assert [*(R @ p.point + t), 1.0] == pytest.approx(T @ [*p.point, 1.0])
        assert T[3].tolist() == [0, 0, 0, 1]


@states
def test_products_and_inverses_stay_in_the_group(p: ChainParams) -> None:
    s = solve(p)
    for T in (*s.composed, s.inverse):
        assert is_rotation(T[:3, :3])
        assert T[3].tolist() == [0, 0, 0, 1]


@states
def test_the_hand_is_where_the_product_leads(p: ChainParams) -> None:
    s = solve(p)
    first, second, third = s.individual
    assert s.end_effector == pytest.approx(first @ second @ third)
    assert s.end == pytest.approx(s.end_effector[:3, 3])
    assert s.through[3] == pytest.approx(first @ (second @ (third @ [*p.point, 1.0])))
    assert s.kept[0][0] == pytest.approx(s.kept[0][1])


@states
def test_the_way_back_turns_its_step(p: ChainParams) -> None:
    s = solve(p)
    R, t = s.end_effector[:3, :3], s.end_effector[:3, 3]
    assert s.inverse == pytest.approx(se3.transform(R.T, -R.T @ t))
    assert s.inverse @ s.end_effector == pytest.approx(np.eye(4))


@pytest.mark.parametrize("angle", dice.uniform(-180, 180, 3))
def test_the_hand_of_one_link_sees_the_world_straight_behind(angle: float) -> None:
    assert solve(ChainParams(axes="z", angles=(angle,), lengths=(1.0,))).inverse[:3, 3] == pytest.approx([-1, 0, 0])


def test_two_turns_exchanged_lead_down_and_to_the_side_but_about_one_axis_to_one_place() -> None:
    turns = ChainParams(axes="zyy", lengths=(0, 0, 1), angles=(90, 90, 0), swap=1)
    s = solve(turns)
    assert s.swapped is not None
    assert s.end == pytest.approx((0, 0, -1))
    assert s.swapped.end == pytest.approx((0, 1, 0))
    assert s.swapped.distance == pytest.approx(1.41, abs=0.005)
    alike = solve(turns.changed({"axes": "zzy", "angles": (40, 50, 0)})).swapped
    assert alike is not None
    assert alike.distance == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("angle", dice.uniform(-180, 180, 3))
def test_how_freely_a_flat_arm_moves_goes_with_the_sine_of_its_elbow(angle: float) -> None:
    s = solve(ChainParams(axes="zz", lengths=(1.0, 0.8), angles=(30.0, angle)))
    assert s.manipulability == pytest.approx(1.0 * 0.8 * abs(math.sin(math.radians(angle))))
