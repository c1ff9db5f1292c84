"""Parameters of the sim."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal, Self

from sims.kit.fields import Choice, NumberBox, Slider, Switch, Vector
from sims.kit.frame import HEIGHT, WIDTH
from sims.kit.params import Params
from sims.kit.stereo import LARGEST as LARGEST_OWN
from sims.kit.stereo import Own, OwnPair, OwnSizes, Size, sizes, usable
from sims.kit.types import Pixel
from sims.triangulation.holding import held_point

Method = Literal["dlt", "midpoint", "optimal"]
NAMES: dict[Method, str] = {"dlt": "DLT", "midpoint": "mid-point", "optimal": "optimal"}
NEAREST, FARTHEST = (-60.0, 0.0, -50.0), (60.0, 100.0, 50.0)
"""Places, in metres, that can be typed."""
LAST_SEED = 9999
LARGEST = 4096
"""Pixels of a side of the pictures of a parallel rig."""
NARROWEST = 1500.0 / WIDTH
"""Greatest focal length, in widths of a picture that isn't small."""

IMAGES, SURENESS, RIG = "Image points", "How sure it is", "Real rigs"
"""Titles of folds."""
OF_RIG = {"baseline", "focal", "width", "height", "cx", "cy", "doffs"}
OF_CURVE = ("baseline", "focal", "noise")


class TriangulationParams(Params):
    """State of the sim."""

    baseline: Annotated[float, Slider(0.05, 2, step=0.01, unit="m", symbol="b", title="Baseline")] = 0.6
    """Distance between the cameras"""
    focal: Annotated[float, Slider(200, NARROWEST * LARGEST, step=10, unit="px", symbol="f", title="Focal length")] = (
        600
    )
    """The same for both cameras"""
    hold: Annotated[
        Literal["point", "pixels"],
        Choice(title="Moving b or f keeps", labels={"point": "the 3D point", "pixels": "the pixels"}),
    ] = "point"
    """What stays when you change the cameras: the 3D point, as in a real scene, so that its pixels move; or the pixels,
    so that the point moves"""
    left_uv: Annotated[
        Pixel, Vector((0.0, 0.0), (LARGEST_OWN - 1.0,) * 2, step=0.1, unit="px", title="Left point u, v", group=IMAGES)
    ] = (410.0, 210.0)
    """Where the point is in the left picture, before noise"""
    right_uv: Annotated[
        Pixel, Vector((0.0, 0.0), (LARGEST_OWN - 1.0,) * 2, step=0.1, unit="px", title="Right point u, v", group=IMAGES)
    ] = (320.0, 210.0)
    """Where the point is in the right picture, before noise"""
    noise: Annotated[float, Slider(0, 5, step=0.05, unit="px", symbol="σ", title="Noise")] = 0
    """Standard deviation of Gaussian noise on both points; 0 is off"""
    seed: Annotated[int, NumberBox(0, LAST_SEED, step=1, title="Sample", group=SURENESS)] = 0
    """Seed of the noise: the same seed, the same noise"""
    method: Annotated[
        Method,
        Choice(
            title="Method", labels={"dlt": "DLT (linear)", "midpoint": "Mid-point", "optimal": "Optimal (least error)"}
        ),
    ] = "dlt"
    """Which reconstruction is the result"""
    show_ellipsoid: Annotated[bool, Switch(title="Show ellipsoid", group=SURENESS)] = True
    """The uncertainty of the result, three standard deviations wide"""
    doffs: Annotated[float, NumberBox(-1000, 1000, step=1, unit="px", title="Offset doffs", group=RIG)] = 0
    """How much farther right the principal point is in the right picture than in the left one, as in Middlebury's data:
    Z = f b / (d + doffs)"""
    cx: Annotated[
        float, NumberBox(0, LARGEST, step=1, unit="px", symbol="cx", title="Left principal point", group=RIG)
    ] = 320
    """Where the left camera's optical axis meets its picture, counted from the left"""
    cy: Annotated[float, NumberBox(0, LARGEST, step=1, unit="px", symbol="cy", title="Principal point", group=RIG)] = (
        240
    )
    """Where the optical axes meet the pictures, counted from the top: the same for both cameras"""
    width: Annotated[int, NumberBox(64, LARGEST, step=1, unit="px", title="Width of the pictures", group=RIG)] = WIDTH
    """How many pixels a picture has from left to right"""
    height: Annotated[int, NumberBox(64, LARGEST, step=1, unit="px", title="Height of the pictures", group=RIG)] = (
        HEIGHT
    )
    """How many pixels a picture has from top to bottom"""
    own: OwnPair = None
    """A stereo pair of your own, in place of the parallel cameras: fx, fy, cx, cy of the left and the right camera, the
    rotation vector in degrees, and T, whose length `baseline` says in metres"""
    own_size: OwnSizes = None
    """Width and height of your left and of your right picture; absent: twice as far as their principal points are"""
    left_of_text: Annotated[int, NumberBox(1, 9, step=1, title="Left camera of the text", group=RIG)] = 1
    """Which one is the left one, where a text has more than two: the first is 1. Choose before you take the text"""
    right_of_text: Annotated[int, NumberBox(1, 9, step=1, title="Right camera of the text", group=RIG)] = 2
    """Which one is the right one, where a text has more than two. Choose before you take the text"""
    before: Annotated[
        tuple[float, float, float] | None,
        Vector(
            (0.05, 200.0, 0.0), (2.0, NARROWEST * LARGEST, 5.0), step=0.01, title="b, f and σ before the change",
            hidden=True,
        ),
    ] = None  # fmt: skip
    """Baseline, focal length and noise before a hand began to change one of them: the plot keeps their curve"""

    @property
    def pair(self) -> Own | None:
        """Somebody’s pair, if it has focal lengths and a baseline: then its cameras stand in place of the sim’s."""
        return usable(self.own)

    @property
    def sizes(self) -> tuple[Size, Size]:
        """Pixels of the left and of the right picture, across and down."""
        if self.pair is None:
            return (self.width, self.height), (self.width, self.height)
        return sizes(self.pair, self.own_size)

    @property
    def last(self) -> Pixel:
        """The pixel in the bottom right corner of a picture of a parallel rig."""
        return self.width - 1.0, self.height - 1.0

    def form(self) -> tuple[Any, ...]:
        """The cameras and their pictures: pixels, which move with every hand, would have all controls made anew."""
        return self.width, self.height, self.own, self.own_size

    def bounds(self, name: str) -> tuple[float, float]:
        if name == "focal":
            return 200.0, NARROWEST * max(self.width, WIDTH)
        return super().bounds(name)

    def label(self, name: str) -> str:
        return "Moving b keeps" if name == "hold" and self.pair else super().label(name)

    def about(self, name: str) -> str:
        if self.pair and name in OF_RIG - {"baseline"}:
            return "This says nothing of a stereo pair of your own: each of its cameras has its own"
        return super().about(name)

    def ranges(self, name: str) -> Sequence[tuple[float, float]]:
        if name in ("left_uv", "right_uv"):
            return tuple((0.0, end - 1.0) for end in self.sizes[name == "right_uv"])
        return super().ranges(name)

    def moved(self, changes: Mapping[str, Any]) -> Self:
        """What `hold` names stays while the rig changes, unless the changes say where the pixels are."""
        after = super().moved(changes)
        if any(name.startswith(("left_uv", "right_uv")) for name in changes):
            return after
        also: dict[str, Any] = self._remembered(changes)
        if after.hold == "point" and not OF_RIG.isdisjoint(changes):
            also |= held_point(self, after)
        return after.model_copy(update=also) if also else after

    def _remembered(self, changes: Mapping[str, Any]) -> dict[str, Any]:
        """The curve from which the change of one number begins, as long as it is that number which changes."""
        if len(changes) != 1 or (name := next(iter(changes))) not in OF_CURVE:
            return {}
        if self.pair and name == "focal":  # its cameras have their own
            return {}
        now = tuple([getattr(self, each) for each in OF_CURVE])
        if self.before and all(
            was == is_now for each, was, is_now in zip(OF_CURVE, self.before, now, strict=True) if each != name
        ):
            return {}
        return {"before": now}
