"""camera: its numbers against OpenCV, what is drawn against its numbers, its hands and its motions."""

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
from scipy.spatial.transform import Rotation

from app.rooms.motion import between
from sims.camera import SIM, CameraParams, CameraSolution, actions, solve
from sims.camera.lens import shown
from sims.camera.solution import LIFT
from sims.camera.window import USUAL, window
from sims.kit import readout
from sims.kit.scene.view import FIELD
from sims.kit.world import NAMES, PLACES, POINTS, SUBJECT, TITLES
from sims.kit.world_drawing import PAINTER, PAINTS
from tests.server import Rig
from tests.sims.markup import words, xml

Array = npt.NDArray[np.float64]
START = CameraParams()
C = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
"""Columns are the level camera's axes in the world."""
states = st.builds(
    CameraParams,
    fx=st.floats(100, 2000),
    fy=st.floats(100, 2000),
    cx=st.floats(0, 640),
    cy=st.floats(0, 480),
    skew=st.floats(-200, 200),
    position=st.tuples(st.floats(-20, 20), st.floats(-20, 20), st.floats(0, 20)),
    pan=st.floats(-180, 180),
    tilt=st.floats(-90, 90),
    roll=st.floats(-180, 180),
    projection=st.sampled_from(["perspective", "orthographic", "weak"]),
    selected=st.sampled_from(NAMES),
)


def pose(p: CameraParams) -> tuple[Array, Array]:
    """R and t of the contract, by SciPy."""
    turn = [
        Rotation.from_euler(a, v, degrees=True).as_matrix() for a, v in zip("zxz", (p.pan, p.tilt, p.roll), strict=True)
    ]
    R = (turn[0] @ C @ turn[1] @ turn[2]).T
    return R, -R @ np.array(p.position)


def intrinsics(p: CameraParams) -> Array:
    return np.array([[p.fx, p.skew, p.cx], [0.0, p.fy, p.cy], [0.0, 0.0, 1.0]])


# ---- numbers


@given(states)
def test_matrices_are_those_of_the_contract(p: CameraParams) -> None:
    s = solve(p)
    R, t = pose(p)
    np.testing.assert_allclose(s.K, intrinsics(p), rtol=1e-15)
    np.testing.assert_allclose(s.R, R, rtol=0, atol=1e-12)
    np.testing.assert_allclose(s.t, t, rtol=0, atol=1e-12)
    np.testing.assert_allclose(s.center, -R.T @ t, rtol=0, atol=1e-12)
    if p.projection == "perspective":
        assert s.P is not None
        np.testing.assert_allclose(s.P, intrinsics(p) @ np.column_stack([R, t]), rtol=0, atol=1e-9)
        assert s.decomposed is not None
        np.testing.assert_allclose(s.decomposed.K, s.K, rtol=1e-9, atol=1e-7)
        np.testing.assert_allclose(s.decomposed.R, s.R, rtol=0, atol=1e-9)
        np.testing.assert_allclose(s.decomposed.center, s.center, rtol=0, atol=1e-7)
    else:
        assert s.decomposed is None


@given(states)
def test_pixels_are_opencvs_and_only_what_is_in_front_has_one(p: CameraParams) -> None:
    p = p.changed({"projection": "perspective", "skew": 0.0})
    R, t = pose(p)
    in_camera = POINTS @ R.T + t  # OpenCV's own rotation vectors lose half of the digits near half a turn
    theirs = cv2.projectPoints(in_camera, np.zeros(3), np.zeros(3), intrinsics(p), None)[0].reshape(-1, 2)
    depths = in_camera[:, 2]
    for point, pixel, depth in zip(solve(p).points, theirs, depths, strict=True):
        assert point.depth == pytest.approx(depth, abs=1e-9)
        if abs(depth) < 1e-3:
            continue
        assert (point.pixel is None) == (depth <= 0.0)
        if point.pixel is not None:
            np.testing.assert_allclose(point.pixel, pixel, rtol=1e-7, atol=1e-5)
            u, v = point.pixel
            assert point.in_image == (-0.5 <= u <= 639.5 and -0.5 <= v <= 479.5)


@given(states)
def test_p_maps_every_named_point_to_its_pixel(p: CameraParams) -> None:
    s = solve(p)
    for name, point in zip(NAMES, s.points, strict=True):
        assert point.world == PLACES[name]
        assert point.name == name
        np.testing.assert_allclose(point.camera, s.R @ point.world + s.t, rtol=0, atol=1e-10)
        if point.pixel is not None and point.depth > 1e-3:
            assert s.P is not None
            a, b, w = s.P @ [*point.world, 1.0]
            np.testing.assert_allclose((a / w, b / w), point.pixel, rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize(("cx", "cy", "fx", "fy"), [(320, 240, 600, 600), (0, 480, 300, 900), (640, 10, 2000, 100)])
def test_fields_of_view_are_those_of_the_off_centre_frustum(cx: float, cy: float, fx: float, fy: float) -> None:
    s = solve(START.changed({"cx": cx, "cy": cy, "fx": fx, "fy": fy}))
    across = math.atan2(639.5 - cx, fx) + math.atan2(cx + 0.5, fx)
    down = math.atan2(479.5 - cy, fy) + math.atan2(cy + 0.5, fy)
    assert (s.fov_x, s.fov_y) == pytest.approx((math.degrees(across), math.degrees(down)), abs=1e-12)


def upright(s: CameraSolution, which: str) -> float:
    """Height of a post in the picture."""
    foot, top = (s.point(f"{which}-{end}").pixel for end in ("foot", "post"))
    assert foot is not None
    assert top is not None
    return foot[1] - top[1]


def test_without_perspective_near_and_far_posts_are_as_tall() -> None:
    ratios = {}
    for kind in ("perspective", "orthographic", "weak"):
        s = solve(START.changed({"projection": kind}))
        ratios[kind] = upright(s, "near") / upright(s, "far")
    assert ratios["orthographic"] == pytest.approx(1.0)
    assert ratios["weak"] == pytest.approx(1.0)
    assert ratios["perspective"] > 1.8


@pytest.mark.parametrize("changes", [{}, {"pan": 30, "cx": 100}, {"position": (2, -6, 3), "tilt": -10, "skew": 50}])
def test_weak_perspective_keeps_sizes_at_the_mean_depth_of_what_is_in_front(changes: dict[str, Any]) -> None:
    p = START.changed({**changes, "projection": "weak"})
    R, t = pose(p)
    depths = (POINTS @ R.T + t)[:, 2]
    mean = depths[depths > 0.0].mean()
    s = solve(p)
    assert s.scale_depth == pytest.approx(mean)
    assert s.scale == pytest.approx(p.fx / mean)
    assert s.P is not None
    np.testing.assert_allclose(s.P[2], [0, 0, 0, 1], rtol=0, atol=0)
    np.testing.assert_allclose(s.P[:2, :3], intrinsics(p)[:2, :2] @ R[:2] / mean, rtol=1e-12, atol=1e-12)


def test_one_point_behind_the_camera_changes_nothing_of_weak_perspective() -> None:
    behind = solve(START.changed({"projection": "weak"})).point("back-post")
    assert behind.depth < 0.0
    depths = [point.depth for point in solve(START).points if point is not behind and point.depth > 0.0]
    assert solve(START.changed({"projection": "weak"})).mean_depth == pytest.approx(np.mean(depths))


@pytest.mark.parametrize("scale", [40.0, 100.0, 350.0])
def test_an_orthographic_scale_is_the_same_from_everywhere(scale: float) -> None:
    """It was divided by the house's depth: moving back shrank the picture, which is weak perspective."""
    heights = []
    for y in (-4.0, -8.0, -16.0):
        for fx in (300.0, 900.0):
            p = START.changed({"projection": "orthographic", "position": (0, y, 1.2), "fx": fx, "fy": fx})
            p = p.changed({"ortho_scale": scale})
            s = solve(p)
            R, _ = pose(p)
            assert s.scale == scale
            assert s.P is not None
            np.testing.assert_allclose(s.P[:2, :3], scale * R[:2], rtol=0, atol=1e-10)
            heights.append(upright(s, "near"))
    np.testing.assert_allclose(heights, scale, rtol=1e-12)  # the post is a metre tall
    weak = [solve(START.changed({"projection": "weak", "position": (0, y, 1.2)})) for y in (-4.0, -8.0, -16.0)]
    assert np.all(np.diff([upright(s, "near") for s in weak]) < -10.0)


def test_an_orthographic_picture_keeps_skew_and_the_shape_of_pixels() -> None:
    p = START.changed({"projection": "orthographic", "fx": 800, "fy": 400, "skew": 80, "ortho_scale": 200})
    s = solve(p)
    x, y, _ = s.point("near-post").camera
    assert s.point("near-post").pixel == pytest.approx((200 * x + 20 * y + 320, 100 * y + 240))


@given(states)
def test_every_state_has_an_answer(p: CameraParams) -> None:
    s = solve(p)
    exists = p.projection != "weak" or any(point.depth > 0.05 for point in s.points)
    assert (s.P is not None) == exists == (s.frustum is not None) == (s.seen is not None)
    for _, corners in s.seen.faces if s.seen else ():
        u, v = np.array(corners).T
        assert ((u > -3.6) & (u < 642.6) & (v > -3.6) & (v < 482.6)).all()
    for html in (readout.render(SIM.readouts(p, s)), SIM.panes(p, s)[0].svg):  # type: ignore[misc]
        assert "nan" not in html.lower()


@given(states)
def test_faces_in_the_picture_are_pieces_of_the_projected_faces(p: CameraParams) -> None:
    """Each corner is a corner of the face or lies on one of its edges, or where the frame or the camera cuts it off."""
    s = solve(p)
    for number, corners in s.seen.faces if s.seen else ():
        assert s.P is not None
        face = np.column_stack([PAINTER.faces[number], np.ones(len(PAINTER.faces[number]))]) @ s.P.T
        for u, v in corners:
            if not (-3.4 < u < 642.4 and -3.4 < v < 482.4):
                continue
            lines = np.cross(face, np.roll(face, -1, axis=0))
            lines = lines / np.linalg.norm(lines[:, :2], axis=1, keepdims=True)
            assert np.abs(lines @ [u, v, 1.0]).min() < 1e-3


def test_parallels_of_the_street_meet_at_its_vanishing_points() -> None:
    p = START.changed({"tilt": -12, "pan": 10, "roll": 5, "skew": 30})
    s = solve(p)
    assert s.P is not None
    pairs = {"along": ("eave-near-left", "eave-far-left"), "across": ("eave-near-left", "eave-near-right"),
             "up": ("wall-near-left", "eave-near-left")}  # fmt: skip
    for meet in s.vanishing:
        first, second = (s.P @ [*PLACES[name], 1.0] for name in pairs[meet.name])
        line = np.cross(first, second)
        assert meet.homogeneous is not None
        assert abs(line @ meet.homogeneous) < 1e-9 * np.linalg.norm(line) * np.linalg.norm(meet.homogeneous)
        assert meet.pixel is not None
    level = {meet.name: meet for meet in solve(START).vanishing}
    assert level["up"].pixel is None
    assert level["along"].in_image
    assert not level["across"].in_image


# ---- what is drawn


@pytest.fixture(scope="module")
def rig() -> Iterator[Rig]:
    with Rig(SIM) as rig:
        yield rig


def drawn_states(count: int = 20) -> list[CameraParams]:
    """Named states, and random ones near enough to see something."""
    random = np.random.default_rng(3)
    found = [START, *(START.changed(changes) for changes in SIM.states.values())]
    for k in range(count):
        x, y, z = random.uniform((-3, -7, 0.2), (3, 0, 3)).tolist()
        found.append(
            START.changed(
                {
                    "fx": random.uniform(100, 2000),
                    "fy": random.uniform(100, 2000),
                    "cx": random.uniform(0, 640),
                    "cy": random.uniform(0, 480),
                    "skew": random.uniform(-200, 200),
                    "position": (x, y, z),
                    "pan": random.uniform(-60, 60),
                    "tilt": random.uniform(-40, 40),
                    "roll": random.uniform(-180, 180),
                    "projection": ("perspective", "perspective", "orthographic", "weak")[k % 4],
                    "selected": NAMES[k % len(NAMES)],
                }
            )
        )
    return found


each_drawn = pytest.mark.parametrize("p", drawn_states(), ids=lambda p: p.query() or "defaults")


def sight_line(p: CameraParams, place: Array) -> tuple[Array, Array]:
    """A place on the line of sight of a place in the picture as it is drawn, and its direction."""
    if p.projection == "perspective":
        return np.array(p.position), place - np.array(p.position)
    return place, pose(p)[0][2]


def real(p: CameraParams, places: Array) -> Array:
    """Pixels of places in the picture as it is shown, which is 640 wide."""
    return np.asarray((places + 0.5) * p.width / 640 - 0.5)


def miss(start: Array, direction: Array, point: Array) -> float:
    """How far a line passes by a point."""
    unit = direction / np.linalg.norm(direction)
    gap = point - start
    return float(np.linalg.norm(gap - unit * (unit @ gap)))


@each_drawn
def test_camera_and_grips_are_where_the_numbers_say(rig: Rig, p: CameraParams) -> None:
    rig.show(p)
    R, _ = pose(p)
    drawn = rig.model.world_pose("/camera")
    np.testing.assert_allclose(drawn[:3, :3], R.T, rtol=0, atol=1e-9)
    np.testing.assert_allclose(drawn[:3, 3], p.position, rtol=0, atol=1e-12)
    np.testing.assert_allclose(rig.model.world_pose("/camera/axes/arrows"), drawn, rtol=0, atol=1e-12)
    np.testing.assert_allclose(rig.model.world_pose("/eye")[:3, 3] - (0, 0, LIFT), p.position, rtol=0, atol=1e-12)
    look = rig.model.world_pose("/look")[:3, 3] - p.position
    np.testing.assert_allclose(look / np.linalg.norm(look), R[2], rtol=0, atol=1e-9)
    np.testing.assert_allclose(rig.model.world_pose("/selected")[:3, 3], PLACES[p.selected], rtol=0, atol=1e-12)


@each_drawn
def test_lines_of_sight_through_drawn_image_points_hit_their_points(rig: Rig, p: CameraParams) -> None:
    rig.show(p)
    s = solve(p)
    seen = [point for point in s.points if point.in_image]
    if s.frustum is None:
        assert not rig.model.visible("/camera/dots")
        assert not rig.model.visible("/camera/ray")
        return
    outside = not p.through
    assert rig.model.visible("/camera/dots") == outside
    dots = rig.model.points("/camera/dots").reshape(-1, 3)
    assert len(dots) == len(seen)
    for dot, point in zip(dots, seen, strict=True):
        assert miss(*sight_line(p, dot), np.array(point.world)) < 1e-6 * max(1.0, point.depth)
    assert rig.model.visible("/camera/rays") == (bool(seen) and p.show_rays and outside)
    if seen and p.show_rays and outside:
        rays = rig.model.points("/camera/rays").reshape(-1, 2, 3)
        np.testing.assert_allclose(rays[:, 1], [point.world for point in seen], rtol=0, atol=2e-6)
    chosen = s.point(p.selected)
    there = chosen.pixel is not None and outside
    assert rig.model.visible("/camera/ray") == there == rig.model.visible("/camera/dot")
    if there:
        dot = rig.model.world_pose("/camera/dot")[:3, 3]
        assert miss(*sight_line(p, dot), np.array(chosen.world)) < 1e-6
        start, end = rig.model.points("/camera/ray")[0]
        np.testing.assert_allclose(end, chosen.world, rtol=0, atol=4e-6)
        assert miss(start, end - start, dot) < 1e-5
        if p.projection == "perspective":
            np.testing.assert_allclose(start, p.position, rtol=0, atol=1e-12)


@each_drawn
def test_frustum_and_picture_are_the_true_ones(rig: Rig, p: CameraParams) -> None:
    rig.show(p)
    s = solve(p)
    there = s.frustum is not None and not p.through
    assert rig.model.visible("/camera/picture") == there == rig.model.visible("/camera/frustum")
    if s.frustum is None:
        return
    R, t = pose(p)

    def pixels(places: Array) -> Array:
        """By the camera's own K: on the picture itself, at its depth or, without perspective, at the one depth."""
        axes = places.reshape(-1, 3) @ R.T + t
        flat = axes[:, :2] / (p.fx / s.scale if s.scale else axes[:, 2:])
        return np.asarray(np.column_stack([flat, np.ones(len(flat))]) @ intrinsics(p)[:2].T)

    right, bottom = p.width - 0.5, p.height - 0.5
    frame = [(-0.5, -0.5), (right, -0.5), (right, bottom), (-0.5, bottom)]
    corners = rig.model.points("/camera/picture").reshape(-1, 3)
    np.testing.assert_allclose(pixels(corners), frame, rtol=0, atol=2e-3)
    edges = rig.model.points("/camera/frustum").reshape(-1, 2, 3)
    np.testing.assert_allclose(pixels(edges[:4, 1]), frame, rtol=0, atol=2e-3)
    if p.projection == "perspective":
        np.testing.assert_allclose(edges[:4, 0], np.tile(p.position, (4, 1)), rtol=0, atol=1e-6)
    else:
        along = edges[:4, 1] - edges[:4, 0]
        np.testing.assert_allclose(along, np.tile(s.frustum.depth * R[2], (4, 1)), rtol=0, atol=1e-5)
    assert s.seen is not None
    edges = (s.straight or s.seen).outlines()
    assert rig.model.visible("/camera/wires") == (len(edges) > 0 and not p.through)
    if len(edges) and not p.through:
        drawn = rig.model.points("/camera/wires").reshape(-1, 3)
        np.testing.assert_allclose(pixels(drawn), real(p, edges.reshape(-1, 2)), rtol=0, atol=5e-3 * p.width / 640)


@each_drawn
def test_the_picture_beside_the_scene_shows_the_same_pixels(rig: Rig, p: CameraParams) -> None:
    rig.show(p)
    s = solve(p)
    marks = {e.get("data-link"): e for e in xml(rig.column.html("pane")).iter("g") if e.get("data-link")}
    assert set(marks) == {point.name for point in s.points if point.pixel is not None}
    for point in s.points:
        if point.in_image:
            found = re.findall(r"[-\d.]+", str(marks[point.name].get("transform")))
            assert point.pixel is not None
            assert tuple(map(float, found)) == pytest.approx(shown(p, point.pixel), rel=0, abs=0.006)
        elif point.pixel is not None:
            assert next(marks[point.name].iter("path")) is not None, "an arrowhead at the border"
    assert "∞" in rig.column.html("pane") or all(m.pixel or not m.homogeneous for m in s.vanishing)


def test_the_little_world_stands_on_the_ground_in_the_scene(rig: Rig) -> None:
    assert rig.model.world_pose("/ground")[2, 3] == 0.0
    drawn = {paint: rig.model.points(f"/things/{paint}").reshape(-1, 3) for paint in PAINTS}
    assert min(places[:, 2].min() for places in drawn.values()) == 0.0
    corners = np.concatenate(list(drawn.values()))
    for place in POINTS:
        assert np.linalg.norm(corners - place, axis=1).min() < 1e-6
    assert len(corners) == sum(len(face) for face in PAINTER.faces)


# ---- selection


def test_a_point_is_selected_in_the_scene_and_lights_up_everywhere(rig: Rig) -> None:
    rig.show(START)
    rig.browser.click("/points/far-post")
    rig.settle()
    assert rig.session.params.selected == "far-post"  # type: ignore[attr-defined]
    chosen = [e for e in xml(rig.column.html("pane")).iter() if "s3-selected" in str(e.get("class"))]
    assert [e.get("data-link") for e in chosen] == ["far-post"]
    rows = [e for e in xml(rig.column.html("read")).iter("tr") if e.get("class") == "s3-selected"]
    assert [e.get("data-link") for e in rows] == ["far-post"]
    np.testing.assert_allclose(rig.model.world_pose("/selected")[:3, 3], PLACES["far-post"])
    assert rig.model.labels()["/selected/label"] == TITLES["far-post"].lower()


def test_what_is_pointed_at_in_picture_or_table_lights_up_in_the_scene_and_passes(rig: Rig) -> None:
    rig.show(START)
    assert not rig.model.visible("/lit")
    for name in ("cube-far", "near-foot"):
        rig.host.call(lambda name=name: rig.session.hover(name))  # type: ignore[misc]
        rig.settle()
        assert rig.model.visible("/lit")
        np.testing.assert_allclose(rig.model.world_pose("/lit")[:3, 3], PLACES[name])
    for name in ("", "nobody"):
        rig.host.call(lambda name=name: rig.session.hover(name))  # type: ignore[misc]
        rig.settle()
        assert not rig.model.visible("/lit")
    assert rig.session.params == START, "pointing changes nothing"


def test_what_is_lit_stays_lit_while_the_camera_moves(rig: Rig) -> None:
    rig.show(START)
    rig.host.call(lambda: rig.session.hover("cube-far"))
    rig.change(pan=20.0)
    rig.settle()
    assert rig.model.visible("/lit")
    rig.host.call(lambda: rig.session.hover(""))
    rig.settle()
    assert not rig.model.visible("/lit")


def test_every_point_can_be_clicked_and_its_row_pressed(rig: Rig) -> None:
    rig.show(START)
    for name in NAMES:
        assert rig.model.node(f"/points/{name}").clicks
        np.testing.assert_allclose(rig.model.world_pose(f"/points/{name}")[:3, 3], PLACES[name])
    rows = [e.get("data-link") for e in xml(rig.column.html("read")).iter("tr") if e.get("data-link")]
    assert rows == list(NAMES)


def test_somebody_who_watches_selects_nothing() -> None:
    with Rig(SIM, watching=True) as rig:
        rig.browser.click("/points/far-post")
        rig.settle()
        assert rig.session.params == START


# ---- words


def test_a_point_that_is_not_in_front_is_said_to_have_no_pixel() -> None:
    behind = START.changed({"selected": "back-post"})
    text = words(readout.render(SIM.readouts(behind, solve(behind))))
    assert "not in front of the camera, so there is no pixel" in text
    assert "Pixel: K x" not in text
    in_plane = START.changed({"position": (0.0, PLACES["near-post"][1], 1.2), "selected": "near-post"})
    s = solve(in_plane)
    assert s.point("near-post").depth == 0.0
    assert s.point("near-post").pixel is None


def test_the_chosen_point_is_worked_through_step_by_step() -> None:
    p = START.changed({"selected": "near-post", "skew": 40, "pan": 7})
    text = words(readout.render(SIM.readouts(p, solve(p)))).replace("−", "-")
    R, t = pose(p)
    axes = R @ PLACES["near-post"] + t
    x = axes / axes[2]
    pixel = intrinsics(p) @ x
    for numbers, digits in ((axes, 3), (x[:2], 3), (pixel[:2], 2)):
        assert " , ".join(f"{v:.{digits}f}" for v in numbers) in text


def test_two_points_with_one_pixel_are_pointed_out() -> None:
    a, b = np.array(PLACES["near-post"]), np.array(PLACES["far-post"])
    at = a + (a - b) / np.linalg.norm(a - b) * 2.0
    p = START.changed({"position": tuple(at.tolist()), "selected": "near-post"})
    p = p.changed(actions.turned_to(p, tuple(b.tolist())))
    assert "Far post, top has the same pixel" in words(readout.render(SIM.readouts(p, solve(p))))


def test_a_projection_without_scale_says_so_and_the_rest_goes_on() -> None:
    p = START.changed(SIM.states["no scale"])
    s = solve(p)
    assert s.P is None
    assert all(point.pixel is None for point in s.points)
    assert "No picture: its scale comes from" in words(readout.render(SIM.readouts(p, s)))


# ---- hands


def test_focal_lengths_move_together_while_they_are_linked(rig: Rig) -> None:
    rig.show(START.changed({"fy": 300}))
    rig.browser.move("fx", 900)
    rig.settle()
    assert (rig.session.params.fx, rig.session.params.fy) == (900.0, 450.0)  # type: ignore[attr-defined]
    rig.browser.move("fy", 600)
    rig.settle()
    assert rig.session.params.fx == pytest.approx(1200.0)  # type: ignore[attr-defined]
    rig.browser.move("linked", False)
    rig.browser.move("fx", 500)
    rig.settle()
    p = rig.session.params
    assert (p.fx, p.fy) == (500.0, 600.0)  # type: ignore[attr-defined]
    assert CameraParams.from_query(parse_qsl(p.query())) == p


def test_a_link_sets_one_focal_length_alone() -> None:
    p = CameraParams.from_query([("fx", "900")])
    assert (p.fx, p.fy, p.linked) == (900.0, 600.0, True)


def test_grips_move_and_turn_the_camera_and_the_numbers_agree(rig: Rig) -> None:
    rig.show(START.changed({"roll": 20}))
    rig.browser.drag("/eye", (0.5, -4.5, 1.5), (1.0, -5.0, 2.0 + LIFT))
    rig.settle()
    p = rig.session.params
    assert isinstance(p, CameraParams)
    assert p.position == pytest.approx((1.0, -5.0, 2.0))
    aim = (2.0, 1.0, 0.5)
    rig.browser.drag("/look", aim)
    rig.settle()
    p = rig.session.params
    assert isinstance(p, CameraParams)
    toward = np.array(aim) - p.position
    np.testing.assert_allclose(pose(p)[0][2], toward / np.linalg.norm(toward), rtol=0, atol=1e-9)
    assert p.roll == 20.0
    assert rig.column.values["pan"] == pytest.approx(p.pan)
    assert rig.column.values["tilt"] == pytest.approx(p.tilt)
    np.testing.assert_allclose(rig.model.world_pose("/camera")[:3, :3], pose(p)[0].T, rtol=0, atol=1e-9)


def test_the_camera_stays_where_it_can_be(rig: Rig) -> None:
    rig.show(START)
    rig.browser.drag("/eye", (30.0, -50.0, -3.0))
    rig.settle()
    assert rig.session.params.position == (20.0, -20.0, 0.0)  # type: ignore[attr-defined]
    rig.browser.drag("/look", (20.0, -20.0, 0.0))
    rig.settle()
    assert not rig.problems()


def test_the_principal_point_is_moved_in_the_picture(rig: Rig) -> None:
    rig.show(START)
    rig.host.call(lambda: rig.session.drag("principal", (100.0, 400.0)))
    rig.settle()
    s = solve(rig.session.params)  # type: ignore[arg-type]
    assert s.K[:2, 2].tolist() == [100.0, 400.0]


@given(states)
def test_looking_at_the_subject_puts_it_on_the_principal_point(p: CameraParams) -> None:
    for step in actions.look(p):
        p = p.changed(step.changes)
    p = p.changed({"projection": "perspective"})
    subject = solve(p).subject
    assert subject.depth > 0.0
    assert subject.pixel == pytest.approx((p.cx, p.cy), rel=0, abs=1e-4)


def test_looking_turns_the_shorter_way_round() -> None:
    p = START.changed({"position": (-1.0, 6.0, 1.0), "pan": -170})
    pans = [step.changes["pan"] for step in actions.look(p)]
    ways = [abs(b - a) for a, b in itertools.pairwise([p.pan, *pans])]
    assert sum(way for way in ways if way != 360.0) < 180.0


# ---- dolly zoom


def height(p: CameraParams) -> float:
    R, t = pose(p)
    a, b = (intrinsics(p) @ (R @ end + t) for end in SUBJECT)
    return float(np.linalg.norm(a[:2] / a[2] - b[:2] / b[2]))


def frames(p: CameraParams) -> Iterator[CameraParams]:
    """Every state that a browser may see on the way: each leg, in twelfths."""
    for step in actions.dolly_zoom(p):
        start = p
        for fraction in np.linspace(0.0, 1.0, 13).tolist():
            p = start.moved({k: between(getattr(start, k), v, fraction) for k, v in step.changes.items()})
            yield p


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"fx": 300, "fy": 300},
        {"cx": 100, "cy": 400, "skew": 60, "fy": 700},
        {"position": (-4, -5, 4), "pan": -25, "tilt": -25},
        {"roll": 70, "tilt": 10},
        {"pan": 30},
        {"fx": 2000, "fy": 1500},
        {"fx": 120, "fy": 110},
    ],
)
def test_dolly_zoom_keeps_the_house_as_tall_within_half_a_pixel(changes: dict[str, Any]) -> None:
    start = START.changed(changes)
    wanted = height(start)
    way = list(frames(start))
    assert len(way) > 50
    assert max(abs(height(p) - wanted) for p in way) < 0.5
    end = way[-1]
    assert math.dist(end.position, start.position) > 1.0
    assert end.fx / start.fx == pytest.approx(end.fy / start.fy)
    axis = pose(start)[0][2]
    assert miss(np.array(start.position), axis, np.array(end.position)) < 1e-9, "it moves along the optical axis"
    assert solve(end).subject.height == pytest.approx(wanted, abs=0.5)


def test_dolly_zoom_first_looks_where_the_subject_is_out_of_sight() -> None:
    way = list(frames(START.changed({"pan": 180})))
    looked = next(k for k, p in enumerate(way) if solve(p).subject.depth > 0.5 and p.pan == way[-1].pan)
    wanted = height(way[looked])
    assert max(abs(height(p) - wanted) for p in way[looked:]) < 0.5


@given(states)
def test_actions_end_in_states_from_everywhere(p: CameraParams) -> None:
    for action in (actions.look, actions.dolly_zoom):
        state = p
        for step in action(p):
            state = state.changed(step.changes)
        assert SIM.describe(state, solve(state))


# ---- the column


def chain(p: CameraParams) -> list[list[str]]:
    """Each step of the line over the picture: what leads to it, what it is, its numbers."""
    (pane,) = SIM.panes(p, solve(p)) if SIM.panes else ()
    return [[str(part.text) for part in step] for step in xml(pane.line).iter("li")]


def test_the_line_over_the_picture_leads_from_the_world_to_the_pixel() -> None:
    p = START.changed({"selected": "near-post", "skew": 40, "pan": 7, "fy": 500})
    R, t = pose(p)
    axes = R @ PLACES["near-post"] + t
    pixel = intrinsics(p) @ (axes / axes[2])
    steps = chain(p)
    assert [what for *_, what, _ in steps] == ["world, m", "camera, m", "normalised", "pixel"]
    assert [by for by, *_ in steps[1:]] == ["R, t", "÷ z", "K"]
    places = (PLACES["near-post"], axes, axes[:2] / axes[2], pixel[:2])
    for (*_, said), numbers, digits in zip(steps, places, (2, 2, 2, 1), strict=True):
        assert said == f"({', '.join(readout.figure(v, digits) for v in numbers)})"


def test_the_line_says_what_each_projection_does_and_where_there_is_no_pixel() -> None:
    steps = chain(START.changed({"projection": "orthographic", "selected": "near-post", "ortho_scale": 200}))
    assert [by for by, *_ in steps[1:]] == ["R, t", "no z", "×"]
    x, y = (float(v.replace("−", "-")) for v in steps[2][-1].strip("()").split(", "))
    u, v = (float(v) for v in steps[3][-1].strip("()").split(", "))
    assert (u, v) == pytest.approx((200 * x + 320, 200 * y + 240), abs=1.1)
    assert chain(START.changed({"projection": "weak"}))[2][0] == "÷ mean z"
    assert chain(START.changed({"k1": -0.2}))[3][0] == "lens"
    assert chain(START.changed({"selected": "back-post"}))[-1] == ["pixel", "⚠ behind"]


def test_few_controls_are_in_sight() -> None:
    first = [name for name in CameraParams.visible if not CameraParams.kinds[name].group]
    assert first == ["through", "projection", "fx", "position", "pan", "tilt"]
    assert [action.name for action in SIM.actions if not action.group] == ["dolly-zoom"]


# ---- through the camera


@pytest.mark.parametrize("projection", ["perspective", "orthographic", "weak"])
def test_through_the_camera_the_window_holds_the_whole_picture(projection: str) -> None:
    p = START.changed({"through": True, "projection": projection, "cx": 150, "pan": 20, "roll": 35, "tilt": -15})
    s, (R, _) = solve(p), pose(p)
    w = window(p, s)
    ahead = np.subtract(w.look_at, w.position)
    np.testing.assert_allclose(ahead / np.linalg.norm(ahead), R[2], rtol=0, atol=1e-9)
    np.testing.assert_allclose(w.up, -R[1], rtol=0, atol=1e-12)
    assert s.frustum is not None
    corners = (s.frustum.corners @ R + p.position - w.position) @ R.T
    slopes = np.abs(corners[:, :2] / corners[:, 2:])
    np.testing.assert_allclose(slopes.max(axis=0), w.half, rtol=1e-9)
    assert (p.position == pytest.approx(w.position)) == (projection == "perspective")
    for point in s.points:  # seen from there, a point is where the picture has it
        if point.pixel is not None and point.in_image:
            x, y, z = R @ (np.array(point.world) - w.position)
            place = (np.array((x, y)) / z - corners[0, :2] / corners[0, 2]) / np.ptp(
                corners[:, :2] / corners[:, 2:], axis=0
            )
            pixel = place * (p.width, p.height) - 0.5
            assert pixel == pytest.approx(point.pixel, abs=1e-6 if projection == "perspective" else 8.0)


def test_the_view_of_who_looks_through_is_just_there_and_the_usual_one_afterwards() -> None:
    p = START.changed({"position": (0, -18, 1.2)})
    through = p.changed({"through": True})
    home = SIM.home(through, solve(through))
    assert (home.position, home.radius) == (p.position, 0.0)
    assert SIM.home(p, solve(p)).radius > USUAL.radius
    assert SIM.home(START, solve(START)) == USUAL


def test_who_looks_through_sees_neither_the_camera_nor_its_grips(rig: Rig) -> None:
    rig.show(START.changed({"through": True}))
    for node in ("/eye", "/look", "/camera/body", "/camera/lens", "/camera/axes", "/camera/rays", "/camera/frustum"):
        assert not rig.model.visible(node), node
    assert rig.model.visible("/camera/frame")
    assert rig.model.visible("/things/wall")
    rig.show(START)
    for node in ("/eye", "/look", "/camera/body", "/camera/lens", "/camera/axes", "/camera/rays", "/camera/frustum"):
        assert rig.model.visible(node), node
    assert not rig.model.visible("/camera/frame")


@pytest.mark.parametrize("aspect", [0.94, 0.64, 1.5])
def test_the_camera_is_in_sight_wherever_it_is_beside_a_large_picture(aspect: float) -> None:
    """At x = 7 m it had gone behind the column."""
    half = math.tan(0.5 * FIELD) * np.array((aspect, 1.0))
    for x, y, z in itertools.product((-9.0, -5.0, 0.0, 5.0, 9.0), (-9.0, -4.0, 0.0, 4.0), (0.0, 1.2, 6.0)):
        p = START.changed({"position": (x, y, z)})
        home = SIM.home(p, solve(p))
        back = np.subtract(home.position, home.look_at)
        back = back / np.linalg.norm(back)
        eye = home.look_at + back * home.radius / math.sin(math.atan(half.min()))
        right = np.cross(-back, (0.0, 0.0, 1.0))
        right = right / np.linalg.norm(right)
        for place in (p.position, (x, y, z + LIFT)):
            away = np.subtract(place, eye)
            slopes = np.abs([right @ away, np.cross(right, -back) @ away]) / (-back @ away)
            assert (slopes < half).all(), (x, y, z, slopes / half)
