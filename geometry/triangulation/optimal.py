"""The optimal method: move both pixels as little as possible, in all, until their rays meet."""

from typing import Any

import numpy as np
import numpy.typing as npt

from ..arrays import Array, Mask, components, quotient, square_root, stack
from ..camera import Camera
from ..epipolar import baseline, essential
from .hartley_sturm import least_correction
from .midpoint import nearest_points
from .result import Triangulation, conclude, pixel_pairs

_ITERATIONS = 20
_SETTLED = 1e-14  # focal lengths


def triangulate_optimal(
    left: Camera, right: Camera, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike
) -> Triangulation:
    """Triangulate pixels (..., 2) by the point whose reprojection errors, squared and added, are least.

    The most likely point if all four coordinates have the same Gaussian noise.
    Raises GeometryError at zero baseline.
    Source: `correct_matches`; the corrected rays meet, and their point is found in closed form.
    """
    between = baseline(left, right)
    pixels_left, pixels_right, defined = pixel_pairs(*correct_matches(left, right, uv_left, uv_right))
    with np.errstate(all="ignore"):
        closest, _, ahead = nearest_points(left, right, between, pixels_left, pixels_right)
        points = 0.5 * (closest[..., 0, :] + closest[..., 1, :])
        return Triangulation(*conclude(left, right, between, points, ahead, defined))


def correct_matches(
    left: Camera, right: Camera, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike
) -> tuple[Array, Array]:
    """Return the nearest pixels (..., 2), left and right, whose rays meet: least |Δleft|² + |Δright|².

    NaN for pairs that aren't defined. Raises GeometryError at zero baseline.
    Source: Lindström 2010, "Triangulation made easy", iterated until it settles, which was the least of all minima
    wherever we compared; for the pairs near an epipole where it doesn't, Hartley and Sturm 1997, "Triangulation".
    """
    pixels_left, pixels_right, defined = pixel_pairs(uv_left, uv_right)
    # One scale for both images keeps the least correction what it is, and the numbers near one.
    scale, centre_left, centre_right = left.K[0, 0], left.K[:2, 2], right.K[:2, 2]
    x_left, x_right = (pixels_left - centre_left) / scale, (pixels_right - centre_right) / scale
    F = _unscaled(right, scale).T @ essential(left, right) @ _unscaled(left, scale)
    with np.errstate(all="ignore"):
        move, settled = _lindstrom(F, x_left, x_right)
    for index in np.argwhere(~settled):
        at = tuple(index)
        move[at] = least_correction(F, x_left[at], x_right[at])
    move = np.where(defined[..., None], scale * move, np.nan)
    return pixels_left + move[..., :2], pixels_right + move[..., 2:]


def _unscaled(camera: Camera, scale: float) -> Array:
    (fx, skew, _), (_, fy, _), _ = camera.K.tolist()
    return np.array([[scale / fx, -skew * scale / (fx * fy), 0.0], [0.0, scale / fy, 0.0], [0.0, 0.0, 1.0]])


def _lindstrom(F: Array, left: Array, right: Array) -> tuple[Array, Mask]:
    (a, b, c), (d, e, f), (g, h, i) = F.tolist()
    (ul, vl), (ur, vr) = components(left), components(right)
    # The gradient of right^T F left by (ul, vl, ur, vr).
    gradient = a * ur + d * vr + g, b * ur + e * vr + h, a * ul + b * vl + c, d * ul + e * vl + f
    residual = ur * gradient[2] + vr * gradient[3] + g * ul + h * vl + i
    normal: tuple[Any, ...] = gradient
    move: tuple[Any, ...] = (0.0, 0.0, 0.0, 0.0)
    for _ in range(_ITERATIONS):
        nul, nvl, nur, nvr = normal
        bend = a * nur + d * nvr, b * nur + e * nvr, a * nul + b * nvl, d * nul + e * nvl
        # The step along the normal that meets the constraint: residual - 2 half step + curve step² = 0.
        half = 0.5 * _sum_of_products(normal, gradient)
        curve = nur * bend[2] + nvr * bend[3]
        step = quotient(residual, half + square_root(half * half - curve * residual))
        previous, move = move, tuple(-step * n for n in normal)
        normal = tuple(g - step * t for g, t in zip(gradient, bend, strict=True))
        settled = sum(abs(new - old) for new, old in zip(move, previous, strict=True)) <= _SETTLED
        if np.all(settled):
            break
    return stack(*move), np.asarray(settled)


def _sum_of_products(a: tuple[Any, ...], b: tuple[Any, ...]) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
