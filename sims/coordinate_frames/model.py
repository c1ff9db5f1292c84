"""Parameters of the sim, and the mathematics of a state."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal, Self

import numpy as np

from geometry import frames, quaternion
from geometry.arrays import Array
from sims.kit.params import Params, choice, number, switch, vector
from sims.kit.sim import Step
from sims.kit.stage import Quaternion

Convention = Literal["opengl", "directx", "ros", "camera", "aviation", "enu", "unreal"]
Handedness = Literal["right", "left"]
Triple = tuple[float, float, float]
NAMES: dict[Convention, str] = {
    "opengl": "OpenGL",
    "directx": "DirectX, Unity",
    "ros": "ROS",
    "camera": "Camera",
    "aviation": "Aviation",
    "enu": "ENU, Blender",
    "unreal": "Unreal",
}
GRIDS = {"grid_xy": (0, 1), "grid_xz": (0, 2), "grid_yz": (1, 2)}
"""Switch of each plane, and its two axes."""
BOUND = 5.0
IN_VIEW = 2.4
"""Metres from the origin within which the first view shows the point."""
ARROW = 1.65
"""Metres of the arrow along which a point has left the view, or in which a direction points."""
DRAWN = 1e4
"""Metres beyond which a point is told, and no longer drawn."""


def triple(vector: Array) -> Triple:
    x, y, z = vector.tolist()
    return x, y, z


class FramesParams(Params):
    """State of the sim. The axes may change while it runs: the point stays where it is, and reads anew."""

    convention: Convention = choice(
        "opengl", title="Convention", description="Where X, Y and Z point, by the custom of a field or program",
        labels=dict(NAMES.items()),
    )  # fmt: skip
    to: Convention = choice(
        "opengl",
        title="Second convention",
        description="Drawn thin and dashed; the matrix leads to it",
        labels=dict(NAMES.items()),
    )
    handedness: Handedness | None = choice(
        None, title="Handedness", description="The other one than the convention's own mirrors Z",
        labels={"right": "Right-handed", "left": "Left-handed"}, absent="As in the convention",
    )  # fmt: skip
    point: Triple = vector(
        (1.0, 0.8, 0.6), -BOUND, BOUND, step=0.05, title="Point x, y, z",
        description="In the axes of the convention; where w isn't 1, the point is these divided by w",
    )  # fmt: skip
    w: float = number(
        1, 0, 2, step=0.01, title="Fourth coordinate", symbol="w",
        description="The point is (x/w, y/w, z/w); with w = 0 it is a direction",
    )  # fmt: skip
    show_rule: bool = switch(
        True, title="Show hand", description="The rule of the right hand, or of the left for left-handed axes"
    )
    rule: float = number(
        1, 0, 1, step=0.01, title="Fingers", description="How far the fingers have swept: 0 along X, 1 along Y"
    )
    grid_xy: bool = switch(False, title="Grid XY", description="The plane of X and Y, where z is zero")
    grid_xz: bool = switch(False, title="Grid XZ", description="The plane of X and Z, where y is zero")
    grid_yz: bool = switch(False, title="Grid YZ", description="The plane of Y and Z, where x is zero")

    @property
    def axes(self) -> Axes:
        return axes(self.convention, self.handedness)

    def changed(self, changes: Mapping[str, Any]) -> Self:
        return self._same_place(super().changed(changes), changes)

    def moved(self, changes: Mapping[str, Any]) -> Self:
        return self._same_place(super().moved(changes), changes)

    def _same_place(self, state: Self, changes: Mapping[str, Any]) -> Self:
        """The state with its point where it was in the world, unless the changes name a point."""
        if "point" in changes or state.axes is self.axes:
            return state
        place = frames.to_world(self.point, self.axes.basis)
        return state.model_copy(update={"point": triple(frames.coordinates(place, state.axes.basis))})


@dataclass(frozen=True)
class Axes:
    """A convention's axes in the world, and how they are drawn."""

    basis: Array
    handedness: str
    directions: tuple[str, str, str]
    """Where x, y and z point, in words."""
    wxyz: Quaternion
    """Turns X and Y of the world to theirs."""
    sign: float
    """1 where Z of the world then lies along theirs, −1 against it: left-handed axes are no turn of the world's."""
    hand: Triple
    """Where the knuckles of the hand are, in axes turned by `wxyz`: its fingers go round Z, where there is room."""


@lru_cache(maxsize=21)
def axes(convention: Convention, handed: Handedness | None = None) -> Axes:
    """The axes of a convention, in its own handedness or another; always the same object."""
    return _axes(convention, handed or frames.handedness(frames.basis(convention)))


@lru_cache(maxsize=14)
def _axes(convention: Convention, handed: str) -> Axes:
    basis = frames.basis(convention, handed)
    sign = 1.0 if handed == "right" else -1.0
    w, x, y, z = (quaternion.from_matrix(basis * (1.0, 1.0, sign)) + 0.0).tolist()
    directions = frames.axis_directions(convention, handed)
    height = -0.78 if directions[2] == "down" else 0.86  # a Z down through the car: the thumb comes from above
    return Axes(basis, handed, directions, (w, x, y, z), sign, (0.08, -0.13, sign * height))


@lru_cache(maxsize=128)
def change(convention: Convention, handed: Handedness | None, to: Convention) -> tuple[Array, float]:
    """The matrix (4, 4) to a convention's coordinates from another's, and its determinant."""
    matrix = frames.change_of_basis(axes(convention, handed).basis, axes(to).basis)
    return matrix, float(np.linalg.det(matrix))


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


CONVENTIONS = tuple(NAMES)
BASES: Array = np.stack([axes(name).basis for name in CONVENTIONS])


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


# ---- what hands and buttons do


def hold_point(p: FramesParams, place: tuple[float, ...]) -> dict[str, Any]:
    """(x, y, z) of a point in the world, to the millimetre, times w; a direction keeps the length of its numbers."""
    reading = np.round(frames.coordinates(place, p.axes.basis), 3) + 0.0
    if p.w > 0.0:
        return {"point": triple(reading * p.w)}
    length, pulled = math.hypot(*p.point) or 1.0, math.hypot(*reading.tolist())
    return {"point": triple(np.round(reading * (length / pulled), 3) + 0.0) if pulled else p.point}


def sweep(p: FramesParams) -> Iterator[Step]:
    """Fingers along X, then over to Y."""
    yield Step({"show_rule": True, "rule": 0.0}, 0.0)
    yield Step({"rule": 0.0}, 0.5)
    yield Step({"rule": 1.0}, 1.2)


def run_away(p: FramesParams) -> Iterator[Step]:
    """From w = 1 to a direction."""
    yield Step({"w": 1.0}, 0.0)
    yield Step({"w": 1.0}, 0.4)
    yield Step({"w": 0.0}, 1.2)
