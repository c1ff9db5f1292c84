"""What is to be reached with axes, a point and its fourth coordinate."""

from __future__ import annotations

import math

import numpy as np

from sims.coordinate_frames.conventions import axes
from sims.coordinate_frames.params import FramesParams
from sims.coordinate_frames.solution import FramesSolution
from sims.kit.challenge import Challenge, Progress, nearer
from sims.kit.readout import figure, quantity

AIM = (2.0, -1.0, 0.5)
"""What ROS is to read, in metres."""
BACK = np.array([0.0, 0.0, 1.0])
"""The direction that is asked for, in OpenGL."""
FAR, NEAR = 4.0, 0.02
"""Metres from the aim where it begins to count, and within which it is reached."""
ALONG = 1.0
"""Degrees within which a direction is the one that is asked for."""


def _mirrored_pair(p: FramesParams, s: FramesSolution) -> Progress:
    if p.convention != "ros":
        return Progress(0.0, "Choose ROS as the first convention.")
    if s.axes is not axes("ros"):
        return Progress(0.4, "These axes were mirrored by hand. Look for two conventions as they are.")
    if s.determinant < 0.0:
        return Progress(1.0, "det T = −1: no turn leads from one to the other")
    return Progress(0.4, "det T = 1: a turn leads from one to the other. Look at the hand of each.")


def _ros_reads(p: FramesParams, s: FramesSolution) -> Progress:
    if p.convention == "ros":
        return Progress(0.0, "Leave ROS first: choose another convention.")
    if s.cartesian is None:
        return Progress(0.1, "A direction is nowhere: set w to 1.")
    left = math.dist(s.coordinates["ros"].tolist(), AIM)
    return nearer(left, FAR, NEAR, f"{quantity(left, 'm', 2)} to go", "ROS reads (2, −1, 0.5)")


def _direction_back(p: FramesParams, s: FramesSolution) -> Progress:
    if s.axes is not axes("opengl"):
        return Progress(0.0, "Choose OpenGL first, right-handed.")
    length = math.hypot(*p.point)
    if not length:
        return Progress(0.0, "(0, 0, 0) leads nowhere: give z a number.")
    off = math.degrees(math.acos(min(max(float(BACK @ p.point) / length, -1.0), 1.0)))
    if p.w > 0.0:
        share = 0.4 * (1.0 - off / 180.0) + 0.2 * (2.0 - p.w)
        return Progress(share, f"A point still, for w is {figure(p.w, 2)}.")
    done = "A direction with no place: it points back, towards you"
    return nearer(off, 180.0, ALONG, f"A direction, {quantity(off, '°', 0)} off", done)


CHALLENGES: tuple[Challenge[FramesParams, FramesSolution], ...] = (
    Challenge(
        id="mirrored-pair", title="Two worlds that no turn joins",
        goal="Find a convention to which no turn leads from ROS: det T = −1.",
        near=_mirrored_pair, solves={"convention": "ros", "to": "unreal"},
        misses=(
            {"convention": "ros", "to": "camera"}, {"to": "directx"},
            {"convention": "ros", "handedness": "left", "to": "camera"},
        ),
    ),
    Challenge(
        id="ros-reads", title="Say it in ROS",
        goal="With another convention than ROS chosen, place the point where ROS reads (2, −1, 0.5).",
        near=_ros_reads, solves={"point": (1.0, 0.5, -2.0)},
        misses=({"point": (1.0, 0.5, -1.9)}, {"convention": "ros", "point": AIM}, {"point": AIM, "w": 0}),
    ),
    Challenge(
        id="direction-back", title="A direction, no place",
        goal="In OpenGL, make the direction (0, 0, 1, 0).",
        near=_direction_back, solves={"point": (0.0, 0.0, 1.0), "w": 0},
        misses=({"point": (0.0, 0.0, 1.0), "w": 0.1}, {"point": (0.0, 0.3, 1.0), "w": 0}),
    ),
)  # fmt: skip
