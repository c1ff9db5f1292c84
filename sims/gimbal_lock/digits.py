"""Numbers with as many digits as it takes to see that they aren't yet those of lock."""

from __future__ import annotations

import math

from sims.kit.readout import figure, quantity

MOST = 6
"""Decimals that are shown at most."""
NONE = 1e-9
"""What is smaller is rounding."""


def angle(degrees: float, digits: int = 0) -> str:
    """An angle; near ±90° with more digits, so that only 90° itself is called that."""
    away = abs(abs(math.remainder(degrees, 180.0)) - 90.0)
    return quantity(degrees, "°", max(digits, _decimals(away)))


def small(value: float) -> str:
    """A number from 0 on, with three decimals; a small one with more, so that only 0 itself is called that."""
    return figure(value, max(3, 1 + _decimals(value)))


def _decimals(away: float) -> int:
    """How many decimals a number needs to differ from another that is so far away."""
    return 0 if away >= 0.5 or away < NONE else min(math.ceil(-math.log10(away) - 1e-9), MOST)
