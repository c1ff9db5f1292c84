"""From where the scene is looked at."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from sims.kit.types import Place, Vector

FIELD = 0.7
"""Vertical field of view of the scene, in radians; the page has it from here."""
NEAR = 0.01
"""Metres from the viewpoint at which things begin to be seen: viser's own."""
SPARE = 1.12
"""How much more than a window is in sight."""
UP = (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Window:
    """A view as through a window: `half` is the half of its width and height at one metre from the viewpoint."""

    position: Place
    look_at: Place
    up: Place
    half: tuple[float, float]
    near: float = NEAR


@dataclass(frozen=True)
class Seen:
    """From where somebody looks at the scene, through a page of some width over height."""

    position: Place
    look_at: Place
    aspect: float


def aspect(camera: Any) -> float:
    """Width over height of the page that a camera is seen in."""
    return float((camera.image_width or 1) / (camera.image_height or 1))  # a frame that is hidden again has none


def _half(aspect: float) -> float:
    """What is in sight at one metre, from the middle to the nearer edge; static/viewer/view.js does the same."""
    return math.tan(0.5 * FIELD) * min(1.0, aspect)


def look(camera: Any, position: Vector, look_at: Vector, radius: float) -> None:
    """Look from a place at another, or from so far behind it that a sphere of `radius` fits."""
    away = np.subtract(position, look_at)
    away *= radius / math.sin(math.atan(_half(aspect(camera)))) / float(np.linalg.norm(away))
    camera.position = np.asarray(look_at) + away
    camera.look_at = np.asarray(look_at)


def look_through(camera: Any, window: Window) -> None:
    """Look from a place at another, upright as said, with a whole window in sight."""
    across, down = window.half
    camera.position, camera.look_at, camera.up_direction = map(np.array, (window.position, window.look_at, window.up))
    camera.fov = 2.0 * math.atan(SPARE * max(down, across / aspect(camera)))
    camera.near = window.near


def stand_back(camera: Any) -> None:
    """Upright again, and with the usual field of view."""
    camera.up_direction, camera.fov, camera.near = np.array(UP), FIELD, NEAR
