"""What projection matrices P (3, 4) say and lose: their parts, vanishing points, and what is inside a picture."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .arrays import Array, Mask, cross, dot, norm
from .errors import GeometryError, as_array, as_finite_array, as_number

_SINGULAR = 1e-12  # ratio of singular values, or part of a length, below which only rounding is left


@dataclass(frozen=True, eq=False)
class Decomposition:
    """P ~ K [R | t]: K (3, 3) with positive diagonal and last entry 1, a rotation R (3, 3), t (3,) and the centre (3,).

    `conditioning` is the ratio of the least to the greatest singular value of P's left block: with it near
    zero the centre is far away and unsure. It depends on the unit of pixels.
    """

    K: Array
    R: Array
    t: Array
    center: Array
    conditioning: float


def decompose(P: npt.ArrayLike) -> Decomposition:
    """Return the intrinsics, rotation and centre of a finite camera, from its P (3, 4) up to scale and sign.

    RQ decomposition of the left block, by Gram–Schmidt on its rows from the last one upwards.
    Raises GeometryError for an affine camera, whose centre is at infinity, and for any other singular left block.
    Source: Hartley and Zisserman 2004, sec. 6.2.4.
    """
    P = as_finite_array("P", P, 3, 4)
    if P.ndim > 2:
        raise GeometryError("P", f"an array of shape {P.shape}", "one matrix of shape (3, 4)")
    greatest, _, least = np.linalg.svd(P[:, :3], compute_uv=False).tolist()
    if least <= _SINGULAR * greatest:
        raise GeometryError("P", P.tolist(), "a finite camera: the left block (3, 3) must have an inverse")
    (*a, p), (*b, q), (*c, r) = P.tolist()
    scale = math.copysign(math.hypot(*c), dot(a, cross(b, c)))
    a, b, z = _scaled(a, 1.0 / scale), _scaled(b, 1.0 / scale), _scaled(c, 1.0 / scale)
    cy, cx = dot(b, z), dot(a, z)
    y = _unit([v - cy * w for v, w in zip(b, z, strict=True)])
    leftover = dot(y, z)
    y = _unit([v - leftover * w for v, w in zip(y, z, strict=True)])  # once more: rounding left some of z in it
    x = cross(y, z)
    fx, skew, fy = dot(a, x), dot(a, y), dot(b, y)
    t3 = r / scale
    t2 = (q / scale - cy * t3) / fy
    t1 = (p / scale - skew * t2 - cx * t3) / fx
    R, t = np.array([x, y, z]), np.array([t1, t2, t3])
    K = np.array([[fx, skew, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])
    return Decomposition(K, R, t, -t.dot(R), least / greatest)


def _scaled(vector: Sequence[float], factor: float) -> list[float]:
    return [factor * v for v in vector]


def _unit(vector: Sequence[float]) -> list[float]:
    return _scaled(vector, 1.0 / math.hypot(*vector))


def vanishing_points(P: npt.ArrayLike, directions: npt.ArrayLike) -> tuple[Array, Array]:
    """Return where lines of directions (..., 3) in the world vanish: homogeneous (..., 3), and pixels (..., 2).

    Homogeneous points have length one. Those at infinity, of lines parallel to the picture, end in an exact 0 and
    have NaN for a pixel. A direction that P maps to nothing (zero, or along the view of an affine camera) is NaN.
    Source: Hartley and Zisserman 2004, sec. 8.6.1.
    """
    P, d = as_finite_array("P", P, 3, 4), as_array("directions", directions, 3)
    with np.errstate(invalid="ignore", divide="ignore"):
        points = d @ P[:, :3].T
        lengths = norm(d)
        tiny = _SINGULAR * lengths[..., None] * norm(P[:, :3])
        points = np.where(np.abs(points) <= tiny, 0.0, points)
        points = points / norm(points)[..., None]
        w = points[..., 2:]
        pixels = points[..., :2] / np.where(w == 0.0, np.nan, w)
    return points, pixels


def viewpoint(P: npt.ArrayLike) -> Array:
    """Return from where P (3, 4) looks, homogeneous (4,): its centre with w > 0, or, for an affine camera, a direction.

    That direction points from the things to the camera, w = 0. P has the sign that gives points in front a positive
    third coordinate. A place is on the side of a plane (a, b, c, d) that its product with it says, in both cases.
    Source: Hartley and Zisserman 2004, sec. 6.2.1.
    """
    (*a, p), (*b, q), (*c, r) = as_finite_array("P", P, 3, 4).tolist()
    sides = cross(b, c), cross(c, a), cross(a, b)
    x, y, z = (-p * u - q * v - r * w for u, v, w in zip(*sides, strict=True))
    return np.array([x, y, z, dot(a, sides[0])])


def ground_line(P: npt.ArrayLike) -> tuple[float, float, float]:
    """Return (a, b, c) with a u + b v + c > 0 for the pixels in which P (3, 4) shows the plane z = 0.

    The rest shows what is above, and 0 is the horizon. P has its sign as for `viewpoint`. For an affine camera a and b
    are 0: all of its picture shows the plane, or nothing of it.
    Source: Hartley and Zisserman 2004, sec. 8.6.2.
    """
    (*a, _), (*b, _), (*c, _) = as_finite_array("P", P, 3, 4).tolist()
    (_, _, u), (_, _, v), (_, _, w) = cross(b, c), cross(c, a), cross(a, b)
    if abs(w) <= _SINGULAR * math.hypot(*a) * math.hypot(*b):
        w = 0.0
    below = viewpoint(P).item(2) < 0.0
    return (u, v, w) if below else (-u, -v, -w)


def frame_planes(P: npt.ArrayLike, width: float, height: float) -> Array:
    """Return the half-spaces (4, 4) of the points that P (3, 4) maps into a picture of a size in pixels.

    In the order left, top, right, bottom. A row (a, b, c, d) holds where a x + b y + c z + d ≥ 0. All four
    together hold nowhere behind a perspective camera. Edges are at −½ and width − ½.
    """
    u, v, w = as_finite_array("P", P, 3, 4)
    right = as_number("width", width, above=0.0) - 0.5
    bottom = as_number("height", height, above=0.0) - 0.5
    return np.stack([u + 0.5 * w, v + 0.5 * w, right * w - u, bottom * w - v])


def clip_segments(segments: npt.ArrayLike, planes: npt.ArrayLike) -> tuple[Array, Mask]:
    """Return the parts (n, 2, 3) of segments (n, 2, 3) inside all planes (m, 4), and which of them exist (n,).

    A row (a, b, c, d) of planes keeps a x + b y + c z + d ≥ 0. A segment that is wholly outside, or isn't finite, is
    NaN and False; one that only touches keeps a part without length.
    Source: Cyrus and Beck 1978.
    """
    segments, planes = as_array("segments", segments, 2, 3), as_finite_array("planes", planes, 4)
    with np.errstate(all="ignore"):
        flat = segments.reshape(-1, 3).dot(planes[:, :3].T) + planes[:, 3]
        distances = flat.reshape(len(segments), 2, len(planes))
        before, after = distances[:, 0], distances[:, 1]
        crossing = before / (before - after)
        outside = distances < 0.0
        enter = np.where(outside[:, 0], crossing, 0.0).max(axis=1, initial=0.0)
        leave = np.where(outside[:, 1], crossing, 1.0).min(axis=1, initial=1.0)
        exists = (enter <= leave) & ~(outside[:, 0] & outside[:, 1]).any(axis=1)
        exists &= np.isfinite(segments.reshape(-1, 6).sum(axis=1))
        start, end = segments[:, 0], segments[:, 1]
        along = end - start
        first = start + enter[:, None] * along
        last = np.where(leave[:, None] == 1.0, end, start + leave[:, None] * along)
        clipped = np.stack([first, last], axis=1)
        clipped[~exists] = np.nan
    return clipped, exists
