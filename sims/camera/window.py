"""From where, and how wide, the scene is seen by who looks through the camera."""

from __future__ import annotations

import numpy as np

from sims.camera.params import CameraParams
from sims.camera.solution import CameraSolution, camera_of
from sims.kit.scene.view import Window
from sims.kit.view import View

AWAY = 300.0
"""Metres behind the camera from which its lines of sight are as good as parallel."""
USUAL = View((-4.28, -8.2, 4.4), (0.2, -0.6, -0.4), 3.5)


def view(p: CameraParams) -> View:
    """The first view of a state."""
    if not p.through:
        return USUAL
    forward = camera_of(p).R[2]
    position = np.array(p.position) - (0.0 if p.projection == "perspective" else AWAY) * forward
    return View(tuple(position.tolist()), tuple((position + forward).tolist()), 0.0)


def window(p: CameraParams, s: CameraSolution) -> Window:
    """What the camera looks through: as wide as its picture, which is all in sight."""
    home = view(p)
    away = 0.0 if p.projection == "perspective" else AWAY
    corners = np.array([(1.0, 1.0)]) if s.frustum is None else s.frustum.corners[:, :2] / (s.frustum.depth + away)
    across, down = np.abs(corners).max(axis=0).tolist()
    return Window(home.position, home.look_at, tuple((-s.R[1]).tolist()), (across, down), max(0.01, 0.9 * away))
