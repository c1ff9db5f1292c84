"""The mathematics of a state."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from geometry import frames
from geometry.arrays import Array
from sims.coordinate_frames.conventions import BASES, CONVENTIONS, Axes, Convention, axes, change
from sims.coordinate_frames.params import FramesParams

IN_VIEW = 2.4
"""Metres from the origin within which the first view shows the point."""
ARROW = 1.65
"""Metres of the arrow along which a point has left the view, or in which a direction points."""
DRAWN = 1e4
"""Metres beyond which a point is told, and no longer drawn."""


@dataclass(frozen=True)
class FramesSolution:
    """`cartesian` and `point_world` are None for a direction; `coordinates` are then those of the direction."""

    basis: Array
    handedness: str
    point_world: Array | None
    coordinates: dict[Convention, Array]
    matrix: Array
    determinant: float
    homogeneous: Array
    cartesian: Array | None
    axes: Axes
    axes_to: Axes
    undivided: Array
    """Where (x, y, z, 1) is in the world."""
    direction: Array | None
    """Unit vector in the world along which the point, or the direction, lies; None at the origin."""
    distance: float | None
    """From the origin to the point; None for a direction."""
    tip: Array | None
    """Where the arrow ends that stands for a direction or for a point out of view."""
    corner: Array | None
    """The point as the boxes of its coordinates are drawn: in axes turned by `axes.wxyz`."""


def solve(p: FramesParams) -> FramesSolution:
    """All the mathematics of a state."""
    own = p.axes
    matrix, determinant = change(p.convention, p.handedness, p.to)
    homogeneous = np.array([*p.point, p.w])
    cartesian = _divided(homogeneous)
    world = None if cartesian is None else frames.to_world(cartesian, own.basis)
    undivided = world if world is not None and p.w == 1.0 else frames.to_world(p.point, own.basis)
    distance = None if world is None else math.hypot(*world.tolist())
    direction = _unit(undivided)
    away = direction is not None and (distance is None or distance > IN_VIEW)
    return FramesSolution(
        basis=own.basis,
        handedness=own.handedness,
        point_world=world,
        coordinates=_readings(undivided if world is None else world),
        matrix=matrix,
        determinant=determinant,
        homogeneous=homogeneous,
        cartesian=cartesian,
        axes=own,
        axes_to=axes(p.to),
        undivided=undivided,
        direction=direction,
        distance=distance,
        tip=ARROW * direction if direction is not None and away else None,
        corner=None if cartesian is None or away else cartesian * (1.0, 1.0, own.sign) + 0.0,
    )


def _divided(homogeneous: Array) -> Array | None:
    """The point (x/w, y/w, z/w); None for a direction, and where the quotient is too large."""
    if homogeneous[3] == 0.0:
        return None
    value, finite = frames.point_or_direction(homogeneous)
    return value if finite and math.isfinite(math.hypot(*value.tolist())) else None


def _unit(vector: Array) -> Array | None:
    length = math.hypot(*vector.tolist())
    return vector / length if length else None


def _readings(place: Array) -> dict[Convention, Array]:
    return dict(zip(CONVENTIONS, frames.coordinates(place, BASES), strict=True))
