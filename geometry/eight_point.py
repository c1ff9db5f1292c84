"""The fundamental matrix from matching pixels, by the normalised eight-point algorithm."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .arrays import Array, norm
from .epipolar import normalize
from .errors import GeometryError, as_finite_array

FEWEST = 8
_SINGULAR = 1e-12  # ratio of singular values below which rounding alone tells the solutions apart


@dataclass(frozen=True, eq=False)
class EightPoint:
    """F (3, 3) of rank 2, scaled as `fundamental` scales it, and how well the pixels fix it.

    `conditioning` is the ratio of the eighth to the first singular value of the equations: the nearer to zero, the
    more the answer owes to noise. Where it is zero but for rounding, more than one F fits, and F is NaN: so for points
    on one plane, for cameras that only turn, and for pixels that coincide. `singular_values` (3,) are those of F in
    normalised coordinates before its rank was enforced, the largest 1; the last one is zero for exact pixels.
    """

    F: Array
    conditioning: float
    singular_values: Array

    @property
    def unique(self) -> bool:
        """Whether the pixels fix F."""
        return math.isfinite(self.F.item(0))


def eight_point(uv_left: npt.ArrayLike, uv_right: npt.ArrayLike) -> EightPoint:
    """Return the F that fits matching pixels (n, 2), n ≥ 8, left and right, in the least-squares sense.

    It minimises the algebraic error in coordinates with their centroid at 0 and a mean distance of √2 from it, and then
    takes the nearest matrix of rank 2.
    Raises GeometryError for fewer than eight pairs, or pixels that aren't finite.
    Source: Hartley 1997, "In defense of the eight-point algorithm"; Hartley and Zisserman 2004, algorithm 11.1.
    """
    left, right = as_finite_array("uv_left", uv_left, 2), as_finite_array("uv_right", uv_right, 2)
    if left.ndim != 2 or len(left) < FEWEST:
        raise GeometryError("uv_left", f"an array of shape {left.shape}", f"shape (n, 2) with n at least {FEWEST}")
    if right.shape != left.shape:
        raise GeometryError("uv_right", f"an array of shape {right.shape}", f"the shape of uv_left, {left.shape}")
    (T_left, p), (T_right, q) = _normalized(left), _normalized(right)
    equations = (q[:, :, None] * p[:, None, :]).reshape(-1, 9)
    _, singular, Vt = np.linalg.svd(equations, full_matrices=len(left) < 9)
    conditioning = float(singular[7] / singular[0])
    if conditioning <= _SINGULAR:
        return EightPoint(np.full((3, 3), math.nan), 0.0, np.full(3, math.nan))
    U, values, Wt = np.linalg.svd(Vt[8].reshape(3, 3))
    F = T_right.T @ (U[:, :2] * values[:2]) @ Wt[:2] @ T_left
    return EightPoint(normalize(F), conditioning, values / values[0])


def _normalized(pixels: Array) -> tuple[Array, Array]:
    """A similarity (3, 3) to centroid 0 and mean distance √2, and the pixels (n, 3) after it."""
    centre = pixels.mean(axis=0)
    with np.errstate(over="ignore"):  # pixels beyond all bounds have no spread that counts: they fix nothing
        spread = float(norm(pixels - centre).mean())
    scale = math.sqrt(2.0) / spread if spread > 1e-14 * float(np.abs(pixels).max()) else 1.0
    u, v = (-scale * centre).tolist()
    T = np.array([[scale, 0.0, u], [0.0, scale, v], [0.0, 0.0, 1.0]])
    return T, np.column_stack([scale * (pixels - centre), np.ones(len(pixels))])
