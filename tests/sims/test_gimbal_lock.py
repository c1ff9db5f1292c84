"""gimbal-lock: rings, pivots and reach as a browser received them, the numbers beside them, and what the buttons do."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from geometry.rotations import axis_angle_to_matrix
from sims.gimbal_lock import SIM, GimbalParams, digits, meshes, rings, solve
from sims.gimbal_lock.params import NEAR, NEAR_PITCH
from sims.gimbal_lock.scene import PER_RATE
from sims.kit import readout
from sims.kit.palette import DARK, LIGHT
from sims.kit.sim import Action, Step
from tests.server import Rig
from tests.sims.markup import words, xml

Array = npt.NDArray[np.float64]
START = GimbalParams()
RINGS = {"outer": "/outer", "middle": "/outer/middle", "inner": "/outer/middle/inner"}
HOLDERS = {"outer": "", "middle": "/outer", "inner": "/outer/middle"}
OWN_AXIS = {"outer": 2, "middle": 1, "inner": 0}
"""Column of the axis about which each ring turns, in the frame of what holds it."""
NORMAL = {"outer": 0, "middle": 2, "inner": 1}
"""Column of the normal of each ring's plane, in its own frame."""
angles = st.floats(-180, 180)
any_state = st.builds(GimbalParams, yaw=angles, pitch=angles | st.sampled_from([-90.0, 0.0, 90.0]), roll=angles)
each_lock = pytest.mark.parametrize("lock", [90.0, -90.0])
POSES = [
    {},
    {"yaw": 30, "pitch": 35, "roll": -25},
    {"yaw": -130, "pitch": 90, "roll": 77},
    {"yaw": 40, "pitch": -90, "roll": 25},
    {"yaw": 170, "pitch": 180, "roll": -180},
    {"yaw": 1e-7, "pitch": 89.9999999, "roll": -1e-7},
]
each_pose = pytest.mark.parametrize("changes", POSES)


@pytest.fixture(scope="module")
def rig() -> Iterator[Rig]:
    with Rig(SIM) as rig:
        yield rig


def state(**changes: Any) -> GimbalParams:
    return START.changed(changes)


def rotation(p: GimbalParams, rings: int = 3) -> Array:
    """The first turns as one rotation, by SciPy: capitals are turns about turned axes."""
    turns = [angle if k < rings else 0.0 for k, angle in enumerate(p.angles)]
    matrix: Array = Rotation.from_euler("ZYX", turns, degrees=True).as_matrix()
    return matrix


def turned(rig: Rig, name: str) -> Array:
    return rig.model.world_pose(name)[:3, :3]


def drawn_axis(rig: Rig, ring: str) -> Array:
    """Direction of a ring's axis, from the two ends of its arrow head in the scene."""
    tail, tip = rig.model.points(f"{HOLDERS[ring]}/tip")[0]
    along: Array = (tip - tail) / np.linalg.norm(tip - tail)
    return along


def middle_and_normal(points: Array) -> tuple[Array, Array]:
    """The middle of points on a ring, and the direction across its plane (up to its sign)."""
    middle = points.mean(axis=0)
    return middle, np.linalg.svd(points - middle)[2][2]


# ---- the mechanism, as drawn


@each_pose
def test_rings_and_aircraft_are_where_the_angles_lead(rig: Rig, changes: dict[str, Any]) -> None:
    p = state(**changes)
    rig.show(p)
    for count, name in enumerate(RINGS.values(), start=1):
        pose = rig.model.world_pose(name)
        np.testing.assert_allclose(pose[:3, :3], rotation(p, count), rtol=0, atol=1e-12)
        np.testing.assert_array_equal(pose[:3, 3], 0.0)
    for part in ("ring", "stripe", "hull", "mark", "mount"):
        np.testing.assert_array_equal(turned(rig, f"{RINGS['inner']}/{part}"), turned(rig, RINGS["inner"]))
    np.testing.assert_allclose(turned(rig, RINGS["inner"]), solve(p).R, rtol=0, atol=1e-12)


@each_pose
def test_drawn_axes_are_the_columns_of_the_jacobian(rig: Rig, changes: dict[str, Any]) -> None:
    p = state(**changes)
    rig.show(p)
    axes = solve(p).axes
    for k, ring in enumerate(RINGS):
        np.testing.assert_allclose(drawn_axis(rig, ring), axes[:, k], rtol=0, atol=1e-6)
        line = rig.model.points(f"{HOLDERS[ring]}/axis").reshape(-1, 3)
        np.testing.assert_allclose(np.cross(line, axes[:, k]), 0.0, rtol=0, atol=1e-6)


def test_rings_are_perpendicular_at_zero_in_planes_and_axes(rig: Rig) -> None:
    rig.show(START)
    normals = []
    for ring, name in RINGS.items():
        _, normal = middle_and_normal(rig.model.points(f"{name}/ring"))
        np.testing.assert_allclose(np.abs(normal), np.eye(3)[NORMAL[ring]], rtol=0, atol=1e-6)
        normals.append(normal)
    axes = np.array([drawn_axis(rig, ring) for ring in RINGS])
    np.testing.assert_allclose(np.array(normals) @ np.array(normals).T, np.eye(3), rtol=0, atol=1e-6)
    np.testing.assert_allclose(axes, np.eye(3)[[2, 1, 0]], rtol=0, atol=1e-6)


@each_lock
def test_outer_and_inner_ring_turn_about_one_line_at_lock(rig: Rig, lock: float) -> None:
    for yaw, roll in ((0.0, 0.0), (70.0, -20.0), (-180.0, 133.0)):
        rig.show(state(yaw=yaw, pitch=lock, roll=roll))
        outer, middle, inner = (drawn_axis(rig, ring) for ring in RINGS)
        np.testing.assert_allclose(inner, -math.copysign(1.0, lock) * outer, rtol=0, atol=1e-6)
        assert abs(middle @ outer) < 1e-6
        planes = [middle_and_normal(rig.model.points(f"{RINGS[ring]}/ring"))[1] for ring in ("outer", "middle")]
        np.testing.assert_allclose(abs(planes[0] @ planes[1]), 1.0, rtol=0, atol=1e-6)


@pytest.mark.parametrize(("ring", "angle"), [("outer", "yaw"), ("middle", "pitch"), ("inner", "roll")])
def test_pivots_stay_where_they_are_while_their_ring_turns(rig: Rig, ring: str, angle: str) -> None:
    pose = {"yaw": 25.0, "pitch": -40.0, "roll": 60.0}
    rig.show(state(**pose))
    pivots, body = f"{HOLDERS[ring]}/pivots", f"{RINGS[ring]}/ring"
    before, was = rig.model.points(pivots), rig.model.points(body)
    axis = rotation(state(**pose), list(RINGS).index(ring))[:, OWN_AXIS[ring]]
    for turn in (10.0, 75.0, -160.0):
        rig.show(state(**{**pose, angle: turn}))
        np.testing.assert_allclose(rig.model.points(pivots), before, rtol=0, atol=1e-12)
        assert np.abs(rig.model.points(body) - was).max() > 0.1
    # On the ring's turning axis, at both sides, from inside the ring to beyond what holds it.
    along = before @ axis
    assert np.linalg.norm(before - np.outer(along, axis), axis=1).max() < 0.07
    radius = np.linalg.norm(was, axis=1)
    for end in (along, -along):
        assert end.max() > radius.max() + 0.05
        assert end[end > 0].min() < radius.min() + 0.02


def test_every_ring_turns_freely_inside_what_holds_it() -> None:
    """Between the spheres that two neighbours sweep there is a gap; the aircraft has one too."""
    spheres = []
    for ring in rings.RINGS:
        reach = np.linalg.norm(meshes.ring(ring).vertices, axis=1)
        spheres.append((reach.min(), reach.max()))
    for (inside, _), (_, outside) in pairwise(spheres):
        assert outside < inside - 0.05
    arm = np.linalg.norm(meshes.stand().vertices, axis=1)
    assert spheres[0][1] < arm.min() - 0.05


def test_the_aircraft_fits_in_the_inner_ring(rig: Rig) -> None:
    rig.show(START)
    ring = np.linalg.norm(rig.model.points(f"{RINGS['inner']}/ring"), axis=1).min()
    for part in ("hull", "mark"):
        assert np.linalg.norm(rig.model.points(f"{RINGS['inner']}/{part}"), axis=1).max() < ring


def test_bodies_are_closed_outwards_and_light() -> None:
    bodies = [make(ring) for ring in rings.RINGS for make in (meshes.ring, meshes.pivots)]
    for body in (*bodies, meshes.mount(1.0)):
        whole = body.copy()
        whole.merge_vertices()
        whole.update_faces(whole.nondegenerate_faces())  # an edge that ends on the axis makes them
        assert whole.is_watertight
        assert whole.volume > 0.0
    sent = [*bodies, meshes.stand(), *(meshes.stripe(ring) for ring in rings.RINGS)]
    assert sum(12 * (len(body.vertices) + len(body.faces)) for body in sent) < 400_000


def test_rings_differ_by_colour_dashes_and_letter(rig: Rig) -> None:
    rig.show(START)
    colours = {tuple(rig.model.node(f"{name}/ring").props["color"]) for name in RINGS.values()}
    assert len(colours) == 3
    dashes = [len(rig.model.points(f"{HOLDERS[ring]}/axis")) for ring in RINGS]
    assert dashes[0] > dashes[1] > dashes[2] == 1
    labels = rig.model.labels()
    assert [labels[f"{HOLDERS[ring]}/label"] for ring in RINGS] == ["Z yaw 0°", "Y pitch 0°", "X roll 0°"]


# ---- held by their grips


@pytest.mark.parametrize("changes", [*POSES, {"yaw": -20, "pitch": -150, "roll": 91}])
def test_each_ring_is_held_on_itself_half_way_between_its_pivots(rig: Rig, changes: dict[str, Any]) -> None:
    rig.show(state(**changes))
    assert set(rig.model.draggable()) == {
        *(each for ring in rings.RINGS for each in (ring.grip, f"{RINGS[ring.name]}/ring")),
        *(f"{RINGS['inner']}/{part}" for part in ("hull", "mark")),
    }
    for ring in rings.RINGS:
        place = rig.model.world_pose(ring.grip)[:3, 3]
        on_ring = np.linalg.norm(rig.model.points(f"{RINGS[ring.name]}/ring") - place, axis=1)
        assert on_ring.min() < 0.1, "the grip is off its ring"
        assert abs(place @ drawn_axis(rig, ring.name)) == pytest.approx(ring.radius * math.sqrt(0.5), abs=1e-6)


@given(p=any_state, turned=angles, ring=st.sampled_from(rings.RINGS))
def test_a_ring_turns_to_where_its_grip_is_led(p: GimbalParams, turned: float, ring: rings.Ring) -> None:
    """To the place where the grip would be at an angle; how far out on its axis's plane doesn't matter."""
    aim = solve(p.changed({ring.angle: turned})).grips[rings.RINGS.index(ring)]
    axis = solve(p).axes[:, rings.RINGS.index(ring)]
    for place in (aim, aim + 0.3 * axis, aim + 0.5 * (aim - axis * (axis @ aim))):
        found = p.changed(SIM.handles[ring.grip](p, tuple(place.tolist())))
        assert math.remainder(getattr(found, ring.angle) - turned, 360.0) == pytest.approx(0.0, abs=1e-9)
        assert {n for n in ("yaw", "pitch", "roll") if getattr(found, n) != getattr(p, n)} <= {ring.angle}
    assert SIM.handles[ring.grip](p, tuple((0.7 * axis).tolist())) == {}, "a place on its axis means no angle"


@pytest.mark.parametrize("changes", [{}, {"yaw": 150, "pitch": 60, "roll": -100}, {"pitch": 90, "yaw": 179}])
@pytest.mark.parametrize("ring", rings.RINGS, ids=lambda ring: ring.name)
def test_a_hand_leads_a_ring_all_round_without_a_jump(rig: Rig, ring: rings.Ring, changes: dict[str, Any]) -> None:
    """The pointer goes where the grip is seen from the viewer's place; past ±180° too."""
    p = state(**changes)
    rig.show(p)
    start = getattr(p, ring.angle)
    eye = np.asarray(rig.browser.client.camera.position)
    turns = np.arange(15.0, 361.0, 15.0)
    where = [p.changed({ring.angle: math.remainder(start + turn, 360.0)}) for turn in turns]
    for aim in where:
        place = solve(aim).grips[rings.RINGS.index(ring)]
        seen = eye + 0.8 * (place - eye)  # on the way from the eye to it: in the plane of the drag, not on the ring
        rig.browser.drag(ring.grip, tuple(seen.tolist()))
        rig.settle()
        off = math.remainder(getattr(rig.session.params, ring.angle) - getattr(aim, ring.angle), 360.0)
        assert off == pytest.approx(0.0, abs=0.05)


@pytest.mark.parametrize("ring", rings.RINGS, ids=lambda ring: ring.name)
def test_a_ring_turns_by_its_body_wherever_it_is_taken(rig: Rig, ring: rings.Ring) -> None:
    """The place that was taken stays under the pointer, on its way too."""
    p = state(yaw=150, pitch=60, roll=-100)
    rig.show(p)
    eye = np.asarray(rig.browser.client.camera.position)
    k = rings.RINGS.index(ring)
    places = rig.model.points(f"{RINGS[ring.name]}/ring")[::200]
    axis = solve(p).axes[:, k]
    off_axis = [place for place in places if np.linalg.norm(np.cross(axis, place)) > 0.5 * ring.radius]
    for taken in off_axis[:4]:
        rig.show(p)
        ways = [axis_angle_to_matrix(axis, math.radians(turn)) @ taken for turn in (25.0, 50.0, 80.0)]
        seen = [tuple((eye + 0.8 * (place - eye)).tolist()) for place in ways]
        rig.browser.drag(f"{RINGS[ring.name]}/ring", *seen, taken=tuple(taken.tolist()))
        rig.settle()
        turned = math.remainder(getattr(rig.session.params, ring.angle) - getattr(p, ring.angle), 360.0)
        assert turned == pytest.approx(80.0, abs=0.05)


spots = st.tuples(st.floats(0.2, 0.7), st.floats(-0.6, 0.6), st.floats(-0.2, 0.2))
small = st.tuples(*[st.floats(-0.1, 0.1)] * 3)


@given(p=any_state, spot=spots, turn=small)
def test_the_aircraft_goes_where_it_is_pulled_as_far_as_the_rings_let_it(
    p: GimbalParams, spot: tuple[float, float, float], turn: tuple[float, float, float]
) -> None:
    """Far from lock all the way; and never farther from there than it was."""
    place = Rotation.from_rotvec(turn).apply(solve(p).R @ spot)
    found = p.changed(SIM.handles["/aircraft"](p, (*spot, *place.tolist())))
    away, before = (float(np.linalg.norm(solve(each).R @ spot - place)) for each in (found, p))
    assert away <= before + 1e-9
    if solve(p).singular_values[2] > 0.5:
        assert away < 0.05 * before + 1e-6


@pytest.mark.parametrize("pitch", [90.0, -90.0])
def test_at_lock_a_pull_about_the_lost_axis_turns_nothing(pitch: float) -> None:
    p = state(yaw=25.0, pitch=pitch, roll=-40.0)
    lost = solve(p).lost_axis
    assert lost is not None
    spot = (0.7, 0.0, 0.0)
    place = axis_angle_to_matrix(lost, 0.4) @ solve(p).R @ spot
    stays = SIM.handles["/aircraft"](p, (*spot, *place.tolist()))
    assert [stays[name] for name in ("yaw", "pitch", "roll")] == pytest.approx([25.0, pitch, -40.0], abs=1e-6)
    across = axis_angle_to_matrix(solve(p).axes[:, 1], 0.4) @ solve(p).R @ spot
    assert SIM.handles["/aircraft"](p, (*spot, *across.tolist()))["pitch"] != pytest.approx(pitch, abs=5.0)


# ---- three lamps


@pytest.mark.parametrize("pitch", [0.0, 30.0, 60.0, 85.0, 89.9, 90.0, -90.0, 135.0])
def test_lamps_are_lit_as_much_as_there_are_ways_to_turn(rig: Rig, pitch: float) -> None:
    p = state(pitch=pitch, yaw=20)
    rig.show(p)
    values = np.linalg.svd(solve(p).axes)[1]
    html = next(each.html() for each in SIM.readouts(p, solve(p)))
    assert words(html).endswith(f"{np.linalg.matrix_rank(solve(p).axes, rtol=1e-6)} ways to turn")
    shown = [
        float(found or 0.0) for found in re.findall(r'<i class="s3-lamp(?: s3-out"|" style="--glow:([\d.]+))', html)
    ]
    np.testing.assert_allclose(shown, np.minimum(values, 1.0), rtol=0, atol=6e-4)
    locked = solve(p).dof == 2
    assert html.count("×") == locked, "a lamp that is out isn't told by its colour alone"
    green = [rig.model.node(f"/lamps/{k}").props["color"][1] for k in range(3)]
    assert green == sorted(green, reverse=True)
    assert (green[2] < 70) == (values[2] < 0.01)
    assert rig.model.labels()["/lamps/label"] == ("⚠ 2 ways to turn" if locked else "3 ways to turn")


def test_the_sim_opens_with_what_there_is_to_see() -> None:
    caption = SIM.caption(START, solve(START))
    assert caption.startswith("Three rings, three ways to turn.")
    first = readout.folded(SIM.readouts(START, solve(START)))[""]
    assert words(readout.render(first)).startswith("3 ways to turn")
    assert "singular" not in words(readout.render(first))


def test_the_reach_is_off_at_first_and_then_round_the_aircraft(rig: Rig) -> None:
    rig.show(START)
    assert not rig.model.visible("/reach/shape")
    rig.show(state(show_reach=True))
    wing = max(np.linalg.norm(rig.model.points(f"{RINGS['inner']}/{part}"), axis=1).max() for part in ("hull", "mark"))
    assert min(rig.model.node("/reach/shape/ball").props["scale"]) > wing


@pytest.mark.parametrize(("theme", "red"), [(False, LIGHT.line("x")), (True, DARK.line("x"))])
def test_the_lost_axis_is_not_in_the_red_of_x(theme: bool, red: tuple[int, int, int]) -> None:
    with Rig(SIM, state(pitch=90), dark=theme) as rig:
        for name in ("/reach/lost/arrow", "/reach/lost/opposite", "/reach/weak/axis"):
            colors = np.unique(np.reshape(rig.model.node(name).props["colors"], (-1, 3)), axis=0)
            assert len(colors) == 1
            assert np.abs(colors[0].astype(int) - red).max() > 60


# ---- near lock


@pytest.mark.parametrize(
    ("pitch", "said"),
    [(90, "90°"), (89.9, "89.9°"), (89.97, "89.97°"), (-90.002, "−90.002°"), (89.99999, "89.99999°"), (44.9, "45°")],
)
def test_only_lock_is_called_lock(rig: Rig, pitch: float, said: str) -> None:
    p = state(pitch=pitch)
    rig.show(p)
    assert rig.model.labels()["/outer/label"] == f"Y pitch {said}"
    assert f"pitch {said}" in SIM.describe(p, solve(p))


@pytest.mark.parametrize("pitch", [80.0, 89.0, 89.9, 89.99, 89.9995, 90.0])
def test_a_small_number_is_no_zero(pitch: float) -> None:
    p = state(pitch=pitch)
    least = solve(p).singular_values.item(2)
    for text in (digits.small(least), digits.small(solve(p).conditioning)):
        assert (float(text) == 0.0) == (solve(p).dof == 2)
    assert float(digits.small(least)) == pytest.approx(least, rel=0.05, abs=1e-9)
    said = words(readout.render(SIM.readouts(p, solve(p))))
    assert SIM.panes is not None
    assert digits.small(least) in SIM.panes(p, solve(p))[0].note
    assert ("still 3 degrees of freedom" in said) == solve(p).near


def test_what_near_lock_costs_is_said_first() -> None:
    p = state(pitch=89.93)
    s = solve(p)
    times = np.abs(np.linalg.inv(s.axes) @ np.linalg.svd(s.axes)[0][:, 2]).max()
    assert f"{times:.0f}× as fast" in SIM.caption(p, s)
    assert f"{times:.1f}" in words(readout.render(readout.folded(SIM.readouts(p, s))[""]))
    locked = state(pitch=90)
    assert "∞" in words(readout.render(readout.folded(SIM.readouts(locked, solve(locked)))[""]))


# ---- what they reach


@pytest.mark.parametrize("changes", [*POSES, {"pitch": 80, "yaw": -20}, {"pitch": -100, "yaw": 60}])
def test_ellipsoid_is_the_image_of_unit_ring_rates(rig: Rig, changes: dict[str, Any]) -> None:
    p = state(**changes)
    rig.show(p)
    solution = solve(p)
    for part in ("ball", "outline"):
        name = f"/reach/shape/{part}"
        scaled = turned(rig, name) @ np.diag(rig.model.node(name).props["scale"]) / PER_RATE
        np.testing.assert_allclose(scaled @ scaled.T, solution.axes @ solution.axes.T, rtol=0, atol=1e-6)
    np.testing.assert_allclose(np.linalg.svd(solution.axes)[1], solution.singular_values, rtol=0, atol=1e-12)


@given(any_state)
def test_numbers_are_those_of_the_drawn_axes(p: GimbalParams) -> None:
    solution = solve(p)
    np.testing.assert_allclose(solution.R, rotation(p), rtol=0, atol=1e-12)
    np.testing.assert_allclose(solution.axes[:, 0], (0.0, 0.0, 1.0), rtol=0, atol=1e-12)
    np.testing.assert_allclose(solution.axes[:, 1], rotation(p, 1)[:, 1], rtol=0, atol=1e-12)
    np.testing.assert_allclose(solution.axes[:, 2], rotation(p, 2)[:, 0], rtol=0, atol=1e-12)
    assert solution.conditioning == pytest.approx(abs(np.linalg.det(solution.axes)), abs=1e-12)
    least = math.sqrt(max(1.0 - abs(math.sin(math.radians(p.pitch))), 0.0))
    assert solution.singular_values[2] == pytest.approx(least, abs=1e-7)
    assert (solution.lost_axis is None) == (solution.dof == 3)


@pytest.mark.parametrize(
    ("pitch", "dof"),
    [(0, 3), (89.99, 3), (90, 2), (90.01, 3), (-90, 2), (-89.99, 3), (180, 3), (90 - 1e-9, 2), (90 - 1e-3, 3)],
)
def test_degrees_of_freedom_are_the_rank_of_the_axes(pitch: float, dof: int) -> None:
    solution = solve(state(pitch=pitch, yaw=33, roll=-71))
    assert solution.dof == dof == np.linalg.matrix_rank(solution.axes, rtol=1e-6)
    assert solution.dof == (solution.singular_values > 1e-6 * solution.singular_values[0]).sum()


@each_lock
@given(yaw=angles, roll=angles)
def test_no_ring_turns_about_the_lost_axis(lock: float, yaw: float, roll: float) -> None:
    solution = solve(GimbalParams(yaw=yaw, pitch=lock, roll=roll))
    assert solution.lost_axis is not None
    np.testing.assert_allclose(solution.lost_axis @ solution.axes, 0.0, rtol=0, atol=1e-12)
    assert np.linalg.norm(solution.lost_axis) == pytest.approx(1.0)
    np.testing.assert_allclose(solution.rates, 0.0, rtol=0, atol=1e-12)


@pytest.mark.parametrize("changes", [{"pitch": 90, "yaw": 35}, {"pitch": -90, "yaw": -100, "roll": 20}])
def test_lost_axis_is_drawn_at_lock_with_words(rig: Rig, changes: dict[str, Any]) -> None:
    p = state(**changes)
    rig.show(p)
    lost = solve(p).lost_axis
    for arrow, sign in (("arrow", 1.0), ("opposite", -1.0)):
        tail, tip = rig.model.points(f"/reach/lost/{arrow}")[0]
        np.testing.assert_allclose(tail, 0.0, rtol=0, atol=1e-12)
        np.testing.assert_allclose(tip / np.linalg.norm(tip), sign * np.asarray(lost), rtol=0, atol=1e-6)
    assert rig.model.labels()["/reach/lost/label"] == "⚠ no ring turns about this"
    assert "s3-warn" in rig.column.html("read")


@pytest.mark.parametrize("pitch", [0.0, 45.0, NEAR_PITCH - 0.01, NEAR_PITCH + 0.01, 89.99, 90.0, 91.0, -75.0, 180.0])
def test_nearness_is_that_of_the_smallest_singular_value(rig: Rig, pitch: float) -> None:
    p = state(pitch=pitch)
    rig.show(p)
    least = np.linalg.svd(solve(p).axes)[1][2]
    locked = least < 1e-6
    assert rig.model.visible("/reach/lost") == locked
    assert rig.model.visible("/reach/weak") == (not locked and least < NEAR)
    html = rig.column.html("read")
    assert ("s3-near" in html, "s3-warn" in html) == (not locked and least < NEAR, locked)
    assert ("⚠" in words(readout.render(SIM.readouts(p, solve(p))))) == (least < NEAR)
    if least < NEAR and not locked:
        axes = solve(p).axes
        fastest = np.abs(np.linalg.inv(axes) @ np.linalg.svd(axes)[0][:, 2]).max()
        assert rig.model.labels()["/reach/weak/label"] == f"⚠ rings must turn {fastest:.0f}× as fast"
    inside = any(low < pitch < high for low, high in p.regions()["pitch"])
    assert inside == (least < NEAR)


@given(any_state)
def test_ring_rates_turn_about_the_weakest_axis(p: GimbalParams) -> None:
    solution = solve(p)
    if solution.dof == 3:
        turning = solution.axes @ solution.rates
        np.testing.assert_allclose(turning, solution.weakest_axis, rtol=0, atol=1e-6)
        speed = float(np.linalg.norm(solution.rates))
        assert speed == pytest.approx(1.0 / solution.singular_values[2], rel=1e-6)


# ---- at lock: one combination of yaw and roll


@each_lock
@given(yaw=angles, roll=angles)
def test_reduced_form_is_the_rotation(lock: float, yaw: float, roll: float) -> None:
    p = GimbalParams(yaw=yaw, pitch=lock, roll=roll)
    reduced = solve(p).reduced
    assert reduced is not None
    end = 1.0 if lock > 0 else -1.0
    combined = math.radians(yaw - end * roll)
    assert math.remainder(reduced.angle - math.degrees(combined), 360.0) == pytest.approx(0.0, abs=1e-9)
    cos, sin = math.cos(combined), math.sin(combined)
    errata = np.array([[0.0, -sin, end * cos], [0.0, cos, end * sin], [-end, 0.0, 0.0]])
    np.testing.assert_allclose(reduced.R, errata, rtol=0, atol=1e-12)
    np.testing.assert_allclose(rotation(p), errata, rtol=0, atol=1e-12)


@each_lock
def test_reduced_form_is_written_with_the_signs_of_that_lock(lock: float) -> None:
    """The pattern in symbols, worked out with the numbers of the state, is R."""
    p = state(pitch=lock, yaw=50, roll=-15)
    html = readout.render(SIM.readouts(p, solve(p)))
    table = next(t for t in xml(html).iter("mtable") if any(e.text == "cos" for e in t.iter("mi")))
    sign = {"+": 1.0, "−": -1.0}
    values = []
    for cell in table.iter("mtd"):
        text = "".join(cell.itertext())
        found = re.fullmatch(r"(−?)(0|1|(cos|sin)\(ψ([+−])φ\))", text)
        assert found is not None, text
        value = float(found[2]) if found[3] is None else 0.0
        if found[3] is not None:
            value = getattr(math, found[3])(math.radians(50 + sign[found[4]] * -15))
        values.append(-value if found[1] else value)
    np.testing.assert_allclose(np.reshape(values, (3, 3)), rotation(p), rtol=0, atol=1e-12)


def test_reduced_form_is_shown_at_lock_alone() -> None:
    for pitch, shown in ((90, True), (-90, True), (89.99, False), (0, False)):
        p = state(pitch=pitch)
        assert ("<mi>cos</mi>" in readout.render(SIM.readouts(p, solve(p)))) == shown
        assert (solve(p).reduced is not None) == shown


# ---- the ghost


def test_ghost_is_where_it_was_marked(rig: Rig) -> None:
    p = state(yaw=10, pitch=20, roll=30, show_ghost=True, ghost=(-50, 60, 70))
    rig.show(p)
    marked = Rotation.from_euler("ZYX", p.ghost, degrees=True)
    np.testing.assert_allclose(turned(rig, "/ghost"), marked.as_matrix(), rtol=0, atol=1e-12)
    ghost = solve(p).ghost
    assert ghost is not None
    away = marked * Rotation.from_matrix(rotation(p)).inv()
    assert ghost.angle == pytest.approx(math.degrees(away.magnitude()))
    np.testing.assert_allclose(math.radians(ghost.angle) * ghost.axis, away.as_rotvec(), rtol=0, atol=1e-9)
    np.testing.assert_allclose(solve(p).axes @ ghost.rates, ghost.axis, rtol=0, atol=1e-9)
    rig.show(p.changed({"show_ghost": False}))
    assert not rig.model.visible("/ghost")


def test_same_orientation_by_other_angles_is_said() -> None:
    p = state(yaw=40, pitch=90, roll=40, show_ghost=True, ghost=(0, 90, 0))
    text = words(readout.render(SIM.readouts(p, solve(p))))
    assert "Same orientation as the ghost, which has other ring angles: yaw 0°, pitch 90°, roll 0°" in text
    text = words(readout.render(SIM.readouts(p, solve(p.changed({"roll": 41})))))
    assert "1.0° away" in text


# ---- buttons


def action(name: str) -> Action:
    return next(a for a in SIM.actions if a.name == name)


def frames(name: str, start: GimbalParams) -> list[GimbalParams]:
    """States at the end of each step of a motion; the steps must be such as the program may play."""
    states = [start]
    steps = action(name).run(start)
    assert not isinstance(steps, Mapping)
    for step in steps:
        assert isinstance(step, Step)
        assert 0.0 <= step.seconds <= (1.6 if step.changes else 2.0)
        states.append(states[-1].changed(step.changes))
    return states


@pytest.mark.parametrize("name", ["lock", "same-motion", "try-lost"])
@pytest.mark.parametrize("changes", [{}, {"pitch": 90, "yaw": 170}])
def test_every_leg_of_a_motion_says_what_is_to_be_seen(changes: dict[str, Any], name: str) -> None:
    steps = [step for step in action(name).run(state(**changes)) if isinstance(step, Step)]
    assert all(step.words for step in steps if step.seconds)
    assert all(step.words.endswith(".") and len(step.words) <= 120 for step in steps[:-1]), "the caption flickers"
    said = list(dict.fromkeys(step.words for step in steps if step.words))
    assert len(said) == {"lock": 1, "same-motion": 3, "try-lost": 3}[name] + (name != "lock" and not changes)


def between(a: GimbalParams, b: GimbalParams) -> float:
    """Degrees between the orientations of two states."""
    away = Rotation.from_matrix(solve(a).R).inv() * Rotation.from_matrix(solve(b).R)
    return math.degrees(away.magnitude())


STARTS = [
    {"pitch": 90},
    {},
    {"yaw": 20, "pitch": 60, "roll": -10},
    {"pitch": -90, "yaw": 160, "roll": 10},
    {"pitch": -30, "yaw": -170, "roll": -170},
    {"pitch": 90, "yaw": 100, "roll": -170},
    {"pitch": 90, "yaw": 180, "roll": 180},
    {"pitch": 130, "yaw": -180, "roll": -180, "show_reach": False},
]
each_start = pytest.mark.parametrize("changes", STARTS)


def test_go_to_gimbal_lock_turns_the_middle_ring_alone() -> None:
    end = frames("lock", state(yaw=10, pitch=20, roll=30, show_ghost=True))[-1]
    assert (end.yaw, end.pitch, end.roll, end.show_ghost) == (10, 90, 30, False)
    assert solve(end).dof == 2


@each_start
def test_the_same_motion_returns_the_aircraft_by_another_ring(changes: dict[str, Any]) -> None:
    states = frames("same-motion", state(**changes))
    locked = next(k for k, p in enumerate(states) if abs(p.pitch) == 90.0 and p.show_ghost)
    start = states[locked]
    moved = max(states[locked:], key=lambda p: between(start, p))
    assert between(start, moved) == pytest.approx(40.0, abs=1e-6)
    assert moved.roll == start.roll, "the outer ring alone turns it away"
    end = states[-1]
    assert between(start, end) < 1e-6
    assert abs(math.remainder(end.yaw - start.yaw, 360.0)) == pytest.approx(40.0)
    assert abs(math.remainder(end.roll - start.roll, 360.0)) == pytest.approx(40.0)
    assert end.show_reach == state(**changes).show_reach
    ghost = solve(end).ghost
    assert ghost is not None
    assert ghost.angle < 1e-6


@each_start
def test_trying_to_turn_about_the_lost_axis_shows_that_no_ring_does(changes: dict[str, Any]) -> None:
    states = frames("try-lost", state(**changes))
    away = [(k, g.angle) for k, p in enumerate(states) if (g := solve(p).ghost) is not None]
    marked, first = away[0]
    assert first < 1e-6, "the ghost starts on the aircraft"
    tried = next(k for k, angle in away if angle > 29.0)
    locked, wish = solve(states[marked]), solve(states[tried]).ghost
    assert locked.dof == 2
    assert wish is not None
    assert locked.lost_axis is not None
    assert wish.angle == pytest.approx(30.0, abs=1e-6)
    assert abs(wish.axis @ locked.lost_axis) == pytest.approx(1.0, abs=1e-9)
    np.testing.assert_allclose(wish.rates, 0.0, rtol=0, atol=1e-9)
    assert states[tried].angles == states[marked].angles, "nothing moves"
    text = words(readout.render(SIM.readouts(states[tried], solve(states[tried]))))
    assert "No ring rates turn the aircraft towards it" in text
    # What it takes: a quarter turn of two rings that moves nothing, then the middle ring.
    there = next(k for k, p in enumerate(states) if k > tried and abs(p.pitch) != 90.0)
    for p in states[marked:there]:
        assert between(states[marked], p) < 1e-6
    assert abs(math.remainder(states[there - 1].yaw - states[marked].yaw, 360.0)) == pytest.approx(90.0)
    final = solve(states[-1]).ghost
    assert final is not None
    assert final.angle < 1e-6


@each_start
def test_a_ghost_glides_about_the_lost_axis_all_the_way(changes: dict[str, Any]) -> None:
    """Also between the steps, where the program fills in frames."""
    states = frames("try-lost", state(**changes))
    pairs = [(a, b) for a, b in pairwise(states) if a.show_ghost and a.ghost != b.ghost]
    assert len(pairs) == 1
    (a, b) = pairs[0]
    lost = solve(a).lost_axis
    assert lost is not None
    for part in (0.1, 0.5, 0.8):
        ghost = tuple(u + part * (v - u) for u, v in zip(a.ghost, b.ghost, strict=True))
        wish = solve(a.changed({"ghost": ghost})).ghost
        assert wish is not None
        assert wish.angle == pytest.approx(30.0 * part, abs=1e-6)
        assert abs(wish.axis @ lost) == pytest.approx(1.0, abs=1e-9)


@each_start
@pytest.mark.parametrize("name", ["same-motion", "try-lost"])
def test_no_step_turns_a_ring_further_than_it_says(changes: dict[str, Any], name: str) -> None:
    """A slider that leaves at ±180° comes in at its other end: no ring is sent the long way round."""
    states = frames(name, state(**changes))
    for a, b in pairwise(states):
        for ring in ("yaw", "pitch", "roll"):
            jump = getattr(b, ring) - getattr(a, ring)
            assert abs(jump) <= 90.0 or abs(jump) == 360.0


def test_marking_leaves_a_ghost_here() -> None:
    p = state(yaw=12, pitch=34, roll=56)
    changes = action("mark").run(p)
    assert isinstance(changes, Mapping)
    assert solve(p.changed(changes)).ghost is not None
    assert p.changed(changes).ghost == (12, 34, 56)


# ---- the plot


@pytest.mark.parametrize("pitch", [0.0, 30.0, -48.590377890729, 90.0, 135.0, -180.0])
def test_plot_marks_the_smallest_singular_value(pitch: float) -> None:
    p = state(pitch=pitch)
    assert SIM.panes is not None
    svg = SIM.panes(p, solve(p))[0].svg
    mark = re.search(r'data-handle="effort" data-x="([\d.]+)" data-y="([\d.]+)"', svg)
    assert mark is not None
    u, v = float(mark[1]), float(mark[2])
    assert u == pytest.approx(44.0 + 262.0 * abs(pitch) / 180.0, abs=0.06)
    least = math.sqrt(1.0 - abs(math.sin(math.radians(pitch))))
    assert v == pytest.approx(126.0 - 102.0 * least, abs=0.06)
    curve = re.search(r'<path d="M([\d. L]+)" class="s3-curve"/>', svg)
    assert curve is not None
    points = np.array([[float(n) for n in pair.split()] for pair in curve[1].split("L")])
    assert np.interp(u, points[:, 0], points[:, 1]) == pytest.approx(v, abs=0.5)


@pytest.mark.parametrize(("start", "value", "pitch"), [(20, 65, 65), (-20, 65, -65), (0, 200, 180), (-90, -5, 0)])
def test_the_mark_of_the_plot_turns_the_middle_ring_on_its_side(start: float, value: float, pitch: float) -> None:
    p = state(pitch=start)
    found = p.changed(SIM.handles["effort"](p, (value, 0.3)))
    assert found.pitch == pitch
