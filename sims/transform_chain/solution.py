"""The mathematics of a state."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from geometry import se3
from geometry.arrays import Array
from geometry.kinematics import Chain, Posture, dexterity
from geometry.rotations import rotation_angle
from sims.kit.types import Line, Quaternion
from sims.transform_chain.drawing import HOLD, Circle, Joint, Span, circle, hold, joint, place_of, span, wxyz_of
from sims.transform_chain.params import ChainParams, Place

USUAL = 2.3
"""Length in metres of the arm that the sim begins with: longer ones are drawn stouter, shorter ones slimmer."""
ENOUGH = 0.02
"""Metres within which a target counts as reached."""
NEARLY = 0.05
"""Part of the largest singular value below which the smallest is nearly none."""


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
    apart: Span | None
    """From the arm's end effector to the other's."""


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
    reach: tuple[float, float | None]
    """Bounds of the distance from the base, in metres; None where a joint slides as far as one likes."""
    through: Array
    """The point in homogeneous coordinates, (n + 1, 4): in the end effector's frame, …, in the world."""
    kept: tuple[tuple[float, float], tuple[float, float] | None]
    """Distance of the point from the end effector, and its angle to that one's x axis: in its frame, in the world."""
    target_distance: float | None
    pull_distance: float | None
    pull_outside: bool
    """The hand pulls to where no posture gets."""
    pulled: Span | None
    """From the end effector to where the hand pulls it."""
    joints: tuple[Joint, ...]
    wxyz: Quaternion
    """Orientation of the end effector."""
    end: Place
    tool: str
    """Axis of the end effector that it points along: x with its link, z of an arm whose last link only turns."""
    spans: tuple[Span | None, ...]
    """The composed transforms, from the world to each frame."""
    holds: tuple[Place | None, ...]
    """Where each joint is held, in the world; None for a fixed one."""
    lines: tuple[Line | None, ...]
    """What each joint turns about, in the world: a place and a direction; None for one that doesn't turn."""
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
    chain, moves = p.arm, p.moves
    posture = chain.forward(moves)
    end_effector = posture.composed[-1]
    reach = chain.reach
    joints = tuple(map(joint, chain.links, moves))
    positions = [place_of(position) for position in posture.positions]
    end = positions[-1]
    through = _through(p.point, posture)
    swapped = None if p.swap is None else _other_order(p.swap - 1, chain, posture, joints, moves)
    size = min(max(sum(link.extent for link in chain.links) / USUAL, 0.4), 1.2)
    return ChainSolution(
        individual=posture.individual,
        composed=posture.composed,
        end_effector=end_effector,
        inverse=se3.inverse(end_effector),
        positions=posture.positions,
        swapped_end_effector=None if swapped is None else swapped[0],
        **_freedom(p, chain, posture),
        reach=(reach.least, reach.greatest if math.isfinite(reach.greatest) else None),
        through=through,
        kept=_kept(p.point, end_effector, through[-1]),
        target_distance=None if p.target is None else math.dist(end, p.target),
        pull_distance=None if p.pull is None else math.dist(end, p.pull),
        pull_outside=p.pull is not None and not reach.least <= math.hypot(*p.pull) <= reach.greatest,
        pulled=None if p.pull is None else span(p.pull, end),
        joints=joints,
        wxyz=wxyz_of(end_effector[:3, :3]),
        end=end,
        tool="z" if p.rows and not chain.lengths[-1] and p.axes[-1] == "z" else "x",
        spans=tuple(span(positions[0], position) for position in positions[1:]),
        holds=_holds(chain, moves, posture, joints, HOLD * size),
        lines=_lines(p, posture),
        circle=_trace(p, posture),
        swapped=None if swapped is None else swapped[1],
        size=size,
    )


def _trace(p: ChainParams, posture: Posture) -> Circle | None:
    k = -1 if p.trace is None else p.trace - 1
    return circle(p.axes[k], k, posture) if k >= 0 and p.kind(k) == "r" else None


def _holds(
    chain: Chain, moves: Sequence[float], posture: Posture, joints: Sequence[Joint], radius: float
) -> tuple[Place | None, ...]:
    frames = [np.eye(4), *posture.composed[:-1]]
    own = map(hold, chain.links, joints, moves, [radius] * len(joints))
    places = (place_of(T[:3, :3] @ place + T[:3, 3]) for T, place in zip(frames, own, strict=True))
    return tuple(None if kind == "f" else place for kind, place in zip(chain.joints, places, strict=True))


def _lines(p: ChainParams, posture: Posture) -> tuple[Line | None, ...]:
    frames = [np.eye(4), *posture.composed[:-1]]
    lines = [(place_of(T[:3, 3]), place_of(T[:3, "xyz".index(axis)])) for T, axis in zip(frames, p.axes, strict=True)]
    return tuple(line if p.kind(k) == "r" else None for k, line in enumerate(lines))


def _freedom(p: ChainParams, chain: Chain, posture: Posture) -> dict[str, Any]:
    """What the Jacobian says; which links there are at all decides the mobility, not how long they are."""
    lengths, offsets = (tuple(float(v != 0.0) for v in numbers) for numbers in (chain.lengths, chain.offsets))
    mobility = Chain(chain.axes, lengths, chain.twists, offsets, chain.starts, chain.joints).mobility
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
    if mobility == 2 and left == 1 and p.plane is not None:
        return np.cross(np.eye(3)["xyz".index(p.plane)], directions[:, 0])
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


def _other_order(
    first: int, chain: Chain, posture: Posture, joints: Sequence[Joint], moves: Sequence[float]
) -> tuple[Array, Swapped]:
    other, moved = chain.swap(first, moves)
    T, end = other.forward(moved).composed[-1], posture.composed[-1]
    before = posture.composed[first - 1] if first else np.eye(4)
    at, own = place_of(T[:3, 3]), place_of(end[:3, 3])
    swapped = Swapped(
        wxyz=wxyz_of(before[:3, :3]),
        origin=place_of(before[:3, 3]),
        joints=(joints[first + 1], joints[first], *joints[first + 2 :]),
        end=at,
        end_wxyz=wxyz_of(T[:3, :3]),
        distance=math.dist(at, own),
        angle=math.degrees(float(rotation_angle(T[:3, :3].T @ end[:3, :3]))),
        apart=span(own, at),
    )
    return T, swapped
