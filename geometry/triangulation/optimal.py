"""The optimal method: move both pixels as little as possible, in all, until their rays meet."""

import numpy as np
import numpy.typing as npt

from ..arrays import Array, Mask, components
from ..camera import Camera
from ..epipolar import baseline, essential
from .hartley_sturm import least_correction
from .midpoint import nearest_points
from .result import Triangulation, conclude, pixel_pairs

_ITERATIONS = 20
_SETTLED = 1e-14  # focal lengths
_TINY = float(np.finfo(np.float64).tiny)  # makes 0 / 0, a pair of epipoles, no step


def triangulate_optimal(
    left: Camera, right: Camera, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike
) -> Triangulation:
    """Triangulate pixels (..., 2) by the point whose reprojection errors, squared and added, are least.

    The most likely point if all four coordinates have the same Gaussian noise.
    Raises GeometryError at zero baseline.
    Source: `correct_matches`; the corrected rays meet, and their point is found in closed form.
    """
    between = baseline(left, right)
    pairs, defined = pixel_pairs(*correct_matches(left, right, uv_left, uv_right))
    with np.errstate(all="ignore"):
        on_left, on_right, _, ahead = nearest_points(left, right, between, components(pairs))
        middle = [0.5 * (x + y) for x, y in zip(on_left, on_right, strict=True)]
        return Triangulation(*conclude((left, right), between, middle, ahead, defined))


def correct_matches(
    left: Camera, right: Camera, uv_left: npt.ArrayLike, uv_right: npt.ArrayLike
) -> tuple[Array, Array]:
    """Return the nearest pixels (..., 2), left and right, whose rays meet: least |Δleft|² + |Δright|².

    NaN for pairs that aren't defined. Raises GeometryError at zero baseline.
    Source: Lindström 2010, "Triangulation made easy", iterated until it settles, which was at the least of all
    minima wherever it was compared; where it doesn't (near the epipoles), Hartley and Sturm 1997, "Triangulation".
    """
    pairs, defined = pixel_pairs(uv_left, uv_right)
    # One scale for both images keeps the least correction what it is, and the numbers near one.
    scale = left.K[0, 0]
    x = (pairs - np.concatenate([left.K[:2, 2], right.K[:2, 2]])) / scale
    F = _unscaled(right, scale).T @ essential(left, right) @ _unscaled(left, scale)
    with np.errstate(all="ignore"):
        move, settled = _lindstrom(F, x)
    for index in map(tuple, np.argwhere(~settled)):
        move[index] = least_correction(F, x[index])
    corrected = pairs + np.where(defined[..., None], scale * move, np.nan)
    return corrected[..., :2], corrected[..., 2:]


def _unscaled(camera: Camera, scale: float) -> Array:
    (fx, skew, _), (_, fy, _), _ = camera.K.tolist()
    return np.array([[scale / fx, -skew * scale / (fx * fy), 0.0], [0.0, scale / fy, 0.0], [0.0, 0.0, 1.0]])


def _lindstrom(F: Array, x: Array) -> tuple[Array, Mask]:
    """Return the move (..., 4) from x = (left, right) to the quadric right^T F left = 0, and where it settled."""
    B = np.zeros((4, 4))
    B[:2, 2:], B[2:, :2] = F[:2, :2].T, F[:2, :2]
    linear = np.concatenate([F[2, :2], F[:2, 2]])
    gradient = x @ B + linear
    residual = 0.5 * np.vecdot(x, gradient + linear) + F[2, 2]
    move, normal = np.zeros_like(x), gradient
    for _ in range(_ITERATIONS):
        # Along the normal, residual − 2 half step + curve step² = 0 on the quadric.
        bend = normal @ B
        half, curve = 0.5 * np.vecdot(normal, gradient), 0.5 * np.vecdot(normal, bend)
        step = residual / (half + np.sqrt(half * half - curve * residual) + _TINY)
        previous, move = move, -step[..., None] * normal
        normal = gradient - step[..., None] * bend
        settled = np.abs(move - previous).max(axis=-1) <= _SETTLED
        if settled.all():
            break
    return move, settled
