"""The parts of the arm as meshes, in metres for an arm of the usual size."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import trimesh
from trimesh.creation import annulus, box, cylinder

from sims.kit.scene.bodies import joined, moved

FLOOR = -1.0
"""Height of the floor; the base, where the world's origin is, stands on a column."""
GRIPPER = 0.2
"""Length that the gripper takes of the last link."""
AXLE = 0.19
"""Half the length of a joint's axle."""

END = 0.42
"""Length of the axes of the end effector's frame."""
ARROW = 0.013
"""Radius of an arrow's shaft."""
AXES = np.stack([np.zeros((3, 3)), np.eye(3)], axis=1)
"""Tails and tips of a frame's axes."""


@lru_cache(maxsize=1)
def link() -> trimesh.Trimesh:
    """Two tapered rails from x = −1 to 0, one above the other: what is between them stays in sight."""
    return joined([_rail(side) for side in (-1.0, 1.0)])


@lru_cache(maxsize=1)
def grasp() -> trimesh.Trimesh:
    """What a hand takes of a link: both rails, and what is between them."""
    hull: trimesh.Trimesh = link().convex_hull
    return hull


def _rail(side: float) -> trimesh.Trimesh:
    corners = [
        (x, y * width, side * height + z * thick)
        for x, width, height, thick in ((-1.0, 0.055, 0.078, 0.02), (0.0, 0.035, 0.052, 0.015))
        for y in (-1, 1)
        for z in (-1, 1)
    ]
    rail: trimesh.Trimesh = trimesh.convex.convex_hull(np.array(corners))
    return rail


@lru_cache(maxsize=1)
def bearing() -> trimesh.Trimesh:
    """The ring of a joint about z, with its axle."""
    ring = annulus(r_min=0.082, r_max=0.12, height=0.1, sections=40)
    axle = cylinder(radius=0.014, height=2.0 * AXLE, sections=16)
    return joined([ring, axle])


@lru_cache(maxsize=1)
def sleeve() -> trimesh.Trimesh:
    """The square sleeve of a joint that slides along z: four walls, open at both ends."""
    wall = [box((0.2, 0.035, 0.17)), box((0.035, 0.13, 0.17))]
    places = ((0.0, 0.0825, 0.0), (0.0, -0.0825, 0.0)), ((0.0825, 0.0, 0.0), (-0.0825, 0.0, 0.0))
    return joined([moved(each.copy(), at) for each, ends in zip(wall, places, strict=True) for at in ends])


@lru_cache(maxsize=1)
def flange() -> trimesh.Trimesh:
    """A disc, where two links are fixed to each other."""
    disc: trimesh.Trimesh = cylinder(radius=0.07, height=0.06, sections=32)
    return disc


@lru_cache(maxsize=1)
def post() -> trimesh.Trimesh:
    """A rod from z = 0 to 1: what leads along a joint's axis."""
    return moved(cylinder(radius=0.035, height=1.0, sections=20), (0.0, 0.0, 0.5))


@lru_cache(maxsize=1)
def gripper() -> dict[str, trimesh.Trimesh]:
    """Two fingers round the origin that point along x, on a palm; the finger at +y is the `mark`."""
    stem = cylinder(radius=0.04, height=0.05, sections=24)
    stem.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (0, 1, 0)))
    moved(stem, (-GRIPPER + 0.02, 0.0, 0.0))
    palm = moved(box((0.035, 0.17, 0.08)), (-0.145, 0.0, 0.0))
    return {"hand": joined([stem, palm, _finger(-1.0)]), "mark": _finger(1.0)}


def _finger(side: float) -> trimesh.Trimesh:
    base = [(-0.15, side * y, z) for y in (0.05, 0.085) for z in (-0.03, 0.03)]
    tip = [(0.035, side * y, z) for y in (0.045, 0.06) for z in (-0.018, 0.018)]
    finger: trimesh.Trimesh = trimesh.convex.convex_hull(np.array(base + tip))
    return finger


@lru_cache(maxsize=1)
def column() -> trimesh.Trimesh:
    """A column of height 1 that tapers up to the origin."""
    turns = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
    rings = [
        np.column_stack([radius * np.cos(turns), radius * np.sin(turns), np.full(48, height)])
        for radius, height in ((0.13, -1.0), (0.085, 0.0))
    ]
    body: trimesh.Trimesh = trimesh.convex.convex_hull(np.concatenate(rings))
    return body


@lru_cache(maxsize=1)
def foot() -> trimesh.Trimesh:
    """What the column stands on."""
    return moved(cylinder(radius=0.3, height=0.05, sections=48), (0.0, 0.0, FLOOR + 0.025))


def axes() -> list[tuple[str, tuple[float, float, float], tuple[float, float, float]]]:
    """Role and ends of the pieces of a frame of length 1: x solid, y in long dashes, z in short ones."""
    pieces = []
    for axis, on, off in (("x", 1.0, 0.0), ("y", 0.22, 0.1), ("z", 0.08, 0.08)):
        unit = np.eye(3)["xyz".index(axis)]
        for start in np.arange(0.0, 0.999, on + off):
            a, b = (tuple((t * unit).tolist()) for t in (start, min(start + on, 1.0)))
            pieces.append((axis, a, b))
    return pieces
