"""A jointed arm: nested frames, so that turning a joint is one assignment."""

from __future__ import annotations

import math
from collections.abc import Sequence

from sims.kit.scene.nodes import Strokes
from sims.kit.scene.stage import Stage
from sims.kit.types import Quaternion
from sims.transform_chain import meshes
from sims.transform_chain.solution import Joint

HALF = math.sqrt(0.5)
ALONG: dict[str, Quaternion] = {"x": (HALF, 0.0, HALF, 0.0), "y": (HALF, -HALF, 0.0, 0.0), "z": (1.0, 0.0, 0.0, 0.0)}
"""Turns z to each axis."""
FRAME = 0.3
"""Length of the axes of a frame between."""
SHORTEST = 0.02
"""Metres of a link's body below which it isn't drawn."""
LEVEL = 0.35
"""Opacity of a ghost."""


class Arm:
    """The links under a node, made as they are needed; a ghost is pale, and bare of frames and letters."""

    def __init__(self, stage: Stage, root: str, *, ghost: bool = False) -> None:
        self._stage, self._ghost = stage, ghost
        self._path = root
        self.links: list[Link] = []

    def draw(self, joints: Sequence[Joint], size: float) -> None:
        """Links for these joints; one that is stouter than usual has a greater size."""
        while len(self.links) < len(joints):
            self.links.append(Link(self._stage, self._path, len(self.links) + 1, ghost=self._ghost))
            self._path = self.links[-1].path
        last = len(joints) - 1
        for k, link in enumerate(self.links):
            link.show(k <= last)
            if k <= last:
                link.draw(joints[k], size * (1.0 - 0.45 * k / max(last, 3)), size, last=k == last)


class Link:
    """One joint with its link, and the frame at the link's end; later links hang on that."""

    def __init__(self, stage: Stage, parent: str, number: int, *, ghost: bool) -> None:
        self.path = path = f"{parent}/link{number}"
        self._palette = stage.palette
        self._ghost = ghost
        opacity = LEVEL if ghost else None
        self.joint = stage.mesh(f"{parent}/joint{number}", meshes.bearing(), "ghost", opacity=opacity)
        self.node = stage.group(path)
        self.body = stage.mesh(
            f"{path}/body", meshes.link(), "ghost" if ghost else stage.palette.solid, opacity=opacity, flat=True
        )
        self.letter = None if ghost else stage.label(f"{parent}/joint{number}/letter", "")
        self.frame = None if ghost else frame(stage, f"{path}/frame")
        self.label = None if ghost else stage.label(f"{path}/label", "")

    def draw(self, joint: Joint, girth: float, size: float, *, last: bool) -> None:
        self.node.pose(joint.wxyz, joint.position)
        self.joint.pose(ALONG[joint.axis])
        self.joint.scale(girth)
        hand = meshes.GRIPPER * size if last else 0.0
        self.body.show(joint.length - hand > SHORTEST)
        self.body.pose(position=(-hand, 0.0, 0.0))
        self.body.scale((max(joint.length - hand, SHORTEST), girth, girth))
        if self.letter is not None and self.frame is not None:
            self.joint.color(self._palette.surface(joint.axis))
            self.letter.text(joint.axis)
            self.letter.pose(position=(0.0, 0.0, (meshes.AXLE + 0.09) * girth))
            self.frame.show(not last)
            self.frame.scale(FRAME * size)

    def show(self, visible: bool) -> None:
        self.node.show(visible)
        self.joint.show(visible)

    def name(self, text: str, place: tuple[float, float, float]) -> None:
        """Name the transform that leads here, at a place in its frame; no name hides it."""
        if self.label is not None:
            self.label.say(text or None)
            self.label.pose(position=place)


def frame(stage: Stage, name: str) -> Strokes:
    """A thin coordinate frame of length 1, dashed by axis."""
    pieces = meshes.axes()
    strokes = stage.strokes(name, [role for role, _, _ in pieces], width=1.8)
    strokes.draw([(start, end) for _, start, end in pieces])
    return strokes
