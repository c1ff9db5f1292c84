"""The equations on the page of the rings, both sides at random states."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from geometry.rotations import axis_rotation
from sims import gimbal_lock
from sims.gimbal_lock import GimbalParams, solve

LESSON = (Path(gimbal_lock.__file__).parent / "lesson.md").read_text("utf-8")
STATES = [GimbalParams(yaw=y, pitch=p, roll=r) for y, p, r in np.random.default_rng(4).uniform(-180, 180, (6, 3))]
each_state = pytest.mark.parametrize("p", STATES, ids=lambda p: p.query())


@each_state
def test_rotation_is_the_product_of_the_rings_from_the_outside_in(p: GimbalParams) -> None:
    outer, middle, inner = (axis_rotation(axis, math.radians(a)) for axis, a in zip("zyx", p.angles, strict=True))
    np.testing.assert_allclose(solve(p).R, outer @ middle @ inner, atol=1e-12)


@each_state
def test_inner_axis_is_where_the_page_says(p: GimbalParams) -> None:
    yaw, pitch, _ = map(math.radians, p.angles)
    axis = math.cos(yaw) * math.cos(pitch), math.sin(yaw) * math.cos(pitch), -math.sin(pitch)
    np.testing.assert_allclose(solve(p).axes[:, 2], axis, atol=1e-12)
    np.testing.assert_array_equal(solve(p).axes[:, 0], (0, 0, 1))


@each_state
def test_smallest_singular_value_and_the_product_of_all(p: GimbalParams) -> None:
    s, pitch = solve(p), math.radians(p.pitch)
    assert s.singular_values[2] == pytest.approx(math.sqrt(1 - abs(math.sin(pitch))), abs=1e-12)
    assert np.prod(s.singular_values) == pytest.approx(abs(np.linalg.det(s.axes)), abs=1e-12)
    assert s.conditioning == pytest.approx(abs(math.cos(pitch)), abs=1e-12)
    np.testing.assert_allclose(np.linalg.svd(s.axes)[1], s.singular_values, atol=1e-12)


@each_state
def test_at_both_ends_one_combination_is_left(p: GimbalParams) -> None:
    yaw, _, roll = map(math.radians, p.angles)
    for end in (1, -1):
        c, s = math.cos(yaw - end * roll), math.sin(yaw - end * roll)
        R = np.array([[0.0, -s, end * c], [0.0, c, end * s], [-end, 0.0, 0.0]])
        np.testing.assert_allclose(solve(p.changed({"pitch": 90 * end})).R, R, atol=1e-12)


def test_table_says_what_the_rings_do() -> None:
    for pitch, told in ((0, "| 0° | 1 |"), (45, "| ±45° | 0.541 |"), (80, "| ±80° | 0.123 |"), (90, "| ±90° | 0 |")):
        assert told in LESSON
        assert float(told.split("|")[2]) == pytest.approx(solve(GimbalParams(pitch=pitch)).singular_values[2], abs=5e-4)
    assert max(solve(GimbalParams(pitch=80)).rates) == pytest.approx(5.74, abs=0.005), "almost 6 times as fast"


def test_turns_that_are_told_of() -> None:
    ghost = {"yaw": 40, "roll": 40, "show_ghost": True}
    for pitch, apart in ((90, 0.0), (-90, 80.0)):
        found = solve(GimbalParams(pitch=pitch, ghost=(0, pitch, 0), **ghost)).ghost
        assert found is not None
        assert found.angle == pytest.approx(apart, abs=1e-9)
    lost = solve(GimbalParams(pitch=90, show_ghost=True, ghost=(90, 60, 90)))
    assert lost.ghost is not None
    assert lost.lost_axis is not None
    assert lost.ghost.angle == pytest.approx(30.0)
    assert abs(lost.ghost.axis @ lost.lost_axis) == pytest.approx(1.0)
