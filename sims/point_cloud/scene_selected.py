"""About the selected point: what its normal follows from, the cell whose mean it is, and the way to another point."""

from __future__ import annotations

import numpy as np

from geometry.arrays import Array
from sims.kit.readout import quantity
from sims.kit.scene.nodes import Cloud
from sims.kit.scene.stage import Stage
from sims.point_cloud.layers import Cells
from sims.point_cloud.solution import CloudSolution


class About:
    """Its nearest points with the plane through them; the cells of a thinned cloud; a measured distance."""

    def __init__(self, stage: Stage) -> None:
        self.node = stage.group("/near")
        self.node.show(False)
        self.near: Cloud = stage.cloud("/near/points", "held")
        self.plane = stage.sheet("/near/plane", "held", opacity=0.35)
        self.rim = stage.lines("/near/rim", "held", width=2.0)
        stage.linked("neighbors", self.near, self.rim)
        self.cells = CellsInScene(stage, "/cells", "held")
        self.way = stage.lines("/measured", "ink", width=3.0)
        self.length = stage.label("/measured/length", "", anchor="bottom-center")
        stage.linked("measure", self.way)
        stage.linked("other", self.way)

    def draw(self, s: CloudSolution, size: float, dot: float) -> None:
        """`size` of its neighbours' dots, and of each `dot` that was merged, in metres."""
        self._plane(s, size)
        self.cells.draw(s.drawn.cells, dot)
        self._distance(s)

    def _plane(self, s: CloudSolution, size: float) -> None:
        chosen = s.selected
        self.node.show(chosen is not None)
        if chosen is not None:
            self.near.points(chosen.neighbors)
            self.near.size(size)
            self._fitted(chosen.plane)

    def _fitted(self, corners: Array | None) -> None:
        self.plane.vertices(corners)
        self.rim.show(corners is not None)
        if corners is not None:
            self.rim.path(corners[[0, 1, 2, 3, 0]])

    def _distance(self, s: CloudSolution) -> None:
        found = s.measured
        ends = None if found is None or s.selected is None else np.array([s.selected.position, found.position])
        self.way.stroke(None if ends is None else ends.tolist())
        self.length.say(None if found is None else quantity(found.distance, "m"))
        if ends is not None:
            self.length.pose(position=ends.mean(axis=0).tolist())


class CellsInScene:
    """The cell of a point, in a colour of the palette, with those near it and what was measured in them."""

    def __init__(self, stage: Stage, name: str, role: str) -> None:
        self.own = stage.lines(f"{name}/own", role, width=2.5)
        self.others = stage.lines(f"{name}/near", "ghost", width=1.0)
        self.merged: Cloud = stage.cloud(f"{name}/points", "ink")
        stage.linked("voxel_size", self.own, self.others)
        self.draw(None, 1.0)

    def draw(self, cells: Cells | None, dot: float) -> None:
        """Show them, with dots of a size in metres; or hide them."""
        self.own.pieces(None if cells is None else cells.own)
        self.others.pieces(None if cells is None else cells.near)
        self.merged.show(cells is not None)
        if cells is not None:
            self.merged.points(cells.points)
            self.merged.size(dot)
