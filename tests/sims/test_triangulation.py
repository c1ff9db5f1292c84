"""triangulation: its numbers against OpenCV and closed forms, its noise, its states without a point, its hands."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Iterator
from typing import Any
from urllib.parse import parse_qsl

import cv2
import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from geometry.camera import parallel_rig
from geometry.triangulation import covariance, monte_carlo
from sims.kit import readout
from sims.kit.frame import inside
from sims.kit.readout import figure
from sims.kit.sim import jsonable
from sims.kit.stereo_text import Found
from sims.triangulation import SIM, TriangulationParams, TriangulationSolution, actions, calibration, corners, solve
from sims.triangulation import solution as mathematics
from sims.triangulation.panes import magnification, panes
from sims.triangulation.rig import rig as rig_of
from sims.triangulation.scene_closeup import chord
from tests.frames import differences
from tests.server import Rig
from tests.sims.markup import words, xml

Array = npt.NDArray[np.float64]
START = TriangulationParams()
pixels = st.tuples(st.floats(0, 639), st.floats(0, 479))
states = st.builds(
    TriangulationParams,
    baseline=st.floats(0.05, 2),
    focal=st.floats(200, 1500),
    left_uv=pixels,
    right_uv=pixels,
    noise=st.sampled_from([0.0, 0.5, 5.0]),
    seed=st.integers(0, 9999),
    method=st.sampled_from(["dlt", "midpoint", "optimal"]),
)


def projections(p: TriangulationParams, point: npt.ArrayLike) -> tuple[Array, Array]:
    """Pixels of a world point by the definition of the rig: centres (∓b/2, 0, 1), looking along Y."""
    x, y, z = np.asarray(point, dtype=float)
    both = [
        np.array([320 + p.focal * (x - c) / y, 240 - p.focal * (z - 1) / y]) for c in (-p.baseline / 2, p.baseline / 2)
    ]
    return both[0], both[1]


def matrices(p: TriangulationParams) -> tuple[Array, Array]:
    """K [R | t] of both cameras, written out."""
    K = np.array([[p.focal, 0, 320], [0, p.focal, 240], [0, 0, 1]])
    R = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    centres = [np.array([x, 0, 1.0]) for x in (-p.baseline / 2, p.baseline / 2)]
    left, right = (K @ np.column_stack([R, -R @ c]) for c in centres)
    return left, right


def found(p: TriangulationParams, method: str) -> Array:
    point = solve(p).by_method[method].point  # type: ignore[index]
    assert point is not None
    return point


PAIRS = [
    {},
    {"right_uv": (320, 222)},
    {"baseline": 1.7, "focal": 350, "left_uv": (500, 100), "right_uv": (130, 90)},
    {"baseline": 0.1, "left_uv": (330, 240), "right_uv": (310, 241)},
    {"noise": 2.0, "seed": 11},
]
each_pair = pytest.mark.parametrize("changes", PAIRS)


# ---- numbers


def test_defaults_are_the_projections_of_the_point_that_the_contract_names() -> None:
    left, right = projections(START, (0.3, 4.0, 1.2))
    assert START.left_uv == tuple(left)
    assert START.right_uv == tuple(right)
    solution = solve(START)
    assert solution.point is not None
    np.testing.assert_allclose(solution.point, (0.3, 4.0, 1.2), rtol=0, atol=1e-12)
    assert solution.ray_gap == 0.0
    assert solution.disparity == 90.0
    assert solution.depth_from_disparity == 4.0
    assert solution.in_front
    a, b = np.array([0.6, 4, 0.2]), np.array([0.0, 4, 0.2])
    assert solution.parallax_angle == pytest.approx(math.degrees(math.acos(a @ b / math.sqrt(a @ a * (b @ b)))))


@each_pair
def test_linear_point_is_that_of_opencv(changes: dict[str, Any]) -> None:
    p = START.changed(changes)
    left, right = (np.array(pixel).reshape(2, 1) for pixel in mathematics.measured(p))
    # In normalised coordinates, where its equations are well scaled.
    K_inverse = np.linalg.inv(np.array([[p.focal, 0, 320], [0, p.focal, 240], [0, 0, 1]]))
    normal = [K_inverse[:2, :2] @ pixel + K_inverse[:2, 2:] for pixel in (left, right)]
    X = cv2.triangulatePoints(*(K_inverse @ P for P in matrices(p)), *normal)
    np.testing.assert_allclose(found(p, "dlt"), (X[:3] / X[3]).ravel(), rtol=1e-9, atol=1e-9)


@each_pair
def test_optimal_point_projects_to_opencvs_corrected_pixels(changes: dict[str, Any]) -> None:
    p = START.changed(changes)
    left, right = mathematics.measured(p)
    F = rig_of(p).F
    corrected = cv2.correctMatches(F, np.array([[left]]), np.array([[right]]))
    for ours, theirs in zip(projections(p, found(p, "optimal")), corrected, strict=True):
        np.testing.assert_allclose(ours, np.ravel(theirs), rtol=0, atol=1e-6)


@each_pair
def test_mid_point_is_half_way_along_the_common_perpendicular(changes: dict[str, Any]) -> None:
    p = START.changed(changes)
    solution = solve(p)
    assert solution.closest_points is not None
    left, right = solution.closest_points
    rays = [np.array([(u - 320) / p.focal, 1.0, -(v - 240) / p.focal]) for u, v in mathematics.measured(p)]
    for ray in rays:
        assert abs((right - left) @ ray) < 1e-9
    assert np.linalg.norm(right - left) == pytest.approx(solution.ray_gap, abs=1e-12)
    np.testing.assert_allclose(found(p, "midpoint"), (left + right) / 2, rtol=0, atol=1e-12)


@given(states)
def test_errors_are_distances_to_the_projections_and_the_optimal_ones_are_least(p: TriangulationParams) -> None:
    solution = solve(p)
    squares = {}
    for method, result in solution.by_method.items():
        if result.point is None or result.point[1] < 0.01:
            continue
        left, right = projections(p, result.point)
        errors = math.dist(left, solution.measured_left), math.dist(right, solution.measured_right)
        assert (result.reprojection_left, result.reprojection_right) == pytest.approx(errors, abs=1e-6)
        squares[method] = 2.0 * (result.reprojection_rms or 0.0) ** 2
        assert squares[method] == pytest.approx(errors[0] ** 2 + errors[1] ** 2, abs=1e-6)
    for other in ("dlt", "midpoint"):
        if other in squares and "optimal" in squares:
            assert squares["optimal"] <= squares[other] + 1e-7


@given(states)
def test_every_state_has_an_answer_without_nan(p: TriangulationParams) -> None:
    solution = solve(p)
    assert (solution.point is None) == (solution.status != "found")
    assert solution.point is None or solution.in_front
    values = jsonable(solution)
    assert values["point"] is None or all(v is not None for v in values["point"])
    for line, pixel in ((solution.line_left, solution.measured_left), (solution.line_right, solution.measured_right)):
        assert line is not None
        assert np.linalg.norm(line[:2]) == pytest.approx(1.0)
        assert abs(line[0]) < 1e-9, "a parallel rig has horizontal epipolar lines"
        assert pixel is not None


def test_epipolar_line_goes_through_the_row_of_the_other_point() -> None:
    solution = solve(START.changed({"left_uv": (400, 100), "right_uv": (300, 180)}))
    assert solution.line_left is not None
    assert solution.line_right is not None
    assert abs(solution.line_left @ (17.0, 180.0, 1.0)) < 1e-9
    assert abs(solution.line_right @ (17.0, 100.0, 1.0)) < 1e-9


# ---- uncertainty


def test_covariance_is_the_propagated_one_for_one_pixel_or_the_noise() -> None:
    for noise, sigma in ((0.0, 1.0), (0.5, 0.5), (3.0, 3.0)):
        p = START.changed({"noise": noise})
        solution = solve(p)
        assert solution.point is not None
        assert solution.covariance is not None
        assert solution.ellipsoid_axes is not None
        assert solution.sigma_px == sigma
        np.testing.assert_allclose(
            solution.covariance, covariance(parallel_rig(p.baseline, p.focal), solution.point, sigma), rtol=1e-12
        )
        np.testing.assert_allclose(
            np.sort(solution.ellipsoid_axes**2), np.linalg.eigvalsh(solution.covariance), rtol=1e-9
        )
        expected = math.sqrt(2.0) * sigma * solution.point[1] ** 2 / (p.focal * p.baseline)
        assert solution.depth_sigma == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("depth", [1.5, 4.0, 12.0])
def test_half_the_baseline_doubles_the_depth_sigma(depth: float) -> None:
    wide, narrow = (at_depth(START.changed({"baseline": b}), depth) for b in (0.6, 0.3))
    assert narrow.depth_sigma is not None
    assert wide.depth_sigma is not None
    assert narrow.depth_sigma / wide.depth_sigma == pytest.approx(2.0, rel=0.02)
    assert narrow.ellipsoid_axes is not None
    assert wide.ellipsoid_axes is not None
    assert narrow.ellipsoid_axes[0] / wide.ellipsoid_axes[0] == pytest.approx(2.0, rel=0.02)


def at_depth(p: TriangulationParams, depth: float) -> TriangulationSolution:
    return solve(p.changed(actions.hold_point(p, (0.05, depth, 1.1))))


def dot_of(svg: str) -> tuple[float, float]:
    """Where the plot's point is in its picture."""
    mark = re.search(r'data-handle="depth"[^>]* data-x="([\d.]+)" data-y="([\d.]+)"', svg)
    assert mark is not None
    return float(mark[1]), float(mark[2])


@pytest.mark.parametrize("changes", [{}, {"baseline": 0.3}, {"noise": 2.0}, {"left_uv": (360, 240)}])
def test_plot_marks_the_point_on_its_curve_and_its_ghosts_are_half_and_twice_the_baseline(
    changes: dict[str, Any],
) -> None:
    p = START.changed(changes)
    svg = panes(p, solve(p))[2].svg
    u, v = dot_of(svg)
    above: dict[str, list[float]] = {"curve": [], "ghost": []}
    for path, kind in re.findall(r'<path d="M([\d. L]+)" class="s3-(curve|ghost)"/>', svg):
        points = np.array([[float(n) for n in pair.split()] for pair in path.split("L")])
        above[kind].append(float(126.0 - np.interp(u, points[:, 0], points[:, 1])))
    height = 126.0 - v
    assert above["curve"][0] == pytest.approx(height, abs=1.0)
    half, twice = sorted(above["ghost"], reverse=True)
    assert twice == pytest.approx(height / 2.0, abs=1.0)
    assert half == pytest.approx(2.0 * height, abs=1.5) or half > 95.0


def test_drawn_samples_agree_with_the_propagated_covariance() -> None:
    p = START.changed({"noise": 0.5})
    solution = solve(p)
    assert solution.covariance is not None
    cameras = parallel_rig(p.baseline, p.focal)
    many = monte_carlo(*cameras, *mathematics.measured(p), p.noise, 20_000, seed=5)
    sampled = np.cov(many.T)
    scale = np.sqrt(np.outer(np.diag(solution.covariance), np.diag(solution.covariance)))
    assert np.abs((sampled - solution.covariance) / scale).max() < 0.1
    assert len(solution.cloud) == 300
    ratio = np.std(solution.cloud, axis=0, ddof=1) / np.sqrt(np.diag(solution.covariance))
    np.testing.assert_allclose(ratio, 1.0, atol=0.15)
    middle = np.abs(solution.cloud.mean(axis=0) - solution.point) / np.sqrt(np.diag(solution.covariance) / 300)
    assert (middle < 4.0).all()


# ---- noise


def test_noise_is_on_both_points_and_the_same_for_the_same_seed() -> None:
    p = START.changed({"noise": 1.5, "seed": 42})
    again = TriangulationParams.from_query(parse_qsl(p.query()))
    assert jsonable(solve(p)) == jsonable(solve(again))
    shifts = np.subtract([solve(p).measured_left, solve(p).measured_right], [p.left_uv, p.right_uv])
    assert (np.abs(shifts) > 1e-6).all()
    other = solve(p.changed({"seed": 43}))
    assert not np.allclose(other.measured_left, solve(p).measured_left)


def test_noise_grows_with_its_deviation_and_zero_is_off() -> None:
    assert mathematics.measured(START) == (START.left_uv, START.right_uv)
    one, two = (
        np.subtract(mathematics.measured(START.changed({"noise": s})), [START.left_uv, START.right_uv]) for s in (1, 2)
    )
    np.testing.assert_allclose(two, 2.0 * one, rtol=1e-9)
    assert len(solve(START).cloud) == 0
    assert solve(START).true_point is None


def test_noise_of_many_seeds_is_gaussian_with_the_deviation_named() -> None:
    shifts = np.array(
        [
            np.subtract(mathematics.measured(START.changed({"noise": 2.0, "seed": k})), [START.left_uv, START.right_uv])
            for k in range(500)
        ]
    )
    assert shifts.std() == pytest.approx(2.0, rel=0.05)
    assert abs(shifts.mean()) < 0.2
    left_u, left_v, right_u, right_v = shifts.reshape(500, 4).T
    for a, b in itertools.combinations((left_u, left_v, right_u, right_v), 2):
        assert abs(np.corrcoef(a, b)[0, 1]) < 0.2


def test_true_point_is_where_the_pixels_came_from() -> None:
    solution = solve(START.changed({"noise": 1.0}))
    assert solution.true_point is not None
    np.testing.assert_allclose(solution.true_point, (0.3, 4.0, 1.2), atol=1e-9)
    missing = solve(START.changed({"noise": 1.0, "right_uv": (320, 230)}))
    assert missing.true_point is None, "rays that miss came from no point"
    assert missing.target is not None


# ---- states without a point

NOWHERE = {
    "parallel rays": "parallel",
    "diverging rays": "behind",
    "behind, rays miss": "behind",
    "no disparity, rays miss, mid-point": "behind",
}


@pytest.mark.parametrize(("name", "status"), NOWHERE.items())
def test_where_there_is_no_point_that_is_said_and_nothing_is_made_up(name: str, status: str) -> None:
    p = START.changed(SIM.states[name])
    solution = solve(p)
    assert solution.status == status
    for nothing in ("point", "covariance", "ellipsoid_axes", "depth_sigma", "target", "depth_from_disparity"):
        assert getattr(solution, nothing) is None
    result = solution.by_method[p.method]
    assert result.reprojection_left is result.reprojection_right is result.reprojection_rms is None
    html = readout.render(SIM.readouts(p, solution))
    assert "s3-warn" in html
    assert "⚠" in words(html)
    assert actions.held_point(p, solution) is None


def test_parallel_rays_have_no_disparity_and_no_parallax_but_a_distance() -> None:
    solution = solve(START.changed(SIM.states["parallel rays"]))
    assert solution.disparity == 0.0
    assert solution.parallax_angle == 0.0
    assert solution.closest_points is None
    along = np.array([0.15, 1.0, 0.05])
    assert solution.ray_gap == pytest.approx(
        float(np.linalg.norm(np.cross([0.6, 0, 0], along)) / np.linalg.norm(along))
    )


def test_diverging_rays_name_where_their_lines_meet() -> None:
    p = START.changed(SIM.states["diverging rays"])
    solution = solve(p)
    assert not solution.in_front
    assert solution.closest_points is not None
    np.testing.assert_allclose(solution.closest_points[:, 1], -9.0)
    assert "9.00" in words(readout.render(SIM.readouts(p, solution)))


def test_an_almost_parallel_pair_is_called_so() -> None:
    for name in ("parallel to rounding", "no disparity, rays miss"):
        solution = solve(START.changed(SIM.states[name]))
        assert solution.status == "found"
        assert solution.vague
    assert solve(START.changed({"right_uv": (408.7, 210)})).vague, "σ_Z / Z = √2 σ / d"
    assert not solve(START.changed({"right_uv": (408.5, 210)})).vague


# ---- hands and buttons


@given(st.floats(0.05, 2), st.floats(200, 1500), st.floats(-60, 60), st.floats(-5, 100), st.floats(-50, 50))
def test_holding_a_point_sets_both_pixels_to_its_projections_or_the_nearest_seen(
    baseline: float, focal: float, x: float, y: float, z: float
) -> None:
    p = START.changed({"baseline": baseline, "focal": focal})
    held = p.changed(actions.hold_point(p, (x, y, z)))
    assert held.left_uv[1] == held.right_uv[1], "both pixels come from one point"
    assert held.left_uv[0] > held.right_uv[0], "which is in front of the cameras"
    if y <= 0.01:
        return
    exact = projections(p, (x, y, z))
    if all(0 <= u <= 639 and 0 <= v <= 479 for u, v in exact):
        np.testing.assert_allclose([held.left_uv, held.right_uv], exact, rtol=0, atol=1e-6)
        target = solve(held).target
        assert target is not None
        np.testing.assert_allclose(target, (x, y, z), rtol=1e-6, atol=1e-6)
    elif exact[0][0] - exact[1][0] <= 639:
        np.testing.assert_allclose(held.left_uv[0] - held.right_uv[0], exact[0][0] - exact[1][0], rtol=0, atol=1e-6)


def test_handles_of_the_pictures_set_their_pixel() -> None:
    assert SIM.handles["left_uv"](START, (12.5, 30.25)) == {"left_uv": (12.5, 30.25)}
    assert SIM.handles["right_uv"](START, (12.5, 30.25)) == {"right_uv": (12.5, 30.25)}
    moved = START.moved(SIM.handles["right_uv"](START, (-4.0, 600.0)))
    assert moved.right_uv == (0.0, 479.0)


def test_buttons_lead_to_the_next_sample_and_switch_noise() -> None:
    assert START.changed(actions.new_sample(START)) == START.changed({"seed": 1, "noise": 1.0})
    noisy = START.changed({"noise": 0.3, "seed": 9999})
    assert noisy.changed(actions.new_sample(noisy)) == noisy.changed({"seed": 0})
    assert noisy.changed(actions.switch_noise(noisy)).noise == 0.0
    assert START.changed(actions.switch_noise(START)).noise == 1.0


def test_the_point_can_be_typed_and_hides_where_there_is_none() -> None:
    with Rig(SIM) as rig:
        assert rig.column.vector("/point") == pytest.approx([0.3, 4.0, 1.2])
        rig.browser.move("/point", [0.1, 3.0, 1.3])
        rig.settle()
        left, right = projections(START, (0.1, 3.0, 1.3))
        state = rig.session.params
        assert isinstance(state, TriangulationParams)
        assert state.left_uv == pytest.approx(tuple(left))
        assert state.right_uv == pytest.approx(tuple(right))
        rig.show(START.changed(SIM.states["parallel rays"]))
        assert not rig.column.parts["control:/point"]
        rig.show(START)
        assert rig.column.parts["control:/point"]


# ---- pictures and close-up


def test_pictures_hold_the_handles_the_reprojection_and_the_other_points_line() -> None:
    p = START.changed({"right_uv": (320, 222), "method": "optimal"})
    solution = solve(p)
    left, right, _ = panes(p, solution)
    for pane, own, other, pixel in ((left, "left", "right", (410.0, 210.0)), (right, "right", "left", (320.0, 222.0))):
        root = xml(pane.svg)
        handle = next(e for e in root.iter() if e.get("data-handle"))
        assert handle.get("data-handle") == f"{own}_uv"
        assert (float(handle.get("data-x") or 0), float(handle.get("data-y") or 0)) == pixel
        line, arrow = (e for e in root.iter() if e.tag.endswith("line"))
        assert (handle.get("data-link"), line.get("data-link"), arrow.get("data-link")) == (own, other, None)
        assert line.get("stroke") == f"var(--{other})"
        row = 222.0 if own == "left" else 210.0
        assert float(line.get("y1") or 0) == float(line.get("y2") or 0) == pytest.approx(row)
        times = magnification(6.0, 6.0)
        length = float(arrow.get("y2") or 0) - float(arrow.get("y1") or 0)
        assert abs(length) == pytest.approx(6.0 * times, abs=0.02)
        assert pane.note == f"error 6.00\u2009px ×{times}"


MISS = START.changed({"right_uv": (320, 230), "noise": 2.0, "baseline": 0.2, "method": "optimal"})
NOISY = START.changed({"noise": 2.0, "seed": 5, "method": "midpoint"})


def linked(html: str, name: str) -> list[str]:
    """What is linked under a name, and its classes."""
    found = [e for e in xml(html).iter() if e.get("data-link") == name]
    return sorted(f"{e.tag.split('}')[-1]} {e.get('class', '')}".strip() for e in found)


@pytest.fixture(scope="module")
def rig() -> Iterator[Rig]:
    with Rig(SIM) as rig:
        yield rig


@pytest.mark.parametrize("p", [START, MISS, NOISY], ids=["defaults", "miss", "noise"])
def test_image_points_are_linked_with_their_lines_rays_and_rows(rig: Rig, p: TriangulationParams) -> None:
    rig.show(p)
    pictures, tables = rig.column.html("pane"), rig.column.html("read")
    rows = {str(e.get("data-link")): [str(td.text) for td in e.iter("td")] for e in xml(tables).iter("tr")}
    for side, measured in zip(("left", "right"), mathematics.measured(p), strict=True):
        lines = 3 if p.noise else 1  # a cross is two
        assert linked(pictures, side) == ["g", *["line"] * lines]
        assert linked(tables, side) == ["tr"], "it can't be selected"
        assert rows[side] == [figure(v, 2) for v in measured]


@pytest.mark.parametrize("p", [START, MISS, NOISY], ids=["defaults", "miss", "noise"])
def test_points_of_all_methods_are_linked_with_where_they_are_seen_and_their_rows(
    rig: Rig, p: TriangulationParams
) -> None:
    rig.show(p)
    pictures, tables = rig.column.html("pane"), rig.column.html("read")
    solution = solve(p)
    for name, result in solution.by_method.items():
        chosen = name == p.method
        assert linked(pictures, name) == ["g s3-point" if chosen else "g s3-point s3-quiet"] * 2
        assert linked(tables, name) == ["tr s3-selected" if chosen else "tr"]
        for mark, at in zip(
            (e for e in xml(pictures).iter() if e.get("data-link") == name),
            (result.pixel_left, result.pixel_right), strict=True,
        ):  # fmt: skip
            assert at is not None
            place = [float(v) for v in re.findall(r"[-\d.]+", str(mark.get("transform")))]
            np.testing.assert_allclose(place, at, rtol=0, atol=0.006)
        for path in (f"/{name}", f"/closeup/{name}"):
            assert all(rig.model.node(f"{path}/{body}").clicks for body in ("filled", "ghost", "lit"))
    assert linked(pictures, "true") == ([] if solution.true_point is None else ["g s3-point s3-quiet"] * 2)
    assert linked(tables, "true") == ([] if solution.true_point is None else ["tr"])


def test_the_true_point_has_a_row_with_the_errors_that_the_noise_made() -> None:
    solution = solve(NOISY)
    assert solution.point is not None
    assert solution.true_point is not None
    tables = xml(readout.render(SIM.readouts(NOISY, solution)))
    (row,) = (e for e in tables.iter("tr") if e.get("data-link") == "true")
    a, b = (math.dist(m, h) for m, h in zip(mathematics.measured(NOISY), (NOISY.left_uv, NOISY.right_uv), strict=True))
    apart = 1000.0 * math.dist(solution.true_point, solution.point)
    expected = [figure(a, 3), figure(b, 3), figure(math.hypot(a, b) / math.sqrt(2), 3), f"{figure(apart, 1)}\u2009mm"]
    assert [str(td.text) for td in row.iter("td")] == expected


@pytest.mark.parametrize(
    ("name", "nodes"),
    [
        ("left", {"/left/lit"}),
        ("right", {"/right/lit"}),
        ("dlt", {"/dlt/lit", "/closeup/dlt/lit"}),
        ("optimal", {"/optimal/lit", "/closeup/optimal/lit"}),
        ("true", {"/point/lit", "/closeup/true/lit"}),
        ("", set()),
        ("nobody", set()),
    ],
)
def test_what_is_pointed_at_lights_up_in_the_scene_and_nothing_else_changes(
    rig: Rig, name: str, nodes: set[str]
) -> None:
    rig.host.call(lambda: rig.session.hover(""))
    rig.show(NOISY)
    before = rig.model.snapshot()
    rig.host.call(lambda: rig.session.hover(name))
    rig.settle()
    after = rig.model.snapshot()
    assert {key.removeprefix("scene ") for key in after if key not in before} == nodes
    assert not differences(before, {key: after[key] for key in before})
    for side in ("left", "right"):
        if f"/{side}/lit" in nodes:
            np.testing.assert_array_equal(rig.model.points(f"/{side}/lit"), rig.model.points(f"/{side}/ray"))
            rig.show(NOISY.changed({"left_uv": (300, 300), "right_uv": (200, 300)}))
            np.testing.assert_array_equal(rig.model.points(f"/{side}/lit"), rig.model.points(f"/{side}/ray"))
    rig.host.call(lambda: rig.session.hover(""))
    rig.show(NOISY)
    assert not differences(before, rig.model.snapshot(), within=1e-12)


def test_a_method_is_selected_by_a_click_on_its_point_and_marked_everywhere(rig: Rig) -> None:
    rig.show(MISS)
    rig.browser.click("/closeup/midpoint/ghost")
    rig.settle()
    assert rig.session.params == MISS.changed({"method": "midpoint"})
    pictures, tables = rig.column.html("pane"), rig.column.html("read")
    assert linked(pictures, "midpoint") == ["g s3-point"] * 2
    assert linked(tables, "midpoint") == ["tr s3-selected"]
    assert tables.count("s3-selected") == 1
    assert rig.model.visible("/midpoint/filled")
    rig.host.call(lambda: rig.session.select("left"))
    rig.settle()
    assert rig.session.params == MISS.changed({"method": "midpoint"}), "an image point can't be selected"


def test_what_is_outside_a_picture_is_marked_at_its_border() -> None:
    p = START.changed({"left_uv": (639, 479), "right_uv": (0, 0), "noise": 5.0, "seed": 3})
    solution = solve(p)
    out = 0
    for pane, side, found in zip(
        panes(p, solution), ("left", "right"),
        (solution.by_method["dlt"].pixel_left, solution.by_method["dlt"].pixel_right), strict=False,
    ):  # fmt: skip
        for name, at in (
            (side, {"left": solution.measured_left, "right": solution.measured_right}[side]),
            ("dlt", found),
        ):
            heads = [e for e in xml(pane.svg).iter() if e.get("data-link") == name and list(e.iter("path"))]
            outside = at is not None and not inside(*at, 640, 480)
            assert len(heads) == outside
            out += outside
    assert out > 0


@pytest.mark.parametrize(
    ("left", "right", "times"),
    [(None, None, 1), (0.0, 0.0, 1), (80.0, 3.0, 1), (0.0, 6.0, 10), (0.05, 0.0, 100), (0.02, 0.01, 1)],
)
def test_arrows_are_magnified_until_they_can_be_seen_but_no_farther(
    left: float | None, right: float | None, times: int
) -> None:
    assert magnification(left, right) == times


def test_what_the_glass_holds_of_a_line() -> None:
    start, end = chord([0.1, 0.0, 0.2], (0.15, 1.0, 0.05), 0.75)
    for place in (start, end):
        assert math.hypot(*place) == pytest.approx(0.75)
        offset = np.subtract(place, [0.1, 0.0, 0.2])
        np.testing.assert_allclose(np.cross(offset, (0.15, 1.0, 0.05)), 0.0, atol=1e-12)
    missed, same = chord([2.0, 0.0, 0.0], (0.0, 1.0, 0.0), 0.75)
    assert missed == same


# ---- what stays while the cameras change


def slid(p: TriangulationParams, **values: float) -> TriangulationParams:
    """The state after sliders moved, one after the other."""
    for name, value in values.items():
        p = p.moved({name: value})
    return p


def sigma(p: TriangulationParams) -> float:
    found = solve(p).depth_sigma
    assert found is not None
    return found


def test_a_larger_baseline_or_focal_length_makes_the_same_point_surer() -> None:
    before = solve(START)
    for values in ({"baseline": 2.0}, {"focal": 1500.0}, {"baseline": 0.05}, {"baseline": 1.2, "focal": 450.0}):
        after = solve(slid(START, **values))
        np.testing.assert_allclose(after.point, before.point, rtol=0, atol=1e-9)  # type: ignore[arg-type]
        larger = values.get("baseline", 0.6) * values.get("focal", 600.0) / 360.0
        assert after.depth_sigma == pytest.approx(before.depth_sigma / larger)  # type: ignore[operator]


def test_a_link_means_what_it_always_did() -> None:
    p = TriangulationParams.from_query(parse_qsl("baseline=1.2"))
    assert (p.left_uv, p.right_uv, p.hold) == ((410.0, 210.0), (320.0, 210.0), "point")
    assert solve(p).depth == pytest.approx(8.0), "its pixels are those of the default"
    named = TriangulationParams.from_query(parse_qsl("baseline=1.2&left_uv=410,210&right_uv=320,210"))
    assert named == p
    assert START.changed({"baseline": 1.2}) == p, "a course page sets what it names, and nothing else"


def test_pixels_stay_where_that_is_asked_for() -> None:
    p = START.changed({"hold": "pixels"})
    after = slid(p, baseline=2.0, focal=900.0)
    assert (after.left_uv, after.right_uv) == (START.left_uv, START.right_uv)
    assert sigma(after) > sigma(p)


def test_what_names_pixels_sets_them_whatever_else_it_names() -> None:
    after = START.moved({"baseline": 2.0, "left_uv": (400.0, 200.0)})
    assert (after.left_uv, after.right_uv) == ((400.0, 200.0), START.right_uv)


@given(states, st.floats(0.05, 2), st.floats(200, 1500))
def test_the_point_is_held_and_so_is_the_miss(p: TriangulationParams, baseline: float, focal: float) -> None:
    p = p.changed({"noise": 0.0, "method": "optimal", "hold": "point"})
    between = slid(p, baseline=baseline)
    after = slid(between, focal=focal)
    was, now = solve(p).point, solve(after).point
    if was is None or now is None:
        assert was is None, "a point that is held goes on to be there"
        np.testing.assert_allclose([after.left_uv, after.right_uv], [p.left_uv, p.right_uv], atol=1e-9)
        return
    pixels = [uv for each in (between, after) for uv in (each.left_uv, each.right_uv)]
    if all(0.01 < v < end - 0.01 for uv in pixels for v, end in zip(uv, p.last, strict=True)):
        np.testing.assert_allclose(now, was, rtol=1e-6, atol=1e-6)
        assert after.left_uv[1] - after.right_uv[1] == pytest.approx(p.left_uv[1] - p.right_uv[1], abs=1e-9)


def test_a_point_that_a_picture_shows_no_more_goes_aside_at_its_depth() -> None:
    after = slid(START, baseline=2.0, focal=1200.0)
    assert after.left_uv[0] == 639.0
    found = solve(after).point
    assert found is not None
    assert found[1] == pytest.approx(4.0)
    assert found[0] < 0.3


def test_the_slider_of_the_baseline_leaves_the_point_in_the_scene(rig: Rig) -> None:
    rig.show(START)
    at = rig.model.world_pose("/point")[:3, 3]
    rig.host.call(lambda: rig.session.slide("baseline", 1.7))
    rig.settle()
    np.testing.assert_allclose(rig.model.world_pose("/point")[:3, 3], at, rtol=0, atol=1e-9)
    assert rig.session.params.query_items()["left_uv"] != "410,210"
    rig.browser.move("hold", "pixels")
    rig.settle()
    rig.host.call(lambda: rig.session.slide("baseline", 0.6))
    rig.settle()
    assert rig.model.world_pose("/point")[1, 3] < 3.0


# ---- the plot


def axes(p: TriangulationParams) -> list[str]:
    return re.findall(r'data-axes="([^"]*)"', panes(p, solve(p))[2].svg)


def test_the_plots_axes_stay_while_a_slider_moves_and_the_curve_before_is_seen() -> None:
    begun = START
    for name, values in (("baseline", (0.7, 2.0, 0.1)), ("focal", (900.0, 250.0)), ("noise", (2.0, 0.3))):
        was = begun
        for value in values:
            begun = slid(begun, **{name: value})
            svg = panes(begun, solve(begun))[2].svg
            assert svg.count('class="s3-ghost"') == 1
            assert begun.before == (was.baseline, was.focal, was.noise)
            assert axes(begun) == axes(was.changed({"before": begun.before}))
        assert "before" in words(svg)
    back = slid(START, baseline=0.7, focal=600.0).moved({"baseline": 0.6})
    assert back.before == (0.7, 600.0, 0.0), "another slider, another curve before it"
    there = slid(START, baseline=0.7).moved({"baseline": 0.6})
    assert there.before == (0.6, 600.0, 0.0)
    assert panes(there, solve(there))[2].svg.count('class="s3-ghost"') == 2, "half and twice the baseline"


def test_what_is_surer_than_the_plot_has_room_for_is_marked_at_its_top() -> None:
    p = slid(START, baseline=0.05)
    pane = panes(p, solve(p))[2]
    assert dot_of(pane.svg)[1] == pytest.approx(24.0)
    assert "beyond the top" in pane.note


@pytest.mark.parametrize("changes", [{}, {"noise": 2.0, "seed": 4}, {"right_uv": (320, 222)}, {"doffs": 30.0}])
def test_the_point_is_dragged_along_the_depth_in_the_plot(changes: dict[str, Any]) -> None:
    p = START.changed({**changes, "method": "optimal"})
    for depth in (2.0, 6.5, 9.0):
        moved = p.moved(SIM.handles["depth"](p, (depth, 0.3)))
        assert solve(moved).depth == pytest.approx(depth, rel=1e-6)
        assert axes(moved) == axes(p)
        middles = [0.5 * (each.left_uv[0] + each.right_uv[0]) for each in (p, moved)]
        assert middles[0] == pytest.approx(middles[1]), "in the direction in which it is seen"
    for beyond, end in ((0.2, 1.01), (30.0, 9.99)):
        moved = p.moved(SIM.handles["depth"](p, (beyond, 0.3)))
        assert solve(moved).depth == pytest.approx(end, rel=1e-6), "it stays on its plot"
        assert axes(moved) == axes(p)
    nowhere = START.changed(SIM.states["diverging rays"])
    assert SIM.handles["depth"](nowhere, (3.0, 0.1)) == {}


# ---- what is said


def formulas(p: TriangulationParams) -> dict[str, str]:
    """The words of each read-out that is a formula, by its note."""
    found = [each for each in SIM.readouts(p, solve(p)) if isinstance(each, readout.Formula)]
    return {each.note: words(each.html()) for each in found}


@pytest.mark.parametrize("method", ["dlt", "midpoint", "optimal"])
def test_both_angles_are_named_and_differ_where_the_rays_miss(method: str) -> None:
    p = START.changed({"left_uv": (639, 479), "right_uv": (320, 0), "method": method})
    solution = solve(p)
    a, b = (np.array([(u - 320) / 600, 1.0, -(v - 240) / 600]) for u, v in (p.left_uv, p.right_uv))
    rays = math.degrees(math.acos(a @ b / math.sqrt(a @ a * (b @ b))))
    assert solution.point is not None
    a, b = (solution.point - np.array([x, 0.0, 1.0]) for x in (-0.3, 0.3))
    there = math.degrees(math.acos(a @ b / math.sqrt(a @ a * (b @ b))))
    assert abs(rays - there) > 1.0
    assert (solution.ray_angle, solution.point_angle) == pytest.approx((rays, there))
    said = formulas(p)
    assert figure(rays, 2) in said["Angle between the two rays"]
    assert figure(there, 2) in said["Angle at the point, between the lines to both cameras (parallax)"]


@each_pair
def test_the_equations_of_the_linear_method_are_shown_with_what_solves_them(changes: dict[str, Any]) -> None:
    p = START.changed(changes)
    solution, rows = solve(p), list[Array]()
    K_inverse = np.linalg.inv(np.array([[p.focal, 0, 320], [0, p.focal, 240], [0, 0, 1]]))
    for uv, P in zip(mathematics.measured(p), matrices(p), strict=True):
        inner = K_inverse @ P
        x, y, _ = K_inverse @ [*uv, 1.0]
        rows += [x * inner[2] - inner[0], y * inner[2] - inner[1]]
    np.testing.assert_allclose(solution.equations, rows, rtol=0, atol=1e-9)
    v = solution.least_vector
    assert np.linalg.norm(v) == pytest.approx(1.0)
    assert np.linalg.norm(solution.equations @ v) == pytest.approx(solution.singular_values[3], abs=1e-12)
    np.testing.assert_allclose(v[:3] / v[3], found(p, "dlt"), rtol=1e-9)
    html = readout.render(SIM.readouts(p, solution))
    sides = re.findall(r'<mtd class="s3-(left|right)"><mn>(.*?)</mn>', html)
    assert [side for side, _ in sides] == ["left"] * 8 + ["right"] * 8
    assert [value for _, value in sides] == [figure(value, 3) for value in np.ravel(rows)]


def test_the_sentence_says_what_a_change_of_the_cameras_did() -> None:
    assert SIM.caption(START, solve(START)).startswith("Drag the 3D point onto a corner")
    reached = START.changed(SIM.handles["/point"](START, tuple(corners.PLACES[0].tolist())))
    assert SIM.caption(reached, solve(reached)).startswith("That is a corner of")
    for changes, said in (
        ({"baseline": 1.2}, "A longer baseline, a surer depth: from ±\u00a00.063 to ±\u00a00.031"),
        ({"focal": 300.0}, "A shorter focal length, a less sure depth: from ±\u00a00.063 to ±\u00a00.126"),
    ):
        p = slid(START, **changes)
        assert SIM.caption(p, solve(p)) == f"{said}\u2009m at the same point."
    other = START.changed(calibration.middlebury(START))
    assert (
        SIM.caption(other, solve(other))
        == "Another rig, a surer depth: from ±\u00a00.063 to ±\u00a00.031\u2009m at the same point."
    )
    kept = slid(START.changed({"hold": "pixels"}), baseline=1.2)
    assert SIM.caption(kept, solve(kept)).startswith("With the pixels kept, a longer baseline means a farther point")
    noisy = slid(START, noise=1.0)
    assert SIM.caption(noisy, solve(noisy)).startswith("Noise makes")


# ---- the ellipsoid


def test_a_long_ellipsoid_is_cut_and_its_length_said(rig: Rig) -> None:
    p = START.changed({"right_uv": (408.512, 210)})
    solution = solve(p)
    assert solution.depth == pytest.approx(242.0, abs=0.1)
    assert solution.ellipsoid_axes is not None
    rig.show(p)
    assert not rig.model.visible("/uncertainty/ellipsoid")
    assert rig.model.visible("/uncertainty/cut")
    node = rig.model.node("/uncertainty/cut")
    pose = rig.model.world_pose("/uncertainty/cut")
    unit = np.asarray(node.props["vertices"], dtype=float).reshape(-1, 3)
    corners = (unit * node.props["scale"]) @ pose[:3, :3].T + pose[:3, 3]
    offsets = corners - solution.point
    assert solution.covariance is not None
    inverse = np.linalg.inv(9.0 * solution.covariance)
    assert np.einsum("ni,ij,nj->n", offsets, inverse, offsets).max() == pytest.approx(1.0, abs=1e-5), "no farther"
    along = offsets @ np.linalg.eigh(solution.covariance)[1][:, 2]
    assert np.abs(along).max() == pytest.approx(0.5 * solution.depth, rel=1e-5)  # type: ignore[operator]
    assert corners[:, 1].min() > 0.4 * solution.depth, "the scene before the cameras is free"  # type: ignore[operator]
    length = f"{figure(6.0 * float(solution.ellipsoid_axes[0]), 0)} m long"
    assert length in words(rig.column.html("read"))
    assert "ellipsoid cut" in rig.model.labels()["/result/label"]
    rig.show(START)
    assert rig.model.visible("/uncertainty/ellipsoid")
    assert not rig.model.visible("/uncertainty/cut")


# ---- real rigs


def test_a_calibration_of_middlebury_is_understood_in_metres_and_pixels() -> None:
    assert SIM.paste is not None
    assert rig_in(SIM.paste.found(SIM.paste.example)) == calibration.MIDDLEBURY, "and nothing by rounding, for the link"


def rig_in(found: list[Found]) -> dict[str, float]:
    """The parallel rig that is taken."""
    made = calibration.changes(START, found)
    assert made["own"] is None
    return {name: value for name, value in made.items() if name in calibration.PARALLEL}


KITTI_TEXT = """\
calib_time: 09-Jan-2012 13:57:47
S_rect_00: 1.242000e+03 3.750000e+02
P_rect_00: 7.215377e+02 0 6.095593e+02 0 0 7.215377e+02 1.728540e+02 0 0 0 1 0
P_rect_01: 7.215377e+02 0 6.095593e+02 -3.875744e+02 0 7.215377e+02 1.728540e+02 0 0 0 1 0
"""


@pytest.mark.parametrize("text", [KITTI_TEXT, KITTI_TEXT.replace("P_rect_0", "P").replace("S_rect", "other")])
def test_a_calibration_of_kitti_is_understood(text: str) -> None:
    assert rig_in(calibration.read(text)) == pytest.approx(calibration.KITTI, rel=1e-5)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "No pair was found"),
        ("cam0=[1 2\ncam1=[1 2]\nbaseline=1", "“cam0” should have 9 numbers"),
        (calibration.EXAMPLE.replace("4161.221 0 1654", "4161.221 9 1654"), "no skew"),
        (calibration.EXAMPLE.replace("cam0=[4161.221", "cam0=[0"), "above 0"),
        (calibration.EXAMPLE.replace("width=2880", ""), "doesn’t say how large the pictures are"),
        (calibration.EXAMPLE.replace("176.252", "nan"), "“baseline” should have 1 number."),
        (KITTI_TEXT.replace("7.215377e+02", "0"), "above 0"),
    ],
)
def test_what_is_no_calibration_is_refused_in_words(text: str, said: str) -> None:
    with pytest.raises(ValueError, match=said):
        calibration.changes(START, calibration.read(text))


@pytest.mark.parametrize("run", [calibration.middlebury, calibration.kitti])
def test_a_real_rig_looks_at_the_same_point_and_is_as_sure_as_its_numbers_say(run: Any) -> None:
    p = START.changed(run(START))
    solution = solve(p)
    np.testing.assert_allclose(solution.point, (0.3, 4.0, 1.2), rtol=0, atol=1e-9)  # type: ignore[arg-type]
    assert solution.disparity is not None
    assert solution.depth_from_disparity == pytest.approx(p.focal * p.baseline / (solution.disparity + p.doffs))
    assert solution.depth_sigma == pytest.approx(math.sqrt(2.0) * 16.0 / (p.focal * p.baseline))
    assert p.before == (0.6, 600.0, 0.0), "the curve of the rig before is kept"
    assert ("doffs" in words(readout.render(SIM.readouts(p, solution)))) == bool(p.doffs)
    again = TriangulationParams.from_query(parse_qsl(p.query()))
    assert again == p


def test_no_disparity_is_near_where_the_principal_points_differ() -> None:
    p = START.changed({**calibration.MIDDLEBURY, "left_uv": (1400, 900), "right_uv": (1400, 900)})
    assert solve(p).depth == pytest.approx(4161.221 * 0.176252 / 209.059)
    far = p.changed({"right_uv": (1609.059, 900)})
    assert solve(far).status == "parallel"
    assert "with doffs added is zero" in words(readout.render(SIM.readouts(far, solve(far))))


def test_a_rig_that_is_out_of_bounds_is_refused() -> None:
    with pytest.raises(ValidationError, match="baseline"):
        START.changed(calibration.with_rig(START, {**calibration.MIDDLEBURY, "baseline": 176.252}))


@pytest.mark.parametrize("run", [calibration.middlebury, calibration.kitti])
def test_pictures_of_any_size_are_drawn_as_wide_and_held_in_their_own_pixels(run: Any) -> None:
    p = START.changed(run(START))
    (left,) = xml(panes(p, solve(p))[0].svg)
    assert left.get("viewBox") == f"-0.5 -0.5 640 {math.ceil(640 * p.height / p.width)}"
    (handle,) = (e for e in left.iter() if e.get("data-handle"))
    place = float(handle.get("data-x", "")), float(handle.get("data-y", ""))
    scale = 640 / p.width
    np.testing.assert_allclose(np.add(place, 0.5), scale * (np.array(p.left_uv) + 0.5), rtol=0, atol=1e-9)
    assert f"{p.left_uv[0]:.1f}, {p.left_uv[1]:.1f} pixels" in handle.get("aria-label", "")
    there = SIM.handles["left_uv"](p, place)
    assert there["left_uv"] == pytest.approx(p.left_uv)
    corner = p.moved(SIM.handles["left_uv"](p, (639.0, 479.0)))
    assert corner.left_uv[0] > p.width - 3
    assert corner.left_uv[1] <= p.height - 1
    (line,) = (e for e in left.iter() if e.get("data-link") == "right")
    assert float(line.get("y1", "")) + 0.5 == pytest.approx(scale * (p.right_uv[1] + 0.5), abs=0.01)


def test_a_pixel_is_in_a_picture_of_any_size() -> None:
    with pytest.raises(ValidationError, match="from 0 to 639"):
        START.changed({"left_uv": (640.0, 10.0)})
    assert START.changed({"width": 2880, "left_uv": (2000.0, 10.0)}).left_uv == (2000.0, 10.0)
    assert START.bounds("focal") == (200.0, 1500.0)


def test_the_little_world_is_where_both_pictures_show_it(rig: Rig) -> None:
    """The top of the second post, right below the point: its faces meet there in both pictures, and in the scene."""
    rig.show(START)
    top = np.array([0.3, 4.0, 1.0])
    edges = rig.model.points("/things/edges").reshape(-1, 3)
    assert np.linalg.norm(edges - top, axis=1).min() < 0.005
    for pane, pixel in zip(panes(START, solve(START)), projections(START, top), strict=False):
        corners = re.findall(r"[ML]([-\d.]+) ([-\d.]+)", pane.svg.partition('class="s3-faces"')[2])
        assert np.linalg.norm(np.array(corners, dtype=float) - pixel, axis=1).min() < 1.0


@pytest.mark.parametrize("preset", [lambda p: {}, calibration.kitti])
def test_who_matches_a_corner_is_told_how_far_from_it_the_point_is(preset: Any) -> None:
    assert solve(START).matched is None
    p = START.changed(preset(START))
    corner = min(corners.PLACES.tolist(), key=lambda place: math.dist(place, (0.3, 4.0, 1.0)))
    p = p.changed(actions.hold_point(p, tuple(corner)))
    solution = solve(p)
    assert solution.matched is not None
    assert solution.matched.place.tolist() == corner
    assert solution.matched.apart == pytest.approx(0.0, abs=1e-9)
    near = p.changed({"right_uv": (p.right_uv[0] - 2.0, p.right_uv[1])})
    solution = solve(near)
    assert solution.matched is not None
    assert solution.point is not None
    assert solution.matched.apart == pytest.approx(math.dist(solution.point, corner))
    note = f"DLT: {figure(1000 * solution.matched.apart, 1)}\u2009mm off a corner"
    assert note in [each.note for each in SIM.readouts(near, solution) if isinstance(each, readout.Formula)]
    assert SIM.caption(near.changed({"before": None}), solution).startswith("That is a corner of a post: your point is")
    off = p.changed({"right_uv": (p.right_uv[0], p.right_uv[1] + 7.0 * p.width / 640)})
    assert solve(off).matched is None


def test_a_point_in_the_direction_of_a_corner_alone_is_no_match() -> None:
    p = START.changed({**calibration.MIDDLEBURY, "baseline": 0.05})
    corner = min(corners.PLACES.tolist(), key=lambda place: math.dist(place, (0.3, 4.0, 1.0)))
    p = p.changed(actions.hold_point(p, tuple(corner)))
    assert solve(p).matched is not None
    farther = p.changed({"right_uv": (p.right_uv[0] + 20.0, p.right_uv[1])})
    assert solve(farther).matched is None


@pytest.mark.parametrize("run", [calibration.middlebury, calibration.kitti])
def test_a_real_rig_stands_in_the_scene_as_its_numbers_say(rig: Rig, run: Any) -> None:
    p = START.changed({**run(START), "noise": 1.0})
    rig.show(p)
    last = np.array([p.width, p.height]) - 0.5
    corners_of_picture = [(-0.5, -0.5), (last[0], -0.5), (*last,), (-0.5, last[1])]
    for side, sign, cx in (("left", -0.5, p.cx), ("right", 0.5, p.cx + p.doffs)):
        centre = np.array([sign * p.baseline, 0.0, 1.0])

        def pixels(places: Array, centre: Array = centre, cx: float = cx) -> Array:
            x, y, z = (places.reshape(-1, 3) - centre).T
            return np.column_stack([cx + p.focal * x / y, p.cy - p.focal * z / y])

        measured = mathematics.measured(p)[side == "right"]
        np.testing.assert_allclose(pixels(rig.model.points(f"/{side}/ray")[0, 1]), [measured], rtol=0, atol=1e-2)
        seen = pixels(rig.model.points(f"/{side}/picture"))
        np.testing.assert_allclose(seen, corners_of_picture, rtol=0, atol=1e-2)


def test_controls_are_made_anew_for_another_size_of_the_pictures_alone(rig: Rig) -> None:
    """A hand that moves pixels or cameras doesn't pay for fourteen controls."""
    rig.show(START)
    assert slid(START, baseline=1.0).form() == START.form()
    rig.show(START.changed({"width": 2880}))
    slider = next(xml(rig.column.parts["control:focal"]).iter("input"))
    assert float(slider.get("max", "")) == 1500.0 * 2880 / 640
