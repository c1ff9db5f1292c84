"""epipolar: a stereo pair of one's own, as OpenCV, Kalibr and ROS write it, against OpenCV."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt
import pytest

from sims.epipolar import SIM, EpipolarParams, solve
from sims.epipolar.calibration import EXAMPLE, changes, says
from sims.epipolar.own import OwnPair
from sims.kit import readout
from sims.kit.readout import figure
from sims.kit.refusals import BadParams
from sims.kit.stereo_text import read
from sims.triangulation.calibration import EXAMPLE as MIDDLEBURY
from tests.sims.markup import words, xml

Array = npt.NDArray[np.float64]
K_LEFT = np.array([[458.654, 0, 367.215], [0, 457.296, 248.375], [0, 0, 1]])
K_RIGHT = np.array([[457.587, 0, 379.999], [0, 456.134, 255.238], [0, 0, 1]])
TURN = np.array([0.05, -0.21, 0.11])
R = cv2.Rodrigues(TURN)[0].astype(np.float64)
T = np.array([[-0.31], [0.02], [0.04]])
T_IN_EXAMPLE = "T: [-0.110074, 0.000399, -0.000853]"
EXPECTED = [
    458.654, 457.296, 367.215, 248.375, 457.587, 456.134, 379.999, 255.238, *np.degrees(TURN), -0.31, 0.02, 0.04,
]  # fmt: skip


def opencv(folder: Path, names: tuple[str, str] = ("K1", "K2"), ending: str = "yml") -> str:
    """What OpenCV itself writes."""
    path = folder / f"pair.{ending}"
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
    for name, matrix in zip((*names, "R", "T"), (K_LEFT, K_RIGHT, R, T), strict=True):
        storage.write(name, matrix)
    storage.release()
    return path.read_text()


def kalibr() -> str:
    rows = "\n".join(f"  - {[*row, shift]}" for row, (shift,) in zip(R.tolist(), T.tolist(), strict=True))
    return f"""cam0:
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [-0.28, 0.07, 0.0002, 1.8e-05]
  intrinsics: [458.654, 457.296, 367.215, 248.375]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
cam1:
  T_cn_cnm1:
{rows}
  - [0.0, 0.0, 0.0, 1.0]
  cam_overlaps: [0]
  intrinsics: [457.587, 456.134, 379.999, 255.238]
  rostopic: /cam1/image_raw
"""


def ros(*, right_first: bool = False) -> str:
    first, second, P_first, P_second, *_ = cv2.stereoRectify(
        K_LEFT, np.zeros(5), K_RIGHT, np.zeros(5), (752, 480), R, T
    )
    texts = [
        f"""image_width: 752
camera_name: narrow_stereo/{name}
camera_matrix:
  rows: 3
  cols: 3
  data: {np.ravel(K).tolist()}
distortion_model: plumb_bob
rectification_matrix:
  rows: 3
  cols: 3
  data: {np.ravel(turn).tolist()}
projection_matrix:
  rows: 3
  cols: 4
  data: {np.ravel(P).tolist()}
"""
        for name, K, turn, P in (("left", K_LEFT, first, P_first), ("right", K_RIGHT, second, P_second))
    ]
    return "\n".join(reversed(texts) if right_first else texts)


def own(text: str, **more: Any) -> Any:
    """Both calibrations that are taken from a text."""
    return changes(EpipolarParams().changed(more), read(text))["own"]


def test_a_pair_is_read_as_opencv_writes_it(tmp_path: Path) -> None:
    for names in (("K1", "K2"), ("M1", "M2"), ("cameraMatrix1", "cameraMatrix2")):
        np.testing.assert_allclose(own(opencv(tmp_path, names)), EXPECTED, rtol=0, atol=1e-9)
    np.testing.assert_allclose(own(opencv(tmp_path, ending="json")), EXPECTED, rtol=0, atol=1e-9)
    pasted = "\n".join(f"{n} = {m.tolist()}" for n, m in (("K1", K_LEFT), ("K2", K_RIGHT), ("R", R), ("T", T)))
    np.testing.assert_allclose(own(pasted), EXPECTED, rtol=0, atol=1e-9)


def test_a_pair_is_read_as_kalibr_and_ros_write_it() -> None:
    np.testing.assert_allclose(own(kalibr()), EXPECTED, rtol=0, atol=1e-9)
    for right_first in (False, True):
        np.testing.assert_allclose(own(ros(right_first=right_first)), EXPECTED, rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "No pair was found"), ("K1: [1, 0, 0]", "No pair was found"), ("R: [nan]\n" * 400, "No pair was found"),
        (EXAMPLE.replace("K2: [457.587, 0,", "K2: [457.587,"), "“K2” should have 9 numbers"),
        (EXAMPLE.replace("R: [0.999997", "R: [0.8"), "R should be a rotation"),
        (EXAMPLE.replace("R:", "rotation:"), "“R” should have 9 numbers"),
        (EXAMPLE.replace("[458.654,", "[-458.654,"), "with fx and fy above 0"),
        (EXAMPLE.replace("[458.654, 0,", "[458.654, 3,"), "A camera matrix should be"),
        (EXAMPLE.replace(T_IN_EXAMPLE, "T: [0, 0, 0]"), "T is 0 long"),
        (EXAMPLE.replace(T_IN_EXAMPLE, "T: [0, 0, -1e-10]"), "T is 1e-10 long: this sim takes 1e-09"),
        (EXAMPLE.replace(T_IN_EXAMPLE, "T: [0, 0, -2000000]"), "There is -2e.06 in K1, K2 or T"),
        (EXAMPLE.replace("K2: [457.587, 0,", "K2: [0.9, 0,"), "A focal length is 0.9: this sim takes 1 or more"),
        (EXAMPLE.replace("[752, 480]", "[752, 15]"), "752 × 15 pixels: this sim takes 16 to 8192"),
        (EXAMPLE.replace("[752, 480]", "[9000, 480]"), "9000 × 480 pixels: this sim takes 16 to 8192"),
        (kalibr().replace("456.134, 379.999", "456.134"), "“intrinsics” should have 4 numbers"),
    ],
)  # fmt: skip
def test_what_is_no_pair_is_refused_in_words(text: str, said: str) -> None:
    with pytest.raises(ValueError, match=said.split(" (")[0]):
        own(text)


def seen(points: Array) -> tuple[Array, Array]:
    """Both pixels (n, 2) of points before the left camera, as OpenCV projects them."""
    nothing = np.zeros(3)
    left = cv2.projectPoints(points, nothing, nothing, K_LEFT, None)[0][:, 0]
    right = cv2.projectPoints(points, TURN, T, K_RIGHT, None)[0][:, 0]
    return left.astype(np.float64), right.astype(np.float64)


def state(**more: Any) -> EpipolarParams:
    p = EpipolarParams()
    return p.changed({**changes(p, read(EXAMPLE)), "own": tuple(EXPECTED), **more})


def chain(count: int) -> str:
    """Kalibr's of more cameras: each is turned and shifted against the one before it as the second is."""
    first, second = kalibr().split("cam1:")
    return first + "".join(f"cam{k}:{second}" for k in range(1, count))


def three(folder: Path) -> str:
    """What OpenCV's sample 3calibration writes of three cameras."""
    storage = cv2.FileStorage(str(folder / "three.yml"), cv2.FILE_STORAGE_WRITE)
    storage.write("imageWidth", 752)
    storage.write("imageHeight", 480)
    for k, K in enumerate((K_LEFT, K_RIGHT, K_LEFT), start=1):
        storage.write(f"cameraMatrix{k}", K)
        storage.write(f"distCoeffs{k}", np.zeros((5, 1)))
    for k, (turn, shift) in enumerate(((R, T), (R @ R, 2.0 * T)), start=2):
        storage.write(f"R1{k}", turn)
        storage.write(f"T1{k}", shift)
    storage.release()
    return (folder / "three.yml").read_text()


def test_of_more_cameras_the_pair_is_the_chosen_one_and_it_is_said() -> None:
    p, found = EpipolarParams(), read(chain(4))
    assert [each["name"] for each in found] == ["cam0", "cam1", "cam2", "cam3"]
    first = p.changed(changes(p, found))
    np.testing.assert_allclose(first.own, EXPECTED, rtol=0, atol=1e-9)  # type: ignore[arg-type]
    assert "cam0 on the left and cam1 on the right; for others of its 4" in says(first, found)
    p = p.changed({"left_of_text": 2, "right_of_text": 4})
    chosen = p.changed(changes(p, found))
    assert chosen.own is not None
    assert chosen.own[:8] == pytest.approx(EXPECTED[4:8] * 2)
    two = np.eye(4)
    two[:3, :3], two[:3, 3:] = R, T
    np.testing.assert_allclose(chosen.own[11:], (two @ two)[:3, 3], rtol=0, atol=1e-9)
    np.testing.assert_allclose(chosen.own[8:11], np.degrees(2 * TURN), rtol=0, atol=1e-9)
    assert "cam1 on the left and cam3 on the right" in says(chosen, found)
    assert EpipolarParams.from_query(chosen.query_items().items()) == chosen


def test_three_cameras_of_opencvs_are_told_from_the_first(tmp_path: Path) -> None:
    np.testing.assert_allclose(own(three(tmp_path), right_of_text=3)[11:], 2.0 * T[:, 0], rtol=0, atol=1e-9)
    between = own(three(tmp_path), left_of_text=2, right_of_text=3)
    np.testing.assert_allclose(between[8:11], np.degrees(TURN), rtol=0, atol=1e-9)
    np.testing.assert_allclose(between[11:], (2.0 * T - R @ T)[:, 0], rtol=0, atol=1e-9)


@pytest.mark.parametrize("pair", [(1, 5), (2, 2)])
def test_a_pair_that_is_not_in_the_text_is_refused_with_those_that_are(pair: tuple[int, int]) -> None:
    with pytest.raises(ValueError, match="1 is cam0, 2 is cam1, 3 is cam2, 4 is cam3"):
        own(chain(4), left_of_text=pair[0], right_of_text=pair[1])


def test_the_pictures_have_the_size_that_the_text_says_or_one_round_the_principal_points() -> None:
    p = EpipolarParams()
    said = p.changed(changes(p, read(EXAMPLE)))
    assert said.sizes == ((752, 480), (752, 480))
    assert "752 × 480 and 752 × 480 pixels." in says(said, read(EXAMPLE))
    unsaid = said.changed({"own_size": None})
    assert unsaid.sizes == ((735, 498), (761, 511))
    assert "if the principal points are in their middle" in says(unsaid, read(EXAMPLE))
    old = EpipolarParams.from_query([("own", ",".join(map(str, said.own or ())))])
    assert (old.own, old.sizes) == (said.own, unsaid.sizes), "links from before sizes were read"


def test_rigs_of_stereo_data_sets_are_taken_too() -> None:
    middlebury = own(MIDDLEBURY)
    assert middlebury == pytest.approx(
        (4161.221, 4161.221, 1445.577, 984.686, 4161.221, 4161.221, 1654.636, 984.686, 0, 0, 0, -0.176252, 0, 0)
    )


@pytest.mark.parametrize("sizes", [(1920, 1080, 640, 480)])
def test_a_pair_of_different_cameras_is_opencvs(sizes: tuple[int, ...]) -> None:
    p = EpipolarParams().changed(
        {"own": (1400, 1390, 940, 560, 510, 515, 300, 250, 4, -22, 3, -310, 25, 60), "own_size": sizes, "points": 12}
    )
    assert p.own is not None
    s = solve(p)
    assert s.F is not None
    assert (s.size_left, s.size_right) == (sizes[:2], sizes[2:])
    turn, shift = cv2.Rodrigues(np.radians(p.own[8:11]))[0], np.array(p.own[11:])
    left, right = s.K @ np.eye(3, 4), s.K_right @ np.column_stack([turn, shift])
    both = np.isfinite(s.pixels_left + s.pixels_right).all(axis=1)
    X = cv2.triangulatePoints(left, right, s.pixels_left[both].T, s.pixels_right[both].T)
    for P, seen in ((left, s.pixels_left[both]), (right, s.pixels_right[both])):
        x = P @ X
        np.testing.assert_allclose((x[:2] / x[2]).T, seen, rtol=0, atol=1e-6, err_msg="their true relative pose")
    for which, pixels, lines in ((1, s.pixels_left, s.lines_right), (2, s.pixels_right, s.lines_left)):
        assert lines is not None
        expected = cv2.computeCorrespondEpilines(pixels[both].reshape(-1, 1, 2), which, s.F)[:, 0]
        np.testing.assert_allclose(lines[both], expected, rtol=1e-4, atol=1e-2)  # single precision


def test_with_a_pair_of_somebodys_its_controls_stand_there_and_a_preset_takes_it_away() -> None:
    p = state(pick="left:700,470")
    assert set(SIM.offers(p).idle()) == {"left", "right", "left_pan", "right_pan", "focal"}
    assert set(SIM.offers(EpipolarParams()).idle()) == {"own_left", "own_right"}
    preset: Any = next(action for action in SIM.actions if action.name == "rectified")
    (step,) = preset.run(p)
    back = p.moved(step.changes)
    assert (back.pair, back.pick, back.sizes) == (None, None, ((640, 480), (640, 480)))


@pytest.mark.parametrize("pick", ["left:752,3", "right:3,480"])
def test_a_pixel_outside_somebodys_pictures_is_refused_with_their_size(pick: str) -> None:
    with pytest.raises(BadParams) as caught:
        EpipolarParams.from_query({**state().query_items(), "pick": pick}.items())
    ((name, _, allowed),) = caught.value.complaints
    assert (name, allowed) == ("pick", "left:u,v or right:u,v, with u from 0 to 751 and v from 0 to 479")


def test_the_point_is_where_both_of_a_turned_pair_see_it() -> None:
    """Cameras that look towards each other's side see nothing of the place that it has by itself."""
    p = EpipolarParams()
    found = read(EXAMPLE)
    found[1]["pose"] = np.block(
        [[cv2.Rodrigues(np.array([0, 1.4, 0]))[0], np.array([[-0.7], [0], [0.6]])], [0, 0, 0, 1]]
    ).tolist()
    s = solve(p.changed(changes(p, found)))
    assert s.pixel_left is not None
    assert s.pixel_right is not None
    assert all(0.0 < v < edge for v, edge in zip((*s.pixel_left, *s.pixel_right), (752, 480) * 2, strict=True))


def test_a_match_that_was_typed_is_drawn_with_its_line() -> None:
    p = state(own_left=(300.0, 200.0), own_right=(280.0, 190.0))
    left, right, *_ = SIM.panes(p, solve(p)) if SIM.panes else ()
    assert "yours" in left.svg
    assert "yours" in right.svg
    assert 'stroke-dasharray="2 6"' in right.svg
    assert "yours" not in SIM.panes(state(), solve(state()))[0].svg if SIM.panes else ""


def solved(p: EpipolarParams) -> OwnPair:
    pair = solve(p).own
    assert pair is not None
    return pair


def test_matches_of_the_pair_keep_its_constraint_and_lines_are_opencvs() -> None:
    left, right = seen(np.random.default_rng(5).uniform((-1, -1, 2), (1, 1, 6), (20, 3)))
    for p_left, p_right in zip(left.tolist(), right.tolist(), strict=True):
        pair = solved(state(own_left=p_left, own_right=p_right))
        assert pair.residual == pytest.approx(0.0, abs=1e-9)
        assert pair.distance == pytest.approx(0.0, abs=1e-6)
        off = solved(state(own_left=p_left, own_right=(p_right[0], p_right[1] + 5.0)))
        assert pair.line_right is not None
        assert abs(off.distance or 0.0) == pytest.approx(5.0 * abs(pair.line_right[1]), abs=1e-6)
        expected = cv2.computeCorrespondEpilines(np.array([[p_left]]), 1, pair.F)[0, 0]
        np.testing.assert_allclose(pair.line_right, expected, rtol=1e-4, atol=1e-3)


def test_its_epipoles_are_where_each_camera_sees_the_other() -> None:
    pair = solved(state())
    center = -R.T @ T[:, 0]
    assert pair.epipole_left == pytest.approx(tuple((K_LEFT @ center / center[2])[:2]), rel=1e-9)
    seen_left = K_RIGHT @ T[:, 0]
    assert pair.epipole_right == pytest.approx(tuple((seen_left / seen_left[2])[:2]), rel=1e-9)
    assert pair.baseline == pytest.approx(float(np.linalg.norm(T)))
    assert pair.angle == pytest.approx(float(np.degrees(np.linalg.norm(TURN))))


def test_its_numbers_stand_in_their_fold_and_can_be_copied() -> None:
    p = state(own_left=(300.0, 200.0), own_right=(280.0, 190.0))
    pair = solved(p)
    html = readout.render(readout.folded(SIM.readouts(p, solve(p)))["Your own stereo pair"])
    assert pair.distance is not None
    assert figure(abs(pair.distance), 2) in words(html)
    copied = [json.loads(str(e.get("value"))) for e in xml(html).iter("button")]
    np.testing.assert_array_equal(copied, [pair.F, pair.E])
    nothing = readout.folded(SIM.readouts(EpipolarParams(), solve(EpipolarParams())))["Your own stereo pair"]
    assert "Paste a calibration" in words(readout.render(nothing))


def test_a_pasted_text_becomes_a_state_and_the_state_a_link() -> None:
    assert SIM.paste is not None
    p = EpipolarParams()
    p = p.changed(SIM.paste.changes(p, SIM.paste.found(kalibr())))
    assert EpipolarParams.from_query(p.query_items().items()) == p
    assert p.own is not None
    np.testing.assert_allclose(p.own, EXPECTED, rtol=0, atol=1e-9)


@pytest.mark.parametrize("broken", [{0: 0.0}, {5: -1.0}, {11: 0.0, 12: 0.0, 13: 0.0}])
def test_a_link_without_focal_lengths_or_a_baseline_is_of_no_pair(broken: dict[int, float]) -> None:
    numbers = [broken.get(k, value) for k, value in enumerate(EXPECTED)]
    p = EpipolarParams.from_query([("own", ",".join(map(str, numbers)))])
    assert solve(p).own is None
