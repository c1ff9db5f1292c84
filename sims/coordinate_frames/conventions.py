"""The conventions: how their axes lie in the world, and how one's coordinates become another's."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np

from geometry import frames, quaternion
from geometry.arrays import Array
from sims.kit.types import Quaternion

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


def triple(vector: Array) -> Triple:
    x, y, z = vector.tolist()
    return x, y, z


@dataclass(frozen=True)
class Drawn:
    """How axes are drawn: as they are, or while they turn from others."""

    wxyz: Quaternion
    """Turns X and Y of the world to theirs."""
    side: float
    """1 where Z of the world so turned lies along theirs, −1 against it, less while it shrinks and grows again.

    Left-handed axes are no turn of the world's.
    """


@dataclass(frozen=True)
class Axes:
    """A convention's axes in the world."""

    basis: Array
    handedness: str
    directions: tuple[str, str, str]
    """Where x, y and z point, in words."""
    drawn: Drawn


@dataclass(frozen=True)
class Second:
    """What leads to the second frame."""

    matrix: Array
    """(4, 4): to its coordinates from those of the first."""
    determinant: float
    origin: Array
    """Where it begins, in the world."""


@lru_cache(maxsize=21)
def axes(convention: Convention, handed: Handedness | None = None) -> Axes:
    """The axes of a convention, in its own handedness or another; always the same object."""
    return _axes(convention, handed or own_hand(convention))


@lru_cache(maxsize=7)
def own_hand(convention: Convention) -> str:
    """The handedness that a convention has by custom."""
    return frames.handedness(frames.basis(convention))


@lru_cache(maxsize=14)
def _axes(convention: Convention, handed: str) -> Axes:
    basis = frames.basis(convention, handed)
    side = 1.0 if handed == "right" else -1.0
    w, x, y, z = (quaternion.from_matrix(basis * (1.0, 1.0, side)) + 0.0).tolist()
    return Axes(basis, handed, frames.axis_directions(convention, handed), Drawn((w, x, y, z), side))


@lru_cache(maxsize=128)
def second(convention: Convention, handed: Handedness | None, to: Convention, origin: Triple) -> Second:
    """The frame of another convention's own axes, with its origin given in the first one's coordinates."""
    basis = axes(convention, handed).basis
    matrix = frames.change_of_basis(basis, axes(to).basis, origin)
    return Second(matrix, float(np.linalg.det(matrix)), frames.to_world(origin, basis))


CONVENTIONS = tuple(NAMES)
BASES: Array = np.stack([axes(name).basis for name in CONVENTIONS])
