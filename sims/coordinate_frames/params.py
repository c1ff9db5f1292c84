"""Parameters of the sim."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Self

from geometry import frames
from sims.coordinate_frames.conventions import NAMES, Axes, Convention, Handedness, Triple, axes, triple
from sims.kit.params import Params, choice, number, switch, vector

GRIDS = {"grid_xy": (0, 1), "grid_xz": (0, 2), "grid_yz": (1, 2)}
"""Switch of each plane, and its two axes."""
BOUND = 5.0


class FramesParams(Params):
    """State of the sim. The axes may change while it runs: the point stays where it is, and reads anew."""

    convention: Convention = choice(
        "opengl", title="Convention", description="Where X, Y and Z point, by the custom of a field or program",
        labels=dict(NAMES.items()),
    )  # fmt: skip
    to: Convention = choice(
        "opengl",
        title="Second convention",
        description="Drawn thin and dashed; the matrix leads to it",
        labels=dict(NAMES.items()),
    )
    handedness: Handedness | None = choice(
        None, title="Handedness", description="The other one than the convention's own mirrors Z",
        labels={"right": "Right-handed", "left": "Left-handed"}, absent="As in the convention",
    )  # fmt: skip
    point: Triple = vector(
        (1.0, 0.8, 0.6), -BOUND, BOUND, step=0.05, title="Point x, y, z",
        description="In the axes of the convention; where w isn't 1, the point is these divided by w",
    )  # fmt: skip
    w: float = number(
        1, 0, 2, step=0.01, title="Fourth coordinate", symbol="w",
        description="The point is (x/w, y/w, z/w); with w = 0 it is a direction",
    )  # fmt: skip
    show_rule: bool = switch(
        True, title="Show hand", description="The rule of the right hand, or of the left for left-handed axes"
    )
    rule: float = number(
        1, 0, 1, step=0.01, title="Fingers", description="How far the fingers have swept: 0 along X, 1 along Y"
    )
    grid_xy: bool = switch(False, title="Grid XY", description="The plane of X and Y, where z is zero")
    grid_xz: bool = switch(False, title="Grid XZ", description="The plane of X and Z, where y is zero")
    grid_yz: bool = switch(False, title="Grid YZ", description="The plane of Y and Z, where x is zero")

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
