"""Parameters of the sim."""

from __future__ import annotations

import math
from typing import Annotated

from sims.kit.fields import Slider, Switch, Vector
from sims.kit.params import Params

LOCK = "How far from lock"
"""A fold."""
NEAR = 0.2
"""The smallest singular value below which the sim warns."""
NEAR_PITCH = math.degrees(math.asin(1.0 - NEAR**2))
"""Degrees of pitch at which it has that value."""


class GimbalParams(Params):
    """State of the sim."""

    yaw: Annotated[float, Slider(-180, 180, step=1, unit="°", symbol="ψ", title="Outer yaw")] = 0
    """Turn of the outer ring in the stand, about Z"""
    pitch: Annotated[float, Slider(-180, 180, step=1, unit="°", symbol="θ", title="Middle pitch")] = 0
    """Turn of the middle ring in the outer one, about its Y"""
    roll: Annotated[float, Slider(-180, 180, step=1, unit="°", symbol="φ", title="Inner roll")] = 0
    """Turn of the inner ring in the middle one, about its X; the aircraft is fixed in it"""
    show_reach: Annotated[bool, Switch(title="Show reach", group=LOCK)] = False
    """The angular velocities that the three rings can make together"""
    show_ghost: Annotated[bool, Switch(title="Show ghost", group="Show")] = False
    """A second aircraft at a marked orientation, to compare with"""
    ghost: Annotated[
        tuple[float, float, float], Vector(-180.0, 180.0, step=1, unit="°", title="Ghost", hidden=True)
    ] = (0.0, 0.0, 0.0)
    """Yaw, pitch and roll of the marked orientation"""

    @property
    def angles(self) -> tuple[float, float, float]:
        """Yaw, pitch and roll in degrees."""
        return self.yaw, self.pitch, self.roll

    def regions(self) -> dict[str, list[tuple[float, float]]]:
        """Where the smallest singular value is low, for the slider's track."""
        return {"pitch": [(-180.0 + NEAR_PITCH, -NEAR_PITCH), (NEAR_PITCH, 180.0 - NEAR_PITCH)]}
