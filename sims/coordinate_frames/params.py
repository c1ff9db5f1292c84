"""Parameters of the sim."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Self

from geometry import frames
from sims.coordinate_frames.conventions import NAMES, Axes, Convention, Handedness, Triple, axes, triple
from sims.kit.fields import Choice, Slider, Switch, Vector
from sims.kit.params import Params

GRIDS = {"grid_xy": (0, 1), "grid_xz": (0, 2), "grid_yz": (1, 2)}
"""Switch of each plane, and its two axes."""
BOUND = 5.0


SHOW = "Show"


class FramesParams(Params):
    """State of the sim. The axes may change while it runs: the point stays where it is, and reads anew."""

    convention: Annotated[Convention, Choice(title="Convention", labels=dict(NAMES.items()))] = "opengl"
    """Where X, Y and Z point, by the custom of a field or program"""
    to: Annotated[Convention, Choice(title="Second convention", labels=dict(NAMES.items()))] = "opengl"
    """Drawn thin and dashed; the matrix leads to it"""
    handedness: Annotated[
        Handedness | None,
        Choice(
            title="Handedness", labels={"right": "Right-handed", "left": "Left-handed"}, absent="As in the convention"
        ),
    ] = None
    """The other one than the convention's own mirrors Z"""
    point: Annotated[Triple, Vector(-BOUND, BOUND, step=0.05, title="Point")] = (1.0, 0.8, 0.6)
    """In the axes of the convention; where w isn't 1, the point is these divided by w"""
    w: Annotated[float, Slider(0, 2, step=0.01, symbol="w", title="Coordinate")] = 1
    """The point is (x/w, y/w, z/w); with w = 0 it is a direction"""
    show_rule: Annotated[bool, Switch(title="Show hand", group=SHOW)] = True
    """The rule of the right hand, or of the left for left-handed axes"""
    rule: Annotated[float, Slider(0, 1, step=0.01, title="Fingers", group=SHOW)] = 1
    """How far the fingers have swept: 0 along X, 1 along Y"""
    grid_xy: Annotated[bool, Switch(title="Grid XY", group=SHOW)] = False
    """The plane of X and Y, where z is zero"""
    grid_xz: Annotated[bool, Switch(title="Grid XZ", group=SHOW)] = False
    """The plane of X and Z, where y is zero"""
    grid_yz: Annotated[bool, Switch(title="Grid YZ", group=SHOW)] = False
    """The plane of Y and Z, where x is zero"""

    @property
    def axes(self) -> Axes:
        return axes(self.convention, self.handedness)

    def changed(self, changes: Mapping[str, Any]) -> Self:
        return self._same_place(super().changed(changes), changes)

    def moved(self, changes: Mapping[str, Any]) -> Self:
        return self._same_place(super().moved(changes), changes)

    def _same_place(self, state: Self, changes: Mapping[str, Any]) -> Self:
        """The state with its point where it was in the world, unless the changes name a point."""
        if "point" in changes or state.axes is self.axes:
            return state
        place = frames.to_world(self.point, self.axes.basis)
        return state.model_copy(update={"point": triple(frames.coordinates(place, state.axes.basis))})
