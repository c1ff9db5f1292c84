"""Cameras without perspective: scaled orthographic projection, which weak perspective is too."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from .arrays import Array, components, if_positive, stack
from .camera import Camera
from .errors import GeometryError, as_finite_array, as_number


@dataclass(frozen=True, eq=False)
class AffineCamera:
    """A camera that divides by one depth (metres, above 0) for every point, instead of by the point's own.

    At that depth it shows what the perspective camera shows: u = (fx x + s y) / depth + cx, v = fy y / depth + cy.
    Source: Hartley and Zisserman 2004, sec. 6.3.
    """

    perspective: Camera
    depth: float

    def __post_init__(self) -> None:
        as_number("depth", self.depth, above=0.0)

    @cached_property
    def P(self) -> Array:
        """Projection matrix (3, 4), with last row (0, 0, 0, 1)."""
        flattened = self.perspective.T_camera_world[:3].copy()
        flattened[2] = (0.0, 0.0, 0.0, self.depth)
        return self.perspective.K @ flattened / self.depth

    @property
    def depth_row(self) -> Array:
        """Row (4,) whose product with a homogeneous world point is its depth in metres."""
        return self.perspective.depth_row

    def project(self, points: npt.ArrayLike) -> tuple[Array, Array]:
        """Return the pixels (..., 2) of world points (..., 3), and their depths (...) along z in metres.

        A point that isn't in front of the camera (depth ≤ 0), or isn't finite, has no pixel: NaN, as for the
        perspective camera.
        """
        (fx, skew, cx), (_, fy, cy), _ = self.perspective.K.tolist()
        with np.errstate(all="ignore"):
            x, y, depth = components(self.perspective.to_camera(points))
            nothing = 0.0 * if_positive(depth) + 0.0 * x + 0.0 * y
            u, v = (fx * x + skew * y) / self.depth + cx, fy * y / self.depth + cy
            return stack(u + nothing, v + nothing), np.asarray(depth)


def weak_perspective(camera: Camera, points: npt.ArrayLike) -> AffineCamera:
    """Return the affine camera that is nearest to a perspective one about points (n, 3): at their mean depth.

    Raises GeometryError where that depth isn't positive, and where there are no points.
    Source: Hartley and Zisserman 2004, sec. 6.3.1.
    """
    P = as_finite_array("points", points, 3).reshape(-1, 3)
    if not len(P):
        raise GeometryError("points", "none", "one point or more")
    mean = float(camera.to_camera(P)[:, 2].mean())
    if mean <= 0.0:
        raise GeometryError("points", f"at a mean depth of {mean:g}", "points whose mean depth is above 0")
    return AffineCamera(camera, mean)
