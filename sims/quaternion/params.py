"""Parameters of the sim."""

from __future__ import annotations

import math
from typing import Self

from pydantic import model_validator

from sims.kit.params import Params, choice, number, numbers, refusal, spell, switch, vector
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
TIP = 1.7
"""Metres from the origin to the tip of the axis."""
PRESETS: dict[str, Triple] = {
    "x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0),
    "(1, 1, 0)": (1.0, 1.0, 0.0), "(1, 1, 1)": (1.0, 1.0, 1.0),
}  # fmt: skip


class QuaternionParams(Params):
    """State of the sim."""

    axis: Triple = vector(
        (0.0, 0.0, 1.0), -LONGEST, LONGEST, step=0.01, title="Axis n", presets=PRESETS,
        description="Any direction; what you give is put at length one. You can also drag the arrow's tip",
    )  # fmt: skip
    angle: float = number(
        90, 0, 360, step=1, unit="°", title="Angle", symbol="θ", description="Of the turn about the axis"
    )
    start: Quaternion = vector(
        ONE, -1.0, 1.0, step=0.01, title="Start", control="none",
        description="Orientation before the turn, as a quaternion w, x, y, z of any length but zero",
    )  # fmt: skip
    t: float = number(
        1,
        0,
        1,
        step=0.01,
        title="Progress",
        symbol="t",
        description="Where the object is, from start (0) to target (1)",
    )
    interpolation: Name = choice(
        "slerp", title="Interpolation", description="How the object goes from start to target",
        labels={"slerp": "SLERP: constant speed", "nlerp": "NLERP: straight, put at length one",
                "euler": "Euler angles, each on its own"},
    )  # fmt: skip
    long_way: bool = switch(
        False, title="Take the long way (−q)",
        description="Go to −q instead of q: the same target by the other way round. Not for Euler angles",
    )  # fmt: skip
    show_euler: bool = switch(
        False, title="Euler angles", description="Show the yaw, pitch and roll that make the same orientation"
    )
    point: Triple = vector(
        (1.0, 0.0, 0.0), -REACH, REACH, step=0.01, unit="m", title="Point p",
        description="A point that q turns: q p q* gives its image p′. You can also drag it",
    )  # fmt: skip
    show_paths: bool = switch(
        True, title="Paths of the nose", group="Show",
        description="Where the nose goes on the unit sphere, with marks at equal times",
    )  # fmt: skip
    show_point: bool = switch(True, title="Point and image", group="Show", description="Show p, p′ and the arc between")
    history: tuple[float, ...] = numbers(
        (), -360.0, 360.0, least=0,
        most=4 * MOST_TURNS, step=0.01, title="Turns made", control="none",
        description="The turns that led to the start, the first one first: x, y, z of the axis and the angle of each",
    )  # fmt: skip

    @model_validator(mode="after")
    def _turns(self) -> Self:
        for name in ("axis", "start"):
            if math.hypot(*getattr(self, name)) < SHORTEST:
                words = f"{name} must not be zero: zero has no direction, got {spell(getattr(self, name))}"
                raise refusal([name], words)
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
