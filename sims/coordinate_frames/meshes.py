"""A small car to stand for the world, and a hand for the rule; both low in polygons."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
import trimesh
from trimesh.creation import capsule, cylinder

from sims.kit.scene.bodies import joined, moved

Corners = Sequence[tuple[float, float, float]]
CURL = (40.0, 30.0, 20.0)
"""Degrees that the three joints of a finger bend when it has swept from X to Y."""
SEGMENTS = (0.21, 0.16)
"""Lengths of a finger from the knuckle to its second and its third joint."""
TIPS = (0.12, 0.16, 0.13, 0.08)
PITCH = 0.088
"""Distance from finger to finger."""


def _hull(corners: Corners) -> trimesh.Trimesh:
    hull: trimesh.Trimesh = trimesh.convex.convex_hull(np.array(corners))
    return hull


def _tapered(outline: Sequence[tuple[float, float, float]]) -> trimesh.Trimesh:
    """A body of corners (x, half-width, z), the same at its left and right."""
    return _hull([(x, side * y, z) for x, y, z in outline for side in (-1.0, 1.0)])


@lru_cache(maxsize=1)
def car() -> dict[str, trimesh.Trimesh]:
    """A car 1.7 long, nose +X, left side +Y, its roof just below z = 0 and its wheels' feet at z = −0.66.

    `body`, `glass`, `tyres`, and `trim`: lamps, hubs and bumpers.
    """
    lower = _tapered(
        [
            (-0.84, 0.34, -0.5), (-0.86, 0.37, -0.4), (-0.8, 0.36, -0.26), (0.36, 0.37, -0.26), (0.8, 0.34, -0.33),
            (0.86, 0.34, -0.42), (0.84, 0.32, -0.52), (-0.7, 0.36, -0.54), (0.7, 0.36, -0.54),
        ]
    )  # fmt: skip
    glass = _tapered([(-0.7, 0.34, -0.27), (0.36, 0.34, -0.27), (0.06, 0.275, -0.07), (-0.5, 0.275, -0.07)])
    roof = _tapered([(-0.53, 0.285, -0.075), (0.07, 0.285, -0.075), (0.02, 0.25, -0.03), (-0.46, 0.25, -0.03)])
    pillar = _tapered([(-0.2, 0.346, -0.27), (-0.12, 0.346, -0.27), (-0.14, 0.283, -0.07), (-0.2, 0.283, -0.07)])
    wheels = [(x, side * 0.33, -0.5) for x in (-0.52, 0.52) for side in (-1.0, 1.0)]
    tyres = [_wheel(place, 0.16, 0.13) for place in wheels]
    hubs = [_wheel(place, 0.085, 0.14) for place in wheels]
    lamps = [
        _hull([(0.79, y - 0.07, -0.35), (0.79, y + 0.07, -0.35), (0.865, y - 0.06, -0.36), (0.865, y + 0.06, -0.36),
               (0.872, y - 0.06, -0.42), (0.872, y + 0.06, -0.42), (0.79, y, -0.43)])
        for y in (-0.24, 0.24)
    ]  # fmt: skip
    return {
        "body": joined([lower, roof, pillar]),
        "glass": glass,
        "tyres": joined(tyres),
        "trim": joined([*hubs, *lamps]),
    }


def _wheel(centre: tuple[float, float, float], radius: float, width: float) -> trimesh.Trimesh:
    wheel: trimesh.Trimesh = cylinder(radius=radius, height=width, sections=24)
    wheel.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (1, 0, 0)))
    return moved(wheel, centre)


@lru_cache(maxsize=2)
def hand(*, left: bool) -> dict[str, trimesh.Trimesh]:
    """A hand at a Z axis, its knuckles at the origin of its fingers: fingers +X, the palm towards +Y, the thumb up Z.

    `palm`, `thumb`, and the three parts of its fingers, `near`, `middle` and `far`, each from its own joint along X.
    The left hand is the right one in a mirror that turns Z round.
    """
    low = -3.6 * PITCH
    palm = joined(
        [
            _rounded([(-0.37, 0.0, -0.04), (0.0, 0.0, -0.03), (0.0, 0.0, low), (-0.35, 0.0, low + 0.04)], 0.065),
            _rounded([(x, 0.0, z) for x in (-0.32, -0.55) for z in (-0.1, low + 0.1)], 0.052),
            _rounded([(-0.32, 0.01, -0.07), (-0.23, 0.07, 0.08)], 0.055),
        ]
    )
    places = [(-0.045 - k * PITCH, length) for k, length in enumerate(TIPS)]
    parts = {
        "palm": palm,
        "thumb": _rounded([(-0.23, 0.07, 0.08), (-0.22, 0.07, 0.31)], 0.048),
        "near": joined([_finger(z, SEGMENTS[0]) for z, _ in places]),
        "middle": joined([_finger(z, SEGMENTS[1]) for z, _ in places]),
        "far": joined([_finger(z, length) for z, length in places]),
    }
    return {name: _mirrored(part) if left else part for name, part in parts.items()}


def _rounded(corners: Corners, radius: float) -> trimesh.Trimesh:
    """The hull of balls at the corners."""
    ball = trimesh.creation.icosphere(subdivisions=1, radius=radius).vertices
    return _hull(np.concatenate([ball + corner for corner in np.array(corners)]).tolist())


def _finger(z: float, length: float) -> trimesh.Trimesh:
    part: trimesh.Trimesh = capsule(height=length, radius=0.04, count=[10, 8])
    part.apply_transform(trimesh.transformations.rotation_matrix(np.pi / 2, (0, 1, 0)))
    return moved(part, (length / 2, 0.0, z))


def _mirrored(part: trimesh.Trimesh) -> trimesh.Trimesh:
    return trimesh.Trimesh(part.vertices * (1.0, 1.0, -1.0), part.faces[:, ::-1], process=False)


@lru_cache(maxsize=1)
def arrow_head() -> trimesh.Trimesh:
    """The head of an arrow that ends at the origin and points along +Y."""
    head: trimesh.Trimesh = moved(trimesh.creation.cone(radius=0.05, height=0.13, sections=24), (0.0, 0.0, -0.13))
    head.apply_transform(trimesh.transformations.rotation_matrix(-np.pi / 2, (1, 0, 0)))
    return head
