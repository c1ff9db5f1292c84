"""Parameters of the sim."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

from pydantic import model_validator

from sims.kit.fields import Choice, Numbers, Opened, Slider, Switch, Vector
from sims.kit.params import Params
from sims.kit.refusals import refusal
from sims.quaternion.paths import Name

Triple = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
Topic = Literal["turn", "ball", "point", "order", "path"]
ONE: Quaternion = (1.0, 0.0, 0.0, 0.0)
NOSE: Triple = (1.0, 0.0, 0.0)
LONGEST = 10.0
"""Greatest entry of an axis."""
SHORTEST = 1e-9
"""A shorter axis, or quaternion, names no direction."""
WHOLE, TWICE = 360.0, 720.0
"""Degrees of a whole turn, after which q is −q, and of two, after which it is q again."""
REACH = 2.0
"""Greatest coordinate of p, in metres."""
MOST_TURNS = 8
"""Turns that the list keeps."""
BALL, SANDWICH, ORDER = "The ball of all turns: q and −q", "Turning a point: q p q*", "Two turns: A·B and B·A"
PATH, COMPOSED, MATRIX = "From start to target: SLERP, NLERP, Euler", "Turns made so far", "Other forms"
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
    angle: Annotated[float, Slider(0, TWICE, step=1, unit="°", symbol="θ", title="Angle")] = 90
    """How far the turn about the axis goes; up to two whole turns, for after one q has become −q"""
    start: Annotated[Quaternion, Vector(-1.0, 1.0, step=0.01, title="Start", hidden=True)] = ONE
    """Orientation before the turn, as a quaternion w, x, y, z of any length but zero"""
    show: Annotated[
        Topic | None,
        Opened(
            title="Look at",
            labels={
                "turn": "A turn, and half of its angle",
                "ball": "The ball of all turns",
                "point": "How q turns a point",
                "order": "Two turns in both orders",
                "path": "Ways from start to target",
            },
            absent="What the rest is about",
            folds={"ball": BALL, "point": SANDWICH, "order": ORDER, "path": PATH},
            closed="turn",
        ),
    ] = None
    """What comes to the object, its axis, the angle and q"""
    t: Annotated[float, Slider(0, 1, step=0.01, symbol="t", title="Progress", group=PATH)] = 1
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
            group=PATH,
        ),
    ] = "slerp"
    """How the object goes from start to target: of the three ways, the one that is thick"""
    long_way: Annotated[bool, Switch(title="Take the long way (−q)", group=PATH)] = False
    """Go to −q instead of q: the same target by the other way round. Not for Euler angles"""
    axis_b: Annotated[Triple, Vector(-LONGEST, LONGEST, step=0.01, title="Axis of B", presets=PRESETS, group=ORDER)] = (
        1.0,
        0.0,
        0.0,
    )
    """The other turn's axis, of any length but zero; A is the turn by the angle about the axis above"""
    angle_b: Annotated[float, Slider(0, 360, step=1, unit="°", title="Angle of B", group=ORDER)] = 90
    """How far the other turn goes"""
    show_euler: Annotated[bool, Switch(title="Euler angles", group=MATRIX)] = False
    """Show the yaw, pitch and roll that make the same orientation"""
    point: Annotated[Triple, Vector(-REACH, REACH, step=0.01, unit="m", title="Point p", group=SANDWICH)] = NOSE
    """A point that q turns: q p q* gives its image p′. You can also drag it"""
    show_paths: Annotated[bool, Switch(title="Paths of the nose", group=PATH)] = True
    """Where each nose goes on its sphere, with marks at equal times"""
    show_point: Annotated[bool, Switch(title="Point and image", group=SANDWICH)] = True
    """Show p, p′ and the arc between"""
    history: Annotated[
        tuple[float, ...],
        Numbers(-TWICE, TWICE, step=0.01, title="Turns made", most=4 * MOST_TURNS, least=0, hidden=True),
    ] = ()
    """The turns that led to the start, the first one first: x, y, z of the axis and the angle of each"""

    @property
    def topic(self) -> Topic:
        """What is shown: what is asked for, or else what the other parameters of a link are about."""
        if self.show is not None:
            return self.show
        if self.interpolation != "slerp" or self.long_way:
            return "path"
        return "turn" if self.point == NOSE else "point"

    @model_validator(mode="after")
    def _turns(self) -> Self:
        for name, words in (("axis", "axis"), ("axis_b", "axis of B"), ("start", "start")):
            if math.hypot(*getattr(self, name)) < SHORTEST:
                raise refusal([name], f"the {words} must not be zero: zero has no direction")
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
    return math.hypot(x, y, z) >= SHORTEST and max(abs(x), abs(y), abs(z)) <= LONGEST and 0.0 <= angle <= TWICE
