"""coordinate-frames: what is drawn is handed as it is labelled, and the point and the car stay where they are."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sims.coordinate_frames import SIM, FramesParams, FramesSolution, solve
from sims.coordinate_frames.conventions import NAMES, Convention
from sims.coordinate_frames.meshes import hand
from sims.coordinate_frames.solution import ARROW, IN_VIEW
from sims.kit.readout import figure
from sims.kit.sim import Step
from tests.frames import SceneModel
from tests.server import Rig

Array = npt.NDArray[np.float64]
DIRECTIONS = {
    "right": (1, 0, 0),
    "left": (-1, 0, 0),
    "forward": (0, 1, 0),
    "back": (0, -1, 0),
    "up": (0, 0, 1),
    "down": (0, 0, -1),
}
ON_PAPER: dict[Convention, tuple[str, str, str, str]] = {
    "opengl": ("right", "up", "back", "right"),
    "directx": ("right", "up", "forward", "left"),
    "ros": ("forward", "left", "up", "right"),
    "camera": ("right", "down", "forward", "right"),
    "aviation": ("forward", "right", "down", "right"),
    "enu": ("right", "forward", "up", "right"),
    "unreal": ("forward", "right", "up", "left"),
}
"""Where x, y and z point, and the hand that they follow."""
# The point that is at right 1, forward −0.6, up 0.8: (1, 0.8, 0.6) in OpenGL.
READINGS: dict[Convention, tuple[float, float, float]] = {
    "opengl": (1, 0.8, 0.6),
    "directx": (1, 0.8, -0.6),
    "ros": (-0.6, -1, 0.8),
    "camera": (1, -0.8, -0.6),
    "aviation": (-0.6, 1, -0.8),
    "enu": (1, -0.6, 0.8),
    "unreal": (-0.6, 1, 0.8),
}
HANDS = (None, "right", "left")
each_hand = pytest.mark.parametrize(("convention", "handed"), list(product(ON_PAPER, HANDS)))
each_pair = pytest.mark.parametrize(("convention", "to"), list(product(ON_PAPER, ON_PAPER)))
numbers = st.floats(-5, 5)
states = st.builds(
    FramesParams,
    convention=st.sampled_from(list(ON_PAPER)),
    to=st.sampled_from(list(ON_PAPER)),
    handedness=st.sampled_from(HANDS),
    point=st.tuples(numbers, numbers, numbers),
    w=st.one_of(st.floats(0.01, 2), st.just(0.0), st.just(1.0)),
)


@pytest.fixture(scope="module")
def rig() -> Iterator[Rig]:
    with Rig(SIM) as rig:
        yield rig


def close(got: Any, wanted: Any, *, rtol: float = 0.0, atol: float, err_msg: str = "") -> None:
    """None isn't close to anything."""
    assert got is not None
    np.testing.assert_allclose(got, wanted, rtol=rtol, atol=atol, err_msg=err_msg)


def state(**changes: Any) -> FramesParams:
    return FramesParams.model_validate(changes)


def axes_on_paper(convention: Convention, handed: str | None) -> Array:
    """Axes as columns; a handedness that isn't the convention's own turns z round."""
    *words, own = ON_PAPER[convention]
    x, y, z = (np.array(DIRECTIONS[word], dtype=float) for word in words)
    return np.column_stack([x, y, z if handed in (None, own) else -z])


def unit(vector: Array) -> Array:
    scaled: Array = vector / np.linalg.norm(vector)
    return scaled


def drawn_axes(model: SceneModel, name: str = "/axes") -> Array:
    """Directions of a frame's axes as columns, from the pieces that the browser draws."""
    paths = (f"{name}/x", f"{name}/y", f"{name}/third/z")
    pieces = [model.points(path) for path in paths]
    return np.column_stack([unit(points[-1, 1] - points[0, 0]) for points in pieces])


# ---- the mathematics


def test_conventions_have_the_names_of_the_contract() -> None:
    assert list(ON_PAPER) == list(NAMES) == list(FramesParams().options("to"))


@each_hand
def test_basis_and_handedness_are_those_on_paper(convention: Convention, handed: str | None) -> None:
    s = solve(state(convention=convention, handedness=handed))
    np.testing.assert_array_equal(s.basis, axes_on_paper(convention, handed))
    assert s.handedness == (handed or ON_PAPER[convention][3])
    assert np.linalg.det(s.basis) == (1.0 if s.handedness == "right" else -1.0)


@pytest.mark.parametrize("convention", ON_PAPER)
def test_one_point_reads_as_on_paper_in_every_convention(convention: Convention) -> None:
    s = solve(state(convention=convention, point=READINGS[convention]))
    close(s.point_world, (1, -0.6, 0.8), atol=1e-15)
    assert set(s.coordinates) == set(READINGS)
    for name, reading in s.coordinates.items():
        close(reading, READINGS[name], atol=1e-15)


def test_ros_reads_what_the_challenge_asks_for() -> None:
    s = solve(state(convention="opengl", point=(1, 0.5, -2)))
    np.testing.assert_array_equal(s.coordinates["ros"], (2, -1, 0.5))


@each_pair
def test_matrix_takes_readings_to_readings(convention: Convention, to: Convention) -> None:
    for handed in HANDS:
        s = solve(state(convention=convention, to=to, handedness=handed, point=(0.3, -1.2, 2.5)))
        wanted = np.eye(4)
        wanted[:3, :3] = np.linalg.inv(axes_on_paper(to, None)) @ axes_on_paper(convention, handed)
        close(s.matrix, wanted, atol=1e-15)
        close((s.matrix @ s.homogeneous)[:3], s.coordinates[to], atol=1e-15)
        assert s.determinant == pytest.approx(np.linalg.det(wanted), abs=1e-12)
        assert s.determinant == (1.0 if s.handedness == ON_PAPER[to][3] else -1.0)


@given(states)
def test_w_divides(p: FramesParams) -> None:
    s = solve(p)
    np.testing.assert_array_equal(s.homogeneous, (*p.point, p.w))
    if p.w == 0.0:
        assert s.cartesian is None
        assert s.point_world is None
        close(s.coordinates[p.convention], own_reading(p, p.point), atol=1e-12)
    else:
        wanted = np.array(p.point) / p.w
        close(s.cartesian, wanted, rtol=1e-12, atol=1e-12)
        close(s.coordinates[p.convention], own_reading(p, wanted), rtol=1e-12, atol=1e-12)
        world = axes_on_paper(p.convention, p.handedness) @ wanted
        close(s.point_world, world, rtol=1e-12, atol=1e-12)


def own_reading(p: FramesParams, point: npt.ArrayLike) -> Array:
    """The convention's own handedness reads a mirrored z with the other sign."""
    mirrored = p.handedness not in (None, ON_PAPER[p.convention][3])
    return np.asarray(point) * (1.0, 1.0, -1.0 if mirrored else 1.0)


@pytest.mark.parametrize("w", [1.0, 0.5, 0.1, 0.01, 1e-3, 1e-9, 0.0])
def test_point_runs_away_along_its_direction(w: float) -> None:
    s = solve(state(convention="ros", point=(1, -2, 2), w=w))
    assert s.direction is not None
    close(s.direction, axes_on_paper("ros", None) @ (1 / 3, -2 / 3, 2 / 3), atol=1e-15)
    if w:
        assert s.distance == pytest.approx(3 / w)
    else:
        assert s.distance is None


def test_nothing_is_neither_point_nor_direction() -> None:
    s = solve(state(point=(0, 0, 0), w=0))
    assert "neither" in SIM.describe(state(point=(0, 0, 0), w=0), s)
    assert all(value is None for value in (s.cartesian, s.point_world, s.direction, s.tip))


# ---- what stays where it is


@given(states, st.sampled_from(list(ON_PAPER)), st.sampled_from(HANDS))
def test_other_axes_leave_the_physical_point(p: FramesParams, convention: Convention, handed: str | None) -> None:
    changes = {"convention": convention, "handedness": handed}
    for after in (p.moved(changes), p.changed(changes)):
        assert (after.convention, after.handedness) == (convention, handed)
        before, now = solve(p), solve(after)
        np.testing.assert_array_equal(now.undivided, before.undivided)
        np.testing.assert_array_equal(now.homogeneous[3], before.homogeneous[3])
        for name in ON_PAPER:
            np.testing.assert_array_equal(now.coordinates[name], before.coordinates[name])
    assert p.moved(changes).moved({"convention": p.convention, "handedness": p.handedness}).point == p.point


def test_a_point_that_is_said_is_read_in_the_new_axes() -> None:
    p = FramesParams().changed({"convention": "ros", "point": (2, -1, 0.5)})
    assert p.point == (2.0, -1.0, 0.5)
    assert FramesParams.from_query([("convention", "ros")]).point == (1.0, 0.8, 0.6)


def test_absent_handedness_is_left_out_of_the_link() -> None:
    assert state(handedness=None).query() == ""
    assert state(handedness="right").query() == "handedness=right"
    assert FramesParams.from_query([("handedness", "left")]).handedness == "left"


@each_hand
def test_axes_change_and_neither_car_nor_point_moves(rig: Rig, convention: Convention, handed: str | None) -> None:
    rig.show(FramesParams())
    model = rig.model
    still = [
        n for n in model.names if n.split("/")[1] in ("car", "forward", "right", "up", "ground", "point", "origin")
    ]
    assert {"/car/body", "/point", "/up/label"} <= set(still)
    before = {name: model.world_pose(name) for name in still}
    rig.change(convention=convention, handedness=handed)
    rig.settle()
    for name, pose in before.items():
        close(model.world_pose(name), pose, atol=1e-12, err_msg=name)
    close(drawn_axes(model), axes_on_paper(convention, handed), atol=1e-6)
    reading = model.labels()["/point/label"]
    assert reading == in_words(solve(rig.session.params).cartesian)  # type: ignore[arg-type]
    assert rig.column.vector("point") == pytest.approx(own_reading(rig.session.params, READINGS[convention]))  # type: ignore[arg-type]


def in_words(point: Array | None) -> str:
    assert point is not None
    return f"({', '.join(figure(v, 2) for v in point.tolist())})\u2009m"


# ---- axes and the rule


@each_hand
def test_axes_are_handed_as_they_are_labelled(rig: Rig, convention: Convention, handed: str | None) -> None:
    rig.show(state(convention=convention, handedness=handed))
    model = rig.model
    axes = drawn_axes(model)
    close(axes, axes_on_paper(convention, handed), atol=1e-6)
    hand = "right" if np.linalg.det(axes) > 0 else "left"
    assert hand == (handed or ON_PAPER[convention][3])
    assert f"{hand.capitalize()}-handed: fingers of the {hand} hand" in rig.column.html("read")
    assert model.labels()[f"/rule/{hand}/label"] == f"{hand} hand"
    assert "/rule/{}/label".format({"right": "left", "left": "right"}[hand]) not in model.labels()
    for axis, letter, path in zip(axes.T, "XYZ", ("/axes", "/axes", "/axes/third"), strict=True):
        tip = model.world_pose(f"{path}/letter_{letter.lower()}")[:3, 3]
        assert model.labels()[f"{path}/letter_{letter.lower()}"] == letter
        close(unit(tip), axis, atol=1e-9)


@each_hand
def test_rule_sweeps_from_x_to_y_and_its_thumb_is_along_z(rig: Rig, convention: Convention, handed: str | None) -> None:
    for rule in (0.0, 0.25, 0.5, 1.0):
        rig.show(state(convention=convention, handedness=handed, rule=rule))
        model = rig.model
        x, y, z = axes_on_paper(convention, handed).T
        swept = math.cos(rule * math.pi / 2) * x + math.sin(rule * math.pi / 2) * y
        arc = model.points("/rule/arc").reshape(-1, 3)
        close(unit(arc[0]), x, atol=1e-6)
        close(unit(arc[-1]), swept, atol=1e-6)
        close(model.world_pose("/rule/head")[:3, 3], arc[-1], atol=1e-6)
        hand = solve(rig.session.params).handedness  # type: ignore[arg-type]
        fingers = f"/rule/{hand}/near/middle/far"
        assert model.visible(fingers)
        close(model.world_pose(fingers)[:3, 0], swept, atol=1e-9)
        knuckles = model.world_pose(f"/rule/{hand}")[:3, 3]
        thumb = (model.points(f"/rule/{hand}/thumb") - knuckles) @ np.column_stack([x, y, z])
        width, depth, length = np.ptp(thumb, axis=0)
        assert length > 2.5 * max(width, depth), "the thumb is longest along Z"
        palm = (model.points(f"/rule/{hand}/palm") - knuckles) @ z
        assert thumb[:, 2].max() > palm.max() + 0.1, "and stands out of the palm there"
        assert thumb[:, 2].min() > palm.min() + 0.1


def test_hands_are_mirror_images_whose_faces_look_outwards() -> None:
    right, left = hand(left=False), hand(left=True)
    for name, part in right.items():
        close(left[name].vertices, part.vertices * (1, 1, -1), atol=1e-15)
        assert part.volume > 0
        assert left[name].volume == pytest.approx(part.volume)


def test_animation_starts_with_the_fingers_along_x() -> None:
    (action,) = [a for a in SIM.actions if a.name == "rule"]
    steps = list(action.run(state(show_rule=False, rule=0.3)))
    assert all(isinstance(step, Step) for step in steps)
    assert steps[0] == Step({"show_rule": True, "rule": 0.0}, 0.0)
    assert isinstance(steps[-1], Step)
    assert steps[-1].changes == {"rule": 1.0}
    assert 0.4 <= steps[-1].seconds <= 1.2


@each_pair
def test_second_axes_are_the_other_conventions_own(rig: Rig, convention: Convention, to: Convention) -> None:
    rig.show(state(convention=convention, to=to))
    assert rig.model.visible("/to") == (convention != to)
    close(drawn_axes(rig.model, "/to"), axes_on_paper(to, None), atol=1e-6)


@each_hand
def test_grids_are_the_planes_of_their_axes(rig: Rig, convention: Convention, handed: str | None) -> None:
    axes = axes_on_paper(convention, handed)
    for name, normal in (("grid_xy", 2), ("grid_xz", 1), ("grid_yz", 0)):
        rig.show(state(convention=convention, handedness=handed, **{name: True}))
        shown = [n for n in ("grid_xy", "grid_xz", "grid_yz") if rig.model.visible(f"/axes/{n}")]
        assert shown == [name]
        points = rig.model.points(f"/axes/{name}").reshape(-1, 3)
        close(points @ axes[:, normal], 0.0, atol=1e-6)
        assert np.linalg.matrix_rank(points, tol=1e-3) == 2


# ---- the point


@each_hand
def test_dashed_lines_lead_from_the_point_to_the_planes(rig: Rig, convention: Convention, handed: str | None) -> None:
    p = state(convention=convention, handedness=handed, point=(0.7, -0.9, 1.1), w=0.8)
    rig.show(p)
    s, model = solve(p), rig.model
    assert s.point_world is not None
    close(model.world_pose("/point")[:3, 3], s.point_world, atol=1e-12)
    for k, axis in enumerate("xyz"):
        points = model.points(f"/axes/box/{axis}").reshape(-1, 3)
        normal = s.basis[:, k]
        foot = s.point_world - normal * (normal @ s.point_world)
        close(points[0], foot, atol=1e-6)
        assert np.linalg.norm(points[-1] - s.point_world) < 0.1
        close(np.cross(points - foot, normal), 0.0, atol=1e-6)


@pytest.mark.parametrize("w", [2.0, 1.0, 0.5, 0.1, 0.01, 1e-3, 1e-9, 0.0])
def test_what_w_does_is_drawn_and_said(rig: Rig, w: float) -> None:
    p = state(convention="ros", point=(1.0, -0.8, 0.6), w=w)
    rig.show(p)
    s, model = solve(p), rig.model
    labels = model.labels()
    away = s.distance is None or s.distance > IN_VIEW
    assert model.visible("/away") == away
    assert model.visible("/axes/box/x") == (not away)
    if away:
        arrow = model.points("/away")[0]
        close(arrow, [(0, 0, 0), ARROW * np.asarray(s.direction)], atol=1e-6)
    if w == 0.0:
        close(model.world_pose("/point")[:3, 3], s.tip, atol=1e-12)
        assert labels["/point/label"].startswith("direction (1.00, −0.80, 0.60)")
        assert "w = 0: no point, but a direction" in rig.column.html("read")
    elif model.visible("/point"):
        close(model.world_pose("/point")[:3, 3], s.point_world, rtol=1e-12, atol=0)
    else:
        assert w < 1e-3
    assert ("/away/label" in labels) == (away and w > 0)
    assert ("Out of view" in rig.column.html("read")) == (away and w > 0)
    assert model.visible("/undivided") == (w not in (0.0, 1.0))
    if model.visible("/undivided"):
        close(model.world_pose("/undivided")[:3, 3], s.undivided, atol=1e-12)


@each_hand
def test_dragging_sets_the_point_where_the_pointer_is(rig: Rig, convention: Convention, handed: str | None) -> None:
    for w in (1.0, 0.5, 1.7):
        rig.show(state(convention=convention, handedness=handed, point=(0.5, 0.4, 0.3), w=w))
        aim = (0.321, -0.25, 1.125)
        rig.browser.drag("/point", (0.1, 0.1, 0.1), aim)
        rig.settle()
        close(rig.model.world_pose("/point")[:3, 3], aim, atol=1e-12)
        p = rig.session.params
        assert isinstance(p, FramesParams)
        assert p.w == w
        wanted = axes_on_paper(convention, handed).T @ aim * w
        close(p.point, wanted, atol=1e-12)


def test_dragging_a_direction_turns_it_and_keeps_the_length_of_its_numbers(rig: Rig) -> None:
    rig.show(state(point=(0, 0, 2), w=0))
    rig.browser.drag("/point", (0.0, 1.0, 1.0))
    rig.settle()
    p = rig.session.params
    assert isinstance(p, FramesParams)
    half = math.sqrt(2.0)
    close(p.point, (0, half, -half), atol=1e-3)
    close(unit(rig.model.world_pose("/point")[:3, 3]), (0, half / 2, half / 2), atol=1e-3)


def test_dragged_points_make_short_links(rig: Rig) -> None:
    rig.show(FramesParams())
    rig.browser.drag("/point", (1 / 3, -2 / 3, 0.1))
    rig.settle()
    assert rig.session.params.query() == "point=0.333,0.1,0.667"


# ---- words


def test_table_reads_the_point_in_all_conventions() -> None:
    p = FramesParams()
    (table,) = [r for r in SIM.readouts(p, solve(p)) if hasattr(r, "rows")]
    rows = {row[0]: row[1:] for row in table.rows}
    for name, words in NAMES.items():
        row = rows[f"{words} ✓" if name == "opengl" else words]
        assert row == (ON_PAPER[name][3], *(figure(v, 2) for v in READINGS[name]))


@pytest.mark.parametrize(("to", "word"), [("directx", "improper (a reflection)"), ("ros", "a rotation")])
def test_matrix_is_called_what_its_determinant_says(to: str, word: str) -> None:
    p = state(to=to)
    assert any(word in getattr(r, "note", "") for r in SIM.readouts(p, solve(p)))


def described(p: FramesParams) -> tuple[str, FramesSolution]:
    s = solve(p)
    return SIM.describe(p, s), s


def test_sentence_names_axes_point_and_second_reading() -> None:
    sentence, _ = described(state(to="ros"))
    assert sentence == (
        "OpenGL, right-handed: X right, Y up, Z back; point (1.00, 0.80, 0.60)\u2009m;"
        " in ROS (−0.60, −1.00, 0.80); the matrix is a rotation."
    )
