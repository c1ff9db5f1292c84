"""transform-chain: its numbers against SciPy, the arm that browsers received, swaps, hands, lists that don't agree."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any
from urllib.parse import parse_qsl

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy.spatial.transform import Rotation

from geometry.kinematics import Chain
from sims.kit import readout
from sims.kit.refusals import BadParams
from sims.kit.spelling import shown_number
from sims.kit.viewer import VERSION
from sims.transform_chain import SIM, ChainParams, ChainSolution, actions, solve
from sims.transform_chain.labels import EDGE, HEIGHT, PLANE, WIDTH, said
from sims.transform_chain.presets import PRESETS, Preset, known
from sims.transform_chain.views import view_of
from tests.frames import decode_frame
from tests.server import Rig
from tests.sims.markup import words, xml

Array = npt.NDArray[np.float64]
START = ChainParams()
EIGHT = START.changed(SIM.states["eight links"])
ONE = START.changed(SIM.states["one link"])


@st.composite
def arms(draw: st.DrawFn) -> ChainParams:
    """Any arm, with a swap and a trace where there are enough joints."""
    n = draw(st.integers(1, 8))

    def many(low: float, high: float) -> tuple[float, ...]:
        return tuple(draw(st.lists(st.floats(low, high), min_size=n, max_size=n)))

    return START.changed(
        {
            "angles": many(-180, 180),
            "lengths": many(0, 2),
            "axes": "".join(draw(st.lists(st.sampled_from("xyz"), min_size=n, max_size=n))),
            "show": draw(st.sampled_from(["individual", "composed"])),
            "swap": draw(st.sampled_from([None, *range(1, n)])),
            "trace": draw(st.sampled_from([None, *range(1, n + 1)])),
            "stage": draw(st.sampled_from([None, *range(1, n + 1)])),
        }
    )


@pytest.fixture(scope="module")
def rig() -> Iterator[Rig]:
    with Rig(SIM) as rig:
        yield rig


@st.composite
def dh_arms(draw: st.DrawFn) -> ChainParams:
    """Any arm whose links have twists, offsets and starts, and whose joints slide or turn."""
    p = draw(arms())

    def many(low: float, high: float) -> tuple[float, ...]:
        return tuple(draw(st.lists(st.floats(low, high), min_size=p.count, max_size=p.count)))

    return p.changed(
        {
            "lengths": many(-2, 2), "twists": many(-180, 180), "offsets": many(-1, 1), "starts": many(-180, 180),
            "joints": "".join(draw(st.lists(st.sampled_from("rpf"), min_size=p.count, max_size=p.count))),
        }
    )  # fmt: skip


def held_at(p: ChainParams, k: int) -> tuple[float, float, float]:
    """Where the k-th joint, which isn't fixed, is held."""
    place = solve(p).holds[k]
    assert place is not None
    return place


def state(rig: Rig) -> ChainParams:
    """The state of a session now."""
    params = rig.session.params
    assert isinstance(params, ChainParams)
    return params


def link(axis: str, degrees: float, length: float) -> Array:
    """Rot(axis, angle) · Trans(length, 0, 0), by SciPy."""
    T = np.eye(4)
    T[:3, :3] = Rotation.from_euler(axis, degrees, degrees=True).as_matrix()
    step = np.eye(4)
    step[0, 3] = length
    return T @ step


def whole_link(p: ChainParams, k: int) -> Array:
    """Rot(axis, θ) · Trans(axis, d) · Trans(length, 0, 0) · Rot(x, α), by SciPy."""
    start, twist = (values[k] if values else 0.0 for values in (p.starts, p.twists))
    way = np.eye(4)
    way["xyz".index(p.axes[k]), 3] = p.offset(k)
    T: Array = link(p.axes[k], p.angles[k] + start, 0.0) @ way @ link("x", 0.0, p.lengths[k]) @ link("x", twist, 0.0)
    return T


def product(p: ChainParams, order: list[int] | None = None) -> Array:
    """The end effector's pose, with the links in some order."""
    T = np.eye(4)
    for k in order or range(p.count):
        T = T @ whole_link(p, k)
    return T


def swapped_order(p: ChainParams) -> list[int]:
    assert p.swap is not None
    order = list(range(p.count))
    order[p.swap - 1 : p.swap + 1] = [p.swap, p.swap - 1]
    return order


# ---- numbers


@given(arms() | dh_arms())
def test_transforms_are_those_of_scipy(p: ChainParams) -> None:
    s = solve(p)
    T = np.eye(4)
    for k in range(p.count):
        own = whole_link(p, k)
        T = T @ own
        np.testing.assert_allclose(s.individual[k], own, rtol=0, atol=1e-12)
        np.testing.assert_allclose(s.composed[k], T, rtol=0, atol=1e-11)
        np.testing.assert_allclose(s.positions[k + 1], T[:3, 3], rtol=0, atol=1e-11)
    np.testing.assert_array_equal(s.positions[0], 0.0)
    np.testing.assert_array_equal(s.end_effector, s.composed[-1])
    np.testing.assert_allclose(s.inverse, np.linalg.inv(T), rtol=0, atol=1e-10)
    np.testing.assert_array_equal(s.inverse[:3, :3], s.end_effector[:3, :3].T)
    assert s.end == tuple(s.positions[-1])


@given(arms())
def test_point_goes_through_the_chain_and_keeps_its_distance_and_angle(p: ChainParams) -> None:
    s = solve(p)
    assert s.through.shape == (p.count + 1, 4)
    np.testing.assert_array_equal(s.through[:, 3], 1.0)
    np.testing.assert_allclose(s.through[-1], product(p) @ [*p.point, 1.0], rtol=0, atol=1e-10)
    for below, above, T in zip(s.through[1:], s.through[:-1], s.individual[::-1], strict=True):
        np.testing.assert_allclose(below, T @ above, rtol=0, atol=1e-10)
    (own, world), angles = s.kept
    assert own == pytest.approx(math.hypot(*p.point))
    assert world == pytest.approx(own, abs=1e-9)
    assert angles is not None
    assert angles[1] == pytest.approx(angles[0], abs=1e-5)
    assert angles[0] == pytest.approx(math.degrees(math.acos(p.point[0] / own)))


@given(arms() | dh_arms())
def test_swapping_exchanges_two_factors_of_the_product(p: ChainParams) -> None:
    s = solve(p)
    if p.swap is None:
        assert s.swapped_end_effector is None
        assert s.swapped is None
        return
    assert s.swapped is not None
    assert s.swapped_end_effector is not None
    T = product(p, swapped_order(p))
    np.testing.assert_allclose(s.swapped_end_effector, T, rtol=0, atol=1e-11)
    assert s.swapped.distance == pytest.approx(np.linalg.norm(T[:3, 3] - s.end), abs=1e-9)
    apart = Rotation.from_matrix(T[:3, :3].T @ s.end_effector[:3, :3]).magnitude()
    assert s.swapped.angle == pytest.approx(math.degrees(apart), abs=1e-5)
    if len({*p.axes[p.swap - 1 : p.swap + 1]}) == 1 and not p.rows:
        assert s.swapped.angle < 1e-6, "turns about one axis commute"


def test_swapped_turns_about_one_axis_change_nothing_about_two_they_do() -> None:
    turns = START.changed({"angles": (30, 40, 0), "lengths": (0, 0, 1), "axes": "zzy", "swap": 1})
    same = solve(turns)
    assert same.swapped_end_effector is not None
    np.testing.assert_allclose(same.swapped_end_effector, same.end_effector, rtol=0, atol=1e-15)
    assert "stays where it is" in words(readout.render(SIM.readouts(turns, same)))
    mixed = turns.changed({"axes": "zyy"})
    differs = solve(mixed)
    assert differs.swapped is not None
    assert differs.swapped.distance > 0.1
    assert differs.swapped.angle > 10.0
    assert "don’t commute" in words(readout.render(SIM.readouts(mixed, differs)))
    steps = START.changed({"swap": 2})
    moved = solve(steps)
    assert moved.swapped is not None
    assert moved.swapped.angle < 1e-9
    assert moved.swapped.distance > 0.1, "links along which there are steps don't commute, though their turns do"


@given(arms() | dh_arms(), st.floats(-180, 180))
def test_circle_is_where_the_end_effector_goes_as_its_joint_turns(p: ChainParams, angle: float) -> None:
    if p.trace is None:
        return
    circle = solve(p).circle
    if p.kind(p.trace - 1) != "r":
        assert circle is None, "it goes straight, or nowhere"
        return
    assert circle is not None
    turned = p.moved({f"angles.{p.trace - 1}": angle})
    w, x, y, z = circle.wxyz
    frame = Rotation.from_quat([x, y, z, w])
    own = frame.inv().apply(np.subtract(solve(turned).end, circle.centre))
    assert math.hypot(own[0], own[1]) == pytest.approx(circle.radius, abs=1e-7)
    assert own[2] == pytest.approx(0.0, abs=1e-7)


@given(arms())
def test_jacobian_is_how_the_end_effector_moves(p: ChainParams) -> None:
    s = solve(p)
    step = 1e-4
    for k in range(p.count):
        ends = []
        for sign in (-1, 1):
            angles = [a + sign * step * (j == k) for j, a in enumerate(p.angles)]
            ends.append(Chain(p.axes, p.lengths).forward(np.radians(angles)).positions[-1])
        rate = (ends[1] - ends[0]) / math.radians(2 * step)
        np.testing.assert_allclose(s.jacobian[:3, k], rate, rtol=0, atol=1e-6)
    np.testing.assert_allclose(s.singular_values, np.linalg.svd(s.jacobian[:3], compute_uv=False), rtol=0, atol=1e-12)
    assert s.manipulability == pytest.approx(np.prod(s.singular_values[: max(s.mobility, 1)]))


@given(arms())
def test_which_links_there_are_decides_the_mobility(p: ChainParams) -> None:
    p = p.changed({"lengths": [0.0 if length < 0.3 else length for length in p.lengths]})
    assert solve(p).mobility == Chain(p.axes, p.lengths).mobility


@pytest.mark.parametrize(
    ("name", "lost"),
    [
        ("planar 2R stretched, singular", (math.cos(math.radians(30)), 0.5, 0)),
        ("planar 2R folded, singular", (math.cos(math.radians(30)), 0.5, 0)),
        ("above its base, singular", None),
        ("twist that moves nothing", None),
    ],
)
def test_singular_poses_are_said_in_words(name: str, lost: Any) -> None:
    p = START.changed(SIM.states[name])
    s = solve(p)
    text = words(readout.render(SIM.readouts(p, s)))
    assert s.singular == ("singular" in name)
    assert ("Singular pose" in text) == s.singular
    assert ("singular pose" in SIM.describe(p, s)) == s.singular
    if lost:
        assert s.lost is not None
        assert abs(s.lost @ lost) == pytest.approx(1.0)
    if s.lost is not None:
        np.testing.assert_allclose(s.lost @ s.jacobian[:3], 0.0, atol=1e-9)
    if not s.singular:
        assert "No joint moves the end effector" in text


def test_an_ordinary_pose_is_not_called_singular_and_a_near_one_is_called_near() -> None:
    assert not solve(START).singular
    assert not solve(START.changed({"angles": (30, 60), "lengths": (1, 0.8), "axes": "zz"})).near_singular
    near = START.changed(SIM.states["nearly singular"])
    assert solve(near).near_singular
    assert "Near a singular pose" in words(readout.render(SIM.readouts(near, solve(near))))


# ---- what is drawn


CASES = {"one": ONE, "three": START, "eight": EIGHT}


@pytest.mark.parametrize("count", CASES)
@pytest.mark.parametrize("show", ["individual", "composed"])
def test_arm_is_drawn_where_the_matrices_say(rig: Rig, count: str, show: str) -> None:
    p = CASES[count].changed({"show": show})
    for params in (p, p.moved({"angles.0": -77.5}), p.moved({f"lengths.{p.count - 1}": 1.3}), p.moved({"axes.0": "x"})):
        rig.show(params)
        check_arm(rig, params, solve(params))


@given(arms() | dh_arms())
def test_any_arm_is_drawn_where_the_matrices_say(rig: Rig, p: ChainParams) -> None:
    rig.show(p)
    check_arm(rig, p, solve(p))


def check_arm(rig: Rig, p: ChainParams, s: ChainSolution) -> None:
    model, path = rig.model, ""
    expected = np.eye(4)
    for k in range(p.count):
        joint, before = model.world_pose(f"{path}/joint{k + 1}"), expected
        np.testing.assert_allclose(joint[:3, 3], before[:3, 3], rtol=0, atol=1e-9)
        axis = before[:3, "xyz".index(p.axes[k])]
        np.testing.assert_allclose(joint[:3, 2], axis, rtol=0, atol=1e-9)
        path += f"/link{k + 1}"
        expected = before @ whole_link(p, k)
        np.testing.assert_allclose(model.world_pose(path), expected, rtol=0, atol=1e-9)
        np.testing.assert_allclose(model.world_pose(path), s.composed[k], rtol=0, atol=1e-9)
        if model.visible(f"{path}/body"):
            body = model.points(f"{path}/body")
            own = (np.column_stack([body, np.ones(len(body))]) @ np.linalg.inv(expected).T)[:, 0]
            assert max(own, key=abs) == pytest.approx(-p.lengths[k], abs=1e-6), "a link ends where its joint is"
        post = f"{path.rpartition('/')[0]}/joint{k + 1}/post"
        if model.visible(post):
            heights = (model.points(post) - before[:3, 3]) @ axis
            assert heights[np.abs(heights - p.offset(k)).argmin()] == pytest.approx(p.offset(k), abs=1e-6)
        assert model.visible(f"{path}/frame") == (k < p.count - 1 and p.stage in (None, k + 1, k + 2))
    np.testing.assert_allclose(model.world_pose("/end_effector"), s.end_effector, rtol=0, atol=1e-9)
    tips = model.points("/end_effector/axes")[:, 1] - s.end
    np.testing.assert_allclose(tips / np.linalg.norm(tips, axis=1)[:, None], s.end_effector[:3, :3].T, atol=1e-6)
    np.testing.assert_allclose(model.world_pose("/end_effector/point")[:3, 3], s.through[-1, :3], rtol=0, atol=1e-9)
    np.testing.assert_allclose(model.world_pose("/grip")[:3, 3], s.end_effector[:3, 3], rtol=0, atol=1e-9)
    longer = f"{path}/link{p.count + 1}"
    assert longer not in model or not model.visible(longer)
    check_arrows(rig, p, s)
    if s.swapped is not None:
        check_ghost(rig, p)
    elif "/swapped" in model:
        assert not model.visible("/swapped")


def check_arrows(rig: Rig, p: ChainParams, s: ChainSolution) -> None:
    path = ""
    for i in range(1, 9):
        path += f"/link{i}"
        for kind, arrow, tail in (
            ("individual", f"{path}/arrow", s.positions[min(i, p.count) - 1]),
            ("composed", f"/composed{i}", s.positions[0]),
        ):
            there = i <= p.count and p.show == kind and p.stage in (None, i)
            there = there and math.dist(tail, s.positions[i]) > 1e-6
            assert (arrow in rig.model and rig.model.visible(arrow)) == there, arrow
            if there:
                ends = rig.model.points(arrow)[0]
                np.testing.assert_allclose(ends, [tail, s.positions[i]], rtol=0, atol=1e-5)


def check_ghost(rig: Rig, p: ChainParams) -> None:
    assert p.swap is not None
    path, order = "/swapped", swapped_order(p)
    for number, k in enumerate(order[p.swap - 1 :], start=1):
        path += f"/link{number}"
        expected = product(p, order[: p.swap + number - 1])
        np.testing.assert_allclose(rig.model.world_pose(path), expected, rtol=0, atol=1e-9)
        assert rig.model.visible(path), k
    np.testing.assert_allclose(rig.model.world_pose("/swapped_end"), product(p, order), rtol=0, atol=1e-9)


def test_trace_is_drawn_through_the_end_effector_and_follows_the_joint_that_moves(rig: Rig) -> None:
    rig.show(START)
    assert not rig.model.visible("/trace")
    rig.browser.move("angles.1", 65.5)
    rig.settle()
    p = state(rig)
    assert (p.angles, p.trace) == ((30, 65.5, -30), 2)
    points = rig.model.points("/trace").reshape(-1, 3)
    ends = np.array([solve(p.moved({"angles.1": a})).end for a in np.linspace(-180, 180, 721)])
    gaps = np.linalg.norm(points[:, None] - ends, axis=2).min(axis=1)
    assert gaps.max() < 0.01


SLIDING = START.changed(SIM.states["SCARA"])


@pytest.mark.parametrize("start", [START, EIGHT, SLIDING], ids=["three", "eight", "SCARA"])
@pytest.mark.parametrize("show", ["individual", "composed"])
def test_one_window_moves_the_whole_arm_by_poses_alone(
    rig: Rig, start: ChainParams, show: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A browser draws poses at once, and what things are made of a frame later: arrows would lag behind the arm."""
    rig.show(start.changed({"show": show, "trace": 1, "swap": None}))
    windows: list[list[dict[str, Any]]] = []
    feed = rig.model.feed

    def noted(frame: bytes | str) -> None:
        assert isinstance(frame, bytes)
        windows.append(decode_frame(frame))
        feed(frame)

    monkeypatch.setattr(rig.model, "feed", noted)
    for angle in (-100.0, 12.5, 179.5):
        windows.clear()
        rig.browser.move("angles.0", angle)
        rig.settle()
        (window,) = [each for each in windows if any(message.get("name") == VERSION for message in each)]
        others = [message for each in windows if each is not window for message in each if "name" in message]
        assert not others, "a state is drawn by halves"
        changed = [{*message["updates"]} - {"text"} for message in window if "updates" in message]
        assert not any(changed), [message for message in window if "updates" in message]
        check_arm(rig, state(rig), solve(state(rig)))


@given(arms() | dh_arms())
def test_words_stand_where_they_say_over_nothing_and_hang_on_nothing_that_moves(rig: Rig, p: ChainParams) -> None:
    """A browser draws a label by where its parent was a frame before."""
    rig.show(p)
    s = solve(p)
    kept = said(p, s)
    shown = rig.model.labels()
    assert shown == {f"/words/{word.name}": word.text for word in kept}
    for word in kept:
        np.testing.assert_allclose(rig.model.world_pose(f"/words/{word.name}")[:3, 3], word.place, rtol=0, atol=1e-12)
    np.testing.assert_array_equal(rig.model.world_pose("/words"), np.eye(4))
    radius = view_of(p).radius
    for k, one in enumerate(kept):
        for other in kept[:k]:
            x, y = np.abs(np.array(PLANE) @ np.subtract(one.place, other.place))
            wide = 0.5 * (2 * EDGE + WIDTH * (len(one.text) + len(other.text))) * radius
            assert x >= wide - 1e-9 or y >= HEIGHT * radius - 1e-9, (one, other)


def test_words_give_way_to_more_important_ones_alone() -> None:
    assert {word.name for word in said(START, solve(START))} >= {"T1", "T2", "T3", "x", "y", "z", "world_X", "axis1"}
    heap = START.changed(SIM.states["SCARA"])
    names = [word.name for word in said(heap, solve(heap))]
    assert "x" in names
    assert "T4" in names
    assert "T1" not in names, "it would stand over a letter of the world's axes"
    stretched = START.changed(SIM.states["planar 2R stretched, singular"])
    assert said(stretched, solve(stretched))[0].text == "⚠ singular pose"
    alone = EIGHT.changed({"stage": 5, "swap": None})
    assert [word.text for word in said(alone, solve(alone)) if word.text.startswith("T")] == ["T₄₅"]


def test_what_the_swap_did_is_said_beside_the_ghost(rig: Rig) -> None:
    p = START.changed({"swap": 1})
    rig.show(p)
    s = solve(p)
    assert s.swapped is not None
    texts = [rig.model.labels()[f"/words/{name}"] for name in ("swapped", "outcome")]
    assert texts == ["T₀₁ and T₁₂ swapped", f"{s.swapped.distance:.2f}\u2009m away, turned by {s.swapped.angle:.1f}°"]
    for name in ("swapped", "outcome"):
        assert math.dist(rig.model.world_pose(f"/words/{name}")[:3, 3], s.swapped.end) < 0.5
    rig.show(START.changed(SIM.states["swapped turns, same axis"]))
    assert rig.model.labels()["/words/outcome"] == "the same pose"


# ---- what is seen


@pytest.mark.parametrize("name", SIM.states)
def test_every_state_is_in_sight(name: str) -> None:
    """All frames, the target and the ghost are within the radius round the middle of the view that always fits."""
    p = START.changed(SIM.states[name])
    s = solve(p)
    view = SIM.home(p, s)
    places = [*s.positions[1:], *([p.target] if p.target else []), *([s.swapped.end] if s.swapped else [])]
    assert max(math.dist(place, view.look_at) for place in places) <= 1.06 * view.radius


def test_eight_long_links_and_far_targets_are_stepped_back_for_and_a_small_arm_is_looked_at_from_near() -> None:
    long = START.changed({"angles": (0.0,) * 8, "lengths": (0.6,) * 8, "axes": "zyyyyyyy"})
    assert SIM.home(long, solve(long)).radius > 1.5 * SIM.view.radius
    far = START.changed({"target": (2.0, -3.0, 1.5)})
    assert SIM.home(far, solve(far)).radius > 1.2 * SIM.view.radius
    assert SIM.home(SLIDING, solve(SLIDING)).radius < 0.6 * SIM.view.radius
    for angle in (-180.0, 0.0, 170.0):
        assert view_of(SLIDING.moved({"angles.0": angle})) == view_of(SLIDING), "turning a joint moves nobody's view"


# ---- the strip


def test_the_strip_stands_first_and_shows_each_factor_and_the_product_so_far(rig: Rig) -> None:
    rig.show(START)
    s = solve(START)
    strip = xml(rig.column.parts["read:"])[0]
    cards = strip.findall("label")
    assert strip.get("class") == "s3-stages s3-open"
    assert [card.find("input").get("value") for card in cards] == ["1", "2", "3", ""]  # type: ignore[union-attr]
    for k, card in enumerate(cards[:3]):
        shown = [float(cell.text.replace("−", "-")) for cell in card.iter("mn") if cell.text]
        wanted = np.concatenate([s.individual[k].ravel(), s.composed[k].ravel()])
        np.testing.assert_allclose(shown, wanted, rtol=0, atol=0.0051)
        assert f"angles.{k}" in str(card.get("data-link"))
    assert rig.column.values["stage"] == ""
    assert "Jacobian" not in rig.column.parts["read:"]
    assert "Jacobian" in rig.column.parts["read:Freedom to move"]


def test_where_nothing_can_be_chosen_the_strip_has_no_buttons() -> None:
    html = readout.still(SIM.readouts(START, solve(START)))
    assert "s3-stages" in html
    assert "<input" not in html


def test_one_transform_alone_is_chosen_in_the_strip(rig: Rig) -> None:
    for start, name in ((START, "individual"), (EIGHT, "composed")):
        rig.show(start.changed({"show": name}))
        rig.browser.move("stage", 2)
        rig.settle()
        p = state(rig)
        assert p.stage == 2
        check_arrows(rig, p, solve(p))
        texts = words(rig.column.parts["read:"])
        assert "T01T12" in texts.replace("₀", "0").replace("₁", "1").replace("₂", "2")
        shown = [
            e.get("data-link") for e in xml(rig.column.parts["read:"]).iter("div") if e.get("class") == "s3-formula"
        ]
        assert "angles.1" in str(shown[0]), "its transform, and then the product up to it"
        rig.browser.press("remove-link")
        rig.settle()
        assert state(rig).stage == 2
        rig.browser.move("stage", None)
        rig.settle()
        assert state(rig).stage is None
    assert ONE.changed({"stage": 1}).changed(actions.add_link(ONE.changed({"stage": 1}))).stage == 1
    two = START.changed({"stage": 3})
    assert two.changed(actions.remove_link(two)).stage is None


# ---- numbers in boxes


@pytest.mark.parametrize("name", SIM.states)
def test_no_box_shows_what_rounding_left_of_a_zero(rig: Rig, name: str) -> None:
    p = START.changed(SIM.states[name])
    rig.show(p)
    for angle in (90.0, -90.0, 180.0, -180.0, -0.0):
        rig.browser.move("angles.0", angle)
        rig.settle()
        shown = [shown_number(v) for v in rig.column.values.values() if isinstance(v, float)]
        assert not [text for text in shown if "e" in text or text.startswith("−0.0000000") or text == "−0"]
    rig.browser.drag("/grip", (0.7, 0.0, 0.0))
    rig.settle()
    shown = [shown_number(v) for v in state(rig).angles]
    assert not [text for text in shown if "e" in text and abs(float(text.replace("−", "-"))) < 1e-8]


# ---- hands


@given(arms() | dh_arms(), st.floats(-180, 180), st.floats(-0.5, 0.5), st.floats(0.3, 3.0), st.data())
def test_a_joint_turns_to_where_it_is_held(
    p: ChainParams, angle: float, beside: float, farther: float, data: st.DataObject
) -> None:
    """To the side of its plane, and farther out or nearer, a hand means the same angle."""
    k = data.draw(st.integers(0, p.count - 1))
    if p.kind(k) == "f":
        assert solve(p).holds[k] is None
        assert actions.turned(p, k, (1.0, 1.0, 1.0)) == {}
        return
    if p.slides(k):
        aim = p.moved({f"offsets.{k}": 0.5 * beside})
        held = p.moved(actions.turned(p, k, held_at(aim, k)))
        assert held.offset(k) == pytest.approx(aim.offset(k), abs=1e-9)
        return
    aim = p.moved({f"angles.{k}": angle})
    s = solve(aim)
    frame = s.composed[k - 1] if k else np.eye(4)
    axis, middle = (
        frame[:3, "xyz".index(p.axes[k])],
        frame[:3, 3] + s.joints[k].offset * frame[:3, "xyz".index(p.axes[k])],
    )
    place = middle + farther * (np.array(held_at(aim, k)) - middle) + beside * axis
    held = p.moved(actions.turned(p, k, tuple(place.tolist())))
    assert -180.0 <= held.angles[k] <= 180.0
    assert math.remainder(held.angles[k] - angle, 360.0) == pytest.approx(0.0, abs=1e-6)
    assert [a for j, a in enumerate(held.angles) if j != k] == [a for j, a in enumerate(p.angles) if j != k]


def test_a_joint_is_led_round_and_round_without_a_jump(rig: Rig) -> None:
    rig.show(START)
    before = START.angles[1]
    for turn in range(45, 800, 15):
        place = held_at(START.moved({"angles.1": math.remainder(turn, 360.0)}), 1)
        rig.browser.drag("/turn2", place)
        rig.settle()
        p = state(rig)
        step = math.remainder(p.angles[1] - before, 360.0)
        assert 0.0 < step <= 15.0 + 1e-6, turn
        np.testing.assert_allclose(rig.model.world_pose("/turn2")[:3, 3], place, rtol=0, atol=1e-9)
        before = p.angles[1]
    assert (p.angles[0], p.angles[2], p.trace) == (30, -30, 2)


@pytest.mark.parametrize("k", [0, 1, 2])
def test_a_link_turns_wherever_it_is_taken(rig: Rig, k: int) -> None:
    """About its joint, by as much as the place that was taken goes round."""
    rig.show(START)
    body = "".join(f"/link{n}" for n in range(1, k + 2)) + "/grasp"
    joint, normal = solve(START).lines[k] or ((), ())
    eye = np.asarray(rig.browser.client.camera.position)
    places = rig.model.points(body)
    taken = places[np.argmax(np.linalg.norm(places - joint, axis=1))]
    ways = [Rotation.from_rotvec(math.radians(a) * np.array(normal)).apply(taken - joint) + joint for a in (20, 40)]
    seen = [tuple((eye + 0.9 * (way - eye)).tolist()) for way in ways]
    rig.browser.drag(body, *seen, taken=tuple(taken.tolist()))
    rig.settle()
    turned = [math.remainder(a - b, 360.0) for a, b in zip(state(rig).angles, START.angles, strict=True)]
    assert turned == pytest.approx([40.0 * (j == k) for j in range(3)], abs=0.05)


def test_a_sliding_joint_is_pulled_along_its_axis(rig: Rig) -> None:
    rig.show(SLIDING)
    x, y, z = held_at(SLIDING, 2)
    rig.browser.drag("/turn3", (x + 0.3, y - 0.2, z - 0.05))
    rig.settle()
    p = state(rig)
    assert p.offsets == pytest.approx((0, 0, 0.17, 0)), "this axis points down"
    assert p.angles == SLIDING.angles
    rig.browser.drag("/grip", (0.5, 0.4, -0.1))
    rig.settle()
    assert solve(state(rig)).end == pytest.approx((0.5, 0.4, -0.1), abs=1e-6)
    assert state(rig).offsets[2] == pytest.approx(0.1, abs=1e-6)


def test_adding_and_removing_links_keeps_the_other_values() -> None:
    with Rig(SIM, START.changed({"show": "composed", "swap": 2, "trace": 3})) as rig:
        for n in range(4, 9):
            rig.browser.press("add-link")
            rig.settle()
            p = state(rig)
            assert p.count == len(p.angles) == len(p.lengths) == n
            assert (p.angles[:3], p.lengths[:3], p.axes[:3]) == (START.angles, START.lengths, START.axes)
            assert (p.show, p.swap, p.trace) == ("composed", 2, 3)
            assert f'data-slide="angles.{n - 1}"' in rig.column.parts["control:angles"]
        rig.browser.press("add-link")
        rig.settle()
        assert state(rig) == p, "eight links are the most"
        rig.browser.move("angles.7", 12.5)
        rig.browser.move("lengths.7", 0.77)
        rig.browser.move("axes.7", "x")
        rig.settle()
        p = state(rig)
        assert (p.angles[7], p.lengths[7], p.axes[7]) == (12.5, 0.77, "x")
        for n in range(7, 0, -1):
            rig.browser.press("remove-link")
            rig.settle()
            q = state(rig)
            assert (q.angles, q.lengths, q.axes) == (p.angles[:n], p.lengths[:n], p.axes[:n])
            assert q.swap == (2 if n > 2 else None)
        rig.browser.press("remove-link")
        rig.settle()
        assert state(rig).count == 1


@pytest.mark.parametrize("preset", PRESETS, ids=lambda preset: preset.name)
def test_presets_are_what_they_say(preset: Preset) -> None:
    p = EIGHT.changed(actions.preset(preset)(EIGHT))
    assert known(p) is preset
    assert preset.says in words(readout.render(SIM.readouts(p, solve(p))))
    assert known(p.moved({"angles.0": 3.0})) is preset
    assert known(p.moved({"lengths.1": 0.111})) is None
    assert not solve(p).singular


def test_six_axis_arm_reaches_as_far_as_its_maker_says() -> None:
    """1.45 m to the wrist's middle, for the ABB IRB 1600-6/1.45."""
    arm = next(preset for preset in PRESETS if preset.name == "six-axis")
    assert sum(arm.lengths[:5]) == pytest.approx(1.45)


@given(arms(), st.tuples(*[st.floats(-1, 1)] * 3))
def test_held_end_effector_comes_near_within_half_turns(p: ChainParams, place: tuple[float, float, float]) -> None:
    held = p.moved(actions.hold_end(p, place))
    assert all(-180 <= a <= 180 for a in held.angles)
    assert (held.lengths, held.axes, held.trace) == (p.lengths, p.axes, None)
    s = solve(held)
    aim = held.pull or tuple(0.0 if {a} == {*p.axes} else v for a, v in zip("xyz", place, strict=True))
    before = math.dist(solve(p).end, aim)
    assert math.dist(s.end, aim) <= before + 1e-9
    if held.pull is None:
        np.testing.assert_allclose(s.end, aim, rtol=0, atol=1e-7)
    elif s.pull_outside:
        least, greatest = s.reach
        assert greatest is not None
        assert not least <= math.hypot(*aim) <= greatest


def test_reachable_place_is_reached_and_nothing_is_said() -> None:
    p = START.moved(actions.hold_end(START, (1.2, 0.4, 0.3)))
    s = solve(p)
    assert p.pull is None
    assert s.end == pytest.approx((1.2, 0.4, 0.3), abs=1e-7)
    assert "each" not in SIM.describe(p, s).split("metres")[1]


def test_place_out_of_reach_is_said_and_the_arm_points_to_it(rig: Rig) -> None:
    rig.show(START)
    rig.browser.drag("/grip", (4.0, 3.0, 0.0))
    rig.settle()
    p, s = state(rig), solve(state(rig))
    assert p.pull == pytest.approx((4, 3, 0))
    assert s.pull_outside
    assert s.pull_distance == pytest.approx(5.0 - 2.3, abs=1e-3)
    np.testing.assert_allclose(np.array(s.end) / np.linalg.norm(s.end), (0.8, 0.6, 0), atol=1e-3)
    assert any("out of reach" in text for text in rig.model.labels().values())
    assert "Out of reach" in words(rig.column.html("read"))
    np.testing.assert_allclose(rig.model.points("/pulled").reshape(-1, 3)[0], (4, 3, 0), atol=1e-6)
    np.testing.assert_allclose(rig.model.world_pose("/pulled")[:3, 3], s.end, atol=1e-12)
    rig.browser.move("angles.0", 0.0)
    rig.settle()
    assert state(rig).pull is None, "the hand has let go"


def test_place_inside_the_bounds_that_is_not_reached_is_not_called_out_of_reach() -> None:
    p = START.changed({"angles": (0, 0, 0), "lengths": (1, 0.8, 0.5), "axes": "zyy", "pull": (0, 0, 2.2)})
    s = solve(p)
    assert not s.pull_outside
    assert "Not reached" in words(readout.render(SIM.readouts(p, s)))
    inner = START.changed({"angles": (0, 0), "lengths": (1, 0.4), "axes": "zz", "pull": (0.1, 0, 0)})
    assert solve(inner).pull_outside, "nearer than the arm folds"


@pytest.mark.parametrize("name", [name for name in SIM.states if "singular" in name])
def test_end_effector_is_dragged_off_a_singular_pose(name: str) -> None:
    p = START.changed(SIM.states[name])
    aim = solve(p.moved({f"angles.{k}": a + 25 for k, a in enumerate(p.angles)})).end
    held = p.moved(actions.hold_end(p, aim))
    np.testing.assert_allclose(solve(held).end, aim, rtol=0, atol=1e-6)


def test_an_arm_in_a_plane_stays_in_it() -> None:
    p = START.changed(SIM.states["planar 2R"])
    held = p.moved(actions.hold_end(p, (0.9, 0.9, 0.7)))
    assert held.pull is None
    assert solve(held).end == pytest.approx((0.9, 0.9, 0.0), abs=1e-7)


@pytest.mark.parametrize("p", CASES.values(), ids=CASES)
def test_new_targets_can_be_reached_and_differ(p: ChainParams) -> None:
    seen = {p.target}
    for _ in range(4):
        p = p.changed(actions.new_target(p))
        assert p.target is not None
        assert p.target not in seen
        seen.add(p.target)
        least, greatest = solve(p).reach
        assert greatest is not None
        assert least - 0.002 <= math.hypot(*p.target) <= greatest + 0.002
    assert p.changed(actions.new_target(p)) == p.changed(actions.new_target(p))


def test_target_is_shown_until_it_is_reached_and_sliders_leave_it(rig: Rig) -> None:
    p = START.changed({"target": (1.2, 0.4, 0.3)})
    rig.show(p)
    away = math.dist(solve(p).end, (1.2, 0.4, 0.3))
    assert f"target {away:.2f}\u2009m away" in rig.model.labels().values()
    assert not rig.model.visible("/target/ball")
    rig.browser.drag("/grip", (1.2, 0.4, 0.3))
    rig.settle()
    assert state(rig).target == (1.2, 0.4, 0.3)
    assert "✓ target reached" in rig.model.labels().values()
    assert rig.model.visible("/target/ball")
    np.testing.assert_array_equal(rig.model.world_pose("/target")[:3, 3], (1.2, 0.4, 0.3))


def test_sweep_turns_one_joint_once_round_and_back() -> None:
    for p in (START, EIGHT):
        steps = list(actions.sweep(p))
        k = (p.trace or 1) - 1
        now = p
        for step in steps:
            now = now.changed(step.changes)
            assert [a for j, a in enumerate(now.angles) if j != k] == [a for j, a in enumerate(p.angles) if j != k]
        assert now.angles == p.angles
        assert now.trace == k + 1
        assert sum(step.seconds for step in steps) == pytest.approx(actions.FULL_TURN)


# ---- links that restore the arm, and lists that don't agree


@given(arms())
def test_link_restores_the_arm(p: ChainParams) -> None:
    assert ChainParams.from_query(parse_qsl(p.query())) == p


def test_link_is_spelled_as_course_pages_spell_it() -> None:
    p = ChainParams.from_query(parse_qsl("angles=30,40,-30,5&lengths=1,0.8,0.5,0.25&axes=zyyx"))
    assert p.angles == pytest.approx((30, 40, -30, 5))
    assert p.lengths == pytest.approx((1, 0.8, 0.5, 0.25))
    assert p.query() == "angles=30,40,-30,5&lengths=1,0.8,0.5,0.25&axes=zyyx"


@pytest.mark.parametrize(
    ("query", "named", "allowed"),
    [
        ("angles=1,2", "angles", "got 2 angles, 3 lengths, 3 axes"),
        ("axes=zzzz", "axes", "got 3 angles, 3 lengths, 4 axes"),
        ("angles=1,2&lengths=1,1", "angles lengths", "got 2 angles, 2 lengths, 3 axes"),
        ("angles=1,2&lengths=1&axes=z", "angles lengths axes", "got 2 angles, 1 lengths, 1 axes"),
        ("angles=1,2,x", "angles", "1 to 8 numbers from -180 to 180, separated by commas"),
        ("angles=", "angles", "1 to 8 numbers from -180 to 180, separated by commas"),
        ("angles=1,2,181", "angles", "angles must be from -180 to 180, got 1,2,181"),
        ("lengths=1,1,-1", "lengths", "lengths must be from 0 to 2, got 1,1,-1"),
        ("axes=zyq", "axes", "1 to 8 letters, each one of: x, y, z"),
        ("axes=ZYY", "axes", "1 to 8 letters, each one of: x, y, z"),
        ("axes=", "axes", "1 to 8 letters, each one of: x, y, z"),
        ("angles=1,2,3,4,5,6,7,8,9", "angles", "1 to 8 numbers from -180 to 180, separated by commas"),
        ("swap=3", "swap", "swap must be from 1 to 2, got 3"),
        ("swap=off", "swap", "a whole number from 1 to 7"),
        ("trace=4", "trace", "trace must be from 1 to 3"),
        ("target=1,2", "target", "3 numbers from -20 to 20, separated by commas"),
    ],
)
def test_bad_lists_are_named_with_what_is_allowed(query: str, named: str, allowed: str) -> None:
    with pytest.raises(BadParams) as caught:
        ChainParams.from_query(parse_qsl(query, keep_blank_values=True))
    assert [name for name, _, _ in caught.value.complaints] == named.split()
    assert all(allowed in said for _, _, said in caught.value.complaints)
    ChainParams.from_query(caught.value.good.items())


def test_good_rest_of_a_bad_link_is_a_good_link() -> None:
    with pytest.raises(BadParams) as caught:
        ChainParams.from_query(parse_qsl("angles=x&lengths=1,1&axes=zz&show=composed"))
    assert caught.value.good == {"show": "composed"}


def test_one_joint_has_no_neighbour_to_swap_with() -> None:
    with pytest.raises(ValidationError, match="swap must be absent, got 1"):
        ONE.changed({"swap": 1})
    assert dict(ONE.options("swap")) == {None: "Off"}
    assert dict(START.options("swap")) == {None: "Off", 1: "1 ↔ 2", 2: "2 ↔ 3"}
