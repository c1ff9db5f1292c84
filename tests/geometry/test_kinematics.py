"""Arms against products of SciPy's rotations, finite differences and NumPy's singular values."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from geometry import Array, GeometryError, se3
from geometry.kinematics import Chain, dexterity
from tests.geometry.strategies import EXACT, angles, near

lengths = st.floats(0.0, 2.0) | near(0.0, 1.0)


@st.composite
def arms(draw: st.DrawFn, fewest: int = 1) -> tuple[Chain, Array]:
    """An arm of one to eight joints, and its angles."""
    axes = draw(st.text("xyz", min_size=fewest, max_size=8))
    n = len(axes)
    chain = Chain(axes, tuple(draw(st.lists(lengths, min_size=n, max_size=n))))
    return chain, np.array(draw(st.lists(angles, min_size=n, max_size=n)))


def link(axis: str, length: float, angle: float) -> Array:
    T = np.eye(4)
    T[:3, :3] = Rotation.from_euler(axis, angle).as_matrix()
    T[:3, 3] = T[:3, :3] @ [length, 0.0, 0.0]
    return T


def end(chain: Chain, turns: Array) -> Array:
    return chain.forward(turns).positions[..., -1, :]


@given(arms())
def test_links_and_their_products(arm: tuple[Chain, Array]) -> None:
    chain, turns = arm
    posture = chain.forward(turns)
    T = np.eye(4)
    for i, joint in enumerate(zip(chain.axes, chain.lengths, turns, strict=True)):
        T = T @ link(*joint)
        np.testing.assert_allclose(posture.individual[i], link(*joint), rtol=0, atol=EXACT)
        np.testing.assert_allclose(posture.composed[i], T, rtol=0, atol=10 * EXACT)
    np.testing.assert_array_equal(posture.positions[1:], posture.composed[:, :3, 3])
    np.testing.assert_array_equal(posture.positions[0], 0.0)
    np.testing.assert_allclose(se3.compose(*posture.individual), posture.composed[-1], rtol=0, atol=10 * EXACT)


@given(arms())
def test_lengths_and_angles_are_preserved(arm: tuple[Chain, Array]) -> None:
    chain, turns = arm
    posture = chain.forward(turns)
    found = np.linalg.norm(np.diff(posture.positions, axis=0), axis=-1)
    np.testing.assert_allclose(found, np.abs(chain.lengths), rtol=0, atol=10 * EXACT)
    R = posture.composed[:, :3, :3]
    np.testing.assert_allclose(R.swapaxes(1, 2) @ R, np.broadcast_to(np.eye(3), R.shape), rtol=0, atol=10 * EXACT)
    back = se3.inverse(posture.composed[-1])
    np.testing.assert_allclose(back @ posture.composed[-1], np.eye(4), rtol=0, atol=100 * EXACT)


@given(arms())
def test_the_jacobian_is_the_derivative_of_the_pose(arm: tuple[Chain, Array]) -> None:
    chain, turns = arm
    posture, step = chain.forward(turns), 1e-5
    n = len(chain.axes)
    ahead, behind = (chain.forward(turns + sign * step * np.eye(n)).composed[:, -1] for sign in (1.0, -1.0))
    rates = (ahead - behind) / (2.0 * step)
    np.testing.assert_allclose(posture.jacobian[:3], rates[:, :3, 3].T, rtol=0, atol=1e-8)
    spin = rates[:, :3, :3] @ posture.composed[-1, :3, :3].T
    np.testing.assert_allclose(posture.jacobian[3:], [spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], rtol=0, atol=1e-8)


@given(arms(), angles)
def test_turning_the_base_turns_the_arm(arm: tuple[Chain, Array], more: float) -> None:
    chain, turns = arm
    R = Rotation.from_euler(chain.axes[0], more).as_matrix()
    turned = chain.forward(turns + more * np.eye(len(turns))[0])
    np.testing.assert_allclose(turned.positions, chain.forward(turns).positions @ R.T, rtol=0, atol=100 * EXACT)


@given(arms(), st.integers(2, 4))
def test_a_batch_is_the_single_ones(arm: tuple[Chain, Array], count: int) -> None:
    chain, turns = arm
    batch = turns + 0.3 * np.arange(2.0 * count).reshape(2, count, 1)
    found = chain.forward(batch)
    for index in np.ndindex(2, count):
        for many, one in zip(found, chain.forward(batch[index]), strict=True):
            np.testing.assert_allclose(many[index], one, rtol=0, atol=1e-14)


def test_the_default_arm_of_the_sim() -> None:
    posture = Chain("zyy", (1.0, 0.8, 0.5)).forward(np.radians([30.0, 40.0, -30.0]))
    assert posture.individual.shape == posture.composed.shape == (3, 4, 4)
    assert posture.positions.shape == (4, 3)
    assert posture.jacobian.shape == (6, 3)
    out = 1.0 + 0.8 * math.cos(math.radians(40.0)) + 0.5 * math.cos(math.radians(10.0))
    down = 0.8 * math.sin(math.radians(40.0)) + 0.5 * math.sin(math.radians(10.0))
    expected = [out * math.cos(math.radians(30.0)), out * math.sin(math.radians(30.0)), -down]
    np.testing.assert_allclose(posture.positions[-1], expected, rtol=0, atol=EXACT)


@pytest.mark.parametrize(
    ("axes", "links", "argument"),
    [
        ("", (), "axes"),
        ("zw", (1.0, 1.0), "axes"),
        ("zy", (1.0,), "lengths"),
        ("z", (math.nan,), "lengths"),
        ("z", (math.inf,), "lengths"),
    ],
)
def test_what_is_no_arm_is_refused(axes: str, links: tuple[float, ...], argument: str) -> None:
    with pytest.raises(GeometryError) as caught:
        Chain(axes, links)
    assert caught.value.argument == argument


def test_bad_angles_are_refused_and_nan_in_a_batch() -> None:
    chain = Chain("zy", (1.0, 1.0))
    for bad in ([0.0], [0.0, 1.0, 2.0], [0.0, math.nan], [math.inf, 0.0]):
        with pytest.raises(GeometryError, match="angles"):
            chain.forward(bad)
    found = chain.forward([[0.0, 0.0], [0.0, math.nan]])
    assert np.isfinite(found.jacobian[0]).all()
    assert np.isnan(found.positions[1, 2]).any()
    np.testing.assert_array_equal(found.positions[0, 2], [2.0, 0.0, 0.0])


# ---- twists, offsets, joints that slide


@st.composite
def dh_arms(draw: st.DrawFn) -> tuple[Chain, Array]:
    """An arm of one to six joints with all that a link can have, and its angles and ways."""
    n = draw(st.integers(1, 6))

    def many(numbers: st.SearchStrategy[float]) -> tuple[float, ...]:
        return tuple(draw(st.lists(numbers, min_size=n, max_size=n)))

    chain = Chain(
        draw(st.text("xyz", min_size=n, max_size=n)), many(st.floats(-2.0, 2.0)), many(angles),
        many(st.floats(-1.0, 1.0)), many(angles), draw(st.text("rpf", min_size=n, max_size=n)),
    )  # fmt: skip
    return chain, np.array(many(st.floats(-3.0, 3.0)))


def whole_link(chain: Chain, i: int, moved: float) -> Array:
    """Rot(axis, θ) · Trans(axis, d) · Trans(x, length) · Rot(x, twist), each factor by SciPy."""
    turn, way = moved * (chain.joints[i] == "r"), moved * (chain.joints[i] == "p")
    T = link(chain.axes[i], 0.0, chain.starts[i] + turn)
    T = T @ se3.transform(np.eye(3), (chain.offsets[i] + way) * np.eye(3)["xyz".index(chain.axes[i])])
    return T @ se3.transform(np.eye(3), (chain.lengths[i], 0.0, 0.0)) @ link("x", 0.0, chain.twists[i])


@given(dh_arms())
def test_whole_links_and_their_products(arm: tuple[Chain, Array]) -> None:
    chain, moved = arm
    posture, T = chain.forward(moved), np.eye(4)
    for i, each in enumerate(moved):
        own = whole_link(chain, i, each)
        T = T @ own
        np.testing.assert_allclose(posture.individual[i], own, rtol=0, atol=10 * EXACT)
        np.testing.assert_allclose(posture.composed[i], T, rtol=0, atol=100 * EXACT)
    many = chain.forward([moved, moved + 0.25])
    for batch, one in zip(many, chain.forward(moved + 0.25), strict=True):
        np.testing.assert_allclose(batch[1], one, rtol=0, atol=1e-13)
    reach = chain.reach
    assert reach.least - 1e-9 <= np.linalg.norm(posture.positions[-1]) <= reach.greatest + 1e-9


@given(dh_arms())
def test_the_jacobian_of_joints_that_slide_is_the_derivative_too(arm: tuple[Chain, Array]) -> None:
    chain, moved = arm
    step = 1e-5
    ahead, behind = (chain.forward(moved + sign * step * np.eye(len(moved))).composed[:, -1] for sign in (1.0, -1.0))
    rates = (ahead - behind) / (2.0 * step)
    spin = rates[:, :3, :3] @ chain.forward(moved).composed[-1, :3, :3].T
    expected = np.column_stack([rates[:, :3, 3], spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]])
    np.testing.assert_allclose(chain.forward(moved).jacobian.T, expected, rtol=0, atol=1e-7)


def test_published_pose_of_a_ur5() -> None:
    """Universal Robots' own table; the pose is one that textbooks give to check it."""
    quarter = math.pi / 2.0
    ur5 = Chain(
        "zzzzzz", (0.0, -0.425, -0.39225, 0.0, 0.0, 0.0), (quarter, 0.0, 0.0, quarter, -quarter, 0.0),
        (0.089159, 0.0, 0.0, 0.10915, 0.09465, 0.0823),
    )  # fmt: skip
    at = ur5.forward(np.radians([180.0, -45.0, 0.0, 90.0, 0.0, 0.0])).positions[-1]
    np.testing.assert_allclose(at, (0.51096, 0.19145, 0.60011), rtol=0, atol=1e-5)
    np.testing.assert_allclose(ur5.forward([0.0] * 6).positions[-1], (-0.81725, -0.19145, -0.005491), atol=EXACT)


@given(dh_arms(), st.data())
def test_swapped_links_take_all_that_they_have_along(arm: tuple[Chain, Array], data: st.DataObject) -> None:
    chain, moved = arm
    if len(moved) > 1:
        i = data.draw(st.integers(0, len(moved) - 2))
        swapped, values = chain.swap(i, moved)
        expected = chain.forward(moved).individual.copy()
        expected[[i, i + 1]] = expected[[i + 1, i]]
        np.testing.assert_array_equal(swapped.forward(values).individual, expected)


@pytest.mark.parametrize(
    ("more", "argument"),
    [
        ({"twists": (0.0,)}, "twists"),
        ({"offsets": (0.0, math.nan)}, "offsets"),
        ({"starts": (0.0,) * 3}, "starts"),
        ({"joints": "r"}, "joints"),
        ({"joints": "rx"}, "joints"),
    ],
)
def test_what_is_no_row_is_refused(more: dict[str, Any], argument: str) -> None:
    with pytest.raises(GeometryError) as caught:
        Chain("zz", (1.0, 1.0), **more)
    assert caught.value.argument == argument


# ---- dexterity


@given(arms())
def test_singular_values_and_manipulability(arm: tuple[Chain, Array]) -> None:
    chain, turns = arm
    J = chain.forward(turns).jacobian[:3]
    values, manipulability, singular = dexterity(J, chain.mobility)
    np.testing.assert_allclose(values, np.linalg.svd(J, compute_uv=False), rtol=0, atol=EXACT)
    if chain.mobility == 3:
        # det of a product of rounded numbers: half of its digits are left under the root
        assert manipulability == pytest.approx(math.sqrt(max(np.linalg.det(J @ J.T), 0.0)), rel=1e-6, abs=1e-5)
    if len(turns) >= chain.mobility:
        assert bool(singular) is bool(np.linalg.matrix_rank(J, rtol=1e-6) < chain.mobility)


@given(st.floats(0.1, 2.0), st.floats(0.1, 2.0), angles, angles)
def test_a_planar_arm_of_two_links(a: float, b: float, first: float, second: float) -> None:
    chain = Chain("zz", (a, b))
    assert chain.mobility == 2
    found = dexterity(chain.forward([first, second]).jacobian[:3], 2)
    assert found.manipulability == pytest.approx(a * b * abs(math.sin(second)), abs=EXACT)


@given(st.sampled_from((0.0, math.pi, -math.pi)), angles)
def test_a_planar_arm_is_singular_when_straight_or_folded(elbow: float, first: float) -> None:
    chain = Chain("zz", (1.0, 0.8))
    for off, singular in ((0.0, True), (1e-3, False)):
        found = dexterity(chain.forward([first, elbow + off]).jacobian[:3], chain.mobility)
        assert bool(found.singular) is singular
    assert dexterity(chain.forward([[first, 0.0], [first, 1.0]]).jacobian[:, :3], 2).singular.tolist() == [True, False]


@pytest.mark.parametrize(
    ("axes", "mobility"),
    [("z", 1), ("x", 0), ("xx", 0), ("zz", 2), ("zzz", 2), ("zyy", 3), ("yy", 2), ("zy", 2), ("xy", 2), ("zyyxyx", 3)],
)
def test_mobility(axes: str, mobility: int) -> None:
    chain = Chain(axes, tuple(0.5 + 0.1 * i for i in range(len(axes))))
    assert chain.mobility == mobility
    found = dexterity(chain.forward([0.3 + 0.2 * i for i in range(len(axes))]).jacobian[:3], mobility)
    assert not found.singular
    assert float(found.manipulability) > 0.0 or mobility == 0


def test_a_jacobian_that_isn_t_finite_is_refused() -> None:
    with pytest.raises(GeometryError, match="jacobian"):
        dexterity(np.full((3, 2), math.nan), 2)


# ---- reach


@given(arms())
def test_no_posture_is_out_of_reach(arm: tuple[Chain, Array]) -> None:
    chain, turns = arm
    distance = float(np.linalg.norm(end(chain, turns)))
    assert chain.reach.least - 1e-11 <= distance <= chain.reach.greatest + 1e-11


@given(arms(), st.sets(st.integers(0, 7)))
def test_some_posture_has_the_greatest_reach(arm: tuple[Chain, Array], backward: set[int]) -> None:
    chain, _ = arm
    signed = tuple(-length if i in backward else length for i, length in enumerate(chain.lengths))
    chain = Chain(chain.axes, signed)
    # Straight or folded at each joint that bends: an exhaustive search finds both extremes of a dominated arm.
    bends = [(0.0, math.pi) if i and axis != "x" else (0.0,) for i, axis in enumerate(chain.axes)]
    postures = np.stack([grid.ravel() for grid in np.meshgrid(*bends)], axis=-1)
    distances = np.linalg.norm(end(chain, postures), axis=-1)
    assert distances.max() == pytest.approx(chain.reach.greatest, abs=1e-11)
    if chain.reach.least > 0.0:
        assert chain.reach.tight
        assert distances.min() == pytest.approx(chain.reach.least, abs=1e-11)


def test_reach_of_known_arms() -> None:
    for axes, lengths, least, greatest in (
        ("zz", (1.0, 0.8), 0.2, 1.8),
        ("zyy", (1.0, 0.8, 0.5), 0.0, 2.3),
        ("zxy", (1.0, 0.5, 0.2), 1.3, 1.7),
        ("zx", (1.0, -0.4), 0.6, 0.6),
    ):
        reach = Chain(axes, lengths).reach
        assert reach.tight
        assert (reach.least, reach.greatest) == pytest.approx((least, greatest), abs=EXACT)
    # Bends about y and z, no twist between: three equal links don't close to a triangle here.
    assert Chain("zyz", (1.0, 1.0, 1.0)).reach == (0.0, 3.0, False)
    turns = np.random.default_rng(0).uniform(-math.pi, math.pi, (2000, 3))
    assert np.linalg.norm(end(Chain("zyz", (1.0, 1.0, 1.0)), turns), axis=-1).min() > 0.99


# ---- swap


@given(arms(2), st.data())
def test_swapping_exchanges_two_transforms(arm: tuple[Chain, Array], data: st.DataObject) -> None:
    chain, turns = arm
    i = data.draw(st.integers(0, len(turns) - 2))
    swapped, moved = chain.swap(i, turns)
    expected = chain.forward(turns).individual.copy()
    expected[[i, i + 1]] = expected[[i + 1, i]]
    np.testing.assert_array_equal(swapped.forward(moved).individual, expected)
    again, back = swapped.swap(i, moved)
    assert again == chain
    np.testing.assert_array_equal(back, turns)


@given(angles, angles, lengths, lengths)
def test_swapping_pure_turns_matters_only_about_different_axes(a: float, b: float, l: float, m: float) -> None:
    for axes in ("zzz", "zyx"):
        chain = Chain(axes, (0.0, 0.0, l))
        swapped, moved = chain.swap(0, [a, b, 0.4])
        first, second = end(chain, np.array([a, b, 0.4])), end(swapped, moved)
        if axes == "zzz":
            np.testing.assert_allclose(first, second, rtol=0, atol=10 * EXACT)
    chain = Chain("zy", (1.0, 1.0 + m))
    swapped, moved = chain.swap(0, [1.0, 0.5])
    assert np.abs(end(chain, np.array([1.0, 0.5])) - end(swapped, moved)).max() > 0.1


@pytest.mark.parametrize(("axes", "index"), [("zyy", -1), ("zyy", 2), ("z", 0)])
def test_only_neighbours_can_be_swapped(axes: str, index: int) -> None:
    chain = Chain(axes, (1.0,) * len(axes))
    with pytest.raises(GeometryError, match="index"):
        chain.swap(index, [0.0] * len(axes))
