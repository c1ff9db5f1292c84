"""Parameters of the sim."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from sims.camera.world import TITLES, Name, Place
from sims.kit.fields import Choice, Slider, Switch, Vector
from sims.kit.params import Params

Projection = Literal["perspective", "orthographic", "weak"]
Pixel = tuple[float, float]
FARTHEST = 20.0


LENS = "The rest of K"


class CameraParams(Params):
    """State of the sim."""

    projection: Annotated[
        Projection,
        Choice(
            title="Projection",
            labels={"perspective": "Perspective", "orthographic": "Orthographic", "weak": "Weak perspective"},
        ),
    ] = "perspective"
    """Whether what is farther away becomes smaller"""
    fx: Annotated[float, Slider(100, 2000, step=10, unit="px", symbol="fx", title="Focal length")] = 600
    """In pixel widths"""
    fy: Annotated[float, Slider(100, 2000, step=10, unit="px", symbol="fy", title="Focal length", group=LENS)] = 600
    """In pixel heights"""
    linked: Annotated[bool, Switch(title="Link fx and fy", group=LENS)] = True
    """Moving one moves the other in proportion, as a zoom does"""
    cx: Annotated[float, Slider(0, 640, step=1, unit="px", symbol="cx", title="Principal point", group=LENS)] = 320
    """Where the optical axis meets the picture, from the left"""
    cy: Annotated[float, Slider(0, 480, step=1, unit="px", symbol="cy", title="Principal point", group=LENS)] = 240
    """Where the optical axis meets the picture, from the top"""
    skew: Annotated[float, Slider(-200, 200, step=1, unit="px", symbol="s", title="Skew", group=LENS)] = 0
    """How far the pixel rows lean; zero in nearly every real camera"""
    position: Annotated[
        Place,
        Vector((-FARTHEST, -FARTHEST, 0.0), (FARTHEST, FARTHEST, FARTHEST), step=0.05, unit="m", title="Position C"),
    ] = (0.0, -4.0, 1.2)
    """Centre of projection in the world"""
    pan: Annotated[float, Slider(-180, 180, step=1, unit="°", symbol="ψ", title="Pan")] = 0
    """About the world's Z; positive looks left"""
    tilt: Annotated[float, Slider(-90, 90, step=1, unit="°", symbol="θ", title="Tilt")] = 0
    """About the camera's x; positive looks up"""
    roll: Annotated[float, Slider(-180, 180, step=1, unit="°", symbol="φ", title="Roll")] = 0
    """About the optical axis; positive turns the camera clockwise"""
    selected: Annotated[Name, Choice(title="Point", labels=TITLES, group="The point, step by step")] = "roof-near"
    """The point that is worked through; click one to choose it"""
    show_rays: Annotated[bool, Switch(title="Rays", group="Show")] = True
    """From the points in the picture to the camera"""
    show_frustum: Annotated[bool, Switch(title="Frustum", group="Show")] = True
    """What the picture can show of space"""
    show_vanishing: Annotated[bool, Switch(title="Vanishing points", group="Show")] = True
    """Where the parallels of street and house meet"""
    show_labels: Annotated[bool, Switch(title="Labels", group="Show")] = True
    """Names of things in the scene"""

    def moved(self, changes: Mapping[str, Any]) -> Self:
        moving = [name for name in ("fx", "fy") if name in changes]
        if self.linked and len(moving) == 1:
            (name,) = moving
            other = "fy" if name == "fx" else "fx"
            low, high = self.bounds(name)
            value = min(max(changes[name], low), high)
            changes = {**changes, other: getattr(self, other) * value / getattr(self, name)}
        return super().moved(changes)
