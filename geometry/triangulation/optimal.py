"""The optimal method: move both pixels as little as possible, in all, until their rays meet."""

from functools import lru_cache

import numpy as np
import numpy.typing as npt

from ..arrays import Array, Components, Mask, components, everywhere, square_root, stack
from ..camera import Camera
from ..epipolar import baseline, essential
from .hartley_sturm import least_correction
from .rays import advance, direction, nearest_depth, parallax
from .result import Triangulation, conclude, pixel_pairs

_ITERATIONS = 20
_SETTLED = 1e-14  # focal lengths
_TINY = float(np.finfo(np.float64).tiny)  # makes 0 / 0, a pair of epipoles, no step


def triangulate_optimal(left: Camera, right: Camera, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike) -> Triangulation:
    """Triangulate pixels (..., 2) by the point whose reprojection errors, squared and added, are least.

    The most likely point if all four coordinates have the same Gaussian noise.
    Raises GeometryError at zero baseline.
    Source: `correct_matches`; the corrected rays meet, and their point is found in closed form.
    """
    between = baseline(left, right).tolist()
    pairs, defined = pixel_pairs(*correct_matches(left, right, uv_left, uv_right))
    with np.errstate(all="ignore"):
        ul, vl, ur, vr = components(pairs)
        a, b = direction(left, ul, vl), direction(right, ur, vr)
        point = advance(left, nearest_depth(between, a, b), a)
        return Triangulation(*conclude((left, right), point, parallax(a, b), True, defined))


def correct_matches(
    left: Camera, right: Camera, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike
) -> tuple[Array, Array]:
    """Return the nearest pixels (..., 2), left and right, whose rays meet: least |Δleft|² + |Δright|².

    NaN for pairs that aren't defined. Raises GeometryError at zero baseline.
    Source: Lindström 2010, "Triangulation made easy", iterated until it settles; in all the tests' comparisons it
    does so at the least of the minima. Where it doesn't settle, near an epipole, Hartley and Sturm 1997.
    """
    pairs, defined = pixel_pairs(uv_left, uv_right)
    # One scale for both images keeps the least correction what it is, and the numbers near one.
    scale = left.K.item(0, 0)
    x = (pairs - np.concatenate([left.K[:2, 2], right.K[:2, 2]])) / scale
    F = _scaled_fundamental(left, right)
    with np.errstate(all="ignore"):
        move, settled = _lindstrom(F, components(x))
    if not settled.all():
        for index in map(tuple, np.argwhere(~settled)):
            move[index] = least_correction(F, x[index])
    corrected = pairs + np.where(defined[..., None], scale * move, np.nan)
    return corrected[..., :2], corrected[..., 2:]


@lru_cache(maxsize=64)
def _scaled_fundamental(left: Camera, right: Camera) -> Array:
    scale = left.K.item(0, 0)
    return _unscaled(right, scale).T @ essential(left, right) @ _unscaled(left, scale)


def _unscaled(camera: Camera, scale: float) -> Array:
    (fx, skew, _), (_, fy, _), _ = camera.K.tolist()
    return np.array([[scale / fx, -skew * scale / (fx * fy), 0.0], [0.0, scale / fy, 0.0], [0.0, 0.0, 1.0]])


def _lindstrom(F: Array, pair: Components) -> tuple[Array, Mask]:
    """Return the move (..., 4) of a pair to the quadric right^T F left = 0, and where it settled."""
    (a, b, c), (d, e, f), (g, h, i) = F.tolist()
    ul, vl, ur, vr = pair
    gradient = a * ur + d * vr + g, b * ur + e * vr + h, a * ul + b * vl + c, d * ul + e * vl + f
    residual = ur * gradient[2] + vr * gradient[3] + g * ul + h * vl + i
    normal = gradient
    for _ in range(_ITERATIONS):
        nul, nvl, nur, nvr = normal
        bend = a * nur + d * nvr, b * nur + e * nvr, a * nul + b * nvl, d * nul + e * nvl
        # Along the normal, the quadric is at residual − 2 half step + curve step² = 0.
        half = 0.5 * sum(n * t for n, t in zip(normal, gradient, strict=True))
        curve = nur * bend[2] + nvr * bend[3]
        step = residual / (half + square_root(half * half - curve * residual) + _TINY)
        previous, normal = normal, tuple(t - step * w for t, w in zip(gradient, bend, strict=True))
        turned = sum(abs(new - old) for new, old in zip(normal, previous, strict=True))
        settled = abs(step) * turned <= _SETTLED
        if everywhere(settled):
            break
    return stack(*(-step * n for n in previous)), np.asarray(settled)
