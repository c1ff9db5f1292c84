"""epipolar: its numbers against the definitions and OpenCV, its states without an answer, what is drawn, its hands."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from itertools import pairwise
from typing import Any
from xml.etree import ElementTree

import cv2
import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.rooms.motion import between
from sims.epipolar import SIM, EpipolarParams, EpipolarSolution, candidate, numbers, plan, ray, solve
from sims.epipolar.actions import PRESETS
from sims.epipolar.panes import panes
from sims.epipolar.params import OTHERS, WORLD, title
from sims.kit import readout
from sims.kit.frame import INSET
from sims.kit.readout import figure
from sims.kit.refusals import BadParams
from sims.kit.sim import jsonable
from sims.kit.world import BODIES
from tests.frames import differences
from tests.server import Rig
from tests.sims.markup import words, xml

Array = npt.NDArray[np.float64]
START = EpipolarParams()
OPENED = EpipolarParams.from_query(())
SIDES = ("left", "right")
places = st.tuples(st.floats(-3, 3), st.floats(-3, 3), st.floats(0, 3))
pans = st.floats(-60, 60)
states = st.builds(
    EpipolarParams,
    left=places,
    right=places,
    left_pan=pans,
    right_pan=pans,
    focal=st.floats(200, 1500),
    point=st.tuples(st.floats(-5, 5), st.floats(-3, 12), st.floats(-2, 5)),
    points=st.integers(1, 12),
    noise=st.sampled_from([0.0, 1.0]),
)


LEVEL = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
OWN: dict[str, dict[str, Any]] = {
    "different cameras": {
        "own": (1400, 1390, 940, 560, 510, 515, 300, 250, 4, -22, 3, -310, 25, 60), "own_size": (1920, 1080, 640, 480),
    },
    "the right camera sees the left one": {
        "own": (458, 457, 367, 248, 900, 910, 500, 380, 2, 6, -1, 0.1, -0.05, 1.0), "own_size": (752, 480, 1024, 768),
    },
    "portrait": {
        "own": (3000, 3000, 1500, 2000, 3100, 3050, 1490, 2010, -3, 2, 1, -90, 0, 5),
        "own_size": (3000, 4000, 3000, 4000), "show_all_lines": True, "points": 12, "trail": (1.0, 8.0),
        "candidate": (1700.0, 2100.0),
    },
}  # fmt: skip
"""Stereo pairs of somebody's: the size of their pictures and their K differ, T is in any unit."""


def pose(p: EpipolarParams, side: str) -> tuple[Array, Array]:
    """Columns of the camera's axes in the world, and its centre: Rz(pan) C, as the contract has it.

    A pair of somebody's is turned by half its rotation to both sides; its baseline has 1.2 m.
    """
    if p.own is not None:
        half = cv2.Rodrigues(np.radians(p.own[8:11]) / 2.0)[0]
        toward = LEVEL @ half.T @ p.own[11:] * (-0.6 / np.linalg.norm(p.own[11:]))
        turned, way = (half, -toward) if side == "left" else (half.T, toward)
        return LEVEL @ turned, np.array([0.0, 0.0, 1.0]) + way
    a = math.radians(getattr(p, f"{side}_pan"))
    turn = np.array([[math.cos(a), -math.sin(a), 0], [math.sin(a), math.cos(a), 0], [0, 0, 1]])
    return turn @ LEVEL, np.array(getattr(p, side))


def lens(p: EpipolarParams, side: str) -> tuple[float, ...]:
    """fx, fy, cx, cy."""
    return (p.focal, p.focal, 320.0, 240.0) if p.own is None else p.own[:4] if side == "left" else p.own[4:8]


def last(p: EpipolarParams, side: str) -> tuple[float, float]:
    """The pixel at the lower right."""
    sizes = p.own_size or (640, 480, 640, 480)
    width, height = sizes[:2] if side == "left" else sizes[2:]
    return width - 1.0, height - 1.0


def pixels(p: EpipolarParams, side: str, points: npt.ArrayLike) -> Array:
    """Pixels (n, 2) of points (n, 3) in the world by the definition of a camera."""
    R, C = pose(p, side)
    x, y, z = ((np.asarray(points, dtype=float) - C) @ R).T
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        fx, fy, cx, cy = lens(p, side)
        return np.column_stack([cx + fx * x / z, cy + fy * y / z])


def in_frame(seen: Array, last: tuple[float, float] = (639.0, 479.0)) -> bool:
    return bool(((seen >= -0.5) & (seen <= np.add(last, 0.5))).all())


def close(seen: Any, expected: Any, *, within: float = 0.0) -> None:
    np.testing.assert_allclose(np.asarray(seen, dtype=float), np.asarray(expected, dtype=float), rtol=0, atol=within)


def lines_of(s: EpipolarSolution, side: str) -> Array:
    lines = s.lines_left if side == "left" else s.lines_right
    assert lines is not None
    return lines


def pixels_of(s: EpipolarSolution, side: str) -> Array:
    return s.pixels_left if side == "left" else s.pixels_right


each_preset = pytest.mark.parametrize("name", PRESETS)


# ---- numbers


def test_defaults_are_a_rectified_pair() -> None:
    s = solve(START)
    half = math.sqrt(0.5)
    close(s.K, [[600, 0, 320], [0, 600, 240], [0, 0, 1]])
    assert s.F is not None
    assert s.E is not None
    close(s.F, [[0, 0, 0], [0, 0, half], [0, -half, 0]], within=1e-12)
    close(s.E, [[0, 0, 0], [0, 0, half], [0, -half, 0]], within=1e-12)
    assert s.rank == 2
    close(s.singular_values, [half, half, 0], within=1e-12)
    assert s.epipole_left_pixel is s.epipole_right_pixel is None, "at infinity"
    close(s.epipole_left, [1, 0, 0], within=1e-12)
    assert s.pixel_left == pytest.approx((455, 210))
    assert s.pixel_right == pytest.approx((275, 210))
    for line in (s.line_left, s.line_right):
        assert line is not None
        close(np.abs(line), [0, 1, 210], within=1e-9)


@each_preset
@pytest.mark.parametrize("count", [1, 6, 12])
def test_all_shown_points_lie_in_both_pictures(name: str, count: int) -> None:
    p = START.changed({**PRESETS[name], "points": count})
    s = solve(p)
    for side in SIDES:
        assert len(pixels_of(s, side)) == count
        close(pixels_of(s, side), pixels(p, side, s.points), within=1e-9)
        assert in_frame(pixels_of(s, side))


@each_preset
def test_exact_points_satisfy_the_constraint_and_lines_run_through_point_and_epipole(name: str) -> None:
    s = solve(START.changed({**PRESETS[name], "points": 12}))
    assert s.F is not None
    assert s.residual is not None
    assert s.sampson is not None
    assert abs(s.residual) < 1e-9
    assert s.sampson < 1e-9
    for p_left, p_right in zip(s.pixels_left, s.pixels_right, strict=True):
        assert abs(np.append(p_right, 1) @ s.F @ np.append(p_left, 1)) < 1e-9
    for side, pole in (("left", s.epipole_left), ("right", s.epipole_right)):
        assert pole is not None
        for line, pixel in zip(lines_of(s, side), pixels_of(s, side), strict=True):
            assert math.hypot(line[0], line[1]) == pytest.approx(1.0, abs=1e-12)
            assert abs(line @ [*pixel, 1]) < 1e-6
            assert abs(line @ pole) < 1e-6 * max(abs(pole[2]), 1e-6), "a distance in pixels where it is finite"


@each_preset
def test_lines_are_opencvs(name: str) -> None:
    s = solve(START.changed({**PRESETS[name], "points": 12}))
    assert s.F is not None
    for which, seen, side in ((1, s.pixels_left, "right"), (2, s.pixels_right, "left")):
        expected = cv2.computeCorrespondEpilines(seen.reshape(-1, 1, 2), which, s.F)[:, 0]
        np.testing.assert_allclose(lines_of(s, side), expected, rtol=1e-4, atol=1e-3)  # single precision


@given(states)
def test_f_and_p_are_those_of_the_definition_in_every_state(p: EpipolarParams) -> None:
    s = solve(p)
    jsonable(s)
    for side, P in (("left", s.P_left), ("right", s.P_right)):
        R, C = pose(p, side)
        close(P, s.K @ np.column_stack([R.T, -R.T @ C]), within=1e-9)
    apart = math.dist(p.left, p.right)
    assert s.F is None if apart == 0.0 else s.F is not None or apart < 1e-12
    if s.F is None or apart < 1e-3:
        return
    assert s.rank == 2
    assert np.linalg.norm(s.F) == pytest.approx(1.0, abs=1e-12)
    assert s.F.max() >= -s.F.min() * (1 - 1e-9)
    # Any F of these cameras: [e']ₓ P' P⁺ (Hartley and Zisserman, eq. 9.1)
    e = s.P_right @ [*p.left, 1]
    expected = np.array([[0, -e[2], e[1]], [e[2], 0, -e[0]], [-e[1], e[0], 0]]) @ s.P_right @ np.linalg.pinv(s.P_left)
    expected /= np.linalg.norm(expected)
    close(s.F, np.sign((expected * s.F).sum()) * expected, within=1e-8)


@given(states)
def test_epipoles_are_where_each_camera_sees_the_other(p: EpipolarParams) -> None:
    s = solve(p)
    if s.F is None or math.dist(p.left, p.right) < 1e-2:
        return
    for side, other, pole in (("left", p.right, s.epipole_left_pixel), ("right", p.left, s.epipole_right_pixel)):
        (seen,) = pixels(p, side, [other])
        if np.abs(seen).max() < 1e4:  # neither at infinity nor almost
            assert pole == pytest.approx(tuple(seen), abs=1e-4)


def test_up_is_up() -> None:
    low, high = solve(START.changed({"point": (0.3, 4, 0.5)})), solve(START.changed({"point": (0.3, 4, 1.5)}))
    assert low.pixel_left is not None
    assert high.pixel_left is not None
    assert high.pixel_left[1] < low.pixel_left[1], "rows count downwards"


def test_forward_motion_has_both_epipoles_in_sight_and_turning_sends_them_away() -> None:
    s = solve(START.changed(PRESETS["forward"]))
    assert s.epipole_left_pixel == pytest.approx((320, 240), abs=1e-9)
    assert s.epipole_right_pixel == pytest.approx((320, 240), abs=1e-9)
    assert solve(START.changed(PRESETS["vertical"])).epipole_left_pixel is None
    converging = solve(START.changed(PRESETS["converging"]))
    assert converging.epipole_left_pixel == pytest.approx((320 + 600 * math.tan(math.radians(72)), 240))


def test_moving_the_point_in_its_epipolar_plane_keeps_both_lines() -> None:
    before, after = (solve(START.changed({"point": point})) for point in ((0.3, 4.0, 1.2), (-0.4, 2.0, 1.1)))
    assert before.pixel_left != after.pixel_left
    assert before.pixel_right != after.pixel_right
    close(before.line_left, after.line_left, within=1e-9)
    close(before.line_right, after.line_right, within=1e-9)


# ---- what doesn't exist


@pytest.mark.parametrize("pan", [0.0, 8.0])
def test_without_a_baseline_there_is_no_f_and_the_rest_goes_on(pan: float) -> None:
    p = START.changed(
        {"left": (0, 0, 1), "right": (0, 0, 1), "left_pan": pan, "right_pan": -pan, "points": 12, "pick": "left:9,9"}
    )
    s = jsonable(solve(p))
    nothing = (
        "F E rank singular_values epipole_left epipole_right epipole_left_pixel line_left line_right residual sampson"
    )
    assert all(s[name] is None for name in nothing.split())
    assert s["pixel_left"] is not None
    assert s["K"] is not None
    assert s["estimate"]["status"] == "ambiguous"
    assert s["picked"]["line"] is None
    html = words(readout.render(SIM.readouts(p, solve(p))))
    assert "without a baseline" in html
    assert "⚠" in html
    assert "more than one F" in html


def test_the_tiniest_baseline_has_an_f() -> None:
    s = solve(START.changed(SIM.states["tiny baseline"]))
    assert s.rank == 2
    assert s.residual == pytest.approx(0.0, abs=1e-9)


def test_points_that_are_not_in_front_have_no_pixel() -> None:
    s = solve(START.changed(SIM.states["behind one"]))
    assert s.pixel_right is None
    assert s.line_left is None
    assert s.residual is None
    assert s.pixel_left is not None
    assert s.line_right is not None, "its left pixel has a line all the same"
    s = solve(START.changed(SIM.states["behind both"]))
    assert all(each is None for each in (s.pixel_left, s.pixel_right, s.line_left, s.line_right))
    assert s.F is not None


def test_a_point_on_the_baseline_has_no_line() -> None:
    p = START.changed(SIM.states["point on the baseline"])
    s = solve(p)
    assert s.on_baseline
    assert s.line_left is s.line_right is s.drawn.plane is None
    assert "every plane" in words(readout.render(SIM.readouts(p, s)))


# ---- the picked pixel


@pytest.mark.parametrize("pick", ["left:200,300", "right:0,0", "left:639,479", "right:10.25,1e-05"])
def test_a_picked_pixel_stands_in_the_link_and_has_its_line_in_the_other_picture(pick: str) -> None:
    p = EpipolarParams.from_query([("pick", pick), *START.changed(PRESETS["converging"]).query_items().items()])
    assert p.query_items()["pick"] == pick
    s = solve(p)
    assert s.picked is not None
    assert s.F is not None
    assert pick.startswith(s.picked.side)
    F = s.F if s.picked.side == "left" else s.F.T
    expected = F @ [*s.picked.pixel, 1]
    close(s.picked.line, expected / math.hypot(*expected[:2]), within=1e-9)


@pytest.mark.parametrize(
    "pick",
    [
        "left", "left:", "left:1", "left:1,2,3", "middle:1,2", "Left:1,2", "left:a,b", "left:-1,2", "left:640,2",
        "right:1,480", "left:nan,1", "left:1e999,1", "left:1.2.3,4", "left: 1,2", "left:1,2 ", "",
    ],
)  # fmt: skip
def test_a_pick_that_is_none_is_refused_with_what_is_allowed(pick: str) -> None:
    with pytest.raises(BadParams) as caught:
        EpipolarParams.from_query([("pick", pick), ("focal", "700")])
    ((name, received, allowed),) = caught.value.complaints
    assert (name, received) == ("pick", pick)
    assert allowed == "left:u,v or right:u,v, with u from 0 to 639 and v from 0 to 479"
    assert caught.value.good == {"focal": "700"}


def test_pictures_are_picked_in_and_the_pick_is_cleared() -> None:
    assert SIM.handles["pick_left"](START, (12.5, 30.25)) == {"pick": "left:12.5,30.25"}
    assert SIM.handles["pick_right"](START, (-4.0, 600.0)) == {"pick": "right:0,479"}
    picked = START.changed({"pick": "left:1,2"})
    clear: Any = next(action for action in SIM.actions if action.name == "clear-pick")
    assert picked.changed(clear.run(picked)) == START


# ---- F from the points


@each_preset
def test_exact_pixels_give_the_true_f(name: str) -> None:
    s = solve(START.changed({**PRESETS[name], "points": 8}))
    assert s.estimate.status == "found"
    assert s.estimate.difference == pytest.approx(0.0, abs=1e-9)
    assert s.estimate.exact_rms == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("count", [1, 7])
def test_fewer_than_eight_points_are_too_few_and_it_is_said(count: int) -> None:
    p = START.changed({"points": count, "noise": 1.0})
    s = solve(p)
    assert s.estimate.status == "few"
    assert s.estimate.F is None
    assert f"takes 8 points that both cameras see; here are {count}." in words(readout.render(SIM.readouts(p, s)))


def test_a_point_that_one_camera_does_not_see_is_left_out() -> None:
    p = START.changed({**SIM.states["behind one"], "points": 9})
    assert solve(p).estimate.seen == 8
    assert solve(p).estimate.status == "found"
    assert solve(p.changed({"points": 8})).estimate.status == "few"


def test_noise_is_of_its_seed_and_makes_an_estimate_that_fits_the_noise_better_than_the_truth() -> None:
    p = START.changed({"points": 12, "noise": 1.0})
    fits = [solve(p.changed({"seed": seed})) for seed in range(40)]
    for seed, s in enumerate(fits):
        assert s.estimate.F is not None
        assert np.linalg.svd(s.estimate.F)[1][2] < 1e-12
        close(s.estimate.F, solve(p.changed({"seed": seed})).estimate.F)
        measured = s.estimate.measured_left - s.pixels_left, s.estimate.measured_right - s.pixels_right
        assert 0.5 < np.concatenate(measured).std() < 1.6
        np.testing.assert_array_equal(s.pixels_left, solve(p.changed({"noise": 0.0})).pixels_left)
    assert mean(fits, "noisy_rms") < mean(fits, "noisy_rms_true")
    less = [solve(p.changed({"seed": seed, "noise": 0.1})) for seed in range(40)]
    assert mean(less, "difference") < 0.3 * mean(fits, "difference")


def mean(solutions: list[EpipolarSolution], name: str) -> float:
    return float(np.mean([getattr(s.estimate, name) for s in solutions]))


def test_the_button_shows_noise_and_then_the_next() -> None:
    button: Any = next(action for action in SIM.actions if action.name == "new-sample").run
    noisy = START.changed(button(START))
    assert (noisy.noise, noisy.points, noisy.seed) == (1.0, 12, 0)
    assert noisy.changed(button(noisy)).seed == 1
    assert START.changed(button(noisy.changed({"seed": 9999}))).seed == 0


# ---- depth along the left ray


def slid(p: EpipolarParams) -> Iterator[EpipolarParams]:
    """States of a sweep, in twenty parts a leg."""
    for step in ray.sweep(p):
        start = p
        for k in range(1, 21 if step.seconds else 2):
            part = k / 20 if step.seconds else 1.0
            p = start.moved({name: between(getattr(start, name), value, part) for name, value in step.changes.items()})
            yield p


@each_preset
def test_a_sweep_moves_p_prime_along_its_line_while_p_stays(name: str) -> None:
    before = START.changed(PRESETS[name])
    at = solve(before)
    assert at.line_right is not None
    seen = []
    for p in slid(before):
        s = solve(p)
        assert s.pixel_left == pytest.approx(at.pixel_left, abs=1e-6)
        assert s.pixel_right is not None, "it is before the right camera all the time"
        assert abs(at.line_right @ [*s.pixel_right, 1.0]) < 1e-6
        seen.append(s.pixel_right)
    assert p.point == pytest.approx(before.point)
    assert p.trail is not None
    assert math.dist(min(seen), max(seen)) > 40.0, "it runs a good way"
    near, far = (solve(p.changed({"point": ray.reached(p, depth)[1]})) for depth in p.trail)
    trail = solve(p).trail
    assert trail is not None
    assert trail.pixels is not None
    close(trail.pixels, [near.pixel_right, far.pixel_right], within=1e-6)


def test_the_depth_has_a_slider_that_leaves_a_trail(rig: Rig) -> None:
    rig.show(OPENED)
    before = rig.session.solution
    for depth in (2.0, 6.0, 4.0):
        rig.browser.move("depth", depth)
        rig.settle()
        s = rig.session.solution
        assert s.depth_left == pytest.approx(depth)
        assert rig.column.values["depth"] == s.depth_left
        close(s.pixel_left, before.pixel_left, within=1e-9)
        assert math.dist(s.pixel_right, before.pixel_right) > 5.0
    assert rig.session.params.model_dump()["trail"] == pytest.approx((2.0, 6.0))
    close(s.trail.steps, rig.model.points("/trail_steps"), within=1e-6)
    assert len(s.trail.steps) == 5, "one at each whole metre"
    close(ends(rig, "/trail"), s.trail.ends, within=1e-6)
    rig.browser.press("clear-pick")
    rig.settle()
    assert rig.session.params.model_dump()["trail"] is None
    assert not rig.model.visible("/trail")


def test_where_p_slides_a_link_is_without_the_last_digits_of_a_product() -> None:
    p = EpipolarParams()
    for depth in (2.05, 3.1):
        p = p.changed(ray.hold(p, (depth,)))
    assert (p.point, p.trail) == ((0.0975, 3.1, 1.155), (2.05, 4.0))


@given(states, st.floats(0.01, 30), st.floats(0.01, 30))
def test_a_trail_is_where_the_right_camera_sees_the_ray(p: EpipolarParams, one: float, other: float) -> None:
    p = p.changed({"trail": (one, other)})
    s = solve(p)
    if s.trail is None:
        assert s.depth_left < ray.LEAST
        return
    assert s.trail.near <= min(one, other, s.depth_left * (1 + 1e-12))
    R, C = pose(p, "right")
    for place, pixel in zip(s.trail.steps, s.trail.step_pixels, strict=True):
        depth = float((place - C) @ R[:, 2])
        if depth > 1e-3:
            close(pixels(p, "right", [place])[0], pixel, within=1e-6 * max(1.0, float(np.abs(pixel).max())))
        elif depth < -1e-9:
            assert np.isnan(pixel).all()
    for pixel in s.trail.pixels or ():
        assert np.isfinite(pixel).all()


# ---- a free pixel of the right picture


def skew_distance(p: EpipolarParams, s: EpipolarSolution, pixel: tuple[float, float]) -> float:
    """How far the lines of sight are apart, by the textbook's formula."""
    ways = []
    for side, (u, v) in (("left", s.pixel_left or (0.0, 0.0)), ("right", pixel)):
        R, _ = pose(p, side)
        ways.append(R @ [(u - 320) / p.focal, (v - 240) / p.focal, 1.0])
    normal = np.cross(ways[0], ways[1])
    return float(abs(np.subtract(p.right, p.left) @ normal) / np.linalg.norm(normal))


@pytest.mark.parametrize("pixel", [(380.0, 300.0), (100.0, 20.0), (378.5, 250.25)])
def test_off_the_line_no_point_gives_the_pair_and_it_is_said_how_far(pixel: tuple[float, float]) -> None:
    p = OPENED.changed({"candidate": pixel})
    s = solve(p)
    c = s.candidate
    assert c is not None
    assert c.distance is not None
    assert c.residual is not None
    assert s.F is not None
    assert s.pixel_left is not None
    line = s.F @ [*s.pixel_left, 1.0]
    assert c.residual == pytest.approx(line @ [*pixel, 1.0], abs=1e-12)
    assert c.distance == pytest.approx(line @ [*pixel, 1.0] / math.hypot(line[0], line[1]), abs=1e-9)
    assert c.foot is not None
    assert math.dist(c.foot, pixel) == pytest.approx(abs(c.distance), abs=1e-9)
    assert c.verdict == "off the line"
    if c.gap is not None:
        assert c.gap == pytest.approx(skew_distance(p, s, pixel), abs=1e-9)
    said = SIM.caption(p, s)
    assert said.startswith("No point in space gives this pair")
    assert f"{abs(c.distance):.1f}" in said
    shown = words(readout.render(SIM.readouts(p, s)))
    assert figure(c.residual) in shown
    assert f"{abs(c.distance):.1f}" in shown


def test_residual_distance_and_gap_grow_together_as_it_leaves_the_line(rig: Rig) -> None:
    p = OPENED
    for step in candidate.free(p):
        p = p.moved(step.changes)
    rig.show(p)
    begun = rig.session.solution.candidate
    assert abs(begun.distance) == pytest.approx(candidate.AWAY)
    found = []
    for distance in (0.0, 5.0, 20.0, 60.0):
        rig.browser.move("off_line", distance)
        rig.settle()
        c = rig.session.solution.candidate
        assert c.distance == pytest.approx(distance, abs=1e-9)
        close(c.foot, begun.foot, within=1e-9)
        found.append((abs(c.residual), c.gap))
        if distance:
            close(ends(rig, "/candidate/gap"), c.nearest, within=1e-6)
            assert rig.model.labels()["/candidate/place/label"] == f"gap {c.gap:.2f}\u2009m"
    assert found[0] == pytest.approx((0.0, 0.0), abs=1e-9)
    assert found == sorted(found)
    assert all(a < b for one, other in pairwise(found) for a, b in zip(one, other, strict=True))


@pytest.mark.parametrize(
    ("name", "verdict", "said"),
    [
        ("free on the line", "a point", "one point in space"), ("free and parallel", "at infinity", "at infinity"),
        ("free and behind", "behind a camera", "behind a camera"), ("free without a baseline", "no line", ""),
    ],
)  # fmt: skip
def test_on_the_line_the_rays_meet_or_part_or_are_parallel(name: str, verdict: str, said: str) -> None:
    p = START.changed(SIM.states[name])
    s = solve(p)
    assert s.candidate is not None
    assert s.candidate.verdict == verdict
    assert said in SIM.caption(p, s)
    if verdict == "a point":
        assert s.candidate.nearest is not None
        close(pixels(p, "right", [s.candidate.nearest[1]]), [s.candidate.pixel], within=1e-6)
    else:
        assert s.candidate.nearest is None


def test_p_prime_is_held_until_it_is_free_and_then_only_q_prime() -> None:
    _, right, *_ = panes(OPENED, solve(OPENED))
    assert 'data-handle="right_pixel"' in right.svg
    p = OPENED.changed({"candidate": (380.0, 300.0)})
    left, right, *_ = panes(p, solve(p))
    assert 'data-handle="left_pixel"' in left.svg
    assert "right_pixel" not in right.svg
    assert 'data-handle="candidate" data-x="380.0" data-y="300.0"' in right.svg.replace(' data-link=""', "")
    assert SIM.handles["candidate"](p, (-5.0, 900.0)) == {"candidate": (0.0, 479.0)}


# ---- what is read, and from where all is seen


def shown_matrix(html: str, name: str) -> Array:
    """A matrix as its digits say it."""
    for formula in xml(html).iter("math"):
        if "".join(formula.itertext()).startswith(f"{name}="):
            entries = [[str(n.text).replace("−", "-") for n in entry.iter("mn")] for entry in formula.iter("mtd")]
            return np.array([float(e[0]) * 10.0 ** int(e[2]) if len(e) == 3 else float(e[0]) for e in entries]).reshape(
                3, 3
            )
    raise AssertionError(name)


@pytest.mark.parametrize("name", [*PRESETS, "random 3", "random 8"])
def test_the_digits_of_f_that_are_shown_satisfy_the_constraint_and_all_of_them_can_be_copied(name: str) -> None:
    p = START.changed({**PRESETS[name], "points": 12}) if name in PRESETS else DRAWN[name]
    s = solve(p)
    html = readout.render(SIM.readouts(p, s))
    F = shown_matrix(html, "F")
    for left, right in zip(s.pixels_left, s.pixels_right, strict=True):
        if np.isfinite(left).all() and np.isfinite(right).all():
            line = F @ [*left, 1.0]
            off = abs(line @ [*right, 1.0]) / math.hypot(line[0], line[1])
            assert off < 0.05 * max(1.0, float(np.abs([*left, *right]).max()) / 640.0)
    copied = [e.get("value") for e in xml(html).iter("button") if e.get("data-s3") == "copy"]
    assert s.F is not None
    np.testing.assert_array_equal(json.loads(str(copied[0])), s.F)


@each_preset
def test_the_epipolar_plane_is_not_seen_edge_on(name: str) -> None:
    p = START.changed(PRESETS[name])
    s = solve(p)
    view = SIM.home(p, s)
    assert s.drawn.plane is not None
    a, b, _, d = s.drawn.plane
    normal = np.cross(b - a, d - a)
    area = float(np.linalg.norm(normal))
    toward = np.subtract(view.look_at, view.position)
    assert abs(normal @ toward) / area / np.linalg.norm(toward) > 0.25
    assert min(np.linalg.norm(b - a), area / np.linalg.norm(b - a)) >= 0.99, "it is no thin strip"


def test_sliding_along_the_ray_leaves_the_view_alone() -> None:
    homes = {SIM.home(p, solve(p)) for p in slid(OPENED) if p.trail is not None}
    assert len(homes) == 1


@each_preset
@pytest.mark.parametrize("lines", [True, False])
def test_numbers_in_the_pictures_cover_neither_points_nor_each_other(name: str, *, lines: bool) -> None:
    p = START.changed({**PRESETS[name], "points": 12, "show_all_lines": lines})
    s = solve(p)
    for pane, side in zip(panes(p, s), SIDES, strict=False):
        spots = [tuple(each) for each in pixels_of(s, side).tolist()]
        boxes = {
            str(e.text): numbers.Box(
                float(str(e.get("x"))),
                float(str(e.get("y"))) - 0.5 * numbers.HIGH,
                0.5 * numbers.WIDE * len(str(e.text)),
            )
            for e in xml(pane.svg).iter("text")
            if str(e.text).isdecimal()
        }
        assert sorted(boxes, key=int) == [f"{k}" for k in range(2, 13)]
        for text, box in boxes.items():
            assert not any(box.covers(at, 6.0) for at in spots[1:]), text
            assert math.dist((box.u, box.v), spots[int(text) - 1]) < 40.0, "it stands beside its point"
            assert not any(box.meets(other) for other in boxes.values() if other is not box), text


def test_estimating_with_too_few_points_says_what_to_do() -> None:
    said = words(readout.render(SIM.readouts(START, solve(START))))
    assert "takes 8 points that both cameras see; here are 6. “Estimate F, new noise” shows 12." in said
    button: Any = next(action for action in SIM.actions if action.name == "new-sample")
    assert button.label in said
    assert solve(START.changed(button.run(START))).estimate.status == "found"


def test_what_corresponds_are_corners_of_things(rig: Rig) -> None:
    rig.show(START.changed({"points": 12}))
    np.testing.assert_array_equal(rig.model.world_pose("/things")[:3, 3], WORLD)
    corners = {tuple(np.round(np.add(corner, WORLD), 9)) for body in BODIES for face in body.faces for corner in face}
    for k, place in enumerate(OTHERS.tolist(), start=2):
        assert tuple(np.round(place, 9)) in corners
        assert title(k) in rig.column.html("pane")


def test_it_opens_with_an_epipole_in_a_picture_and_other_links_mean_what_they_meant() -> None:
    s = solve(OPENED)
    assert s.epipole_right_pixel is not None
    assert in_frame(np.array([s.epipole_right_pixel]))
    assert "Slide P along the left ray" in SIM.caption(OPENED, s)
    assert "at infinity" in SIM.caption(START, solve(START))
    assert OPENED.query() == ""
    assert EpipolarParams.from_query([("points", "9")]) == START.changed({"points": 9})
    assert EpipolarParams.from_query(START.query_items().items()) == START
    for changes in ({"left_pan": -8.0}, {"left": OPENED.left}, {**PRESETS["sight"], "points": 3}):
        p = START.changed(changes)
        assert EpipolarParams.from_query(p.query_items().items()) == p


# ---- shown equals drawn


@pytest.fixture(scope="module")
def rig() -> Iterator[Rig]:
    with Rig(SIM) as rig:
        yield rig


def drawn_states() -> dict[str, EpipolarParams]:
    named = {name: START.changed(changes) for name, changes in {"defaults": {}, **SIM.states, **OWN}.items()}
    random = np.random.default_rng(7)
    for k in range(20):
        left, right = random.uniform((-3, -3, 0), (3, 3, 3), (2, 3)).tolist()
        named[f"random {k}"] = START.changed(
            {
                "left": left, "right": right, "left_pan": random.uniform(-60, 60), "right_pan": random.uniform(-60, 60),
                "focal": random.uniform(200, 1500), "point": random.uniform((-5, -3, -2), (5, 12, 5)).tolist(),
                "points": int(random.integers(1, 13)), "show_all_lines": bool(k % 2), "show_plane": bool(k % 3),
                "pick": random.choice(["left:100,50", "right:600,400"]),
            }
        )  # fmt: skip
    return named


DRAWN = drawn_states()
each_drawn = pytest.mark.parametrize("params", DRAWN.values(), ids=DRAWN.keys())


def ends(rig: Rig, name: str) -> Array:
    """Both ends of a stroke, in the world."""
    drawn: Array = rig.model.points(name)[0]
    return drawn


@each_drawn
def test_cameras_points_and_rays_are_where_the_numbers_say(rig: Rig, params: EpipolarParams) -> None:
    rig.show(params)
    model, s = rig.model, solve(params)
    for side in SIDES:
        R, C = pose(params, side)
        seen = model.world_pose(f"/{side}")
        close(seen[:3, :3], R, within=1e-9)
        close(seen[:3, 3], C, within=1e-12)
        close(model.world_pose(f"/{side}_center")[:3, 3], C, within=1e-12)
        assert model.visible(f"/{side}_center") == (params.own is None), "somebody's pair can't be bent"
        assert any(name.startswith(f"/{side}/") for name in model.draggable()) == (params.own is None)
        foot = ends(rig, f"/{side}/post")[1]
        close(foot[2], 0.0, within=1e-6)
        corners = pixels(params, side, model.points(f"/{side}/picture"))
        close(corners[[0, 2]], [(-0.5, -0.5), np.add(last(params, side), 0.5)], within=2e-2)
        ray = model.points("/rays")[SIDES.index(side)]
        close(ray, [C, params.point], within=1e-6)
        pixel = s.pixel_left if side == "left" else s.pixel_right
        assert model.visible(f"/{side}/pixel") == (
            pixel is not None and in_frame(np.array([pixel]), last(params, side))
        )
        if model.visible(f"/{side}/pixel"):
            place = model.world_pose(f"/{side}/pixel")[None, :3, 3]
            close(pixels(params, side, place), [pixel], within=1e-6)
    np.testing.assert_array_equal(model.world_pose("/point")[:3, 3], params.point)
    close(ends(rig, "/baseline"), [pose(params, side)[1] for side in SIDES], within=1e-6)
    if params.points > 1:
        others = [f"/points/{k}" for k in range(2, 13)]
        assert [model.visible(name) for name in others] == [k < params.points for k in range(1, 12)]
        close([model.world_pose(name)[:3, 3] for name in others[: params.points - 1]], s.points[1:])


def crosses(lines: Array, last: tuple[float, float]) -> bool:
    """Whether any of the lines has corners of the picture on both its sides."""
    u, v = last
    corners = np.array([(0, 0, 1), (u, 0, 1), (u, v, 1), (0, v, 1)])
    apart = lines @ corners.T
    return bool(((apart.min(axis=1) < 0) & (apart.max(axis=1) > 0)).any()) if len(lines) else False


@each_drawn
def test_lines_and_epipoles_lie_on_the_pictures_where_the_numbers_say(rig: Rig, params: EpipolarParams) -> None:
    rig.show(params)
    model, s = rig.model, solve(params)
    left, right = (pose(params, side)[1] for side in SIDES)
    for side, line, pole in (
        ("left", s.line_left, s.epipole_left_pixel),
        ("right", s.line_right, s.epipole_right_pixel),
    ):
        if model.visible(f"/{side}/line"):
            assert line is not None
            for u, v in pixels(params, side, ends(rig, f"/{side}/line")):
                assert abs(line @ [u, v, 1]) < 0.05
                right_edge, bottom = np.add(last(params, side), 0.5)
                edges = abs(u + 0.5), abs(u - right_edge), abs(v + 0.5), abs(v - bottom)
                assert min(edges) < 0.05, "from edge to edge"
        if model.visible(f"/{side}/epipole"):
            assert pole is not None
            place = model.world_pose(f"/{side}/epipole")[:3, 3]
            np.testing.assert_allclose(pixels(params, side, [place]), [pole], rtol=1e-6, atol=1e-4)
            along = right - left
            across = np.cross(place - left, along) / np.linalg.norm(along)
            assert np.linalg.norm(across) < 1e-6, "on the baseline"
        if model.visible(f"/{side}/all_lines"):
            drawn = model.points(f"/{side}/all_lines")
            assert len(drawn) <= params.points - 1
            for piece in drawn:
                seen = np.column_stack([pixels(params, side, piece), np.ones(2)])
                assert np.abs(seen @ lines_of(s, side)[1:].T).max(axis=0).min() < 0.05
        else:
            assert not params.show_all_lines or s.F is None or not crosses(lines_of(s, side)[1:], last(params, side))


@each_drawn
def test_the_plane_holds_both_centres_and_the_point(rig: Rig, params: EpipolarParams) -> None:
    rig.show(params)
    s = solve(params)
    there = params.show_plane and s.F is not None and not s.on_baseline
    assert rig.model.visible("/plane") == there
    if there and s.baseline > 1e-3:
        corners = rig.model.points("/plane")
        normal = np.cross(corners[1] - corners[0], corners[3] - corners[0])
        normal /= np.linalg.norm(normal)
        for place in (*(pose(params, side)[1] for side in SIDES), params.point):
            assert abs(normal @ (np.array(place) - corners[0])) < 1e-4


@each_drawn
def test_the_picked_pixel_is_drawn(rig: Rig, params: EpipolarParams) -> None:
    rig.show(params)
    model, s = rig.model, solve(params)
    assert model.visible("/pick_ray") == (s.picked is not None)
    if s.picked is None:
        assert not model.visible("/left/picked_line")
        return
    side, other = s.picked.side, "right" if s.picked.side == "left" else "left"
    start, end = ends(rig, "/pick_ray")
    close(start, pose(params, side)[1], within=1e-6)
    close(pixels(params, side, [end]), [s.picked.pixel], within=1e-2)
    assert not model.visible(f"/{side}/picked_line")
    if model.visible(f"/{other}/picked_line"):
        assert s.picked.line is not None
        seen = np.column_stack([pixels(params, other, ends(rig, f"/{other}/picked_line")), np.ones(2)])
        assert np.abs(seen @ s.picked.line).max() < 0.05


@each_drawn
def test_trouble_is_said_in_the_scene_and_beside_it(rig: Rig, params: EpipolarParams) -> None:
    rig.show(params)
    s = solve(params)
    trouble = s.F is None or s.on_baseline or s.pixel_left is None or s.pixel_right is None
    assert rig.model.visible("/warning") == trouble
    assert not trouble or "s3-warn" in rig.column.html("read")


# ---- pictures


def shapes(svg: str, tag: str) -> list[dict[str, str]]:
    return [dict(e.attrib) for e in xml(svg).iter() if e.tag.split("}")[-1] == tag]


def unscaled(p: EpipolarParams, side: str, drawn: Any) -> Array:
    """The pixels (n, 2) that are drawn at places of a picture, which is 640 wide whatever the camera's is."""
    return np.asarray((np.asarray(drawn) + 0.5) * (last(p, side)[0] + 1.0) / 640.0 - 0.5)


@pytest.mark.parametrize(
    "name", ["defaults", "converging", "forward", "vertical", "picked", "noise", "zero baseline", "own pair", *OWN]
)
def test_pictures_show_the_pixels_of_the_solution(name: str) -> None:
    p = DRAWN[name].changed({"candidate": None})
    s = solve(p)
    for pane, side in zip(panes(p, s), SIDES, strict=False):
        near, (width, height) = (last(p, side)[0] + 1.0) / 640.0, np.add(last(p, side), 1.0)
        assert f'viewBox="-0.5 -0.5 640 {math.ceil(640 * height / width)}"' in pane.svg
        seen = [k for k in range(2, p.points + 1) if in_frame(pixels_of(s, side)[k - 1], last(p, side))]
        assert seen
        at = unscaled(p, side, [mark_places(pane.svg)[f"{k}"] for k in seen])
        np.testing.assert_allclose(at, [pixels_of(s, side)[k - 1] for k in seen], rtol=0, atol=0.006 * near)
        held = next(g for g in shapes(pane.svg, "g") if g.get("data-handle") == f"{side}_pixel")
        place = float(held["data-x"]), float(held["data-y"])
        pixel = s.pixel_left if side == "left" else s.pixel_right
        assert pixel is not None
        assert tuple(unscaled(p, side, place)) == pytest.approx(pixel, abs=1e-9)
        assert f"{pixel[0]:.1f}, {pixel[1]:.1f} pixels" in held["aria-label"]
        assert p.changed(SIM.handles[f"{side}_pixel"](p, place)).point == pytest.approx(p.point), "it is held there"
        assert SIM.handles[f"pick_{side}"](p, place)["pick"].startswith(f"{side}:{pixel[0]:.6f}"[:8])
        dashed = [d for d in shapes(pane.svg, "line") if d.get("stroke-dasharray") == "7 5"]
        line: Any = s.line_left if side == "left" else s.line_right
        assert len(dashed) == (line is not None)
        for d in dashed:
            for k in ("1", "2"):
                end = unscaled(p, side, (float(d[f"x{k}"]), float(d[f"y{k}"])))
                assert abs(np.dot(line, [*end, 1])) < 0.02 * near


def marks(svg: str, name: str) -> list[ElementTree.Element]:
    return [e for e in xml(svg).iter("g") if e.get("data-link") == name and "s3-point" in str(e.get("class"))]


def mark_places(svg: str) -> dict[str, Array]:
    """Where the linked points of a picture are."""
    return {str(e.get("data-link")): moved_to(e) for e in xml(svg).iter("g") if e.get("data-link")}


def moved_to(mark: ElementTree.Element) -> Array:
    """The place to which a mark is moved."""
    return np.array([float(v) for v in re.findall(r"[-\d.]+", str(mark.get("transform")))])


def at_border(place: Array) -> bool:
    return bool(min(place[0], 639 - place[0], place[1], 479 - place[1]) == pytest.approx(INSET - 0.5, abs=0.01))


@pytest.mark.parametrize(
    ("name", "heads"), [("defaults", 2), ("vertical", 2), ("converging", 1), ("forward", 0), ("zero baseline", 0)]
)
def test_an_epipole_that_is_outside_is_marked_at_the_border_in_its_direction(name: str, heads: int) -> None:
    p = DRAWN[name]
    s = solve(p)
    for pane, pole in zip(panes(p, s), (s.epipole_left_pixel, s.epipole_right_pixel), strict=False):
        found = [e for e in xml(pane.svg).iter("g") if "Epipole" in str(e.findtext("title"))]
        assert len(found) == heads
        for mark in found:
            (head,) = mark.iter("path")
            place = moved_to(mark)
            assert at_border(place)
            assert str(head.get("d")).count("z") == (2 if pole is None else 1), "at infinity it has two heads"
            if pole is not None:
                way, toward = place - (319.5, 239.5), np.array(pole) - (319.5, 239.5)
                close(way / np.linalg.norm(way), toward / np.linalg.norm(toward), within=1e-4)
        assert heads == 2 or "∞" not in "".join(xml(pane.svg).itertext())
        rings = [d for d in shapes(pane.svg, "circle") if d.get("class") == "s3-hollow"]
        assert len(rings) == (pole is not None and in_frame(np.array([pole])))


def test_points_that_are_outside_a_picture_are_marked_at_its_border() -> None:
    p = START.changed({"left_pan": 12, "right_pan": -12, "point": (4.0, 3.0, 1.0), "points": 12, "selected": 5})
    s = solve(p)
    out = 0
    for pane, side in zip(panes(p, s), SIDES, strict=False):
        for k, pixel in enumerate(pixels_of(s, side), start=1):
            if in_frame(pixel[None]):
                assert not any(at_border(moved_to(mark)) for mark in marks(pane.svg, f"{k}"))
                continue
            out += 1
            (mark,) = marks(pane.svg, f"{k}")
            assert at_border(moved_to(mark))
            assert "s3-selected" in str(mark.get("class")) or k != 5
    assert out > 6


def test_both_pictures_can_be_picked_in_and_the_plan_goes_when_told() -> None:
    left, right, above = panes(START, solve(START))
    assert 'data-pick="pick_left"' in left.svg
    assert 'data-pick="pick_right"' in right.svg
    assert "data-pick" not in above.svg
    hidden = START.changed({"show_top": False})
    assert len(panes(hidden, solve(hidden))) == 2


@pytest.mark.parametrize("name", ["defaults", "converging", "forward"])
def test_the_plan_shows_places_from_above(name: str) -> None:
    p = DRAWN[name]
    svg = panes(p, solve(p))[2].svg
    for handle in ("left", "right", "point"):
        (g,) = (g for g in shapes(svg, "g") if g.get("data-handle") == f"plan_{handle}")
        at = float(g["data-x"]), float(g["data-y"])
        x, y, z = getattr(p, handle)
        assert at == pytest.approx(plan.at(x, y))
        assert re.search(rf"X {x:.2f}, Y {y:.2f} metres".replace("-", "−"), g["aria-label"])
        held = p.changed(SIM.handles[f"plan_{handle}"](p, (at[0] + plan.SCALE, at[1] - plan.SCALE)))
        assert getattr(held, handle) == pytest.approx((x + 1, y + 1, z)), "X to the right, Y up, the same height"


# ---- links


def kinds_of(html: str, name: str) -> list[str]:
    """What is linked under a name, and its classes."""
    linked = [e for e in xml(html).iter() if e.get("data-link") == name]
    return sorted(f"{e.tag.split('}')[-1]} {e.get('class', '')}".strip() for e in linked)


def test_every_point_is_linked_across_pictures_plan_table_and_scene(rig: Rig) -> None:
    rig.show(START.changed({"points": 12, "show_all_lines": True}))
    pictures, table = rig.column.html("pane"), rig.column.html("read")
    for k in range(2, 13):
        assert kinds_of(pictures, f"{k}") == ["g s3-point"] * 3 + ["line"] * 2
        assert kinds_of(table, f"{k}") == ["tr"]
        assert rig.model.node(f"/points/{k}").clicks
    assert kinds_of(pictures, "1") == ["g"] * 3 + ["line"] * 2, "three handles and two lines"
    assert kinds_of(table, "1") == ["tr s3-selected"]
    assert rig.model.node("/point").clicks
    assert 'data-link="7"' not in panes(START, solve(START))[0].svg, "it isn't shown"


def test_what_is_pointed_at_lights_up_in_the_scene_and_nothing_else_changes(rig: Rig) -> None:
    p = START.changed({"point": (-0.5, 3.0, 1.5)})
    rig.show(p)
    before = rig.model.snapshot()
    for name, place in (("1", p.point), ("4", OTHERS[2])):
        rig.host.call(lambda name=name: rig.session.hover(name))  # type: ignore[misc]
        rig.settle()
        after = rig.model.snapshot()
        assert {key for key in after if key not in before} == {"scene /lit", "scene /lit/ball", "scene /lit/rays"}
        assert not differences(before, {key: after[key] for key in before})
        close(rig.model.world_pose("/lit/ball")[:3, 3], place, within=1e-9)
        close(rig.model.points("/lit/rays"), [(p.left, place), (p.right, place)], within=1e-6)
    rig.change(right=(0.8, 0.1, 1.0))
    rig.settle()
    close(rig.model.points("/lit/rays")[1], [(0.8, 0.1, 1.0), OTHERS[2]], within=1e-6)
    rig.show(p)
    for name in ("", "7", "13", "0", "nobody"):
        rig.host.call(lambda name=name: rig.session.hover(name))  # type: ignore[misc]
        rig.settle()
        assert not differences(before, rig.model.snapshot()), "points that aren't shown don't light up"


def test_a_point_that_is_selected_is_marked_everywhere(rig: Rig) -> None:
    rig.show(START)
    assert not rig.model.visible("/selected")
    rig.browser.click("/points/3")
    rig.settle()
    assert rig.session.params == START.changed({"selected": 3})
    pictures, table = rig.column.html("pane"), rig.column.html("read")
    assert kinds_of(pictures, "3") == ["g s3-point s3-selected"] * 3
    assert (pictures + table).count("s3-selected") == 4
    assert kinds_of(table, "3") == ["tr s3-selected"]
    close(rig.model.world_pose("/selected/ball")[:3, 3], OTHERS[1], within=1e-9)
    close(rig.model.points("/selected/rays"), [(START.left, OTHERS[1]), (START.right, OTHERS[1])], within=1e-6)
    assert rig.model.labels()["/selected/ball/label"] == "point 3"
    rig.change(points=2)
    rig.settle()
    assert not rig.model.visible("/selected"), "a point that isn't shown isn't marked"
    rig.browser.click("/point")
    rig.settle()
    assert rig.session.params == START.changed({"points": 2})


def test_the_table_holds_the_pixels_of_all_points() -> None:
    p = START.changed({"left_pan": 12, "right_pan": -12, "points": 12})
    s = solve(p)
    html = readout.render(SIM.readouts(p, s))
    rows = {str(e.get("data-link")): [str(td.text) for td in e.iter("td")] for e in xml(html).iter("tr")}
    for k, (left, right) in enumerate(zip(s.pixels_left, s.pixels_right, strict=True), start=1):
        expected = []
        for pixel in (left, right):
            cells = [figure(float(v), 1) for v in pixel]
            expected += cells if in_frame(pixel[None]) else [f"({cell})" for cell in cells]
        assert rows[f"{k}"] == expected
    behind = START.changed(SIM.states["behind both"])
    assert words(readout.render(SIM.readouts(behind, solve(behind)))).count("–") == 4


# ---- hands and buttons


@pytest.mark.parametrize(("node", "name"), [("/point", "point"), ("/left_center", "left"), ("/right_center", "right")])
def test_what_is_dragged_in_the_scene_follows(rig: Rig, node: str, name: str) -> None:
    rig.show(START)
    aim = (0.25, 0.5, 1.4)
    rig.browser.drag(node, (0.1, 0.2, 1.1), aim)
    rig.settle()
    assert getattr(rig.session.params, name) == pytest.approx(aim)
    close(rig.model.world_pose(node)[:3, 3], aim, within=1e-9)


def test_a_camera_dragged_onto_the_other_ends_epipolar_geometry_and_away_again_restores_it(rig: Rig) -> None:
    rig.show(START)
    rig.browser.drag("/left_center", START.right)
    rig.settle()
    assert rig.session.solution.F is None
    assert any("no baseline" in text for text in rig.model.labels().values())
    rig.browser.drag("/left_center", START.left)
    rig.settle()
    assert rig.session.params == START
    assert rig.session.solution.F is not None


@given(states, st.sampled_from(SIDES), st.floats(0, 639), st.floats(0, 479))
def test_holding_the_point_in_a_picture_puts_it_there_at_its_depth(
    p: EpipolarParams, side: str, u: float, v: float
) -> None:
    p = p.changed({"point": (0.3, 4.0, 1.2)})
    R, C = pose(p, side)
    depth = float((np.array(p.point) - C) @ R[:, 2])
    place = SIM.handles[f"{side}_pixel"](p, (u, v))["point"]
    close(pixels(p, side, [place]), [(u, v)], within=1e-6)
    if depth > 0.05:
        assert (np.array(place) - C) @ R[:, 2] == pytest.approx(depth)


@each_preset
def test_buttons_lead_to_presets_with_everything_in_sight(name: str) -> None:
    action: Any = next(action for action in SIM.actions if action.name == name)
    lost = START.changed({"point": (4, 9, 4), "focal": 1400, "left_pan": 50, "points": 9, "pick": "left:1,2"})
    state = lost
    for step in action.run(lost):
        assert 0.4 <= step.seconds <= 1.2
        state = state.changed(step.changes)
    assert state == START.changed({**PRESETS[name], "points": 9, "pick": "left:1,2"})
    assert in_frame(solve(state).pixels_left)
