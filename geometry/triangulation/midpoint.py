"""The mid-point method: half-way between the nearest points of the two rays."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..arrays import Array, Mask, cross, dot, norm
from ..camera import Camera
from ..epipolar import baseline
from .result import Triangulation, conclude, pixel_pairs


@dataclass(frozen=True, eq=False)
class Midpoint(Triangulation):
    """A Triangulation with the `gap` (...) between the lines of sight in metres, and their nearest points.

    `closest` (..., 2, 3) has the point of the left line, then of the right; NaN where the rays are parallel.
    """

    gap: Array
    closest: Array


def triangulate_midpoint(
    left: Camera, right: Camera, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike
) -> Midpoint:
    """Triangulate pixels (..., 2) by the middle of the common perpendicular of their rays, in closed form.

    Quick, and good for a wide baseline; it degrades near the epipoles and isn't projectively invariant.
    Raises GeometryError at zero baseline.
    Source: Hartley and Sturm 1997, "Triangulation", sec. 5.3.
    """
    between = baseline(left, right)
    pixels_left, pixels_right, defined = pixel_pairs(uv_left, uv_right)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        closest, gap, ahead = nearest_points(left, right, between, pixels_left, pixels_right)
        fields = conclude(
            left, right, between, 0.5 * (closest[..., 0, :] + closest[..., 1, :]), ahead, defined
        )
    infinite = ~np.isfinite(closest).all(axis=(-2, -1), keepdims=True) | ~defined[..., None, None]
    return Midpoint(*fields, np.where(defined, gap, np.nan), np.where(infinite, np.nan, closest))


def nearest_points(
    left: Camera, right: Camera, between: Array, pixels_left: Array, pixels_right: Array
) -> tuple[Array, Array, Mask]:
    """Return the nearest points (..., 2, 3) of two lines of sight, the gap (...), and which lie ahead on both rays."""
    origin_left, toward_left = left.pixel_ray(pixels_left)
    origin_right, toward_right = right.pixel_ray(pixels_right)
    normal = cross(toward_left, toward_right)
    squared = dot(normal, normal)
    along_left = dot(cross(between, toward_right), normal) / squared
    along_right = dot(cross(between, toward_left), normal) / squared
    closest = [
        origin_left + along_left[..., None] * toward_left,
        origin_right + along_right[..., None] * toward_right,
    ]
    skew_gap, parallel_gap = (
        np.abs(dot(between, normal)) / np.sqrt(squared),
        norm(cross(between, toward_left)),
    )
    gap = np.where(squared > 0.0, skew_gap, parallel_gap)
    return np.stack(closest, axis=-2), gap, (along_left > 0.0) & (along_right > 0.0)
