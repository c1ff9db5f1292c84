"""The mathematics of a state."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from geometry import frames
from geometry.arrays import Array
from sims.coordinate_frames.conventions import BASES, CONVENTIONS, Axes, Convention, Drawn, second
from sims.coordinate_frames.params import FramesParams

IN_VIEW = 2.4
"""Metres from the origin within which the first view shows the point."""
ARROW = 1.65
"""Metres of the arrow along which a point has left the view."""
SHORTEST = 0.3
"""Metres of an arrow that is still seen."""
DRAWN = 1e4
"""Metres beyond which a point is told, and no longer drawn."""


@dataclass(frozen=True)
class FramesSolution:
    """`cartesian` and `point_world` are None for a direction; `coordinates` are then those of the direction.

    `coordinates` are all from the first origin; those with `_to` are of the second frame, from its own.
    """

    basis: Array
    handedness: str
    point_world: Array | None
    coordinates: dict[Convention, Array]
    matrix: Array
    determinant: float
    homogeneous: Array
    cartesian: Array | None
    homogeneous_to: Array
    """`matrix` times `homogeneous`."""
    cartesian_to: Array | None
    direction_to: Array
    """`matrix` times (x, y, z, 0)."""
    origin_world: Array
    """Where the second frame begins."""
    axes: Axes
    axes_to: Axes
    drawn: Drawn
    drawn_to: Drawn
    undivided: Array
    """Where (x, y, z, 1) is in the world."""
    direction: Array | None
    """Unit vector in the world along which the point, or the direction, lies; None at the origin."""
    distance: float | None
    """From the origin to the point; None for a direction."""
    arrow: Array | None
    """What stands for the direction (x, y, z, 0) in the world: as long as it is, where that can be seen."""
    arrows: Array
    """(n, 2, 3): it from each origin, but for the first one's where the arrow to `tip` stands there."""
    tip: Array | None
    """Where the arrow ends that stands for a direction or for a point out of view."""
    corner: Array | None
    """The point as the boxes of its coordinates are drawn: in axes turned by `drawn.wxyz`; None while these turn."""

    @property
    def apart(self) -> bool:
        """The second frame begins elsewhere."""
        return bool(self.origin_world.any())


def solve(p: FramesParams) -> FramesSolution:
    """All the mathematics of a state."""
    own, other = p.axes, second(p.convention, p.handedness, p.to, p.origin)
    homogeneous, free = np.array([*p.point, p.w]), np.array([*p.point, 0.0])
    cartesian = _divided(homogeneous)
    world = None if cartesian is None else own.basis @ cartesian + 0.0
    undivided = world if world is not None and p.w == 1.0 else own.basis @ homogeneous[:3] + 0.0
    distance = None if world is None else math.hypot(*world.tolist())
    direction, arrow = _direction(undivided)
    away = direction is not None and distance is not None and distance > IN_VIEW
    tip = arrow if cartesian is None else ARROW * direction if direction is not None and away else None
    T, drawn = other.matrix, p.drawn
    return FramesSolution(
        basis=own.basis,
        handedness=own.handedness,
        point_world=world,
        coordinates=_readings(undivided if world is None else world),
        matrix=T,
        determinant=other.determinant,
        homogeneous=homogeneous,
        cartesian=cartesian,
        homogeneous_to=T @ homogeneous + 0.0,
        cartesian_to=None if cartesian is None else T[:3, :3] @ cartesian + T[:3, 3] + 0.0,
        direction_to=T @ free + 0.0,
        origin_world=other.origin,
        axes=own,
        axes_to=p.axes_to,
        drawn=drawn,
        drawn_to=p.drawn_to,
        undivided=undivided,
        direction=direction,
        distance=distance,
        arrow=arrow,
        arrows=_arrows(arrow, tip, other.origin),
        tip=tip,
        corner=None if cartesian is None or away or p.turn else cartesian * (1.0, 1.0, drawn.side) + 0.0,
    )


def _divided(homogeneous: Array) -> Array | None:
    """The point (x/w, y/w, z/w); None for a direction, and where the quotient is too large."""
    if homogeneous[3] == 0.0:
        return None
    value, finite = frames.point_or_direction(homogeneous)
    return value if finite and math.isfinite(math.hypot(*value.tolist())) else None


def _direction(vector: Array) -> tuple[Array | None, Array | None]:
    """Its unit vector, and the arrow that stands for it; None where it has no direction."""
    length = math.hypot(*vector.tolist())
    if not length:
        return None, None
    unit = vector / length
    if SHORTEST <= length <= IN_VIEW:
        return unit, vector
    return unit, (ARROW if length > IN_VIEW else SHORTEST) * unit


def _arrows(arrow: Array | None, tip: Array | None, origin: Array) -> Array:
    """Tail and tip of the same arrow from each origin that has to show it."""
    starts = ([np.zeros(3)] if tip is None else []) + ([origin] if origin.any() else [])
    return np.array([[start, start + arrow] for start in starts if arrow is not None]).reshape(-1, 2, 3)


def _readings(place: Array) -> dict[Convention, Array]:
    return dict(zip(CONVENTIONS, np.vecmat(place, BASES) + 0.0, strict=True))
