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


CONVENTIONS = tuple(NAMES)
BASES: Array = np.stack([axes(name).basis for name in CONVENTIONS])
