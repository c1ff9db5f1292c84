"""The point of each method: every method has a shape of its own, filled where it is the chosen one."""

from __future__ import annotations

import numpy as np
import trimesh

from geometry.arrays import Array
from sims.kit.stage import Stage
from sims.triangulation.model import METHODS, Method


def _shape(name: Method) -> trimesh.Trimesh:
    """Of radius about one."""
    body: trimesh.Trimesh
    if name == "dlt":
        body = trimesh.creation.box((1.6, 1.6, 1.6))
    elif name == "midpoint":
        body = trimesh.convex.convex_hull(1.5 * np.concatenate([np.eye(3), -np.eye(3)]))
    else:
        body = trimesh.creation.icosphere(subdivisions=3, radius=1.0)
    return body


BODIES = {name: _shape(name) for name in METHODS}


class Shape:
    """A point, or none; drawn `times` as far from `origin` as it is."""

    def __init__(self, stage: Stage, path: str, name: Method) -> None:
        self.node = stage.group(path)
        self.filled = stage.mesh(f"{path}/filled", BODIES[name], "ink", flat=name != "optimal")
        self.ghost = stage.mesh(f"{path}/ghost", BODIES[name], "ghost", flat=name != "optimal")

    def draw(
        self, point: Array | None, chosen: bool, size: float, origin: Array | float = 0.0, times: float = 1.0
    ) -> None:
        """Show the point of a method; those that aren't chosen are smaller, and hide in the chosen one."""
        self.node.show(point is not None)
        if point is None:
            return
        self.node.pose(position=(times * (point - origin)).tolist())
        self.filled.show(chosen)
        self.ghost.show(not chosen)
        self.filled.scale(size)
        self.ghost.scale(0.6 * size)
