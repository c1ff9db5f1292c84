"""The mid-point method: half-way between the nearest points of the two lines of sight."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ..arrays import Array, Components, components, cross, dot, ratio, stack
from ..camera import Camera
from ..epipolar import baseline
from .result import Triangulation, conclude, pixel_pairs


@dataclass(frozen=True, eq=False)
class Midpoint(Triangulation):
    """A Triangulation with the `gap` (...) between the lines of sight in metres, and their nearest points.

    `closest` (..., 2, 3) has the point of the left line, then of the right; NaN where the lines are parallel.
    """

    gap: Array
    closest: Array


def triangulate_midpoint(
    left: Camera, right: Camera, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike
) -> Midpoint:
    """Triangulate pixels (..., 2) by the middle of the lines' common perpendicular, in closed form.

    Quick, and good for a wide baseline; it degrades near the epipoles and isn't projectively invariant.
    Raises GeometryError at zero baseline.
    Source: Hartley and Sturm 1997, "Triangulation", sec. 5.3.
    """
    between = baseline(left, right)
    pairs, defined = pixel_pairs(uv_left, uv_right)
    with np.errstate(all="ignore"):
        on_left, on_right, gap, ahead = nearest_points(left, right, between, components(pairs))
        middle = [0.5 * (x + y) for x, y in zip(on_left, on_right, strict=True)]
        fields = conclude((left, right), between, middle, ahead, defined)
        both = stack(*on_left, *on_right).reshape(*defined.shape, 2, 3)
    return Midpoint(*fields, np.where(defined, gap, np.nan), np.where(defined[..., None, None], both, np.nan))


def nearest_points(
    left: Camera, right: Camera, between: Array, pair: Components
) -> tuple[Any, Any, Any, Any]:
    """Return the nearest points of two lines of sight (components), their gap, and whether both are ahead."""
    base = between.tolist()
    toward_left, toward_right = _direction(left, *pair[:2]), _direction(right, *pair[2:])
    normal = cross(toward_left, toward_right)
    squared = dot(normal, normal)
    along_left = ratio(dot(cross(base, toward_right), normal), squared)
    along_right = ratio(dot(cross(base, toward_left), normal), squared)
    on_left = [c + along_left * d for c, d in zip(left.center.tolist(), toward_left, strict=True)]
    on_right = [c + along_right * d for c, d in zip(right.center.tolist(), toward_right, strict=True)]
    return (
        on_left,
        on_right,
        _gap(base, toward_left, normal, squared),
        (along_left > 0.0) & (along_right > 0.0),
    )


def _direction(camera: Camera, u: Any, v: Any) -> list[Any]:
    return [a * u + b * v + c for a, b, c in camera.back_projection.tolist()]


def _gap(base: Components, toward: Components, normal: Components, squared: Any) -> Any:
    apart = cross(base, toward)
    parallel = (dot(apart, apart) / dot(toward, toward)) ** 0.5
    return np.where(squared > 0.0, ratio(abs(dot(base, normal)), squared**0.5), parallel)
