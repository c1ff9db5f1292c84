"""The mathematics of a state."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from geometry import hamilton, quaternion
from geometry.arrays import Array, cross, dot
from geometry.euler import matrix_to_euler
from geometry.interpolation import euler_interpolation, nlerp, nlerp_angle, slerp, turn_between
from geometry.rotations import unit
from sims.quaternion.order import Orders, both_orders
from sims.quaternion.params import ONE, TIP, QuaternionParams, Triple
from sims.quaternion.paths import Name, NosePath, ball_path, paths

IDENTITY = np.array(ONE)
NO_PATH = np.zeros((0, 3))
APART = 0.15
SAME = 1e-6
"""Radians within which two orientations are drawn as one."""
INFINITE = 1e9
"""Distance in the ball from which on only rounding tells a place from one at infinity."""


@dataclass(frozen=True)
class Interpolated:
    """The object at t."""

    q: Array
    R: Array


@dataclass(frozen=True)
class Way:
    """One interpolation: the object's quaternion at t and degrees from the start to there; the nose and its path."""

    q: Array
    at: Array
    turned: float
    nose: NosePath


@dataclass(frozen=True)
class Track:
    """The circle on which the axis leads p to its image: in the frame of the axis, angles in radians."""

    radius: float
    height: float
    begin: float


@dataclass(frozen=True)
class QuaternionSolution:
    """`q` turns by the angle about the axis, `q_total` = q ⊗ start is the target."""

    q: Array
    q_total: Array
    R_total: Array
    euler: tuple[float, float, float]
    """Yaw, pitch, roll of the target in degrees (zyx, intrinsic)."""
    euler_locked: bool
    rotated_point: Array
    interpolated: Interpolated
    sandwich: Mapping[str, Array]
    terms: Array
    """(4, 4) of q ⊗ start: row i sums to component i."""
    n: Array
    """The axis at length one."""
    length: float
    """Length of the axis as given."""
    start: Array
    way_axis: Array
    """Axis of the one turn from start to target that SLERP and NLERP make, unit."""
    way_angle: float
    """Its angle in degrees."""
    lead: float
    """Degrees by which NLERP is ahead of SLERP at t."""
    ball_q: Array | None
    """q in the stereographic ball; None at infinity."""
    ball_minus_q: Array | None
    ball_now: Array | None
    """The object's quaternion at t there."""
    ball_start: Array | None
    """The start there, and the target as the path comes to it; only for a start that is turned."""
    ball_target: Array | None
    ball_path: Array
    """Its path from start to target there, (n, 3); empty where the ball isn't shown."""
    axis_frame: Array
    """Orientation of the angle's arc: z along the axis, x where the arc starts."""
    tip: Array
    track: Track
    moved: bool
    """p and its image are so far apart that both can be named."""
    at_start: bool
    """The object is drawn where the start is."""
    at_target: bool
    ways: Mapping[Name, Way] | None
    """The interpolations beside each other, where they are shown."""
    orders: Orders | None
    """A and B in both orders, where they are shown."""


def solve(p: QuaternionParams) -> QuaternionSolution:
    """All the mathematics of a state."""
    q = quaternion.from_axis_angle(p.axis, math.radians(p.angle))
    start = quaternion.normalize(p.start)
    total = quaternion.multiply(q, start)
    R_total = quaternion.to_matrix(total)
    angles, locked = matrix_to_euler(R_total, "zyx", "intrinsic")
    now = _between(p, p.interpolation, start, total)
    n = unit(p.axis)
    way_axis, way_angle = turn_between(start, total, long_way=p.long_way)
    path = _ball_path(p, start, total)
    turned = not _same(start, IDENTITY)
    steps = hamilton.sandwich(q, p.point)
    frame = _axis_frame(n, quaternion.to_matrix(start))
    return QuaternionSolution(
        q=q,
        q_total=total,
        R_total=R_total,
        euler=_degrees(angles),
        euler_locked=bool(locked),
        rotated_point=steps.rotated[1:],
        interpolated=Interpolated(now, quaternion.to_matrix(now)),
        sandwich=steps._asdict(),
        terms=hamilton.product_terms(q, start),
        n=n,
        length=math.hypot(*p.axis),
        start=start,
        way_axis=way_axis,
        way_angle=math.degrees(way_angle),
        lead=math.degrees(nlerp_angle(float(way_angle), p.t) - p.t * way_angle),
        ball_q=_in_ball(q),
        ball_minus_q=_in_ball(-q),
        ball_now=_in_ball(now),
        ball_start=_in_ball(start) if turned else None,
        ball_target=_finite(path[-1]) if turned and len(path) else None,
        ball_path=path,
        axis_frame=quaternion.from_matrix(frame),
        tip=TIP * n,
        track=_track(frame, np.array(p.point)),
        moved=math.dist(p.point, steps.rotated[1:]) > APART,
        at_start=_same(now, start),
        at_target=_same(now, total),
        ways=_ways(p, start, total) if p.topic == "path" else None,
        orders=both_orders(p.axis, p.angle, p.axis_b, p.angle_b, start, p.t) if p.topic == "order" else None,
    )


def _between(p: QuaternionParams, by: Name, start: Array, total: Array) -> Array:
    """The object's quaternion at t."""
    if by == "euler":
        return euler_interpolation(start, total, p.t)
    return (slerp if by == "slerp" else nlerp)(start, total, p.t, long_way=p.long_way)


def _ways(p: QuaternionParams, start: Array, total: Array) -> dict[Name, Way]:
    found: dict[Name, Way] = {}
    for name, nose in paths(start.tobytes(), total.tobytes(), p.long_way).items():
        q = _between(p, name, start, total)
        turn = quaternion.to_axis_angle(quaternion.multiply(q, quaternion.conjugate(start)))[1]
        found[name] = Way(q, quaternion.to_matrix(q)[:, 0], math.degrees(turn), nose)
    return found


def _ball_path(p: QuaternionParams, start: Array, total: Array) -> Array:
    if p.topic != "ball":
        return NO_PATH
    return ball_path(start.tobytes(), total.tobytes(), p.long_way, p.interpolation == "euler")


def _axis_frame(n: Array, start: Array) -> Array:
    """A frame whose z is the axis, and whose x points where the nose of the start does, or its left wing."""
    z = n.tolist()
    for column in (0, 1):
        seen = start[:, column].tolist()
        along = dot(seen, z)
        if abs(along) < 0.97:
            break
    x = unit([s - along * c for s, c in zip(seen, z, strict=True)])
    return np.array([x, cross(z, x.tolist()), z]).T


def _track(frame: Array, point: Array) -> Track:
    x, y, z = (point @ frame).tolist()
    return Track(math.hypot(x, y), z, math.atan2(y, x))


def _same(p: Array, q: Array) -> bool:
    """Whether two quaternions turn the same, as far as anybody sees."""
    return 2.0 * min(math.dist(p, q), math.dist(p, -q)) < SAME


def _in_ball(q: Array) -> Array | None:
    place, finite = hamilton.to_ball(q)
    return place if finite and max(map(abs, place.tolist())) < INFINITE else None


def _finite(place: Array) -> Array | None:
    return place if math.isfinite(place.sum()) else None


def _degrees(angles: Array) -> Triple:
    yaw, pitch, roll = (math.degrees(a) for a in angles.tolist())
    return yaw, pitch, roll
