"""Parameters of the sim, and the mathematics of a state."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, Self

import numpy as np
import numpy.typing as npt

from geometry.arrays import Array
from sims.camera.world import NAMES, TITLES, Name, Place
from sims.kit.params import Params, choice, number, switch, vector

Projection = Literal["perspective", "orthographic", "weak"]
Pixel = tuple[float, float]
WIDTH, HEIGHT = 640, 480
PICTURE_WIDTH = 0.9
"""Metres that the picture is wide where it stands in the scene; how far in front follows from the focal length."""
FARTHEST = 20.0


class CameraParams(Params):
    """State of the sim."""

    projection: Projection = choice(
        "perspective", title="Projection", description="Whether what is farther away becomes smaller",
        labels={"perspective": "Perspective", "orthographic": "Orthographic", "weak": "Weak perspective"},
    )  # fmt: skip
    fx: float = number(
        600, 100, 2000, step=10, unit="px", title="Focal length", symbol="fx", description="In pixel widths"
    )
    fy: float = number(
        600, 100, 2000, step=10, unit="px", title="Focal length", symbol="fy", description="In pixel heights"
    )
    linked: bool = switch(
        True, title="Link fx and fy", description="Moving one moves the other in proportion, as a zoom does"
    )
    cx: float = number(
        320, 0, 640, step=1, unit="px", title="Principal point", symbol="cx",
        description="Where the optical axis meets the picture, from the left",
    )  # fmt: skip
    cy: float = number(
        240, 0, 480, step=1, unit="px", title="Principal point", symbol="cy",
        description="Where the optical axis meets the picture, from the top",
    )  # fmt: skip
    skew: float = number(
        0, -200, 200, step=1, unit="px", title="Skew", symbol="s",
        description="How far the pixel rows lean; zero in nearly every real camera",
    )  # fmt: skip
    position: Place = vector(
        (0.0, -4.0, 1.2), (-FARTHEST, -FARTHEST, 0.0), (FARTHEST, FARTHEST, FARTHEST), step=0.05, unit="m",
        title="Position C", description="Centre of projection in the world",
    )  # fmt: skip
    pan: float = number(
        0, -180, 180, step=1, unit="°", title="Pan", symbol="ψ", description="About the world's Z; positive looks left"
    )
    tilt: float = number(
        0, -90, 90, step=1, unit="°", title="Tilt", symbol="θ", description="About the camera's x; positive looks up"
    )
    roll: float = number(
        0, -180, 180, step=1, unit="°", title="Roll", symbol="φ",
        description="About the optical axis; positive turns the camera clockwise",
    )  # fmt: skip
    selected: Name = choice(
        "roof-near", title="Point", description="The point that is worked through; click one to choose it",
        labels=TITLES,
    )  # fmt: skip
    show_rays: bool = switch(True, title="Rays", description="From the points in the picture to the camera")
    show_frustum: bool = switch(True, title="Frustum", description="What the picture can show of space")
    show_vanishing: bool = switch(
        True, title="Vanishing points", description="Where the parallels of street and house meet"
    )
    show_labels: bool = switch(True, title="Labels", description="Names of things in the scene")

    def moved(self, changes: Mapping[str, Any]) -> Self:
        moving = [name for name in ("fx", "fy") if name in changes]
        if self.linked and len(moving) == 1:
            (name,) = moving
            other = "fy" if name == "fx" else "fx"
            low, high = self.bounds(name)
            value = min(max(changes[name], low), high)
            changes = {**changes, other: getattr(self, other) * value / getattr(self, name)}
        return super().moved(changes)


@dataclass(frozen=True)
class CameraSolution:
    """What doesn't exist is None. `center`, `look` and `world` are in the world, the rest in the camera's axes."""

    K: Array
    R: Array
    t: Array
    P: Array | None
    center: Array
    orientation: Array
    """Quaternion of the camera in the world."""
    fov_x: float
    fov_y: float
    points: Sequence[Mapping[str, Any]]
    mean_depth: float
    scale_depth: float | None
    """The one depth by which a picture without perspective divides."""
    subject: Mapping[str, Any]
    """`world`, `depth` and `pixel` of the house's middle; `height`: pixels from its ground to its ridge."""
    decomposed: Mapping[str, Any] | None
    """`K`, `R` and `center`, found from P alone; an affine P has no centre."""
    vanishing: Sequence[Mapping[str, Any]]
    """`name`, `role`, `homogeneous`, `pixel` and `in_image` for each direction of the street."""
    wires: Array
    """Edges (n, 2, 2) in the picture, in pixels, cut off at its frame and at the camera's plane."""
    shown: npt.NDArray[np.intp]
    """Numbers (n,) of those edges in the world."""
    frustum: Frustum | None
    reach: float
    """How far the optical axis is drawn; `look`, at its end, is where the grip stands that turns the camera."""
    look: Array
    grip: Array
    """Where the grip stands that moves the camera: above it, where nothing hides it."""

    def point(self, name: str) -> Mapping[str, Any]:
        """One of `points`."""
        return self.points[NAMES.index(name)]


@dataclass(frozen=True)
class Frustum:
    """What the picture can show of space, and the picture as it stands there; all in the camera's axes, in metres."""

    depth: float
    """Of the picture."""
    corners: Array
    """Of the picture (4, 3): top left, top right, bottom right, bottom left."""
    back: Array
    """Where the lines of sight through them come from (4, 3): the centre, or the camera's plane."""
    far: Array | None
    """Without perspective: where sizes are true (4, 3)."""
    wires: Array
    """Edges (n, 2, 3) of the picture."""
    dots: Array
    """Named points (m, 3) in the picture."""
    rays: Array
    """Lines of sight (m, 2, 3) from the camera to those points."""
    chosen: Array | None
    """Line of sight (3, 3) of the selected point: where it comes from, its place in the picture, the point."""
    meet: Array
    """Vanishing points (3, 3) in the picture; the centre for those that aren't in it."""
