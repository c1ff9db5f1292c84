"""The poses that a browser received are those that the read-outs and SciPy name."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import product

import numpy as np
import numpy.typing as npt
import pytest
from scipy.spatial.transform import Rotation

from geometry.euler import ORDERS
from sims.euler_angles import SIM as EULER_ANGLES
from sims.euler_angles import EulerParams
from sims.kit.readout import quantity
from sims.triangulation import SIM as TRIANGULATION
from sims.triangulation import TriangulationParams, TriangulationSolution
from tests.server import Rig

Array = npt.NDArray[np.float64]
AIRCRAFT = "/turn1/turn2/turn3"
BEFORE = ("", "/turn1", "/turn1/turn2")
"""Names of the frames before each turn; the world has none."""
NOSE_OR_WING = {"z": 0, "y": 0, "x": 1}
"""Column of the direction that shows a turn about each axis."""
DASH_AND_GAP = 0.21
each_convention = pytest.mark.parametrize(("order", "frame"), list(product(ORDERS, ("intrinsic", "extrinsic"))))


@pytest.fixture(scope="module")
def rig() -> Iterator[Rig]:
    with Rig(EULER_ANGLES) as rig:
        yield rig


# ---- euler-angles


def states(order: str, frame: str, count: int) -> Iterator[EulerParams]:
    """Random states of a convention, and two at its locks."""
    random = np.random.default_rng(ORDERS.index(order) * 2 + (frame == "extrinsic"))
    start = EulerParams().moved({"order": order, "frame": frame})
    for _ in range(count):
        angles = {name: random.uniform(*start.bounds(name)) for name in ("yaw", "pitch", "roll")}
        yield start.moved({**angles, "progress": random.choice([3.0, random.uniform(0.0, 3.0)])})
    for lock in (0.0, 180.0) if start.proper else (-90.0, 90.0):
        yield start.moved({start.names[1]: lock})


def turns(params: EulerParams) -> list[tuple[str, float]]:
    """Axis and applied angle (degrees) of each turn, in the order in which they are made."""
    part = [min(max(params.progress - k, 0.0), 1.0) for k in range(3)]
    return [(axis, angle * share) for axis, angle, share in zip(params.order, params.angles, part, strict=True)]


def rotation(params: EulerParams, count: int = 3) -> Array:
    """The first turns as one rotation, by SciPy: capitals are turns about the body's own axes."""
    axes = params.order.upper() if params.frame == "intrinsic" else params.order
    angles = [angle for _, angle in turns(params)]
    applied = [angle if k < count else 0.0 for k, angle in enumerate(angles)]
    matrix: Array = Rotation.from_euler(axes, applied, degrees=True).as_matrix()
    return matrix


def drawn(rig: Rig, name: str) -> Array:
    return rig.model.world_pose(name)[:3, :3]


@each_convention
def test_aircraft_is_where_the_matrix_says(rig: Rig, order: str, frame: str) -> None:
    for params in states(order, frame, 5):
        rig.show(params)
        solution = EULER_ANGLES.solve(params)
        pose = rig.model.world_pose(AIRCRAFT)
        np.testing.assert_allclose(pose[:3, :3], solution.R_progress, rtol=0, atol=1e-9)
        np.testing.assert_allclose(pose[:3, :3], rotation(params), rtol=0, atol=1e-9)
        np.testing.assert_array_equal(pose[:3, 3], 0.0)
        for body in ("hull", "mark", "arrows"):
            np.testing.assert_array_equal(rig.model.world_pose(f"{AIRCRAFT}/{body}"), pose)


@each_convention
def test_frames_between_are_where_one_and_two_turns_lead(rig: Rig, order: str, frame: str) -> None:
    for params in states(order, frame, 2):
        rig.show(params)
        for count, name in enumerate(BEFORE[1:], start=1):
            np.testing.assert_allclose(drawn(rig, name), rotation(params, count), rtol=0, atol=1e-9)


@each_convention
def test_changes_too_small_to_see_are_drawn(rig: Rig, order: str, frame: str) -> None:
    """viser's own setters would leave out each of these, and the sum of all."""
    start = EulerParams().moved({"order": order, "frame": frame})
    for k in range(1, 4):
        params = start.moved({name: getattr(start, name) + k * 1e-7 for name in ("yaw", "pitch", "roll")})
        rig.show(params)
        np.testing.assert_allclose(drawn(rig, AIRCRAFT), rotation(params), rtol=0, atol=1e-14)


@each_convention
def test_arcs_lead_from_where_each_turn_starts_to_where_it_ends(rig: Rig, order: str, frame: str) -> None:
    for params in states(order, frame, 3):
        rig.show(params)
        for k, (axis, angle) in enumerate(turns(params)):
            arc = f"{BEFORE[k]}/arc{k}"
            if abs(angle) < 0.6:
                assert not rig.model.visible(f"{arc}/label") or abs(angle) > 0.4
                continue
            before = rotation(params, k)
            column = "xyz".index(axis)
            normal = before[:, column] if frame == "intrinsic" else np.eye(3)[column]
            check_arc(rig, arc, normal, angle)
            assert rig.model.labels()[f"{arc}/label"].endswith(f" {quantity(angle, '°', 0)}")
            seen = before[:, NOSE_OR_WING[axis]]
            start = rig.model.points(f"{arc}/start")[0, 1]
            flat = seen - normal * (normal @ seen)
            if np.linalg.norm(flat) > 0.2:  # else the nose lies along the axis, and shows nothing of the turn
                np.testing.assert_allclose(unit(start), unit(flat), rtol=0, atol=1e-5)


def check_arc(rig: Rig, arc: str, normal: Array, angle: float) -> None:
    """Its points lie on a circle round the axis, from the start stroke to the end stroke, turned by the angle."""
    model = rig.model
    assert all(model.visible(f"{arc}/{part}") for part in ("line", "start", "end", "label"))
    start, end = (model.points(f"{arc}/{part}")[0, 1] for part in ("start", "end"))
    turn = Rotation.from_rotvec(normal * angle, degrees=True)
    np.testing.assert_allclose(turn.apply(start), end, rtol=0, atol=1e-5)
    points = model.points(f"{arc}/line").reshape(-1, 3)
    radius = float(np.linalg.norm(start))
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), radius, rtol=0, atol=1e-5)
    np.testing.assert_allclose(points @ normal, 0.0, rtol=0, atol=1e-5)
    np.testing.assert_allclose(points[0], start, rtol=0, atol=1e-5)
    assert np.linalg.norm(points[-1] - end) < DASH_AND_GAP
    half_way = Rotation.from_rotvec(normal * angle / 2, degrees=True).apply(start)
    label = model.world_pose(f"{arc}/label")[:3, 3]
    np.testing.assert_allclose(unit(label), unit(half_way), rtol=0, atol=1e-5)


def unit(vector: Array) -> Array:
    scaled: Array = vector / np.linalg.norm(vector)
    return scaled


# ---- triangulation


@pytest.fixture(scope="module")
def stereo() -> Iterator[Rig]:
    with Rig(TRIANGULATION) as rig:
        yield rig


PARALLEL = {name: changes for name, changes in TRIANGULATION.states.items() if "own" not in changes}


def pairs(count: int = 25) -> Iterator[TriangulationParams]:
    """The sim's named states of parallel cameras, and random ones; turned ones have tests of their own."""
    start = TriangulationParams()
    yield from (start.changed(changes) for changes in PARALLEL.values())
    random = np.random.default_rng(5)
    for _ in range(count):
        u, v, w = random.uniform((0, 0, 0), (639, 479, 639)).tolist()
        yield start.changed(
            {
                "baseline": random.uniform(0.05, 2.0),
                "focal": random.uniform(200.0, 1500.0),
                "left_uv": (u, v),
                "right_uv": (w, min(max(v + random.normal(), 0.0), 479.0)),
                "noise": random.choice([0.0, 0.5, 2.0]),
                "seed": int(random.integers(100)),
                "method": random.choice(["dlt", "midpoint", "optimal"]),
            }
        )


def names_of_pairs() -> list[str]:
    return [*PARALLEL, *(f"random {k}" for k in range(25))]


each_pair = pytest.mark.parametrize("params", list(pairs()), ids=names_of_pairs())


def centre(params: TriangulationParams, side: str) -> Array:
    return np.array([params.baseline * (-0.5 if side == "left" else 0.5), 0.0, 1.0])


def pixels(params: TriangulationParams, side: str, points: Array) -> Array:
    """Where points in the world (n, 3) are in a picture: x to the right, y down, looking along +Y."""
    x, y, z = (points - centre(params, side)).T
    return np.column_stack([320.0 + params.focal * x / y, 240.0 - params.focal * z / y])


def measured_pixels(params: TriangulationParams) -> dict[str, Array]:
    solution = TRIANGULATION.solve(params)
    return {"left": np.array(solution.measured_left), "right": np.array(solution.measured_right)}


@each_pair
def test_cameras_rays_and_pixels_are_where_the_numbers_say(stereo: Rig, params: TriangulationParams) -> None:
    stereo.show(params)
    model = stereo.model
    for side, pixel in measured_pixels(params).items():
        pose = model.world_pose(f"/{side}")
        np.testing.assert_allclose(pose[:3, 3], centre(params, side), rtol=0, atol=1e-12)
        np.testing.assert_allclose(pose[:3, :3], [[1, 0, 0], [0, 0, 1], [0, -1, 0]], rtol=0, atol=1e-12)
        ray = model.points(f"/{side}/ray")[0]
        np.testing.assert_allclose(ray[0], centre(params, side), rtol=0, atol=1e-12)
        np.testing.assert_allclose(pixels(params, side, ray[1:]), [pixel], rtol=0, atol=2e-3)
        ball = model.world_pose(f"/{side}/pixel")[:3, 3]
        np.testing.assert_allclose(pixels(params, side, ball[None]), [pixel], rtol=0, atol=1e-6)
        corners = pixels(params, side, model.points(f"/{side}/picture"))
        frame = {(-0.5, -0.5), (639.5, -0.5), (639.5, 479.5), (-0.5, 479.5)}
        assert {(round(u, 2), round(v, 2)) for u, v in corners.tolist()} == frame
    ends = model.points("/baseline").reshape(-1, 3)
    np.testing.assert_allclose(ends, [centre(params, "left"), centre(params, "right")], rtol=0, atol=1e-6)


@each_pair
def test_points_of_all_methods_are_where_the_numbers_say(stereo: Rig, params: TriangulationParams) -> None:
    stereo.show(params)
    model, solution = stereo.model, TRIANGULATION.solve(params)
    for method, found in solution.by_method.items():
        assert model.visible(f"/{method}") == (found.point is not None)
        if found.point is not None:
            np.testing.assert_array_equal(model.world_pose(f"/{method}")[:3, 3], found.point)
            assert model.visible(f"/{method}/filled") == (method == params.method)
            assert model.visible(f"/{method}/ghost") == (method != params.method)
            for side, pixel in measured_pixels(params).items():
                at = pixels(params, side, found.point[None])[0]
                error = {"left": found.reprojection_left, "right": found.reprojection_right}[side]
                assert np.linalg.norm(at - pixel) == pytest.approx(error, abs=1e-6)
    assert model.visible("/point") == (solution.target is not None)
    if solution.target is not None:
        np.testing.assert_array_equal(model.world_pose("/point")[:3, 3], solution.target)
    if model.visible("/gap"):
        assert solution.closest_points is not None
        np.testing.assert_allclose(model.points("/gap")[0], solution.closest_points, rtol=1e-6, atol=1e-6)
        length = float(np.linalg.norm(np.diff(solution.closest_points, axis=0)))
        assert length == pytest.approx(solution.ray_gap, rel=1e-6, abs=1e-9)


@each_pair
def test_ellipsoid_is_the_covariance_and_the_cloud_its_samples(stereo: Rig, params: TriangulationParams) -> None:
    stereo.show(params)
    model, solution = stereo.model, TRIANGULATION.solve(params)
    np.testing.assert_array_equal(model.points("/uncertainty_cloud"), solution.cloud.astype(np.float32))
    if model.visible("/uncertainty"):
        pose = model.world_pose("/uncertainty/ellipsoid")
        np.testing.assert_array_equal(pose[:3, 3], solution.point)
        scaled = pose[:3, :3] @ np.diag(model.node("/uncertainty/ellipsoid").props["scale"]) / 3.0
        wanted = solution.covariance
        assert wanted is not None
        np.testing.assert_allclose(scaled @ scaled.T, wanted, rtol=0, atol=1e-9 * np.abs(wanted).max())
        assert np.linalg.det(pose[:3, :3]) == pytest.approx(1.0)
    else:
        assert solution.ellipsoid_axes is None or solution.vague or not params.show_ellipsoid


def spread(solution: TriangulationSolution) -> float:
    """How far what belongs to the result is from it, in metres."""
    assert solution.point is not None
    assert solution.ellipsoid_axes is not None
    others = [found.point for found in solution.by_method.values() if found.point is not None]
    apart = [float(np.linalg.norm(other - solution.point)) for other in others]
    return max(*apart, solution.ray_gap, 3.0 * float(solution.ellipsoid_axes[0]))


@each_pair
def test_close_up_shows_what_is_there_as_much_larger_as_it_says(stereo: Rig, params: TriangulationParams) -> None:
    stereo.show(params)
    model, solution = stereo.model, TRIANGULATION.solve(params)
    if not model.visible("/closeup"):  # nothing there is small, or nothing there at all
        assert solution.point is None or solution.vague or spread(solution) > 0.05 * solution.point[1]
        return
    assert solution.point is not None
    said = re.search(r"×([\d.e+]+)", model.labels()["/closeup/label"])
    assert said is not None
    times = float(said[1])
    assert times > 1.0
    middle = model.world_pose("/closeup")[:3, 3]
    places = {f"/closeup/{method}": found.point for method, found in solution.by_method.items()}
    places["/closeup/true"] = solution.true_point
    for name, place in places.items():
        assert model.visible(name) == (place is not None)
        if place is not None:
            drawn = (model.world_pose(name)[:3, 3] - middle) / times
            np.testing.assert_allclose(drawn, place - solution.point, rtol=0, atol=1e-9)
    if model.visible("/closeup/uncertainty"):
        assert solution.ellipsoid_axes is not None
        scale = model.node("/closeup/uncertainty/ellipsoid").props["scale"]
        np.testing.assert_allclose(scale, 3.0 * times * solution.ellipsoid_axes, rtol=1e-9)


@each_pair
def test_whether_there_is_a_point_is_said_in_the_scene_and_beside_it(stereo: Rig, params: TriangulationParams) -> None:
    stereo.show(params)
    solution = TRIANGULATION.solve(params)
    warned = solution.point is None or solution.vague
    assert stereo.model.visible("/warning") == warned
    assert ("s3-warn" in stereo.column.html("read")) == warned


def test_dragging_the_point_moves_both_pixels_to_its_projections(stereo: Rig) -> None:
    stereo.show(TriangulationParams())
    aim = (0.2, 3.0, 1.3)
    stereo.browser.drag("/point", (0.1, 3.5, 1.2), aim)
    stereo.settle()
    params = stereo.session.params
    assert isinstance(params, TriangulationParams)
    for side, pixel in (("left", params.left_uv), ("right", params.right_uv)):
        np.testing.assert_allclose(pixels(params, side, np.array([aim])), [pixel], rtol=0, atol=1e-9)
    np.testing.assert_allclose(stereo.model.world_pose("/point")[:3, 3], aim, rtol=0, atol=1e-9)


@pytest.mark.parametrize("aim", [(9.0, 2.0, 1.0), (-9.0, 2.0, 1.0), (0.0, 1.0, 9.0), (0.0, -3.0, 1.0), (0.0, 0.0, 1.0)])
def test_a_point_dragged_out_of_sight_stays_where_both_pictures_show_it(
    stereo: Rig, aim: tuple[float, float, float]
) -> None:
    stereo.show(TriangulationParams())
    stereo.browser.drag("/point", aim)
    stereo.settle()
    params = stereo.session.params
    assert isinstance(params, TriangulationParams)
    for side in ("left", "right"):
        ((u, v),) = pixels(params, side, stereo.model.world_pose("/point")[None, :3, 3]).tolist()
        assert -1e-6 <= u <= 639 + 1e-6
        assert -1e-6 <= v <= 479 + 1e-6


def test_shift_drags_along_one_axis(stereo: Rig) -> None:
    stereo.show(TriangulationParams())
    x, y, z = stereo.model.world_pose("/point")[:3, 3].tolist()
    stereo.browser.drag("/point", (x + 0.02, y + 0.5, z + 0.03), modifier="shift")
    stereo.settle()
    np.testing.assert_allclose(stereo.model.world_pose("/point")[:3, 3], (x, y + 0.5, z), rtol=0, atol=1e-9)
