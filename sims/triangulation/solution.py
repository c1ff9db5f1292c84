"""The mathematics of a state."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from geometry import quaternion
from geometry import triangulation as tri
from geometry.arrays import Array
from geometry.epipolar import epipolar_line_left, epipolar_line_right
from sims.triangulation import corners
from sims.triangulation.holding import Pixel
from sims.triangulation.params import Method, TriangulationParams
from sims.triangulation.rig import Rig, rig

METHODS: dict[Method, Callable[..., tri.Triangulation]] = {
    "dlt": tri.triangulate_dlt,
    "midpoint": tri.triangulate_midpoint,
    "optimal": tri.triangulate_optimal,
}
SAMPLES = 300
SIGMAS = 3.0
"""Standard deviations up to which the ellipsoid is drawn."""
DRAWN = 0.5
"""Depths of the point, to both sides of it, up to which it is drawn: a longer one would hide the scene."""
UNSEEN = 1e-9
"""Pixels of noise up to which nothing of it is seen."""


@dataclass(frozen=True)
class MethodResult:
    """What one method finds; pixels and errors of its point in both pictures."""

    point: Array | None
    status: str
    reprojection_left: float | None = None
    reprojection_right: float | None = None
    reprojection_rms: float | None = None
    pixel_left: Pixel | None = None
    pixel_right: Pixel | None = None


@dataclass(frozen=True)
class TriangulationSolution:
    """What doesn't exist is None. `covariance` and what follows from it are for `sigma_px` pixels of noise."""

    point: Array | None
    status: str
    by_method: Mapping[Method, MethodResult]
    ray_gap: float
    closest_points: Array | None
    disparity: float
    depth_from_disparity: float | None
    sigma_px: float
    covariance: Array | None
    ellipsoid_axes: Array | None
    ellipsoid_orientation: Array | None
    """Quaternion that turns X, Y, Z to its axes."""
    depth_sigma: float | None
    parallax_angle: float
    """Degrees between the lines of sight as the method has them: the mid-point's are the rays, those of the others go
    to their point."""
    ray_angle: float
    """Degrees between both rays."""
    point_angle: float | None
    """Degrees, at the result, between the lines to both cameras."""
    in_front: bool
    measured_left: Pixel
    measured_right: Pixel
    line_left: Array
    line_right: Array
    target: Array | None
    """The point without noise, which the learner holds."""
    true_point: Array | None
    """The point that the pixels came from: with noise, and where the rays without it meet."""
    cloud: Array
    """What other noise of the same size would have given; empty without noise."""
    sight_left: Pixel
    sight_right: Pixel
    """x and y of the lines of sight at depth 1, in each camera's axes."""
    equations: Array
    """A of the linear method's A X = 0: two rows for the left picture, two for the right."""
    singular_values: Array
    least_vector: Array
    """Singular vector of the least of them: the point of the linear method, homogeneous."""
    matched: corners.Matched | None
    """The corner of the little world on which both image points are."""

    @property
    def depth(self) -> float | None:
        """How far in front of the cameras the point is."""
        return None if self.point is None else float(self.point[1])

    @property
    def drawn_part(self) -> float:
        """How much of the ellipsoid's length is drawn."""
        if self.depth is None or self.ellipsoid_axes is None:
            return 1.0
        return min(1.0, DRAWN * self.depth / (SIGMAS * self.ellipsoid_axes.item(0)))

    @property
    def vague(self) -> bool:
        """The point exists, but a standard deviation of its depth is as large as the depth."""
        return self.depth is not None and (self.depth_sigma is None or self.depth_sigma >= self.depth)


def solve(p: TriangulationParams) -> TriangulationSolution:
    """All the mathematics of a state."""
    cameras = rig(p)
    left, right = measured(p)
    found = {name: method(cameras.left, cameras.right, left, right) for name, method in METHODS.items()}
    chosen, middle = found[p.method], found["midpoint"]
    assert isinstance(middle, tri.Midpoint)
    by_method: dict[Method, MethodResult] = {name: _result(cameras, each, left, right) for name, each in found.items()}
    point = by_method[p.method].point
    disparity = float(tri.disparity(left, right))
    target = point if p.noise == 0.0 else _point(METHODS[p.method](cameras.left, cameras.right, p.left_uv, p.right_uv))
    return TriangulationSolution(
        point=point,
        status=by_method[p.method].status,
        by_method=by_method,
        ray_gap=float(middle.gap),
        closest_points=_existing(middle.closest),
        disparity=disparity,
        depth_from_disparity=_positive(float(tri.depth_from_disparity(disparity, p.baseline, p.focal, p.doffs))),
        **_uncertainty(cameras, point, sigma_of(p.noise)),
        parallax_angle=math.degrees(float(chosen.parallax)),
        ray_angle=math.degrees(float(middle.parallax)),
        point_angle=None if point is None else _angle_at(point, p.baseline),
        in_front=bool(chosen.in_front),
        measured_left=left,
        measured_right=right,
        line_left=epipolar_line_left(cameras.F, right),
        line_right=epipolar_line_right(cameras.F, left),
        target=target,
        true_point=target if p.noise > 0.0 and p.left_uv[1] == p.right_uv[1] else None,
        cloud=_cloud(cameras, left, right, p.noise, p.seed) if point is not None else NO_POINTS,
        sight_left=pair(cameras.left.normalized(left)),
        sight_right=pair(cameras.right.normalized(right)),
        **_linear(cameras, left, right),
        matched=corners.matched(cameras.world, p.left_uv, p.right_uv, p.width, point),
    )


def sigma_of(noise: float) -> float:
    """Pixels of noise for which it is said how sure the point is: without any, those of one pixel."""
    return noise if noise > UNSEEN else 1.0


def measured(p: TriangulationParams) -> tuple[Pixel, Pixel]:
    """The left and the right pixel with their noise."""
    if p.noise == 0.0:
        return p.left_uv, p.right_uv
    (du, dv), (eu, ev) = _unit_noise(p.seed)
    left, right, s = p.left_uv, p.right_uv, p.noise
    return (left[0] + s * du, left[1] + s * dv), (right[0] + s * eu, right[1] + s * ev)


@lru_cache(maxsize=1024)
def _unit_noise(seed: int) -> tuple[Pixel, Pixel]:
    left, right = tri.pixel_noise(1, seed)[0]
    return pair(left), pair(right)


NO_POINTS: Array = np.empty((0, 3))


@lru_cache(maxsize=64)
def _cloud(cameras: Rig, left: Pixel, right: Pixel, noise: float, seed: int) -> Array:
    """Points (n, 3) that pixels with as much noise again would give, as far as they exist; none without noise."""
    if noise == 0.0:
        return NO_POINTS
    points = tri.monte_carlo(cameras.left, cameras.right, left, right, noise, SAMPLES, seed)
    return points[np.isfinite(points).all(axis=1)]


def _result(cameras: Rig, found: tri.Triangulation, left: Pixel, right: Pixel) -> MethodResult:
    status = tri.Status(int(found.status)).name.lower()
    if status != "found":
        return MethodResult(None, status)
    at_left, at_right = (pair(camera.project(found.point)[0]) for camera in (cameras.left, cameras.right))
    a, b = math.dist(at_left, left), math.dist(at_right, right)
    return MethodResult(found.point, status, a, b, math.hypot(a, b) / math.sqrt(2.0), at_left, at_right)


def _angle_at(point: Array, baseline: float) -> float:
    """Degrees at a point between the lines to both cameras, which stand at a height of 1 m."""
    x, y, z = point.tolist()
    flat = math.hypot(y, z - 1.0)  # from the line through both cameras
    return math.degrees(math.atan2(x + 0.5 * baseline, flat) - math.atan2(x - 0.5 * baseline, flat))


def _linear(cameras: Rig, left: Pixel, right: Pixel) -> dict[str, Any]:
    """The equations of the linear method, and their solution with its last entry above 0."""
    A = tri.dlt_equations(cameras.left, cameras.right, left, right)
    _, singular, vectors = np.linalg.svd(A)
    least = vectors[3] if vectors.item(3, 3) >= 0.0 else -vectors[3]
    return {"equations": A, "singular_values": singular, "least_vector": least}


def _uncertainty(cameras: Rig, point: Array | None, sigma: float) -> dict[str, Any]:
    names = ("covariance", "ellipsoid_axes", "ellipsoid_orientation", "depth_sigma")
    known = None if point is None else _existing(tri.covariance((cameras.left, cameras.right), point, sigma))
    if known is None:
        return {"sigma_px": sigma, **dict.fromkeys(names)}
    lengths, directions = tri.ellipsoid_axes(known)
    values = known, lengths, quaternion.from_matrix(directions), math.sqrt(known.item(1, 1))
    return {"sigma_px": sigma, **dict(zip(names, values, strict=True))}


def _point(found: tri.Triangulation) -> Array | None:
    return found.point if found.valid else None


def _existing(array: Array) -> Array | None:
    return array if math.isfinite(array.sum()) else None


def _positive(value: float) -> float | None:
    return value if value > 0.0 else None


def pair(array: Array) -> Pixel:
    """Two coordinates as plain numbers."""
    u, v = array.tolist()
    return u, v
