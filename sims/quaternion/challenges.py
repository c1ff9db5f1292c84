"""What is to be reached with turns."""

from __future__ import annotations

import math

from geometry import quaternion
from sims.kit.challenge import Challenge, Progress, nearer
from sims.kit.readout import quantity
from sims.quaternion.params import QuaternionParams
from sims.quaternion.solution import QuaternionSolution

SIXTY = quaternion.from_axis_angle((0.0, 0.0, 1.0), math.radians(60.0))
QUARTER, APART = 90.0, 90.0
"""Degrees of each of two turns, and between the ends to which both orders are to lead."""
WIDE = 8.0
"""Degrees between SLERP and NLERP; on the short way there are never more than 8.15."""


def _same_turn(_: QuaternionParams, s: QuaternionSolution) -> Progress:
    along = min(max(float(s.q @ SIXTY), -1.0), 1.0)
    apart = 2.0 * math.degrees(math.acos(abs(along)))
    if apart <= 1.0 and (along > 0.0 or s.n[2] > 0.0):
        return Progress(0.5, "That is the position, by the same arrow. Look for another one, with w below zero.")
    to_go = 2.0 * math.degrees(math.acos(-along))
    words = f"The aircraft is {quantity(apart, '°', 0)} from where it should stand"
    return nearer(to_go, 360.0, 1.0, words, "The same position, and all four signs are turned round")


def _orders_apart(p: QuaternionParams, s: QuaternionSolution) -> Progress:
    if s.orders is None:
        return Progress(0.0, "Open “Two turns” first.")
    if p.angle != QUARTER or p.angle_b != QUARTER:
        return Progress(0.1, "Both turns must be quarter turns, of 90°.")
    words = f"The two ends are {quantity(s.orders.apart, '°', 1)} apart"
    left = abs(s.orders.apart - APART)
    return nearer(left, APART, 1.0, words, f"{quantity(s.orders.apart, '°', 1)} apart by nothing but the order")


def _widest_gap(p: QuaternionParams, s: QuaternionSolution) -> Progress:
    if not s.ways:
        return Progress(0.0, "Open “From start to target” first.")
    if p.long_way:
        return Progress(0.1, "That is the long way. Take the short one.")
    gap = abs(s.lead)
    words = f"{quantity(gap, '°', 1)} apart, {quantity(max(WIDE - gap, 0.0), '°', 1)} to go"
    return nearer(WIDE - gap, WIDE, 0.0, words, f"{quantity(gap, '°', 1)} apart: on a short way it gets hardly wider")


CHALLENGES: tuple[Challenge[QuaternionParams, QuaternionSolution], ...] = (
    Challenge(
        id="same-turn", title="The same turn with the opposite q",
        goal=(
            "Bring the aircraft to where 60° about Z would bring it, but by another arrow and angle: all four numbers"
            " of q are to have the opposite sign."
        ),
        near=_same_turn, solves={"axis": (0, 0, -1), "angle": 300},
        misses=(
            {"angle": 60}, {"angle": 420},
            {"axis": (0, 0, -1), "angle": 296}, {"axis": (0, 0.1, -1), "angle": 300},
        ),
    ),
    Challenge(
        id="orders-apart", title="Apart by nothing but the order",
        goal="Find axes of two quarter turns, of 90° each, for which the two orders end 90° apart.",
        near=_orders_apart, solves={"show": "order", "axis_b": (1.19, 0, 1)},
        misses=(
            {"show": "order", "axis_b": (1.0, 0, 1)},
            {"show": "order", "axis_b": (1.4, 0, 1)},
            {"show": "order", "axis_b": (1.19, 0, 1), "angle_b": 80},
        ),
    ),
    Challenge(
        id="widest-gap", title="The widest gap",
        goal="Find a turn and a t at which SLERP and NLERP are 8° apart or more, on the short way.",
        near=_widest_gap, solves={"show": "path", "angle": 180, "t": 0.24},
        misses=(
            {"show": "path", "angle": 170, "t": 0.24},
            {"show": "path", "angle": 180, "t": 0.3},
            {"show": "path", "angle": 120, "t": 0.24, "long_way": True},
        ),
    ),
)  # fmt: skip
