"""The scene: two cameras, their rays, the points that the methods find, and how sure they are."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
import trimesh

from geometry import quaternion
from geometry.camera import R_WORLD_LEVEL
from sims.kit.camera_figure import CameraFigure
from sims.kit.readout import quantity
from sims.kit.stage import Solid, Stage
from sims.triangulation.model import (
    METHODS,
    NAMES,
    NO_POINTS,
    PICTURE_WIDTH,
    WIDTH,
    Method,
    MethodResult,
    Pixel,
    TriangulationParams,
    TriangulationSolution,
    rig,
)  # fmt: skip

LEVEL = quaternion.from_matrix(R_WORLD_LEVEL).tolist()
FAR = 12.0
"""Metres that a ray is drawn when it leads to no point."""
BACKWARD = 4.0
"""Metres that it is drawn backwards, to where the lines of sight meet."""
SIGMAS = 3.0
APART = 0.08
"""Metres from which on points that the methods find are told apart by labels."""
SEEN_GAP = 0.002
RADIUS = 0.075


class TriangulationScene:
    """Both cameras stand at a height of 1 m and look along Y."""

    def __init__(self, stage: Stage) -> None:
        stage.ground(size=16.0, cell=0.5)
        self.eyes = [Eye(stage, "left", "L"), Eye(stage, "right", "R")]
        self.baseline = stage.lines("/baseline", np.zeros((2, 3)), "ink", width=2.0)
        self.baseline_label = stage.label("/baseline/label", "", (0.0, -0.1, 0.72))
        self.points = {name: Found(stage, name) for name in METHODS}
        self.drop = stage.lines("/drop", np.zeros((2, 3)), "ghost", width=1.2)
        self.gap = stage.lines("/gap", np.zeros((2, 3)), "held", width=5.0)
        self.gap_label = stage.label("/gap/label", "", anchor="center-right")
        self.grip = stage.grip("/point", RADIUS)
        self.true_label = stage.label("/point/label", "true point", (0.0, 0.0, -0.16))
        self.region = Region(stage)
        self.warning = stage.label("/warning", "")

    def draw(self, p: TriangulationParams, s: TriangulationSolution) -> None:
        for eye, sight, side in zip(self.eyes, (s.sight_left, s.sight_right), (-0.5, 0.5), strict=True):
            eye.draw(p, s, sight, side * p.baseline)
        self.baseline.path([(-0.5 * p.baseline, 0.0, 1.0), (0.5 * p.baseline, 0.0, 1.0)])
        self.baseline_label.text(f"baseline {quantity(p.baseline, 'm', 2)}")
        self._points(p, s)
        self._gap(s)
        self._warn(s)
        self.region.draw(p, s)

    def _points(self, p: TriangulationParams, s: TriangulationSolution) -> None:
        for name, found in self.points.items():
            found.draw(s.by_method[name], name == p.method, s.point)
        self.grip.show(s.target is not None)
        self.true_label.show(s.true_point is not None)
        if s.target is not None:
            self.grip.pose(position=s.target.tolist())
        self.drop.show(s.point is not None)
        if s.point is not None:
            x, y, z = s.point.tolist()
            self.drop.pieces(np.array([[(x, y, z), (x, y, 0.0)], [(x - 0.1, y, 0.0), (x + 0.1, y, 0.0)]]))

    def _gap(self, s: TriangulationSolution) -> None:
        seen = s.point is not None and s.closest_points is not None and s.ray_gap > SEEN_GAP
        self.gap.show(seen)
        if seen and s.closest_points is not None:
            self.gap.path(s.closest_points)
            self.gap_label.pose(position=s.closest_points.mean(axis=0) - np.array([0.0, 0.0, 0.3]))
            self.gap_label.text(f"rays miss by {quantity(100.0 * s.ray_gap, 'cm', 1)}")

    def _warn(self, s: TriangulationSolution) -> None:
        self.warning.show(s.point is None or s.vague)
        if s.status == "parallel":
            self.warning.text("⚠ parallel rays: no finite point")
        elif s.status == "behind":
            self.warning.text("⚠ no point in front: the rays diverge")
        else:
            self.warning.text("⚠ almost parallel: depth unknown")
        x = 0.5 * (s.sight_left[0] + s.sight_right[0])
        self.warning.pose(position=(3.0 * x, 3.0, 1.5))


class Eye:
    """One camera with the pixel that it measured, and the line of sight through it."""

    def __init__(self, stage: Stage, name: Literal["left", "right"], letter: str) -> None:
        path = f"/{name}"
        self.figure = CameraFigure(stage, path, name, letter)
        stage.lines(f"{path}/post", [(0.0, 0.08, -0.12), (0.0, 1.0, -0.12)], "ghost", width=1.2)
        self.pixel = stage.ball(f"{path}/pixel", 0.016, name)
        self.ray = stage.lines(f"{path}/ray", np.zeros((2, 3)), name, width=1.8)
        self.back = stage.lines(f"{path}/back", np.zeros((2, 3)), name, width=1.5, dash=(0.08, 0.08))

    def draw(self, p: TriangulationParams, s: TriangulationSolution, sight: Pixel, x: float) -> None:
        cameras = rig(p.baseline, p.focal)
        self.figure.node.pose(LEVEL, (x, 0.0, 1.0))
        self.figure.draw(cameras.corners, cameras.size)
        along = np.array([*sight, 1.0])
        self.pixel.pose(position=along * (PICTURE_WIDTH * cameras.size * p.focal / WIDTH))
        self.pixel.scale(cameras.size)
        reach = FAR if s.depth is None else 1.12 * s.depth + 0.15
        self.ray.path([np.zeros(3), along * reach])
        meeting = 0.0 if s.closest_points is None else s.closest_points.item(0, 1)
        self.back.show(s.status == "behind")
        if s.status == "behind":
            self.back.path([np.zeros(3), along * max(meeting, -BACKWARD)])


class Found:
    """The point of one method: filled if it is the chosen one, else a ghost. Each method has a shape of its own."""

    def __init__(self, stage: Stage, name: Method) -> None:
        self.name = NAMES[name]
        self.node = stage.group(f"/{name}")
        body = SHAPES[name]
        self.filled = stage.mesh(f"/{name}/filled", body, "ink", flat=True)
        self.ghost = stage.mesh(f"/{name}/ghost", body, "ghost", flat=True, opacity=0.6)
        self.ghost.scale(0.6)
        self.label = stage.label(f"/{name}/label", "")

    def draw(self, found: MethodResult, chosen: bool, result: Any) -> None:
        self.node.show(found.point is not None)
        if found.point is None:
            return
        self.node.pose(position=found.point.tolist())
        self.filled.show(chosen)
        self.ghost.show(not chosen)
        apart = 0.0 if result is None else float(np.abs(found.point - result).max())
        self.label.show(chosen or apart > APART)
        self.label.pose(position=(0.0, 0.0, 0.2 if chosen else -0.2))
        self.label.text(f"{self.name}, depth {quantity(found.point.item(1), 'm', 2)}" if chosen else self.name)


class Region:
    """Where the point may be: the ellipsoid of three standard deviations with its axes, and the cloud of samples."""

    def __init__(self, stage: Stage) -> None:
        self.node = stage.group("/uncertainty")
        self.ball: Solid = stage.ball("/uncertainty/ellipsoid", 1.0, "ink", opacity=0.16)
        self.axes = stage.lines("/uncertainty/axes", np.zeros((4, 3)), "ink", width=3.0)
        self.label = stage.label("/uncertainty/label", "", anchor="center-left")
        self.cloud = stage.cloud("/cloud", NO_POINTS, "ink", size=0.008)
        self.shown = NO_POINTS

    def draw(self, p: TriangulationParams, s: TriangulationSolution) -> None:
        if s.cloud is not self.shown:
            self.shown = s.cloud
            self.cloud.points(s.cloud)
        visible = p.show_ellipsoid and s.ellipsoid_axes is not None and not s.vague
        self.node.show(visible)
        if not visible or s.ellipsoid_axes is None or s.ellipsoid_directions is None or s.point is None:
            return
        lengths = SIGMAS * s.ellipsoid_axes
        self.node.pose(quaternion.from_matrix(s.ellipsoid_directions).tolist(), s.point.tolist())
        a, b, c = lengths.tolist()
        self.ball.scale((a, b, c))
        ends = np.zeros((3, 2, 3))
        ends[range(3), 0, range(3)] = lengths
        ends[:, 1] = -ends[:, 0]
        self.axes.pieces(ends)
        far = -a if s.ellipsoid_directions[1, 0] < 0.0 else a
        self.label.pose(position=(far, 0.0, 0.0))
        assumed = " for 1\u2009px" if p.noise == 0.0 else ""
        self.label.text(f"3σ{assumed}: ±{quantity(SIGMAS * (s.depth_sigma or 0.0), 'm', 2)} deep")


def _shape(name: Method) -> trimesh.Trimesh:
    body: trimesh.Trimesh
    if name == "dlt":
        body = trimesh.creation.box((1.7 * RADIUS,) * 3)
    elif name == "midpoint":
        body = trimesh.convex.convex_hull(1.6 * RADIUS * np.concatenate([np.eye(3), -np.eye(3)]))
    else:
        body = trimesh.creation.icosphere(subdivisions=3, radius=1.15 * RADIUS)
    return body


SHAPES = {name: _shape(name) for name in METHODS}
