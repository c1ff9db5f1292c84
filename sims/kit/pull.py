"""A body that turns about the world's origin is pulled at one of its spots."""

from __future__ import annotations

import numpy as np

from geometry.arrays import Array
from geometry.rotations import shortest_turn

LEAST = 1e-6
"""Metres from the origin within which a place says no direction."""


def pulled(R: Array, held: tuple[float, ...]) -> Array | None:
    """The orientation (3, 3) of a body with orientation R (3, 3) after the shortest turn that the pull asks for.

    `held` is where the spot is in the body's frame, then where in the world it is pulled to. None where that is no
    direction.
    """
    spot, place = np.reshape(held, (2, 3))
    if min(spot @ spot, place @ place) < LEAST**2:
        return None
    return shortest_turn(R @ spot, place) @ R
