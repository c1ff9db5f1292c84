"""coordinate-frames: what is drawn is handed as it is labelled, and the point and the car stay where they are."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise, product
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.rooms import motion
from sims.coordinate_frames import SIM, FramesParams, FramesSolution, solve
from sims.coordinate_frames.conventions import NAMES, Convention
from sims.coordinate_frames.meshes import hand
from sims.coordinate_frames.solution import ARROW, IN_VIEW, SHORTEST
from sims.kit.readout import figure
from sims.kit.sim import Step
from tests.frames import SceneModel
from tests.server import Rig
from tests.sims.markup import xml

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
DRAWN_AXES = ("/axes/x", "/axes/y", "/axes/third/z")
FINGERS = ("near", "near/middle", "near/middle/far")
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
    """The defaults of the contract, but for what is said."""
    return FramesParams.model_validate(changes)


PLAIN = state(to="opengl")


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
    assert state(handedness=None, to="ros").query() == "to=ros"
    assert state(handedness="right").query() == "handedness=right"
    assert FramesParams.from_query([("handedness", "left")]).handedness == "left"


@each_hand
def test_axes_change_and_neither_car_nor_point_moves(rig: Rig, convention: Convention, handed: str | None) -> None:
    rig.show(PLAIN.changed({"origin": (0.3, -0.2, 1.1)}))
    model = rig.model
    places = ("car", "forward", "right", "up", "ground", "point", "origin", "second")
    still = [n for n in model.names if n.split("/")[1] in places]
    assert {"/car/body", "/point", "/up/label", "/second"} <= set(still)
    before = {name: model.world_pose(name) for name in still}
    rig.change(convention=convention, handedness=handed)
    rig.settle()
    for name, pose in before.items():
        close(model.world_pose(name), pose, atol=1e-12, err_msg=name)
    close(drawn_axes(model), axes_on_paper(convention, handed), atol=1e-6)
    reading = model.labels()["/point/label"]
    assert reading == in_words(solve(rig.session.params).cartesian)  # type: ignore[arg-type]
    p = rig.session.params
    assert isinstance(p, FramesParams)
    assert rig.column.vector("point") == pytest.approx(own_reading(p, READINGS[convention]))
    close(axes_on_paper(convention, handed) @ p.origin, (0.3, -1.1, -0.2), atol=1e-12)


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


@pytest.mark.parametrize(("convention", "hand"), [("ros", "right"), ("unreal", "left")])
def test_the_rule_says_one_thing_at_a_time_and_lights_its_axis(rig: Rig, convention: str, hand: str) -> None:
    (action,) = [a for a in SIM.actions if a.name == "rule"]
    p = state(convention=convention, show_rule=False, rule=0.3)
    seen = []
    for step in action.run(p):
        assert isinstance(step, Step)
        p = p.moved(step.changes)
        rig.show(p)
        thick = {axis: rig.model.node(path).props["shaft_radius"] for axis, path in zip("xyz", DRAWN_AXES, strict=True)}
        assert p.lit is None or thick[p.lit] > 2.0 * max(v for axis, v in thick.items() if axis != p.lit)
        if step.words and (p.lit, p.rule, step.words) not in seen:
            seen.append((p.lit, p.rule, step.words))
            assert p.show_rule
            assert step.seconds >= 1.0, "there is time to read it"
    assert [(lit, rule) for lit, rule, _ in seen] == [("x", 0.0), ("y", 1.0), ("z", 1.0)]
    assert f"{hand} hand along X" in seen[0][2]
    assert "towards Y" in seen[1][2]
    assert f"along Z: these axes are {hand}-handed" in seen[2][2]
    assert p.lit is None
    assert len(set(thick.values())) == 1


@each_hand
def test_the_hand_is_at_the_origin_fingers_along_x_and_thumb_along_z(
    rig: Rig, convention: Convention, handed: str | None
) -> None:
    rig.show(state(convention=convention, handedness=handed, rule=0))
    hand, axes = solve(rig.session.params).handedness, axes_on_paper(convention, handed)  # type: ignore[arg-type]
    thumb = rig.model.points(f"/rule/{hand}/thumb").reshape(-1, 3) @ axes
    assert np.linalg.norm(thumb[thumb[:, 2].argmax(), :2]) < 0.06, "its tip is on the axis"
    fingers = np.concatenate([rig.model.points(f"/rule/{hand}/{part}") for part in FINGERS]).reshape(-1, 3) @ axes
    middle = fingers.mean(axis=0)
    assert np.linalg.norm(middle[1:]) < 0.1, "they are along the axis"
    assert 0.2 < middle[0] < 0.8
    palm = rig.model.points(f"/rule/{hand}/palm").reshape(-1, 3) @ axes
    assert (palm.min(axis=0) < 0.05).all()
    assert palm[:, 0].max() > 0.0, "the origin is in it"


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
        assert np.abs(points).max() > 1.4, "it is larger than the axes"


@each_hand
def test_in_faint_grids_one_strong_line_goes_through_the_foot_of_the_point(
    rig: Rig, convention: Convention, handed: str | None
) -> None:
    p = state(convention=convention, handedness=handed, grid_xy=True, grid_xz=True, grid_yz=True)
    rig.show(p)
    s, along = solve(p), set()
    assert s.point_world is not None
    for name, normal in (("grid_xy", 2), ("grid_xz", 1), ("grid_yz", 0)):
        (line,) = rig.model.points(f"/axes/{name}/through")
        foot = s.point_world - s.basis[:, normal] * (s.basis[:, normal] @ s.point_world)
        close(np.cross(line[1] - line[0], foot - line[0]), 0.0, atol=1e-6)
        along.add(int(np.abs((line[1] - line[0]) @ s.basis).argmax()))
        faint, strong = (rig.model.node(n).props for n in (f"/axes/{name}", f"/axes/{name}/through"))
        assert strong["thickness"] > 2.0 * faint["thickness"]
        assert np.min(faint["colors"]) > np.min(strong["colors"]), "more of the white page is in it"
    assert along == {0, 1, 2}


def test_the_car_is_seen_through() -> None:
    """So that an axis which leads down, in camera and aviation, is seen in it."""
    with Rig(SIM, state(convention="aviation")) as rig:
        bodies = [name for name in rig.model.names if name.startswith("/car/")]
        assert len(bodies) == 4
        assert all(rig.model.node(name).props["opacity"] <= 0.5 for name in bodies)


# ---- the second frame


def frame(axes: Array, origin: npt.ArrayLike) -> Array:
    """A frame as a matrix to the world."""
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = axes, origin
    return T


ORIGIN = (0.4, -1.2, 0.3)


@each_pair
def test_a_point_is_shifted_and_a_direction_is_not(convention: Convention, to: Convention) -> None:
    for handed in HANDS:
        p = state(convention=convention, to=to, handedness=handed, point=(0.3, -1.2, 2.5), origin=ORIGIN)
        s, first = solve(p), axes_on_paper(convention, handed)
        T = np.linalg.solve(frame(axes_on_paper(to, None), first @ ORIGIN), frame(first, 0.0))
        close(s.matrix, T, atol=1e-12)
        close(s.homogeneous_to, T @ [*p.point, 1.0], atol=1e-12)
        close(s.cartesian_to, (T @ [*p.point, 1.0])[:3], atol=1e-12)
        close(s.direction_to, T @ [*p.point, 0.0], atol=1e-12)
        near = solve(p.changed({"origin": (0, 0, 0)}))
        np.testing.assert_array_equal(s.direction_to, near.direction_to)
        assert np.abs(s.homogeneous_to - near.homogeneous_to).max() > 0.1
        assert s.determinant == near.determinant


@pytest.mark.parametrize("w", [0.0, 0.5, 1.0, 2.0])
def test_the_product_beside_the_scene_is_that_of_the_solution(rig: Rig, w: float) -> None:
    p = state(convention="ros", to="camera", point=(0.5, -1, 0.25), origin=ORIGIN, w=w)
    rig.show(p)
    s = solve(p)
    formula = next(e for e in xml(rig.column.parts["read:"]).iter("math"))
    shown = [e.text for e in formula.iter("mn")]
    wanted = [figure(v, 2 if k % 4 == 3 else 0) for k, v in enumerate(s.matrix.ravel().tolist())]
    for vector in (s.homogeneous, (*p.point, 0.0), s.homogeneous_to, s.direction_to):
        wanted += [figure(float(v), 2) for v in vector]
    assert shown == wanted
    close(s.homogeneous_to[:3], s.direction_to[:3] + w * s.matrix[:3, 3], atol=1e-12)
    said = "point direction moves stays" if w else "direction direction stays stays"
    assert " ".join(e.text or "" for e in formula.iter("mtext")) == said


@each_pair
def test_the_second_frame_is_drawn_at_its_origin(rig: Rig, convention: Convention, to: Convention) -> None:
    p = state(convention=convention, to=to, origin=ORIGIN)
    rig.show(p)
    s, model = solve(p), rig.model
    close(s.origin_world, axes_on_paper(convention, None) @ ORIGIN, atol=1e-12)
    assert model.visible("/to")
    for name in ("/to", "/second"):
        close(model.world_pose(name)[:3, 3], s.origin_world, atol=1e-12)
    close(drawn_axes(model, "/to"), axes_on_paper(to, None), atol=1e-6)
    pose = frame(axes_on_paper(to, None), s.origin_world)
    assert s.point_world is not None
    close((np.linalg.inv(pose) @ [*s.point_world, 1.0])[:3], s.cartesian_to, atol=1e-12)
    close(model.points("/sight")[0, 0], s.origin_world, atol=1e-6)
    assert np.linalg.norm(model.points("/sight")[-1, 1] - s.point_world) < 0.1


def test_one_arrow_stands_for_the_direction_at_either_origin(rig: Rig) -> None:
    for w in (1.0, 0.0):
        p = state(convention="ros", to="camera", origin=ORIGIN, w=w)
        rig.show(p)
        s, model = solve(p), rig.model
        first = model.points("/directions")[0] if w else model.points("/away")[0]
        copy = model.points("/directions")[-1]
        close(first[0], (0, 0, 0), atol=1e-6)
        close(copy[0], s.origin_world, atol=1e-6)
        close(copy[1] - copy[0], first[1] - first[0], atol=1e-6)
        close(axes_on_paper("camera", None).T @ (copy[1] - copy[0]), s.direction_to[:3], atol=1e-6)
        assert model.visible("/directions/label")


@each_hand
def test_the_second_origin_is_pulled_and_typed(rig: Rig, convention: Convention, handed: str | None) -> None:
    rig.show(state(convention=convention, handedness=handed))
    before = solve(rig.session.params)  # type: ignore[arg-type]
    aim = (0.321, -0.25, 1.125)
    rig.browser.drag("/second", (0.1, 0.1, 0.1), aim)
    rig.settle()
    p = rig.session.params
    assert isinstance(p, FramesParams)
    close(rig.model.world_pose("/second")[:3, 3], aim, atol=1e-12)
    close(p.origin, axes_on_paper(convention, handed).T @ aim, atol=1e-12)
    np.testing.assert_array_equal(solve(p).point_world, before.point_world)
    rig.browser.move("origin", [0.5, 0, 0])
    rig.settle()
    close(rig.model.world_pose("/second")[:3, 3], 0.5 * axes_on_paper(convention, handed)[:, 0], atol=1e-12)


def test_moving_the_second_frame_comes_back_and_says_why() -> None:
    (action,) = [a for a in SIM.actions if a.name == "shift"]
    p = FramesParams.from_query([])
    places, words = {p.origin}, []
    for step in action.run(p):
        assert isinstance(step, Step)
        p = p.moved(step.changes)
        places.add(p.origin)
        words.append(step.words)
    assert p == FramesParams.from_query([])
    assert len(places) == 2
    assert all(0 < len(each) <= 120 for each in words)


# ---- how the sim opens, and what links mean


def test_it_opens_with_two_frames_that_differ() -> None:
    p = FramesParams.from_query([])
    assert p == FramesParams(**FramesParams.opening)
    assert p.query() == ""
    s = solve(p)
    assert np.abs(s.matrix[:3, :3] - np.eye(3)).max() == 1.0
    assert np.linalg.norm(s.origin_world) > 0.5
    assert SIM.home(p, s) == SIM.view, "all of it is in sight"


@pytest.mark.parametrize(
    "link",
    ["to=opengl", "convention=ros", "handedness=right", "point=1,0.5,2", "w=1", "grid_xy=0", "show_rule=1", "rule=1"],
)
def test_a_link_that_says_anything_means_the_defaults_of_the_contract_by_the_rest(link: str) -> None:
    name, _, text = link.partition("=")
    p = FramesParams.from_query([(name, text)])
    fields = FramesParams.model_fields
    rest = {each: getattr(p, each) for each in fields if each != name}
    assert rest == {each: fields[each].default for each in rest}
    assert (rest.get("to", "opengl"), p.origin) == ("opengl", (0.0, 0.0, 0.0))
    assert FramesParams.from_query([tuple(item.split("=")) for item in p.query().split("&")]) == p  # type: ignore[misc]


def test_the_defaults_have_a_link_of_their_own() -> None:
    assert PLAIN.query() == "convention=opengl"
    assert PLAIN.changed({"to": "ros"}).query() == "to=ros"


# ---- handedness is a choice of two


@each_hand
def test_handedness_is_one_of_two_and_shown(rig: Rig, convention: Convention, handed: str | None) -> None:
    p = state(convention=convention, handedness=handed)
    rig.show(p)
    offered = p.options("handedness")
    assert list(offered.values()) == ["Right-handed", "Left-handed"]
    assert offered[p.handedness].lower().startswith(p.axes.handedness)
    radios = [e.get("value") for e in xml(rig.column.parts["control:handedness"]).iter("input")]
    assert radios == [value or "" for value in offered]
    assert rig.column.values["handedness"] == (p.handedness or "")
    other = next(value for value in offered if value != p.handedness)
    rig.browser.move("handedness", other)
    rig.settle()
    after = rig.session.params
    assert isinstance(after, FramesParams)
    assert {after.axes.handedness, p.axes.handedness} == {"right", "left"}


def test_a_convention_that_is_chosen_has_its_own_handedness() -> None:
    assert state(convention="opengl", handedness="left").moved({"convention": "ros"}).handedness is None
    assert state(convention="opengl", handedness="left").changed({"convention": "ros"}).handedness == "left"


# ---- axes turn


def drawing(rig: Rig, name: str, value: Any) -> list[Array]:
    """The first axes in each state on the way, as they are drawn in it."""
    before = rig.session.params
    assert isinstance(before, FramesParams)
    assert SIM.eases is not None
    steps = list(SIM.eases(before, before.moved({name: value})))
    assert [step.seconds for step in steps] == [0.0, 0.8, 0.0]
    start, end, rest = (dict(step.changes) for step in steps)
    seen = []
    for done in (0.0, 0.3, 0.7, 1.0):
        way = {k: motion.between(start[k], v, done) for k, v in end.items()}
        rig.show(before.moved({name: value}).moved(way))
        seen.append(lengths_and_directions(rig.model))
    rig.show(before.moved({name: value}).moved(rest))
    assert rig.session.params == before.moved({name: value})
    close(lengths_and_directions(rig.model), seen[-1], atol=1e-6)
    return seen


def lengths_and_directions(model: SceneModel) -> Array:
    return np.column_stack([model.points(path)[0, 1] for path in DRAWN_AXES])


@pytest.mark.parametrize(("convention", "to"), list(pairwise([*ON_PAPER, "opengl"])))
def test_chosen_axes_turn_from_where_the_others_were(rig: Rig, convention: Convention, to: Convention) -> None:
    rig.show(state(convention=convention))
    before = lengths_and_directions(rig.model)
    seen = drawing(rig, "convention", to)
    close(seen[0], before, atol=1e-6)
    for axes in seen:
        x, y, z = axes.T
        close((x @ y, y @ z, z @ x), 0.0, atol=1e-5)
        close((np.linalg.norm(x), np.linalg.norm(y)), np.linalg.norm(before[:, 0]), atol=1e-5)
    turned = [np.degrees(np.arccos(np.clip(unit(a[:, 0]) @ unit(b[:, 0]), -1, 1))) for a, b in pairwise(seen)]
    assert max(turned) < 100.0, "it doesn't jump"


def test_a_mirrored_axis_shrinks_and_grows_on_the_other_side(rig: Rig) -> None:
    rig.show(state(convention="enu", origin=(0, 1, 0)))
    heights = [axes[2, 2] for axes in drawing(rig, "handedness", "left")]
    assert heights[0] > heights[1] > 0.0 > heights[2] > heights[3] == -heights[0]
    assert not list(SIM.eases(PLAIN, PLAIN.changed({"w": 0.5})))  # type: ignore[misc]


def test_no_box_of_coordinates_while_its_axes_turn_and_any_other_change_ends_it(rig: Rig) -> None:
    half = state(convention="ros", turn=(1, 1, 0, 0, 0.5), turn_to=(1, 0, 1, 0, 1), lit="x")
    rig.show(half)
    assert not rig.model.visible("/axes/box")
    rig.browser.move("w", 0.9)
    rig.settle()
    p = rig.session.params
    assert isinstance(p, FramesParams)
    assert (p.turn, p.turn_to, p.lit) == (None, None, None)
    assert rig.model.visible("/axes/box/x")
    assert half.changed({"point": (1, 1, 1)}).turn is None


def test_a_chosen_convention_is_seen_to_turn_but_not_where_motion_is_reduced(rig: Rig) -> None:
    rig.show(state(to="camera"))
    rig.browser.move("convention", "ros")
    p = rig.session.params
    assert isinstance(p, FramesParams)
    assert (p.convention, p.turn is None) == ("ros", False)
    rig.host.wait(rig.session.rested())
    assert rig.session.params == state(to="camera").moved({"convention": "ros"})
    rig.session.motion.reduced = True
    rig.browser.move("convention", "enu")
    assert rig.session.params.turn is None
    rig.session.motion.reduced = False


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
        arrow, length = model.points("/away")[0], ARROW if w else math.hypot(*p.point)
        close(arrow, [(0, 0, 0), length * np.asarray(s.direction)], atol=1e-6)
    assert "s3-near" not in rig.column.html("read")
    assert "s3-warn" not in rig.column.html("read"), "it is no error"
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


@pytest.mark.parametrize(("numbers", "length"), [(0.001, SHORTEST), (1.0, 1.0), (5.0, ARROW)])
def test_a_directions_arrow_is_as_long_as_it_is_where_that_can_be_seen(numbers: float, length: float) -> None:
    s = solve(state(point=(0, numbers, 0), w=0))
    close(s.arrow, (0, 0, length), atol=1e-12)


def test_dragged_points_make_short_links(rig: Rig) -> None:
    rig.show(PLAIN)
    rig.browser.drag("/point", (1 / 3, -2 / 3, 0.1))
    rig.settle()
    assert rig.session.params.query() == "point=0.333,0.1,0.667"


# ---- words


def test_table_reads_the_point_in_all_conventions() -> None:
    p = PLAIN
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
        " in ROS: (−0.60, −1.00, 0.80); the matrix is a rotation."
    )
    sentence, _ = described(state(to="ros", origin=(1, 0, 0)))
    assert "in ROS, which begins at (1.00, 0.00, 0.00): (−0.60, 0.00, 0.80)" in sentence


def test_all_numbers_zero_is_told_as_trouble(rig: Rig) -> None:
    rig.show(state(point=(0, 0, 0), w=0))
    assert "s3-warn" in rig.column.html("read")


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"to": "opengl"}, "second convention"),
        ({"to": "ros"}, "ring"),
        ({"to": "ros", "origin": (1, 0, 0)}, "direction’s do not"),
        ({"w": 0.5}, "x/w"),
        ({"w": 0}, "direction"),
        ({"w": 0, "point": (0, 0, 0)}, "set one of them"),
    ],
)
def test_the_caption_says_what_matters_now(changes: dict[str, Any], words: str) -> None:
    p = state(**changes)
    assert words in SIM.caption(p, solve(p))
