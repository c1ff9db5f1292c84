"""euler-angles: how three turns compose into one rotation.

An aircraft (nose +X, left wing +Y, top +Z) is turned three times. Intrinsic turns are about the axes that the
aircraft has by then, extrinsic ones about the fixed axes of the world.
"""

from __future__ import annotations

from sims.euler_angles import recognise
from sims.euler_angles.actions import HANDLES, animate, take
from sims.euler_angles.challenges import CHALLENGES
from sims.euler_angles.params import EulerParams
from sims.euler_angles.readouts import FACTORS, FORMS, caption, describe, readouts
from sims.euler_angles.scene import EulerScene
from sims.euler_angles.solution import EulerSolution, solve
from sims.kit.paste import Paste
from sims.kit.sim import Action, Contract, Objective, Sim
from sims.kit.view import View

__all__ = ["CONTRACT", "SIM", "EulerParams", "EulerSolution", "solve"]

SIM = Sim(
    slug="euler-angles",
    title="Euler angles",
    summary="Turn an aircraft three times, see each turn in its own frame, and read the one rotation they make.",
    concepts=("Euler angles", "Gimbal lock"),
    objectives=(
        Objective("Predict the orientation that three turns in a given order produce", "Apply"),
        Objective(
            "Tell intrinsic from extrinsic turns, and order the matrices of the product accordingly",
            "Analyze",
        ),
        Objective("Find the middle angle at which an order locks, and say what is lost there", "Analyze"),
    ),
    params=EulerParams,
    solve=solve,
    scene=EulerScene,
    caption=caption,
    readouts=readouts,
    folds=(FACTORS, FORMS),
    describe=describe,
    view=View((3.6, -2.655, 2.0), (0.3, 0.345, 0.0), 1.9),
    handles=HANDLES,
    paste=Paste(
        group="Paste a rotation",
        title="A rotation, in any form",
        about="A matrix, a quaternion, an axis with its angle, a rotation vector or Euler angles, as NumPy, SciPy, ROS,"
        " Unity or CSS write them; where a text can mean several, you are asked which",
        example='Rotation.from_euler("ZYX", [30, 20, 10], degrees=True)',
        read=recognise.read,
        changes=take,
        says=lambda _, found: f"Read as {found['what']}. It is there in all forms under “{FORMS}”.",
    ),
    actions=(Action("animate", "Animate sequence", "Make the three turns one after another", animate),),
    challenges=CHALLENGES,
    states={
        "zero": {"yaw": 0, "pitch": 0, "roll": 0},
        "lock up": {"pitch": 90},
        "lock down": {"pitch": -90},
        "proper lock 0": {"order": "zxz", "pitch": 0},
        "proper lock 180": {"order": "zyz", "pitch": 180},
        "middle is yaw": {"order": "xzy", "yaw": 90},
        "extrinsic": {"frame": "extrinsic", "order": "xyz", "progress": 1.5},
        "half-way": {"progress": 1.5},
        "target": {"show_target": True},
    },
)

CONTRACT = Contract(
    parameters="order frame yaw pitch roll progress",
    solution="R factors quaternion axis_angle lock_distance locked",
    link="order=zxz&frame=extrinsic&yaw=-120.5&pitch=90&roll=45&progress=1.5",
    state={
        "order": "zxz", "frame": "extrinsic", "yaw": -120.5, "pitch": 90.0, "roll": 45.0, "progress": 1.5,
    },
)  # fmt: skip
