"""From where the scene is looked at."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from sims.kit.types import Vector

FIELD = 0.7
"""Vertical field of view of the scene, in radians; the page has it from here."""


def look(camera: Any, position: Vector, look_at: Vector, radius: float) -> None:
    """Look from a place at another, or from so far behind it that a sphere of `radius` fits."""
    height = camera.image_height or 1  # a frame that is hidden again has none
    aspect = (camera.image_width or 1) / height
    half = math.tan(0.5 * FIELD) * min(1.0, aspect)  # static/viewer/view.js does the same for the first view
    away = np.subtract(position, look_at)
    away *= radius / math.sin(math.atan(half)) / float(np.linalg.norm(away))
    camera.position = np.asarray(look_at) + away
    camera.look_at = np.asarray(look_at)
