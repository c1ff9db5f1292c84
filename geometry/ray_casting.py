"""Where rays first meet simple bodies: what a laser scanner measures of a scene that is known exactly."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from .arrays import Array, Mask, norm
from .errors import GeometryError, as_choice, as_finite_array

SHAPES = ("box", "cylinder", "ellipsoid")


@dataclass(frozen=True, eq=False)
class Body:
    """A box, a cylinder along its z, or an ellipsoid, about its own origin: `half` (3,) are its half extents.

    T_world_body (4, 4) places it. Half extents of a cylinder are its two radii and half its height.
    Raises GeometryError for another shape, and if a half extent isn't positive.
    """

    shape: str
    half: Array
    T_world_body: Array

    def __post_init__(self) -> None:
        as_choice("shape", self.shape, SHAPES)
        as_finite_array("T_world_body", self.T_world_body, 4, 4)
        if as_finite_array("half", self.half, 3).shape != (3,) or not (np.asarray(self.half) > 0.0).all():
            raise GeometryError("half", self.half, "three lengths above 0")


@dataclass(frozen=True, eq=False)
class Hits:
    """For each ray (N,): the distance in metres, infinite where it meets nothing; the outward unit normal (N, 3) of
    what it meets, zero for nothing; and the number of that body, or −1.
    """

    distance: Array
    normals: Array
    body: npt.NDArray[np.intp]


def cast(origins: npt.ArrayLike, directions: npt.ArrayLike, bodies: Sequence[Body]) -> Hits:
    """Return where rays from origins (3,) or (N, 3) along unit directions (N, 3) first meet one of the bodies.

    A ray that starts inside a body meets it where it leaves.
    Raises GeometryError if an argument isn't finite. Source: Kay and Kajiya 1986, for boxes.
    """
    d = as_finite_array("directions", directions, 3)
    start = as_finite_array("origins", origins, 3)
    o = np.broadcast_to(start, d.shape) if start.ndim > 1 else start[None]
    hits = Hits(np.full(len(d), np.inf), np.zeros_like(d), np.full(len(d), -1, np.intp))
    for number, body in enumerate(bodies):
        rows = _may_meet(start, d, body)
        met = _meet(o if len(o) == 1 else o[rows], d[rows], body)
        nearer = np.flatnonzero(met.distance < hits.distance[rows])
        rows = rows[nearer]
        hits.distance[rows], hits.normals[rows], hits.body[rows] = met.distance[nearer], met.normals(nearer), number
    return hits


def _may_meet(o: Array, d: Array, body: Body) -> npt.NDArray[np.intp]:
    """Rays that pass through the sphere round the body."""
    away = body.T_world_body[:3, 3] - o
    along = d @ away if away.ndim == 1 else np.vecdot(away, d)
    beyond = np.vecdot(away, away) - np.vecdot(body.half, body.half)  # the square of the way to where it is touched
    return np.flatnonzero((beyond <= 0.0) | (along >= np.sqrt(np.maximum(beyond, 0.0)) * (1.0 - 1e-9)))


@dataclass(frozen=True, eq=False)
class _Met:
    """Where rays meet a body, in its scaled frame where it is a cube, a cylinder or a ball."""

    body: Body
    p: Array
    v: Array
    distance: Array
    flat: npt.NDArray[np.intp]
    """Along which axis the face is flat that is met, or −1."""

    def normals(self, rows: npt.NDArray[np.intp]) -> Array:
        """Unit normals in the world of some of the rays, all of which meet it."""
        point = (self.p if len(self.p) == 1 else self.p[rows]) + self.distance[rows, None] * self.v[rows]
        local = _normal(point, self.flat[rows], self.body.shape) / self.body.half
        normals = local @ self.body.T_world_body[:3, :3].T
        return normals / norm(normals)[:, None]


@np.errstate(divide="ignore", invalid="ignore")
def _meet(o: Array, d: Array, body: Body) -> _Met:
    """Rays from origins, one (1, 3) for all or one (N, 3) for each."""
    R, t = body.T_world_body[:3, :3], body.T_world_body[:3, 3]
    p, v = ((o - t) @ R) / body.half, (d @ R) / body.half
    inside = {"box": _cube, "cylinder": _cylinder, "ellipsoid": _ball}[body.shape](p, v)
    enter, leave, axis_in, axis_out = inside
    starts_outside = enter > 0.0
    distance = np.where(starts_outside, enter, leave)
    distance = np.where((enter <= leave) & (distance > 0.0), distance, np.inf)
    return _Met(body, p, v, distance, np.where(starts_outside, axis_in, axis_out))


Span = tuple[Array, Array, npt.NDArray[np.intp], npt.NDArray[np.intp]]


def _cube(p: Array, v: Array) -> Span:
    """Where rays enter and leave [−1, 1]³, and through the faces of which axes."""
    first, second = (-1.0 - p) / v, (1.0 - p) / v
    low, high = np.fmin(first, second), np.fmax(first, second)
    parallel_outside = (v == 0.0) & (np.abs(p) > 1.0)
    low[parallel_outside] = np.inf
    enter, leave = np.argmax(low, axis=1), np.argmin(high, axis=1)
    rows = np.arange(len(v))
    return low[rows, enter], high[rows, leave], enter, leave


def _ball(p: Array, v: Array) -> Span:
    low, high, none = _roots(np.vecdot(v, v), np.vecdot(p, v), np.vecdot(p, p) - 1.0)
    side = np.full(len(v), -1)
    return np.where(none, np.inf, low), np.where(none, -np.inf, high), side, side


def _cylinder(p: Array, v: Array) -> Span:
    """The part between the caps of the part within the round: whichever comes later in, and earlier out."""
    xy, along = slice(0, 2), slice(2, 3)
    low, high, none = _roots(
        np.vecdot(v[:, xy], v[:, xy]), np.vecdot(p[:, xy], v[:, xy]), np.vecdot(p[:, xy], p[:, xy]) - 1.0
    )
    straight = (v[:, :2] == 0.0).all(axis=1)
    inside = np.vecdot(p[:, xy], p[:, xy]) <= 1.0
    low = np.where(straight, np.where(inside, -np.inf, np.inf), np.where(none, np.inf, low))
    high = np.where(straight, np.where(inside, np.inf, -np.inf), np.where(none, -np.inf, high))
    cap_in, cap_out, _, _ = _cube(p[:, along], v[:, along])
    enter, leave = np.maximum(low, cap_in), np.minimum(high, cap_out)
    return enter, leave, np.where(cap_in >= low, 2, -1), np.where(cap_out <= high, 2, -1)


def _roots(a: Array, half_b: Array, c: Array) -> tuple[Array, Array, Mask]:
    square = half_b * half_b - a * c
    root = np.sqrt(np.maximum(square, 0.0))
    return (-half_b - root) / a, (-half_b + root) / a, square < 0.0


def _normal(point: Array, flat: npt.NDArray[np.intp], shape: str) -> Array:
    """Normal of the scaled body: along the axis of a flat face, else from its centre or its axis."""
    outwards = point.copy()
    if shape == "cylinder":
        outwards[:, 2] = 0.0
    faces = np.flatnonzero(flat >= 0)
    outwards[faces] = 0.0
    outwards[faces, flat[faces]] = np.sign(point[faces, flat[faces]])
    outwards[~outwards.any(axis=1)] = (0.0, 0.0, 1.0)
    return outwards
