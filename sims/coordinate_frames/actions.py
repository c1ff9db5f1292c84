"""What buttons and handles do to a state."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from geometry import frames
from sims.coordinate_frames.conventions import triple
from sims.coordinate_frames.params import FramesParams
from sims.kit.sim import Step


def hold_point(p: FramesParams, place: tuple[float, ...]) -> dict[str, Any]:
    """(x, y, z) of a point in the world, to the millimetre, times w; a direction keeps the length of its numbers."""
    reading = np.round(frames.coordinates(place, p.axes.basis), 3) + 0.0
    if p.w > 0.0:
        return {"point": triple(reading * p.w)}
    length, pulled = math.hypot(*p.point) or 1.0, math.hypot(*reading.tolist())
    return {"point": triple(np.round(reading * (length / pulled), 3) + 0.0) if pulled else p.point}


def sweep(p: FramesParams) -> Iterator[Step]:
    """Fingers along X, then over to Y."""
    yield Step({"show_rule": True, "rule": 0.0}, 0.0)
    yield Step({"rule": 0.0}, 0.5)
    yield Step({"rule": 1.0}, 1.2)


def run_away(p: FramesParams) -> Iterator[Step]:
    """From w = 1 to a direction."""
    yield Step({"w": 1.0}, 0.0)
    yield Step({"w": 1.0}, 0.4)
    yield Step({"w": 0.0}, 1.2)
