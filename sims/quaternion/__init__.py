"""quaternion: a turn about an axis as four numbers, how turns compose, and paths between two orientations.

An aircraft (nose +X, left wing +Y, top +Z) stands at a start and is turned by an angle about an axis: its target
is q ⊗ start. Half of the angle is what q holds. More comes with each fold: all turns as a ball, a point that q turns,
two turns in both orders, and the ways from start to target by SLERP, NLERP and Euler angles.
"""

from __future__ import annotations

from sims.kit.sim import Action, Contract, Objective, Sim
from sims.quaternion import actions, ball, dial
from sims.quaternion.challenges import CHALLENGES
from sims.quaternion.offers import QuaternionOffers
from sims.quaternion.panes import panes
from sims.quaternion.params import BALL, COMPOSED, MATRIX, ORDER, PATH, SANDWICH, QuaternionParams
from sims.quaternion.readouts import caption, describe, readouts
from sims.quaternion.scene import QuaternionScene
from sims.quaternion.solution import QuaternionSolution, solve

__all__ = ["CONTRACT", "SIM", "QuaternionParams", "QuaternionSolution", "solve"]

HALF = 0.5**0.5

SIM = Sim(
    slug="quaternion",
    title="Quaternions",
    summary="Turn an aircraft about any axis, read the quaternion that does it, compose turns, and move smoothly.",
    concepts=("Quaternion", "Quaternion Rotation", "SLERP"),
    objectives=(
        Objective("Write the quaternion of a turn from its axis and half its angle, and read them back", "Apply"),
        Objective("Explain why q and −q turn the same, and what the long way is", "Understand"),
        Objective("Compose turns as products, and predict that their order matters", "Apply"),
        Objective("Compare SLERP, NLERP and Euler angles by their path and their speed", "Analyze"),
    ),
    params=QuaternionParams,
    solve=solve,
    scene=QuaternionScene,
    caption=caption,
    readouts=readouts,
    folds=(BALL, SANDWICH, ORDER, PATH, COMPOSED, MATRIX),
    describe=describe,
    view=ball.VIEW,
    panes=panes,
    offers=QuaternionOffers,
    actions=(
        Action("play", "Play", "See what is shown happen, from the start on; nothing comes of it", actions.play),
        Action(
            "apply", "Make this turn", "Turn by θ about n: where that leads is the start of the next turn, q ⊗ start",
            actions.apply, aliases=("compose",),
        ),
        Action("undo", "Undo last turn", "Take back the last turn made", actions.undo, COMPOSED),
    ),
    handles={
        "/tip": actions.hold_tip, "/axis": actions.hold_axis, "/angle": actions.hold_angle,
        "/object": actions.hold_object, "/point": actions.hold_point, "t": actions.hold_t,
        "theta": dial.hold_theta, "half": dial.hold_half, "q": ball.hold_q, "minus_q": ball.hold_minus_q,
    },
    challenges=CHALLENGES,
    states={
        "no turn": {"angle": 0},
        "half turn": {"axis": (1, 1, 0), "angle": 180},
        "whole turn": {"axis": (1, 1, 1), "angle": 360, "t": 0.5},
        "minus q": {"axis": (0, 0, -1), "angle": 300},
        "second round": {"axis": (0, 1, 1), "angle": 450},
        "two whole turns": {"angle": 720},
        "ball": {"show": "ball", "axis": (1, 0.5, 1), "angle": 140},
        "ball at infinity": {"show": "ball", "angle": 360},
        "ball, start turned": {"show": "ball", "start": (HALF, HALF, 0, 0), "angle": 100, "t": 0.5},
        "point": {"show": "point", "axis": (1, 1, 1), "angle": 120},
        "both orders": {"show": "order", "t": 0.7},
        "orders alike": {"show": "order", "axis_b": (0, 0, -3), "angle_b": 40},
        "three ways": {"show": "path", "axis": (1, 0, 1), "angle": 170, "t": 0.25},
        "long way": {"axis": (1, 1, 1), "angle": 100, "long_way": True, "t": 0.4},
        "long way of no turn": {"angle": 0, "long_way": True, "t": 0.25},
        "long way of a half turn": {"angle": 180, "long_way": True, "interpolation": "nlerp", "t": 0.3},
        "axis along the nose": {"axis": (1, 0, 0), "point": (2, 0, 0)},
        "gimbal lock": {"axis": (0, 1, 0), "show_euler": True, "interpolation": "euler", "t": 0.6},
        "composed": {
            "start": (HALF, 0, 0, HALF), "history": (0, 0, 1, 90), "axis": (1, 0, 0), "show_euler": True, "t": 0.5,
        },
        "euler path": {"axis": (1, 1, 0), "angle": 150, "interpolation": "euler", "t": 0.5, "show_euler": True},
    },
)  # fmt: skip

CONTRACT = Contract(
    parameters="axis angle start t interpolation long_way show_euler point show axis_b angle_b",
    solution="q q_total R_total euler rotated_point interpolated sandwich",
    link=(
        "axis=1,1,0&angle=120&start=0.5,0.5,0.5,0.5&t=0.25&interpolation=nlerp&long_way=1&show_euler=1"
        "&point=0,1,0.5"
    ),
    state={
        "axis": [1.0, 1.0, 0.0], "angle": 120.0, "start": [0.5, 0.5, 0.5, 0.5], "t": 0.25,
        "interpolation": "nlerp", "long_way": True, "show_euler": True, "point": [0.0, 1.0, 0.5],
    },
)  # fmt: skip
