"""The pinhole camera: x right, y down, z forward, integer pixel centres, p ~ K [R | t] X."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from .arrays import Array, components, if_positive, norm, stack
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
    Source: Hartley and Zisserman 2004, sec. 6.1.
    """

    K: Array
    T_camera_world: Array

    def __post_init__(self) -> None:
        for name, array in (
            ("K", _checked_intrinsics(self.K)),
            ("T_camera_world", _checked_pose(self.T_camera_world)),
        ):
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
        """Inverse (3, 3) of K: from homogeneous pixels to directions in camera axes, at z = 1."""
        (fx, skew, cx), (_, fy, cy), _ = self.K.tolist()
        across = -skew / (fx * fy)
        return np.array([[1.0 / fx, across, -cx / fx - across * cy], [0.0, 1.0 / fy, -cy / fy], [0.0, 0.0, 1.0]])

    @cached_property
    def back_projection(self) -> Array:
        """(K R)⁻¹, (3, 3): from homogeneous pixels to directions in the world, at depth 1."""
        return np.asarray(self.R.T.dot(self.K_inverse))

    @cached_property
    def P(self) -> Array:
        """Projection matrix K [R | t], (3, 4)."""
        return self.K @ self.T_camera_world[:3]

    @cached_property
    def center(self) -> Array:
        """Centre of projection −Rᵀt, (3,), in the world."""
        return np.asarray(-self.t.dot(self.R))

    @property
    def depth_row(self) -> Array:
        """Row (4,) whose product with a homogeneous world point is its depth in metres."""
        row: Array = self.T_camera_world[2]
        return row

    @np.errstate(invalid="ignore")
    def to_camera(self, points: npt.ArrayLike) -> Array:
        """Return world points (..., 3) in camera coordinates, in metres."""
        return np.asarray(as_array("points", points, 3).dot(self.R.T) + self.t)

    def project(self, points: npt.ArrayLike) -> tuple[Array, Array]:
        """Return the pixels (..., 2) of world points (..., 3), and their depths (...) along z in metres.

        A point that isn't in front of the camera (depth ≤ 0), or isn't finite, has no pixel: NaN.
        Source: Hartley and Zisserman 2004, sec. 6.1.
        """
        (fx, skew, cx), (_, fy, cy), _ = self.K.tolist()
        with np.errstate(all="ignore"):
            x, y, depth = components(self.to_camera(points))
            z = if_positive(depth)
            u, v = (fx * x + skew * y) / z + cx, fy * y / z + cy
            nothing = (u + v + z) - (u + v + z)  # zero, but NaN where any of them is infinite
            return stack(u + nothing, v + nothing), np.asarray(depth)

    @np.errstate(invalid="ignore")
    def normalized(self, pixels: npt.ArrayLike) -> Array:
        """Return pixels (..., 2) as normalised image coordinates: where their rays meet the plane z = 1."""
        u, v = components(as_array("pixels", pixels, 2))
        (fx, skew, cx), (_, fy, cy), _ = self.K.tolist()
        y = (v - cy) / fy
        return stack((u - cx - skew * y) / fx, y)

    @np.errstate(invalid="ignore")
    def pixel_ray(self, pixels: npt.ArrayLike) -> tuple[Array, Array]:
        """Return the origin (3,) and unit directions (..., 3) in the world of the rays of pixels (..., 2)."""
        x, y = components(self.normalized(pixels))
        directions = stack(x, y, 1.0 + 0.0 * x).dot(self.R)
        return self.center, directions / norm(directions)[..., None]

    def fov(self, width: float, height: float) -> tuple[float, float]:
        """Return the horizontal and the vertical field of view, in radians, of an image of a size in pixels.

        Between opposite edges of the true, off-centre frustum, in the camera's xz and yz planes. With integer
        pixel centres the edges are at −½ and width − ½.
        """
        width, height = as_number("width", width, above=0.0), as_number("height", height, above=0.0)
        (fx, _, cx), (_, fy, cy), _ = self.K.tolist()
        horizontal = math.atan((width - 0.5 - cx) / fx) - math.atan((-0.5 - cx) / fx)
        return horizontal, math.atan((height - 0.5 - cy) / fy) - math.atan((-0.5 - cy) / fy)

    def frustum_corners(self, width: float, height: float, depth: float) -> Array:
        """Return the corners (4, 3), in the world, of the image's frustum at a depth in metres.

        In the picture's order: top left, top right, bottom right, bottom left.
        """
        right, bottom = (
            as_number("width", width, above=0.0) - 0.5,
            as_number("height", height, above=0.0) - 0.5,
        )
        corners = [[-0.5, -0.5, 1.0], [right, -0.5, 1.0], [right, bottom, 1.0], [-0.5, bottom, 1.0]]
        directions = np.array(corners) @ self.K_inverse.T @ self.R
        return self.center + as_number("depth", depth, above=0.0) * directions


def _checked_intrinsics(K: Array) -> Array:
    K = np.array(K, dtype=np.float64)
    flat = K.ravel().tolist()
    triangular = len(flat) == 9 and flat[3:4] + flat[6:] == [0.0, 0.0, 0.0, 1.0]
    if not triangular or K.shape != (3, 3) or not all(map(math.isfinite, flat)) or min(flat[0], flat[4]) <= 0.0:
        raise GeometryError("K", K.tolist(), "[[fx, skew, cx], [0, fy, cy], [0, 0, 1]] with fx and fy above 0")
    return K


def _checked_pose(T: Array) -> Array:
    T = np.array(T, dtype=np.float64)
    rigid = T.shape == (4, 4) and T[3].tolist() == [0.0, 0.0, 0.0, 1.0]
    if not rigid or not all(map(math.isfinite, T[:3, 3].tolist())):
        raise GeometryError("T_camera_world", T.tolist(), "one rigid transform (4, 4) with last row (0, 0, 0, 1)")
    as_rotation("T_camera_world", T[:3, :3])
    return T


def pan_tilt_roll(pan: float, tilt: float, roll: float) -> Array:
    """Return R_world_camera (3, 3) = Rz(pan) C Rx(tilt) Rz(roll) for angles in radians, with C = R_WORLD_LEVEL.

    At zero the camera looks along the world's +Y. Pan turns about the world's Z, tilt about the camera's x (positive
    looks up), roll about the optical axis.
    """
    c, s = math.cos(as_number("pan", pan)), math.sin(pan)
    p, q = math.cos(as_number("tilt", tilt)), math.sin(tilt)
    g, h = math.cos(as_number("roll", roll)), math.sin(roll)
    # Columns of Rz(pan) C Rx(tilt): right, down and forward before the roll.
    right, down, forward = (c, s, 0.0), (-s * q, c * q, -p), (-s * p, c * p, q)
    rows = [(g * a + h * b, g * b - h * a, f) for a, b, f in zip(right, down, forward, strict=True)]
    return np.array(rows)


def aim(center: npt.ArrayLike, target: npt.ArrayLike) -> tuple[float | None, float]:
    """Return the pan and the tilt, in radians, that turn a camera at a place (3,) towards another (3,).

    Straight up or down any pan does: None. Raises GeometryError if the places coincide.
    """
    x, y, z = (as_finite_array("target", target, 3) - as_finite_array("center", center, 3)).tolist()
    flat = math.hypot(x, y)
    if not flat and not z:
        raise GeometryError("target", [x, y, z], "a place other than the camera's")
    return (math.atan2(-x, y) if flat > 1e-12 * abs(z) else None), math.atan2(z, flat)


def parallel_rig(
    baseline: float,
    focal: float,
    principal_point: tuple[float, float] = (320.0, 240.0),
    height: float = 1.0,
    doffs: float = 0.0,
) -> tuple[Camera, Camera]:
    """Return the left and the right camera of a stereo rig that looks along the world's +Y.

    Their centres are (∓baseline/2, 0, height) in metres; focal, principal_point and doffs are in pixels. The principal
    point is the left camera's; the right one's lies doffs farther right, as in rigs whose pictures were rectified.
    Raises GeometryError for a negative baseline or a focal length that isn't positive.
    """
    half = 0.5 * as_number("baseline", baseline, least=0.0)
    cx, cy = principal_point
    return (
        _level(-half, height, focal, (cx, cy)),
        _level(half, height, focal, (cx + as_number("doffs", doffs), cy)),
    )


def _level(x: float, height: float, focal: float, principal_point: tuple[float, float]) -> Camera:
    T = np.array([[1.0, 0.0, 0.0, -x], [0.0, 0.0, -1.0, height], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
    return Camera.from_intrinsics(focal, focal, *principal_point, T_camera_world=T)
