"""triangulation: a 3D point from its places in two pictures, and how sure it is.

Two parallel cameras stand at a height of 1 m and look along +Y, or in their place a stereo pair of somebody's. Each
picture gives a ray; three methods say where the rays meet, or nearly meet, and noise in the pixels says how far that
may be from the truth.
"""

from __future__ import annotations

from sims.kit.paste import Paste
from sims.kit.sim import Action, Contract, Objective, Sim, Typed
from sims.kit.stereo_text import ENDINGS
from sims.kit.view import View
from sims.triangulation import actions, calibration
from sims.triangulation.captions import caption
from sims.triangulation.challenges import CHALLENGES
from sims.triangulation.offers import TriangulationOffers
from sims.triangulation.panes import panes
from sims.triangulation.params import FARTHEST, IMAGES, NEAREST, RIG, SURENESS, TriangulationParams
from sims.triangulation.readouts import EQUATIONS, METHODS, describe, readouts
from sims.triangulation.scene import TriangulationScene, seen
from sims.triangulation.solution import TriangulationSolution, solve

TOE_IN = calibration.toe_in(TriangulationParams())

__all__ = ["CONTRACT", "SIM", "TriangulationParams", "TriangulationSolution", "solve"]

SIM = Sim(
    slug="triangulation",
    title="Triangulation",
    summary="Find a point in space from its places in two pictures, by three methods, and see how sure it is.",
    concepts=("Triangulation", "Stereo Vision", "Uncertainty"),
    objectives=(
        Objective("Reconstruct a point from two pixels, and compare DLT, mid-point and optimal triangulation", "Apply"),
        Objective("Explain how baseline, focal length and depth set the uncertainty of the depth", "Understand"),
        Objective("Tell parallel and diverging rays from small errors, and say why they give no point", "Analyze"),
    ),
    params=TriangulationParams,
    solve=solve,
    scene=TriangulationScene,
    caption=caption,
    readouts=readouts,
    folds=(IMAGES, METHODS, EQUATIONS, SURENESS, RIG),
    describe=describe,
    view=View((3.8, -2.2, 3.4), (0.1, 2.0, 1.35), 2.5),
    seen=seen,
    panes=panes,
    actions=(
        Action("new-sample", "New sample", "Noise of the next seed; turns noise on if it is off", actions.new_sample),
        Action("noise", "Noise on or off", "Noise of 1 px on both points, or none", actions.switch_noise),
        Action(
            "middlebury", "Middlebury", "Two still cameras indoors, with differing principal points (Adirondack)",
            calibration.middlebury, group=RIG,
        ),
        Action("kitti", "KITTI", "Two cameras on the roof of a car", calibration.kitti, group=RIG),
        Action(
            "toe-in", "Toe-in pair", "Two unlike cameras, each turned by 15° to the other’s side", calibration.toe_in,
            group=RIG,
        ),
        Action("parallel", "The sim’s own", "The two parallel cameras as they open", calibration.parallel, group=RIG),
    ),
    selects="method",
    paste=Paste(
        group=RIG,
        title="A stereo pair of your own",
        about=(
            "What a calibration says: K1, K2, R and T as OpenCV has them, Kalibr’s camchain, both ROS files,"
            " Middlebury’s calib.txt, or KITTI’s calib_cam_to_cam.txt. Rectified or not"
        ),
        example=calibration.EXAMPLE,
        read=calibration.read,
        changes=calibration.changes,
        endings=ENDINGS,
        says=calibration.says,
    ),
    offers=TriangulationOffers,
    handles={
        "/point": actions.hold_point, "left_uv": actions.hold_left, "right_uv": actions.hold_right,
        "depth": actions.hold_depth,
    },
    typed=(
        Typed(
            "/point", "3D point", "Sets both image points exactly, as dragging the point in the scene does",
            NEAREST, FARTHEST, actions.held_point,
        ),
    ),
    challenges=CHALLENGES,
    states={
        "toe-in pair": TOE_IN,
        "toe-in pair, noise": {**TOE_IN, "noise": 1.0, "seed": 3},
        "toe-in pair, rays miss": {**TOE_IN, "right_uv": (1290.0, 480.0), "method": "optimal"},
        "toe-in pair, behind": {**TOE_IN, "left_uv": (100.0, 540.0), "right_uv": (1200.0, 400.0)},
        "rays miss": {"right_uv": (320, 222), "method": "optimal"},
        "noise": {"noise": 1.0, "seed": 3},
        "much noise": {"noise": 5.0, "baseline": 0.3, "method": "midpoint"},
        "parallel rays": {"right_uv": (410, 210)},
        "diverging rays": {"right_uv": (450, 210)},
        "behind, rays miss": {"right_uv": (430, 225), "method": "optimal"},
        "no disparity, rays miss": {"right_uv": (410, 214)},
        "no disparity, rays miss, mid-point": {"right_uv": (410, 214), "method": "midpoint"},
        "almost parallel": {"right_uv": (409.5, 210)},
        "parallel to rounding": {"right_uv": (409.999999999, 210)},
        "tiny baseline": {"baseline": 0.05, "left_uv": (357.5, 210), "right_uv": (350, 210), "noise": 0.5},
        "near": {"left_uv": (639, 240), "right_uv": (0, 240)},
        "noise makes rays parallel": {"right_uv": (409, 210), "noise": 5.0},
    },
)  # fmt: skip

CONTRACT = Contract(
    parameters=(
        "baseline focal left_uv right_uv noise seed method hold width height cx cy doffs own own_size left_of_text"
        " right_of_text"
    ),
    solution=(
        "point by_method ray_gap closest_points disparity depth_from_disparity covariance"
        " ellipsoid_axes parallax_angle in_front ray_angle point_angle equations singular_values least_vector"
        " depth point_left size_left size_right K_left K_right F"
    ),
    link="baseline=1.2&focal=800&left_uv=400,200&right_uv=300,201.5&noise=0.5&seed=7&method=optimal",
    state={
        "baseline": 1.2, "focal": 800.0, "left_uv": [400.0, 200.0], "right_uv": [300.0, 201.5], "noise": 0.5,
        "seed": 7, "method": "optimal",
    },
)  # fmt: skip
