"""epipolar: what two pictures of one scene have to do with each other.

Two cameras look at points. A point and both centres span the epipolar plane, which cuts each picture in a line: where
the point is in one picture, it must be on that line in the other. F says so in numbers.
"""

from __future__ import annotations

from sims.epipolar import model, plan
from sims.epipolar.hands import hold_pixel
from sims.epipolar.model import EpipolarParams
from sims.epipolar.pictures import panes
from sims.epipolar.scene import EpipolarScene
from sims.epipolar.solution import EpipolarSolution, solve
from sims.epipolar.words import describe, readouts
from sims.kit.sim import Action, Objective, Sim, View

__all__ = ["SIM", "EpipolarParams", "EpipolarSolution", "solve"]

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
    readouts=readouts,
    describe=describe,
    view=View((4.2, -3.4, 3.9), (0.1, 1.9, 1.0), 2.7),
    panes=panes,
    actions=(
        Action("rectified", "Rectified pair", "Side by side, same direction: level lines", model.preset("rectified")),
        Action("converging", "Converging pair", "Both look at the points: lines fan out", model.preset("converging")),
        Action("forward", "Forward motion", "One behind the other: epipoles in sight", model.preset("forward")),
        Action("vertical", "Vertical pair", "One above the other: upright lines", model.preset("vertical")),
        Action("new-sample", "Estimate F, new noise", "From 12 points, with the next noise", model.new_sample),
        Action("clear-pick", "Clear picked pixel", "Takes the pixel and its line away", model.clear_pick),
    ),
    handles={
        "/point": model.hold("point"),
        "/left_center": model.hold("left"),
        "/right_center": model.hold("right"),
        "left_pixel": hold_pixel("left"),
        "right_pixel": hold_pixel("right"),
        "pick_left": model.hold_pick("left"),
        "pick_right": model.hold_pick("right"),
        "plan_left": plan.hold("left"),
        "plan_right": plan.hold("right"),
        "plan_point": plan.hold("point"),
    },
    states={
        "converging": {**model.PRESETS["converging"], "show_all_lines": True, "points": 12},
        "forward": {**model.PRESETS["forward"], "show_all_lines": True},
        "vertical": {**model.PRESETS["vertical"], "show_all_lines": True},
        "picked": {"pick": "left:200,300"},
        "picked at the epipole": {**model.PRESETS["forward"], "pick": "right:320,240"},
        "noise": {"points": 12, "noise": 1.0, "seed": 3},
        "eight exact points": {"points": 8},
        "zero baseline": {"left": (0.0, 0.0, 1.0), "right": (0.0, 0.0, 1.0), "pick": "left:200,300", "points": 12},
        "pure rotation": {
            "left": (0.0, 0.0, 1.0), "right": (0.0, 0.0, 1.0), "left_pan": 8, "right_pan": -8, "points": 12,
        },
        "tiny baseline": {"left": (0.0, 0.0, 1.0), "right": (1e-6, 0.0, 1.0), "points": 12},
        "point on the baseline": {**model.PRESETS["forward"], "point": (0.0, 4.0, 1.0)},
        "behind one": {**model.PRESETS["forward"], "point": (0.3, 0.4, 1.2)},
        "behind both": {"point": (0.3, -2.0, 1.2)},
        "at a centre": {"point": (-0.6, 0.0, 1.0)},
        "out of the pictures": {"point": (4.0, 3.0, 3.0)},
        "epipole far away": {"left_pan": 0.001, "right_pan": -0.001},
    },
)  # fmt: skip
