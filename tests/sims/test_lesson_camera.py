"""What the lesson on cameras says in formulas, against `geometry` and the sim."""

from __future__ import annotations

import numpy as np
import pytest

from sims.camera.params import CameraParams
from sims.camera.solution import CameraSolution, NamedPoint, solve

dice = np.random.default_rng(23)
states = pytest.mark.parametrize(
    "p",
    [
        CameraParams(
            position=(dice.uniform(-1, 1), dice.uniform(-7, -4), dice.uniform(0.5, 2.5)), pan=dice.uniform(-20, 20),
            tilt=dice.uniform(-15, 10), roll=dice.uniform(-30, 30), fx=dice.uniform(400, 900),
            fy=dice.uniform(400, 900), cx=dice.uniform(250, 390), cy=dice.uniform(200, 280),
        )
        for _ in range(4)
    ],
    ids=range(4),
)  # fmt: skip


def seen(s: CameraSolution) -> list[NamedPoint]:
    found = [point for point in s.points if point.pixel is not None]
    assert len(found) > 10
    return found


@states
def test_a_pixel_is_a_direction_scaled_and_shifted(p: CameraParams) -> None:
    for point in seen(solve(p)):
        x, y, z = point.camera
        assert point.pixel == pytest.approx((p.fx * x / z + p.cx, p.fy * y / z + p.cy))


@states
def test_skew_adds_its_part_of_y(p: CameraParams) -> None:
    for plain, skewed in zip(seen(solve(p)), seen(solve(p.changed({"skew": 70.0}))), strict=True):
        _, y, z = plain.camera
        assert plain.pixel is not None
        assert skewed.pixel == pytest.approx((plain.pixel[0] + 70.0 * y / z, plain.pixel[1]))


@states
def test_P_is_K_times_R_and_t_and_its_third_number_the_depth(p: CameraParams) -> None:
    s = solve(p)
    assert s.P is not None
    assert pytest.approx(s.P) == s.K @ np.column_stack([s.R, s.t])
    for point in seen(s):
        u, v, w = s.P @ [*point.world, 1.0]
        assert (u / w, v / w) == pytest.approx(point.pixel)
        assert w == pytest.approx(point.depth)
        assert point.camera == pytest.approx(s.R @ point.world + s.t)


@states
def test_the_centre_is_where_the_cameras_axes_begin(p: CameraParams) -> None:
    s = solve(p)
    assert -s.R.T @ s.t == pytest.approx(p.position)
    assert s.R @ p.position + s.t == pytest.approx([0, 0, 0], abs=1e-12)


def test_the_house_is_as_far_and_as_tall_as_the_text_says_and_then_half_as_tall() -> None:
    near, far = solve(CameraParams()).subject, solve(CameraParams(position=(0.0, -9.55, 1.2))).subject
    assert near.height is not None
    assert far.height is not None
    assert (round(near.depth, 1), round(near.height)) == (5.6, 184)
    assert far.depth == pytest.approx(2 * near.depth, rel=1e-3)
    assert far.height == pytest.approx(near.height / 2, rel=1e-3)


def test_the_tops_of_the_posts_are_on_one_ray_and_the_far_one_about_twice_as_far() -> None:
    s = solve(CameraParams(position=(-0.5, -4.2, 1.0)))
    near, far = s.point("near-post"), s.point("far-post")
    assert near.pixel == pytest.approx(far.pixel, abs=0.2)
    assert far.depth / near.depth == pytest.approx(2.0, abs=0.1)


def test_orthographic_keeps_its_scale_and_weak_perspective_does_not() -> None:
    for projection, keeps in (("orthographic", True), ("weak", False)):
        here, back = (
            solve(CameraParams.model_validate({"projection": projection, "position": (0.0, y, 1.2)})).scale
            for y in (-4.0, -8.0)
        )
        assert (here == back) is keeps
