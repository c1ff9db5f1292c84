"""quaternion: its numbers against SciPy, what a browser is sent, composition and undo, what is refused."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from typing import Any
from urllib.parse import parse_qsl
from xml.etree.ElementTree import Element

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy.spatial.transform import Rotation, Slerp

from sims.kit import readout
from sims.kit.params import LONGEST_VALUE
from sims.kit.refusals import BadParams
from sims.kit.spelling import spell
from sims.quaternion import SIM, QuaternionParams, actions, solve
from sims.quaternion.ball import MIDDLE, SCREEN, pixel
from sims.quaternion.ball import RADIUS as BALL_RADIUS
from sims.quaternion.dial import HALF, RADIUS, TURN, at
from sims.quaternion.panes import panes
from sims.quaternion.params import MOST_TURNS, PRESETS
from tests.server import Rig
from tests.sims.markup import words, xml

Array = npt.NDArray[np.float64]
START = QuaternionParams()
HALF_ROOT = 0.5**0.5
FLAT = tuple(SCREEN[0].tolist())
"""An axis in the plane of the ball's picture."""
AXES = [(0, 0, 1), (1, 1, 0), (1, 1, 1), (-0.3, 2.0, 0.7), (0.02, -0.01, -9.0), (1, 0, 0)]
entries = st.floats(-1, 1)
directions = st.tuples(entries, entries, entries).filter(lambda v: math.hypot(*v) > 1e-3)
starts = st.tuples(entries, entries, entries, entries).filter(lambda v: math.hypot(*v) > 1e-3)
states = st.builds(
    QuaternionParams,
    axis=directions,
    angle=st.floats(0, 360) | st.sampled_from([0.0, 180.0, 360.0]),
    start=starts | st.just((1.0, 0.0, 0.0, 0.0)),
    t=st.floats(0, 1) | st.sampled_from([0.0, 0.5, 1.0]),
    interpolation=st.sampled_from(["slerp", "nlerp", "euler"]),
    long_way=st.booleans(),
    point=directions,
)


def turn(p: QuaternionParams, share: float = 1.0) -> Rotation:
    """The turn by SciPy."""
    return Rotation.from_rotvec(share * p.angle * np.array(p.axis) / math.hypot(*p.axis), degrees=True)


def begin(p: QuaternionParams) -> Rotation:
    return Rotation.from_quat(p.start, scalar_first=True)


def rotation(q: npt.ArrayLike) -> Rotation:
    return Rotation.from_quat(q, scalar_first=True)


def near(a: Any, b: Any, within: float = 1e-9) -> None:
    np.testing.assert_allclose(a, b, rtol=0, atol=within)


# ---- numbers


@given(states)
def test_numbers_are_scipys(p: QuaternionParams) -> None:
    s = solve(p)
    total = turn(p) * begin(p)
    half = math.radians(p.angle) / 2
    near(s.q, [math.cos(half), *(math.sin(half) * np.array(p.axis) / math.hypot(*p.axis))])
    near(rotation(s.q_total).as_matrix(), total.as_matrix())
    near(s.R_total, total.as_matrix())
    near(s.rotated_point, turn(p).apply(p.point))
    near(Rotation.from_euler("ZYX", s.euler, degrees=True).as_matrix(), total.as_matrix(), 1e-6)
    near(s.sandwich["rotated"], [0.0, *s.rotated_point])
    near(s.terms.sum(axis=1), s.q_total)
    near(s.interpolated.R, rotation(s.interpolated.q).as_matrix())


@given(states)
def test_the_object_goes_from_start_to_target(p: QuaternionParams) -> None:
    first, last = (solve(p.changed({"t": t})) for t in (0.0, 1.0))
    near(first.interpolated.R, begin(p).as_matrix(), 1e-6)
    near(last.interpolated.R, last.R_total, 1e-6)


@given(states)
def test_slerp_is_scipys_and_the_long_way_ends_at_the_opposite_quaternion(p: QuaternionParams) -> None:
    short, long = (solve(p.changed({"long_way": w, "t": 1.0, "interpolation": "slerp"})) for w in (False, True))
    near(short.interpolated.q, -long.interpolated.q)
    assert short.way_angle + long.way_angle == pytest.approx(360.0)
    if 0.01 < short.way_angle < 179.99:
        ends = Rotation.concatenate([begin(p), turn(p) * begin(p)])
        now = solve(p.changed({"long_way": False, "interpolation": "slerp"}))
        near(now.interpolated.R, Slerp([0, 1], ends)(p.t).as_matrix(), 1e-7)


@given(states)
def test_paths_lead_from_start_to_target_along_the_way_that_the_object_goes(p: QuaternionParams) -> None:
    s = solve(p.changed({"show": "path"}))
    assert s.ways is not None
    assert list(s.ways) == ["slerp", "nlerp", "euler"]
    for name, way in s.ways.items():
        path, mark = way.nose.path, way.nose.marks[4]
        near(path[0], begin(p).as_matrix()[:, 0])
        near(path[-1], s.R_total[:, 0], 1e-7)
        near(np.linalg.norm(path, axis=1), 1.0)
        third = solve(p.changed({"interpolation": name, "t": 1 / 3})).interpolated.R[:, 0]
        near(mark.mean(axis=0) / np.linalg.norm(mark.mean(axis=0)), third, 1e-6)
        alone = solve(p.changed({"interpolation": name})).interpolated
        near(way.q, alone.q)
        near(way.at, alone.R[:, 0])
        near(math.cos(math.radians(way.turned)), np.cos((rotation(way.q) * begin(p).inv()).magnitude()), 1e-7)


@given(states)
def test_q_and_minus_q_turn_the_same_and_are_on_both_sides_of_the_ball(p: QuaternionParams) -> None:
    s = solve(p)
    near(rotation(-s.q_total).as_matrix(), s.R_total)
    quarter = math.radians(p.angle) / 4
    if s.ball_q is not None and p.angle < 350:
        near(s.ball_q, math.tan(quarter) * s.n, 1e-6)
        assert np.linalg.norm(s.ball_q) <= 1 + 1e-9 or p.angle > 180
    if s.ball_minus_q is not None and p.angle > 10:
        near(s.ball_minus_q, -s.n / math.tan(quarter), 1e-6)


def test_opposite_axis_and_the_rest_of_the_turn_is_the_opposite_quaternion() -> None:
    for axis in AXES:
        one = solve(START.changed({"axis": axis, "angle": 60}))
        other = solve(START.changed({"axis": tuple(-v for v in axis), "angle": 300}))
        near(one.q, -other.q)
        near(one.R_total, other.R_total)
        assert one.ball_q is not None
        assert other.ball_minus_q is not None
        near(one.ball_q, other.ball_minus_q)


def test_slerp_and_nlerp_agree_at_the_middle_and_differ_most_in_between() -> None:
    leads = [solve(START.changed({"angle": 170, "t": t})).lead for t in np.linspace(0, 1, 101)]
    near([leads[0], leads[50], leads[100]], 0.0)
    assert max(leads) == pytest.approx(-min(leads))
    assert int(np.argmin(leads)) < 50 < int(np.argmax(leads)), "NLERP is slow at first"
    assert max(leads) > 3.0


# ---- what a browser is sent


@pytest.fixture(scope="module")
def rig() -> Iterator[Rig]:
    with Rig(SIM) as rig:
        yield rig


TOPICS = ["turn", "ball", "point", "order", "path"]


def scenes() -> Iterator[QuaternionParams]:
    """Named states, every axis by many angles, and random ones."""
    yield from (START.changed(changes) for changes in SIM.states.values())
    yield from (START.changed({"axis": a, "angle": d, "t": 0.4}) for a in AXES for d in (1, 90, 180, 240, 359))
    random = np.random.default_rng(7)
    for _ in range(20):
        yield START.changed(
            {
                "axis": tuple(random.normal(size=3)),
                "angle": random.uniform(0, 720),
                "show": random.choice(TOPICS),
                "axis_b": tuple(random.normal(size=3)),
                "start": tuple(random.uniform(-1, 1, size=4)),
                "t": random.uniform(),
                "interpolation": random.choice(["slerp", "nlerp", "euler"]),
                "long_way": bool(random.integers(2)),
                "point": tuple(random.uniform(-1, 1, size=3)),
            }
        )


each_scene = pytest.mark.parametrize("p", list(scenes()), ids=lambda p: p.query()[:60] or "defaults")


@each_scene
def test_bodies_are_where_the_numbers_say(rig: Rig, p: QuaternionParams) -> None:
    rig.show(p)
    s = solve(p)
    alone = p.topic not in ("order", "path")
    for body in ("hull", "mark", "arrows"):
        near(rig.model.world_pose(f"/object/{body}")[:3, :3], s.interpolated.R)
    for name, R in (("/start", begin(p).as_matrix()), ("/target", s.R_total)):
        if rig.model.visible(name):
            near(rig.model.world_pose(f"{name}/hull")[:3, :3], R)
        elif alone:
            near(s.interpolated.R, R, 1e-5)
    assert rig.model.visible("/object") == alone
    assert rig.model.visible("/point") == (p.topic == "point")
    if p.topic == "point":
        near(rig.model.world_pose("/point")[:3, 3], p.point)
        near(rig.model.world_pose("/image")[:3, 3], turn(p).apply(p.point))


@pytest.mark.parametrize("axis", AXES)
def test_the_object_is_turned_about_the_axis_that_is_drawn(rig: Rig, axis: tuple[float, float, float]) -> None:
    for angle in (30.0, 90.0, 179.0):
        rig.show(START.changed({"axis": axis, "angle": angle}))
        tail, tip = rig.model.points("/axis/arrow")[0]
        drawn = (tip - tail) / np.linalg.norm(tip - tail)
        near(tail, 0.0)
        near(drawn, np.array(axis) / math.hypot(*axis), 1e-6)
        near(rig.model.world_pose("/tip")[:3, 3] / np.linalg.norm(rig.model.world_pose("/tip")[:3, 3]), drawn, 1e-6)
        about = Rotation.from_matrix(rig.model.world_pose("/object")[:3, :3]).as_rotvec(degrees=True)
        near(about, angle * drawn, 1e-4)


@each_scene
def test_the_arc_lies_across_the_axis_and_ends_at_the_angle(rig: Rig, p: QuaternionParams) -> None:
    rig.show(p)
    alone = p.topic not in ("order", "path")
    assert rig.model.visible("/axis/turn") == rig.model.visible("/angle") == alone
    assert rig.model.visible("/axis/turn/arc") == (alone and p.angle > 0)
    assert rig.model.visible("/axis/turn/lap") == (alone and p.angle > 360), "a whole turn is behind it"
    if p.angle == 0 or not alone:
        return
    n = np.array(p.axis) / math.hypot(*p.axis)
    middle = rig.model.world_pose("/axis/turn")[:3, 3]
    near(middle, n * (middle @ n), 1e-6)
    arc = rig.model.points("/axis/turn/arc").reshape(-1, 3) - middle
    near(arc @ n, 0.0, 1e-6)
    begins, ends = (rig.model.points(f"/axis/turn/{end}")[0, 1] - middle for end in ("begin", "end"))
    near(arc[0], begins, 1e-6)
    near(arc[-1], ends, 1e-6)
    near(turn(p).apply(begins), ends, 1e-6)
    half = Rotation.from_rotvec(math.radians(p.angle - 360 if p.angle > 360 else p.angle) / 2 * n).apply(begins)
    near(arc[len(arc) // 2], half, 1e-6)
    image = rig.model.world_pose("/image")[:3, 3]
    if rig.model.visible("/axis/track"):
        track = rig.model.points("/axis/track").reshape(-1, 3)
        near(track[0], p.point, 1e-6)
        assert min(np.linalg.norm(track - image, axis=1)) < 0.05
        near(track @ n, np.array(p.point) @ n, 1e-6)


def line(rig: Rig, name: str) -> Array:
    """Pieces of a way's path and then its marks, about the middle of its sphere."""
    look = next(word for word in ("chosen", "ghost") if rig.model.visible(f"/ways/{name}/{word}"))
    pieces: Array = rig.model.points(f"/ways/{name}/{look}") - rig.model.world_pose(f"/ways/{name}")[:3, 3]
    return pieces


def marks(rig: Rig, name: str) -> Array:
    """Directions of the marks of a way."""
    ends = line(rig, name)[-13:].mean(axis=1)
    directions: Array = ends / np.linalg.norm(ends, axis=1)[:, None]
    return directions


def gaps(rig: Rig, name: str) -> Array:
    """Degrees between neighbouring marks."""
    at = marks(rig, name)
    apart: Array = np.degrees(2 * np.arcsin(np.linalg.norm(np.diff(at, axis=0), axis=1) / 2))
    return apart


@pytest.mark.parametrize("chosen", ["slerp", "nlerp", "euler"])
def test_marks_are_equally_far_apart_under_slerp_alone(rig: Rig, chosen: str) -> None:
    p = START.changed({"axis": (1, 1, 1), "angle": 160, "interpolation": chosen, "show": "path"})
    rig.show(p)
    slerp, nlerp, euler = (gaps(rig, name) for name in ("slerp", "nlerp", "euler"))
    near(slerp, slerp.mean(), 1e-3)
    assert nlerp.max() > 1.5 * nlerp.min()
    assert euler.max() > 1.1 * euler.min()
    assert nlerp[6] > slerp[6] > nlerp[0], "NLERP is fast in the middle"


@each_scene
def test_three_objects_go_side_by_side_from_start_to_target(rig: Rig, p: QuaternionParams) -> None:
    rig.show(p)
    s = solve(p)
    assert rig.model.visible("/ways") == (p.topic == "path") == bool(s.ways)
    middles = []
    for name, way in (s.ways or {}).items():
        middle = rig.model.world_pose(f"/ways/{name}")[:3, 3]
        middles.append(middle)
        near(rig.model.world_pose(f"/ways/{name}/object/hull")[:3, :3], rotation(way.q).as_matrix())
        nose = rig.model.world_pose(f"/ways/{name}/nose")[:3, 3] - middle
        near(nose / np.linalg.norm(nose), rotation(way.q).as_matrix()[:, 0])
        near(marks(rig, name)[0], begin(p).as_matrix()[:, 0], 1e-6)
        near(marks(rig, name)[-1], s.R_total[:, 0], 1e-6)
        assert rig.model.visible(f"/ways/{name}/chosen") == (name == p.interpolation)
        on_path = np.linalg.norm(line(rig, name)[:-13].reshape(-1, 3) - nose, axis=1)
        assert on_path.min() < 0.07, "the nose is on its path"
    if middles:
        near(middles[1] - middles[0], middles[2] - middles[1])
        assert np.linalg.norm(middles[1] - middles[0]) > 2 * 0.54, "no sphere is in another"


def pictures(p: QuaternionParams) -> Element:
    return xml("".join(each.svg for each in panes(p, solve(p))))


def handles(p: QuaternionParams) -> dict[str, tuple[float, float]]:
    """Where the picture's handles are."""
    found = [e for e in pictures(p).iter("g") if e.get("data-handle")]
    return {e.get("data-handle", ""): (float(e.get("data-x", 0)), float(e.get("data-y", 0))) for e in found}


@pytest.mark.parametrize("angle", [70.0, 90.0, 180.0, 200.0, 290.0, 500.0, 650.0])
def test_both_quaternions_are_in_the_ball(angle: float) -> None:
    for axis in AXES[:4]:
        p = START.changed({"axis": axis, "angle": angle, "show": "ball"})
        n, quarter = np.array(axis) / math.hypot(*axis), math.radians(angle) / 4
        places = {"q": pixel(math.tan(quarter) * n), "minus_q": pixel(-n / math.tan(quarter))}
        found = handles(p)
        for name, place in found.items():
            near(place, places[name], 1e-6)
        assert found.keys() == places.keys() or angle not in (180.0, 200.0)
        assert found, "one of them can be held"


@pytest.mark.parametrize(
    ("angle", "where"), [(0.0, "−q, farther"), (360.0, "q, farther"), (359.99, "q, farther"), (720.0, "−q, farther")]
)
def test_a_quaternion_at_infinity_is_pointed_to_in_short_words(angle: float, where: str) -> None:
    p = START.changed({"angle": angle, "show": "ball"})
    (ball,) = panes(p, solve(p))
    assert where in [e.text for e in xml(ball.svg).iter("text")]
    assert list(handles(p)) == ["q" if where[0] == "−" else "minus_q"]
    assert not re.search(r"\d{5}", ball.note), "ten digits say nothing"
    s = solve(p)
    assert all(at is None or np.abs(at).max() < 1e9 for at in (s.ball_q, s.ball_minus_q)), "infinity is no number"


def test_less_is_shown_until_it_is_asked_for(rig: Rig) -> None:
    rig.show(START)
    seen = {name.split("/")[1] for name in rig.model.names if rig.model.visible(name)}
    assert not seen & {"point", "image", "ways", "orders", "target"}
    assert {"object", "axis", "tip"} <= seen
    assert [pane.name for pane in panes(START, solve(START))] == ["dial"]


@pytest.mark.parametrize(
    ("query", "topic"),
    [
        ("angle=30", "turn"), ("t=0.5", "turn"), ("interpolation=nlerp&t=0.25", "path"), ("long_way=1", "path"),
        ("point=0,1,0.5", "point"), ("point=0,1,0.5&show=turn", "turn"), ("show_paths=1&show_point=1", "turn"),
    ],
)  # fmt: skip
def test_an_old_link_still_shows_what_it_is_about(query: str, topic: str) -> None:
    p = QuaternionParams.from_query(parse_qsl(query))
    assert p.topic == topic
    shown = SIM.offers(p).params
    assert (shown.show or "turn") == topic, "its fold is open"


# ---- the half angle


@pytest.mark.parametrize("angle", [0.0, 60.0, 180.0, 359.0, 360.0, 451.0, 720.0])
def test_the_second_dial_turns_half_as_far_and_holds_q(angle: float) -> None:
    p = START.changed({"axis": (0, 3, 4), "angle": angle})
    theta, half = handles(p)["theta"], handles(p)["half"]
    for hand, middle, turned in ((theta, TURN, angle), (half, HALF, angle / 2)):
        radians = math.radians(turned)
        near((hand[0] - middle[0], middle[1] - hand[1]), (RADIUS * math.cos(radians), RADIUS * math.sin(radians)), 1e-3)
    q = solve(p).q
    near((half[0] - HALF[0]) / RADIUS, q[0])
    near((HALF[1] - half[1]) / RADIUS * np.array([0, 0.6, 0.8]), q[1:])


def test_after_one_round_q_is_minus_q_and_after_two_it_is_q_again() -> None:
    q, minus, again = (solve(START.changed({"axis": (1, 2, 3), "angle": a})) for a in (0, 360, 720))
    near(q.q, -minus.q)
    near(q.q, again.q)
    first, second = (solve(START.changed({"axis": (1, 2, 3), "angle": a})) for a in (77, 437))
    near(first.q, -second.q)
    near(first.R_total, second.R_total)
    near(first.ball_q, second.ball_minus_q)


def dragged(p: QuaternionParams, name: str, to: tuple[float, float]) -> QuaternionParams:
    return p.moved(SIM.handles[name](p, to))


def test_a_hand_leads_the_angle_round_twice_and_back() -> None:
    p, seen = START.changed({"angle": 0}), []
    for degrees in (*range(0, 780, 20), *range(760, -60, -20)):
        p = dragged(p, "theta", at(TURN, math.radians(degrees), 50.0))
        seen.append(p.angle)
    near(seen, [*range(0, 721, 20), 720, 720, *([720] * 2), *range(720, -1, -20), 0, 0])
    for half in (10, 100, 190, 280, 350):
        p = dragged(p, "half", at(HALF, math.radians(half)))
        assert p.angle == 2 * half
    assert dragged(p, "half", HALF) == p, "the middle says nothing"


def test_keys_move_the_hands_from_wherever_they_are() -> None:
    """An arrow key leads a handle a pixel on; that must be a degree at least, in one of the two directions."""
    for angle in range(0, 720, 15):
        p = START.changed({"angle": angle})
        for name, (x, y) in handles(p).items():
            steps = {dragged(p, name, (x + dx, y + dy)).angle - angle for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1))}
            assert any(step > 0 for step in steps), (name, angle)
            assert any(step < 0 for step in steps) or angle == 0, (name, angle)


# ---- q in a hand


@given(states, st.floats(-150, 150), st.floats(-150, 150))
def test_q_goes_where_it_is_led_in_the_plane_of_the_picture(p: QuaternionParams, dx: float, dy: float) -> None:
    p = p.changed({"show": "ball", "angle": min(p.angle, 200)})
    before = solve(p)
    assert before.ball_q is not None
    x, y = pixel(before.ball_q)
    led = solve(dragged(p, "q", (x + dx, y + dy)))
    wanted = Rotation.from_mrp(before.ball_q + np.array([dx, dy]) / BALL_RADIUS @ SCREEN)
    assert (rotation(led.q).inv() * wanted).magnitude() < 4e-3, "as far as axis and angle are round numbers"
    if led.ball_q is not None and np.abs(led.ball_q).max() < 3:
        near(pixel(led.ball_q), (x + dx, y + dy), 2.0)


@given(states, st.floats(-60, 60), st.floats(-60, 60))
def test_minus_q_takes_q_with_it(p: QuaternionParams, dx: float, dy: float) -> None:
    p = p.changed({"show": "ball", "angle": max(p.angle, 170)})
    place = solve(p).ball_minus_q
    assert place is not None
    x, y = pixel(place)
    led = solve(dragged(p, "minus_q", (x + dx, y + dy)))
    if led.ball_minus_q is not None and np.abs(led.ball_minus_q).max() < 3:
        near(pixel(led.ball_minus_q), (x + dx, y + dy), 2.0)


def test_q_in_the_second_round_stays_there_and_the_middle_is_a_turn_by_nothing() -> None:
    p = START.changed({"show": "ball", "axis": (0, 1, 0), "angle": 500})
    x, y = handles(p)["q"]
    led = dragged(p, "q", (x + 4, y + 3))
    assert led.angle == pytest.approx(500, abs=20)
    near(led.axis, (0, 1, 0), 0.2)
    flat = START.changed({"axis": FLAT, "angle": 60, "show": "ball"})
    assert dragged(flat, "q", MIDDLE) == flat.changed({"angle": 0})
    assert dragged(flat.changed({"angle": 660}), "q", MIDDLE).angle == 720
    assert dragged(flat.changed({"angle": 300}), "minus_q", MIDDLE).angle == 360


# ---- two turns in both orders


@given(states, directions, st.floats(0, 360))
def test_both_orders_are_scipys(p: QuaternionParams, axis_b: tuple[float, ...], angle_b: float) -> None:
    p = p.changed({"show": "order", "axis_b": axis_b, "angle_b": angle_b, "t": 1.0})
    orders = solve(p).orders
    assert orders is not None
    a, b = turn(p), Rotation.from_rotvec(angle_b * np.array(axis_b) / math.hypot(*axis_b), degrees=True)
    near(rotation(orders.a_first).as_matrix(), (b * a).as_matrix())
    near(rotation(orders.b_first).as_matrix(), (a * b).as_matrix())
    near(rotation(orders.left).as_matrix(), (b * a * begin(p)).as_matrix())
    near(rotation(orders.right).as_matrix(), (a * b * begin(p)).as_matrix())
    apart = (b * a * (a * b).inv()).magnitude()
    near(math.cos(math.radians(orders.apart)), math.cos(apart), 1e-7)
    half_way = solve(p.changed({"t": 0.5})).orders
    assert half_way is not None
    near(rotation(half_way.left).as_matrix(), (a * begin(p)).as_matrix())
    near(rotation(half_way.right).as_matrix(), (b * begin(p)).as_matrix())


def test_two_objects_stand_where_both_orders_lead(rig: Rig) -> None:
    for t in (0.0, 0.3, 0.5, 0.9, 1.0):
        p = START.changed({"show": "order", "axis_b": (1, 1, 0), "angle_b": 100, "t": t})
        rig.show(p)
        orders = solve(p).orders
        assert orders is not None
        for side, q in (("left", orders.left), ("right", orders.right)):
            near(rig.model.world_pose(f"/orders/{side}/object/hull")[:3, :3], rotation(q).as_matrix())
            for letter, n in (("A", (0, 0, 1)), ("B", (HALF_ROOT, HALF_ROOT, 0))):
                tail, tip = rig.model.points(f"/orders/{side}/{letter}")[0]
                near(tail, rig.model.world_pose(f"/orders/{side}")[:3, 3], 1e-6)
                near(tip - tail, n, 1e-6)
    assert {"A first, then B", "B first, then A"} <= set(rig.model.labels().values())


@pytest.mark.parametrize(("axis_b", "said"), [((1, 0, 0), "120.0° apart"), ((0, 0, -2), "both orders end the same")])
def test_whether_the_order_matters_is_said(axis_b: tuple[float, float, float], said: str) -> None:
    p = START.changed({"show": "order", "axis_b": axis_b})
    read = words(readout.render(SIM.readouts(p, solve(p))))
    assert said in read
    assert "First A, then B" in read


# ---- what a fold begins with


def test_the_comparison_opens_with_a_turn_where_the_ways_differ(rig: Rig) -> None:
    rig.show(START)
    rig.browser.move("show", "path")
    rig.settle()
    p = rig.session.params
    assert isinstance(p, QuaternionParams)
    assert (p.topic, p.t) == ("path", 0.25)
    ways = solve(p).ways
    assert ways is not None
    turned = [way.turned for way in ways.values()]
    assert turned[0] - turned[1] > 5.0, "SLERP is ahead of NLERP"
    assert math.degrees(math.acos(ways["slerp"].at @ ways["euler"].at)) > 10.0
    rig.browser.move("show", "turn")
    rig.settle()
    assert rig.session.params == p.changed({"show": "turn", "t": 1.0}), "the object is at its target again"


def test_a_turn_that_tells_stays_as_it_is(rig: Rig) -> None:
    start = START.changed({"axis": (1, 1, 1), "angle": 150})
    rig.show(start)
    rig.browser.move("show", "path")
    rig.settle()
    assert rig.session.params == start.changed({"show": "path", "t": 0.25})
    rig.browser.move("t", 0.4)
    rig.settle()
    assert rig.session.params == start.changed({"show": "path", "t": 0.4}), "only the opening changes anything"


def test_both_orders_open_with_a_turn_to_make(rig: Rig) -> None:
    rig.show(START.changed({"angle": 0}))
    rig.browser.move("show", "order")
    rig.settle()
    orders = rig.session.solution.orders
    assert orders is not None
    assert orders.apart > 30.0


def test_t_is_held_in_the_plot() -> None:
    p = START.changed({"show": "path", "angle": 170, "t": 0.25})
    assert "t" in handles(p)
    assert dragged(p, "t", (0.333, 12.0)).t == 0.33
    assert dragged(p, "t", (1.4, 0.0)).t == 1.0


# ---- hands


def test_the_tip_is_dragged_to_a_direction(rig: Rig) -> None:
    rig.show(START)
    rig.browser.drag("/tip", (0.3, 0.4, 1.0), (1.2, -0.9, 0.0))
    rig.settle()
    assert rig.session.params == START.changed({"axis": (0.8, -0.6, 0.0)})
    near(rig.model.world_pose("/tip")[:3, 3], 1.7 * np.array([0.8, -0.6, 0.0]))
    near(rig.model.world_pose("/object")[:3, :3], Rotation.from_rotvec([72, -54, 0], degrees=True).as_matrix())
    rig.browser.drag("/tip", (0.0, 0.0, 0.0))
    rig.settle()
    assert rig.session.params.axis == (0.8, -0.6, 0.0), "no direction there: the last one stays"


@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (1.0, -0.5, 0.4), (0.0, -2.0, -0.3)])
@pytest.mark.parametrize("far", [0.9, 1.4])
def test_the_axis_is_turned_wherever_it_is_taken(rig: Rig, axis: tuple[float, float, float], far: float) -> None:
    """The spot of its arrow that was taken stays under the pointer."""
    p = START.changed({"axis": axis})
    rig.show(p)
    taken = far * solve(p).n
    eye = np.asarray(rig.browser.client.camera.position)
    aim = Rotation.from_rotvec((0.15, -0.2, 0.1)).apply(taken)
    rig.browser.drag("/axis/grasp", tuple((eye + 1.2 * (aim - eye)).tolist()), taken=tuple(taken.tolist()))
    rig.settle()
    now = rig.session.params
    assert isinstance(now, QuaternionParams)
    assert now == p.changed({"axis": now.axis})
    np.testing.assert_allclose(far * rig.session.solution.n, aim, rtol=0, atol=2e-3)
    near(rig.model.world_pose("/tip")[:3, 3] / 1.7, rig.session.solution.n)


@pytest.mark.parametrize("angle", [0.0, 100.0, 359.0, 410.0, 660.0])
def test_the_object_is_turned_wherever_it_is_taken(rig: Rig, angle: float) -> None:
    """It has come there by one turn from its start, whose q goes on from where it was."""
    p = QuaternionParams().changed({"axis": (1, 2, 3), "angle": angle, "start": (0.8, 0.6, 0, 0)})
    rig.show(p)
    places = rig.model.points("/object/hull")
    taken = places[np.linalg.norm(places, axis=1) > 0.7][3]
    eye = np.asarray(rig.browser.client.camera.position)
    own = rig.model.world_pose("/object")[:3, :3].T @ taken
    aim = Rotation.from_rotvec((0.1, -0.2, 0.15)).apply(taken)
    rig.browser.drag("/object/hull", tuple((eye + 1.2 * (aim - eye)).tolist()), taken=tuple(taken.tolist()))
    rig.settle()
    np.testing.assert_allclose(rig.model.world_pose("/object")[:3, :3] @ own, aim, rtol=0, atol=5e-3)
    assert np.array(rig.session.solution.q) @ solve(p).q > 0.95


@pytest.mark.parametrize("angle", [0.0, 90.0, 355.0, 400.0, 720.0])
def test_the_arc_of_the_angle_is_led_round(rig: Rig, angle: float) -> None:
    p = QuaternionParams().changed({"axis": (1, -1, 2), "angle": angle})
    rig.show(p)
    ends = [solve(p.changed({"angle": min(angle + more, 720.0)})) for more in (8.0, 16.0)]
    grip = rig.model.world_pose("/angle")[:3, 3]
    np.testing.assert_allclose(grip, rig.model.points("/axis/turn/end")[0, 1], rtol=0, atol=1e-5)
    turned = [Rotation.from_rotvec(math.radians(more) * ends[0].n).apply(grip) for more in (8.0, 16.0)]
    rig.browser.drag("/angle", *(tuple(place.tolist()) for place in turned))
    rig.settle()
    assert rig.column.values["angle"] == pytest.approx(min(angle + 16.0, 720.0))


def test_p_is_dragged_and_its_image_follows(rig: Rig) -> None:
    start = START.changed({"show": "point"})
    rig.show(start)
    rig.browser.drag("/point", (0.5, 0.25, -0.5), (0.2, 9.0, -0.4))
    rig.settle()
    assert rig.session.params == start.changed({"point": (0.2, 2.0, -0.4)})
    near(rig.model.world_pose("/image")[:3, 3], (-2.0, 0.2, -0.4))


def test_the_object_turns_while_the_angle_is_moved(rig: Rig) -> None:
    rig.show(START)
    for angle in (10.0, 123.0, 359.0, 480.0):
        rig.browser.move("angle", angle)
        rig.settle()
        near(rig.model.world_pose("/object")[:3, :3], Rotation.from_euler("z", angle, degrees=True).as_matrix())


def test_presets_set_the_axis_and_name_it(rig: Rig) -> None:
    rig.show(START)
    assert rig.column.values["axis:preset"] == "z"
    for word, axis in PRESETS.items():
        rig.browser.move("axis:preset", word)
        rig.settle()
        assert rig.session.params == START.changed({"axis": axis})
    rig.browser.move("axis", [0.0, 1.0, 2.0])
    rig.settle()
    assert rig.column.values["axis:preset"] == ""
    rig.browser.move("axis:preset", "x")
    rig.browser.move("axis:preset", "")
    rig.settle()
    assert rig.column.values["axis:preset"] == "x", "there is no other axis to choose"


# ---- what is refused


def test_a_zero_axis_from_a_control_is_refused_with_a_message_and_the_last_state_stays(rig: Rig) -> None:
    rig.browser.told.clear()
    good = START.changed({"axis": (0.0, 2.0, 0.0)})
    rig.show(good)
    before = rig.model.snapshot()
    rig.browser.move("axis", [0.0, 0.0, 0.0])
    rig.settle()
    assert rig.browser.refused == ["The axis must not be zero: zero has no direction."]
    assert rig.session.params == good
    assert rig.column.vector("axis") == [0.0, 2.0, 0.0]
    assert rig.model.snapshot().keys() == before.keys()
    rig.browser.move("angle", 45.0)
    rig.settle()
    assert rig.session.params == good.changed({"angle": 45.0})


@pytest.mark.parametrize(
    ("query", "name"),
    [
        ("axis=0,0,0", "axis"),
        ("axis=1e-12,0,0", "axis"),
        ("axis_b=0,0,0", "axis_b"),
        ("start=0,0,0,0", "start"),
        ("history=0,0,1", "history"),
        ("history=0,0,0,90", "history"),
        ("history=0,0,1,-90", "history"),
        ("history=0,0,11,90", "history"),
    ],
)
def test_a_link_to_what_cannot_be_is_refused_by_name(query: str, name: str) -> None:
    with pytest.raises(BadParams) as refused:
        QuaternionParams.from_query([*parse_qsl(query), ("angle", "30")])
    assert [complaint[0] for complaint in refused.value.complaints] == [name]
    assert refused.value.good == {"angle": "30"}


@given(st.floats(1e-9, 10, allow_subnormal=False), st.sampled_from(AXES[:3]))
def test_an_axis_of_any_length_turns_the_same(length: float, axis: tuple[int, int, int]) -> None:
    unit = np.array(axis) / math.hypot(*axis)
    s = solve(START.changed({"axis": tuple((length * unit).tolist())}))
    near(s.q, solve(START.changed({"axis": axis})).q)
    assert np.linalg.norm(s.q) == pytest.approx(1.0)


def test_that_the_axis_is_put_at_length_one_is_said() -> None:
    def said(axis: tuple[float, float, float]) -> str:
        p = START.changed({"axis": axis})
        return words(readout.render(SIM.readouts(p, solve(p))))

    assert "Your axis (0.00, 3.00, 4.00) has length 5.00. n = (0.00, 0.60, 0.80) has length 1." in said((0, 3, 4))
    assert "has length" not in said((0, 0, 1))


@pytest.mark.parametrize(
    ("changes", "said", "warned"),
    [
        ({"angle": 0}, "No angle", False),
        ({"angle": 360}, "A whole turn: q is −1", False),
        ({"angle": 450}, "a whole turn and 90°", False),
        ({"angle": 720}, "q is 1 again", False),
        ({"angle": 180, "show": "path"}, "both ways are equally long", True),
        ({"angle": 180, "long_way": True}, "both ways are equally long", True),
        ({"axis": (0, 1, 0), "show_euler": True}, "Gimbal lock", True),
    ],
)
def test_what_is_special_is_said_in_words(changes: dict[str, Any], said: str, warned: bool) -> None:
    p = START.changed(changes)
    html = readout.render(SIM.readouts(p, solve(p)))
    assert said in words(html)
    assert ("s3-near" in html) == warned
    plain = readout.render(SIM.readouts(START, solve(START)))
    assert said not in words(plain)
    assert "s3-near" not in plain


# ---- composition


def after(p: QuaternionParams, name: str) -> QuaternionParams:
    """The state after a button, and after its motion."""
    result = next(action for action in SIM.actions if action.name == name).run(p)
    for changes in [result] if isinstance(result, Mapping) else [step.changes for step in result]:
        p = p.changed(changes)
    return p


@given(states.map(lambda p: p.changed({"t": 1.0, "angle": p.angle or 5.0})))
def test_a_turn_made_and_undone_leaves_everything_as_it_was(p: QuaternionParams) -> None:
    made = after(p, "apply")
    assert made.turns == [(*p.axis, p.angle)]
    near(rotation(made.start).as_matrix(), solve(p).R_total)
    back = after(made, "undo")
    near(back.start, np.array(p.start) / math.hypot(*p.start), 1e-11)
    assert back == p.changed({"start": back.start, "show": back.show})
    assert after(back, "undo") == back, "nothing is left to undo"


def test_no_angle_is_no_turn(rig: Rig) -> None:
    p = START.changed({"angle": 0})
    assert after(p, "apply") == p
    once = after(START, "apply")
    assert after(once, "apply") == once, "pressed again, before there is another angle"
    rig.show(p)
    rig.browser.press("apply")
    rig.settle()
    assert rig.session.params == p
    assert not rig.browser.told[-1].get("errors")


def test_one_button_makes_a_turn_and_knows_the_name_of_the_other() -> None:
    known = {name: action for action in SIM.actions for name in action.names}
    assert known["apply"] is known["compose"], "course pages send either"
    assert known["apply"].label == "Make this turn"


def test_while_a_turn_is_made_the_object_turns_about_its_axis_all_the_way() -> None:
    p = START.changed({"axis": (0, 1, 0), "angle": 300})
    steps = list(actions.apply(p))
    assert [step.changes.get("angle") for step in steps] == [0.0, 0.0, 300, 0.0]
    assert steps[2].seconds > 0.5


def test_undone_turns_give_back_the_very_link() -> None:
    p = first = START.changed({"axis": (1, 1, 1), "angle": 77})
    for axis in AXES:
        p = after(p.changed({"axis": axis, "angle": 31.5}), "apply")
    for _ in AXES:
        p = after(p, "undo")
    assert p.changed({"axis": first.axis, "angle": 77}).query() == first.query()


@given(states.filter(lambda p: p.angle > 0))
def test_after_a_turn_the_object_stays_where_it_is(p: QuaternionParams) -> None:
    made = after(p, "apply")
    near(solve(made).interpolated.R, solve(p).R_total)
    assert (made.angle, made.t, made.axis) == (0.0, 1.0, p.axis)
    assert made.topic not in ("order", "path"), "it is seen"


def test_the_order_of_two_quarter_turns_matters() -> None:
    def both(*axes: tuple[int, int, int]) -> Array:
        p = START
        for axis in axes:
            p = after(p.changed({"axis": axis, "angle": 90}), "apply")
        assert [turn[:3] for turn in p.turns] == list(axes)
        return solve(p).R_total

    xy, yx = both((1, 0, 0), (0, 1, 0)), both((0, 1, 0), (1, 0, 0))
    near(xy, Rotation.from_euler("xy", [90, 90], degrees=True).as_matrix())
    near(yx, Rotation.from_euler("yx", [90, 90], degrees=True).as_matrix())
    assert np.abs(xy - yx).max() > 0.5


@given(states)
def test_the_list_of_turns_fits_in_a_link(p: QuaternionParams) -> None:
    for k in range(MOST_TURNS + 2):
        p = after(p.changed({"angle": 31.4159265 + k}), "apply")
    assert 1 <= len(p.turns) <= MOST_TURNS
    assert len(spell(p.history)) <= LONGEST_VALUE
    assert QuaternionParams.from_query(parse_qsl(p.query())) == p


def test_short_turns_are_all_kept_and_listed() -> None:
    p = START
    for k in range(MOST_TURNS):
        p = after(p.changed({"axis": (1, 1, 0), "angle": 10.0 * k + 10.0}), "apply")
    assert len(p.turns) == MOST_TURNS
    said = words(readout.render(SIM.readouts(p, solve(p))))
    assert "1. (1, 1, 0) 10°" in said
    assert "8. (1, 1, 0) 80°" in said


def test_too_many_turns_are_refused() -> None:
    with pytest.raises(ValidationError):
        START.changed({"history": (0.0, 0.0, 1.0, 90.0) * (MOST_TURNS + 1)})


@pytest.mark.parametrize("topic", TOPICS)
def test_play_leads_through_what_is_shown_and_says_what_to_see(topic: str) -> None:
    p = START.changed({"show": topic, "t": 1.0})
    steps = list(actions.play(p))
    runs = "t" if topic in ("order", "path") else "angle"
    assert steps[0].changes[runs] == 0.0
    assert steps[-1].changes == {runs: getattr(p, runs)}
    assert 0.4 <= sum(step.seconds for step in steps) <= 3.0
    assert steps[-1].words
    assert after(p, "play") == p, "nothing comes of it"
