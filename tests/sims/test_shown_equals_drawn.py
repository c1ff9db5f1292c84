"""The poses that a browser received are those that the read-outs and SciPy name."""

from __future__ import annotations

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
    made = Rig(EULER_ANGLES)
    yield made
    made.close()
    assert not made.problems()


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
