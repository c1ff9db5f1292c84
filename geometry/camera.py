"""The pinhole camera: x right, y down, z forward, integer pixel centres, p ~ K [R | t] X."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from .arrays import Array, components, norm, stack
from .errors import GeometryError, as_array, as_finite_array, as_number
from .rotations import as_rotation

# Columns are the camera's x, y and z in the world, for a level camera that looks along the world's +Y.
R_WORLD_LEVEL: Array = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
R_WORLD_LEVEL.flags.writeable = False


@dataclass(frozen=True, eq=False)
class Camera:
    """A calibrated camera: K (3, 3) in pixels, and T_camera_world (4, 4) in metres. Its arrays are read-only.

    Raises GeometryError if K isn't upper triangular with positive focal lengths and last row (0, 0, 1), or if
    T_camera_world isn't a rigid transform.
    Source: Hartley and Zisserman 2004, eqs. 6.8 and 6.9.
    """

    K: Array
    T_camera_world: Array

    def __post_init__(self) -> None:
        K = as_finite_array("K", self.K, 3, 3).copy()
        T = as_finite_array("T_camera_world", self.T_camera_world, 4, 4).copy()
        _check(K, T)
        for name, array in (("K", K), ("T_camera_world", T)):
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    @classmethod
    def from_intrinsics(
        cls, fx: float, fy: float, cx: float, cy: float, skew: float = 0.0, *, T_camera_world: npt.ArrayLike
    ) -> "Camera":
        """Build a camera from its focal lengths, principal point and skew, all in pixels."""
        K = np.array([[fx, skew, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])
        return cls(K, as_array("T_camera_world", T_camera_world, 4, 4))

    @cached_property
    def R(self) -> Array:
        """Rotation (3, 3) from world to camera axes."""
        return self.T_camera_world[:3, :3]

    @cached_property
    def t(self) -> Array:
        """World origin (3,) in camera coordinates."""
        return self.T_camera_world[:3, 3]

    @cached_property
    def K_inverse(self) -> Array:
        """Inverse (3, 3) of K: from homogeneous pixels to directions in camera axes."""
        (fx, skew, cx), (_, fy, cy), _ = self.K.tolist()
        across = -skew / (fx * fy)
        return np.array(
            [[1.0 / fx, across, -cx / fx - across * cy], [0.0, 1.0 / fy, -cy / fy], [0.0, 0.0, 1.0]]
        )

    @cached_property
    def P(self) -> Array:
        """Projection matrix K [R | t], (3, 4)."""
        return self.K @ self.T_camera_world[:3]

    @cached_property
    def center(self) -> Array:
        """Centre of projection −Rᵀt, (3,), in the world."""
        return -(self.t @ self.R)

    def to_camera(self, points: npt.ArrayLike) -> Array:
        """Return world points (..., 3) in camera coordinates, in metres."""
        return np.asarray(as_array("points", points, 3) @ self.R.T + self.t)

    def project(self, points: npt.ArrayLike) -> tuple[Array, Array]:
        """Return the pixels (..., 2) of world points (..., 3), and their depths (...) along z in metres.

        A point that isn't in front of the camera (depth ≤ 0), or isn't finite, has no pixel: NaN.
        Source: Hartley and Zisserman 2004, eq. 6.8.
        """
        with np.errstate(all="ignore"):
            x, y, depth = components(self.to_camera(points))
            depth = np.asarray(depth)
            z = np.where(depth > 0.0, depth, np.nan)
            (fx, skew, cx), (_, fy, cy), _ = self.K.tolist()
            pixels = stack((fx * x + skew * y) / z + cx, fy * y / z + cy)
            seen = np.isfinite(pixels).all(axis=-1) & np.isfinite(depth)
        return np.where(seen[..., None], pixels, np.nan), depth

    def normalized(self, pixels: npt.ArrayLike) -> Array:
        """Return pixels (..., 2) as normalised image coordinates: where their rays meet the plane z = 1."""
        u, v = components(as_array("pixels", pixels, 2))
        (fx, skew, cx), (_, fy, cy), _ = self.K.tolist()
        y = (v - cy) / fy
        return stack((u - cx - skew * y) / fx, y)

    def pixel_ray(self, pixels: npt.ArrayLike) -> tuple[Array, Array]:
        """Return the origin (3,) and unit directions (..., 3), in the world, of the rays of pixels (..., 2)."""
        x, y = components(self.normalized(pixels))
        directions = stack(x, y, 1.0 + 0.0 * x) @ self.R
        return self.center, directions / norm(directions)[..., None]

    def fov(self, width: float, height: float) -> tuple[float, float]:
        """Return the horizontal and vertical field of view in radians of an image of width × height pixels.

        Between opposite edges of the true, off-centre frustum, measured in the camera's xz and yz planes;
        with integer pixel centres the edges are at −½ and width − ½.
        """
        as_number("width", width, above=0.0)
        as_number("height", height, above=0.0)
        (fx, _, cx), (_, fy, cy), _ = self.K.tolist()
        horizontal = math.atan((width - 0.5 - cx) / fx) - math.atan((-0.5 - cx) / fx)
        return horizontal, math.atan((height - 0.5 - cy) / fy) - math.atan((-0.5 - cy) / fy)

    def frustum_corners(self, width: float, height: float, depth: float) -> Array:
        """Return the corners (4, 3), in the world, of the image's frustum at a depth in metres.

        In the picture's order: top left, top right, bottom right, bottom left.
        """
        as_number("depth", depth, above=0.0)
        right, bottom = (
            as_number("width", width, above=0.0) - 0.5,
            as_number("height", height, above=0.0) - 0.5,
        )
        corners = self.normalized([[-0.5, -0.5], [right, -0.5], [right, bottom], [-0.5, bottom]])
        return self.center + depth * (np.column_stack([corners, np.ones(4)]) @ self.R)


def _check(K: Array, T: Array) -> None:
    if K.shape != (3, 3) or T.shape != (4, 4):
        raise GeometryError(
            "camera", f"K {K.shape} and T_camera_world {T.shape}", "one K (3, 3) and one T (4, 4)"
        )
    (fx, _, _), (k10, fy, _), last = K.tolist()
    if min(fx, fy) <= 0.0 or k10 != 0.0 or last != [0.0, 0.0, 1.0]:
        raise GeometryError(
            "K", K.tolist(), "[[fx, skew, cx], [0, fy, cy], [0, 0, 1]] with fx and fy above 0"
        )
    if T[3].tolist() != [0.0, 0.0, 0.0, 1.0]:
        raise GeometryError("T_camera_world", T.tolist(), "a rigid transform with last row (0, 0, 0, 1)")
    as_rotation("T_camera_world", T[:3, :3])


def parallel_rig(
    baseline: float, focal: float, principal_point: tuple[float, float] = (320.0, 240.0), height: float = 1.0
) -> tuple[Camera, Camera]:
    """Return the left and the right camera of a stereo rig that looks along the world's +Y.

    Their centres are (∓baseline/2, 0, height) in metres; focal and principal_point are in pixels.
    Raises GeometryError for a negative baseline or a focal length that isn't positive.
    """
    half = 0.5 * as_number("baseline", baseline, least=0.0)
    R = R_WORLD_LEVEL.T
    cameras = []
    for x in (-half, half):
        T = np.eye(4)
        T[:3, :3] = R
        T[:3, 3] = -R @ (x, 0.0, height)
        cameras.append(Camera.from_intrinsics(focal, focal, *principal_point, T_camera_world=T))
    return cameras[0], cameras[1]
