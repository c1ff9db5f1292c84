"""Arms of one's own: tables of Denavit and Hartenberg as people write them, and URDF against its own definition."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from sims.transform_chain import SIM, ChainParams, own, solve
from sims.transform_chain.presets import PRESETS, known

Array = npt.NDArray[np.float64]
UR5 = """
| link | a (mm)  | alpha (rad) | d (mm) | theta |
|------|---------|-------------|--------|-------|
| 1    | 0       | pi/2        | 89.159 | q1    |
| 2    | −425    | 0           | 0      | q2    |
| 3    | -392.25 | 0           | 0      | q3    |
| 4    | 0       | π/2         | 109.15 | q4    |
| 5    | 0       | -π/2        | 94.65  | q5    |
| 6    | 0       | 0           | 82.3   | q6    |
"""


def arm(text: str) -> ChainParams:
    """The state that a text leads to."""
    return ChainParams().changed(own.changes(ChainParams(), own.read(text)))


# ---- tables


def test_a_published_table_is_the_preset() -> None:
    p = arm(UR5)
    assert p.joints == "rrrrrr"
    assert [each.name for each in PRESETS if each.twists == p.twists] == ["ur5"]
    assert p.lengths == pytest.approx((0, -0.425, -0.39225, 0, 0, 0))
    assert p.offsets == pytest.approx((0.089159, 0, 0, 0.10915, 0.09465, 0.0823))
    posed = p.changed({"angles": (180, -45, 0, 90, 0, 0)})
    np.testing.assert_allclose(solve(posed).end, (0.51096, 0.19145, 0.60011), rtol=0, atol=1e-5)


def test_presets_of_published_arms_are_where_their_sources_say() -> None:
    puma = next(each for each in PRESETS if each.name == "puma-560")
    p = ChainParams().changed(
        {name: getattr(puma, name) for name in ("axes", "lengths", "twists", "offsets")}
        | {"angles": (0, 45, 180, 0, 45, 0)}
    )
    np.testing.assert_allclose(solve(p).end, (0.5963, -0.1501, -0.01435), rtol=0, atol=1e-4)
    ur5 = ChainParams().changed(SIM.states["UR5, as textbooks have it"])
    assert known(ur5) is not None
    np.testing.assert_allclose(solve(ur5).end, (0.51096, 0.19145, 0.60011), rtol=0, atol=1e-5)


@pytest.mark.parametrize(
    ("text", "rows"),
    [
        ("0.4,90,0,0\n0.3,0,0.1,0", [(0.4, 90, 0, 0, "r"), (0.3, 0, 0.1, 0, "r")]),
        ("0,4 90 0 0", [(0.4, 90, 0, 0, "r")]),
        ("0.4; 90°; 10 cm; 0".replace("10 cm", "10cm"), [(0.4, 90, 0.1, 0, "r")]),
        ("[[0.4, 90, 0, 0],\n [0, 0, 0.2, 0]]", [(0.4, 90, 0, 0, "r"), (0, 0, 0.2, 0, "r")]),
        ("0 -90 d1 0\n0.2 0 0 q2+90", [(0, -90, 0, 0, "p"), (0.2, 0, 0, 90, "r")]),
        ("0 0 0.12 0 p\n0 0 0 0 fixed", [(0, 0, 0.12, 0, "p"), (0, 0, 0, 0, "f")]),
        ("theta d a alpha\nq1 0.3 0.4 90", [(0.4, 90, 0.3, 0, "r")]),
        ("θ\td\tr\tα\ttype\n0\t0.3\t400mm\tπ/2\tR", [(0.4, 90, 0.3, 0, "r")]),
        (own.EXAMPLE, [(0.425, 0, 0.3, 0, "r"), (0.375, 180, 0, 0, "r"), (0, 0, 0.12, 0, "p")]),
    ],
)
def test_tables_are_understood_as_people_write_them(text: str, rows: list[tuple[Any, ...]]) -> None:
    found = [tuple(row.values()) for row in own.read(text)]
    assert [row[4] for row in found] == [row[4] for row in rows]
    np.testing.assert_allclose([row[:4] for row in found], [row[:4] for row in rows], rtol=0, atol=1e-12)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "There are no rows in it"),
        ("hello", "Line 1 has 1 cells"),
        ("1 2 3", "Line 1 has 3 cells"),
        ("0 0 0 0\n0 x 0 0", "Line 2: alpha is “x”, and no number"),
        ("0 0 0 0 z", "it turns.*not “z”"),
        ("0 0 0 0\n" * 9, "This arm has 9 links; here it can have 1 to 8"),
        ("a alpha d\n0 0 0", "a, α, d, θ are wanted"),
        ("<robot", "This isn’t XML"),
        ('<!DOCTYPE robot [<!ENTITY a "b">]><robot/>', "document type"),
        ("<html/>", "begins with <robot>"),
        ('<robot><link name="a"/></robot>', "0 links are no joint’s child"),
    ],
)
def test_what_is_no_arm_is_said_in_words(text: str, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        own.read(text)


def test_an_arm_that_is_too_long_for_the_sim_is_refused_by_its_bounds() -> None:
    with pytest.raises(ValueError, match="lengths must be from -2 to 2"):
        arm("3 0 0 0")


def test_it_is_read_in_the_child() -> None:
    assert SIM.paste is not None
    assert SIM.paste.found("0.4 90 0 0") == [{"a": 0.4, "alpha": 90.0, "d": 0.0, "theta": 0.0, "joint": "r"}]
    with pytest.raises(ValueError, match="There are no rows in it"):
        SIM.paste.found("")


# ---- URDF


def joint(number: int, kind: str, xyz: Any, rpy: Any, axis: Any) -> str:
    """A joint from one link to the next."""
    x, r, a = (" ".join(f"{v!r}" for v in values) for values in (xyz, rpy, axis))
    return (
        f'<joint name="j{number}" type="{kind}"><parent link="l{number}"/><child link="l{number + 1}"/>'
        f'<origin xyz="{x}" rpy="{r}"/><axis xyz="{a}"/></joint>'
    )


def placed(joint: tuple[Any, Any, Any, Any], moved: float) -> Array:
    """What the joint's own definition says: its origin, then its motion along or about its axis."""
    kind, xyz, rpy, axis = joint
    T, M = np.eye(4), np.eye(4)
    T[:3, :3], T[:3, 3] = Rotation.from_euler("xyz", rpy).as_matrix(), xyz
    unit = np.array(axis) / np.linalg.norm(axis)
    if kind == "prismatic":
        M[:3, 3] = moved * unit
    elif kind != "fixed":
        M[:3, :3] = Rotation.from_rotvec(moved * unit).as_matrix()
    return T @ M


angles = st.sampled_from((0.0, math.pi / 2, -math.pi / 2, math.pi)) | st.floats(-3.1, 3.1)
places = st.tuples(*[st.sampled_from((0.0, 0.1, -0.2)) | st.floats(-0.3, 0.3)] * 3)
unit_axes = st.sampled_from(((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, -1.0)))
oblique = st.tuples(*[st.floats(0.2, 1.0)] * 3)
moving = st.sampled_from(("revolute", "continuous", "prismatic"))
one_joint = st.tuples(moving | st.just("fixed"), places, st.tuples(angles, angles, angles), unit_axes | oblique)


@given(st.lists(one_joint, min_size=1, max_size=6), st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6))
def test_a_robots_end_is_where_its_own_description_puts_it(joints: list[Any], moves: list[float]) -> None:
    text = f"<robot name='r'>{''.join(joint(k, *each) for k, each in enumerate(joints))}</robot>"
    if all(each[0] == "fixed" for each in joints):
        with pytest.raises(ValueError, match="No joint of it"):
            own.read(text)
        return
    rows = own.read(text)
    assume(all(abs(row[name]) < 2.0 for row in rows for name in "ad"))  # else two axes are nearly parallel
    p = ChainParams().changed(own.changes(ChainParams(), rows))
    T, values = np.eye(4), iter(moves)
    moved = []
    for each in joints:
        way = 0.0 if each[0] == "fixed" else next(values)
        moved += [] if each[0] == "fixed" else [way]
        T = T @ placed(each, way)
    ways = iter(moved)
    angles, offsets = [0.0] * p.count, list(p.offsets)
    for k in range(p.count):
        if p.kind(k) == "r":
            angles[k] = math.degrees(next(ways))
        elif p.kind(k) == "p":
            offsets[k] += next(ways)
    posed = p.model_copy(update={"angles": tuple(angles), "offsets": tuple(offsets)})
    np.testing.assert_allclose(solve(posed).end_effector, T, rtol=0, atol=1e-6)


UR = [
    ("revolute", (0, 0, 0.089159), (0, 0, 0), (0, 0, 1)), ("revolute", (0, 0.13585, 0), (0, 1.570796325, 0), (0, 1, 0)),
    ("revolute", (0, -0.1197, 0.425), (0, 0, 0), (0, 1, 0)),
    ("revolute", (0, 0, 0.39225), (0, 1.570796325, 0), (0, 1, 0)),
    ("revolute", (0, 0.093, 0), (0, 0, 0), (0, 0, 1)), ("revolute", (0, 0, 0.09465), (0, 0, 0), (0, 1, 0)),
    ("fixed", (0, 0.0823, 0), (0, 0, 1.570796325), (1, 0, 0)),
]  # fmt: skip


def test_side_links_without_joints_that_move_are_left_out() -> None:
    side = (
        '<joint name="eye" type="fixed"><parent link="l2"/><child link="camera"/></joint>'
        '<joint name="foot" type="fixed"><parent link="l0"/><child link="floor"/></joint>'
    )
    whole = "".join(joint(k, *each) for k, each in enumerate(UR))
    p = arm(f'<?xml version="1.0"?><robot name="ur5">{whole}{side}</robot>')
    assert p.count <= 7
    assert p.joints[:6] == "rrrrrr"
    assert solve(p).end == pytest.approx((0.81725, 0.19145, -0.005491), abs=1e-6), "stretched along x, as ROS has it"


def test_a_right_angle_of_five_digits_makes_axes_parallel() -> None:
    whole = "".join(joint(k, *each) for k, each in enumerate(UR)).replace("1.570796325", "1.5708")
    p = arm(f"<robot>{whole}</robot>")
    assert max(map(abs, p.offsets)) < 0.2, "the common normal of nearly parallel axes is far away"
    assert solve(p).end == pytest.approx((0.81725, 0.19145, -0.005491), abs=1e-4)


@pytest.mark.parametrize(
    ("joints", "words"),
    [
        (joint(0, "floating", (0, 0, 0), (0, 0, 0), (0, 0, 1)), "“j0” is floating: revolute, continuous"),
        (joint(0, "revolute", (0, 0, 0), (0, 0, 0), (0, 0, 0)), "an axis without a direction"),
        (joint(0, "revolute", (0, 0), (0, 0, 0), (0, 0, 1)), "xyz is “0 0”, and not three numbers"),
        (joint(0, "revolute", (0, 0, "nan"), (0, 0, 0), (0, 0, 1)), "not three numbers"),
        (
            joint(0, "revolute", (0, 0, 0), (0, 0, 0), (0, 0, 1))
            + joint(0, "revolute", (0, 0, 0), (0, 0, 0), (0, 0, 1)).replace('"l1"', '"x"'),
            "It forks at the link “l0”",
        ),
        ('<joint name="j" type="fixed"><child link="a"/></joint>', "“j” has no parent link"),
        (
            '<joint type="fixed"><parent link="a"/><child link="b"/></joint>'
            '<joint type="fixed"><parent link="b"/><child link="a"/></joint>',
            "hang on one root; 0 links",
        ),
    ],
)
def test_what_is_no_one_chain_is_said_in_words(joints: str, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        own.read(f"<robot>{joints}</robot>")
