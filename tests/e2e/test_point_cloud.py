"""point-cloud, from the hand on a control to the points on the screen."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import TimeoutError, ViewportSize

from sims.point_cloud.cloud import Cloud
from sims.point_cloud.files import ply_bytes, read
from tests.e2e.conftest import Classroom
from tests.e2e.course import CourseSite
from tests.e2e.learner import Learner, touch
from tests.e2e.picture import Picture

SMALL: ViewportSize = {"width": 720, "height": 520}
RED_AND_BLUE = np.array([(255, 0, 0), (0, 0, 255)], np.uint8)


def agree(learner: Learner, **expected: Any) -> dict[str, Any]:
    """State, address, solution, read-outs and scene come to say the same; the solution."""

    def said() -> dict[str, Any]:
        solution = learner.solution(**expected)
        drawn = sum(len(learner.scene.points(f"/{layer}/points")) for layer in layers(learner))
        assert drawn == solution["points_out"]
        assert learner.reads("d", solution["dimensions"])
        return solution

    return learner.until(said)


def layers(learner: Learner) -> list[str]:
    return [name for name in ("cloud", "marked") if learner.scene.visible(f"/{name}/points")]


def test_voxels_thin_the_cloud_and_zero_brings_it_back(classroom: Classroom) -> None:
    learner = classroom.open_column("point-cloud/embed?voxel_size=0.5", size=SMALL)
    few = agree(learner, voxel_size=0.5)
    assert few["points_out"] < 1_000
    learner.press_keys("voxel_size", "ArrowLeft", "ArrowLeft")
    more = agree(learner, voxel_size=0.49)
    assert more["points_out"] != few["points_out"]
    learner.choose("color", "height")
    learner.until(lambda: learner.params["color"] == "height")
    learner.until(lambda: "Height" in learner.sockets.column.html("pane"))
    learner.type("voxel_size", "0")
    assert agree(learner, voxel_size=0)["points_out"] == few["points_in"]


def test_a_click_selects_the_point_under_it(classroom: Classroom) -> None:
    learner = classroom.open("point-cloud/embed?voxel_size=0.3&point_size=8&show_box=0", size=SMALL)
    agree(learner)
    points = learner.scene.points("/cloud/points")
    aim = points[np.argmin(np.linalg.norm(points - [0.6, -1.6, 0.0], axis=1))]
    x, y = Picture(learner).place(aim)
    learner.page.mouse.move(x + 1, y)
    learner.until(lambda: learner.scene.visible("/under/own"))
    cell = learner.scene.points("/under/own").reshape(-1, 3)
    assert (np.abs(cell.mean(axis=0) - aim) < 0.35).all(), "it isn't the cell under the pointer"
    learner.page.mouse.move(2, y)
    learner.until(lambda: not learner.scene.visible("/under/own"))
    learner.page.mouse.click(x, y)
    learner.until(lambda: learner.params["selected"] is not None)
    chosen = learner.solved()["selected"]
    np.testing.assert_allclose(chosen["position"], aim, atol=0.35)
    learner.until(
        lambda: np.testing.assert_allclose(learner.scene.world_pose("/selected")[:3, 3], chosen["position"], atol=1e-6)
    )
    assert learner.reads("p", chosen["position"])
    learner.type("selected", "")
    learner.sees(selected=None)

    touch(learner, (x, y))
    learner.until(lambda: learner.params["selected"] is not None)
    np.testing.assert_allclose(learner.solved()["selected"]["position"], aim, atol=0.35)


def test_a_registration_is_stepped(classroom: Classroom) -> None:
    learner = classroom.open_column(
        "point-cloud/embed?dataset=two-scans&voxel_size=0.1&process=register&step=0", size=SMALL
    )
    before = agree(learner, step=0)["registration"]
    learner.press("Next step")
    learner.press("Next step")
    after = agree(learner, step=2)["registration"]
    assert after["rmse"] < before["rmse"]
    learner.until(lambda: np.testing.assert_allclose(learner.scene.world_pose("/marked"), after["T"], atol=1e-6))
    assert learner.reads("T", after["T"])
    assert "Error of the pairs" in learner.sockets.column.html("pane")


def test_long_work_says_how_far_it_is_and_is_cancelled(classroom: Classroom, tmp_path: Path) -> None:
    """The worst of clouds, all in one place, takes seconds on any machine."""
    learner = classroom.open_column("point-cloud/embed?voxel_size=0.5&color=variation", size=SMALL)
    path = tmp_path / "one place.ply"
    path.write_bytes(ply_bytes(Cloud("", np.ones((500_000, 3)))))
    bring(learner, path)
    learner.until(lambda: agree_on_file(learner))
    agree(learner, color="variation")
    assert any(cancelled(learner, neighbors) for neighbors in (50, 49, 48)), "nothing was said of long work"
    agree(learner, voxel_size=0.5)
    learner.frame.get_by_role("group", name="Work in progress").wait_for(state="hidden")


def cancelled(learner: Learner, neighbors: int) -> bool:
    """Begin long work and cancel it; False if it was done before, as on a quick machine it may be."""
    learner.type("voxel_size", "0.5")  # all are one
    learner.type("neighbors", str(neighbors))
    agree(learner, voxel_size=0.5, neighbors=neighbors)
    version = learner.sockets.state["version"]
    work = learner.frame.get_by_role("group", name="Work in progress")
    learner.type("voxel_size", "0")
    with suppress(TimeoutError):
        work.get_by_text("Estimating normals").wait_for(timeout=8_000)
        work.get_by_role("button", name="Cancel").dispatch_event("click", timeout=1_000)
    learner.until(lambda: learner.sockets.state["version"] > version)
    return bool(learner.params["voxel_size"] == 0.5)


def bring(learner: Learner, path: Path) -> None:
    """Open the folder of one's own data, and choose a file there."""
    learner.frame.locator("summary", has_text="Your own data").click()
    learner.frame.get_by_label("Bring a file").set_input_files(path)


def test_a_learner_brings_a_file_and_takes_it_home(classroom: Classroom, tmp_path: Path) -> None:
    learner = classroom.open_column("point-cloud/embed?voxel_size=0.5", size=SMALL)
    other = classroom.open_column("point-cloud/embed?voxel_size=0.5", size=SMALL)
    points = np.array([[0.0, 0.0, 0.0], [2.0, 1.0, 0.5]])
    path = tmp_path / "my scan.ply"
    path.write_bytes(ply_bytes(Cloud("", points, RED_AND_BLUE)))
    bring(learner, path)
    solution = learner.until(lambda: agree_on_file(learner))
    assert solution["points_in"] == 2
    np.testing.assert_allclose(learner.scene.points("/cloud/points"), points, atol=1e-6)
    assert "my scan.ply" in learner.sockets.column.html("read")
    with learner.page.expect_download() as download:
        learner.frame.get_by_role("button", name="More").click()
        learner.frame.get_by_role("button", name="Download").click()
    np.testing.assert_array_equal(read("a.ply", download.value.path().read_bytes(), 10**6).points, points)
    assert other.params["dataset"] == "room"

    broken = tmp_path / "broken.ply"
    broken.write_bytes(b"ply\nformat nothing")
    learner.witness.expect("422")
    learner.frame.get_by_label("Bring a file").set_input_files(broken)
    status = learner.frame.locator("[data-s3-file-status]")
    learner.until(lambda: "Nothing has changed" in (status.text_content() or ""))
    assert learner.solved()["points_in"] == 2


def test_a_bad_file_that_is_dropped_is_refused_where_one_sees_it(classroom: Classroom) -> None:
    learner = classroom.open_column("point-cloud/embed?voxel_size=0.5", size=SMALL)
    bad = "() => { const all = new DataTransfer(); all.items.add(new File(['ply'], 'bad.ply')); return all; }"
    status = learner.frame.locator("[data-s3-file-status]")
    assert not status.is_visible(), "its fold is closed"
    learner.witness.expect("422")
    dropped = learner.page.evaluate_handle(bad)
    learner.page.dispatch_event("body", "drop", {"dataTransfer": dropped})
    learner.frame.locator(".s3-notice", has_text="Nothing has changed").wait_for()
    status.wait_for()
    assert "bad.ply" in (status.text_content() or ""), "and it stays there when the notice has gone"


def agree_on_file(learner: Learner) -> dict[str, Any]:
    assert learner.params["dataset"] == "file"
    return learner.solved()


def test_a_file_that_takes_long_is_given_up(classroom: Classroom, tmp_path: Path) -> None:
    learner = classroom.enter_alone(size=SMALL)
    learner.open_column("point-cloud/embed?voxel_size=0.5")
    path = tmp_path / "long.xyz"
    path.write_text("0 0 0\n" * 100_000)
    slow = {"offline": False, "latency": 0, "downloadThroughput": -1, "uploadThroughput": 20_000}
    learner.page.context.new_cdp_session(learner.page).send("Network.emulateNetworkConditions", slow)
    bring(learner, path)
    learner.frame.get_by_role("progressbar", name="Upload").wait_for()
    learner.frame.locator(".s3-upload").get_by_role("button", name="Cancel").click()
    status = learner.frame.locator("[data-s3-file-status]")
    learner.until(lambda: "given up. Nothing has changed" in (status.text_content() or ""))
    assert learner.params["dataset"] == "room"


def test_a_file_is_brought_in_a_sandboxed_frame(classroom: Classroom, tmp_path: Path) -> None:
    """Its origin is its own: what it sends crosses origins, and the browser asks the server first."""
    path = tmp_path / "mine.csv"
    path.write_text("x,y,z\n0,0,0\n2,1,0.5\n1,1,1\n")
    learner = classroom.enter(painted=False)
    with CourseSite() as course:
        course.show(learner, "point-cloud/embed?voxel_size=0.5", 'sandbox="allow-scripts"')
        learner.enter_frame()
        bring(learner, path)
        assert learner.until(lambda: agree_on_file(learner))["points_in"] == 3
        learner.says("“mine.csv”")


@pytest.mark.parametrize("query", ["dataset=file&file=upload-of-yesterday"])
def test_a_file_that_is_gone_is_said_in_words(classroom: Classroom, query: str) -> None:
    learner = classroom.open_column(f"point-cloud/embed?{query}", size=SMALL)
    learner.until(lambda: "gone" in learner.sockets.column.html("read"))
    assert not layers(learner)
