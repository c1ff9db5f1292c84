"""Parameters of the sim."""

from __future__ import annotations

import math
from typing import Annotated, Self

from pydantic import model_validator

from sims.kit.fields import Choice, Numbers, Slider, Switch, Vector
from sims.kit.params import Params
from sims.kit.refusals import refusal
from sims.quaternion.paths import Name

Triple = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
ONE: Quaternion = (1.0, 0.0, 0.0, 0.0)
LONGEST = 10.0
"""Greatest entry of an axis."""
SHORTEST = 1e-9
"""A shorter axis, or quaternion, names no direction."""
REACH = 2.0
"""Greatest coordinate of p, in metres."""
MOST_TURNS = 8
"""Turns that the list keeps."""
PATH, COMPOSED, SANDWICH, MATRIX = "From start to target", "Composing turns", "Turning a point: q p q*", "Other forms"
"""Titles of folds."""
TIP = 1.7
"""Metres from the origin to the tip of the axis."""
PRESETS: dict[str, Triple] = {
    "x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0),
    "(1, 1, 0)": (1.0, 1.0, 0.0), "(1, 1, 1)": (1.0, 1.0, 1.0),
}  # fmt: skip


class QuaternionParams(Params):
    """State of the sim."""

    axis: Annotated[Triple, Vector(-LONGEST, LONGEST, step=0.01, title="Axis n", presets=PRESETS)] = (0.0, 0.0, 1.0)
    """Any direction; what you give is put at length one. You can also drag the arrow's tip"""
    angle: Annotated[float, Slider(0, 360, step=1, unit="°", symbol="θ", title="Angle")] = 90
    """How far the turn about the axis goes"""
    start: Annotated[Quaternion, Vector(-1.0, 1.0, step=0.01, title="Start", hidden=True)] = ONE
    """Orientation before the turn, as a quaternion w, x, y, z of any length but zero"""
    t: Annotated[float, Slider(0, 1, step=0.01, symbol="t", title="Progress")] = 1
    """Where the object is, from start (0) to target (1)"""
    interpolation: Annotated[
        Name,
        Choice(
            title="Interpolation",
            labels={
                "slerp": "SLERP: constant speed",
                "nlerp": "NLERP: straight, put at length one",
                "euler": "Euler angles, each on its own",
            },
        ),
    ] = "slerp"
    """How the object goes from start to target"""
    long_way: Annotated[bool, Switch(title="Take the long way (−q)", group=PATH)] = False
    """Go to −q instead of q: the same target by the other way round. Not for Euler angles"""
    show_euler: Annotated[bool, Switch(title="Euler angles", group=MATRIX)] = False
    """Show the yaw, pitch and roll that make the same orientation"""
    point: Annotated[Triple, Vector(-REACH, REACH, step=0.01, unit="m", title="Point p", group=SANDWICH)] = (
        1.0,
        0.0,
        0.0,
    )
    """A point that q turns: q p q* gives its image p′. You can also drag it"""
    show_paths: Annotated[bool, Switch(title="Paths of the nose", group="Show")] = True
    """Where the nose goes on the unit sphere, with marks at equal times"""
    show_point: Annotated[bool, Switch(title="Point and image", group="Show")] = True
    """Show p, p′ and the arc between"""
    history: Annotated[
        tuple[float, ...],
        Numbers(-360.0, 360.0, step=0.01, title="Turns made", most=4 * MOST_TURNS, least=0, hidden=True),
    ] = ()
    """The turns that led to the start, the first one first: x, y, z of the axis and the angle of each"""

    @model_validator(mode="after")
    def _turns(self) -> Self:
        for name in ("axis", "start"):
            if math.hypot(*getattr(self, name)) < SHORTEST:
                raise refusal([name], f"the {name} must not be zero: zero has no direction")
        if len(self.history) % 4 or not all(_is_turn(*turn) for turn in self.turns):
            words = "history must be turns of four numbers: x, y, z of an axis that isn't zero, and an angle"
            raise refusal(["history"], words)
        return self

    @property
    def turns(self) -> list[Quaternion]:
        """Axis x, y, z and angle in degrees of each turn made."""
        h = self.history
        return [(h[k], h[k + 1], h[k + 2], h[k + 3]) for k in range(0, len(h) - 3, 4)]


def _is_turn(x: float, y: float, z: float, angle: float) -> bool:
    return math.hypot(x, y, z) >= SHORTEST and max(abs(x), abs(y), abs(z)) <= LONGEST and 0.0 <= angle <= 360.0
