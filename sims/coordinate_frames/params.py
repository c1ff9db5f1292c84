"""Parameters of the sim."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal, Self

from geometry import frames
from sims.coordinate_frames.conventions import (
    NAMES,
    Axes,
    Convention,
    Drawn,
    Handedness,
    Triple,
    axes,
    own_hand,
    triple,
)
from sims.kit.fields import Choice, Slider, Switch, Vector
from sims.kit.params import Params

GRIDS = {"grid_xy": (0, 1), "grid_xz": (0, 2), "grid_yz": (1, 2)}
"""Switch of each plane, and its two axes."""
HANDS: Mapping[Handedness, str] = {"right": "Right-handed", "left": "Left-handed"}
PASSING = ("turn", "turn_to", "lit")
"""What a motion alone sets: any other change ends it."""
BOUND = 5.0
SHOW = "Show"
Turn = tuple[float, float, float, float, float]


class FramesParams(Params):
    """State of the sim. The axes may change while it runs: the point stays where it is, and reads anew."""

    opening: ClassVar[Mapping[str, Any]] = {
        "convention": "ros", "to": "camera", "point": (0.4, 0.7, 0.8), "origin": (0.2, -1.2, 0.0), "show_rule": False,
    }  # fmt: skip
    convention: Annotated[Convention, Choice(title="Convention", labels=dict(NAMES.items()))] = "opengl"
    """Where X, Y and Z point, by the custom of a field or program"""
    handedness: Annotated[
        Handedness | None, Choice(title="Handedness", labels=dict(HANDS.items()), absent="As in the convention")
    ] = None
    """The other one than the convention's own mirrors Z"""
    to: Annotated[Convention, Choice(title="Second convention", labels=dict(NAMES.items()))] = "opengl"
    """Axes of the second frame, drawn thin and dashed, X′, Y′ and Z′"""
    origin: Annotated[Triple, Vector(-BOUND, BOUND, step=0.05, title="Second origin")] = (0.0, 0.0, 0.0)
    """Where the second frame begins, in the first one’s coordinates; in the scene, pull its ring"""
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
    turn: Annotated[Turn | None, Vector(-1, 1, step=0.01, title="First axes while they turn", hidden=True)] = None
    """How they are drawn: a quaternion w, x, y, z of any length, and the side of Z, 1 to −1"""
    turn_to: Annotated[Turn | None, Vector(-1, 1, step=0.01, title="Second axes while they turn", hidden=True)] = None
    """The same of the second frame"""
    lit: Annotated[
        Literal["x", "y", "z"] | None,
        Choice(title="Lit axis", labels={"x": "X", "y": "Y", "z": "Z"}, absent="None", hidden=True),
    ] = None
    """The axis that the rule of the hand is at"""

    @property
    def axes(self) -> Axes:
        return axes(self.convention, self.handedness)

    @property
    def axes_to(self) -> Axes:
        return axes(self.to)

    @property
    def drawn(self) -> Drawn:
        return _drawn(self.turn, self.axes)

    @property
    def drawn_to(self) -> Drawn:
        return _drawn(self.turn_to, self.axes_to)

    def options(self, name: str) -> Mapping[Any, str]:
        if name != "handedness":
            return super().options(name)
        own = own_hand(self.convention)
        return {None if hand == own != self.handedness else hand: words for hand, words in HANDS.items()}

    def changed(self, changes: Mapping[str, Any]) -> Self:
        return self._same_places(super().changed(changes), changes)

    def moved(self, changes: Mapping[str, Any]) -> Self:
        """Who chooses a convention gets it as it is by custom."""
        if "convention" in changes:
            changes = {"handedness": None, **changes}
        return self._same_places(super().moved(changes), changes)

    def _same_places(self, state: Self, changes: Mapping[str, Any]) -> Self:
        """The state at rest, with what has a place where it was in the world: all that the changes don't name."""
        update: dict[str, Any] = {
            name: None for name in PASSING if name not in changes and getattr(state, name) is not None
        }
        if state.axes is not self.axes:
            for name in {"point", "origin"} - changes.keys():
                place = frames.to_world(getattr(self, name), self.axes.basis)
                update[name] = triple(frames.coordinates(place, state.axes.basis))
        return state.model_copy(update=update) if update else state


def _drawn(turn: Turn | None, rest: Axes) -> Drawn:
    """Axes on their way, or as they are."""
    length = 0.0 if turn is None else math.hypot(*turn[:4])
    if turn is None or not length:
        return rest.drawn
    w, x, y, z, side = turn
    return Drawn((w / length, x / length, y / length, z / length), side)
