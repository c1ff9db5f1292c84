"""triangulation: a stereo pair that isn't rectified, against the formulas written out and against OpenCV."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Mapping
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from sims.epipolar.calibration import EXAMPLE as ROBOT
from sims.kit import readout
from sims.kit.readout import figure
from sims.kit.sim import jsonable
from sims.triangulation import SIM, TriangulationParams, calibration, challenges, solve
from sims.triangulation.depth_plot import sight, sigmas
from sims.triangulation.rig import rig as rig_of
from tests.server import Rig
from tests.sims.markup import words, xml

Array = npt.NDArray[np.float64]
START = TriangulationParams()
LEVEL = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
SIZES = (1280, 720, 1920, 1080)


def pair(lenses: tuple[float, ...], turn: tuple[float, ...], shift: tuple[float, ...], **more: Any) -> Any:
    """A state with somebody's pair; `turn` is a rotation vector in degrees."""
    own = (*lenses, *turn, *shift)
    return START.changed({"own": own, "own_size": SIZES, "baseline": float(np.linalg.norm(shift)), **more})


def solved(p: TriangulationParams) -> Any:
    """A solution in which everything exists."""
    return solve(p)


lenses = st.tuples(
    st.floats(500, 2000), st.floats(500, 2000), st.floats(500, 780), st.floats(250, 470),
    st.floats(900, 3000), st.floats(900, 3000), st.floats(760, 1160), st.floats(430, 650),
)  # fmt: skip
turns = st.tuples(*[st.floats(-23, 23)] * 3)
shifts = st.tuples(st.floats(-1.2, -0.3), st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))
pairs = st.builds(pair, lenses, turns, shifts)
"""Cameras that are turned by up to 40° against each other."""
TOE_IN = START.changed(calibration.toe_in(START))


def matrices(p: TriangulationParams) -> tuple[Array, Array]:
    """P of both cameras as OpenCV has them: the world is the left camera."""
    assert p.own is not None
    own = p.own
    K = [np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1.0]]) for fx, fy, cx, cy in (own[:4], own[4:8])]
    R, t = cv2.Rodrigues(np.radians(own[8:11]))[0], np.array(own[11:])
    return K[0] @ np.eye(3, 4), K[1] @ np.column_stack([R, p.baseline * t / np.linalg.norm(t)])


def project(P: Array, X: Array) -> Array:
    u, v, w = P @ [*X, 1.0]
    assert w > 0.0
    return np.array([u / w, v / w])


def world_of_left(p: TriangulationParams) -> tuple[Array, Array]:
    """How the left camera's axes stand in the world by columns, and its centre: as is said in the sim's own words."""
    assert p.own is not None
    half = np.asarray(cv2.Rodrigues(np.radians(p.own[8:11]) / 2)[0], dtype=float)
    R = LEVEL @ half
    to_right = -(LEVEL @ half.T) @ np.array(p.own[11:])
    return R, np.array([0, 0, 1.0]) - 0.5 * p.baseline * to_right / np.linalg.norm(to_right)


def at(p: TriangulationParams, X: Array, off: tuple[float, float] = (0.0, 0.0)) -> TriangulationParams:
    """The state whose pixels are those of a place in the left camera's axes, the right one off by some."""
    left, right = (project(P, X) for P in matrices(p))
    sides = (("left_uv", left, SIZES[:2]), ("right_uv", right + off, SIZES[2:]))
    for _, (u, v), (width, height) in sides:
        assume(0.0 <= u <= width - 1 and 0.0 <= v <= height - 1)
    return p.changed({name: tuple(uv.tolist()) for name, uv, _ in sides})


places = st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(2.5, 9.0)).map(np.array)
offs = st.tuples(st.floats(-4, 4), st.floats(-4, 4))


# ---- numbers


@given(pairs, places)
def test_a_place_is_found_again_in_both_cameras_axes(p: TriangulationParams, X: Array) -> None:
    p = at(p, X)
    s = solved(p)
    R, center = world_of_left(p)
    for found in s.by_method.values():
        np.testing.assert_allclose(found.point, center + R @ X, rtol=0, atol=1e-6)
        assert found.reprojection_rms == pytest.approx(0.0, abs=1e-6)
    np.testing.assert_allclose(s.point_left, X, rtol=0, atol=1e-6)
    assert s.depth == pytest.approx(X[2], abs=1e-6)
    assert s.ray_gap == pytest.approx(0.0, abs=1e-6)
    assert (s.disparity, s.depth_from_disparity) == (None, None)
    assert (s.size_left, s.size_right) == (SIZES[:2], SIZES[2:])


@given(pairs, places, offs)
def test_rays_that_miss_are_as_opencv_has_them(p: TriangulationParams, X: Array, off: tuple[float, float]) -> None:
    p = at(p, X, off)
    s = solved(p)
    assume(s.point is not None and s.depth is not None and s.depth < 30.0)
    P1, P2 = matrices(p)
    left, right = np.array(p.left_uv), np.array(p.right_uv)
    R, center = world_of_left(p)

    # Lines, with F of OpenCV's own P.
    for which, uv, line in ((1, left, s.line_right), (2, right, s.line_left)):
        expected = cv2.computeCorrespondEpilines(uv.reshape(1, 1, 2), which, s.F)[0, 0]
        np.testing.assert_allclose(line, expected, rtol=1e-4, atol=2e-2)  # single precision
    np.testing.assert_allclose(s.K_left, P1[:, :3])
    np.testing.assert_allclose(s.K_right @ (P2[:, :3].T @ np.linalg.inv(s.K_right).T).T, P2[:, :3], atol=1e-6)

    # DLT in normalised coordinates and in the sim's world, where what it makes small is what it says.
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R.T, -R.T @ center
    M1, M2 = (np.linalg.inv(K) @ P @ T for K, P in ((s.K_left, P1), (s.K_right, P2)))
    normal = [(np.linalg.inv(K) @ [*uv, 1.0])[:2].reshape(2, 1) for K, uv in ((s.K_left, left), (s.K_right, right))]
    h = cv2.triangulatePoints(M1, M2, *normal)[:, 0]
    np.testing.assert_allclose(s.by_method["dlt"].point, h[:3] / h[3], rtol=1e-6, atol=1e-6)
    rows = [value[0] * M[2] - M[k] for M, uv in ((M1, normal[0]), (M2, normal[1])) for k, value in enumerate(uv)]
    np.testing.assert_allclose(s.equations, rows, rtol=0, atol=1e-9)
    assert np.linalg.norm(s.equations @ s.least_vector) == pytest.approx(s.singular_values[3], abs=1e-12)

    # The optimal pixels are OpenCV's, and no pair of others that meet is nearer.
    best = s.by_method["optimal"]
    if best.point is not None:
        corrected = cv2.correctMatches(s.F, left.reshape(1, 1, 2), right.reshape(1, 1, 2))
        np.testing.assert_allclose([best.pixel_left, best.pixel_right], np.ravel(corrected).reshape(2, 2), atol=1e-3)
        for other in s.by_method.values():
            assert other.point is None or (best.reprojection_rms or 0.0) <= (other.reprojection_rms or 0.0) + 1e-9

    # The mid-point is half-way along the common perpendicular.
    a, b = s.closest_points
    for P, uv in ((M1, normal[0]), (M2, normal[1])):
        assert abs((b - a) @ (P[:, :3].T @ [*uv[:, 0], 1.0])) < 1e-9
    assert np.linalg.norm(b - a) == pytest.approx(s.ray_gap, abs=1e-9)
    for found in s.by_method.values():
        if found.point is not None:
            seen_left, seen_right = (project(P @ T, found.point) for P in (P1, P2))
            assert found.reprojection_left == pytest.approx(math.dist(seen_left, left), abs=1e-6)
            assert found.reprojection_right == pytest.approx(math.dist(seen_right, right), abs=1e-6)


@given(pairs, places)
def test_how_sure_it_is_follows_from_differences_of_its_projections(p: TriangulationParams, X: Array) -> None:
    p = at(p, X).changed({"noise": 0.7, "seed": 0})
    s = solved(p)
    step, P = 1e-5, matrices(p)
    columns = [
        np.concatenate([project(each, s.point_left + d) - project(each, s.point_left - d) for each in P]) / (2 * step)
        for d in step * np.eye(3)
    ]
    C = 0.49 * np.linalg.inv(np.transpose(columns).T @ np.transpose(columns))
    R, _ = world_of_left(p)
    np.testing.assert_allclose(s.covariance, R @ C @ R.T, rtol=1e-4, atol=1e-5 * np.abs(C).max())
    assert s.depth_sigma == pytest.approx(math.sqrt(C[2, 2]), rel=1e-4)
    np.testing.assert_allclose(np.sort(s.ellipsoid_axes), np.sqrt(np.linalg.eigvalsh(s.covariance)), rtol=1e-6)
    np.testing.assert_allclose(s.true_point, world_of_left(p)[1] + R @ X, rtol=0, atol=1e-6)
    a, b = (c - s.point for c in (world_of_left(p)[1], 2 * np.array([0, 0, 1.0]) - world_of_left(p)[1]))
    angle = math.degrees(math.acos(a @ b / math.sqrt(a @ a * (b @ b))))
    assert s.point_angle == pytest.approx(angle, abs=1e-4)


def test_a_pair_that_is_not_turned_is_the_parallel_rig() -> None:
    """One mathematics: what own parameters say of a rectified pair is what the sim's say."""
    own = (600.0, 600.0, 320.0, 240.0, 600.0, 600.0, 320.0, 240.0, 0.0, 0.0, 0.0, -60.0, 0.0, 0.0)
    for more in (
        {},
        {"right_uv": (320.0, 222.0), "method": "optimal"},
        {"noise": 2.0, "seed": 5, "method": "midpoint"},
    ):
        p = START.changed(more)
        q = p.changed({"own": own, "own_size": (640, 480, 640, 480)})
        ours, theirs = jsonable(solved(q)), jsonable(solved(p))
        for name in ("point", "by_method", "covariance", "depth_sigma", "equations", "cloud", "line_left", "matched"):
            assert same(ours[name], theirs[name]), name
        for x in (1.5, 4.0, 9.0):
            one, other = (sigmas(np.array([x]), (0.6, 600.0, 1.0), sight(each, solved(each))) for each in (p, q))
            np.testing.assert_allclose(one, other, rtol=1e-9)


def panes_of(p: TriangulationParams) -> list[str]:
    assert SIM.panes is not None
    return [pane.svg for pane in SIM.panes(p, solved(p))]


def same(a: Any, b: Any) -> bool:
    if isinstance(a, Mapping):
        return all(same(a[name], b[name]) for name in b)
    if isinstance(a, str) or a is None or b is None:
        return bool(a == b)
    return bool(np.allclose(np.array(a, dtype=float), np.array(b, dtype=float), rtol=1e-6, atol=1e-9))


# ---- hands


@given(pairs, places, st.floats(0.1, 2.0), offs)
def test_the_baselines_slider_holds_the_point_and_the_miss_or_the_pixels(
    p: TriangulationParams, X: Array, baseline: float, off: tuple[float, float]
) -> None:
    p = at(p, X, off).changed({"method": "optimal"})
    was = solved(p)
    assume(was.point is not None)
    after = p.moved({"baseline": baseline})
    now = solved(after)
    inside = [
        0.01 < v < end - 1.01 for uv, size in zip((after.left_uv, after.right_uv), after.sizes, strict=True)
        for v, end in zip(uv, size, strict=True)
    ]  # fmt: skip
    if all(inside) and off == (0.0, 0.0):
        np.testing.assert_allclose(now.point, was.point, rtol=0, atol=1e-5)
    kept = p.changed({"hold": "pixels"}).moved({"baseline": baseline})
    assert (kept.left_uv, kept.right_uv) == (p.left_uv, p.right_uv)
    scaled = solved(kept).point
    middle = np.array([0, 0, 1.0])
    np.testing.assert_allclose((scaled - middle) * p.baseline / baseline, was.point - middle, rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize(
    "aim", [(0.0, 3.0, 1.0), (9.0, 4.0, 1.0), (-9.0, 4.0, 1.0), (0.0, 3.0, 9.0), (0.2, 30.0, -9.0)]
)
def test_a_point_is_dragged_and_stays_where_both_pictures_show_it(aim: tuple[float, float, float]) -> None:
    p = TOE_IN.moved(SIM.handles["/point"](TOE_IN, aim))
    s = solved(p)
    assert s.depth == pytest.approx(rig_of(p).left.to_camera(aim).item(2), rel=1e-6), "at its depth"
    pixels = [project(P, s.point_left) for P in matrices(p)]
    for (u, v), (width, height), held in zip(pixels, p.sizes, (p.left_uv, p.right_uv), strict=True):
        assert -1e-6 <= u <= width - 1 + 1e-6
        assert -1e-6 <= v <= height - 1 + 1e-6
        assert held == pytest.approx((u, v), abs=1e-6)
    if aim == (0.0, 3.0, 1.0):
        np.testing.assert_allclose(s.point, aim, rtol=0, atol=1e-9)
    assert SIM.handles["/point"](TOE_IN, (0.0, -5.0, 1.0)) == {}, "behind both cameras there is nothing to be held"


def test_the_point_is_dragged_along_the_left_ray_in_the_plot() -> None:
    s = solved(TOE_IN)
    for depth in (2.0, 6.5, 9.0):
        moved = TOE_IN.moved(SIM.handles["depth"](TOE_IN, (depth, 0.3)))
        assert solved(moved).depth == pytest.approx(depth, rel=1e-9)
        assert moved.left_uv == pytest.approx(TOE_IN.left_uv)
        found = sigmas(np.array([depth]), (0.8, 600.0, 1.0), sight(moved, solved(moved)))
        assert solved(moved).depth_sigma == pytest.approx(found.item(), rel=1e-9), "the dot is on the curve"
    mark = re.search(r'data-handle="depth"[^>]* data-x="([\d.]+)" data-y="([\d.]+)"', panes_of(TOE_IN)[2])
    assert mark is not None
    assert float(mark[1]) == pytest.approx(44 + 262 * s.depth / 10, abs=0.1)


def test_a_longer_baseline_makes_the_same_point_surer_and_it_is_said() -> None:
    p = TOE_IN.moved({"baseline": 1.6})
    was, now = solved(TOE_IN), solved(p)
    np.testing.assert_allclose(now.point, was.point, rtol=0, atol=1e-9)
    assert now.depth_sigma < 0.6 * was.depth_sigma
    said = [f"±\u00a0{figure(each.depth_sigma)}" for each in (was, now)]
    assert (
        SIM.caption(p, now)
        == f"A longer baseline, a surer depth: from {said[0]} to {said[1]}\u2009m at the same point."
    )
    assert "before" in words(panes_of(p)[2])
    other = TOE_IN.moved({"focal": 900.0})
    assert (other.before, solved(other).depth_sigma) == (None, pytest.approx(was.depth_sigma)), "it has its own"


# ---- texts


def text(p: TriangulationParams, **more: str) -> str:
    """A calibration as OpenCV writes it."""
    own = p.own
    assert own is not None
    K = [[fx, 0, cx, 0, fy, cy, 0, 0, 1] for fx, fy, cx, cy in (own[:4], own[4:8])]
    said: dict[str, Any] = {
        "K1": K[0], "K2": K[1], "R": np.ravel(cv2.Rodrigues(np.radians(own[8:11]))[0]).tolist(), "T": [*own[11:]],
        "imageSize1": [*SIZES[:2]], "imageSize2": [*SIZES[2:]],
    }  # fmt: skip
    return "\n".join(f"{name}: {more.get(name) or numbers}" for name, numbers in said.items())


def taken(said: str, p: TriangulationParams = START) -> TriangulationParams:
    assert SIM.paste is not None
    return p.changed(SIM.paste.changes(p, calibration.read(said)))


LENSES = (900.0, 905.0, 640.0, 360.0, 1400.0, 1390.0, 950.0, 530.0)
WANTED = pair(LENSES, (2.0, 30.0, -1.0), (-0.77, 0.02, 0.2))


def test_a_pasted_pair_is_taken_as_it_stands_and_its_link_brings_it_back() -> None:
    p = taken(text(WANTED))
    assert p.own == pytest.approx(WANTED.own, rel=1e-9, abs=1e-9)
    assert (p.own_size, p.sizes) == (SIZES, (SIZES[:2], SIZES[2:]))
    assert p.baseline == pytest.approx(math.dist((0, 0, 0), (-0.77, 0.02, 0.2)))
    np.testing.assert_allclose(solved(p).point, (0.3, 4.0, 1.2), rtol=0, atol=1e-9)
    assert TriangulationParams.from_query(p.query_items().items()) == p
    assert set(SIM.offers(p).idle()) == {"focal", "cx", "cy", "doffs", "width", "height"}
    assert not SIM.offers(START).idle()
    assert (p.label("hold"), START.label("hold")) == ("Moving b keeps", "Moving b or f keeps")
    assert p.about("focal").startswith("This says nothing of a stereo pair of your own")


@pytest.mark.parametrize(
    ("shift", "baseline", "said"),
    [
        ((-0.77, 0.02, 0.2), 0.795802, "is taken to be in metres"),
        ((-310.0, 2.0, 4.0), 0.310032, "is taken to be in millimetres"),
        ((-31.0, 0.0, 9.0), 0.6, "here the cameras are 0.60\u2009m apart"),
    ],
)
def test_the_length_of_T_is_metres_or_millimetres_or_said_to_be_neither(
    shift: tuple[float, float, float], baseline: float, said: str
) -> None:
    wanted = WANTED.changed({"own": (*LENSES, 2.0, 30.0, -1.0, *shift)})
    p = taken(text(wanted))
    assert p.baseline == pytest.approx(baseline, abs=1e-6)
    assert SIM.paste is not None
    assert said in SIM.paste.says(p, calibration.read(text(wanted)))
    notes = [each.text for each in SIM.readouts(p, solved(p)) if isinstance(each, readout.Note)]
    assert any(said in each for each in notes)


def test_a_rectified_pair_of_any_format_is_a_rectified_rig() -> None:
    parallel = pair((700.0, 700.0, 640.0, 360.0) * 2, (0.0, 0.0, 0.0), (-0.2, 0.0, 0.0))
    one_size = {"imageSize2": "1280, 720"}
    p = taken(text(parallel, **one_size), taken(text(WANTED)))
    assert (p.own, p.own_size, p.focal, p.baseline, p.cx, p.doffs) == (None, None, 700.0, 0.2, 640.0, 0.0)
    assert (p.width, p.height) == SIZES[:2]
    assert solved(p).depth_from_disparity == pytest.approx(solved(p).depth)
    assert SIM.paste is not None
    assert "rectified rig: b is 0.200" in SIM.paste.says(p, calibration.read(text(parallel, **one_size)))
    for run in (calibration.middlebury, calibration.kitti, calibration.parallel):
        assert WANTED.changed(run(WANTED)).pair is None
    for other in (
        {"T": "-0.2, 0.05, 0"}, {"T": "0.2, 0, 0"}, {"K2": "700, 0, 640, 0, 700, 350, 0, 0, 1"},
        {"K2": "710, 0, 640, 0, 700, 360, 0, 0, 1"}, {"imageSize2": "1920, 1080"},
    ):  # fmt: skip
        assert taken(text(parallel, **one_size | other)).pair is not None, f"{other} isn't rectified"


def test_of_more_cameras_the_pair_is_chosen_and_it_is_said() -> None:
    found = [*calibration.read(text(WANTED)), calibration.read(text(WANTED))[0]]
    p = START.changed({"left_of_text": 3, "right_of_text": 2})
    p = p.changed(calibration.changes(p, found))
    assert p.own == pytest.approx(WANTED.own, rel=1e-9, abs=1e-9)
    assert "for others of its 3, choose them" in calibration.says(p, found)
    with pytest.raises(ValueError, match="1 is K1, 2 is K2"):
        calibration.changes(START.changed({"left_of_text": 4}), found)


def test_a_pair_that_cant_be_used_is_refused_in_words() -> None:
    for what, instead, said in (
        ("T: .*", "T: [-1e-10, 0, 0]", "T is 1e-10 long"), ("900", "0.9", "focal length is 0.9"),
        ("1280, 720", "1280, 12", "1280 × 12 and 1920 × 1080 pixels: this sim takes 16 to 8192"),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=said):
            calibration.changes(START, calibration.read(re.sub(what, instead, calibration.TOE_IN)))


def test_the_robots_cameras_of_epipolar_are_taken_and_distortion_is_spoken_of() -> None:
    p = taken(ROBOT)
    assert p.sizes == ((752, 480), (752, 480))
    assert p.baseline == pytest.approx(0.110078, abs=1e-6)
    found = calibration.read(ROBOT + "\nD1: [-0.28, 0.07, 0, 0, 0]")
    assert "after distortion was taken out" in calibration.says(p, found)
    assert "distortion" not in calibration.says(p, calibration.read(ROBOT))


def test_a_pair_that_sees_nothing_of_the_point_looks_at_where_its_middles_meet() -> None:
    wanted = pair(LENSES, (0.0, 100.0, 0.0), (-0.3, 0.0, 0.25))
    p = taken(text(wanted))
    s = solved(p)
    assert s.status == "found"
    assert s.ray_gap == pytest.approx(0.0, abs=1e-9)
    for uv, size in zip((p.left_uv, p.right_uv), p.sizes, strict=True):
        np.testing.assert_allclose(uv, np.array(size) / 2, atol=60)


@pytest.mark.parametrize("uv", [{"left_uv": (1280.0, 9.0)}, {"right_uv": (9.0, 1080.0)}])
def test_a_pixel_outside_its_own_picture_is_refused(uv: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=f"{next(iter(uv))} must be"):
        TOE_IN.changed(uv)


# ---- what is said and drawn


def test_what_needs_a_rectified_pair_says_that_it_does_not_hold() -> None:
    s = solved(TOE_IN)
    read = readout.folded(SIM.readouts(TOE_IN, s))
    key = words(readout.render(read[""]))
    assert "Not rectified: Z = f b / d doesn’t hold here" in key
    everything = words(readout.render(itertools.chain.from_iterable(read.values())))
    assert "Disparity: left u" not in everything
    assert "Depth from a disparity" not in everything
    assert figure(s.depth) in key
    assert "Not rectified" not in words(readout.render(SIM.readouts(START, solved(START))))
    for name in ("toe-in pair, behind", "toe-in pair", "toe-in pair, noise"):
        p = START.changed(SIM.states[name])
        assert "None" not in words(readout.render(SIM.readouts(p, solved(p)))) + SIM.describe(p, solved(p))
        assert "disparity of" not in SIM.describe(p, solved(p))


def test_challenges_of_the_sims_cameras_are_not_met_with_others() -> None:
    ten = next(each for each in challenges.CHALLENGES if each.id == "ten-centimetres")
    q = START.changed({**ten.solves, "own": (*(600.0, 600.0, 320.0, 240.0) * 2, 0, 0, 0, -0.6, 0, 0)})
    assert not ten.near(q.changed({"own_size": (640, 480, 640, 480)}), solved(q)).solved


@pytest.fixture(scope="module")
def stage() -> Any:
    with Rig(SIM) as rig:
        yield rig


STATES = [name for name in SIM.states if name.startswith("toe-in")]


@pytest.mark.parametrize("p", [*(START.changed(SIM.states[name]) for name in STATES), WANTED.changed({"noise": 1.0})])
def test_cameras_rays_and_pictures_are_drawn_where_they_stand(stage: Rig, p: TriangulationParams) -> None:
    stage.show(p)
    s, model = solved(p), stage.model
    R, center = world_of_left(p)
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R.T, -R.T @ center
    centers = center, 2 * np.array([0, 0, 1.0]) - center
    for k, (side, P) in enumerate(zip(("left", "right"), matrices(p), strict=True)):
        pose = model.world_pose(f"/{side}")
        np.testing.assert_allclose(pose[:3, 3], centers[k], rtol=0, atol=1e-9)
        pixel = (s.measured_left, s.measured_right)[k]
        ray = model.points(f"/{side}/ray")[0]
        np.testing.assert_allclose(ray[0], centers[k], rtol=0, atol=1e-6)
        np.testing.assert_allclose(project(P @ T, ray[1]), pixel, rtol=0, atol=2e-3)
        ball = model.world_pose(f"/{side}/pixel")[:3, 3]
        np.testing.assert_allclose(project(P @ T, ball), pixel, rtol=0, atol=1e-6)
        width, height = p.sizes[k]
        corners = [project(P @ T, each) for each in model.points(f"/{side}/picture")]
        frame = [(-0.5, -0.5), (width - 0.5, -0.5), (width - 0.5, height - 0.5), (-0.5, height - 0.5)]
        np.testing.assert_allclose(corners, frame, rtol=0, atol=2e-2)
        assert model.points(f"/{side}/post")[0, 1, 2] == pytest.approx(0.0, abs=1e-6), "it stands on the ground"
    np.testing.assert_allclose(model.points("/baseline").reshape(-1, 3), centers, rtol=0, atol=1e-6)
    if s.point is not None:
        np.testing.assert_array_equal(model.world_pose(f"/{p.method}")[:3, 3], s.point)
        assert f"depth {figure(s.depth, 2 if s.depth_sigma >= 0.005 else 4)}" in model.labels()["/result/label"]
    if model.visible("/gap"):
        np.testing.assert_allclose(model.points("/gap")[0], s.closest_points, rtol=1e-6, atol=1e-6)
    if model.visible("/closeup"):
        for side, (start, end) in zip(("left", "right"), model.points("/closeup/rays"), strict=False):
            along = np.diff(model.points(f"/{side}/ray")[0], axis=0)[0]
            crossed = np.cross((end - start) / np.linalg.norm(end - start), along / np.linalg.norm(along))
            np.testing.assert_allclose(crossed, 0.0, atol=1e-4)
    if s.covariance is not None and model.visible("/uncertainty"):
        pose = model.world_pose("/uncertainty/ellipsoid")
        scaled = pose[:3, :3] @ np.diag(model.node("/uncertainty/ellipsoid").props["scale"]) / 3.0
        np.testing.assert_allclose(scaled @ scaled.T, s.covariance, rtol=0, atol=1e-9 * np.abs(s.covariance).max())


def test_pictures_have_their_own_sizes_and_lines_that_are_not_level() -> None:
    p = TOE_IN.changed({"right_uv": (560.0, 470.0)})
    s = solved(p)
    for k, (svg, (width, height), line) in enumerate(
        zip(panes_of(p), p.sizes, (s.line_left, s.line_right), strict=False)
    ):
        (root,) = xml(svg)
        assert root.get("viewBox") == f"-0.5 -0.5 640 {math.ceil(640 * height / width)}"
        drawn = next(e for e in root.iter() if e.get("data-link") == ("right", "left")[k] and e.get("x1"))
        scale = width / 640
        ends = [[float(drawn.get(f"{c}{n}", "")) for c in "xy"] for n in (1, 2)]
        assert ends[0][1] != ends[1][1]
        for x, y in ends:
            assert abs(line @ [scale * (x + 0.5) - 0.5, scale * (y + 0.5) - 0.5, 1.0]) < 0.05
