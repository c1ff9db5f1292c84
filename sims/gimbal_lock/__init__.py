"""gimbal-lock: why a degree of freedom disappears.

Three rings, nested: the outer one turns about the world's Z, the middle one about the outer ring's y, the inner one,
which holds an aircraft, about the middle ring's x. What they can do together depends on the pitch alone.
"""

from __future__ import annotations

from sims.gimbal_lock import actions
from sims.gimbal_lock.challenges import CHALLENGES
from sims.gimbal_lock.panes import panes
from sims.gimbal_lock.params import LOCK, GimbalParams
from sims.gimbal_lock.readouts import ROTATION, caption, describe, readouts
from sims.gimbal_lock.scene import GimbalScene
from sims.gimbal_lock.solution import GimbalSolution, solve
from sims.kit.sim import Action, Contract, Objective, Sim
from sims.kit.view import View

__all__ = ["CONTRACT", "SIM", "GimbalParams", "GimbalSolution", "solve"]

SIM = Sim(
    slug="gimbal-lock",
    title="Gimbal lock",
    summary="Turn three nested rings, bring two of their axes into line, and see which turn none of them can make.",
    concepts=("Gimbal lock", "Degrees of freedom", "Singular values"),
    objectives=(
        Objective("Explain how two ring axes in line take one degree of freedom away", "Understand"),
        Objective("Find both lock pitches, and the one combination of yaw and roll that is left at each", "Analyze"),
        Objective("Judge from the singular values how near to lock the rings are, and what a turn costs", "Evaluate"),
    ),
    params=GimbalParams,
    solve=solve,
    scene=GimbalScene,
    caption=caption,
    readouts=readouts,
    folds=(LOCK, ROTATION),
    describe=describe,
    view=View((3.6, -3.3, 1.82), (0.0, 0.0, 0.07), 2.05),
    panes=panes,
    actions=(
        Action("lock", "Go to gimbal lock", "Turn the middle ring to 90°", actions.go_to_lock),
        Action(
            "same-motion", "Show the same motion",
            "At lock: the outer ring turns the aircraft away, the inner one turns it back", actions.same_motion,
        ),
        Action(
            "try-lost", "Try to turn about the lost axis",
            "At lock: a ghost turns about it; see which detour the rings need to follow", actions.try_lost_axis,
        ),
        Action(
            "mark", "Mark this orientation", "Leave a ghost of the aircraft here, to compare with", actions.mark,
            "Show",
        ),
    ),
    handles=actions.HANDLES,
    challenges=CHALLENGES,
    states={
        "turned": {"yaw": 30, "pitch": 35, "roll": -25},
        "lock up": {"pitch": 90},
        "lock down": {"pitch": -90, "yaw": 40, "roll": 25},
        "near lock": {"pitch": 80, "yaw": -20},
        "just off lock": {"pitch": 89.99, "show_reach": True},
        "upside down": {"pitch": 180},
        "half": {"pitch": 48.590378},
        "same orientation": {"pitch": 90, "yaw": 40, "roll": 40, "show_ghost": True, "ghost": (0, 90, 0)},
        "ghost about the lost axis": {"pitch": 90, "show_ghost": True, "ghost": (90, 60, 90)},
        "ghost elsewhere": {"pitch": 20, "show_ghost": True, "ghost": (90, 60, 90), "show_reach": True},
    },
)  # fmt: skip

CONTRACT = Contract(
    parameters="yaw pitch roll",
    solution="R axes singular_values dof lost_axis conditioning",
    link="yaw=-30&pitch=90&roll=45.5",
    state={
        "yaw": -30.0, "pitch": 90.0, "roll": 45.5,
    },
)  # fmt: skip
