"""From where the scene is looked at."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from sims.kit.layout import LAYOUT
from sims.kit.types import Vector


def look(camera: Any, position: Vector, look_at: Vector, radius: float, *, width: float, phone: bool) -> None:
    """Look from a place at another, or from so far behind it that a sphere of `radius` fits.

    `width`: pixels that panels leave to the scene.
    """
    seen = LAYOUT.sheet if phone else 1.0  # of the height; static/viewer/view.js does the same for the first view
    height = camera.image_height or 1  # a frame that is hidden again has none
    aspect = (min(camera.image_width, width) or 1) / (seen * height)
    half = math.tan(0.5 * LAYOUT.field) * min(1.0, aspect) * seen
    away = np.subtract(position, look_at)
    away *= radius / math.sin(math.atan(half)) / float(np.linalg.norm(away))
    middle = np.subtract(look_at, (0.0, 0.0, LAYOUT.lower * radius if phone else 0.0))
    camera.position = middle + away
    camera.look_at = middle
