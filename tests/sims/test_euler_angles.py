"""euler-angles: names in every order, what is left at lock, what can be held, and how the product builds up."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from geometry.euler import FRAMES, ORDERS
from sims.euler_angles import SIM, EulerParams, solve
from sims.euler_angles.actions import ARCS, BODY
from sims.kit import readout
from sims.kit.column import Column
from tests.server import Rig
from tests.sims.markup import words

Array = npt.NDArray[np.float64]
START = EulerParams()
PARTS = ("/turn1/turn2/turn3/hull", "/turn1/turn2/turn3/mark")
CONVENTIONS = list(product(ORDERS, FRAMES))
each_convention = pytest.mark.parametrize(("order", "frame"), CONVENTIONS)
conventions = st.sampled_from(CONVENTIONS)
shares = st.tuples(*[st.floats(0.0, 1.0)] * 3)


@pytest.fixture(scope="module")
def rig() -> Iterator[Rig]:
    with Rig(SIM) as rig:
        yield rig


def state(order: str = "zyx", frame: str = "intrinsic", **changes: Any) -> EulerParams:
    return START.moved({"order": order, "frame": frame}).changed(changes)


def within(order: str, frame: str, parts: tuple[float, float, float]) -> EulerParams:
    """A state with its angles so far between their bounds."""
    start = state(order, frame)
    spans = {name: start.bounds(name) for name in ("yaw", "pitch", "roll")}
    return start.changed({n: low + (high - low) * s for (n, (low, high)), s in zip(spans.items(), parts, strict=True)})


def scipys(p: EulerParams, angles: Any = None) -> Array:
    order = p.order.upper() if p.frame == "intrinsic" else p.order
    matrix: Array = Rotation.from_euler(order, p.angles if angles is None else angles, degrees=True).as_matrix()
    return matrix


def shown(p: EulerParams, fold: str = "") -> str:
    return words(readout.render(readout.folded(SIM.readouts(p, solve(p)))[fold]))


# ---- one source of names


@each_convention
def test_sliders_words_and_hints_call_the_turns_alike(order: str, frame: str) -> None:
    proper = order[0] == order[2]
    for p in (
        state(order, frame),
        state(order, frame, progress=1.5),
        state(order, frame, pitch=0.0 if proper else 90.0),
    ):
        said = " ".join((SIM.caption(p, solve(p)), SIM.describe(p, solve(p)), shown(p)))
        wrong = "yaw|pitch|roll|ψ|θ|φ" if proper else "first angle|second angle|third angle|α|β|γ"
        assert not re.search(rf"\b({wrong})\b", said), said
    for k, name in enumerate(p.names):
        axis = order[k].upper()
        label, about = p.label(name), p.about(name)
        assert label.endswith(f" · {axis}{'′' * k if frame == 'intrinsic' else ''}")
        assert about.startswith(("First", "Second", "Third")[k])
        assert f"about the {'aircraft’s own' if frame == 'intrinsic' else 'world’s fixed'} {axis}" in about
        assert about in Column(SIM).html(p, solve(p)).replace("&#x27;", "'")
        caption = SIM.caption(p.changed({"progress": k + 0.5}), solve(p.changed({"progress": k + 0.5})))
        if not solve(p).locked:
            assert p.turns[k].said in caption


@each_convention
def test_sliders_stand_in_the_order_of_the_turns(order: str, frame: str) -> None:
    p = state(order, frame)
    html = Column(SIM).html(p, solve(p))
    found = re.findall(r'data-part="control:(yaw|pitch|roll)"', html)
    assert tuple(found) == p.names
    assert Column(SIM).of(p, solve(p)).parts["arranged"].split() == ["order", "frame", *p.names, "progress"]


@pytest.mark.parametrize(
    ("axis", "does"), [("z", "nose to the left"), ("y", "lowers the nose"), ("x", "lifts the left wing")]
)
def test_what_a_positive_turn_does_is_what_it_is_said_to_do(axis: str, does: str) -> None:
    R = Rotation.from_euler(axis, 20, degrees=True).as_matrix()
    nose, wing = R[:, 0], R[:, 1]
    assert {"z": nose[1] > 0, "y": nose[2] < 0, "x": wing[2] > 0}[axis]
    p = state("zyx")
    assert does in p.about({"z": "yaw", "y": "pitch", "x": "roll"}[axis])


def test_that_positive_pitch_lowers_the_nose_is_said_once() -> None:
    assert shown(START).count("Positive pitch lowers the nose: with Z up") == 1
    assert "lowers the nose" not in shown(state(pitch=-20.0))


# ---- lock


@each_convention
def test_what_is_left_at_lock_is_said_and_alone_counts(order: str, frame: str) -> None:
    for lock in state(order, frame).locks:
        start = state(order, frame, yaw=50.0, roll=35.0)
        start = start.changed({**dict.fromkeys(start.names, 40.0), start.names[1]: lock})
        solution = solve(start)
        assert solution.locked
        assert solution.left is not None
        first, _, third = start.turns
        sign = "+" if solution.left.sign > 0 else "−"
        value = start.angles[0] + solution.left.sign * start.angles[2]
        assert (
            f"Only the {'sum' if sign == '+' else 'difference'} {first.symbol} {sign} {third.symbol} = {value:.1f}°"
            in shown(start)
        )
        moved = (start.angles[0] - solution.left.sign * 25.0, lock, start.angles[2] + 25.0)
        np.testing.assert_allclose(scipys(start, moved), scipys(start), rtol=0, atol=1e-12)
        elsewhere = (start.angles[0] + solution.left.sign * 25.0, lock, start.angles[2] + 25.0)
        assert np.abs(scipys(start, elsewhere) - scipys(start)).max() > 0.3


@pytest.mark.parametrize(("pitch", "said"), [(90.0, "ψ − φ = 20.0°"), (-90.0, "ψ + φ = 40.0°")])
def test_at_the_locks_of_zyx_the_textbooks_combinations_are_left(pitch: float, said: str) -> None:
    assert said in shown(state(pitch=pitch))


@each_convention
def test_both_locks_stand_on_the_circle_of_the_middle_turn(rig: Rig, order: str, frame: str) -> None:
    p = state(order, frame)
    rig.show(p)
    name = next(name for name in rig.model.names if name.endswith("/arc1/circle"))
    arc = name.removesuffix("/circle")
    labels = rig.model.labels()
    circle = rig.model.points(name).reshape(-1, 3)
    radius = np.linalg.norm(circle, axis=1)
    np.testing.assert_allclose(radius, radius[0], rtol=1e-5)
    assert np.linalg.norm(circle.mean(axis=0)) < 0.05, "it isn't whole"
    for lock in p.locks:
        assert labels[f"{arc}/words{lock:.0f}"].endswith(f"lock at {readout.quantity(lock, '°', 0)}")
        place = rig.model.world_pose(f"{arc}/words{lock:.0f}")[:3, 3]
        rig.show(p.changed({p.names[1]: lock}))
        end = solve(p.changed({p.names[1]: lock})).ends[1]
        np.testing.assert_allclose(place / np.linalg.norm(place), end / np.linalg.norm(end), rtol=0, atol=1e-6)
        assert rig.model.labels()[f"{arc}/words{lock:.0f}"].startswith("⚠")
        rig.show(p)


def test_the_roll_arc_is_outside_the_wing_and_clear_of_the_other_arcs(rig: Rig) -> None:
    rig.show(START)
    radii = [np.linalg.norm(rig.model.points(f"{before}/arc{k}/line"), axis=-1).mean() for k, before in
             enumerate(("", "/turn1", "/turn1/turn2"))]  # fmt: skip
    wing = np.linalg.norm(rig.model.points("/turn1/turn2/turn3/mark"), axis=1).max()
    assert min(radii) > wing + 0.1
    assert min(abs(a - b) for a, b in ((radii[0], radii[1]), (radii[0], radii[2]), (radii[1], radii[2]))) > 0.1


# ---- what can be held


@each_convention
def test_grips_are_where_arcs_nose_and_wing_end(rig: Rig, order: str, frame: str) -> None:
    p = state(order, frame)
    rig.show(p)
    assert set(rig.model.draggable()) == {*ARCS, *BODY, *PARTS}
    for k, (grip, before) in enumerate(zip(ARCS, ("", "/turn1", "/turn1/turn2"), strict=True)):
        end = rig.model.points(f"{before}/arc{k}/end")[0, 1]
        np.testing.assert_allclose(rig.model.world_pose(grip)[:3, 3], end, rtol=0, atol=1e-5)
    for grip, spot in BODY.items():
        place = rig.model.world_pose(grip)[:3, 3]
        np.testing.assert_allclose(place / np.linalg.norm(place), scipys(p) @ spot, rtol=0, atol=1e-9)
    rig.show(p.changed({"progress": 1.5}))
    assert not any(rig.model.visible(grip) for grip in (*ARCS, *BODY)), "a turn half made is held by its slider"


@given(conventions, shares, st.floats(0.0, 1.0))
def test_an_arc_is_led_to_any_angle(
    convention: tuple[str, str], parts: tuple[float, float, float], share: float
) -> None:
    p = within(*convention, parts)
    for k, (grip, name) in enumerate(zip(ARCS, p.names, strict=True)):
        low, high = p.bounds(name)
        aim = p.changed({name: low + share * (high - low)})
        if abs(getattr(aim, name) - getattr(p, name)) > 179.0:
            continue  # half a turn has no direction
        found = p.changed(SIM.handles[grip](p, tuple((1.7 * solve(aim).ends[k]).tolist())))
        assert math.remainder(getattr(found, name) - getattr(aim, name), 360.0) == pytest.approx(0.0, abs=1e-7)
        assert SIM.handles[grip](p, (0.0, 0.0, 0.0)) == {}


def test_an_arc_pulled_beyond_its_end_stays_there() -> None:
    p = state(pitch=85.0)
    for beyond in (95.0, 150.0, -130.0):
        turn = Rotation.from_euler("zy", (beyond, 0), degrees=True)
        assert turn is not None
        place = scipys(p, (p.yaw, beyond, 0.0))[:, 0]
        assert SIM.handles[ARCS[1]](p, tuple(place.tolist())) == {"pitch": 90.0}


@given(conventions, shares, st.tuples(*[st.floats(-1.0, 1.0)] * 3))
def test_nose_and_wing_go_where_they_are_pulled(
    convention: tuple[str, str], parts: tuple[float, float, float], place: tuple[float, float, float]
) -> None:
    p = within(*convention, parts)
    length = math.hypot(*place)
    if length < 0.01:
        return
    for grip, spot in BODY.items():
        before = scipys(p)
        if (before @ spot) @ place < -0.999 * length:
            continue  # opposite: no turn is the shortest
        found = p.changed(SIM.handles[grip](p, place))
        after = scipys(found)
        np.testing.assert_allclose(after @ spot, np.array(place) / length, rtol=0, atol=1e-4)
        turned = Rotation.from_matrix(after @ before.T).magnitude()
        angle = math.acos(min(max(float((before @ spot) @ place) / length, -1.0), 1.0))
        assert turned == pytest.approx(angle, abs=1e-3), "it isn't the shortest turn"
    assert SIM.handles["/held_nose"](p, (0.0, 0.0, 0.0)) == {}


@pytest.mark.parametrize(("part", "progress"), [(PARTS[0], 3.0), (PARTS[1], 3.0), (PARTS[0], 1.4)])
def test_the_aircraft_turns_wherever_it_is_taken(rig: Rig, part: str, progress: float) -> None:
    """The place that was taken stays under the pointer; one near the middle turns it as a ball does."""
    p = state(yaw=40.0, pitch=20.0, roll=-30.0, progress=progress)
    rig.show(p)
    eye = np.asarray(rig.browser.client.camera.position)
    places = rig.model.points(part)
    outside = places[np.linalg.norm(places, axis=1) > 0.6]
    taken = outside[np.argmax(outside @ eye)]
    aims = [Rotation.from_rotvec((0.05 * k, 0.1 * k, -0.08 * k)).apply(taken) for k in (1, 2, 3)]
    own = rig.model.world_pose(part)[:3, :3].T @ taken
    rig.browser.drag(part, *(tuple((eye + 0.8 * (aim - eye)).tolist()) for aim in aims), taken=tuple(taken.tolist()))
    rig.settle()
    np.testing.assert_allclose(rig.model.world_pose(part)[:3, :3] @ own, aims[-1], rtol=0, atol=1e-6)
    before = rig.model.world_pose(part)[:3, :3]
    taken = (0.05, -0.05, 0.1)
    rig.browser.drag(part, (0.05, -0.05, 0.12), taken=taken)
    rig.settle()
    turned = Rotation.from_matrix(before.T @ rig.model.world_pose(part)[:3, :3]).magnitude()
    assert 0.01 < turned < 0.2, "a small pull near the middle turns it a little"


# ---- the product builds up


@each_convention
def test_the_product_grows_turn_by_turn(order: str, frame: str) -> None:
    p = state(order, frame)
    for progress in (0.0, 0.5, 1.0, 1.5, 2.0, 2.5):
        now = p.changed({"progress": progress})
        made = math.ceil(progress)
        formulas = [
            each for each in readout.folded(SIM.readouts(now, solve(now)))[""] if isinstance(each, readout.Formula)
        ]
        product, so_far = formulas[0].value, formulas[1]
        letters = order[:made] if frame == "intrinsic" else order[:made][::-1]
        assert words(so_far.name).replace(" ", "") == ("".join(f"R{letter}" for letter in letters) or "I")
        part = [min(max(progress - k, 0.0), 1.0) for k in range(3)]
        R = scipys(p, [a * share for a, share in zip(p.angles, part, strict=True)])
        assert so_far.value == readout.mathml(R, roles=("x", "y", "z"))
        lit = re.findall(r'class="s3-now" data-link="(\w+)"', product)
        assert lit == ([p.names[int(progress)]] if progress % 1.0 else [])
        assert product.count("s3-later") == 3 - made
        names = re.findall(r'data-link="(\w+)"', product)
        assert tuple(names) == (p.names if frame == "intrinsic" else p.names[::-1])
    whole = readout.folded(SIM.readouts(p, solve(p)))[""]
    assert any(isinstance(each, readout.Formula) and each.name == readout.symbol("R") for each in whole)


@pytest.mark.parametrize(("order", "frame"), CONVENTIONS[:5])
def test_the_animation_names_each_turn(order: str, frame: str) -> None:
    p = state(order, frame)
    steps = SIM.actions[0].run(p)
    assert not isinstance(steps, Mapping)
    said = list(dict.fromkeys(step.words for step in steps))
    assert [sentence.split()[0] for sentence in said] == ["First", "Second", "Third"]
    for turn, sentence in zip(p.turns, said, strict=True):
        assert f"{turn.said}, about" in sentence
        assert sentence.endswith(f" {turn.axis}.")


# ---- two triples


@given(conventions, shares)
def test_another_triple_that_is_read_back_is_said_to_be_the_same_rotation(
    convention: tuple[str, str], parts: tuple[float, float, float]
) -> None:
    p = within(*convention, parts)
    solution = solve(p)
    back = list(solution.recovered.values())
    np.testing.assert_allclose(scipys(p, back), scipys(p), rtol=0, atol=1e-9)
    differs = any(abs(math.remainder(a - b, 360.0)) > 0.01 for a, b in zip(p.angles, back, strict=True))
    said = "two triples give each" in shown(p)
    if not solution.locked:
        assert said >= differs
    assert not (said and solution.locked)


def test_target_is_where_its_angles_say_until_the_aircraft_covers_it(rig: Rig) -> None:
    p = state(show_target=True, target=(-50.0, 60.0, 70.0), progress=1.5)
    rig.show(p)
    aim = Rotation.from_euler("ZYX", p.target, degrees=True)
    np.testing.assert_allclose(rig.model.world_pose("/target")[:3, :3], aim.as_matrix(), rtol=0, atol=1e-9)
    solution = solve(p)
    away = math.degrees((aim * Rotation.from_matrix(solution.R_progress).inv()).magnitude())
    assert solution.target is not None
    assert solution.target.angle == pytest.approx(away)
    assert f"The target is {away:.1f}° away" in shown(p)
    assert rig.model.visible("/target")
    for hidden in (state(show_target=True, target=p.angles), state()):
        rig.show(hidden)
        assert not rig.model.visible("/target")


def test_yaw_in_the_middle_beyond_90_is_read_back_otherwise() -> None:
    p = state("xzy", yaw=120.0)
    assert "yaw ψ 60.00°" in shown(p)
    assert "two triples give each" in shown(p)
    assert "two triples" not in shown(state("xzy", yaw=60.0))
