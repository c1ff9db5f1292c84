"""The mathematics of a state."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from geometry import quaternion, se3
from geometry.arrays import Array
from geometry.kinematics import Chain, Posture, dexterity
from geometry.rotations import rotation_angle
from sims.kit.types import Quaternion
from sims.transform_chain.params import ChainParams, Place

USUAL = 2.3
"""Length in metres of the arm that the sim begins with: longer ones are drawn stouter, shorter ones slimmer."""
ENOUGH = 0.02
"""Metres within which a target counts as reached."""
NEARLY = 0.05
"""Part of the largest singular value below which the smallest is nearly none."""
_TURNS = {"x": (1, 2, 0), "y": (2, 0, 1), "z": (0, 1, 2)}
"""Columns of a frame that has its third axis along x, y or z."""


@dataclass(frozen=True)
class Joint:
    """One transform as it is drawn: the frame after a joint and its link, in the frame before."""

    axis: str
    length: float
    wxyz: Quaternion
    position: Place


@dataclass(frozen=True)
class Circle:
    """What the end effector describes as one joint turns: in the xy plane of a frame in the world."""

    wxyz: Quaternion
    centre: Place
    radius: float


@dataclass(frozen=True)
class Swapped:
    """The arm from the two exchanged transforms on: the frame that it begins in, and how its end effector differs."""

    wxyz: Quaternion
    origin: Place
    joints: tuple[Joint, ...]
    end: Place
    end_wxyz: Quaternion
    distance: float
    angle: float


@dataclass(frozen=True)
class ChainSolution:
    """What doesn't exist is None. The Jacobian's first three rows are for velocity, the others for turning."""

    individual: Array
    composed: Array
    end_effector: Array
    inverse: Array
    positions: Array
    swapped_end_effector: Array | None
    jacobian: Array
    singular_values: Array
    manipulability: float
    mobility: int
    singular: bool
    near_singular: bool
    lost: Array | None
    """Unit vector along which the end effector can't move in a singular pose, where there is one such direction."""
    reach: tuple[float, float]
    """Bounds of the distance from the base, in metres."""
    through: Array
    """The point in homogeneous coordinates, (n + 1, 4): in the end effector's frame, …, in the world."""
    kept: tuple[tuple[float, float], tuple[float, float] | None]
    """Distance of the point from the end effector, and its angle to that one's x axis: in its frame, in the world."""
    target_distance: float | None
    pull_distance: float | None
    pull_outside: bool
    """The hand pulls to where no posture gets."""
    plane: str | None
    """Axis that all joints turn about."""
    joints: tuple[Joint, ...]
    wxyz: Quaternion
    """Orientation of the end effector."""
    end: Place
    arrows: Array
    """Tails and tips (m, 2, 3) of the transforms as `show` says; those that lead nowhere are left out."""
    circle: Circle | None
    swapped: Swapped | None
    size: float
    """How stout the arm is drawn: 1 for the usual length."""

    @property
    def short(self) -> float | None:
        """Metres from the end effector to where the hand pulls it, if it doesn't get there."""
        return self.pull_distance if self.pull_distance is not None and self.pull_distance > 1e-6 else None


def solve(p: ChainParams) -> ChainSolution:
    """All the mathematics of a state."""
    chain = Chain(p.axes, p.lengths)
    posture = chain.forward([math.radians(a) for a in p.angles])
    end_effector = posture.composed[-1]
    reach = chain.reach
    joints = tuple(map(_joint, p.axes, p.angles, p.lengths))
    end = _place(posture.positions[-1])
    through = _through(p.point, posture)
    swapped = None if p.swap is None else _other_order(p, chain, posture, joints)
    return ChainSolution(
        individual=posture.individual,
        composed=posture.composed,
        end_effector=end_effector,
        inverse=se3.inverse(end_effector),
        positions=posture.positions,
        swapped_end_effector=None if swapped is None else swapped[0],
        **_freedom(p, posture),
        reach=(reach.least, reach.greatest),
        through=through,
        kept=_kept(p.point, end_effector, through[-1]),
        target_distance=None if p.target is None else math.dist(end, p.target),
        pull_distance=None if p.pull is None else math.dist(end, p.pull),
        pull_outside=p.pull is not None and not reach.least <= math.hypot(*p.pull) <= reach.greatest,
        plane=p.axes[0] if len({*p.axes}) == 1 else None,
        joints=joints,
        wxyz=_wxyz(end_effector[:3, :3]),
        end=end,
        arrows=_arrows(p.show, posture.positions),
        circle=None if p.trace is None else _circle(p.axes[p.trace - 1], p.trace - 1, posture),
        swapped=None if swapped is None else swapped[1],
        size=min(max(sum(p.lengths) / USUAL, 0.4), 1.2),
    )


def _joint(axis: str, degrees: float, length: float) -> Joint:
    angle = math.radians(degrees)
    half, c, s = 0.5 * angle, length * math.cos(angle), length * math.sin(angle)
    w, v = math.cos(half), math.sin(half)
    if axis == "x":
        return Joint(axis, length, (w, v, 0.0, 0.0), (length, 0.0, 0.0))
    if axis == "y":
        return Joint(axis, length, (w, 0.0, v, 0.0), (c, 0.0, -s))
    return Joint(axis, length, (w, 0.0, 0.0, v), (c, s, 0.0))


def _freedom(p: ChainParams, posture: Posture) -> dict[str, Any]:
    """What the Jacobian says; which links there are at all decides the mobility, not how long they are."""
    mobility = Chain(p.axes, tuple(float(length > 0.0) for length in p.lengths)).mobility
    velocity = posture.jacobian[:3]
    values, manipulability, singular = dexterity(velocity, mobility)
    least = values.item(mobility - 1) if mobility else 0.0
    return {
        "jacobian": posture.jacobian,
        "singular_values": values,
        "manipulability": float(manipulability),
        "mobility": mobility,
        "singular": bool(singular),
        "near_singular": mobility > 0 and not singular and least < NEARLY * values.item(0),
        "lost": _lost(p, velocity, mobility) if singular else None,
    }


def _lost(p: ChainParams, velocity: Array, mobility: int) -> Array | None:
    directions, values, _ = np.linalg.svd(velocity)
    left = int((values > 1e-6 * values[0]).sum())
    if mobility == 3 and left == 2:
        return np.asarray(directions[:, 2])
    if mobility == 2 and left == 1 and len({*p.axes}) == 1:
        return np.cross(np.eye(3)["xyz".index(p.axes[0])], directions[:, 0])
    return None


def _through(point: Place, posture: Posture) -> Array:
    rows = [np.array([*point, 1.0])]
    for T in posture.individual[::-1]:
        rows.append(T @ rows[-1])
    return np.array(rows)


def _kept(point: Place, T: Array, world: Array) -> tuple[tuple[float, float], tuple[float, float] | None]:
    arm = (world[:3] - T[:3, 3]).tolist()
    distances = math.hypot(*point), math.hypot(*arm)
    if distances[0] < 1e-9:
        return distances, None
    axis = T[:3, 0].tolist()
    own = math.atan2(math.hypot(*point[1:]), point[0])
    along = sum(a * b for a, b in zip(arm, axis, strict=True))
    across = math.sqrt(max(distances[1] ** 2 - along**2, 0.0))
    return distances, (math.degrees(own), math.degrees(math.atan2(across, along)))


def _arrows(show: str, positions: Array) -> Array:
    tails = positions[:-1] if show == "individual" else np.zeros_like(positions[1:])
    ends = np.stack([tails, positions[1:]], axis=1)
    long = np.abs(ends[:, 1] - ends[:, 0]).sum(axis=1) > 1e-6
    return ends if long.all() else ends[long]


def _circle(axis: str, k: int, posture: Posture) -> Circle:
    """Rounded, so that it is the same for every angle of its joint."""
    frame = posture.composed[k - 1][:3, :3] if k else np.eye(3)
    turned = frame[:, _TURNS[axis]]
    normal, origin = turned[:, 2], posture.positions[k]
    arm = posture.positions[-1] - origin
    centre = origin + (arm @ normal) * normal
    radius = math.dist(posture.positions[-1].tolist(), centre.tolist())
    return Circle(_wxyz(turned), _place(centre.round(12)), round(radius, 9))


def _other_order(p: ChainParams, chain: Chain, posture: Posture, joints: Sequence[Joint]) -> tuple[Array, Swapped]:
    assert p.swap is not None
    first = p.swap - 1
    other, angles = chain.swap(first, [math.radians(a) for a in p.angles])
    T, end = other.forward(angles).composed[-1], posture.composed[-1]
    before = posture.composed[first - 1] if first else np.eye(4)
    swapped = Swapped(
        wxyz=_wxyz(before[:3, :3]),
        origin=_place(before[:3, 3]),
        joints=(joints[first + 1], joints[first], *joints[first + 2 :]),
        end=_place(T[:3, 3]),
        end_wxyz=_wxyz(T[:3, :3]),
        distance=math.dist(T[:3, 3].tolist(), end[:3, 3].tolist()),
        angle=math.degrees(float(rotation_angle(T[:3, :3].T @ end[:3, :3]))),
    )
    return T, swapped


def _wxyz(R: Array) -> Quaternion:
    w, x, y, z = quaternion.from_matrix(R).tolist()
    return w, x, y, z


def _place(array: Array) -> Place:
    x, y, z = array.tolist()
    return x, y, z
