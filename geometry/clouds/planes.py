"""The plane that most points are on, by RANSAC and least squares."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..arrays import Array, Mask, norm
from ..errors import GeometryError, as_finite_array, as_number
from ..rotations import unit
from .points import Indices, as_cloud

_SAMPLE = 1024  # points on which hypotheses are compared
_FINALISTS = 16  # of them are compared on all points
_ROUNDS = 20  # of least squares on the inliers, until these don't change


@dataclass(frozen=True, eq=False)
class Plane:
    """The plane n·p + offset = 0 with unit normal n (3,), and what supports it.

    `inliers` (N,) are the points within the distance, `rms` their root mean square distance in metres. `spread` is
    the standard deviation in metres of the inliers along the plane's narrower direction: the smaller it is beside
    `rms`, the less sure is the plane's tilt, about rms / spread / √n radians.
    """

    normal: Array
    offset: float
    inliers: Mask
    rms: float
    spread: float

    def distance(self, points: npt.ArrayLike) -> Array:
        """Return the signed distances (...) of points (..., 3), in metres: positive where the normal points."""
        return np.asarray(np.asarray(points, dtype=np.float64) @ self.normal + self.offset)


def ransac_plane(
    points: npt.ArrayLike,
    distance: float,
    *,
    seed: int = 0,
    hypotheses: int = 1024,
    up: npt.ArrayLike | None = None,
    tilt: float = math.pi / 2.0,
) -> Plane:
    """Find the plane with most points (N, 3) within a distance in metres, then fit it to those by least squares.

    With `up` (3,) only planes are tried whose normal is within `tilt` radians of it, and the normal points up.
    The same seed gives the same plane.
    Raises GeometryError for fewer than three points, points on a line, and if no plane has the tilt.
    Source: Fischler and Bolles 1981; the hypotheses are compared on a sample, the best of them on all points.
    """
    cloud, distance = as_cloud("points", points), as_number("distance", distance, above=0.0)
    upwards = np.array([0.0, 0.0, 1.0]) if up is None else unit(as_finite_array("up", up, 3), "up")
    steepest = math.cos(as_number("tilt", tilt, least=0.0)) if up is not None else -1.0
    if len(cloud) < 3:
        raise GeometryError("points", f"{len(cloud)} points", "at least three")
    center = cloud.mean(axis=0)
    centred = cloud - center
    rng = np.random.default_rng(seed)
    normals, offsets = _hypotheses(centred, rng, hypotheses, upwards, steepest)
    sample = centred if len(cloud) <= _SAMPLE else centred[rng.integers(len(cloud), size=_SAMPLE)]
    votes = (np.abs(sample @ normals.T + offsets) <= distance).sum(axis=0)
    finalists = np.argsort(-votes, kind="stable")[:_FINALISTS]
    inliers = max((_near(centred, normals[i], offsets[i], distance) for i in finalists), key=np.count_nonzero)
    return _refined(centred, center, inliers, distance, upwards, steepest)


def fit_plane(points: npt.ArrayLike) -> tuple[Array, Array, Array]:
    """Return unit normal (3,), centroid (3,) and variances (3,), rising, in m² of the plane nearest to points (N, 3).

    Raises GeometryError for fewer than three points, and for points on a line.
    """
    cloud = as_cloud("points", points)
    if len(cloud) < 3:
        raise GeometryError("points", f"{len(cloud)} points", "at least three")
    center = cloud.mean(axis=0)
    offsets = cloud - center
    values, vectors = np.linalg.eigh(offsets.T @ offsets / len(cloud))
    if values[1] <= 1e-12 * values[2] or values[2] == 0.0:
        raise GeometryError("points", f"{len(cloud)} points on a line", "points that span a plane")
    return vectors[:, 0], center, np.maximum(values, 0.0)


def _hypotheses(
    centred: Array, rng: np.random.Generator, count: int, up: Array, steepest: float
) -> tuple[Array, Array]:
    """Planes through three points each, (H, 3) and (H,), turned up."""
    a, b, c = centred[_triples(len(centred), rng, count)].transpose(1, 0, 2)
    across = np.cross(b - a, c - a)
    length, sides = norm(across), norm(b - a) * norm(c - a)
    spanned = length > 1e-9 * sides
    normals = across[spanned] / length[spanned, None]
    a = a[spanned]
    if not len(normals):
        normals, a = fit_plane(centred)[0][None], np.zeros((1, 3))
    normals *= np.where(normals @ up < 0.0, -1.0, 1.0)[:, None]
    allowed = normals @ up >= steepest
    if not allowed.any():
        raise GeometryError("tilt", "no plane through three of the points within it", "a larger tilt")
    return normals[allowed], -np.vecdot(normals, a)[allowed]


def _triples(length: int, rng: np.random.Generator, count: int) -> Indices:
    """Three different places each: a step is added wherever a place is taken already."""
    first = rng.integers(length, size=count)
    second = (first + 1 + rng.integers(length - 1, size=count)) % length
    low, high = np.minimum(first, second), np.maximum(first, second)
    third = rng.integers(length - 2, size=count)
    third += third >= low
    third += third >= high
    return np.stack([first, second, third], axis=1)


def _near(centred: Array, normal: Array, offset: float, distance: float) -> Mask:
    return np.asarray(np.abs(centred @ normal + offset) <= distance)


def _refined(centred: Array, center: Array, inliers: Mask, distance: float, up: Array, steepest: float) -> Plane:
    """Least squares on the inliers, anew until they don't change; the last that keeps the tilt."""
    found: Plane | None = None
    for _ in range(_ROUNDS):
        normal, middle, values = fit_plane(centred[inliers])
        normal = normal if normal @ up >= 0.0 else -normal
        if found is not None and normal @ up < steepest:
            break
        offset = -float(normal @ middle)
        new = _near(centred, normal, offset, distance)
        if np.count_nonzero(new) < 3:
            break
        rms = float(np.sqrt(np.mean((centred[new] @ normal + offset) ** 2)))
        found = Plane(normal, offset - float(normal @ center), new, rms, float(np.sqrt(values[1])))
        if (new == inliers).all():
            break
        inliers = new
    if found is None:
        raise GeometryError("points", "points among which no plane holds", "points of which some are near to a plane")
    return found
