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
from geometry.epipolar import epipolar_line_left, epipolar_line_right, sampson_distance
from sims.kit.stereo import Size
from sims.kit.types import Pixel
from sims.triangulation import corners
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
MEET = 1e-6
"""Pixels that pixels are moved by at most for their rays to meet, where these came from one point but for rounding."""


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
    """What doesn't exist is None. `covariance` and what follows from it are for `sigma_px` pixels of noise.

    Disparity and the depth from it exist in parallel rigs alone.
    """

    point: Array | None
    status: str
    by_method: Mapping[Method, MethodResult]
    ray_gap: float
    closest_points: Array | None
    depth: float | None
    """How far in front of the left camera the point is, along its optical axis."""
    point_left: Array | None
    """The point in the left camera's axes: x right, y down, z forward."""
    disparity: float | None
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
    size_left: Size
    size_right: Size
    K_left: Array
    K_right: Array
    F: Array
    """right^T F left = 0 for pixels, of norm 1."""
    line_left: Array | None
    """None where the right pixel is the epipole: then every left one may be its partner."""
    line_right: Array | None
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
    at_left = None if point is None else cameras.left.to_camera(point)
    disparity = None if p.pair else float(tri.disparity(left, right))
    target = point if p.noise == 0.0 else _point(METHODS[p.method](cameras.left, cameras.right, p.left_uv, p.right_uv))
    return TriangulationSolution(
        point=point,
        status=by_method[p.method].status,
        by_method=by_method,
        ray_gap=float(middle.gap),
        closest_points=_existing(middle.closest),
        depth=None if at_left is None else at_left.item(2),
        point_left=at_left,
        disparity=disparity,
        depth_from_disparity=None if disparity is None else _from_disparity(p, disparity),
        **_uncertainty(cameras, point, sigma_of(p.noise)),
        parallax_angle=math.degrees(float(chosen.parallax)),
        ray_angle=math.degrees(float(middle.parallax)),
        point_angle=None if point is None else _angle_at(point, cameras),
        in_front=bool(chosen.in_front),
        measured_left=left,
        measured_right=right,
        size_left=cameras.sizes[0],
        size_right=cameras.sizes[1],
        K_left=cameras.left.K,
        K_right=cameras.right.K,
        F=cameras.F,
        line_left=_existing(epipolar_line_left(cameras.F, right)),
        line_right=_existing(epipolar_line_right(cameras.F, left)),
        target=target,
        true_point=target if p.noise > 0.0 and _meet(p, cameras) else None,
        cloud=_cloud(cameras, left, right, p.noise, p.seed) if point is not None else NO_POINTS,
        sight_left=pair(cameras.left.normalized(left)),
        sight_right=pair(cameras.right.normalized(right)),
        **_linear(cameras, left, right),
        matched=_matched(p, cameras, point, at_left),
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


def _from_disparity(p: TriangulationParams, disparity: float) -> float | None:
    depth = float(tri.depth_from_disparity(disparity, p.baseline, p.focal, p.doffs))
    return depth if depth > 0.0 else None


def _meet(p: TriangulationParams, cameras: Rig) -> bool:
    """Whether the rays of the pixels without noise meet."""
    if p.pair is None:
        return p.left_uv[1] == p.right_uv[1]
    return float(sampson_distance(cameras.F, p.left_uv, p.right_uv)) < MEET


def _matched(
    p: TriangulationParams, cameras: Rig, point: Array | None, at_left: Array | None
) -> corners.Matched | None:
    depth = 0.0 if at_left is None else at_left.item(2)
    return corners.matched(cameras.world, p.left_uv, p.right_uv, cameras.sizes, point, depth)


def _angle_at(point: Array, cameras: Rig) -> float:
    """Degrees at a point between the lines to both cameras."""
    to_left, between = cameras.left.center - point, cameras.right.center - cameras.left.center
    across = np.linalg.norm(np.cross(to_left, between))
    return math.degrees(math.atan2(across, to_left @ (to_left + between)))


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
    forward = cameras.left.R[2]
    values = known, lengths, quaternion.from_matrix(directions), math.sqrt(forward @ known @ forward)
    return {"sigma_px": sigma, **dict(zip(names, values, strict=True))}


def _point(found: tri.Triangulation) -> Array | None:
    return found.point if found.valid else None


def _existing(array: Array) -> Array | None:
    return array if math.isfinite(array.sum()) else None


def pair(array: Array) -> Pixel:
    """Two coordinates as plain numbers."""
    u, v = array.tolist()
    return u, v
