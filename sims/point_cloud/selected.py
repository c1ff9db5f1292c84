"""The selected point: what was measured there, what its neighbours say, and how far another point is."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from geometry import se3
from geometry.arrays import Array
from sims.point_cloud import layers
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.derived import around, local
from sims.point_cloud.params import CloudParams
from sims.point_cloud.result import Result


@dataclass(frozen=True, eq=False)
class Selected:
    """One point: what was measured there, and what its neighbours say: normal and surface variation, or null.

    `neighbors` (k, 3) are its nearest points, itself the first, and `eigenvalues` (3,), rising, their variances in m²
    along the axes of the plane that is fitted to them: its corners (4, 3) are `plane`, null of points on a line. From
    the side, `section` (k, 2) has them along the widest of these axes and across the plane, in metres from its middle.
    `merged` says how many measured points it is the mean of; null without voxels.
    """

    index: int
    position: Array
    color: Array | None
    normal: Array | None
    intensity: float | None
    variation: float | None
    neighbors: Array
    eigenvalues: Array
    plane: Array | None
    section: Array
    merged: int | None


@dataclass(frozen=True, eq=False)
class Measured:
    """From the selected point to another one, in metres: its number, position, offset along x, y, z, and distance."""

    other: int
    position: Array
    offset: Array
    distance: float


def place(result: Result, number: int | None) -> tuple[int, Array] | None:
    """The row of the shown point of a number, and how its layer is moved: those of the first layer come first."""
    first = len(result.base.rows)
    if number is None or number >= first + len(result.marked.rows):
        return None
    if number < first:
        return int(result.base.rows[number]), np.eye(4)
    return int(result.marked.rows[number - first]), result.T


def selected(p: CloudParams, thin: Cloud, result: Result) -> Selected | None:
    """What is known of the selected point; None if there is none of that number."""
    found = place(result, p.selected)
    if found is None or p.selected is None:
        return None
    row, T = found
    near, beside = local(thin, p.neighbors), around(thin, row, p.neighbors)
    normal, variation = near.normals[row], float(near.variation[row])
    return Selected(
        index=p.selected,
        position=se3.apply(T, thin.points[row]),
        color=None if thin.colors is None else thin.colors[row],
        normal=T[:3, :3] @ normal if normal.any() else None,
        intensity=None if thin.intensity is None else float(thin.intensity[row]),
        variation=None if math.isnan(variation) else variation,
        neighbors=se3.apply(T, thin.points[beside.rows]),
        eigenvalues=beside.eigenvalues,
        plane=se3.apply(T, layers.plane_of(beside)) if beside.flat else None,
        section=(thin.points[beside.rows] - beside.center) @ beside.axes[[2, 0]].T,
        merged=None if thin.counts is None else int(thin.counts[row]),
    )


def measured(p: CloudParams, thin: Cloud, result: Result, start: Selected | None) -> Measured | None:
    """How far the other point is from the selected one, while it is measured."""
    found = place(result, p.other)
    if found is None or start is None or p.other is None or not p.measure:
        return None
    row, T = found
    end = se3.apply(T, thin.points[row])
    offset = end - start.position
    return Measured(p.other, end, offset, float(np.linalg.norm(offset)))
