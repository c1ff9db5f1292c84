"""What the lesson on quaternions says in formulas, against `geometry` and the sim."""

from __future__ import annotations

import math
from functools import reduce

import numpy as np
import pytest

from geometry import quaternion
from geometry.arrays import Array
from geometry.euler import euler_to_matrix
from geometry.interpolation import slerp
from sims.quaternion.params import QuaternionParams
from sims.quaternion.solution import QuaternionSolution, solve
from sims.transform_chain.params import ChainParams
from sims.transform_chain.solution import solve as solve_chain

I, J, K = np.eye(4)[1:]
dice = np.random.default_rng(17)
states = pytest.mark.parametrize(
    "p",
    [
        QuaternionParams(
            axis=tuple(dice.uniform(-1, 1, 3)), angle=dice.uniform(5, 700), point=tuple(dice.uniform(-2, 2, 3)),
            show="path", t=dice.uniform(0.1, 0.9),
        )
        for _ in range(4)
    ],
    ids=range(4),
)  # fmt: skip


def product(*factors: Array) -> Array:
    return reduce(quaternion.multiply, factors)


@states
def test_q_is_half_the_angle_in_cosine_and_sine(p: QuaternionParams) -> None:
    s, half = solve(p), math.radians(p.angle) / 2
    assert s.q == pytest.approx([math.cos(half), *(math.sin(half) * s.n)])
    assert s.q @ s.q == pytest.approx(1.0)


def test_half_turns_multiply_as_i_j_and_k() -> None:
    for half_turn in (I, J, K):
        assert product(half_turn, half_turn) == pytest.approx([-1, 0, 0, 0])
    assert product(I, J) == pytest.approx(K)
    assert product(J, I) == pytest.approx(-K)
    assert solve(QuaternionParams(angle=180)).q == pytest.approx(K)


@states
def test_a_product_is_dot_cross_and_sums(p: QuaternionParams) -> None:
    (a, *u), (b, *v) = solve(p).q.tolist(), dice.normal(size=4).tolist()
    dot, cross = float(np.dot(u, v)), np.cross(u, v)
    assert product(np.array([a, *u]), np.array([b, *v])) == pytest.approx(
        [a * b - dot, *(a * np.array(v) + b * np.array(u) + cross)]
    )


@states
def test_a_point_is_turned_by_q_from_both_sides(p: QuaternionParams) -> None:
    s = solve(p)
    point = np.array([0.0, *p.point])
    turned = product(s.q, point, s.q * [1, -1, -1, -1])
    assert turned == pytest.approx(s.sandwich["rotated"])
    assert turned[1:] == pytest.approx(s.R_total @ p.point)


@states
def test_one_side_turns_what_is_across_by_half_and_spoils_what_is_along(p: QuaternionParams) -> None:
    s = solve(p)
    across = np.cross(s.n, p.point)
    by_half = quaternion.rotate(quaternion.from_axis_angle(s.n, math.radians(p.angle) / 2), across)
    assert product(s.q, np.array([0.0, *across])) == pytest.approx([0.0, *by_half])
    along = solve(p.changed({"point": tuple(1.4 * s.n)}))
    assert abs(along.sandwich["q_p"][0]) > 1e-3
    assert along.rotated_point == pytest.approx(1.4 * s.n)


@states
def test_without_the_half_a_turn_comes_out_twice(p: QuaternionParams) -> None:
    n, angle = solve(p).n, math.radians(p.angle)
    forgetful = np.array([math.cos(angle), *(math.sin(angle) * n)])
    twice = quaternion.from_axis_angle(n, 2 * angle)
    assert quaternion.to_matrix(forgetful) == pytest.approx(quaternion.to_matrix(twice))


@states
def test_slerp_is_the_formula_of_the_page(p: QuaternionParams) -> None:
    s = solve(p)
    omega = math.radians(s.way_angle) / 2
    end = s.q_total if s.start @ s.q_total >= 0 else -s.q_total
    blend = (math.sin((1 - p.t) * omega) * s.start + math.sin(p.t * omega) * end) / math.sin(omega)
    assert blend == pytest.approx(slerp(s.start, s.q_total, p.t))
    assert turned(s) == pytest.approx(p.t * s.way_angle)


def turned(s: QuaternionSolution) -> float:
    assert s.ways is not None
    return min(s.ways["slerp"].turned, 360.0 - s.ways["slerp"].turned)


@states
def test_the_links_onward_lead_to_the_same_turn(p: QuaternionParams) -> None:
    s = solve(p)
    chain = solve_chain(ChainParams(axes="zyx", lengths=(0.0, 0.0, 1.0), angles=s.euler))
    assert chain.end_effector[:3, :3] == pytest.approx(s.R_total)
    assert euler_to_matrix(np.radians(s.euler), "zyx", "intrinsic") == pytest.approx(s.R_total)
