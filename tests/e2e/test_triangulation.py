"""triangulation: hands on the point in the scene, the points in the pictures and the panel, down to the pixel."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from tests.e2e.conftest import Classroom
from tests.e2e.learner import Learner, box
from tests.e2e.picture import Picture

Array = npt.NDArray[np.float64]
HANDLES = """() => ["left_uv", "right_uv"].map((name) => {
    const { x, y } = document.querySelector(`[data-handle=${name}]`).dataset;
    return [Number(x), Number(y)];
})"""
METHODS = ("dlt", "midpoint", "optimal")


def agree(learner: Learner, **expected: Any) -> dict[str, Any]:
    """State, address, solution, read-outs, pictures and scene come to say the same; the solution."""

    def said() -> dict[str, Any]:
        solution = learner.solution(**expected)
        drawn(learner, solution)
        assert solution["point"] is None or learner.reads("X", solution["point"])
        assert learner.reads("d", solution["disparity"], 2)
        places: list[list[float]] = learner.frame.evaluate(HANDLES)
        assert places == [learner.params["left_uv"], learner.params["right_uv"]]
        return solution

    return learner.until(said)


def drawn(learner: Learner, solution: dict[str, Any]) -> None:
    """The frames that this browser received put everything where the solution says."""
    scene, baseline = learner.scene, learner.params["baseline"]
    for method in METHODS:
        point = solution["by_method"][method]["point"]
        assert scene.visible(f"/{method}") == (point is not None)
        if point is not None:
            np.testing.assert_allclose(scene.world_pose(f"/{method}")[:3, 3], point, rtol=0, atol=1e-6)
    assert scene.visible("/point") == (solution["target"] is not None)
    if solution["target"] is not None:
        np.testing.assert_allclose(scene.world_pose("/point")[:3, 3], solution["target"], rtol=0, atol=1e-6)
    for side, sign in (("left", -1), ("right", 1)):
        centre = [sign * baseline / 2, 0, 1]
        np.testing.assert_allclose(scene.world_pose(f"/{side}")[:3, 3], centre, rtol=0, atol=1e-6)
        start, end = scene.points(f"/{side}/ray")[0]
        np.testing.assert_allclose(start, centre, rtol=0, atol=1e-6)
        sight = pixel_of(end, learner.params, sign)
        np.testing.assert_allclose(sight, solution[f"measured_{side}"], rtol=0, atol=1e-3)


def pixel_of(world: npt.ArrayLike, params: dict[str, Any], sign: int) -> Array:
    """Where the left (-1) or right (+1) camera sees a point: parallel cameras at a height of 1 m, looking along Y."""
    x, y, z = np.asarray(world, dtype=float)
    f = params["focal"]
    return np.array([320 + f * (x - sign * params["baseline"] / 2) / y, 240 - f * (z - 1) / y])


def test_the_point_is_dragged_and_a_method_selected_in_the_scene(classroom: Classroom) -> None:
    learner = classroom.open("triangulation/embed")
    solution = agree(learner, left_uv=[410, 210], right_uv=[320, 210])
    np.testing.assert_allclose(solution["point"], [0.3, 4, 1.2], atol=1e-9)
    before = np.array(solution["point"])
    camera = dict(learner.sockets.camera)

    shown(learner)
    at = learner.scene.world_pose("/point")[:3, 3]
    picture = Picture(learner)
    assert picture.shows("held", at, within=12), f"nothing to hold: {picture.around(at)}"

    x, y = learner.place_of("/point")
    learner.pull((x, y), 24, -30)
    learner.until(lambda: learner.params["left_uv"] != [410, 210])
    learner.until(lambda: np.testing.assert_allclose(learner.place_of("/point"), [x + 24, y - 30], atol=3))
    solution = agree(learner)
    after = np.array(solution["point"])
    forward = np.subtract(camera["look_at"], camera["position"])
    assert abs((after - before) @ forward / np.linalg.norm(forward)) < 0.02, (
        "it moves in the plane that faces the viewer"
    )
    for side, sign in (("left", -1), ("right", 1)):
        np.testing.assert_allclose(learner.params[f"{side}_uv"], pixel_of(after, learner.params, sign), atol=1e-6)
    np.testing.assert_allclose(learner.sockets.camera["position"], camera["position"], atol=1e-9)
    shown(learner)

    x, y = learner.place_of("/point")
    learner.pull((x, y), 4, 40, key="Shift")
    learner.until(lambda: not np.allclose(learner.solved()["point"], after, atol=0.05))
    step = np.abs(np.subtract(agree(learner)["point"], after))
    assert np.count_nonzero(step > 1e-6) == 1, "with Shift it moves along one axis"

    version = learner.sockets.state["version"]
    canvas = box(learner.frame.locator("canvas[data-engine]"))
    learner.pull((canvas["x"] + 40, canvas["y"] + canvas["height"] - 40), 60, -10)
    learner.until(lambda: not np.allclose(learner.sockets.camera["position"], camera["position"], atol=0.01))
    assert learner.sockets.state["version"] == version, "a drag on empty space turns the view, and nothing else"
    shown(learner)

    learner.type("right_uv", f"{learner.params['right_uv'][1] + 20:.1f}", box=2)  # the methods come to stand apart
    agree(learner, method="dlt")
    learner.click_on("/closeup/midpoint")
    agree(learner, method="midpoint")
    learner.until(lambda: learner.pressed("midpoint"))
    learner.until(lambda: learner.scene.visible("/midpoint/filled"))


def shown(learner: Learner) -> None:
    """On the screen: the rays in the colours of their cameras."""

    def look() -> None:
        picture = Picture(learner)
        for side in ("left", "right"):
            start, end = learner.scene.points(f"/{side}/ray")[0]
            spots = [start + t * (end - start) for t in (0.35, 0.5, 0.65)]
            assert any(picture.shows(side, spot, within=2) for spot in spots), f"no {side}: {picture.around(spots[1])}"

    learner.until(look)


def test_the_points_are_dragged_in_the_pictures(classroom: Classroom) -> None:
    learner = classroom.open_column("triangulation/embed")
    frame = learner.frame
    scale = box(frame.locator("svg[data-pane=left]"))["width"] / 640
    core = box(frame.locator("[data-handle=left_uv] .s3-core"))
    learner.pull((core["x"] + core["width"] / 2, core["y"] + core["height"] / 2), 20, -6)
    learner.until(
        lambda: np.testing.assert_allclose(learner.params["left_uv"], [410 + 20 / scale, 210 - 6 / scale], atol=1.5)
    )
    solution = agree(learner, right_uv=[320, 210])
    assert solution["ray_gap"] > 0.001, "rays of pixels in different rows miss each other"
    assert solution["by_method"]["optimal"]["reprojection_rms"] <= solution["by_method"]["dlt"]["reprojection_rms"]
    cells = frame.locator('.s3-table tr[data-link="dlt"] td').all_text_contents()
    assert cells[0] == f"{solution['by_method']['dlt']['reprojection_left']:.3f}"

    handle = frame.locator("[data-handle=right_uv]")
    handle.focus()
    for key, place in (("ArrowRight", [321, 210]), ("Shift+ArrowUp", [321, 200]), ("Alt+ArrowLeft", [320.9, 200])):
        learner.page.keyboard.press(key)
        agree(learner, right_uv=place)
        focused = frame.evaluate("document.activeElement.dataset.handle")
        assert focused == "right_uv", "the focus stays on the point when the picture is drawn anew"
    learner.page.keyboard.press("Shift+ArrowDown")
    depth = agree(learner, right_uv=[320.9, 210])["point"][1]

    dot, plot = frame.locator("[data-handle=depth]"), frame.locator("svg[data-pane=plot]")
    at, scale = box(dot.locator(".s3-core")), min(box(plot)["width"] / 320, box(plot)["height"] / 160)
    learner.pull((at["x"] + at["width"] / 2, at["y"] + at["height"] / 2), 20, -15)
    farther = depth + 20 / scale * 10 / 262
    learner.until(lambda: np.testing.assert_allclose(learner.solved()["point"][1], farther, atol=0.06))
    agree(learner)
    dot.press("ArrowLeft")
    learner.until(lambda: np.testing.assert_allclose(learner.solved()["point"][1], farther - 10 / 262, atol=0.06))


def test_each_control_of_triangulation_answers(classroom: Classroom) -> None:
    learner = classroom.open_column("triangulation/embed")
    learner.press_keys("baseline", "ArrowRight")
    first = agree(learner, baseline=0.61)
    np.testing.assert_allclose(first["point"], [0.3, 4, 1.2], atol=1e-9)
    learner.press("Reset")
    agree(learner, baseline=0.6)
    learner.choose("hold", "pixels")
    learner.type("focal", "800")
    assert agree(learner, focal=800, hold="pixels")["depth_sigma"] > first["depth_sigma"]
    learner.type("left_uv", "400.5", box=1)
    learner.type("right_uv", "215", box=2)
    agree(learner, left_uv=[400.5, 210], right_uv=[320, 215])
    learner.choose("method", "optimal")
    solution = agree(learner, method="optimal")
    assert solution["point"] == solution["by_method"]["optimal"]["point"]
    assert learner.scene.visible("/optimal/filled")
    assert not learner.scene.visible("/dlt/filled")

    assert learner.scene.visible("/uncertainty")
    learner.control("checkbox", "show_ellipsoid").click()
    agree(learner, show_ellipsoid=False)
    learner.until(lambda: not learner.scene.visible("/uncertainty"))

    learner.press("New sample")
    noisy = agree(learner, noise=1, seed=1)
    learner.press("New sample")
    other = agree(learner, noise=1, seed=2)
    assert other["point"] != noisy["point"]
    learner.type("seed", "1")
    assert agree(learner, noise=1, seed=1) == noisy, "the same seed, the same noise"
    learner.press("Noise on or off")
    agree(learner, noise=0)

    learner.type("/point", "-0.5", box=1)
    moved = learner.until(lambda: solved_at(learner, -0.5))
    agree(learner)
    np.testing.assert_allclose(moved[0], -0.5, atol=1e-3)

    learner.press("Reset")
    assert agree(learner, baseline=0.6, focal=600, left_uv=[410, 210], right_uv=[320, 210], method="dlt") != first


def solved_at(learner: Learner, x: float) -> list[float]:
    point: list[float] = learner.solved()["point"]
    assert point[0] == pytest.approx(x, abs=0.01)
    return point


def test_parallel_rays_are_said_where_they_happen(classroom: Classroom) -> None:
    learner = classroom.open_column("triangulation/embed?right_uv=409,210")
    learner.frame.locator("[data-handle=right_uv]").press("ArrowRight")
    solution = agree(learner, left_uv=[410, 210], right_uv=[410, 210])
    assert solution["point"] is None
    assert any("parallel rays" in text for text in learner.scene.labels().values())
    learner.says("Parallel rays: no finite point")
    learner.until(lambda: "arallel rays" in learner.spoken())
    learner.frame.locator("[data-handle=right_uv]").press("ArrowLeft")
    assert agree(learner, right_uv=[409, 210])["point"] is not None


def test_an_image_point_lights_up_with_its_ray_and_a_method_is_selected_wherever_it_is_shown(
    classroom: Classroom,
) -> None:
    learner = classroom.open_column("triangulation/embed?right_uv=320,230&baseline=0.2&method=optimal")
    frame = learner.frame
    agree(learner, method="optimal")
    frame.locator("[data-handle=left_uv] .s3-core").hover()
    learner.until(lambda: learner.lights("left", "g line tr"))
    learner.until(lambda: learner.scene.visible("/left/lit"))
    assert not learner.scene.visible("/right/lit")

    row = frame.locator('tr[data-link="right"]')
    learner.unfold(row)
    row.scroll_into_view_if_needed()
    row.hover()
    learner.until(lambda: learner.lights("right", "g line tr"))
    learner.until(lambda: learner.scene.visible("/right/lit"))
    assert not learner.scene.visible("/left/lit")

    button = learner.find("button", "DLT")
    button.scroll_into_view_if_needed()
    button.hover()
    learner.until(lambda: learner.lights("dlt", "g g tr"))
    learner.until(lambda: learner.scene.visible("/dlt/lit"))
    for mark in frame.locator('svg [data-link="dlt"]').all():
        mark.wait_for(state="visible")
    assert frame.locator('svg [data-link="midpoint"] >> visible=true').count() == 0
    button.press("Enter")
    agree(learner, method="dlt")
    learner.until(lambda: learner.pressed("dlt"))
