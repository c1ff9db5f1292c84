"""Parameters of the sim."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import model_validator

from geometry.arrays import Array
from sims.kit.fields import NumberBox, Slider, Switch, Text, Vector
from sims.kit.frame import HEIGHT, WIDTH
from sims.kit.params import Params
from sims.kit.refusals import refusal
from sims.kit.stereo import LARGEST, Own, OwnPair, OwnSizes, Size, sizes, usable
from sims.kit.world import PLACES, TITLES

Pixel = tuple[float, float]
Place = tuple[float, float, float]
Side = Literal["left", "right"]
CENTER: Pixel = (320.0, 240.0)
"""Principal point of both of the sim’s own cameras."""
LAST_SEED = 9999
LEFT: Place = (-0.6, 0.0, 1.0)
RIGHT: Place = (0.6, 0.0, 1.0)
POINT: Place = (0.3, 4.0, 1.2)
WORLD: Place = (0.3, 5.0, 0.0)
"""Metres that the little world is moved to stand before the cameras."""
CORNERS = (
    "roof-near", "cube-left", "near-post", "eave-far-right", "near-foot", "eave-near-right", "wall-near-left",
    "far-post", "eave-near-left", "wall-near-right", "roof-far",
)  # fmt: skip
OTHERS: Array = np.array([PLACES[name] for name in CORNERS]) + WORLD
"""The points after the first, in the world: in sight of both cameras in each preset, and not on one plane."""


CAMERAS, ESTIMATE, OWN = "The cameras", "F estimated from noisy points", "Your own stereo pair"
"""Titles of folds."""
ESTIMATE_ACTION, ENOUGH = "Estimate F, new noise", 12
"""The button that estimates F, and how many points it shows: as many as that takes, and some more."""


SIGHT: Mapping[str, Any] = {"left": (-0.4, 0.9, 0.9), "right": (0.5, -0.8, 1.2), "left_pan": -8.0, "right_pan": 8.0}
"""The right camera sees the left one: an epipole is in its picture."""


class EpipolarParams(Params):
    """State of the sim."""

    opening: ClassVar[Mapping[str, Any]] = SIGHT

    left: Annotated[
        Place, Vector((-3.0, -3.0, 0.0), (3.0, 3.0, 3.0), step=0.01, unit="m", title="Left camera", group=CAMERAS)
    ] = LEFT
    """Centre of the left camera: X, Y, Z"""
    right: Annotated[
        Place, Vector((-3.0, -3.0, 0.0), (3.0, 3.0, 3.0), step=0.01, unit="m", title="Right camera", group=CAMERAS)
    ] = RIGHT
    """Centre of the right camera: X, Y, Z"""
    left_pan: Annotated[float, Slider(-60, 60, step=0.5, unit="°", title="Left pan", group=CAMERAS)] = 0
    """Turn of the left camera about the vertical; positive is to its left"""
    right_pan: Annotated[float, Slider(-60, 60, step=0.5, unit="°", title="Right pan", group=CAMERAS)] = 0
    """Turn of the right camera about the vertical; positive is to its left"""
    focal: Annotated[float, Slider(200, 1500, step=10, unit="px", symbol="f", title="Focal length", group=CAMERAS)] = (
        600
    )
    """The same for both cameras"""
    point: Annotated[Place, Vector((-5.0, -3.0, -2.0), (5.0, 12.0, 5.0), step=0.01, unit="m", title="3D point")] = POINT
    """The first point, which you can also drag in the scene: X, Y, Z"""
    points: Annotated[int, Slider(1, 12, step=1, title="Points")] = 6
    """How many points are shown, the 3D point among them"""
    show_plane: Annotated[bool, Switch(title="Show epipolar plane", group="Show")] = True
    """The plane through both camera centres and the 3D point"""
    show_all_lines: Annotated[bool, Switch(title="Show all epipolar lines")] = False
    """The lines of all points, and not of the 3D point alone"""
    show_top: Annotated[bool, Switch(title="Show from above", group="Show")] = True
    """A plan of the scene below the pictures"""
    selected: Annotated[int, NumberBox(1, 12, step=1, title="Selected point", hidden=True)] = 1
    """The point that is marked everywhere, by its number; 1 is the 3D point. A click chooses another"""
    noise: Annotated[float, Slider(0, 5, step=0.05, unit="px", symbol="σ", title="Noise", group=ESTIMATE)] = 0
    """Standard deviation of Gaussian noise on the pixels that F is estimated from; 0 is off"""
    seed: Annotated[int, NumberBox(0, LAST_SEED, step=1, title="Sample", group=ESTIMATE)] = 0
    """Seed of the noise: the same seed, the same noise"""
    trail: Annotated[tuple[float, float] | None, Vector(0.01, 30.0, step=0.1, unit="m", title="Trail", hidden=True)] = (
        None
    )
    """Depths between which P has slid along the left ray: that piece of it is marked"""
    candidate: Annotated[Pixel | None, Vector(0.0, LARGEST - 1.0, step=1, unit="px", title="Free p′", hidden=True)] = (
        None
    )
    """A pixel of the right picture, q′, that is tried as the partner of p"""
    own: OwnPair = None
    """Both calibrations: fx, fy, cx, cy of the left and the right camera, the rotation vector in degrees, and T"""
    own_size: OwnSizes = None
    """Width and height of your left and of your right picture; absent: twice as far as their principal points are"""
    left_of_text: Annotated[int, NumberBox(1, 9, step=1, title="Left camera of the text", group=OWN)] = 1
    """Which one is the left one, where a text has more than two: the first is 1. Choose before you take the text"""
    right_of_text: Annotated[int, NumberBox(1, 9, step=1, title="Right camera of the text", group=OWN)] = 2
    """Which one is the right one, where a text has more than two. Choose before you take the text"""
    own_left: Annotated[Pixel, Vector(-1e5, 1e5, step=1, unit="px", title="Your left pixel", group=OWN)] = (0.0, 0.0)
    """A pixel of your left picture, free of distortion: u, v"""
    own_right: Annotated[Pixel, Vector(-1e5, 1e5, step=1, unit="px", title="Your right pixel", group=OWN)] = (0.0, 0.0)
    """The pixel of your right picture that may be its partner: u, v"""
    pick: Annotated[
        str | None,
        Text(
            title="Picked pixel",
            pattern=r"^(left|right):[0-9.e-]{1,24},[0-9.e-]{1,24}$",
            format="left:u,v or right:u,v, with u from 0 to 639 and v from 0 to 479",
            hidden=True,
        ),
    ] = None
    """A pixel of one picture; its epipolar line is shown in the other"""

    @property
    def pair(self) -> Own | None:
        """Somebody’s pair, if it has focal lengths and a baseline: then its cameras stand in place of the sim’s."""
        return usable(self.own)

    @property
    def typed(self) -> bool:
        """Whether somebody typed a match of their pair."""
        return any((*self.own_left, *self.own_right))

    @property
    def sizes(self) -> tuple[Size, Size]:
        """Pixels of the left and of the right picture, across and down."""
        if self.pair is None:
            return (WIDTH, HEIGHT), (WIDTH, HEIGHT)
        return sizes(self.pair, self.own_size)

    def ranges(self, name: str) -> Sequence[tuple[float, float]]:
        if name == "candidate":
            return [(0.0, size - 1.0) for size in self.sizes[1]]
        return super().ranges(name)

    @model_validator(mode="after")
    def _in_a_picture(self) -> Self:
        try:
            side, (u, v) = read_pick(self.pick or "left:0,0")
        except ValueError:
            side, u, v = "left", -1.0, -1.0
        width, height = self.sizes[side == "right"]
        if not (0.0 <= u < width and 0.0 <= v < height):
            range_ = f"u from 0 to {width - 1} and v from 0 to {height - 1}"
            raise refusal(["pick"], f"left:u,v or right:u,v, with {range_}")
        return self


def title(number: int) -> str:
    """What a point is called."""
    return "P, the 3D point" if number == 1 else f"Point {number}: {TITLES[CORNERS[number - 2]]}"


def read_pick(pick: str) -> tuple[Side, Pixel]:
    """Picture and pixel; raises ValueError if they aren't numbers."""
    side, _, place = pick.partition(":")
    u, v = map(float, place.split(","))
    return ("left" if side == "left" else "right"), (u, v)
