"""The mid-point method: half-way between the nearest points of the two lines of sight."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ..arrays import Array, Components, Mask, components, cross, dot, ratio, square_root, stack
from ..camera import Camera
from ..epipolar import baseline
from .rays import advance, direction, nearest_depth, parallax
from .result import PARALLEL, Triangulation, conclude, pixel_pairs


@dataclass(frozen=True, eq=False)
class Midpoint(Triangulation):
    """A Triangulation with the `gap` (...) between the lines of sight in metres, and their nearest points.

    `closest` (..., 2, 3) has the point of the left line, then of the right; NaN where the lines are parallel.
    """

    gap: Array
    closest: Array


def triangulate_midpoint(left: Camera, right: Camera, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike) -> Midpoint:
    """Triangulate pixels (..., 2) by the middle of the lines' common perpendicular, in closed form.

    Quick, and good for a wide baseline; it degrades near the epipoles and isn't projectively invariant.
    Raises GeometryError at zero baseline.
    Source: Hartley and Sturm 1997, "Triangulation".
    """
    between = baseline(left, right).tolist()
    pairs, defined = pixel_pairs(uv_left, uv_right)
    with np.errstate(all="ignore"):
        ul, vl, ur, vr = components(pairs)
        a, b = direction(left, ul, vl), direction(right, ur, vr)
        depth_left, depth_right = nearest_depth(between, a, b), -nearest_depth(between, b, a)
        on_left, on_right = advance(left, depth_left, a), advance(right, depth_right, b)
        middle = [0.5 * (x + y) for x, y in zip(on_left, on_right, strict=True)]
        ahead = (depth_left > 0.0) & (depth_right > 0.0)
        point, status, angle = conclude((left, right), middle, parallax(a, b), ahead, defined)
        gap = np.where(defined, _gap(between, a, b, angle > PARALLEL), np.nan)
        closest = stack(*on_left, *on_right).reshape(*defined.shape, 2, 3)
    return Midpoint(point, status, angle, gap, np.where((angle > PARALLEL)[..., None, None], closest, np.nan))


def _gap(between: Components, a: Components, b: Components, skew: Mask) -> Any:
    normal, apart = cross(a, b), cross(between, a)
    of_skew = ratio(abs(dot(between, normal)), square_root(dot(normal, normal)))
    return np.where(skew, of_skew, square_root(dot(apart, apart) / dot(a, a)))
