"""Point clouds beside Open3D, on the same data in one run: seconds, ratios, and whether the answers agree.

`make bench` installs Open3D into an environment of its own, where there is one for this Python and machine.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial
from importlib import import_module
from typing import Any

import numpy as np

from geometry import Array, clouds, se3

Rows = list[dict[str, Any]]
NEIGHBORS = 16
COUNTS = {100_000: "100 k", 1_000_000: "1 M"}
LEFT_OUT = "\nPoint clouds: not compared, since Open3D isn't here. `make bench` installs it where it can be."


@dataclass
class Case:
    """One process on one cloud: ours, theirs, how often each, and what says whether the results agree."""

    name: str
    ours: Callable[[], Any]
    theirs: Callable[[], Any] | None
    agree: Callable[[Any, Any], str]
    times: int = 3


def measure(quick: bool) -> Rows:
    """Compare with Open3D, or say that it isn't there."""
    try:
        open3d = import_module("open3d")
    except ImportError:
        print(LEFT_OUT)
        return []
    print(
        f"\nPoint clouds beside Open3D {open3d.__version__}, best of several turns each, load {os.getloadavg()[0]:.1f}"
    )
    print(f"{'':44}{'ours s':>9}{'theirs s':>10}{'ratio':>8}  results")
    counts = list(COUNTS)[: 1 if quick else None]
    rows = [_run(case) for count in counts for case in _cases(open3d, count)]
    rows += [_run(case) for case in _registrations(open3d, 100_000)]
    return rows


def _run(case: Case) -> dict[str, Any]:
    ours = theirs = np.inf
    mine = other = None
    for _ in range(case.times):
        ours, mine = _least(case.ours, ours)
        if case.theirs:
            theirs, other = _least(case.theirs, theirs)
    ratio = f"×{theirs / ours:.2f}" if case.theirs else ""
    beside = f"{theirs:.3f}" if case.theirs else ""
    print(f"{case.name:44}{ours:9.3f}{beside:>10}{ratio:>8}  {case.agree(mine, other)}", flush=True)
    return {"case": case.name, "ours_s": ours, "theirs_s": theirs if case.theirs else None}


def _least(function: Callable[[], Any], least: float) -> tuple[float, Any]:
    start = time.perf_counter()
    result = function()
    return min(least, time.perf_counter() - start), result


def surface_cloud(count: int, seed: int = 0) -> Array:
    """A scanned yard of 20 m: a wavy floor and two walls with 5 mm noise, in random order."""
    rng = np.random.default_rng(seed)
    u, v = rng.uniform(0.0, 20.0, (2, count))
    floor = np.stack([u, v, 0.3 * np.sin(u) + 0.2 * np.cos(1.3 * v)], axis=1)
    wall = np.stack([u, np.full(count, 20.0), v / 4.0], axis=1)
    side = np.stack([np.full(count, 20.0), u, v / 4.0], axis=1)
    kind = rng.random(count)[:, None]
    return np.asarray(
        np.where(kind < 0.6, floor, np.where(kind < 0.8, wall, side)) + rng.normal(0.0, 0.005, (count, 3))
    )


def in_order(points: Array) -> Array:
    """The same points as a scanner or a tile gives them: neighbours in space are near in the file."""
    return clouds.Neighbours(points).ordered


def _cases(open3d: Any, count: int) -> Iterator[Case]:
    points = surface_cloud(count)
    name = COUNTS[count]
    for kind, cloud in (("unordered", points), ("ordered", in_order(points))):
        theirs = _cloud(open3d, cloud)
        for size in (_size(points, 8_000), _size(points, int(0.6 * count))):
            cells = len(clouds.voxels(cloud, size).points)
            yield Case(
                f"voxels, {name} {kind}, {cells / 1000.0:.0f} k cells",
                partial(_voxels, cloud, size),
                partial(_their_voxels, theirs, size),
                _same_points,
                5,
            )
        search = open3d.geometry.KDTreeSearchParamKNN(NEIGHBORS)
        yield Case(
            f"normals, {name} {kind}, {NEIGHBORS} neighbours",
            partial(clouds.normals, cloud, NEIGHBORS),
            partial(_their_normals, theirs, search),
            _same_normals,
        )
    theirs = _cloud(open3d, points)
    yield Case(
        f"outliers, {name} unordered",
        lambda: np.flatnonzero(clouds.outliers(points, NEIGHBORS, 2.0).keep),
        lambda: np.asarray(theirs.remove_statistical_outlier(NEIGHBORS, 2.0)[1]),
        lambda mine, other: f"{len(np.setxor1d(mine, other))} points differ",
    )
    yield Case(
        f"plane by RANSAC, {name}",
        lambda: clouds.ransac_plane(points, 0.02),
        lambda: theirs.segment_plane(0.02, 3, 1024)[0],
        _same_plane,
    )
    distance = 0.05 if count == 100_000 else 0.015
    yield Case(
        f"clusters, {name}",
        lambda: clouds.clusters(points, distance).labels,
        lambda: np.asarray(theirs.cluster_dbscan(distance, 1)),
        _same_clusters,
    )
    ray = np.array([10.0, -10.0, 5.0]), np.array([0.05, 1.0, -0.3])
    yield Case(
        f"picking, {name}", lambda: clouds.pick(points, *ray), None, lambda mine, _: f"{mine.off * 1e3:.1f} mm off", 9
    )


def _registrations(open3d: Any, count: int) -> Iterator[Case]:
    """Two scans of one yard with points of their own, 8 cm and 2° apart."""
    target, other = surface_cloud(count, 1), surface_cloud(count, 2)
    T = se3.transform(_turn(0.035), [0.08, -0.05, 0.06])
    source = se3.apply(se3.inverse(T), other)
    p, q = _cloud(open3d, source), _cloud(open3d, target)
    pipeline = open3d.pipelines.registration
    search = open3d.geometry.KDTreeSearchParamKNN(NEIGHBORS)

    def theirs(method: str, most: int = 100, settled: float = clouds.SETTLED) -> Array:
        goal = open3d.geometry.PointCloud(q)
        way = pipeline.TransformationEstimationPointToPoint()
        if method == "plane":
            goal.estimate_normals(search)
            way = pipeline.TransformationEstimationPointToPlane()
        criteria = pipeline.ICPConvergenceCriteria(settled, settled, most)
        return np.asarray(pipeline.registration_icp(p, goal, 0.5, np.eye(4), way, criteria).transformation)

    def ours(method: str, thin: tuple[int, ...], most: int = 100, settled: float = clouds.SETTLED) -> Array:
        found = clouds.register(source, target, 0.5, method=method, thin=thin, most=most, settled=settled)
        return found.T_target_source

    @cache
    def after(method: str) -> str:
        """Where each stops depends on more than the steps: after equally many, without a stop, both are at one pose."""
        return f"after 30 steps each {_apart(ours(method, (), 30, 0.0), theirs(method, 30, 0.0)):.0e} m apart"

    def poses(method: str, mine: Array, other: Array) -> str:
        off, beside = (_apart(T, pose) for pose in (mine, other))
        return f"{off * 1e3:.3f} mm from the truth, theirs {beside * 1e3:.3f}; {after(method)}"

    for method in ("point", "plane"):
        for name, thin in (("same steps", ()), ("coarse to fine", (64, 8))):
            yield Case(
                f"ICP to {method}s, 100 k, {name}",
                partial(ours, method, thin),
                partial(theirs, method),
                partial(poses, method),
                2,
            )


def _voxels(points: Array, size: float) -> Array:
    return clouds.voxels(points, size).points


def _their_voxels(cloud: Any, size: float) -> Array:
    return np.asarray(cloud.voxel_down_sample(size).points)


def _their_normals(cloud: Any, search: Any) -> Array:
    cloud.estimate_normals(search)
    return np.asarray(cloud.normals)


def _size(points: Array, cells: int) -> float:
    """Edge with which the cloud fills about so many cells."""
    low, high = 0.001, 2.0
    for _ in range(12):
        middle = float(np.sqrt(low * high))
        low, high = (middle, high) if len(clouds.voxels(points, middle).points) > cells else (low, middle)
    return high


def _cloud(open3d: Any, points: Array) -> Any:
    return open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))


def _turn(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _apart(A: Array, B: Array) -> float:
    """How far two poses put the yard's corners apart, at most."""
    corners = np.stack(np.meshgrid([0.0, 20.0], [0.0, 20.0], [0.0, 5.0]), axis=-1).reshape(-1, 3)
    return float(np.linalg.norm(se3.apply(A, corners) - se3.apply(B, corners), axis=1).max())


def _same_points(mine: Array, other: Array) -> str:
    if mine.shape != other.shape:
        return f"{len(mine)} and {len(other)} cells"
    a, b = (points[np.lexsort(np.round(points, 8).T)] for points in (mine, other))
    return f"{len(mine)} cells, {np.abs(a - b).max():.0e} m apart"


def _same_normals(mine: clouds.Normals, other: Array) -> str:
    clear = mine.eigenvalues[:, 1] - mine.eigenvalues[:, 0] > 1e-4 * mine.eigenvalues[:, 2]
    across = np.linalg.norm(np.cross(mine.normals[clear], other[clear]), axis=1)
    return f"{clear.mean():.2%} distinct, {across.max():.0e} rad apart"


def _same_plane(mine: clouds.Plane, other: Array) -> str:
    sign = np.sign(other[:3] @ mine.normal)
    across = np.linalg.norm(np.cross(mine.normal, other[:3]))
    return (
        f"{across:.0e} rad, {abs(sign * other[3] - mine.offset):.0e} m apart, {mine.inliers.mean():.0%} of the points"
    )


def _same_clusters(mine: Array, other: Array) -> str:
    pairs = len(np.unique(np.stack([mine, other]), axis=1).T)
    same = pairs == mine.max() + 1 == other.max() + 1
    return f"{mine.max() + 1} clusters, {'the same' if same else 'not the same'}"
