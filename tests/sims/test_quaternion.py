"""quaternion: its numbers against SciPy, what a browser is sent, composition and undo, what is refused."""

from __future__ import annotations

import math
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
from sims.quaternion.panes import panes, pixel
from sims.quaternion.params import MOST_TURNS, PRESETS
from tests.server import Rig
from tests.sims.markup import words, xml

Array = npt.NDArray[np.float64]
START = QuaternionParams()
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
    s = solve(p)
    for name, way in s.ways.items():
        near(way.path[0], begin(p).as_matrix()[:, 0])
        near(way.path[-1], s.R_total[:, 0], 1e-7)
        near(np.linalg.norm(way.path, axis=1), 1.0)
        third = solve(p.changed({"interpolation": name, "t": 1 / 3})).interpolated.R[:, 0]
        near(way.marks[4].mean(axis=0) / np.linalg.norm(way.marks[4].mean(axis=0)), third, 1e-6)


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


def scenes() -> Iterator[QuaternionParams]:
    """Named states, every axis by many angles, and random ones."""
    yield from (START.changed(changes) for changes in SIM.states.values())
    yield from (START.changed({"axis": a, "angle": d, "t": 0.4}) for a in AXES for d in (1, 90, 180, 240, 359))
    random = np.random.default_rng(7)
    for _ in range(20):
        yield START.changed(
            {
                "axis": tuple(random.normal(size=3)),
                "angle": random.uniform(0, 360),
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
    for body in ("hull", "mark", "arrows"):
        near(rig.model.world_pose(f"/object/{body}")[:3, :3], s.interpolated.R)
    for name, R in (("/start", begin(p).as_matrix()), ("/target", s.R_total)):
        if rig.model.visible(name):
            near(rig.model.world_pose(f"{name}/hull")[:3, :3], R)
        else:
            near(s.interpolated.R, R, 1e-5)
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
    assert rig.model.visible("/axis/turn") == (p.angle > 0)
    if p.angle == 0:
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
    half = Rotation.from_rotvec(math.radians(p.angle) / 2 * n).apply(begins)
    near(arc[len(arc) // 2], half, 1e-6)
    image = rig.model.world_pose("/image")[:3, 3]
    if rig.model.visible("/axis/track"):
        track = rig.model.points("/axis/track").reshape(-1, 3)
        near(track[0], p.point, 1e-6)
        assert min(np.linalg.norm(track - image, axis=1)) < 0.05
        near(track @ n, np.array(p.point) @ n, 1e-6)


def marks(rig: Rig, name: str) -> Array:
    """Directions of the marks that are seen of a way."""
    look = next(word for word in ("chosen", "ghost") if rig.model.visible(f"/sphere/{name}/{word}"))
    ends = rig.model.points(f"/sphere/{name}/{look}")[-13:].mean(axis=1)
    directions: Array = ends / np.linalg.norm(ends, axis=1)[:, None]
    return directions


def gaps(rig: Rig, name: str) -> Array:
    """Degrees between neighbouring marks."""
    at = marks(rig, name)
    apart: Array = np.degrees(2 * np.arcsin(np.linalg.norm(np.diff(at, axis=0), axis=1) / 2))
    return apart


@pytest.mark.parametrize("chosen", ["slerp", "nlerp", "euler"])
def test_marks_are_equally_far_apart_under_slerp_alone(rig: Rig, chosen: str) -> None:
    p = START.changed({"axis": (1, 1, 1), "angle": 160, "interpolation": chosen})
    rig.show(p)
    slerp, nlerp, euler = (gaps(rig, name) for name in ("slerp", "nlerp", "euler"))
    near(slerp, slerp.mean(), 1e-3)
    assert nlerp.max() > 1.5 * nlerp.min()
    assert euler.max() > 1.1 * euler.min()
    assert nlerp[6] > slerp[6] > nlerp[0], "NLERP is fast in the middle"


@each_scene
def test_drawn_paths_begin_at_the_start_and_end_at_the_target(rig: Rig, p: QuaternionParams) -> None:
    rig.show(p)
    s = solve(p)
    thick = rig.model.points(f"/sphere/{p.interpolation}/chosen")
    near(thick[0, 0], begin(p).as_matrix()[:, 0], 1e-6)
    for name in s.ways:
        near(marks(rig, name)[0], begin(p).as_matrix()[:, 0], 1e-6)
        near(marks(rig, name)[-1], s.R_total[:, 0], 1e-6)
        assert rig.model.visible(f"/sphere/{name}/chosen") == (name == p.interpolation)
    line = thick[: -len(s.ways[p.interpolation].marks)].reshape(-1, 3)
    at = s.interpolated.R[:, 0]
    assert min(np.linalg.norm(line - at, axis=1)) < 0.12, "the nose is on its path"


def dots(p: QuaternionParams) -> list[Element]:
    svg = xml("".join(each.svg for each in panes(p, solve(p))))
    return [e for e in svg.iter("circle") if e.get("stroke") == "var(--held)"]


@pytest.mark.parametrize("angle", [70.0, 90.0, 180.0, 200.0, 290.0])
def test_both_quaternions_are_in_the_picture(angle: float) -> None:
    for axis in AXES[:4]:
        p = START.changed({"axis": axis, "angle": angle})
        n, quarter = np.array(axis) / math.hypot(*axis), math.radians(angle) / 4
        places = {"s3-dot": pixel(math.tan(quarter) * n), "s3-hollow": pixel(-n / math.tan(quarter))}
        for dot in dots(p):
            at = float(dot.get("cx", 0)), float(dot.get("cy", 0))
            near(at, places[dot.get("class", "")], 0.01)
        assert {dot.get("class") for dot in dots(p)} == {"s3-dot", "s3-hollow"} or angle in (70.0, 290.0)


@pytest.mark.parametrize(("angle", "where"), [(0.0, "−q, farther"), (360.0, "q, farther")])
def test_a_quaternion_at_infinity_is_pointed_to(angle: float, where: str) -> None:
    p = START.changed({"angle": angle})
    texts = [e.text for each in panes(p, solve(p)) for e in xml(each.svg).iter("text")]
    assert where in texts
    assert len(dots(p)) == 1


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


def test_p_is_dragged_and_its_image_follows(rig: Rig) -> None:
    rig.show(START)
    rig.browser.drag("/point", (0.5, 0.25, -0.5), (0.2, 9.0, -0.4))
    rig.settle()
    assert rig.session.params == START.changed({"point": (0.2, 2.0, -0.4)})
    near(rig.model.world_pose("/image")[:3, 3], (-2.0, 0.2, -0.4))


def test_the_object_turns_while_the_angle_is_moved(rig: Rig) -> None:
    rig.show(START)
    for angle in (10.0, 123.0, 359.0):
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

    assert "Your axis (0.00, 3.00, 4.00) has length 5.00" in said((0, 3, 4))
    assert "has length" not in said((0, 0, 1))


@pytest.mark.parametrize(
    ("changes", "said", "warned"),
    [
        ({"angle": 0}, "No angle", False),
        ({"angle": 360}, "A whole turn: q is −1", True),
        ({"angle": 180}, "both ways are equally long", True),
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


@given(states.map(lambda p: p.changed({"t": 1.0, "interpolation": "slerp"})), st.sampled_from(["apply", "compose"]))
def test_a_turn_made_and_undone_leaves_everything_as_it_was(p: QuaternionParams, how: str) -> None:
    made = after(p, how)
    assert made.turns == [(*p.axis, p.angle)]
    near(rotation(made.start).as_matrix(), solve(p).R_total)
    back = after(made, "undo")
    near(back.start, np.array(p.start) / math.hypot(*p.start), 1e-11)
    assert back == p.changed({"start": back.start})
    assert after(back, "undo") == back, "nothing is left to undo"


def test_undone_turns_give_back_the_very_link() -> None:
    p = first = START.changed({"axis": (1, 1, 1), "angle": 77})
    for axis in AXES:
        p = after(p.changed({"axis": axis, "angle": 31.5}), "apply")
    for _ in AXES:
        p = after(p, "undo")
    assert p.changed({"axis": first.axis, "angle": 77}).query() == first.query()


@given(states)
def test_after_apply_the_object_stays_where_it_is(p: QuaternionParams) -> None:
    made = after(p, "apply")
    near(solve(made).interpolated.R, solve(p).R_total)
    assert (made.angle, made.t, made.axis) == (0.0, 1.0, p.axis)


def test_composing_again_makes_the_turn_again() -> None:
    p = START.changed({"angle": 30})
    for k in range(1, 4):
        p = after(p, "compose")
        near(solve(p).R_total, Rotation.from_euler("z", 30 * (k + 1), degrees=True).as_matrix())


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
    for _ in range(MOST_TURNS + 2):
        p = after(p, "compose")
    assert 1 <= len(p.turns) <= MOST_TURNS
    assert len(spell(p.history)) <= LONGEST_VALUE
    assert QuaternionParams.from_query(parse_qsl(p.query())) == p


def test_short_turns_are_all_kept_and_listed() -> None:
    p = START
    for k in range(MOST_TURNS):
        p = after(p.changed({"axis": (1, 1, 0), "angle": 10.0 * k}), "apply")
    assert len(p.turns) == MOST_TURNS
    said = words(readout.render(SIM.readouts(p, solve(p))))
    assert "1. (1, 1, 0) 0°" in said
    assert "8. (1, 1, 0) 70°" in said


def test_too_many_turns_are_refused() -> None:
    with pytest.raises(ValidationError):
        START.changed({"history": (0.0, 0.0, 1.0, 90.0) * (MOST_TURNS + 1)})


def test_play_leads_from_start_to_target() -> None:
    steps = list(actions.play(START))
    assert steps[0].changes == {"t": 0.0}
    assert steps[-1].changes == {"t": 1.0}
    assert 0.4 <= sum(step.seconds for step in steps) <= 1.5
