"""Axes as they are drawn, their planes, and the box of a point's coordinates in them."""

from __future__ import annotations

import numpy as np

from geometry.arrays import Array
from sims.coordinate_frames.conventions import Drawn
from sims.kit.palette import AXES, DASHES
from sims.kit.scene.stage import Stage
from sims.kit.types import IDENTITY, ORIGIN, Place, Quaternion

BEYOND = 0.13
"""How far beyond its axis a letter stands."""
RADIUS, LIT_RADIUS, DIM_RADIUS = 0.02, 0.034, 0.012
"""Radii of an axis, of one that the rule is at, and of the others then."""
Z_ROUND: Quaternion = (0.0, 1.0, 0.0, 0.0)


class AxesFigure:
    """A convention's axes. What belongs to Z hangs on a node of its own, which turns round for left-handed axes."""

    MARK = ""

    def __init__(self, stage: Stage, name: str) -> None:
        self.node = stage.group(name)
        self.third = stage.group(f"{name}/third")
        paths = (name, name, f"{name}/third")
        self.letters = [
            stage.label(f"{path}/letter_{a}", a.upper() + self.MARK) for a, path in zip(AXES, paths, strict=True)
        ]
        self.shafts(stage, [f"{path}/{axis}" for axis, path in zip(AXES, paths, strict=True)])

    def shafts(self, stage: Stage, names: list[str]) -> None:
        self.arrows = [stage.arrows(name, axis, radius=RADIUS) for axis, name in zip(AXES, names, strict=True)]
        stage.linked("convention", *self.arrows)

    def reach(self, k: int, tip: Place) -> None:
        self.arrows[k].between((ORIGIN, tip))

    def draw(self, drawn: Drawn, length: float) -> None:
        """From the node's origin; Z is shorter while it changes sides."""
        self.node.pose(drawn.wxyz)
        self.third.pose(IDENTITY if drawn.side >= 0.0 else Z_ROUND)
        height = max(abs(drawn.side), 0.01) * length
        for k, (letter, tip) in enumerate(zip(self.letters, _along_axes(length, height), strict=True)):
            self.reach(k, tip)
            letter.pose(position=_along_axes(length + BEYOND, height + BEYOND)[k])

    def light(self, lit: str | None) -> None:
        """Make one axis thick and the others thin."""
        for axis, arrow in zip(AXES, self.arrows, strict=True):
            arrow.thickness(RADIUS if lit is None else LIT_RADIUS if axis == lit else DIM_RADIUS)


class GhostAxes(AxesFigure):
    """Those of the second frame: thin, and dashed."""

    MARK = "′"

    def shafts(self, stage: Stage, names: list[str]) -> None:
        self.lines = [stage.lines(n, a, width=2.5, dash=DASHES[a]) for a, n in zip(AXES, names, strict=True)]
        stage.linked("to", *self.lines)

    def reach(self, k: int, tip: Place) -> None:
        self.lines[k].path((ORIGIN, tip))


def _along_axes(length: float, height: float) -> tuple[Place, Place, Place]:
    return (length, 0.0, 0.0), (0.0, length, 0.0), (0.0, 0.0, height)


class Grid:
    """The plane of two axes: faint lines along each in its colour, and a strong one through the point's foot."""

    def __init__(self, stage: Stage, name: str, first: int, second: int, size: float = 1.5, cell: float = 0.5) -> None:
        self.offsets, self.size = np.arange(-size, size + 0.5 * cell, cell), size
        self.node = stage.strokes(name, [AXES[first], AXES[second]] * len(self.offsets), width=1.0, faint=True)
        both = [self._lines(first, second, self.offsets), self._lines(second, first, self.offsets)]
        self.node.draw(np.stack(both, axis=1).reshape(-1, 2, 3))
        # With all three there is one along each axis.
        self.along, self.at = (second, first) if (first, second) == (0, 2) else (first, second)
        self.through = stage.strokes(f"{name}/through", [AXES[self.along]], width=3.0)

    def _lines(self, along: int, at: int, offsets: Array) -> Array:
        """Lines along an axis, at places on another."""
        pieces = np.zeros((len(offsets), 2, 3))
        pieces[:, :, along] = -self.size, self.size
        pieces[:, :, at] = offsets[:, None]
        return pieces

    def draw(self, corner: Array | None, *, shown: bool) -> None:
        self.node.show(shown)
        self.through.show(corner is not None)
        if shown and corner is not None:
            self.through.draw(self._lines(self.along, self.at, corner[[self.at]]))


class Box:
    """From the point a dashed line to each plane, along the axis whose coordinate it is; the other edges thin."""

    def __init__(self, stage: Stage, name: str) -> None:
        self.node = stage.group(name)
        self.edges = [stage.lines(f"{name}/{axis}", axis, width=2.5, dash=DASHES[axis]) for axis in AXES]
        self.others = stage.strokes(f"{name}/others", ["ghost"] * 6, width=1.0)
        stage.linked("point", *self.edges)

    def draw(self, corner: Array | None) -> None:
        self.node.show(corner is not None)
        if corner is None:
            return
        x, y, z = corner.tolist()
        feet = (0.0, y, z), (x, 0.0, z), (x, y, 0.0)
        for edge, foot in zip(self.edges, feet, strict=True):
            edge.path([foot, (x, y, z)])
        on_x, on_y, on_z = (x, 0.0, 0.0), (0.0, y, 0.0), (0.0, 0.0, z)
        yz, xz, xy = feet
        self.others.draw([(xy, on_x), (xy, on_y), (xz, on_x), (xz, on_z), (yz, on_y), (yz, on_z)])
