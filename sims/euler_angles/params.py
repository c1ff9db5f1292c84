"""Parameters of the sim."""

from __future__ import annotations

from typing import Annotated, Literal

from geometry import euler
from sims.euler_angles import names
from sims.euler_angles.names import TurnName
from sims.kit.fields import Choice, Slider, Switch, Vector
from sims.kit.params import Params

Order = Literal["zyx", "xyz", "zxz", "xzy", "yxz", "yzx", "zxy", "xyx", "xzx", "yxy", "yzy", "zyz"]
TARGET = (120.0, -40.0, 60.0)
"""Yaw, pitch and roll of an orientation to reach that one doesn’t hit by chance."""
NEAR_LOCK = 15.0
"""Degrees from lock within which the sim warns."""


class EulerParams(Params):
    """State of the sim."""

    order: Annotated[Order, Choice(title="Order", labels={o: o.upper() for o in euler.ORDERS})] = "zyx"
    """Axes of the three turns, in the order in which they are made"""
    frame: Annotated[
        Literal["intrinsic", "extrinsic"],
        Choice(title="Frame", labels={"intrinsic": "Intrinsic: own axes", "extrinsic": "Extrinsic: fixed axes"}),
    ] = "intrinsic"
    """Turns about the aircraft's own axes, or about the world's"""
    yaw: Annotated[float, Slider(-180, 180, step=1, unit="°", symbol="ψ", title="Yaw")] = 30
    """Angle about Z; first angle of a proper Euler order"""
    pitch: Annotated[float, Slider(-90, 180, step=1, unit="°", symbol="θ", title="Pitch")] = 20
    """Angle about Y; second angle of a proper Euler order"""
    roll: Annotated[float, Slider(-180, 180, step=1, unit="°", symbol="φ", title="Roll")] = 10
    """Angle about X; third angle of a proper Euler order"""
    progress: Annotated[float, Slider(0, 3, step=0.01, title="Progress")] = 3
    """How much of the sequence is applied: 1 is the first turn, 3 all of it"""
    show_target: Annotated[bool, Switch(title="Show target", group="Show")] = False
    """A second aircraft, in an orientation that is to be reached"""
    target: Annotated[
        tuple[float, float, float], Vector(-180.0, 180.0, step=1, unit="°", title="Target", hidden=True)
    ] = TARGET
    """Yaw, pitch and roll of the target, as ZYX about own axes"""

    @property
    def proper(self) -> bool:
        return self.order[0] == self.order[2]

    @property
    def turns(self) -> tuple[TurnName, ...]:
        """What the three turns are called, in the order in which they are made."""
        return names.turns(self.order, self.frame)

    @property
    def names(self) -> tuple[str, str, str]:
        """Parameter names of the three turns, in the order of the turns."""
        first, second, third = self.turns
        return first.parameter, second.parameter, third.parameter

    @property
    def angles(self) -> tuple[float, float, float]:
        """First, second and third angle in degrees."""
        a, b, c = (getattr(self, name) for name in self.names)
        return a, b, c

    @property
    def arranged(self) -> tuple[str, ...]:
        return "order", "frame", *self.names, "progress", "show_target"

    def bounds(self, name: str) -> tuple[float, float]:
        if name == "pitch":
            return (0.0, 180.0) if self.proper else (-90.0, 90.0)
        return super().bounds(name)

    def label(self, name: str) -> str:
        turn = self._turn(name)
        return super().label(name) if turn is None else turn.label

    def about(self, name: str) -> str:
        turn = self._turn(name)
        return super().about(name) if turn is None else turn.about

    def _turn(self, name: str) -> TurnName | None:
        return next((turn for turn in self.turns if turn.parameter == name), None)

    def regions(self) -> dict[str, list[tuple[float, float]]]:
        """Where the middle angle is near lock, for the slider's track."""
        name = self.names[1]
        low, high = self.bounds(name)
        return {name: [(max(low, v - NEAR_LOCK), min(high, v + NEAR_LOCK)) for v in self.locks]}

    @property
    def locks(self) -> tuple[float, float]:
        """Values of the middle angle, in degrees, at which the order locks."""
        return (0.0, 180.0) if self.proper else (-90.0, 90.0)
