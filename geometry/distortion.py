"""What a lens does to a picture: radial and tangential distortion, as OpenCV and most calibration tools state it."""

import math
from dataclasses import astuple, dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from .arrays import Array, components, norm, stack
from .errors import as_array, as_number

_STEPS, _NEAR = 30, 1e-13  # of Newton's method; how near the last step must be, in focal lengths


@dataclass(frozen=True)
class Distortion:
    """Coefficients without unit, in OpenCV's order: radial k1 and k2, tangential p1 and p2, radial k3.

    They act on normalised image coordinates x, y (at z = 1): with r² = x² + y² and d = 1 + k1 r² + k2 r⁴ + k3 r⁶,
    x′ = x d + 2 p1 x y + p2 (r² + 2 x²) and y′ = y d + p1 (r² + 2 y²) + 2 p2 x y.
    Raises GeometryError if one isn't finite. Source: Brown 1966; OpenCV, "Camera calibration and 3D reconstruction".
    """

    k1: float = 0.0
    k2: float = 0.0
    p1: float = 0.0
    p2: float = 0.0
    k3: float = 0.0

    def __post_init__(self) -> None:
        for name in ("k1", "k2", "p1", "p2", "k3"):
            as_number(name, getattr(self, name))

    def __bool__(self) -> bool:
        """Whether it changes anything."""
        return any(astuple(self))

    @cached_property
    def reach(self) -> float:
        """The radius up to which what is farther out is also shown farther out, by k1, k2 and k3; often infinite.

        Beyond it the formula folds the picture back, which no lens does.
        """
        # The slope 1 + 3 k1 r² + 5 k2 r⁴ + 7 k3 r⁶ is zero there: a cubic of 1/r², without a coefficient to divide by.
        roots = np.roots([1.0, 3.0 * self.k1, 5.0 * self.k2, 7.0 * self.k3]).tolist()
        turns = [root.real for root in roots if root.real > 0.0 and abs(root.imag) < 1e-9 * abs(root)]
        return math.sqrt(1.0 / max(turns)) if turns else math.inf

    @np.errstate(invalid="ignore", over="ignore")
    def apply(self, points: npt.ArrayLike) -> Array:
        """Return where points (..., 2) in normalised coordinates are seen through the lens, (..., 2)."""
        x, y = components(as_array("points", points, 2))
        r2 = x * x + y * y
        d = 1.0 + r2 * (self.k1 + r2 * (self.k2 + r2 * self.k3))
        return stack(
            x * d + 2.0 * self.p1 * x * y + self.p2 * (r2 + 2.0 * x * x),
            y * d + self.p1 * (r2 + 2.0 * y * y) + 2.0 * self.p2 * x * y,
        )

    @np.errstate(all="ignore")
    def undo(self, points: npt.ArrayLike) -> Array:
        """Return the points (..., 2) that the lens shows at given ones: the inverse of `apply`, within its reach.

        By Newton's method from the given points. NaN where that finds none, or one beyond the reach.
        """
        seen = as_array("points", points, 2)
        found = seen.copy()
        step = np.full_like(found, np.inf)
        for _ in range(_STEPS):
            off = self.apply(found) - seen
            a, b, c, d = self._slopes(found)
            det = a * d - b * c
            step = np.stack([d * off[..., 0] - b * off[..., 1], a * off[..., 1] - c * off[..., 0]], axis=-1)
            step /= det[..., None]
            found = found - step
            if not (np.abs(step) > _NEAR).any():
                break
        good = (norm(step) <= 1e-9 * (1.0 + norm(found))) & (norm(found) <= self.reach)
        return np.where(good[..., None], found, np.nan)

    def _slopes(self, points: Array) -> tuple[Array, Array, Array, Array]:
        """∂x′/∂x, ∂x′/∂y, ∂y′/∂x, ∂y′/∂y."""
        x, y = points[..., 0], points[..., 1]
        r2 = x * x + y * y
        d = 1.0 + r2 * (self.k1 + r2 * (self.k2 + r2 * self.k3))
        growth = 2.0 * (self.k1 + r2 * (2.0 * self.k2 + 3.0 * r2 * self.k3))
        across = growth * x * y + 2.0 * self.p1 * x + 2.0 * self.p2 * y
        return (
            d + growth * x * x + 2.0 * self.p1 * y + 6.0 * self.p2 * x,
            across,
            across,
            d + growth * y * y + 6.0 * self.p1 * y + 2.0 * self.p2 * x,
        )
