"""Hands on the point in a picture."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from sims.epipolar.model import EpipolarParams, Side
from sims.epipolar.rig import camera

NEAREST = 0.05
"""Metres before a camera that a point which is held in its picture keeps."""


def hold_pixel(side: Side) -> Callable[[EpipolarParams, tuple[float, ...]], Mapping[str, Any]]:
    """A handle that moves the point parallel to a picture, to where that picture shows it at a pixel."""

    def run(p: EpipolarParams, place: tuple[float, ...]) -> Mapping[str, Any]:
        eye = camera(p.left, p.left_pan, p.focal) if side == "left" else camera(p.right, p.right_pan, p.focal)
        depth = max(float(eye.project(p.point)[1]), NEAREST)
        x, y, z = (eye.center + depth * eye.back_projection.dot([place[0], place[1], 1.0])).tolist()
        return {"point": (x, y, z)}

    return run
