"""A jointed arm: nested frames, so that turning a joint is one assignment."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

from sims.kit.scene.nodes import Grip, Strokes
from sims.kit.scene.stage import Stage
from sims.kit.types import ORIGIN, Line, Place, Quaternion
from sims.transform_chain import meshes
from sims.transform_chain.drawing import Joint

HALF = math.sqrt(0.5)
ALONG: dict[str, Quaternion] = {"x": (HALF, 0.0, HALF, 0.0), "y": (HALF, -HALF, 0.0, 0.0), "z": (1.0, 0.0, 0.0, 0.0)}
"""Turns z to each axis."""
UPRIGHT, UPSIDE_DOWN, ABOUT = (1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)
"""Half turns about x and z."""
FRAME = 0.3
"""Length of the axes of a frame between."""
SHORTEST = 0.02
"""Metres of a link's body below which it isn't drawn."""
ROD = 0.6
"""Length of the rod of a joint that slides, for an arm of the usual size."""
LEVEL = 0.35
"""Opacity of a ghost."""


class Arm:
    """The links under a node, made as they are needed; a ghost is pale, and bare of frames, arrows and grips."""

    def __init__(self, stage: Stage, root: str, *, ghost: bool = False) -> None:
        self._stage, self._ghost = stage, ghost
        self._path = root
        self.links: list[Link] = []
        self.grips: list[Grip] = []
        self.lines: Sequence[Line | None] = ()
        self.count = 0

    def draw(
        self, joints: Sequence[Joint], size: float, stage: int | None = None, *, arrows: bool = False, tool: str = "x"
    ) -> None:
        """Links for these joints; one that is stouter than usual has a greater size. `stage`: one that is alone.

        Where the gripper points along x it takes its length of the last link.
        """
        self.count = len(joints)
        while len(self.links) < self.count:
            self.links.append(Link(self._stage, self._path, len(self.links) + 1, ghost=self._ghost))
            self._path = self.links[-1].path
        last = self.count - 1
        for k, link in enumerate(self.links):
            link.show(k <= last)
            if k <= last:
                link.draw(joints[k], size * (1.0 - 0.45 * k / max(last, 3)), size, hand=k == last and tool == "x")
                link.mark(frame=k < last and stage in (None, k + 1, k + 2), arrow=arrows and stage in (None, k + 1))

    def hold(self, places: Sequence[Place | None], lines: Sequence[Line | None], size: float) -> None:
        """Grips of the joints, at places in the world; each link is held too, and turns about its joint's line."""
        self.lines = lines
        while len(self.grips) < len(places):
            k, name = len(self.grips), f"/turn{len(self.grips) + 1}"
            self.grips.append(self._stage.grip(name, 0.024, halo=2.0))
            if (grasp := self.links[k].grasp) is not None:
                self._stage.turned_by(grasp, name, self.grips[k], partial(self._line, k))
        for k, grip in enumerate(self.grips):
            grip.place(places[k] if k < len(places) else None)
            grip.scale(size)

    def _line(self, k: int) -> Line | None:
        return self.lines[k]

    def stress(self, number: int) -> None:
        """Have the arrow and the frame of a link, from 1, stand out, and no other."""
        for k, link in enumerate(self.links, start=1):
            for node in link.marks:
                node.stress(k == number)

    def stress_arrows(self) -> None:
        """Have all arrows stand out."""
        for link in self.links:
            for node in link.marks[:1]:
                node.stress(True)


class Link:
    """One joint with its link, and the frame at the link's end; later links hang on that."""

    def __init__(self, stage: Stage, parent: str, number: int, *, ghost: bool) -> None:
        self.path = path = f"{parent}/link{number}"
        self._palette = stage.palette
        self._ghost = ghost
        self._kind = "r"
        opacity = LEVEL if ghost else None
        solid = "ghost" if ghost else stage.palette.solid
        self.joint = stage.mesh(f"{parent}/joint{number}", meshes.bearing(), "ghost", opacity=opacity)
        self.post = stage.mesh(f"{parent}/joint{number}/post", meshes.post(), solid, opacity=opacity)
        self.node = stage.group(path)
        self.body = stage.mesh(f"{path}/body", meshes.link(), solid, opacity=opacity, flat=True)
        self.grasp = stage.mesh(f"{path}/grasp", meshes.grasp(), solid, opacity=0.0) if not ghost else None
        self.arrow = stage.arrows(f"{path}/arrow", "ink", radius=meshes.ARROW) if not ghost else None
        self.frame = frame(stage, f"{path}/frame") if not ghost else None
        self.marks = [node for node in (self.arrow, self.frame) if node is not None]

    def draw(self, joint: Joint, girth: float, size: float, *, hand: bool) -> None:
        self.node.pose(joint.wxyz, joint.position)
        self._draw_joint(joint, girth)
        self._draw_post(joint, girth, size)
        taken = meshes.GRIPPER * size if hand else 0.0
        length = abs(joint.length) - taken
        for body in (self.body, self.grasp):
            if body is not None:
                body.show(length > SHORTEST)
                body.pose(UPRIGHT if joint.length > 0.0 else ABOUT, (-math.copysign(taken, joint.length), 0.0, 0.0))
                body.scale((max(length, SHORTEST), girth, girth))
        if self.arrow is not None and self.frame is not None:
            self.joint.color(self._palette.solid if joint.kind == "f" else self._palette.surface(joint.axis))
            self.arrow.thickness(meshes.ARROW * size)
            self.arrow.between(None if joint.tail is None else (joint.tail, ORIGIN))
            self.frame.scale(FRAME * size)

    def _draw_joint(self, joint: Joint, girth: float) -> None:
        if joint.kind != self._kind:
            self._kind = joint.kind
            body = {"r": meshes.bearing, "p": meshes.sleeve, "f": meshes.flange}[joint.kind]()
            self.joint.shape(body.vertices, body.faces)
        self.joint.pose(ALONG[joint.axis])
        self.joint.scale(girth)

    def _draw_post(self, joint: Joint, girth: float, size: float) -> None:
        """What leads along the joint's axis: of one that slides a rod, as long as ever, that goes along."""
        if joint.kind == "p":
            self.post.show(True)
            self.post.pose(UPSIDE_DOWN, (0.0, 0.0, joint.offset))
            self.post.scale((girth, girth, ROD * size))
            return
        self.post.show(abs(joint.offset) > SHORTEST)
        self.post.pose(UPRIGHT if joint.offset > 0.0 else UPSIDE_DOWN, ORIGIN)
        self.post.scale((girth, girth, abs(joint.offset) or SHORTEST))

    def mark(self, *, frame: bool, arrow: bool) -> None:
        """Show the frame at the end, and the arrow that leads there from the frame before."""
        if self.arrow is not None and self.frame is not None:
            self.frame.show(frame)
            if not arrow:
                self.arrow.show(False)

    def show(self, visible: bool) -> None:
        """Show it or not, and all that hangs on it."""
        self.node.show(visible)
        self.joint.show(visible)


def frame(stage: Stage, name: str) -> Strokes:
    """A thin coordinate frame of length 1, dashed by axis."""
    pieces = meshes.axes()
    strokes = stage.strokes(name, [role for role, _, _ in pieces], width=1.8)
    strokes.draw([(start, end) for _, start, end in pieces])
    return strokes
