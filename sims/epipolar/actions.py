"""What buttons and handles do to a state."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from sims.epipolar import ray
from sims.epipolar.eye import eyes
from sims.epipolar.params import ENOUGH, LAST_SEED, LEFT, POINT, RIGHT, SIGHT, EpipolarParams, Side
from sims.epipolar.solution import EpipolarSolution
from sims.kit.scale import Scale
from sims.kit.sim import Step
from sims.kit.spelling import plain
from sims.kit.stereo import camera

PRESETS: dict[str, dict[str, Any]] = {
    "rectified": {"left": LEFT, "right": RIGHT, "left_pan": 0.0, "right_pan": 0.0},
    "sight": {**SIGHT},
    "converging": {"left": (-1.2, 0.4, 1.0), "right": (1.2, 0.4, 1.0), "left_pan": -18.0, "right_pan": 18.0},
    "forward": {"left": (0.0, -0.6, 1.0), "right": (0.0, 0.9, 1.0), "left_pan": 0.0, "right_pan": 0.0},
    "vertical": {"left": (0.0, 0.0, 0.65), "right": (0.0, 0.0, 1.45), "left_pan": 0.0, "right_pan": 0.0},
}
"""Camera centres and pans; the rest of what a preset sets is in `preset`."""
GLIDE = 0.9


def preset(name: str) -> Any:
    """An action: both cameras glide to their places, and what is seen of the point is as at the start.

    They are the sim's own: a pair of somebody's goes, and the pixel that was picked in its pictures.
    """

    def run(p: EpipolarParams) -> Iterator[Step]:
        pick = None if p.pair else p.pick
        marks = {"trail": None, "candidate": None, "own": None, "own_size": None, "pick": pick}
        yield Step({**PRESETS[name], "focal": 600.0, "point": POINT, **marks}, GLIDE)

    return run


def new_sample(p: EpipolarParams) -> dict[str, Any]:
    """Noise of the next seed, on as many points as an estimate needs and some more."""
    if p.noise > 0.0 and p.points >= 8:
        return {"seed": (p.seed + 1) % (LAST_SEED + 1)}
    return {"noise": p.noise or 1.0, "points": max(p.points, ENOUGH)}


def clear(p: EpipolarParams) -> dict[str, Any]:
    """No pixel is picked or free, and no trail is shown."""
    return {"pick": None, "candidate": None, "trail": None}


def depth(p: EpipolarParams, s: EpipolarSolution) -> float | None:
    """What the dial of the depth shows, where there is a ray to slide along."""
    return s.depth_left if s.depth_left >= ray.LEAST else None


def off_line(p: EpipolarParams, s: EpipolarSolution) -> float | None:
    """What the dial of q′ shows: how far it is from the line, if both are there."""
    return None if s.candidate is None else s.candidate.distance


def hold(name: str) -> Any:
    """A handle that sets a place in the scene."""

    def run(p: EpipolarParams, place: tuple[float, ...]) -> Mapping[str, Any]:
        return {name: place}

    return run


def hold_pick(side: Side) -> Any:
    """A handle that picks a pixel of one picture."""

    def run(p: EpipolarParams, place: tuple[float, ...]) -> Mapping[str, Any]:
        eye = eyes(p)[side == "right"]
        u, v = eye.within(*Scale.of(*eye.size).pixel(place))
        return {"pick": f"{side}:{plain(u)},{plain(v)}"}

    return run


NEAREST = 0.05
"""Metres before a camera that a point which is held in its picture keeps."""


def hold_pixel(side: Side) -> Callable[[EpipolarParams, tuple[float, ...]], Mapping[str, Any]]:
    """A handle that moves the point parallel to a picture, to where that picture shows it at a pixel."""

    def run(p: EpipolarParams, place: tuple[float, ...]) -> Mapping[str, Any]:
        eye = eyes(p)[side == "right"]
        held, pixel = camera(eye), Scale.of(*eye.size).pixel(place)
        depth = max(float(held.project(p.point)[1]), NEAREST)
        x, y, z = (held.center + depth * held.back_projection.dot([*pixel, 1.0])).tolist()
        return {"point": (x, y, z)}

    return run
