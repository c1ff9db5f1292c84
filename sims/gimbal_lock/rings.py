"""The three rings: sizes, dashes, and where each is held."""

from __future__ import annotations

import math
from typing import NamedTuple

from sims.kit.types import Place

HALF = math.sqrt(0.5)


class Ring(NamedTuple):
    """A ring of the mechanism: radius of its middle line; metres of its dashes and gaps, none for an unbroken stripe.

    It turns about the axis `letter` of the ring outside it, by the parameter `angle`. `held` is the direction from the
    middle to its grip, in its own frame: half way between the pivots.
    """

    name: str
    letter: str
    angle: str
    radius: float
    dash: tuple[float, float] | None
    held: Place

    @property
    def grip(self) -> str:
        """The grip's name in the scene."""
        return f"/grip_{self.name}"


OUTER = Ring("outer", "z", "yaw", 1.22, (0.055, 0.055), (0.0, -HALF, HALF))
MIDDLE = Ring("middle", "y", "pitch", 1.02, (0.19, 0.07), (HALF, -HALF, 0.0))
INNER = Ring("inner", "x", "roll", 0.82, None, (HALF, 0.0, HALF))
RINGS = (OUTER, MIDDLE, INNER)
