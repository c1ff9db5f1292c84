"""point-cloud: clouds of points, their attributes, and the operations everybody uses on them."""

from __future__ import annotations

from functools import partial

from sims.kit.sim import Action, Contract, Files, Objective, Sim
from sims.point_cloud import actions
from sims.point_cloud.captions import caption
from sims.point_cloud.challenges import CHALLENGES
from sims.point_cloud.datasets import DATASETS, dataset
from sims.point_cloud.download import ply
from sims.point_cloud.files import FORMATS
from sims.point_cloud.library import Library
from sims.point_cloud.offers import CloudOffers
from sims.point_cloud.panes import panes
from sims.point_cloud.params import CHOSEN, OWN, VIEWS, CloudParams, view_of
from sims.point_cloud.readouts import BOX, ORIGIN, RESULT, describe, preview, readouts
from sims.point_cloud.scene import CloudScene
from sims.point_cloud.solution import CloudSolution, solve

__all__ = ["CONTRACT", "SIM", "CloudParams", "CloudSolution", "solve"]

SIM = Sim(
    slug="point-cloud",
    title="Point cloud",
    summary="Look into scans of many thousand points: thin them, colour them, and find surfaces, things and motions.",
    concepts=("Point Clouds", "Voxel Grid", "Normals", "Registration (ICP)"),
    objectives=(
        Objective("Read the attributes of points: position, colour, intensity and normal", "Understand"),
        Objective("Thin a cloud with voxels, and say what is lost", "Apply"),
        Objective("Choose parameters that part ground, things and outliers", "Analyze"),
        Objective("Judge a registration by its error, its fitness and what the data leave open", "Evaluate"),
    ),
    params=CloudParams,
    solve=solve,
    scene=CloudScene,
    caption=caption,
    readouts=readouts,
    folds=(RESULT, CHOSEN, BOX, ORIGIN,),
    describe=describe,
    view=VIEWS["room"],
    view_of=view_of,
    panes=panes,
    actions=(
        Action("grow", "Grow the cells", "Growing voxels: how few points keep the shape?", actions.grow),
        Action("play", "Play", "The process from its start; without one, growing voxels", actions.play),
        Action("step", "Next step", "The process one step on; from the last one back to its start", actions.next_step),
    ),
    handles={"/second": actions.hold},
    clicks={"/cloud": actions.pick},
    under=actions.under,
    challenges=CHALLENGES,
    states={
        "street": {"dataset": "street", "color": "intensity"},
        "street without colours": {"dataset": "street", "color": "rgb"},
        "statue": {"dataset": "statue", "color": "height"},
        "two scans": {"dataset": "two-scans"},
        "voxels": {"voxel_size": 0.1, "color": "height", "point_size": 4.0},
        "one voxel a metre": {"voxel_size": 1.0, "show_normals": True, "color": "normals", "point_size": 8.0},
        "normals": {"voxel_size": 0.05, "show_normals": True, "color": "normals"},
        "variation": {"dataset": "statue", "color": "variation", "selected": 20_000},
        "selected": {"selected": 50_000, "show_box": False},
        "measured": {"voxel_size": 0.2, "selected": 10, "measure": True, "other": 900},
        "cells": {"voxel_size": 0.15, "selected": 1_000, "show_box": False},
        "no such point": {"selected": 5_000_000},
        "ground marked": {"process": "ground", "step": 1},
        "things on the street": {"dataset": "street", "process": "clusters", "show_box": False, "voxel_size": 0.1},
        "outliers marked": {"dataset": "statue", "process": "outliers", "step": 1},
        "scans apart": {"dataset": "two-scans", "process": "register", "step": 0},
        "scans together": {"dataset": "two-scans", "process": "register", "step": 40},
        "far apart": {"dataset": "two-scans", "process": "register", "turn": 90.0, "step": 40},
        "out of reach": {"dataset": "two-scans", "process": "register", "shift": (30.0, 0.0, 0.0), "step": 40},
        "points to points": {"dataset": "two-scans", "process": "register", "step": 7, "method": "point"},
        "point of the moving scan": {"dataset": "two-scans", "process": "register", "step": 2, "selected": 150_000},
        "statue's surface": {"dataset": "statue", "process": "surface", "step": 2},
        "no surface": {"dataset": "statue", "process": "surface", "distance": 0.01, "voxel_size": 0.1},
        "file that is gone": {"dataset": "file", "file": "upload-gone", "process": "surface"},
        "nothing left": {"process": "clusters", "step": 1, "voxel_size": 1.0},
    },
    files=Files(OWN, tuple(FORMATS), Library, "columns", preview),
    offers=CloudOffers,
    downloads={"point-cloud.ply": ply},
    heavy=True,
    ahead=[partial(dataset, name) for name in DATASETS],
)  # fmt: skip

CONTRACT = Contract(
    parameters="dataset color point_size voxel_size show_normals neighbors show_box selected process step",
    solution="points_in points_out minimum maximum dimensions selected",
    link=(
        "dataset=statue&color=height&point_size=3&voxel_size=0.05&show_normals=1&neighbors=20"
        "&show_box=0&selected=12&process=outliers&step=1"
    ),
    state={
        "dataset": "statue", "color": "height", "point_size": 3.0, "voxel_size": 0.05, "show_normals": True,
        "neighbors": 20, "show_box": False, "selected": 12, "process": "outliers", "step": 1,
    },
)  # fmt: skip
