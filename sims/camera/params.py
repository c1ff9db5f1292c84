"""Parameters of the sim."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, Self

from sims.camera.world import TITLES, Name, Place
from sims.kit.params import Params, choice, number, switch, vector

Projection = Literal["perspective", "orthographic", "weak"]
Pixel = tuple[float, float]
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
