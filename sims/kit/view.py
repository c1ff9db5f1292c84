"""From where a sim is looked at by itself, and from where instead when a state needs more room."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
import numpy.typing as npt

from geometry.arrays import Array

SPARE = 1.25
"""How much farther than the radius of a view is still in sight: a scene is wider than it is high, or higher."""
STEP = 1.25
"""How much wider each step makes a view: seldom, and by enough to be seen as one."""
RUN_AWAY = 6.0
"""Radii of the view beyond which nobody steps back for a place."""
SIDES: Array = np.array(sorted(product((0.0, 1.0, -1.0), repeat=3), key=np.linalg.norm))
SIDES[1:] /= np.linalg.norm(SIDES[1:], axis=1, keepdims=True)
"""To where a wider view may move its middle: nowhere, or in one of 26 directions."""


@dataclass(frozen=True)
class View:
    """First viewpoint and look-at point in the world, and the radius round it that must fit, in metres.

    With radius 0 it is from just there, at every size of the page; the scene then moves the viewpoint itself, by
    `Stage.look_through`.
    """

    position: tuple[float, float, float]
    look_at: tuple[float, float, float]
    radius: float

    def holding(self, places: Iterable[npt.ArrayLike]) -> View:
        """The same, or by so many steps wider that these places are in sight too; not those that run away.

        A wider view holds all of this one: its middle goes to the side where more is to be seen, never so far that
        something of this one is lost. By steps too, or the view would follow whatever moves.
        """
        away = np.array([np.asarray(place, dtype=float) for place in places]).reshape(-1, 3) - self.look_at
        away = away[(np.abs(away) < RUN_AWAY * self.radius).all(axis=1)]  # before lengths: squares may be too large
        away = away[np.linalg.norm(away, axis=1) < RUN_AWAY * self.radius]
        wide, middles = self.radius, SIDES[:1]
        while not (holds := _all_within(SPARE * wide, away, middles)).any():
            wide *= STEP
            middles = (wide - self.radius) * SIDES
        return self if wide == self.radius else self._moved(middles[holds.argmax()], wide)

    def _moved(self, by: Array, radius: float) -> View:
        """From the same side, with another middle and radius."""
        (x, y, z), (u, v, w), (a, b, c) = self.position, self.look_at, by.tolist()
        return replace(self, position=(x + a, y + b, z + c), look_at=(u + a, v + b, w + c), radius=radius)


def _all_within(radius: float, places: Array, middles: Array) -> npt.NDArray[np.bool_]:
    """For each middle, whether all places are within a radius round it."""
    apart = np.linalg.norm(places - middles[:, None], axis=2)
    return np.asarray((apart <= radius).all(axis=1))
