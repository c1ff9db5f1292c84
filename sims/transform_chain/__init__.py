"""transform-chain: rigid transforms one after another, as an arm of up to eight links.

Link i is T_{i−1,i} = Rot(axis_i, angle_i) · Trans(length_i, 0, 0), and the end effector is where their product leads. A
link may also lead along its axis and twist about its x axis, as in the tables of Denavit and Hartenberg.
"""

from __future__ import annotations

from sims.kit.paste import Paste
from sims.kit.sim import Contract, Objective, Sim, Typed
from sims.transform_chain import actions, own
from sims.transform_chain.challenges import CHALLENGES
from sims.transform_chain.offers import ChainOffers
from sims.transform_chain.params import MOST, OWN, POINT, ChainParams
from sims.transform_chain.readouts import FREEDOM, INVERSE, STAGES, caption, describe, readouts
from sims.transform_chain.scene import ChainScene
from sims.transform_chain.solution import ChainSolution, solve
from sims.transform_chain.views import VIEW, seen, view_of

__all__ = ["CONTRACT", "SIM", "ChainParams", "ChainSolution", "solve"]

SIM = Sim(
    slug="transform-chain",
    title="Transform chain",
    summary="Join up to eight links, turn each joint, and read how their transforms multiply to the hand’s pose.",
    concepts=("Rigid transforms", "SE(3)", "Forward kinematics"),
    objectives=(
        Objective("Compose the transforms of a chain into the pose of its end effector", "Apply"),
        Objective("Explain why two transforms can’t be exchanged, and when two turns can", "Understand"),
        Objective("Tell a singular pose from the arm’s Jacobian, and say which motion is lost", "Analyze"),
    ),
    params=ChainParams,
    solve=solve,
    scene=ChainScene,
    caption=caption,
    readouts=readouts,
    folds=(STAGES, INVERSE, POINT, FREEDOM, OWN),
    describe=describe,
    view=VIEW,
    view_of=view_of,
    seen=seen,
    offers=ChainOffers,
    actions=actions.ACTIONS,
    handles={"/grip": actions.hold_end, **{f"/turn{k + 1}": actions.hold_joint(k) for k in range(MOST)}},
    typed=(
        Typed(
            "/grip", "End effector", "Turns the joints so that the end effector gets there, as dragging it does",
            (-16.0, -16.0, -16.0), (16.0, 16.0, 16.0), actions.end_place,
        ),
    ),
    paste=Paste(
        OWN, "Your table or URDF",
        "Rows of Denavit and Hartenberg, a, α, d, θ and r or p (metres and degrees unless you say otherwise, with q for"
        " what a joint changes), or a robot’s URDF whose joints make one chain, of at most eight links",
        own.EXAMPLE, own.read, own.changes, (".urdf", ".xml", ".csv", ".txt"),
    ),
    challenges=CHALLENGES,
    states={
        "one link": {"angles": (50,), "lengths": (1.2,), "axes": "z"},
        "planar 2R": {"angles": (30, 60), "lengths": (1, 0.8), "axes": "zz"},
        "planar 2R stretched, singular": {"angles": (30, 0), "lengths": (1, 0.8), "axes": "zz"},
        "planar 2R folded, singular": {"angles": (30, 180), "lengths": (1, 0.8), "axes": "zz"},
        "stretched, singular": {"angles": (30, 40, 0)},
        "above its base, singular": {"angles": (0, -60, -60), "lengths": (0, 0.8, 0.8), "axes": "zyy"},
        "nearly singular": {"angles": (30, 2), "lengths": (1, 0.8), "axes": "zz"},
        "twist that moves nothing": {"angles": (40, 20), "lengths": (1, 0.5), "axes": "xx"},
        "all lengths zero": {"lengths": (0, 0, 0)},
        "eight links": {
            "angles": (30, -60, 40, 20, 30, -40, 60, 20), "lengths": (0.4,) * 8, "axes": "zyyxyzyx",
            "swap": 3, "trace": 2,
        },
        "composed": {"show": "composed"},
        "swapped, different axes": {"swap": 1},
        "swapped, same axis": {"swap": 2},
        "swapped turns, same axis": {"angles": (30, 40, 0), "lengths": (0, 0, 1), "axes": "zzy", "swap": 1},
        "trace": {"trace": 2},
        "target": {"target": (1.2, 0.4, 0.3)},
        "out of reach": {"pull": (3, 0, 0.5), "angles": (0, -9.462, 0), "trace": 1},
        "one transform alone": {"stage": 2},
        "SCARA": {
            "angles": (-20, 70, 0, 0), "lengths": (0.425, 0.375, 0, 0), "axes": "zzzz", "twists": (0, 180, 0, 0),
            "offsets": (0, 0, 0.12, 0), "joints": "rrpr",
        },
        "UR5, as textbooks have it": {
            "angles": (180, -45, 0, 90, 0, 0), "lengths": (0, -0.425, -0.39225, 0, 0, 0), "axes": "zzzzzz",
            "twists": (90, 0, 0, 90, -90, 0), "offsets": (0.089159, 0, 0, 0.10915, 0.09465, 0.0823),
        },
        "SCARA without a slide": {"angles": (-20, 70, 90, 0), "lengths": (0.425, 0.375, 0.15, 0), "axes": "zzyx"},
        "six axes": {
            "angles": (30, -60, 80, 0, 40, 0), "lengths": (0.15, 0.7, 0.6, 0, 0, 0.065), "axes": "zyyxyx",
            "show": "composed",
        },
    },
)  # fmt: skip

CONTRACT = Contract(
    parameters="angles lengths axes show swap stage twists offsets starts joints",
    solution="individual composed end_effector inverse positions swapped_end_effector",
    link="show=composed&angles=30,40,-30.5,90&lengths=1,0.8,0.5,0&axes=zyyx&swap=2",
    state={
        "show": "composed", "angles": [30.0, 40.0, -30.5, 90.0], "lengths": [1.0, 0.8, 0.5, 0.0], "axes": "zyyx",
        "swap": 2,
    },
)  # fmt: skip
