"""The simulated clouds: sensors that cast rays at scenery, with the noise and the shadows of real ones.

Nothing here was scanned. Each is made once in a process, from a seed of its own, and rounded to 0.1 mm.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache
from threading import Lock

import numpy as np

from geometry import rotations, se3
from geometry.arrays import Array
from geometry.ray_casting import cast
from sims.kit.progress import begins
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.scenery import Place, Thing, court, room, statue, street

DIGITS = 4
RINGS, TURN = 64, 1800
"""Lasers of the rotating lidar, and how often each measures in a turn."""


def dataset(name: str) -> Cloud:
    """Return one of `DATASETS`; who asks while it is being made waits for it. Raises KeyError for another name."""
    with _making[name]:
        return _made(name)


@cache
def _made(name: str) -> Cloud:
    return DATASETS[name]()


def room_scan() -> Cloud:
    """A room with colours, from two places of a scanner that turns about two axes."""
    rng = np.random.default_rng(1)
    scans = [
        _scan(room(), sensor, _sphere(720, 160, (-62.0, 45.0)), rng, noise=0.002)
        for sensor in ((1.3, -1.5, 1.5), (-1.4, 0.4, 1.6))
    ]
    return _joined("room", scans)


def street_scan() -> Cloud:
    """A street as a lidar on a car's roof sees it in one turn: rings, intensities, shadows; no colours."""
    rng = np.random.default_rng(2)
    steps = _sphere(TURN, RINGS, (-24.8, 4.0))
    cloud = _scan(street(), (0.0, 0.0, 1.9), steps, rng, noise=0.015, reach=34.0, rings=True)
    return Cloud("street", cloud.points, None, cloud.intensity, cloud.ring, None, cloud.sensor, simulated=True)


def statue_scan() -> Cloud:
    """A statue from four sides, with 2 mm noise, and one point in fifty thrown off it."""
    rng = np.random.default_rng(3)
    scans = []
    for side in range(4):
        turn = math.radians(45.0 + 90.0 * side)
        sensor = (3.0 * math.cos(turn), 3.0 * math.sin(turn), 1.5)
        scans.append(_scan(statue(), sensor, _towards(sensor, (0.0, 0.0, 1.12), 38.0, 48.0, 310, 400), rng, 0.002))
    cloud = _joined("statue", scans)
    thrown = rng.random(len(cloud)) < 0.02
    cloud.points[thrown] += np.round(rng.normal(0.0, 0.18, (int(thrown.sum()), 3)), DIGITS)
    return cloud


def two_scans() -> Cloud:
    """A court from two places: the second scan is in its own sensor's frame, some way off where it belongs."""
    rng = np.random.default_rng(4)
    sensors = ((-1.0, -3.6, 1.7), (1.7, -3.2, 1.5))
    first, second = (
        _scan(court(), sensor, _towards(sensor, (0.0, 0.4, 0.9), 74.0, 52.0, 458, 328), rng, 0.002)
        for sensor in sensors
    )
    truth = se3.transform(
        rotations.axis_rotation("z", math.radians(7.0)) @ rotations.axis_rotation("x", math.radians(1.5)),
        np.array([0.16, -0.12, 0.05]),
    )
    moved = np.round(se3.apply(se3.inverse(truth), second.points), DIGITS)
    sensor = np.broadcast_to(se3.apply(se3.inverse(truth), np.array(sensors[1])), moved.shape)
    placed = Cloud("two-scans", moved, second.colors, second.intensity, sensor=sensor, apart=True, truth=truth)
    return _joined("two-scans", [first, placed])


DATASETS: dict[str, Callable[[], Cloud]] = {
    "room": room_scan,
    "street": street_scan,
    "statue": statue_scan,
    "two-scans": two_scans,
}
_making = {name: Lock() for name in DATASETS}


def _sphere(turns: int, rows: int, elevations: tuple[float, float]) -> Array:
    """Directions (rows · turns, 3) all round, between two elevations in degrees."""
    up, about = np.meshgrid(
        np.radians(np.linspace(*elevations, rows)), np.arange(turns) * (2.0 * math.pi / turns), indexing="ij"
    )
    return np.stack([np.cos(up) * np.sin(about), np.cos(up) * np.cos(about), np.sin(up)], axis=-1).reshape(-1, 3)


def _towards(sensor: Place, at: Place, wide: float, high: float, columns: int, rows: int) -> Array:
    """Directions (rows · columns, 3) of a picture that looks from a sensor at a place, its angles in degrees."""
    forward = np.subtract(at, sensor)
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    x, y = np.meshgrid(
        *(math.tan(math.radians(a / 2.0)) * np.linspace(-1.0, 1.0, n) for a, n in ((wide, columns), (high, rows)))
    )
    rays = forward + x[..., None] * right + y[..., None] * np.cross(right, forward)
    return np.asarray(rays / np.linalg.norm(rays, axis=-1, keepdims=True)).reshape(-1, 3)


def _scan(
    things: Sequence[Thing], sensor: Place, rays: Array, rng: np.random.Generator, noise: float,
    reach: float = 30.0, rings: bool = False,
) -> Cloud:  # fmt: skip
    """What comes back: the nearest body on each ray, its range with noise, and light by angle and distance."""
    begins("Simulating a scanner")
    hits = cast(sensor, rays, [thing.body for thing in things])
    seen = np.flatnonzero(hits.distance < reach)
    body, ray, distance = hits.body[seen], rays[seen], hits.distance[seen]
    facing = np.abs(np.vecdot(hits.normals[seen], ray))
    intensity = np.array([thing.reflects for thing in things])[body] * (0.25 + 0.75 * facing) * np.exp(-distance / 60.0)
    intensity = np.clip(intensity * rng.normal(1.0, 0.04, len(seen)), 0.0, 1.0)
    measured = distance + rng.normal(0.0, noise, len(seen))
    points = np.round(np.asarray(sensor) + measured[:, None] * ray, DIGITS)
    base = np.array([thing.color for thing in things])[body] * (0.72 + 0.28 * facing)[:, None]
    colors = np.clip(base + rng.normal(0.0, 5.0, (len(seen), 1)), 0.0, 255.0).astype(np.uint8)
    ring = (seen // TURN).astype(np.uint8) if rings else None
    return Cloud("", points, colors, np.round(intensity, 3), ring, None, np.array(sensor))


def _joined(name: str, scans: Sequence[Cloud]) -> Cloud:
    def rows(attribute: str) -> list[Array]:
        return [np.broadcast_to(getattr(scan, attribute), scan.points.shape) for scan in scans]

    scan = np.repeat(np.arange(len(scans), dtype=np.uint8), [len(one) for one in scans])
    colors = np.concatenate([one.colors for one in scans if one.colors is not None])
    intensity = np.concatenate([one.intensity for one in scans if one.intensity is not None])
    points, sensor = (np.concatenate(rows(attribute)) for attribute in ("points", "sensor"))
    return Cloud(
        name,
        points,
        colors,
        intensity,
        None,
        scan,
        sensor,
        apart=scans[-1].apart,
        truth=scans[-1].truth,
        simulated=True,
    )
