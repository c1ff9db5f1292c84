"""coordinate-frames: what a convention of axes is, its handedness, one point in seven conventions, and w.

The world is a car on a floor: right, forward, up. It never moves; a convention only chooses the axes on its roof.
"""

from __future__ import annotations

from sims.coordinate_frames import actions
from sims.coordinate_frames.challenges import CHALLENGES
from sims.coordinate_frames.params import GRIDS, FramesParams
from sims.coordinate_frames.readouts import ALL, AXES, HOMOGENEOUS, caption, describe, readouts
from sims.coordinate_frames.scene import FramesScene, seen
from sims.coordinate_frames.solution import FramesSolution, solve
from sims.kit.sim import Action, Contract, Objective, Sim
from sims.kit.view import View

__all__ = ["CONTRACT", "SIM", "FramesParams", "FramesSolution", "solve"]

SIM = Sim(
    slug="coordinate-frames",
    title="Coordinate frames",
    summary="Choose axes for one and the same world, see which hand they follow, and read one point in all of them.",
    concepts=("3D coordinate systems", "Handedness", "Homogeneous coordinates"),
    objectives=(
        Objective("Read one physical point in different conventions of axes, and convert between them", "Apply"),
        Objective("Tell the handedness of axes, by hand and by the sign of a determinant", "Analyze"),
        Objective("Explain what the fourth coordinate is for, and what it means that it is zero", "Understand"),
    ),
    params=FramesParams,
    solve=solve,
    scene=FramesScene,
    caption=caption,
    readouts=readouts,
    folds=(HOMOGENEOUS, ALL, AXES,),
    describe=describe,
    view=View((-2.7, -3.5, 2.15), (0.0, 0.0, 0.0), 1.85),
    seen=seen,
    actions=(
        Action("shift", "Move the second frame", "T moves a point’s numbers, never a direction’s", actions.shift),
        Action("rule", "Animate the rule", "Fingers from X to Y, thumb along Z", actions.sweep),
        Action("infinity", "Let w go to 0", "The point runs away; a direction is left", actions.run_away),
    ),
    handles={"/point": actions.hold_point, "/second": actions.hold_origin},
    eases=actions.turn,
    challenges=CHALLENGES,
    states={
        "left-handed OpenGL": {"convention": "opengl", "handedness": "left", "show_rule": True},
        "own handedness, said": {"handedness": "right", "to": "ros"},
        "rotation": {"convention": "ros", "to": "camera", "point": (2, -1, 0.5), "rule": 0.5},
        "reflection": {"to": "directx", "grid_xy": True},
        "right-handed Unreal": {
            "convention": "unreal", "to": "unreal", "handedness": "right", "rule": 0, "show_rule": True,
        },
        "down": {"convention": "aviation", "to": "enu", "grid_xz": True, "grid_yz": True},
        "all grids": {"convention": "camera", "to": "enu", "w": 0.8, **dict.fromkeys(GRIDS, True)},
        "near": {"w": 2},
        "out of view": {"w": 0.1},
        "very far": {"w": 1e-300, "convention": "ros"},
        "too far for numbers": {"point": (5, 5, 5), "w": 2.8e-308},
        "direction": {"point": (0, 0, 1), "w": 0},
        "direction, left-handed": {"point": (-3, 1, 1), "w": 0, "convention": "directx", "to": "ros"},
        "neither": {"point": (0, 0, 0), "w": 0},
        "origin": {"point": (0, 0, 0), "w": 0.5},
        "one frame": {
            "convention": "opengl", "to": "opengl", "origin": (0, 0, 0), "point": (1, 0.8, 0.6), "show_rule": True,
        },
        "a frame elsewhere": {"convention": "unreal", "to": "directx", "origin": (0.5, 1.0, -0.2), "w": 0.5},
        "a direction in both": {"convention": "ros", "to": "camera", "origin": (0.5, -1.0, 0.2), "w": 0},
        "half way": {"convention": "ros", "turn": (1, 1, 0, 0, 0.2), "turn_to": (1, 0, 0, 1, -0.5), "lit": "y"},
        "with the hand": {"show_rule": True},
    },
)  # fmt: skip

CONTRACT = Contract(
    parameters="convention to handedness origin point w grid_xy grid_xz grid_yz show_rule",
    solution="basis handedness point_world coordinates matrix determinant homogeneous cartesian"
    " homogeneous_to cartesian_to direction_to origin_world",
    link="convention=ros&to=camera&handedness=left&point=2,-1,0.5&w=0.5&grid_xy=1&grid_yz=1&show_rule=0",
    state={
        "convention": "ros", "to": "camera", "handedness": "left", "point": [2.0, -1.0, 0.5], "w": 0.5,
        "grid_xy": True, "grid_xz": False, "grid_yz": True, "show_rule": False,
    },
)  # fmt: skip
