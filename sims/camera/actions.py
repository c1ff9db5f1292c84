"""What buttons and handles do to a state."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from geometry.camera import aim
from sims.camera.lens import pixel_at
from sims.camera.params import CameraParams
from sims.camera.solution import LIFT, camera_of
from sims.kit.sim import Step
from sims.kit.types import Place
from sims.kit.world import MIDDLE, SUBJECT

LEGS = 12
SECONDS = 3.0
NEAR = 0.5
"""Metres: a subject nearer than this, or behind, is looked at before the camera moves."""
ZOOM = 2.0
WORDS = {
    ZOOM: "It goes away and zooms in: the house stays as tall, and what is behind it grows.",
    1.0 / ZOOM: "It comes nearer and zooms out: the house stays as tall, and what is behind it shrinks.",
}
"""What is to be seen, by the factor of the depth."""
WIDE = 400.0
"""Pixels of focal length below which the dolly zoom goes away and zooms in, instead of the other way."""


def hold_eye(p: CameraParams, place: tuple[float, ...]) -> dict[str, Any]:
    """The centre of projection, by the grip above it."""
    x, y, z = place
    return {"position": (x, y, z - LIFT)}


def hold_look(p: CameraParams, place: tuple[float, ...]) -> dict[str, Any]:
    """A place that the optical axis goes through."""
    return turned_to(p, place)


def hold_principal(p: CameraParams, place: tuple[float, ...]) -> dict[str, Any]:
    """The principal point in the picture."""
    u, v = pixel_at(p, place)
    return {"cx": u, "cy": v}


def turned_to(p: CameraParams, place: tuple[float, ...]) -> dict[str, Any]:
    """Pan and tilt towards a place; as they are if the camera is there."""
    if math.dist(p.position, place) < 1e-9:
        return {}
    pan, tilt = aim(p.position, place)
    return {"pan": p.pan if pan is None else math.degrees(pan), "tilt": math.degrees(tilt)}


def look(p: CameraParams) -> Iterator[Step]:
    """Turn to the house, the shorter way round."""
    aims = turned_to(p, MIDDLE)
    if aims and abs(aims["pan"] - p.pan) > 180.0:
        edge = math.copysign(180.0, p.pan)
        yield Step({"pan": edge, "tilt": 0.5 * (p.tilt + aims["tilt"])}, 0.5)
        yield Step({"pan": -edge}, 0.0)
    yield Step(aims, 0.8)


def dolly_zoom(p: CameraParams) -> Iterator[Step]:
    """Come nearer and zoom out, or go away and zoom in, so that the house stays as tall in the picture."""
    if camera_of(p).to_camera(MIDDLE).item(2) < NEAR:
        yield from look(p)
        p = p.changed(turned_to(p, MIDDLE))
    near = (1.0 / ZOOM, ZOOM) if min(p.fx, p.fy) >= WIDE else (ZOOM, 1.0 / ZOOM)
    for factor in near:
        legs = [_leg(p, factor, (k + 1) / LEGS) for k in range(LEGS)]
        if all(_fits(p, leg) for leg in legs):
            yield from (Step(leg, SECONDS / LEGS, even=True, words=WORDS[factor]) for leg in legs)
            return


def _leg(p: CameraParams, factor: float, fraction: float) -> dict[str, Any]:
    """Where the camera is and how it zooms when it has made a part of its way, to `factor` times the depth."""
    camera = camera_of(p)
    depth = camera.to_camera(MIDDLE).item(2)
    way = depth * (1.0 - factor) * fraction * fraction * (3.0 - 2.0 * fraction)
    x, y, z = (np.array(p.position) + way * camera.R[2]).tolist()
    position: Place = (x, y, z)
    before, after = _height(p), _height(p.model_copy(update={"position": position}))
    seen = min(before, after) > 1.0  # seen from above, it has no height that could stay
    zoom = before / after if seen else 1.0 - way / depth
    return {"position": position, "fx": zoom * p.fx, "fy": zoom * p.fy, "skew": zoom * p.skew}


def _fits(p: CameraParams, leg: dict[str, Any]) -> bool:
    numbers = [*leg["position"], leg["fx"], leg["fy"], leg["skew"]]
    return all(map(math.isfinite, numbers)) and p.moved(leg) == p.model_copy(update=leg)


def _height(p: CameraParams) -> float:
    """Pixels from the house's ground to its ridge, in the middle."""
    ground, ridge = camera_of(p).project(SUBJECT)[0]
    return math.dist(ground, ridge)
