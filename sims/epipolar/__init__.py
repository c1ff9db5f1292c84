"""epipolar: what two pictures of one scene have to do with each other.

Two cameras look at points. A point and both centres span the epipolar plane, which cuts each picture in a line: where
the point is in one picture, it must be on that line in the other. F says so in numbers.
"""

from __future__ import annotations

from sims.epipolar import actions, calibration, candidate, plan, ray
from sims.epipolar.challenges import CHALLENGES
from sims.epipolar.offers import EpipolarOffers
from sims.epipolar.panes import panes
from sims.epipolar.params import CAMERAS, ESTIMATE, ESTIMATE_ACTION, OWN, EpipolarParams
from sims.epipolar.readouts import LINES, MATRICES, POINTS, caption, describe, readouts
from sims.epipolar.scene import SIDE_BY_SIDE, EpipolarScene, seen, view_of
from sims.epipolar.solution import EpipolarSolution, solve
from sims.kit.paste import Paste
from sims.kit.sim import Action, Contract, Dial, Objective, Sim
from sims.kit.stereo_text import ENDINGS, read

__all__ = ["CONTRACT", "SIM", "EpipolarParams", "EpipolarSolution", "solve"]

SIM = Sim(
    slug="epipolar",
    title="Epipolar geometry",
    summary="See why a point of one picture can only be on one line of the other, and how F says which.",
    concepts=("Epipolar Geometry", "Fundamental Matrix", "Stereo Vision"),
    objectives=(
        Objective("Explain how the epipolar plane makes a line in each picture", "Understand"),
        Objective("Predict where the epipoles are from where the cameras are", "Apply"),
        Objective("Judge an F that is estimated from noisy pixels by residuals and conditioning", "Evaluate"),
    ),
    params=EpipolarParams,
    solve=solve,
    scene=EpipolarScene,
    caption=caption,
    readouts=readouts,
    folds=(MATRICES, LINES, POINTS, ESTIMATE, OWN),
    describe=describe,
    view=SIDE_BY_SIDE,
    view_of=view_of,
    seen=seen,
    panes=panes,
    dials=(
        Dial(
            "depth", "Depth along left ray", "How far P is before the left camera; it slides along the ray of p",
            ray.NEAREST, ray.FARTHEST, actions.depth, 0.05, "m",
        ),
        Dial(
            "off_line", "q′ off the line", "How far the free pixel q′ is from the line of p",
            -candidate.FARTHEST, candidate.FARTHEST, actions.off_line, 1.0, "px",
        ),
    ),
    actions=(
        Action("sweep", "Slide P along its ray", "p stays; p′ runs along its line", ray.sweep),
        Action("free", "Free p′", "A pixel q′ that leaves the line: which point in space gives it?", candidate.free),
        Action("rectified", "Rectified pair", "Side by side, same direction: level lines", actions.preset("rectified")),
        Action("clear-pick", "Clear marks", "Takes picked pixel, q′ and trail away", actions.clear),
        Action("sight", "Camera in sight", "The right camera sees the left one", actions.preset("sight"), CAMERAS),
        Action(
            "converging", "Converging pair", "Both look at the points: lines fan out", actions.preset("converging"),
            CAMERAS,
        ),
        Action(
            "forward", "Forward motion", "One behind the other: epipoles in sight", actions.preset("forward"), CAMERAS
        ),
        Action("vertical", "Vertical pair", "One above the other: upright lines", actions.preset("vertical"), CAMERAS),
        Action("new-sample", ESTIMATE_ACTION, "From 12 points, with the next noise", actions.new_sample, ESTIMATE),
    ),
    handles={
        "/point": actions.hold("point"),
        "/left_center": actions.hold("left"),
        "/right_center": actions.hold("right"),
        "left_pixel": actions.hold_pixel("left"),
        "right_pixel": actions.hold_pixel("right"),
        "pick_left": actions.hold_pick("left"),
        "pick_right": actions.hold_pick("right"),
        "depth": ray.hold,
        "candidate": candidate.hold,
        "off_line": candidate.hold_off,
        "plan_left": plan.hold("left"),
        "plan_right": plan.hold("right"),
        "plan_point": plan.hold("point"),
    },
    paste=Paste(
        OWN, "Calibration of two cameras", "K1, K2, R and T as OpenCV, Kalibr’s camchain, or both ROS files have them",
        calibration.EXAMPLE, read, calibration.changes, ENDINGS, calibration.says,
    ),
    offers=EpipolarOffers,
    challenges=CHALLENGES,
    states={
        "own pair": {
            **calibration.changes(EpipolarParams(), read(calibration.EXAMPLE)),
            "own_left": (300.0, 200.0), "show_all_lines": True,
        },
        "converging": {**actions.PRESETS["converging"], "show_all_lines": True, "points": 12},
        "forward": {**actions.PRESETS["forward"], "show_all_lines": True},
        "vertical": {**actions.PRESETS["vertical"], "show_all_lines": True},
        "picked": {"pick": "left:200,300"},
        "slid": {**actions.PRESETS["sight"], "trail": (1.5, 9.0)},
        "slid behind the right camera": {**actions.PRESETS["forward"], "trail": (0.5, 9.0)},
        "free": {"candidate": (275.0, 260.0)},
        "free on the line": {**actions.PRESETS["sight"], "candidate": (423.4, 224.0)},
        "free and parallel": {"candidate": (455.0, 210.0)},
        "free and behind": {"candidate": (500.0, 210.0)},
        "picked at the epipole": {**actions.PRESETS["forward"], "pick": "right:320,240"},
        "noise": {"points": 12, "noise": 1.0, "seed": 3},
        "eight exact points": {"points": 8},
        "zero baseline": {"left": (0.0, 0.0, 1.0), "right": (0.0, 0.0, 1.0), "pick": "left:200,300", "points": 12},
        "pure rotation": {
            "left": (0.0, 0.0, 1.0), "right": (0.0, 0.0, 1.0), "left_pan": 8, "right_pan": -8, "points": 12,
        },
        "free without a baseline": {
            "left": (0.0, 0.0, 1.0), "right": (0.0, 0.0, 1.0), "candidate": (9.0, 9.0), "trail": (1.0, 2.0),
        },
        "tiny baseline": {"left": (0.0, 0.0, 1.0), "right": (1e-6, 0.0, 1.0), "points": 12},
        "point on the baseline": {**actions.PRESETS["forward"], "point": (0.0, 4.0, 1.0)},
        "behind one": {**actions.PRESETS["forward"], "point": (0.3, 0.4, 1.2)},
        "behind both": {"point": (0.3, -2.0, 1.2)},
        "at a centre": {"point": (-0.6, 0.0, 1.0)},
        "out of the pictures": {"point": (4.0, 3.0, 3.0)},
        "epipole far away": {"left_pan": 0.001, "right_pan": -0.001},
    },
)  # fmt: skip

CONTRACT = Contract(
    parameters=(
        "left right left_pan right_pan focal point points show_plane show_all_lines pick trail candidate own own_left"
        " own_right own_size left_of_text right_of_text"
    ),
    solution=(
        "K P_left P_right F E rank singular_values epipole_left epipole_right epipole_left_pixel"
        " epipole_right_pixel pixel_left pixel_right line_left line_right residual sampson trail candidate own"
        " K_right size_left size_right"
    ),
    link=(
        "left=-0.5,0,1.2&right=0.5,0.1,1&left_pan=-10&right_pan=12.5&focal=700&point=0.2,3.5,1.1"
        "&points=9&show_plane=0&show_all_lines=1&pick=right:300,200.5"
    ),
    state={
        "left": [-0.5, 0.0, 1.2], "right": [0.5, 0.1, 1.0], "left_pan": -10.0, "right_pan": 12.5, "focal": 700.0,
        "point": [0.2, 3.5, 1.1], "points": 9, "show_plane": False, "show_all_lines": True,
        "pick": "right:300,200.5",
    },
)  # fmt: skip
