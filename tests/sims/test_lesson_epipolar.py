"""The equations of the lesson on epipolar geometry, both sides at states that nobody chose."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from geometry.eight_point import eight_point
from geometry.rotations import axis_rotation
from sims.epipolar import EpipolarParams, solve

State = tuple[EpipolarParams, Any]


def solved(p: EpipolarParams) -> Any:
    """A solution in which everything exists."""
    return solve(p)


def states() -> Iterator[EpipolarParams]:
    rng = np.random.default_rng(7)
    for _ in range(4):
        left, right = rng.uniform((-1.2, -0.5, 0.5), (1.2, 0.5, 1.5), (2, 3))
        yield EpipolarParams(
            left=tuple(left), right=tuple(right), left_pan=rng.uniform(-20, 20), right_pan=rng.uniform(-20, 20),
            point=tuple(rng.uniform((-1, 3, 0), (1, 6, 2))),
        )  # fmt: skip


@pytest.fixture(params=list(states()), ids=str)
def state(request: pytest.FixtureRequest) -> State:
    return request.param, solved(request.param)


def test_F_turns_a_pixel_into_its_line(state: State) -> None:
    _, s = state
    line = s.F @ [*s.pixel_left, 1.0]
    np.testing.assert_allclose(
        np.cross(line / np.linalg.norm(line), s.line_right / np.linalg.norm(s.line_right)), 0.0, atol=1e-9
    )
    assert s.line_right[0] ** 2 + s.line_right[1] ** 2 == pytest.approx(1.0)
    assert s.line_right @ [*s.pixel_right, 1.0] == pytest.approx(0.0, abs=1e-8)
    assert [*s.pixel_right, 1.0] @ s.F @ [*s.pixel_left, 1.0] == pytest.approx(0.0, abs=1e-8)


def test_F_is_made_of_the_cameras_and_E_of_the_motion(state: State) -> None:
    p, s = state
    axes = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
    left, right = ((axis_rotation("z", np.radians(pan)) @ axes).T for pan in (p.left_pan, p.right_pan))
    R, (x, y, z) = right @ left.T, right @ np.subtract(p.left, p.right)
    crossed = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    inverse = np.linalg.inv(s.K)
    for made, known in ((crossed @ R, s.E), (inverse.T @ crossed @ R @ inverse, s.F)):
        np.testing.assert_allclose(abs((made * known).sum()) / np.linalg.norm(made), 1.0, atol=1e-9)


def test_the_epipole_has_no_line_and_F_has_rank_2(state: State) -> None:
    _, s = state
    np.testing.assert_allclose(s.F @ s.epipole_left, 0.0, atol=1e-12)
    assert s.rank == np.linalg.matrix_rank(s.F, 1e-12) == 2


def test_no_point_of_the_ray_leaves_the_line_and_the_pixel_stays(state: State) -> None:
    p, s = state
    for far in (0.7, 1.6):
        slid = solved(p.changed({"point": tuple(np.add(p.left, far * np.subtract(p.point, p.left)))}))
        assert slid.pixel_left == pytest.approx(s.pixel_left)
        assert s.line_right @ [*slid.pixel_right, 1.0] == pytest.approx(0.0, abs=1e-8)


def test_eight_pairs_are_enough_and_the_estimate_has_rank_2() -> None:
    s = solved(EpipolarParams(left=(-1.2, 0.4, 1.0), right=(1.2, 0.3, 1.2), left_pan=-18, right_pan=15, points=8))
    found = eight_point(s.pixels_left, s.pixels_right).F
    np.testing.assert_allclose(abs((found * s.F).sum()) / np.linalg.norm(found), 1.0, atol=1e-6)
    assert np.linalg.matrix_rank(found, 1e-12) == 2
