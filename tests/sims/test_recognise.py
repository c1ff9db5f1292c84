"""Which rotation a pasted text means: against SciPy's Rotation, as each program writes it, and what is asked."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from geometry.euler import FRAMES, ORDERS
from sims.euler_angles import SIM, EulerParams, solve
from sims.euler_angles.forms import forms
from sims.euler_angles.recognise import read

Array = npt.NDArray[np.float64]
rotations = st.tuples(*[st.floats(-3.0, 3.0)] * 3).map(Rotation.from_rotvec)


def row(values: npt.ArrayLike) -> str:
    return ", ".join(repr(v) for v in np.ravel(np.asarray(values)).tolist())


def assert_means(text: str, rotation: Rotation, what: str = "") -> None:
    found = read(text)
    np.testing.assert_allclose(found["R"], rotation.as_matrix(), rtol=0, atol=1e-9, err_msg=text)
    assert what in found["what"], found["what"]


@given(rotations)
def test_each_form_that_programs_write_is_recognised(rotation: Rotation) -> None:
    x, y, z, w = rotation.as_quat().tolist()
    M, vector = rotation.as_matrix(), rotation.as_rotvec()
    angle = float(np.linalg.norm(vector))
    axis = vector / angle if angle else np.array([0.0, 0.0, 1.0])
    degrees = float(np.degrees(angle))
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = M, (5.0, 6.0, 7.0)
    assert_means(f"array({M.tolist()}, dtype=float32)", rotation, "matrix, by rows")
    assert_means(f"{M}", Rotation.from_matrix(np.array(read(f"{M}")["R"])), "matrix")
    assert_means("\n".join(" ".join(map(repr, each)) for each in pose.tolist()), rotation, "by rows")
    assert_means(f"matrix3d({row(pose.T)})", rotation, "CSS")
    assert_means(f"wxyz {row((w, x, y, z))}", rotation, "w first")
    assert_means(f"wxyz {[*np.array([w, x, y, z])]}", rotation, "w first")
    assert_means(f"Eigen::Quaterniond q({row((w, x, y, z))});", rotation, "w first")
    assert_means(f"({row((x, y, z, w))}) xyzw", rotation, "w last")
    assert_means(f"R.from_quat([{row((x, y, z, w))}])", rotation, "w last")
    assert_means(f"Rotation.from_quat([{row((w, x, y, z))}], scalar_first=True)", rotation, "w first")
    assert_means(f"new Quaternion({x!r}f, {y!r}f, {z!r}f, {w!r}f)", rotation, "w last")
    assert_means(f"orientation:\n  x: {x!r}\n  y: {y!r}\n  z: {z!r}\n  w: {w!r}", rotation, "named")
    assert_means(f"geometry_msgs.msg.Quaternion(x={x!r}, y={y!r}, z={z!r}, w={w!r})", rotation, "named")
    assert_means(f"Rotation.from_rotvec([{row(vector)}])", rotation, "rotation vector")
    assert_means(f"rotation vector {row(np.degrees(vector))} deg", rotation, "rotation vector")
    assert_means(f"axis {row(axis)} angle {degrees!r}°", rotation, "axis")
    assert_means(f"rotate3d({row(axis)}, {angle!r}rad)", rotation, "CSS")
    assert_means(f"Quaternion.AngleAxis({degrees!r}f, new Vector3({row(axis)}))", rotation, "Unity")


@settings(max_examples=12)  # of each of the 24 conventions
@given(st.tuples(*[st.floats(-179.0, 179.0)] * 3))
def test_euler_angles_keep_their_convention(angles: tuple[float, float, float]) -> None:
    a, b, c = angles
    for order in ORDERS:
        for frame in FRAMES:
            name = order.upper() if frame == "intrinsic" else order
            rotation = Rotation.from_euler(name, angles, degrees=True)
            for text in (
                f'Rotation.from_euler("{name}", [{row(angles)}], degrees=True)',
                f"R.from_euler('{name}', [{row(np.radians(angles))}])",
                f"{order.upper()} {frame} {a!r}° {b!r}° {c!r}°",
                f"{row(np.radians(angles))} rad {name}",
            ):
                found = read(text)
                assert_means(text, rotation, f"{order.upper()} about {'turned' if frame == 'intrinsic' else 'fixed'}")
                assert (found["order"], found["frame"]) == (order, frame)
                np.testing.assert_allclose(found["angles"], angles, rtol=0, atol=1e-9)
    assert_means(f"roll: {a!r} pitch: {b!r} yaw: {c!r} deg", Rotation.from_euler("xyz", angles, degrees=True), "ROS")
    assert_means(f"Quaternion.Euler({row(angles)})", Rotation.from_euler("zxy", (c, a, b), degrees=True), "Unity")
    css = f"rotateZ({a!r}deg) rotateY({b!r}deg) rotateX({c!r}deg)"
    assert_means(css, Rotation.from_euler("ZYX", angles, degrees=True), "CSS")


def test_rounded_numbers_are_taken_as_the_rotation_that_they_stand_for() -> None:
    exact = Rotation.from_rotvec([0.3, -0.5, 0.9])
    R = np.array(read(f"{np.round(exact.as_matrix(), 2).tolist()}")["R"])
    np.testing.assert_allclose(R @ R.T, np.eye(3), rtol=0, atol=1e-12)
    np.testing.assert_allclose(R, exact.as_matrix(), rtol=0, atol=0.01)
    x, y, z, w = np.round(exact.as_quat(), 2).tolist()
    np.testing.assert_allclose(read(f"xyzw {x} {y} {z} {w}")["R"], exact.as_matrix(), rtol=0, atol=0.02)


@pytest.mark.parametrize(
    ("text", "asked"),
    [
        ("0.5 0.5 0.5 0.5", "is w the first of these four numbers or the last?"),
        ("1, 2, 3", "a rotation vector or Euler angles. Which?"),
        ("ZYX 0.3 0.2 0.1", "in degrees or in radians?"),
        ("1 0 0 0.5", "in degrees or in radians?"),
        ("zzx 1 2 3", "no order of three turns"),
        ("1 0 0 0 1 0 0 0 -1", "a mirroring"),
        ("1 2 3 4 5 6 7 8 9", "isn’t a rotation"),
        ("3 4 5 6", "neither a quaternion of length 1 nor an axis"),
        ("wxyz: w=0 x=0 y=0 z=0", "four zeros is no rotation"),
        ("rotate3d(0, 0, 0, 30deg)", "three zeros has no direction"),
        ("hello", "“hello” isn’t a rotation"),
        ("1 2", "isn’t a rotation that is known here"),
        ("rotvec 1e999 0 0", "too large"),
        ("", "isn’t a rotation"),
    ],
)
def test_what_has_several_meanings_or_none_is_asked_or_refused(text: str, asked: str) -> None:
    with pytest.raises(ValueError, match=re.escape(asked)):
        read(text)


@given(st.text(max_size=60) | st.from_regex(r"[-0-9.e ,xyzw()]{0,40}", fullmatch=True))
def test_any_text_is_read_or_refused_in_words(text: str) -> None:
    refused = ""
    R = np.eye(3)
    try:
        R = np.array(read(text)["R"])
    except ValueError as error:
        refused = str(error)
    assert refused[-1:] in ("", ".", "?")
    np.testing.assert_allclose(R @ R.T, np.eye(3), rtol=0, atol=1e-9)


# ---- and what comes of it


def taken(text: str, start: EulerParams | None = None) -> EulerParams:
    assert SIM.paste is not None
    start = start or EulerParams()
    return start.changed(SIM.paste.changes(start, read(text)))


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize("order", ORDERS)
def test_what_is_shown_in_all_forms_is_recognised_again(order: str, frame: str) -> None:
    p = EulerParams().moved({"order": order, "frame": frame, "yaw": -131.5, "pitch": 37.25, "roll": 64.0})
    p = p.changed({"pitch": 17.0})
    for form in forms(p, solve(p)):
        np.testing.assert_allclose(read(form.text)["R"], solve(p).R, rtol=0, atol=1e-9, err_msg=form.note)
        again = taken(form.text, p)
        np.testing.assert_allclose(solve(again).R, solve(p).R, rtol=0, atol=1e-9, err_msg=form.note)
    assert len([*forms(p, solve(p))]) >= 8


@example(rotation=Rotation.from_rotvec((0.0, 0.0, -(2.0**-14))), order="xyx", frame="intrinsic")
@given(rotation=rotations, order=st.sampled_from(ORDERS), frame=st.sampled_from(FRAMES))
def test_a_pasted_rotation_is_shown_in_the_present_order(rotation: Rotation, order: str, frame: str) -> None:
    start = EulerParams().moved({"order": order, "frame": frame, "progress": 1.0})
    state = taken(f"{rotation.as_matrix().tolist()}", start)
    np.testing.assert_allclose(solve(state).R, rotation.as_matrix(), rtol=0, atol=1e-7)
    assert (state.order, state.frame, state.progress) == (order, frame, 3.0)


def test_pasted_euler_angles_bring_their_own_convention() -> None:
    state = taken('Rotation.from_euler("xzy", [10, 100, 30], degrees=True)')
    assert (state.order, state.frame, state.angles) == ("xzy", "extrinsic", (10.0, 100.0, 30.0))
    beyond = taken('Rotation.from_euler("zyx", [10, 170, 30], degrees=True)')
    expected: Any = Rotation.from_euler("zyx", [10, 170, 30], degrees=True).as_matrix()
    np.testing.assert_allclose(solve(beyond).R, expected, rtol=0, atol=1e-9)


def test_what_was_recognised_is_said() -> None:
    assert SIM.paste is not None
    found = SIM.paste.found("wxyz 0.5 0.5 0.5 0.5")
    assert "Read as a quaternion, w first." in SIM.paste.says(EulerParams(), found)
    assert taken("wxyz 0.5 0.5 0.5 0.5") == EulerParams().changed(SIM.paste.changes(EulerParams(), found))
