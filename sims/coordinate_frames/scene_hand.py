"""The hand whose rule tells right-handed from left-handed axes."""

from __future__ import annotations

import math

from sims.coordinate_frames import meshes
from sims.coordinate_frames.solution import FramesSolution
from sims.kit.scene.stage import Stage
from sims.kit.types import Quaternion

ARC_RADIUS = 0.85
KNUCKLES = (0.22, -0.09, 0.17)
"""Where the knuckles are in the axes: the thumb then lies along Z, and X runs along the fingers."""


class Hand:
    """A right or a left hand at the origin, its thumb along Z, and the arc that its fingers sweep, from X to Y."""

    def __init__(self, stage: Stage, name: str) -> None:
        self.node = stage.group(name)
        self.hands = {side: _Fingers(stage, f"{name}/{side}", left=side == "left") for side in ("right", "left")}
        self.arc = stage.lines(f"{name}/arc", "ink", width=3.5)
        self.head = stage.mesh(f"{name}/head", meshes.arrow_head(), "ink")

    def draw(self, s: FramesSolution, rule: float, shown: bool) -> None:
        self.node.show(shown)
        if not shown:
            return
        self.node.pose(s.drawn.wxyz)
        for side, fingers in self.hands.items():
            fingers.node.show(side == s.handedness)
            fingers.bend(rule)
        angle = rule * math.pi / 2
        self.arc.arc(ARC_RADIUS, angle)
        self.head.pose(_about_z(angle), (ARC_RADIUS * math.cos(angle), ARC_RADIUS * math.sin(angle), 0.0))


class _Fingers:
    """One hand; its fingers bend at three joints."""

    def __init__(self, stage: Stage, name: str, *, left: bool) -> None:
        self.node = stage.group(name)
        x, y, z = KNUCKLES
        self.node.pose(position=(x, y, -z if left else z))
        parts = meshes.hand(left=left)
        self.joints = []
        stage.mesh(f"{name}/palm", parts["palm"], "ghost")
        stage.mesh(f"{name}/thumb", parts["thumb"], "z")
        path = name
        for part, at in zip(("near", "middle", "far"), (0.04, *meshes.SEGMENTS), strict=True):
            path = f"{path}/{part}"
            joint = stage.mesh(path, parts[part], "ghost")
            joint.pose(position=(at, 0.0, 0.0))
            self.joints.append(joint)
        side = "left" if left else "right"
        stage.label(f"{name}/label", f"{side} hand", (-0.72, 0.0, 0.16 if left else -0.16))

    def bend(self, rule: float) -> None:
        for joint, most in zip(self.joints, meshes.CURL, strict=True):
            joint.pose(_about_z(math.radians(most) * rule))


def _about_z(angle: float) -> Quaternion:
    return math.cos(angle / 2), 0.0, 0.0, math.sin(angle / 2)
