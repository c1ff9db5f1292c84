"""A real camera in the camera sim: calibrations are read, shown as OpenCV shows them, or refused in words."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt
import pytest

from sims.camera import SIM, CameraParams, solve
from sims.camera.calibration import EXAMPLE, changes, read
from sims.camera.lens import pixel_at, shown
from sims.kit.world import POINTS

Array = npt.NDArray[np.float64]
START = CameraParams()
K = np.array([[4708.25, 0.0, 1987.5], [0.0, 4712.75, 1510.25], [0.0, 0.0, 1.0]])
D = np.array([-0.21, 0.11, 0.0015, -0.0007, -0.02])
EXPECTED = {
    "fx": 4708.25, "fy": 4712.75, "cx": 1987.5, "cy": 1510.25, "width": 4000, "height": 3000,
    "k1": -0.21, "k2": 0.11, "p1": 0.0015, "p2": -0.0007, "k3": -0.02,
}  # fmt: skip
ROS_FILE = """\
image_width: 4000
image_height: 3000
camera_name: narrow_stereo
camera_matrix:
  rows: 3
  cols: 3
  data: [4708.25, 0., 1987.5, 0., 4712.75, 1510.25, 0., 0., 1.]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-2.1e-01, 0.11, .0015, -0.0007, -0.02]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
projection_matrix:
  rows: 3
  cols: 4
  data: [4000, 0, 1900, 0, 0, 4000, 1500, 0, 0, 0, 1, 0]
"""
ROS_1 = """\
header:
  seq: 12
  stamp:
    secs: 1600000000
  frame_id: "camera"
height: 3000
width: 4000
distortion_model: "plumb_bob"
D: [-0.21, 0.11, 0.0015, -0.0007, -0.02]
K: [4708.25, 0.0, 1987.5, 0.0, 4712.75, 1510.25, 0.0, 0.0, 1.0]
R: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
P: [4000.0, 0.0, 1900.0, 0.0, 0.0, 4000.0, 1500.0, 0.0, 0.0, 0.0, 1.0, 0.0]
roi:
  height: 0
  width: 0
"""
ROS_2 = """\
height: 3000
width: 4000
distortion_model: plumb_bob
d:
- -0.21
- 0.11
- 0.0015
- -0.0007
- -0.02
k:
- 4708.25
- 0.0
- 1987.5
- 0.0
- 4712.75
- 1510.25
- 0.0
- 0.0
- 1.0
r:
- 1.0
"""
KALIBR = """\
cam0:
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [-0.21, 0.11, 0.0015, -0.0007]
  distortion_model: radtan
  intrinsics: [4708.25, 4712.75, 1987.5, 1510.25]
  resolution: [4000, 3000]
  rostopic: /cam0/image_raw
cam1:
  T_cn_cnm1:
  - [1.0, 0.0, 0.0, -0.11]
  camera_model: pinhole
  distortion_coeffs: [-0.3, 0.08, 0.0, 0.0]
  distortion_model: radtan
  intrinsics: [457.6, 456.1, 379.9, 255.2]
  resolution: [752, 480]
"""
LINES = """\
# a phone
Camera.fx: 4708.25
Camera.fy: 4712.75
Camera.cx: 1987.5
Camera.cy: 1510.25
Camera.k1: -0.21
Camera.k2: 0.11
Camera.p1: 0.0015
Camera.p2: -0.0007
Camera.k3: -0.02
Camera.width: 4000
Camera.height: 3000
"""
PYTHON = """\
width, height = 0, 0
image_size = (4000, 3000)
K = np.array([[4708.25, 0, 1987.5],
              [0, 4712.75, 1510.25],
              [0, 0, 1]], dtype=np.float64)
dist = np.array([-0.21, 0.11, 0.0015, -0.0007, -0.02])
"""


def by_opencv(folder: Path, ending: str) -> str:
    """What OpenCV itself writes of the camera."""
    path = folder / f"camera{ending}"
    store = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
    store.write("image_width", 4000)
    store.write("image_height", 3000)
    store.write("camera_matrix", K)
    store.write("distortion_coefficients", D.reshape(1, 5))
    store.release()
    return path.read_text()


@pytest.mark.parametrize("ending", [".yaml", ".xml", ".json"])
def test_opencvs_files_are_read(tmp_path: Path, ending: str) -> None:
    assert read(by_opencv(tmp_path, ending)) == pytest.approx({**EXPECTED, "skew": 0.0})


@pytest.mark.parametrize("text", [ROS_FILE, ROS_1, ROS_2, PYTHON], ids=["file", "ROS 1", "ROS 2", "Python"])
def test_what_ros_and_people_write_is_read(text: str) -> None:
    assert read(text) == pytest.approx({**EXPECTED, "skew": 0.0})


def test_the_first_camera_of_kalibrs_chain_is_read_and_plain_lines() -> None:
    assert read(KALIBR) == pytest.approx({**{k: v for k, v in EXPECTED.items() if k != "k3"}, "skew": 0.0})
    assert read(LINES) == pytest.approx({**EXPECTED, "skew": 0.0})


def test_the_example_in_the_box_can_be_used() -> None:
    state = START.changed(changes(START, read(EXAMPLE)))
    assert (state.width, state.height, state.fx, state.k1) == (752, 480, 458.7, -0.283)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("hello", "No fx, fy, cx, cy found"),
        ("", "No fx"),
        ("K: [1, 2, 3]", "“K” should have 9 numbers, and has 3"),
        ("K: [5, 0, 3, 1, 5, 3, 0, 0, 1]", "must be fx, skew, cx"),
        (KALIBR.replace("radtan", "equidistant"), "equidistant"),
        (KALIBR.replace("pinhole", "omni"), "omni"),
        (ROS_FILE.replace("-0.02]", "-0.02, 1, 0, 0]").replace("plumb_bob", "rational_polynomial"), "8 distortion"),
        ("fx: 5e999\nfy: 5\ncx: 1\ncy: 1", "No fx"),
    ],
)
def test_what_cannot_be_used_is_said(text: str, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        read(text)


def test_a_camera_that_does_not_fit_is_said_with_its_bounds() -> None:
    with pytest.raises(ValueError, match=r"cx is 1987\.5, and only 0 to 640 can be shown.*image_width"):
        changes(START, {"fx": 1700.0, "fy": 1700.0, "cx": 1987.5, "cy": 1510.25})
    with pytest.raises(ValueError, match="width is 20000, and only 16 to 8192"):
        changes(START, {**EXPECTED, "width": 20000.0})


def test_pasted_in_the_child_it_becomes_the_state(tmp_path: Path) -> None:
    assert SIM.paste is not None
    data = SIM.paste.found(by_opencv(tmp_path, ".yaml"))
    before = START.changed({"pan": 12, "skew": 5, "projection": "weak"})
    state = before.changed(SIM.paste.changes(before, data))
    assert {name: getattr(state, name) for name in EXPECTED} == EXPECTED
    assert (state.skew, state.pan, state.projection) == (0.0, 12, "perspective")
    assert CameraParams.from_query([tuple(item.split("=")) for item in state.query().split("&")]) == state  # type: ignore[misc]


LENSES = [
    {"k1": -0.3, "k2": 0.08, "p1": 0.001},
    {"k1": 0.4, "fx": 400, "fy": 400, "p2": -0.01},
    {**EXPECTED, "position": (0, -9, 1.2)},
]


@pytest.mark.parametrize("change", LENSES, ids=["barrel", "cushion", "photograph"])
def test_pixels_through_the_lens_are_opencvs(change: dict[str, Any]) -> None:
    p = START.changed(change)
    s = solve(p)
    in_camera = POINTS @ s.R.T + s.t
    coefficients = np.array([p.k1, p.k2, p.p1, p.p2, p.k3])
    theirs = cv2.projectPoints(in_camera, np.zeros(3), np.zeros(3), s.K, coefficients)[0].reshape(-1, 2)
    compared = 0
    for point, pixel in zip(s.points, theirs, strict=True):
        if point.pixel is not None:
            np.testing.assert_allclose(point.pixel, pixel, rtol=1e-9, atol=1e-6)
            compared += 1
            assert point.straight != point.pixel
    assert s.distorted
    assert compared > 10


@pytest.mark.parametrize("change", LENSES, ids=["barrel", "cushion", "photograph"])
def test_the_bent_picture_has_the_corners_where_opencv_has_them(change: dict[str, Any]) -> None:
    p = START.changed(change)
    s = solve(p)
    assert s.seen is not None
    corners = np.array([corner for _, ring in s.seen.faces for corner in ring])
    inside = [point for point in s.points if point.in_image and point.pixel is not None]
    near = [np.linalg.norm(corners - shown(p, point.pixel), axis=1).min() for point in inside if point.pixel]
    assert np.sum(np.array(near) < 1e-6) >= 0.4 * len(near), "those that nothing hides"
    twin = np.array([corner for _, ring in (s.straight.faces if s.straight else ()) for corner in ring])
    off = [np.linalg.norm(twin - shown(p, point.straight), axis=1).min() for point in inside if point.straight]
    assert np.sum(np.array(off) < 1e-6) >= 0.4 * len(near)


def test_without_coefficients_or_perspective_nothing_is_bent() -> None:
    assert not solve(START).distorted
    assert not solve(START.changed({"k1": -0.3, "projection": "orthographic"})).distorted


def test_what_is_beyond_the_reach_of_the_coefficients_has_no_pixel() -> None:
    p = START.changed({"k1": -1.5, "fx": 300, "fy": 300})
    s = solve(p)
    reach = 1.0 / np.sqrt(4.5)
    for point in s.points:
        if point.depth > 0.0:
            radius = np.hypot(point.camera[0], point.camera[1]) / point.depth
            assert (point.pixel is None) == (radius > reach)
            assert point.straight is not None


def test_a_large_picture_is_shown_as_wide_as_a_small_one() -> None:
    p = START.changed(EXPECTED)
    assert shown(p, (-0.5, -0.5)) == (-0.5, -0.5)
    assert shown(p, (3999.5, 2999.5)) == pytest.approx((639.5, 479.5))
    assert pixel_at(p, shown(p, (123.0, 45.0))) == pytest.approx((123.0, 45.0))
    (pane,) = SIM.panes(p, solve(p)) if SIM.panes else ()
    assert 'viewBox="-0.5 -0.5 640 480"' in pane.svg
    handle = SIM.handles["principal"](p, shown(p, (2100.0, 1400.0)))
    assert handle == pytest.approx({"cx": 2100.0, "cy": 1400.0})


def test_bounds_hold_real_cameras_and_stay_for_old_links() -> None:
    assert START.bounds("fx") == START.bounds("fy") == (100.0, 2000.0)
    assert (START.bounds("cx"), START.bounds("cy")) == ((0.0, 640.0), (0.0, 480.0))
    assert START.bounds("skew") == (-200.0, 200.0)
    assert START.changed({"width": 4000}).bounds("fx")[1] == 12500.0
