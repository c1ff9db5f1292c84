"""camera: K, [R | t] and P, and what projection loses.

One camera, drawn as it is, looks at a street; its picture stands in front of it and beside the scene. Every point with
a name is followed from the world to its pixel.
"""

from __future__ import annotations

from sims.camera import actions, calibration
from sims.camera.challenges import CHALLENGES
from sims.camera.panes import panes
from sims.camera.params import OWN, POSE, CameraParams
from sims.camera.readouts import ALL, MATRIX, WORKED, caption, describe, readouts
from sims.camera.scene import CameraScene, seen
from sims.camera.solution import CameraSolution, solve
from sims.camera.window import USUAL, view
from sims.kit.paste import Paste
from sims.kit.sim import Action, Contract, Objective, Sim

__all__ = ["CONTRACT", "SIM", "CameraParams", "CameraSolution", "solve"]

SIM = Sim(
    slug="camera",
    title="Camera",
    summary="Move, turn and zoom a camera, and follow points from the world through K [R | t] to their pixels.",
    concepts=("Camera model", "Intrinsics and extrinsics", "Perspective"),
    objectives=(
        Objective("Compute the pixel of a point from K, R and t, step by step", "Apply"),
        Objective("Tell what each of fx, fy, cx, cy, skew, position and angles does to the picture", "Understand"),
        Objective("Say what projection loses, and when a picture without perspective comes near", "Analyze"),
    ),
    params=CameraParams,
    solve=solve,
    scene=CameraScene,
    caption=caption,
    readouts=readouts,
    folds=(WORKED, ALL, MATRIX,),
    describe=describe,
    view=USUAL,
    view_of=view,
    seen=seen,
    panes=panes,
    actions=(
        Action(
            "dolly-zoom", "Dolly zoom", "Move and zoom together, so that the house stays as tall in the picture",
            actions.dolly_zoom,
        ),
        Action("look", "Look at the house", "Turn the camera to the middle of the house", actions.look, POSE),
    ),
    paste=Paste(
        group=OWN,
        title="Calibration",
        about="What OpenCV, ROS (camera_info) or Kalibr wrote of a camera: its matrix, picture size and distortion",
        example=calibration.EXAMPLE,
        read=calibration.read,
        changes=calibration.changes,
        endings=(".yaml", ".yml", ".xml", ".json", ".txt"),
    ),
    handles={"/eye": actions.hold_eye, "/look": actions.hold_look, "principal": actions.hold_principal},
    challenges=CHALLENGES,
    states={
        "orthographic": {"projection": "orthographic"},
        "weak perspective": {"projection": "weak", "selected": "far-post"},
        "off centre and skewed": {"cx": 120, "cy": 400, "skew": 150, "fy": 900, "selected": "near-post"},
        "behind": {"selected": "back-post"},
        "outside": {"selected": "far-post", "pan": 40},
        "looking back": {"pan": 180},
        "no scale": {"projection": "weak", "position": (0.0, 20.0, 1.2)},
        "orthographic from behind": {"projection": "orthographic", "pan": 180},
        "through": {"through": True, "pan": 10, "roll": 20, "cx": 200},
        "through, orthographic": {"through": True, "projection": "orthographic", "tilt": -15},
        "barrel": {"k1": -0.3, "k2": 0.08, "p1": 0.001},
        "cushion": {"k1": 0.4, "fx": 400, "fy": 400},
        "a photograph": {"width": 4000, "height": 3000, "fx": 4708, "fy": 4712, "cx": 1987, "cy": 1510, "k1": -0.05},
        "straight down": {"position": (-1.0, 1.0, 8.0), "tilt": -90, "selected": "cube-left"},
        "in the house": {"position": (-1.47, 1.6, 0.9), "fx": 300, "fy": 300, "selected": "roof-far"},
        "in the camera's plane": {"position": (0.0, -0.6, 1.2), "selected": "cube-left"},
        "centre on a point": {"position": (-1.0, 1.0, 0.0), "pan": 90},
        "rolled": {"roll": 30, "tilt": 15},
        "nothing in front": {"position": (0.0, 20.0, 1.2)},
        "seen along the street": {"projection": "orthographic", "pan": -15},
    },
)  # fmt: skip

CONTRACT = Contract(
    parameters=(
        "fx fy cx cy skew width height ortho_scale k1 k2 p1 p2 k3 position pan tilt roll projection through show_rays"
        " show_frustum"
    ),
    solution="K R t P center fov_x fov_y points scale scale_depth distorted",
    link=(
        "fx=800&fy=700&cx=300&cy=200&skew=10&position=1,-5.5,2&pan=20&tilt=-10&roll=5&projection=weak"
        "&show_rays=0&show_frustum=0"
    ),
    state={
        "fx": 800.0, "fy": 700.0, "cx": 300.0, "cy": 200.0, "skew": 10.0, "position": [1.0, -5.5, 2.0],
        "pan": 20.0, "tilt": -10.0, "roll": 5.0, "projection": "weak", "show_rays": False, "show_frustum": False,
    },
)  # fmt: skip
