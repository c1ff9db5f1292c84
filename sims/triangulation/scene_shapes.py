"""The point of each method: every method has a shape of its own, filled where it is the chosen one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import trimesh

from sims.kit.scene.stage import Stage
from sims.triangulation.params import Method
from sims.triangulation.solution import METHODS


def _shape(name: Method) -> trimesh.Trimesh:
    """Bodies of radius about one."""
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
    """A point, or none."""

    def __init__(self, stage: Stage, path: str, name: Method) -> None:
        self.node = stage.group(path)
        self.filled = stage.mesh(f"{path}/filled", BODIES[name], "ink", flat=name != "optimal")
        self.ghost = stage.mesh(f"{path}/ghost", BODIES[name], "ghost", flat=name != "optimal")
        self.highlighted = stage.mesh(f"{path}/lit", BODIES[name], "held", flat=name != "optimal")
        self.highlighted.show(False)
        for body in (self.filled, self.ghost, self.highlighted):
            stage.link(body, name)

    def draw(self, place: Sequence[float] | None, chosen: bool, size: float) -> None:
        """Show the point of a method; those that aren't chosen are smaller, and hide in the chosen one."""
        self.node.show(place is not None)
        if place is None:
            return
        self.node.pose(position=place)
        self.filled.show(chosen)
        self.ghost.show(not chosen)
        self.filled.scale(size)
        self.ghost.scale(0.6 * size)
        self.highlighted.scale(1.3 * size)
