"""The point-cloud sim: what is drawn is what the read-outs say, and what others get wrong."""

from __future__ import annotations

import io
from collections.abc import Iterator
from typing import Any
from urllib.parse import parse_qsl

import numpy as np
import pytest
import trimesh
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from geometry import clouds, se3
from sims.kit.column import Column
from sims.kit.palette import before_film, before_tone_mapping
from sims.kit.readout import Note, quantity
from sims.kit.scene.view import FIELD
from sims.point_cloud import SIM, CloudParams, derived, solve
from sims.point_cloud import colors as colors_to_send
from sims.point_cloud.actions import pick, play
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.datasets import dataset
from sims.point_cloud.download import ply
from sims.point_cloud.files import ply_bytes, read
from sims.point_cloud.library import Library
from sims.point_cloud.offers import CloudOffers
from sims.point_cloud.params import VIEWS
from sims.point_cloud.readouts import count
from sims.point_cloud.registration import MOST_STEPS, course
from sims.point_cloud.solution import shown_points
from sims.point_cloud.surface import surface
from tests.server import Rig
from tests.sims.markup import xml


@pytest.fixture(scope="module")
def rig() -> Iterator[Rig]:
    with Rig(SIM) as rig:
        yield rig


def show(rig: Rig, **changes: Any) -> CloudParams:
    params = CloudParams().changed(changes)
    rig.show(params)
    return params


def colors(rig: Rig, name: str = "/cloud/points") -> np.ndarray[Any, np.dtype[np.uint8]]:
    return rig.model.node(name).array("colors")


# ---- shown equals drawn


@pytest.mark.parametrize("voxel", [0.0, 0.1, 1.0])
def test_the_points_that_are_drawn_are_those_of_the_cells(rig: Rig, voxel: float) -> None:
    params = show(rig, voxel_size=voxel)
    drawn = rig.model.points("/cloud/points")
    cloud = dataset("room").points
    wanted = cloud if voxel == 0.0 else clouds.voxels(cloud, voxel).points
    np.testing.assert_allclose(drawn, wanted, atol=1e-6)
    solution = solve(params)
    assert solution.points_in == len(cloud)
    assert solution.points_out == len(drawn)
    assert len(colors(rig)) == len(drawn)


def test_no_voxels_are_no_downsampling(rig: Rig) -> None:
    show(rig, voxel_size=0.2)
    few = len(rig.model.points("/cloud/points"))
    rig.browser.move("voxel_size", 0.0)
    rig.settle()
    assert few < len(rig.model.points("/cloud/points")) == len(dataset("room"))


def test_the_box_is_round_all_points(rig: Rig) -> None:
    params = show(rig, voxel_size=0.3)
    edges = rig.model.points("/box/edges").reshape(-1, 3)
    solution = solve(params)
    points = rig.model.points("/cloud/points")
    np.testing.assert_allclose(edges.min(axis=0), points.min(axis=0), atol=1e-6)
    np.testing.assert_allclose(edges.max(axis=0), points.max(axis=0), atol=1e-6)
    np.testing.assert_allclose(solution.dimensions, np.ptp(points, axis=0), atol=1e-6)
    words = " ".join(rig.model.labels().values())
    for length in solution.dimensions:
        assert f"{length:.2f}" in words
    show(rig, show_box=False)
    assert not rig.model.visible("/box/edges")


def test_the_selected_point_is_ringed_and_read_out(rig: Rig) -> None:
    params = show(rig, selected=4711, voxel_size=0.05)
    chosen = solve(params).selected
    assert chosen is not None
    np.testing.assert_allclose(rig.model.world_pose("/selected")[:3, 3], chosen.position, atol=1e-6)
    np.testing.assert_allclose(rig.model.points("/cloud/points")[4711], chosen.position, atol=1e-6)
    html = rig.column.html("read")
    for value in chosen.position:
        assert f"{abs(value):.3f}" in html
    show(rig)
    assert not rig.model.visible("/selected/label")


def test_selecting_a_point_of_the_moved_scan_finds_it_where_it_is_drawn(rig: Rig) -> None:
    params = show(rig, dataset="two-scans", process="register", step=3, selected=150_000)
    chosen = solve(params).selected
    assert chosen is not None
    first = len(rig.model.points("/cloud/points"))
    drawn = se3.apply(rig.model.world_pose("/marked/points"), rig.model.node("/marked/points").array("points"))
    np.testing.assert_allclose(drawn[150_000 - first], chosen.position, atol=1e-5)
    np.testing.assert_allclose(rig.model.world_pose("/selected")[:3, 3], chosen.position, atol=1e-6)


def test_marked_and_other_points_are_all_points(rig: Rig) -> None:
    params = show(rig, dataset="statue", process="outliers", step=1)
    solution = solve(params)
    assert solution.outliers is not None
    assert len(rig.model.node("/marked/points").array("points")) == solution.outliers.removed > 100
    assert solution.points_out == solution.points_in
    removed = solve(params.changed({"step": 2}))
    assert removed.points_out == solution.points_in - solution.outliers.removed


# ---- what others get wrong


@pytest.mark.parametrize("color", ["height", "intensity", "rgb", "normals", "variation"])
def test_points_have_more_than_one_colour(rig: Rig, color: str) -> None:
    show(rig, color=color, voxel_size=0.1)
    assert len(np.unique(colors(rig), axis=0)) > 20


@pytest.mark.parametrize("name", ["room", "street", "statue", "two-scans"])
def test_normals_point_towards_the_sensor(name: str) -> None:
    cloud = dataset(name)
    assert cloud.sensor is not None
    thin = derived.thinned(cloud, 0.1)
    vectors = derived.normals(thin, 16)
    assert thin.sensor is not None
    to_sensor = thin.sensor - thin.points
    defined = vectors.any(axis=1)
    assert (np.vecdot(vectors, to_sensor)[defined] >= 0.0).all()
    assert np.count_nonzero(vectors[defined][:, 2] > 0.9) > 10
    np.testing.assert_allclose(np.linalg.norm(vectors[defined], axis=1), 1.0)


@pytest.mark.parametrize(("dataset", "voxel"), [("room", 0.1), ("street", 0.0), ("two-scans", 0.0), ("statue", 0.5)])
def test_arrows_of_normals_start_at_points_and_go_along_them(rig: Rig, dataset: str, voxel: float) -> None:
    params = show(rig, dataset=dataset, voxel_size=voxel, show_normals=True)
    arrows = rig.model.points("/cloud/normals")
    thin = shown_points(params)
    near = cKDTree(thin.points)
    off, rows = near.query(arrows[:, 0])
    np.testing.assert_allclose(off, 0.0, atol=1e-5)
    assert len(set(rows)) == len(rows) > min(100, len(thin) // 2)
    assert len(rows) <= 1_200, "more than a browser draws at ease"
    vectors = arrows[:, 1] - arrows[:, 0]
    lengths = np.linalg.norm(vectors, axis=1)
    np.testing.assert_allclose(lengths, solve(params).drawn.arrow, rtol=1e-3)
    np.testing.assert_allclose(vectors / lengths[:, None], derived.normals(thin, 16)[rows], atol=1e-3)
    assert rig.model.node("/cloud/normals").props["head_length"] < 0.5 * lengths.min()
    show(rig, dataset=dataset, voxel_size=voxel)
    assert not rig.model.visible("/cloud/normals")


def test_the_surface_variation_is_the_share_of_the_least_variance(rig: Rig) -> None:
    params = show(rig, dataset="statue", color="variation", selected=4711, neighbors=20)
    points = dataset("statue").points
    near = points[cKDTree(points).query(points[4711], 20)[1]]
    values = np.linalg.eigvalsh(np.cov(near.T))
    chosen = solve(params).selected
    assert chosen is not None
    assert chosen.variation == pytest.approx(values[0] / values.sum(), abs=1e-6)
    assert f"{chosen.variation:.4f}" in rig.column.html("read")
    tally = solve(params).drawn.tally
    assert tally is not None
    assert 0.0 == tally.low < tally.high <= 1.0 / 3.0
    assert f"{tally.high:.2f}" in rig.column.html("pane")
    assert tally.counts.sum() == len(points)


def test_what_has_no_surface_is_grey_and_not_counted() -> None:
    line = Cloud("line", np.outer(np.arange(30.0), [1.0, 0.0, 0.0]))
    assert np.isnan(derived.local(line, 8).variation).all()
    grey = derived.painted(line, line, derived.Look("variation", 8))
    assert (grey == colors_to_send.of_rgb(np.array([colors_to_send.GREY], np.uint8))).all()
    tally = derived.tally(line, line, "variation", 8)
    assert tally is not None
    assert not tally.counts.any()


def test_nothing_is_computed_again_for_size_or_colours(monkeypatch: pytest.MonkeyPatch) -> None:
    params = CloudParams(dataset="two-scans", process="register", step=3, show_normals=True, voxel_size=0.06)
    first = solve(params)
    for name in ("voxels", "normals", "icp", "spacing", "outliers"):
        monkeypatch.setattr(clouds, name, lambda *_, **__: pytest.fail("computed again"))
    again = solve(params.changed({"point_size": 5.0, "show_box": False}))
    assert again.drawn.base is first.drawn.base
    assert again.drawn.base_normals is first.drawn.base_normals
    solve(params.changed({"color": "normals", "step": 5}))


def test_a_change_of_size_sends_no_points(rig: Rig) -> None:
    show(rig)
    before = rig.model.node("/cloud/points").props["points"]
    rig.browser.move("point_size", 6.0)
    rig.settle()
    assert rig.model.node("/cloud/points").props["points"] is before
    assert rig.model.node("/cloud/points").props["point_size"] == pytest.approx(6.0 * VIEWS["room"].radius / 350.0)


def test_another_cloud_is_looked_at_from_where_all_of_it_is_seen(rig: Rig) -> None:
    show(rig)
    show(rig, dataset="street")
    view = VIEWS["street"]
    position = np.array(rig.model.latest["SetCameraPositionMessage"]["position"])
    away = np.linalg.norm(position - view.look_at)
    assert away * np.sin(0.35) == pytest.approx(view.radius, rel=0.1)
    np.testing.assert_allclose(rig.model.latest["SetCameraLookAtMessage"]["look_at"], view.look_at)
    show(rig, dataset="street", color="height")
    np.testing.assert_array_equal(rig.model.latest["SetCameraPositionMessage"]["position"], position)


def test_the_page_hears_of_the_view_that_another_cloud_has(rig: Rig) -> None:
    show(rig)
    show(rig, dataset="statue")
    view = VIEWS["statue"]
    home = [message for message in rig.browser.told if message["type"] == "home"][-1]
    assert home == {"type": "home", "view": [*view.position, *view.look_at], "radius": view.radius, "moved": True}
    position, middle = (
        np.array(rig.model.latest[f"SetCamera{what}Message"][name])
        for what, name in (("Position", "position"), ("LookAt", "look_at"))
    )
    assert np.linalg.norm(position - middle) * np.sin(FIELD / 2) == pytest.approx(view.radius)
    np.testing.assert_allclose(middle, view.look_at)


def steps(rig: Rig) -> float:
    """How far the slider of the steps goes."""
    return float(next(xml(rig.column.parts["control:step"]).iter("input")).get("max", ""))


# ---- picking


def test_a_ray_picks_the_nearest_point_it_meets(rig: Rig) -> None:
    show(rig, voxel_size=0.05)
    points = rig.model.points("/cloud/points")
    eye = np.array([4.6, -5.8, 4.4])
    target = points[np.argmin(np.linalg.norm(points - [0.0, -0.3, 0.74], axis=1))]
    ray = (target - eye) / np.linalg.norm(target - eye)
    rig.browser.send(
        {
            "type": "ScenePointerMessage",
            "event_type": "click",
            "ray_origin": tuple(eye.tolist()),
            "ray_direction": tuple(ray.tolist()),
            "screen_pos": [(0.5, 0.5)],
            "modifier": None,
        }
    )
    rig.settle()
    assert isinstance(rig.session.params, CloudParams)
    chosen = rig.session.params.selected
    assert chosen is not None
    assert np.linalg.norm(points[chosen] - target) < 0.1


def test_a_ray_past_everything_picks_nothing() -> None:
    assert pick(CloudParams(selected=3), (0.0, 0.0, 5.0, 0.0, 0.0, 1.0)) == {"selected": None}


def test_a_selection_ends_when_the_points_change() -> None:
    chosen = CloudParams(selected=10)
    assert chosen.moved({"voxel_size": 0.1}).selected is None
    assert chosen.moved({"dataset": "street"}).selected is None
    assert chosen.moved({"color": "height"}).selected == 10
    assert chosen.moved({"point_size": 3.0}).selected == 10
    registering = CloudParams(dataset="two-scans", process="register", step=1, selected=10)
    assert registering.moved({"step": 2}).selected == 10


# ---- processes


def test_a_process_starts_where_one_sees_it() -> None:
    assert CloudParams().moved({"process": "ground"}).step == 2
    assert CloudParams(dataset="two-scans").moved({"process": "register"}).step == 0
    back = CloudParams(process="register", step=30).moved({"process": "clusters"})
    assert back.step == 2


@pytest.mark.parametrize("query", ["dataset=two-scans&process=register", "process=ground", "process=none"])
def test_a_link_without_a_step_means_where_the_process_begins(query: str) -> None:
    start = CloudParams.from_query(parse_qsl(query))
    assert start.step == (0 if start.process == "register" else 2)
    assert start == CloudParams().changed(dict(parse_qsl(query)))
    assert "step" not in start.query()
    for step in range(3):
        there = start.changed({"step": step})
        assert CloudParams.from_query(parse_qsl(there.query())) == there


def test_the_slider_of_the_steps_ends_at_the_last_one(rig: Rig) -> None:
    params = show(rig, dataset="two-scans", process="register", voxel_size=0.08)
    found = solve(params).registration
    assert found is not None
    assert 3 < found.steps < MOST_STEPS
    assert steps(rig) == found.steps
    rig.browser.move("step", found.steps)
    rig.settle()
    assert "converged" in rig.column.html("read")
    rig.browser.press("step")
    rig.settle()
    assert rig.session.params.step == 0, "from the last step on to the first"  # type: ignore[attr-defined]
    show(rig, dataset="two-scans", process="ground", voxel_size=0.08)
    assert steps(rig) == 2


def test_a_link_beyond_the_last_step_shows_the_last(rig: Rig) -> None:
    params = show(rig, dataset="two-scans", process="register", voxel_size=0.08, step=40)
    found = solve(params).registration
    assert found is not None
    assert found.step == found.steps < 40
    assert params.moved({"point_size": 3.0}).step == 40
    assert CloudOffers(params, solve(params)).moved({"step": 39}).step == found.steps


@pytest.mark.parametrize("method", ["plane", "point"])
def test_the_registration_comes_nearer(method: str) -> None:
    start = CloudParams(dataset="two-scans", process="register", step=0, method=method)
    before, after = (solve(start.changed({"step": step})).registration for step in (0, 40))
    assert before is not None
    assert after is not None
    assert before.off is not None
    assert after.off is not None
    assert before.off > 0.15
    assert after.off < (0.005 if method == "plane" else before.off / 3.0)
    assert after.rmse is not None
    assert before.rmse is not None
    assert after.rmse < before.rmse
    assert not len(after.unobservable)
    np.testing.assert_allclose(after.T[:3, :3] @ after.T[:3, :3].T, np.eye(3), atol=1e-12)


def test_the_error_is_the_sum_over_the_pairs() -> None:
    params = CloudParams(dataset="two-scans", process="register", step=2, voxel_size=0.1)
    cloud = dataset("two-scans")
    way = course(cloud, derived.thinned(cloud, 0.1), "plane", 16, 0.0, (0.0, 0.0, 0.0), 0.0)
    found = solve(params).registration
    assert way is not None
    assert found is not None
    step = way.steps[2]
    paired = step.target >= 0
    gaps = se3.apply(found.T, way.source[paired]) - way.target[step.target[paired]]
    assert found.error == pytest.approx(float((gaps**2).sum()))
    assert found.pairs == int(paired.sum())
    assert found.fitness == pytest.approx(paired.mean())


def test_one_scan_is_not_registered() -> None:
    assert solve(CloudParams(process="register", step=0)).registration is None


def test_the_ground_is_level_and_its_points_are_near() -> None:
    found = solve(CloudParams(process="ground")).ground
    assert found is not None
    assert found.normal[2] > 0.999
    assert found.inliers > 0.25 * len(dataset("room"))
    assert found.rms < found.distance


def test_two_posts_are_merged_by_large_gaps() -> None:
    street = CloudParams(dataset="street", process="clusters", voxel_size=0.05)
    apart, together = (solve(street.changed({"distance": d})).clusters for d in (0.3, 1.0))
    assert apart is not None
    assert together is not None
    assert apart.without_ground
    assert len(apart.sizes) > len(together.sizes) > 1
    assert apart.sizes == sorted(apart.sizes, reverse=True)


def test_the_statue_has_a_surface() -> None:
    found = solve(CloudParams(dataset="statue", process="surface")).surface
    assert found is not None
    assert 4.0 < found.area < 12.0
    assert len(found.faces) == found.triangles
    assert found.faces.max() < len(found.vertices)


THINNED = {"room": (0.05, 0.1), "street": (0.1, 0.3), "statue": (0.02, 0.03, 0.05, 0.07, 0.1), "two-scans": (0.05, 0.1)}


@pytest.mark.parametrize("name", THINNED)
def test_a_thinned_cloud_has_the_same_surface(name: str) -> None:
    """Cells of the mesh that are about as large as the voxels have one point each, which isn't few."""
    whole = solve(CloudParams(dataset=name, process="surface")).surface
    assert whole is not None
    for voxel in THINNED[name]:
        found = solve(CloudParams(dataset=name, process="surface", voxel_size=voxel)).surface
        assert found is not None
        assert found.area == pytest.approx(whole.area, rel=0.12), voxel
        assert found.triangles * found.cell**2 == pytest.approx(whole.triangles * whole.cell**2, rel=0.35), voxel


def test_a_cloud_with_a_point_in_each_cell_has_a_surface() -> None:
    """A file that was thin before it came; and the volume inside is known."""
    rng = np.random.default_rng(1)
    about, round_ = 2.0 * np.pi * rng.random((2, 60_000))
    kept = rng.random(60_000) < (2.0 + 0.6 * np.cos(round_)) / 2.6  # as many on each piece of the surface
    about, radius, round_ = about[kept], 2.0 + 0.6 * np.cos(round_[kept]), round_[kept]
    points = np.stack([radius * np.cos(about), radius * np.sin(about), 0.6 * np.sin(round_)], axis=1)
    for file in (points, clouds.voxels(points, 0.1).points):
        found = surface(Cloud("torus", file), 0.0, 0.0)
        assert found is not None
        assert found.volume == pytest.approx(2.0 * np.pi**2 * 2.0 * 0.36, rel=0.02)


def test_play_ends_at_the_last_step() -> None:
    params = CloudParams(dataset="two-scans", process="register", voxel_size=0.09)
    steps = play(params)
    assert next(steps).changes == {"step": 0}
    found = solve(params).registration  # which the session does before it goes on
    assert found is not None
    assert list(steps)[-1].changes == {"step": found.steps}
    assert [step.changes["step"] for step in play(CloudParams(process="ground"))] == [0, 0, 1, 1, 2, 2]


def test_a_registration_says_what_it_works_on(rig: Rig) -> None:
    params = show(rig, dataset="two-scans", process="register", step=1)
    found = solve(params).registration
    assert found is not None
    second = int(np.count_nonzero(dataset("two-scans").scan == 1))
    assert found.second_points == second
    assert found.pairs <= found.source_points < second // 4
    assert len(found.reaches) == found.steps + 1
    assert sorted(found.reaches, reverse=True) == found.reaches
    assert found.reaches[0] > 2.0 * found.reaches[-1]
    words = rig.column.html("read")
    for number in (found.source_points, second):
        assert count(number) in words
    assert "coarse to fine" in words
    assert f"from step {found.reaches.index(found.reaches[-1])} on" in words


DISPLACED: dict[str, Any] = {"dataset": "two-scans", "process": "register", "voxel_size": 0.08}


def test_the_second_scan_begins_where_it_is_put(rig: Rig) -> None:
    params = show(rig, **DISPLACED, shift=(0.3, -0.2, 0.1), turn=30.0)
    found = solve(params).registration
    assert found is not None
    both = dataset("two-scans")
    middle = both.points[both.scan == 1].mean(axis=0)
    turn = Rotation.from_euler("z", 30.0, degrees=True).as_matrix()
    moved = turn @ (both.points[-1] - middle) + middle + [0.3, -0.2, 0.1]
    np.testing.assert_allclose(se3.apply(found.T, both.points[-1]), moved, atol=1e-9)
    np.testing.assert_allclose(rig.model.world_pose("/marked"), found.T, atol=1e-6)
    plain = solve(CloudParams(**DISPLACED)).registration
    assert plain is not None
    np.testing.assert_array_equal(plain.T, np.eye(4))


def test_dragging_the_second_scan_moves_it_as_far(rig: Rig) -> None:
    show(rig, **DISPLACED, step=3)
    assert not rig.model.visible("/second"), "ICP has moved it already"
    show(rig, **DISPLACED)
    held = rig.model.world_pose("/second")[:3, 3]
    before = rig.model.world_pose("/marked")
    rig.browser.drag("/second", (held + np.array([0.4, 0.1, -0.2])).tolist())
    rig.settle()
    assert rig.session.params.shift == pytest.approx((0.4, 0.1, -0.2), abs=1e-3)  # type: ignore[attr-defined]
    after = rig.model.world_pose("/marked")
    np.testing.assert_allclose(after[:3, 3] - before[:3, 3], [0.4, 0.1, -0.2], atol=1e-3)
    rig.browser.move("step", 2)
    rig.settle()
    rig.browser.move("shift.0", 0.5)
    rig.settle()
    assert rig.session.params.step == 0, "another start is seen at the start"  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("start", "ends"),
    [({}, "in place"), ({"turn": 180.0}, "in the wrong place"), ({"shift": (40.0, 0.0, 0.0)}, "nowhere")],
)
def test_icp_may_fail(start: dict[str, Any], ends: str) -> None:
    params = CloudParams(**DISPLACED, step=40, **start)
    solution = solve(params)
    found = solution.registration
    assert found is not None
    assert found.off is not None
    assert (found.off < 0.01) == (ends == "in place")
    assert (found.pairs == 0) == (ends == "nowhere")
    assert not (found.converged and ends == "nowhere")
    assert ("wrong place" in SIM.caption(params, solution)) == (ends == "in the wrong place")


# ---- a selected point, its cell, and the way to another


@pytest.mark.parametrize("k", [5, 16, 50])
def test_the_neighbours_of_a_selected_point_are_drawn_with_their_plane(rig: Rig, k: int) -> None:
    params = show(rig, dataset="statue", selected=4711, neighbors=k)
    points = dataset("statue").points
    near = points[cKDTree(points).query(points[4711], k)[1]]
    drawn = rig.model.points("/near/points")
    assert {*map(tuple, np.round(drawn, 4).tolist())} == {*map(tuple, np.round(near, 4).tolist())}
    values = np.linalg.eigvalsh(np.cov(near.T, bias=True))
    chosen = solve(params).selected
    assert chosen is not None
    assert chosen.normal is not None
    np.testing.assert_allclose(chosen.eigenvalues, values, atol=1e-12)
    for value in values:
        assert f"{1e6 * value:.1f}" in rig.column.html("read")
    across = np.sort(np.abs((near - near.mean(axis=0)) @ chosen.normal))
    np.testing.assert_allclose(np.sort(np.abs(chosen.section[:, 1])), across, atol=1e-9)
    assert rig.column.html("pane").count("<circle") == k
    corners = rig.model.node("/near/plane").array("vertices")
    across = (corners - near.mean(axis=0)) @ chosen.normal
    np.testing.assert_allclose(across, 0.0, atol=1e-5)
    show(rig, dataset="statue")
    assert not rig.model.visible("/near/points")
    assert not rig.model.visible("/near/plane")


@pytest.mark.parametrize("name", ["room", "two-scans"])
def test_the_cell_of_a_selected_point_is_drawn_with_what_was_merged(rig: Rig, name: str) -> None:
    params = show(rig, dataset=name, voxel_size=0.2, selected=500)
    chosen = solve(params).selected
    assert chosen is not None
    edges = rig.model.points("/cells/own").reshape(-1, 3)
    cloud = dataset(name)
    scan = cloud.points if not cloud.apart else cloud.points[cloud.scan == 0]
    origin = scan.min(axis=0) - 0.1
    own = np.floor((chosen.position - origin) / 0.2)
    inside = scan[(np.floor((scan - origin) / 0.2) == own).all(axis=1)]
    low = origin + 0.2 * own
    np.testing.assert_allclose([edges.min(axis=0), edges.max(axis=0)], [low, low + 0.2], atol=1e-5)
    assert chosen.merged == len(inside)
    np.testing.assert_allclose(chosen.position, inside.mean(axis=0), atol=1e-4)
    shown = rig.model.points("/cells/points")
    assert cKDTree(shown).query(inside)[0].max() < 1e-5
    assert np.abs(shown - chosen.position).max() < 3.0 * 0.2
    assert rig.model.visible("/cells/near")
    show(rig, dataset=name, selected=1000)
    assert not rig.model.visible("/cells/own")


def test_cells_are_drawn_under_a_pointer_that_passes_and_are_no_state(rig: Rig) -> None:
    show(rig, voxel_size=0.2)
    version, answers = rig.session.version, len(rig.browser.told)
    aim = rig.model.points("/cloud/points")[700]
    eye = np.array([6.0, -6.0, 5.0])

    def passes(ray: tuple[float, ...] | None) -> None:
        rig.host.call(lambda: rig.browser.commands.pass_over(ray))
        rig.settle()

    passes((*eye.tolist(), *(aim - eye).tolist()))
    cell = rig.model.points("/under/own").reshape(-1, 3)
    np.testing.assert_allclose(cell.max(axis=0) - cell.min(axis=0), 0.2, atol=1e-5)
    seen = rig.model.points("/cloud/points")
    inside = ((seen > cell.min(axis=0) - 1e-5) & (seen < cell.max(axis=0) + 1e-5)).all(axis=1)
    assert inside.sum() == 1
    sight = (aim - eye) / np.linalg.norm(aim - eye)
    assert np.linalg.norm(np.cross(sight, seen[inside][0] - eye)) < 0.01 * np.linalg.norm(aim - eye) + 1e-6
    assert rig.session.version == version
    assert [told["type"] for told in rig.browser.told[answers:] if told["type"] != "state"] == ["over"]
    passes(None)
    assert not rig.model.visible("/under/own")
    passes((*eye.tolist(), *(aim - eye).tolist()))
    show(rig, voxel_size=0.21)
    assert not rig.model.visible("/under/own"), "another state has other cells"
    show(rig, voxel_size=0.2, process="ground")
    passes((*eye.tolist(), *(aim - eye).tolist()))
    assert not rig.model.visible("/under/own")
    assert not rig.browser.refused


def test_dots_grow_with_the_cells_and_the_original_is_a_ghost(rig: Rig) -> None:
    show(rig)
    sizes = [rig.model.node("/cloud/points").props["point_size"]]
    assert not rig.model.visible("/original")
    for voxel in (0.1, 0.4):
        show(rig, voxel_size=voxel)
        sizes.append(rig.model.node("/cloud/points").props["point_size"])
        ghost = rig.model.points("/original")
        assert rig.model.visible("/original")
        assert 1_000 < len(ghost) <= 20_000
        assert cKDTree(dataset("room").points).query(ghost)[0].max() < 1e-5
    assert sizes == sorted(sizes)
    assert sizes[2] == pytest.approx(4.0 * sizes[1])
    assert 0.1 < sizes[2] < 0.4, "smaller than the cell"
    show(rig, voxel_size=0.1, show_original=False)
    assert not rig.model.visible("/original")


def test_a_distance_is_measured_between_two_points(rig: Rig) -> None:
    params = show(rig, voxel_size=0.2, selected=10, measure=True, other=900)
    points = rig.model.points("/cloud/points")
    found = solve(params).measured
    assert found is not None
    assert found.distance == pytest.approx(float(np.linalg.norm(points[900] - points[10])), abs=1e-6)
    np.testing.assert_allclose(rig.model.points("/measured").reshape(2, 3), points[[10, 900]], atol=1e-6)
    assert rig.model.labels()["/measured/length"] == quantity(found.distance, "m")
    assert f"{found.distance:.3f}" in rig.column.html("read")
    show(rig, voxel_size=0.2, selected=10, other=900)
    assert not rig.model.visible("/measured"), "measuring is off"


def test_a_click_measures_from_the_selected_point() -> None:
    ray = (4.6, -5.8, 4.4, -0.55, 0.66, -0.51)
    plain = pick(CloudParams(voxel_size=0.1), ray)
    assert list(plain) == ["selected"]
    assert pick(CloudParams(voxel_size=0.1, measure=True), ray) == plain, "nothing to measure from yet"
    assert pick(CloudParams(voxel_size=0.1, measure=True, selected=3), ray) == {"other": plain["selected"]}
    assert CloudParams(measure=True, selected=3, other=4).moved({"voxel_size": 0.1}).other is None


# ---- what means nothing isn't there


@pytest.mark.parametrize(
    ("state", "there"),
    [
        ({}, {"grow"}),
        ({"process": "ground"}, {"step", "play", "distance"}),
        ({"process": "outliers"}, {"step", "play", "deviations"}),
        ({"process": "register"}, {"method", "shift", "turn", "distance"}),
        ({"process": "register", "dataset": "two-scans"}, {"step", "play", "method", "shift", "turn", "distance"}),
        ({"voxel_size": 0.1}, {"grow", "show_original"}),
        ({"measure": True}, {"grow", "other"}),
        ({"dataset": "file"}, {"grow", "units", "columns", "second"}),
    ],
)
def test_controls_stand_there_when_they_mean_something(state: dict[str, Any], there: set[str]) -> None:
    sometimes = {
        "grow", "step", "play", "distance", "deviations", "method", "shift", "turn", "show_original", "other", "units",
        "columns", "second",
    }  # fmt: skip
    params = CloudParams().changed(state)
    page = xml(Column(SIM, (Library(),)).html(params, solve(params)))
    parts = {e.get("data-part", ""): e for e in page.iter() if e.get("data-part")}
    for name in sometimes:
        shown = [
            not any(e.get("hidden") is not None for e in [*part][:1])
            for kind in ("control", "action")
            if (part := parts.get(f"{kind}:{name}")) is not None
        ]
        assert shown == [name in there] * len(shown), name
        assert shown


# ---- depth


@pytest.mark.parametrize("color", ["height", "rgb"])
def test_what_faces_away_from_the_light_is_darker(color: str) -> None:
    statue = CloudParams(dataset="statue", color=color)
    lit, plain = (solve(statue.changed({"shading": on})).drawn.base.colors for on in (True, False))
    share = lit.sum(axis=1) / np.maximum(plain.sum(axis=1), 1)
    vectors = derived.normals(dataset("statue"), 16)
    up, down = (share[vectors[:, 2] * sign > 0.9] for sign in (1.0, -1.0))
    assert np.median(up) > 1.15 * np.median(down)


@pytest.mark.parametrize("color", ["intensity", "normals", "variation"])
def test_where_brightness_says_something_it_is_left_alone(color: str) -> None:
    lit, plain = (solve(CloudParams(color=color, shading=shading)).drawn.base.colors for shading in (True, False))
    np.testing.assert_array_equal(lit, plain)


def test_the_street_opens_by_height_without_alarm() -> None:
    street = CloudParams().moved({"dataset": "street"})
    assert street.color == "height"
    assert street == CloudParams.from_query([("dataset", "street")])
    assert street.query() == "dataset=street"
    assert street.moved({"dataset": "room"}).color == "rgb"
    assert CloudParams(color="intensity").moved({"dataset": "street"}).color == "intensity"
    for params in (street, CloudParams(dataset="street", color="rgb")):
        notes = [each for each in SIM.readouts(params, solve(params)) if isinstance(each, Note)]
        assert {note.level for note in notes} == {"info"}


def test_nothing_is_drawn_before_there_is_a_cloud(rig: Rig) -> None:
    """Solving takes a while at first: rings and planes of nothing aren't there meanwhile."""
    show(rig, dataset="file", file="upload-gone")
    assert not rig.model.visible("/selected/ring0")
    assert not rig.model.visible("/ground_plane/label")


# ---- files


def test_two_files_are_registered_to_each_other() -> None:
    both = dataset("two-scans")
    library = Library()
    names = [library.add(f"scan {k}.ply", ply_bytes(Cloud("", both.points[both.scan == k])))[1]["file"] for k in (0, 1)]
    one = CloudParams().moved({"file": names[0], "dataset": "file"}).moved({"process": "register"})
    assert solve(one, library).registration is None
    two = one.moved({"file": names[1], "dataset": "file"})
    assert (two.file, two.second, two.step) == (names[0], names[1], 0)
    chosen = one.changed({"process": "none"}).moved({"second": names[1]})
    assert chosen.process == "register"
    assert not {"step", "play"} & set(CloudOffers(two, None, library).idle())
    assert set(CloudOffers(two, None, library).options("second")) == {None, names[1]}
    solution = solve(two.moved({"voxel_size": 0.05}).changed({"step": 40}), library)
    found = solution.registration
    assert found is not None
    assert found.off is None, "nobody knows"
    assert solution.points_in == len(both)
    corner = np.array([1.0, 1.0, 1.0])
    assert both.truth is not None
    np.testing.assert_allclose(se3.apply(found.T, corner), se3.apply(both.truth, corner), atol=0.01)
    gone = solve(two.changed({"second": "upload-gone"}), library)
    assert "gone" in gone.trouble


def test_two_files_far_from_their_origin_stay_where_they_are() -> None:
    far = np.array([500_000.0, 4_000_000.0, 100.0])
    first, second = (Cloud("", np.eye(3) + k, origin=far + k * np.eye(3)[0]) for k in (0.0, 2.0))
    pair = first.with_second(second)
    assert pair.origin is not None
    assert second.origin is not None
    np.testing.assert_allclose(pair.points[3:] + pair.origin, second.points + second.origin)


@pytest.mark.parametrize("step", [1, 2])
@pytest.mark.parametrize(("process", "marked"), [("ground", 1), ("outliers", 1), ("clusters", None)])
def test_the_download_has_labels_and_normals(process: str, marked: int | None, step: int) -> None:
    params = CloudParams(dataset="room", process=process, step=step, voxel_size=0.1, show_normals=True)
    mesh = trimesh.load(io.BytesIO(ply(params)), file_type="ply")
    vertex = mesh.metadata["_ply_raw"]["vertex"]["data"]
    solution = solve(params)
    thin = derived.thinned(dataset("room"), 0.1)
    rows = np.concatenate([solution.drawn.base.rows, solution.drawn.marked.rows])
    np.testing.assert_allclose(vertex["x"].ravel(), thin.points[rows, 0])
    wanted = derived.normals(thin, 16)[rows]
    np.testing.assert_allclose(np.stack([vertex[n].ravel() for n in ("nx", "ny", "nz")], axis=1), wanted, atol=1e-6)
    if solution.clusters is not None:
        labels = vertex["label"].ravel()
        assert np.bincount(labels)[1:].tolist() == solution.clusters.sizes
        assert (labels == 0).sum() == solution.clusters.unclustered
    elif marked is not None:
        assert (vertex["label"].ravel() == marked).sum() == len(solution.drawn.marked.rows)


def test_the_download_of_a_surface_is_the_mesh() -> None:
    params = CloudParams(dataset="statue", process="surface", voxel_size=0.05)
    found = solve(params).surface
    assert found is not None
    mesh = trimesh.load(io.BytesIO(ply(params)), file_type="ply", process=False)
    assert isinstance(mesh, trimesh.Trimesh)
    np.testing.assert_array_equal(mesh.faces, found.faces)
    np.testing.assert_allclose(mesh.vertices, found.vertices, atol=1e-6)
    assert mesh.area == pytest.approx(found.area, rel=1e-6)
    again = read("surface.ply", ply(params), 10_000_000)
    np.testing.assert_allclose(again.points, found.vertices)


def test_the_download_is_what_is_shown() -> None:
    params = CloudParams(voxel_size=0.2)
    cloud = read("result.ply", ply(params), 10_000_000)
    np.testing.assert_allclose(cloud.points, shown_points(params).points)
    assert cloud.colors is not None
    assert len(cloud) == solve(params).points_out


# ---- colours


def test_many_colours_are_sent_as_single_ones_are() -> None:
    wanted = np.array([(31, 35, 40), (130, 80, 223), (11, 114, 133), (200, 180, 160)], np.uint8)
    single = [before_tone_mapping("#" + "".join(f"{v:02x}" for v in c)) for c in wanted.tolist()]
    assert np.abs(before_film(wanted).astype(int) - single).max() <= 1
