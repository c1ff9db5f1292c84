"""What a state shows as a PLY file, with all that was computed of it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geometry.arrays import Array
from geometry.clouds import Indices
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.derived import LOCAL, normals
from sims.point_cloud.files import ply_bytes
from sims.point_cloud.library import NO_FILES, Library
from sims.point_cloud.params import CloudParams
from sims.point_cloud.result import Result
from sims.point_cloud.solution import processed, shown


def ply(p: CloudParams, library: Library = NO_FILES) -> bytes:
    """What a state shows as a PLY file, where the file that it came from has it.

    Normals are in it if the state has them shown or used, and of each point what the process found: `label`. A surface
    is its own points with the triangles between them.
    """
    cloud, thin, result = processed(p, library)
    if result.surface is not None and result.surface.triangles:
        mesh = result.surface
        return ply_bytes(_back(Cloud(cloud.name, mesh.vertices, origin=cloud.origin)), faces=mesh.faces)
    thin = replace(thin, normals=_computed_normals(p, thin))
    return ply_bytes(_back(shown(thin, result)), _labels(result), LABELS.get(p.process, ""))


LABELS = {
    "ground": "1 on the ground, 0 not",
    "outliers": "1 an outlier, 0 not",
    "clusters": "number of the cluster, 0 too small",
    "register": "0 first scan, 1 second scan",
}
"""What the labels of each process mean."""


def _labels(result: Result) -> Indices | None:
    """What the process found of each shown point (N,), in the order of their numbers; None where it found nothing."""
    found = np.repeat([0, 1], [len(result.base.rows), len(result.marked.rows)])
    if result.clusters is not None:
        found[len(result.base.rows) :] += result.clusters.labels[result.marked.rows]
    nothing = all(one is None for one in (result.ground, result.clusters, result.outliers, result.registration))
    return None if nothing else found


def _back(cloud: Cloud) -> Cloud:
    """The cloud where its file has it."""
    return cloud if cloud.origin is None else replace(cloud, points=cloud.points + cloud.origin)


def _computed_normals(p: CloudParams, thin: Cloud) -> Array | None:
    """Normals (N, 3) of the thinned points, if the state shows or uses them; else those that a file came with."""
    used = p.process == "register" and p.method == "plane" and thin.apart
    return normals(thin, p.neighbors) if p.show_normals or p.color in LOCAL or used else thin.normals
