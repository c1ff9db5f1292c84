"""The bodies of the mechanism: rings, pivots and a stand, all turned on a lathe; light to send."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from itertools import pairwise

import numpy as np
import trimesh

from geometry.arrays import Array
from sims.gimbal_lock.rings import INNER, MIDDLE, OUTER, Ring
from sims.kit.scene.bodies import joined, moved

Profile = Sequence[tuple[float, float]]
FULL = (0.0, 2.0 * math.pi)
SECTIONS = 72
"""Parts of a full turn."""
DEPTH, WIDTH, CHAMFER = 0.08, 0.115, 0.016
"""Thickness of every ring: metres along its radius, across its plane, and at its edges."""
YOKE, FLOOR, SIDE = 1.42, -1.6, math.radians(200.0)
"""Radius of the stand's arm, height of its foot, and the direction of the arm from the middle."""


_QUARTER = {
    "x": trimesh.transformations.rotation_matrix(math.pi / 2, (1, 0, 0)),
    "y": trimesh.transformations.rotation_matrix(math.pi / 2, (0, 1, 0)),
    "z": np.eye(4),
}
# A ring lies in the plane of its own turning axis and of the next ring's, so that both find bearings on it.
_PLANE = {"z": _QUARTER["y"], "y": _QUARTER["z"], "x": _QUARTER["x"]}
_ALONG = {"x": _QUARTER["y"], "y": _QUARTER["x"], "z": _QUARTER["z"]}
"""Turns z to the axis (or to its opposite: all that is turned so is symmetric)."""


def lathe(
    profile: Profile, spans: Sequence[tuple[float, float]] = (FULL,), sections: int = SECTIONS
) -> trimesh.Trimesh:
    """Turn a profile (radius, z), with the body at its left, about z through spans of angles in radians.

    Edges of the profile stay sharp: its corners are there twice, once for each side.
    """
    edges = np.array([*pairwise(profile)])
    vertices: list[Array] = []
    faces: list[Array] = []
    count = 0
    for start, end in spans:
        steps = max(math.ceil(sections * (end - start) / FULL[1]), 1)
        angles = np.linspace(start, end, steps + 1)
        circle = np.column_stack([np.cos(angles), np.sin(angles)])
        for edge in edges:
            strip = np.empty((steps + 1, 2, 3))
            strip[..., :2] = circle[:, None] * edge[:, :1]
            strip[..., 2] = edge[:, 1]
            corner = count + 2 * np.arange(steps)[:, None]
            vertices.append(strip.reshape(-1, 3))
            faces += [corner + np.array(three) for three in ((0, 2, 3), (0, 3, 1))]
            count += 2 * (steps + 1)
    return trimesh.Trimesh(np.concatenate(vertices), np.concatenate(faces), process=False)


def bar(radius: float, depth: float, width: float, chamfer: float) -> Profile:
    """The closed profile of a ring: a rectangle without its corners."""
    a, b, c = depth / 2, width / 2, chamfer
    corners = [(a, c - b), (a, b - c), (a - c, b), (c - a, b), (-a, b - c), (-a, c - b), (c - a, -b), (a - c, -b)]
    return [(radius + r, z) for r, z in (*corners, corners[0])]


def rod(radius: float, low: float, high: float) -> trimesh.Trimesh:
    """A cylinder along z."""
    return lathe([(0.0, low), (radius, low), (radius, high), (0.0, high)], sections=24)


@cache
def ring(of: Ring) -> trimesh.Trimesh:
    """The ring itself, in its own frame at rest."""
    return lathe(bar(of.radius, DEPTH, WIDTH, CHAMFER)).apply_transform(_PLANE[of.letter])


@cache
def stripe(of: Ring) -> trimesh.Trimesh:
    """The ring's dashes, let into its four sides: its second cue beside its colour."""
    spans = [FULL]
    if of.dash is not None:
        count = round(FULL[1] * of.radius / sum(of.dash))
        length = FULL[1] / count * of.dash[0] / sum(of.dash)
        spans = [(k * FULL[1] / count - length / 2, k * FULL[1] / count + length / 2) for k in range(count)]
    flat = lathe(bar(of.radius, 0.3 * DEPTH, WIDTH + 0.006, 0.0), spans)
    round_ = lathe(bar(of.radius, DEPTH + 0.006, 0.22 * WIDTH, 0.0), spans)
    return joined([flat, round_]).apply_transform(_PLANE[of.letter])


@cache
def pivots(of: Ring) -> trimesh.Trimesh:
    """The two pins on which a ring turns, with caps outside what holds it. They belong to that, not to the ring."""
    holder = {"outer": YOKE, "middle": OUTER.radius, "inner": MIDDLE.radius}[of.name]
    inside, outside = of.radius - DEPTH / 2 - 0.012, holder + DEPTH / 2
    parts = [
        rod(0.026, inside, outside),
        rod(0.046, of.radius + DEPTH / 2, holder - DEPTH / 2),
        rod(0.06, outside, outside + 0.045),
    ]
    one = joined(parts)
    other = one.copy().apply_transform(trimesh.transformations.rotation_matrix(math.pi, (1, 0, 0)))
    return joined([one, other]).apply_transform(_ALONG[of.letter])


@cache
def stand() -> trimesh.Trimesh:
    """A half-round arm with bearings at top and bottom, on a column and a round foot."""
    turned = trimesh.transformations.rotation_matrix(SIDE, (0, 0, 1)) @ _QUARTER["x"]
    arm = lathe(bar(YOKE, DEPTH, 0.13, CHAMFER), [(-math.pi / 2, math.pi / 2)]).apply_transform(turned)
    bearings = [rod(0.1, at - DEPTH / 2 - 0.004, at + DEPTH / 2 + 0.004) for at in (-YOKE, YOKE)]
    column = rod(0.06, FLOOR, -YOKE)
    foot = lathe([(0.0, FLOOR), (0.62, FLOOR), (0.62, FLOOR + 0.03), (0.1, FLOOR + 0.1), (0.0, FLOOR + 0.1)])
    return joined([arm, *bearings, column, foot])


def base(length: float, width: float) -> trimesh.Trimesh:
    """A plate on the floor, long in x."""
    return moved(trimesh.creation.box((length, width, 0.06)), (0.0, 0.0, 0.03))


def mount(scale: float) -> trimesh.Trimesh:
    """What holds an aircraft of that scale in the inner ring: a strut from the ring to its belly."""
    return rod(0.022, -INNER.radius + DEPTH / 2, -0.1 * scale)
