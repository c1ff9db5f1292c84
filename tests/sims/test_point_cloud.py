"""The point-cloud sim: what is drawn is what the read-outs say, and what others get wrong."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any
from urllib.parse import parse_qsl

import numpy as np
import pytest
from scipy.spatial import cKDTree

from geometry import clouds, se3
from sims.kit.palette import before_film, before_tone_mapping
from sims.kit.scene.view import FIELD
from sims.point_cloud import SIM, CloudParams, derived, processes, solve
from sims.point_cloud import colors as colors_to_send
from sims.point_cloud.actions import pick, play
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.datasets import dataset
from sims.point_cloud.files import read
from sims.point_cloud.offers import CloudOffers
from sims.point_cloud.params import VIEWS
from sims.point_cloud.solution import ply, shown_points
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
    grey = derived.painted(line, line, "variation", 8)
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
    assert 3 < found.steps < processes.MOST_STEPS
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
    way = processes.course(cloud, derived.thinned(cloud, 0.1), "plane", 16, 0.0)
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
        found = processes.surface(Cloud("torus", file), 0.0, 0.0)
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


# ---- files


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
