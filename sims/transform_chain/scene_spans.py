"""Straight ways between places that move."""

from __future__ import annotations

from typing import Generic, TypeVar

from sims.kit.scene.nodes import Arrows, Lines
from sims.transform_chain.drawing import Span

N = TypeVar("N", Arrows, Lines)


class Straight(Generic[N]):
    """An arrow or a line that is turned to where it leads: only how long it is comes a frame later, at its tail."""

    def __init__(self, node: N) -> None:
        self.node: N = node

    def draw(self, span: Span | None) -> None:
        """Lead along a way; nowhere where there is none."""
        self.node.show(span is not None)
        if span is None:
            return
        self.node.pose(span.wxyz, span.tip)
        ends = (-span.length, 0.0, 0.0), (0.0, 0.0, 0.0)
        if isinstance(self.node, Arrows):
            self.node.between(ends)
        else:
            self.node.path(ends)
