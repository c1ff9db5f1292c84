"""Three objects side by side that go from start to target, each by its own way, with marks at equal times."""

from __future__ import annotations

import math

import trimesh

from geometry.arrays import Array
from sims.kit.scene.stage import Stage
from sims.quaternion.ball import FRAME
from sims.quaternion.params import QuaternionParams
from sims.quaternion.paths import Name
from sims.quaternion.solution import QuaternionSolution, Way

NAMES: dict[Name, str] = {"slerp": "SLERP", "nlerp": "NLERP", "euler": "Euler"}
BESIDE = 1.32
"""Metres between two neighbours, to the right in the first view."""
RADIUS = 0.54
"""Metres from the middle of each to the sphere that its nose touches."""
SCALE = 0.52
SPHERE = trimesh.creation.icosphere(subdivisions=4, radius=RADIUS)


class Ways:
    """All three."""

    def __init__(self, stage: Stage) -> None:
        self.node = stage.group("/ways")
        self.ways = {name: Object(stage, name, (k - 1) * BESIDE * FRAME[0]) for k, name in enumerate(NAMES)}

    def draw(self, p: QuaternionParams, s: QuaternionSolution) -> None:
        self.node.show(s.ways is not None)
        for name, way in (s.ways or {}).items():
            self.ways[name].draw(way, p.show_paths, chosen=name == p.interpolation)


class Object:
    """One of them on its sphere: the chosen one's path is thick and in ink, the others' are thin."""

    def __init__(self, stage: Stage, name: Name, place: Array) -> None:
        path = f"/ways/{name}"
        stage.group(path).pose(position=place.tolist())
        self.body = stage.group(f"{path}/object")
        stage.aircraft(f"{path}/object", scale=SCALE)
        stage.mesh(f"{path}/sphere", SPHERE, "ghost", opacity=0.1, side="back")
        circle = stage.lines(f"{path}/level", "ghost", width=0.8)
        circle.arc(RADIUS, 2.0 * math.pi)
        self.thick = stage.lines(f"{path}/chosen", "ink", width=4.0)
        self.thin = stage.lines(f"{path}/ghost", "ink", width=1.8)
        stage.linked("interpolation", self.thick)
        stage.linked("t", self.thick, self.thin)
        self.nose = stage.ball(f"{path}/nose", 0.045, "ink")
        stage.label(f"{path}/label", NAMES[name], (0.0, 0.0, 1.5 * RADIUS))

    def draw(self, way: Way, paths: bool, *, chosen: bool) -> None:
        self.body.pose(way.q.tolist())
        self.nose.pose(position=(RADIUS * way.at).tolist())
        line, other = (self.thick, self.thin) if chosen else (self.thin, self.thick)
        line.pieces(RADIUS * way.nose.drawn if paths else None)
        other.show(False)
