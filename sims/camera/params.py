"""Parameters of the sim."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from sims.kit.fields import Choice, NumberBox, Slider, Switch, Vector
from sims.kit.frame import HEIGHT, WIDTH
from sims.kit.params import Params
from sims.kit.types import Place
from sims.kit.world import TITLES, Name

Projection = Literal["perspective", "orthographic", "weak"]
FARTHEST = 20.0
LENS, POSE, DISTORTION = "The rest of K, and the picture’s size", "Roll, and where to look", "Lens distortion"
OWN = "Your own camera"
LARGEST = 8192
"""Pixels of the widest and the tallest picture."""
MOST = 3.125
"""Greatest focal length, in widths of the picture."""
COEFFICIENTS = ("k1", "k2", "p1", "p2", "k3")


class CameraParams(Params):
    """State of the sim."""

    through: Annotated[bool, Switch(title="Look through the camera")] = False
    """The scene is seen from the centre of the camera, with the picture as a window; off: from where you were"""
    projection: Annotated[
        Projection,
        Choice(
            title="Projection",
            labels={"perspective": "Perspective", "orthographic": "Orthographic", "weak": "Weak perspective"},
        ),
    ] = "perspective"
    """Whether what is farther away becomes smaller"""
    fx: Annotated[float, Slider(1, MOST * LARGEST, step=10, unit="px", symbol="fx", title="Focal length")] = 600
    """In pixel widths"""
    fy: Annotated[
        float, Slider(1, MOST * LARGEST, step=10, unit="px", symbol="fy", title="Focal length", group=LENS)
    ] = 600
    """In pixel heights"""
    linked: Annotated[bool, Switch(title="Link fx and fy", group=LENS)] = True
    """Moving one moves the other in proportion, as a zoom does"""
    cx: Annotated[float, Slider(0, LARGEST, step=1, unit="px", symbol="cx", title="Principal point", group=LENS)] = 320
    """Where the optical axis meets the picture, from the left"""
    cy: Annotated[float, Slider(0, LARGEST, step=1, unit="px", symbol="cy", title="Principal point", group=LENS)] = 240
    """Where the optical axis meets the picture, from the top"""
    skew: Annotated[float, Slider(-LARGEST, LARGEST, step=1, unit="px", symbol="s", title="Skew", group=LENS)] = 0
    """How far the pixel rows lean; zero in nearly every real camera"""
    width: Annotated[int, NumberBox(16, LARGEST, step=1, unit="px", title="Width of the picture", group=LENS)] = WIDTH
    """A larger picture with the same K shows more; K itself stays"""
    height: Annotated[int, NumberBox(16, LARGEST, step=1, unit="px", title="Height of the picture", group=LENS)] = (
        HEIGHT
    )
    """A larger picture with the same K shows more; K itself stays"""
    ortho_scale: Annotated[float, Slider(10, 2000, step=1, unit="px/m", title="Orthographic scale", group=LENS)] = 100
    """Pixels of a metre, near and far: an orthographic picture has it in place of the focal length"""
    position: Annotated[
        Place,
        Vector((-FARTHEST, -FARTHEST, 0.0), (FARTHEST, FARTHEST, FARTHEST), step=0.05, unit="m", title="Position C"),
    ] = (0.0, -4.0, 1.2)
    """Centre of projection in the world"""
    pan: Annotated[float, Slider(-180, 180, step=1, unit="°", symbol="ψ", title="Pan")] = 0
    """About the world's Z; positive looks left"""
    tilt: Annotated[float, Slider(-90, 90, step=1, unit="°", symbol="θ", title="Tilt")] = 0
    """About the camera's x; positive looks up"""
    roll: Annotated[float, Slider(-180, 180, step=1, unit="°", symbol="φ", title="Roll", group=POSE)] = 0
    """About the optical axis; positive turns the camera clockwise"""
    k1: Annotated[float, Slider(-1.5, 1.5, step=0.01, symbol="k1", title="Radial", group=DISTORTION)] = 0
    """Below zero bends straight lines outwards, as a barrel's, above zero inwards, as a cushion's; perspective only"""
    k2: Annotated[float, NumberBox(-100, 100, step=0.01, symbol="k2", title="Radial", group=DISTORTION)] = 0
    """Like k1, but more of it far from the middle: it goes with the fourth power of the radius"""
    p1: Annotated[float, NumberBox(-1, 1, step=0.001, symbol="p1", title="Tangential", group=DISTORTION)] = 0
    """From a lens that is tilted up or down against the sensor"""
    p2: Annotated[float, NumberBox(-1, 1, step=0.001, symbol="p2", title="Tangential", group=DISTORTION)] = 0
    """From a lens that is tilted sideways against the sensor"""
    k3: Annotated[float, NumberBox(-1000, 1000, step=0.01, symbol="k3", title="Radial", group=DISTORTION)] = 0
    """Like k1, with the sixth power of the radius"""
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

    def bounds(self, name: str) -> tuple[float, float]:
        """Focal lengths, principal point and skew go as far as the picture's size makes sense of them."""
        wide = self.width / WIDTH
        match name:
            case "fx" | "fy":
                return min(100.0, 100.0 * wide), max(2000.0, MOST * self.width)
            case "cx":
                return 0.0, float(self.width)
            case "cy":
                return 0.0, float(self.height)
            case "skew":
                return -200.0 * max(wide, 1.0), 200.0 * max(wide, 1.0)
        return super().bounds(name)

    def label(self, name: str) -> str:
        unused = self.projection == "orthographic" and name in ("fx", "fy")
        return super().label(name) + " – unused" * unused

    def moved(self, changes: Mapping[str, Any]) -> Self:
        moving = [name for name in ("fx", "fy") if name in changes]
        if self.linked and len(moving) == 1:
            (name,) = moving
            other = "fy" if name == "fx" else "fx"
            low, high = self.bounds(name)
            value = min(max(changes[name], low), high)
            changes = {**changes, other: getattr(self, other) * value / getattr(self, name)}
        return super().moved(changes)
