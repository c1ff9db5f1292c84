"""What is to be reached with three rings."""

from __future__ import annotations

from sims.gimbal_lock.params import GimbalParams
from sims.gimbal_lock.solution import GimbalSolution
from sims.kit.challenge import Challenge, Progress, nearer
from sims.kit.readout import quantity

APART = 45.0
"""Degrees by which two settings must differ to be two."""
HALF = 0.5


def _same_orientation(p: GimbalParams, s: GimbalSolution) -> Progress:
    if not p.show_ghost or s.ghost is None:
        return Progress(0.0, "Mark an orientation first, then look for another setting of the same.")
    apart = max(abs(a - b) for a, b in zip(p.angles[::2], p.ghost[::2], strict=True))
    if apart < APART:
        return Progress(0.1, f"Outer and inner ring must stand at least {APART:.0f}° from the marked setting.")
    return nearer(s.ghost.angle, 90.0, 1.0, f"{quantity(s.ghost.angle, '°', 1)} to go", "Two settings, one orientation")


def _both_ends(p: GimbalParams, s: GimbalSolution) -> Progress:
    if not p.show_ghost or abs(abs(p.ghost[1]) - 90.0) > 0.1:
        return Progress(0.4 if s.dof < 3 else 0.0, "Go to one lock and mark it there.")
    if s.dof < 3 and p.pitch * p.ghost[1] < 0:
        return Progress(1.0, "Both ends: +90° and −90°")
    return Progress(0.5, "One is marked. Where is the other?")


def _half(p: GimbalParams, s: GimbalSolution) -> Progress:
    least = s.singular_values.item(2)
    left = abs(least - HALF)
    side = "over" if least > HALF else "below"
    return nearer(left, HALF, 0.005, f"{quantity(least)}: {quantity(left)} {side} the half", "Half of what it was")


CHALLENGES: tuple[Challenge[GimbalParams, GimbalSolution], ...] = (
    Challenge(
        id="same-orientation", title="Two settings, one orientation",
        goal="Mark an orientation, then find other angles of the outer and inner ring that give the same one.",
        near=_same_orientation, solves={"pitch": 90, "yaw": 60, "roll": 60, "show_ghost": True, "ghost": (0, 90, 0)},
        misses=(
            {"pitch": 90, "yaw": 60, "roll": 58, "show_ghost": True, "ghost": (0, 90, 0)},
            {"pitch": 90, "yaw": 40, "roll": 40, "show_ghost": True, "ghost": (0, 90, 0)},
        ),
    ),
    Challenge(
        id="both-ends", title="Both ends",
        goal="Find both pitches at which the rings lock: mark one, then go to the other.",
        near=_both_ends, solves={"pitch": -90, "show_ghost": True, "ghost": (0, 90, 0)},
        misses=(
            {"pitch": 90, "show_ghost": True, "ghost": (0, 90, 0)},
            {"pitch": -89, "show_ghost": True, "ghost": (0, 90, 0)},
        ),
    ),
    Challenge(
        id="half-reach", title="Half of it left",
        goal="Find a pitch at which the smallest singular value is half of what it is at pitch 0.",
        near=_half, solves={"pitch": 48.59}, misses=({"pitch": 47.5}, {"pitch": 60}),
    ),
)  # fmt: skip
