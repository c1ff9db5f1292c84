"""A camera as it stands in a scene: body, letter, frustum and the picture in front of it."""

from __future__ import annotations

from typing import Literal

import numpy as np
import numpy.typing as npt

from sims.kit.scene import bodies
from sims.kit.scene.stage import Stage

BANDS = {"left": 1, "right": 2}
PICTURE_WIDTH = 0.4
"""Metres, in the scene; how far in front of the centre it stands follows from the focal length."""


class CameraFigure:
    """Everything that moves with one camera: place and turn `node`, and the rest follows."""

    def __init__(self, stage: Stage, name: str, role: Literal["left", "right", "ink"], letter: str) -> None:
        self.node = stage.group(name)
        parts = bodies.camera(BANDS.get(role, 0))
        grey = (70, 78, 88) if stage.palette.dark else (88, 96, 106)
        self.solids = [
            stage.mesh(f"{name}/body", parts["body"], role),
            stage.mesh(f"{name}/lens", parts["lens"], grey),
        ]
        if "mark" in parts:
            self.solids.append(stage.mesh(f"{name}/mark", parts["mark"], "page"))
        self.edges = stage.lines(f"{name}/frustum", role, width=1.5)
        self.picture = stage.sheet(f"{name}/picture", role, opacity=0.12)
        self._letter = stage.label(f"{name}/letter", letter)

    def show(self, visible: bool) -> None:
        """Show or hide the body with its letter; who looks through a camera doesn't see it."""
        for node in (*self.solids, self._letter):
            node.show(visible)

    def draw(
        self, corners: npt.NDArray[np.float64], size: float = 1.0, back: npt.NDArray[np.float64] | None = None
    ) -> None:
        """Show the picture's corners (4, 3), round it, in the camera's axes; `size` scales the body.

        The frustum begins in the centre, or, for a camera whose lines of sight are parallel, in corners at its `back`.
        """
        for solid in self.solids:
            solid.scale(size)
        self._letter.pose(position=(0.0, -0.22 * size, -0.12 * size))
        if self.node.differs("corners", corners, back):
            edges = np.zeros((8, 2, 3))
            edges[:4, 1] = edges[4:, 0] = corners
            edges[4:, 1] = np.roll(corners, -1, axis=0)
            if back is not None:
                edges[:4, 0] = back
            self.edges.pieces(edges)
            self.picture.vertices(corners)


class Post:
    """The post on which a camera stands, straight down to the ground however the camera is turned."""

    def __init__(self, stage: Stage, camera: str) -> None:
        self.line = stage.lines(f"{camera}/post", "ghost", width=1.2)

    def draw(self, up: npt.ArrayLike, height: float, size: float = 1.0) -> None:
        """Below a camera at a height; `up` is the world's Z in the camera's axes, `size` that of its body."""
        top, z = np.array([0.0, 0.08, -0.12 * size]), np.asarray(up, dtype=float)
        self.line.stroke((top.tolist(), (top - (height + top @ z) * z).tolist()))
