"""What is to be reached with three turns."""

from __future__ import annotations

import math

from geometry.euler import euler_to_matrix
from geometry.rotations import rotation_angle
from sims.euler_angles.params import TARGET, EulerParams
from sims.euler_angles.solution import EulerSolution
from sims.kit.challenge import Challenge, Progress, nearer
from sims.kit.readout import quantity

CLOSE = 2.0
"""Degrees from the target within which it is reached."""
SAME = 1.0
"""Degrees within which two rotations are one."""
QUARTERS = euler_to_matrix((math.pi / 2, 0.0, math.pi / 2), "zyx", "intrinsic")


def _target(p: EulerParams, s: EulerSolution) -> Progress:
    if s.target is None:
        return Progress(0.0, "Show the target first: there is a switch for it among the controls.")
    if p.target != TARGET:
        return Progress(0.1, "The target that is shown is another one.")
    left = s.target.angle
    return nearer(left, 180.0, CLOSE, f"{quantity(left, '°', 0)} to go", "The aircraft covers its target")


def _other_order(p: EulerParams, s: EulerSolution) -> Progress:
    if (p.order, p.frame) == ("zyx", "intrinsic"):
        return Progress(0.0, "That is ZYX about own axes: choose another order or frame.")
    left = math.degrees(float(rotation_angle(s.R.T @ QUARTERS)))
    return nearer(left, 180.0, SAME, f"{quantity(left, '°', 0)} to go", "Other turns, the same rotation")


def _lock_at_rest(p: EulerParams, s: EulerSolution) -> Progress:
    if p.order != "zxz":
        return Progress(0.0, "Choose the order ZXZ first.")
    left = 0.0 if s.locked and p.pitch < 90.0 else p.pitch
    return nearer(left, 180.0, 0.0, f"β is {quantity(left, '°', 1)}", "Locked at β = 0°, where nothing is tilted yet")


CHALLENGES: tuple[Challenge[EulerParams, EulerSolution], ...] = (
    Challenge(
        id="reach-target", title="Fly into the target",
        goal="Turn the aircraft by its three angles until it covers the target.",
        near=_target, solves={"show_target": True, "yaw": 120, "pitch": -40, "roll": 60},
        misses=(
            {"show_target": True, "yaw": 120, "pitch": -40, "roll": 55},
            {"show_target": True, "yaw": 60, "pitch": -40, "roll": 120},
            {"show_target": True, "target": (30, 20, 10), "yaw": 30, "pitch": 20, "roll": 10},
        ),
    ),
    Challenge(
        id="other-order", title="Other turns, same end",
        goal="Make the orientation of ZYX with 90°, 0° and 90° by another order or frame.",
        near=_other_order, solves={"order": "zxz", "yaw": 90, "pitch": 90, "roll": 0},
        misses=({"yaw": 90, "pitch": 0, "roll": 90}, {"order": "zxz", "yaw": 90, "pitch": 85, "roll": 0}),
    ),
    Challenge(
        id="lock-at-rest", title="Locked before it moves",
        goal="With ZXZ, find the lock in which the aircraft isn’t tilted at all.",
        near=_lock_at_rest, solves={"order": "zxz", "pitch": 0},
        misses=({"pitch": 0}, {"order": "zxz", "pitch": 5}),
    ),
)  # fmt: skip
