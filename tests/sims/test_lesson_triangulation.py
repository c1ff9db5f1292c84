"""The equations of the lesson on triangulation, both sides at states that nobody chose."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from sims.triangulation import TriangulationParams, solve
from sims.triangulation.calibration import toe_in
from sims.triangulation.rig import rig

RNG = np.random.default_rng(5)
RIGS = [(float(b), float(f)) for b, f in RNG.uniform((0.2, 300.0), (1.5, 1200.0), (4, 2))]
each_rig = pytest.mark.parametrize(("baseline", "focal"), RIGS)


def solved(p: TriangulationParams) -> Any:
    """A solution in which everything exists."""
    return solve(p)


def seen(baseline: float, focal: float, place: tuple[float, float, float], **more: float) -> TriangulationParams:
    """A state whose marks are those of a place in the room; both cameras stand at a height of 1 m."""
    x, y, z = place
    left, right = (320.0 + focal * (x + half) / y for half in (0.5 * baseline, -0.5 * baseline))
    v = 240.0 - focal * (z - 1.0) / y
    return TriangulationParams(baseline=baseline, focal=focal, left_uv=(left, v), right_uv=(right, v), **more)


@each_rig
def test_depth_is_f_b_over_d(baseline: float, focal: float) -> None:
    s = solved(seen(baseline, focal, (0.0, 7.0, 1.1)))
    assert s.disparity == pytest.approx(s.measured_left[0] - s.measured_right[0])
    assert s.depth_from_disparity == pytest.approx(focal * baseline / s.disparity) == pytest.approx(7.0)
    assert s.point.item(1) == pytest.approx(7.0)


@each_rig
def test_its_doubt_is_root_2_sigma_Z_squared_over_f_b(baseline: float, focal: float) -> None:
    for depth in (4.0, 8.0):
        s = solved(seen(baseline, focal, (0.0, depth, 1.1)))
        assert s.depth_sigma == pytest.approx(math.sqrt(2.0) * s.sigma_px * depth**2 / (focal * baseline))


@each_rig
def test_two_rows_of_A_for_each_picture_are_zero_at_the_point(baseline: float, focal: float) -> None:
    p = seen(baseline, focal, (0.1, 6.0, 1.2))
    cameras, X = rig(p), np.array([0.1, 6.0, 1.2, 1.0])
    for camera, (u, v) in ((cameras.left, p.left_uv), (cameras.right, p.right_uv)):
        p1, p2, p3 = camera.P
        assert (u * p3 - p1) @ X == pytest.approx(0.0, abs=1e-8)
        assert (v * p3 - p2) @ X == pytest.approx(0.0, abs=1e-8)
    s = solved(p)
    assert s.equations.shape == (4, 4)
    np.testing.assert_allclose(s.equations @ X, 0.0, atol=1e-8)
    assert s.singular_values.item(3) == pytest.approx(0.0, abs=1e-9)


def test_the_point_of_DLT_is_the_last_singular_vector_by_its_fourth_entry() -> None:
    s = solved(TriangulationParams(right_uv=(320.0, 222.0)))
    np.testing.assert_allclose(s.least_vector[:3] / s.least_vector[3], s.by_method["dlt"].point)
    assert np.linalg.norm(s.equations @ s.least_vector) == pytest.approx(s.singular_values.item(3))


def test_each_method_makes_small_what_the_table_says() -> None:
    s = solved(TriangulationParams(right_uv=(320.0, 240.0)))
    rms = {name: found.reprojection_rms for name, found in s.by_method.items()}
    assert rms["optimal"] == min(rms.values())
    np.testing.assert_allclose(s.by_method["midpoint"].point, s.closest_points.mean(axis=0))


def test_doffs_are_added_to_the_disparity() -> None:
    s = solved(TriangulationParams(doffs=30.0))
    assert s.point.item(1) == pytest.approx(600.0 * 0.6 / (90.0 + 30.0))


def test_marks_of_turned_cameras_differ_by_less_than_nothing_and_yet_there_is_a_point() -> None:
    p = TriangulationParams(**toe_in(TriangulationParams()))
    s = solved(p)
    assert (round(p.left_uv[0]), round(p.right_uv[0])) == (560, 1288)
    assert s.disparity is None
    assert s.depth == pytest.approx(s.point_left.item(2)) == pytest.approx(4.045, abs=1e-3)
    np.testing.assert_allclose(s.least_vector[:3] / s.least_vector[3], s.by_method["dlt"].point)
    longer = solved(p.moved({"baseline": 1.0}))
    np.testing.assert_allclose(longer.point, s.point)
    assert longer.depth_sigma < s.depth_sigma


def test_twice_the_baseline_at_the_same_point_is_half_the_doubt() -> None:
    near, far = (
        solved(TriangulationParams(baseline=b, left_uv=(left, 225.0), right_uv=(right, 225.0)))
        for b, left, right in ((0.6, 365.0, 320.0), (1.2, 387.5, 297.5))
    )
    np.testing.assert_allclose(near.point, far.point)
    assert near.depth_sigma == pytest.approx(2.0 * far.depth_sigma)
