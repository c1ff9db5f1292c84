"""What the scene draws of an arm, by numbers: frames one in the other, arrows along them, and where a joint is held.

In a browser a node's pose is drawn at once, and what it is made of a frame later. So whatever moves with the arm hangs
on a node that moves, and is itself the same from state to state.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from geometry import quaternion
from geometry.arrays import Array
from geometry.kinematics import Link, Posture
from sims.kit.types import Quaternion
from sims.transform_chain.params import Place

TURNS = {"x": (1, 2, 0), "y": (2, 0, 1), "z": (0, 1, 2)}
"""An axis as the last of three, the first two of which it turns one to the other."""
SHORT = 1e-6
"""Metres below which an arrow leads nowhere."""
HOLD = 0.17
"""Metres from a joint's axis at which it is held, for an arm of the usual size."""


@dataclass(frozen=True)
class Joint:
    """One transform as it is drawn: the frame after a joint and its link, in the frame before."""

    axis: str
    kind: str
    length: float
    offset: float
    wxyz: Quaternion
    position: Place
    tail: Place | None
    """Where the frame before is, in the frame after; None where they are at one place."""


@dataclass(frozen=True)
class Circle:
    """What the end effector describes as one joint turns: in the xy plane of a frame in the world."""

    wxyz: Quaternion
    centre: Place
    radius: float


@dataclass(frozen=True)
class Span:
    """A straight way that ends at a place: along the x axis of a frame there, from x = −length, which is rounded."""

    wxyz: Quaternion
    tip: Place
    length: float


def joint(link: Link, moved: float) -> Joint:
    """A link's transform, its joint moved so many radians or metres."""
    angle = link.start + moved if link.kind == "r" else link.start
    offset = link.offset + moved if link.kind == "p" else link.offset
    turn = along(link.axis, math.sin(0.5 * angle))
    wxyz = (math.cos(0.5 * angle), *turn)
    c, s = link.length * math.cos(angle), link.length * math.sin(angle)
    x, y, z = {"x": (link.length, 0.0, 0.0), "y": (c, 0.0, -s), "z": (c, s, 0.0)}[link.axis]
    dx, dy, dz = along(link.axis, offset)
    if link.twist:
        wxyz = _twisted(wxyz, link.twist)
    position = (x + dx, y + dy, z + dz)
    tail = None if math.hypot(*position) < SHORT else _tail(link, (dx, dy, dz))
    return Joint(link.axis, link.kind, link.length, offset, wxyz, position, tail)


def along(axis: str, amount: float) -> Place:
    """So much along an axis."""
    return amount * (axis == "x"), amount * (axis == "y"), amount * (axis == "z")


def _twisted(wxyz: Quaternion, twist: float) -> Quaternion:
    """A quaternion times that of a turn about x."""
    (w, x, y, z), c, s = wxyz, math.cos(0.5 * twist), math.sin(0.5 * twist)
    return w * c - x * s, x * c + w * s, y * c + z * s, z * c - y * s


def _tail(link: Link, offset: Place) -> Place:
    """Back along the link and its offset, in the frame at its end: no angle of the joint changes it."""
    (x, y, z), c, s = offset, math.cos(link.twist), math.sin(link.twist)
    return -(link.length + x), -(y * c + z * s), y * s - z * c


def span(tail: Place, tip: Place) -> Span | None:
    """The way between two places; None where they are one."""
    way = [b - a for a, b in zip(tail, tip, strict=True)]
    length = math.hypot(*way)
    if length < SHORT:
        return None
    x, y, z = (v / length for v in way)
    if x < -1.0 + 1e-12:
        return Span((0.0, 0.0, 0.0, 1.0), tip, round(length, 9))
    size = math.sqrt(2.0 * (1.0 + x))  # of 1 + x and the cross product of the x axis with the way
    return Span(((1.0 + x) / size, 0.0, -z / size, y / size), tip, round(length, 9))


def circle(axis: str, k: int, posture: Posture) -> Circle:
    """Rounded, so that it is the same for every angle of its joint."""
    frame = posture.composed[k - 1][:3, :3] if k else np.eye(3)
    turned = frame[:, TURNS[axis]]
    normal, origin = turned[:, 2], posture.positions[k]
    arm = posture.positions[-1] - origin
    centre = origin + (arm @ normal) * normal
    radius = math.dist(posture.positions[-1].tolist(), centre.tolist())
    return Circle(wxyz_of(turned), place_of(centre.round(12)), round(radius, 9))


def hold(link: Link, joint: Joint, moved: float, radius: float) -> Place:
    """Where a joint is held, in the frame before it: beside its link, so far from its axis."""
    angle = link.start + moved if link.kind == "r" else link.start
    c, s = radius * math.cos(angle), radius * math.sin(angle)
    x, y, z = {"x": (0.0, -s, c), "y": (s, 0.0, c), "z": (s, -c, 0.0)}[link.axis]
    dx, dy, dz = along(link.axis, joint.offset)
    return x + dx, y + dy, z + dz


def held_angle(axis: str, place: Place) -> float | None:
    """The turn, in radians, at which a joint is held in that direction; None on its axis."""
    x, y, z = place
    across, ahead = {"x": (-y, z), "y": (x, z), "z": (x, -y)}[axis]
    return None if math.hypot(across, ahead) < SHORT else math.atan2(across, ahead)


def wxyz_of(R: Array) -> Quaternion:
    """A rotation matrix as a quaternion."""
    w, x, y, z = quaternion.from_matrix(R).tolist()
    return w, x, y, z


def place_of(array: Array) -> Place:
    """An array of three as floats."""
    x, y, z = array.tolist()
    return x, y, z
