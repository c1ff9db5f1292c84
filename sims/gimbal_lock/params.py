"""Parameters of the sim."""

from __future__ import annotations

import math

from sims.kit.params import Params, number, switch, vector

NEAR = 0.2
"""The smallest singular value below which the sim warns."""
NEAR_PITCH = math.degrees(math.asin(1.0 - NEAR**2))
"""Degrees of pitch at which it has that value."""


class GimbalParams(Params):
    """State of the sim."""

    yaw: float = number(
        0, -180, 180, step=1, unit="°", title="Outer yaw", symbol="ψ",
        description="Turn of the outer ring in the stand, about Z",
    )  # fmt: skip
    pitch: float = number(
        0, -180, 180, step=1, unit="°", title="Middle pitch", symbol="θ",
        description="Turn of the middle ring in the outer one, about its Y",
    )  # fmt: skip
    roll: float = number(
        0, -180, 180, step=1, unit="°", title="Inner roll", symbol="φ",
        description="Turn of the inner ring in the middle one, about its X; the aircraft is fixed in it",
    )  # fmt: skip
    show_reach: bool = switch(
        True, title="Show reach", description="The angular velocities that the three rings can make together"
    )
    show_ghost: bool = switch(
        False, title="Show ghost", description="A second aircraft at a marked orientation, to compare with"
    )
    ghost: tuple[float, float, float] = vector(
        (0.0, 0.0, 0.0), -180.0, 180.0, step=1, unit="°", title="Ghost", control="none",
        description="Yaw, pitch and roll of the marked orientation",
    )  # fmt: skip

    @property
    def angles(self) -> tuple[float, float, float]:
        """Yaw, pitch and roll in degrees."""
        return self.yaw, self.pitch, self.roll

    def regions(self) -> dict[str, list[tuple[float, float]]]:
        """Where the smallest singular value is low, for the slider's track."""
        return {"pitch": [(-180.0 + NEAR_PITCH, -NEAR_PITCH), (NEAR_PITCH, 180.0 - NEAR_PITCH)]}
