"""Surface reconstruction: the alpha shape, what a ball of radius alpha can't roll into."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import Delaunay, QhullError

from ..arrays import Array, Mask, norm
from ..errors import GeometryError, as_number
from .points import Indices, as_cloud

_FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])  # of a tetrahedron, outwards; opposite vertex i


WIDEST = 1e75
"""Metres between points, from which on the squares of areas overflow."""


@dataclass(frozen=True, eq=False)
class Surface:
    """A triangle mesh on given points (N, 3): `triangles` (T, 3) are their indices, counter-clockwise from outside.

    `solid` (T,) says which triangles bound a solid; the others are sheets, seen from both sides. `area` is in m².
    `volume`, in m³, is what the ball can't get into from outside: the solids, and what sheets enclose without a gap.
    """

    points: Array
    triangles: Indices
    solid: Mask
    area: float
    volume: float


def alpha_shape(points: npt.ArrayLike, alpha: float) -> Surface:
    """Return the alpha shape of points (N, 3), for a ball's radius in metres; sheets of one layer are in it.

    A triangle is in it if a ball of that radius touches its corners and no point is inside: those on which the
    ball comes to rest when it is rolled over the points. Points that are left out are in no triangle.
    Raises GeometryError if the points are fewer than four, or all on a plane; if alpha isn't positive.
    Source: Edelsbrunner and Mücke 1994, "Three-dimensional alpha shapes"; their alpha is this radius.
    """
    cloud, alpha = as_cloud("points", points), as_number("alpha", alpha, above=0.0)
    tetrahedra, neighbours = _delaunay(cloud)
    kept = _circumradii(cloud[tetrahedra]) <= alpha
    # each face of each tetrahedron that isn't kept beyond it; those of two that aren't kept come twice
    other = np.where(neighbours >= 0, kept[neighbours], False)
    regular = kept[:, None] & ~other
    once = ~kept[:, None] & ~other & (neighbours < np.arange(len(tetrahedra))[:, None])
    solids = _faces(tetrahedra, regular)
    resting = _resting(cloud, tetrahedra, neighbours, once, alpha)
    triangles = np.concatenate([solids, _faces(tetrahedra, resting)])
    solid = np.arange(len(triangles)) < len(solids)
    inside = ~_reached(neighbours, once & ~resting)
    volume = mesh_volume(cloud, _faces(tetrahedra, np.broadcast_to(inside[:, None], neighbours.shape)))
    return Surface(cloud, triangles, solid, mesh_area(cloud, triangles), volume)


def mesh_area(points: Array, triangles: Indices) -> float:
    """Return the area in m² of triangles (T, 3) of points (N, 3)."""
    a, b, c = points[triangles].transpose(1, 0, 2)
    return float(0.5 * norm(np.cross(b - a, c - a)).sum())


def mesh_volume(points: Array, triangles: Indices) -> float:
    """Return the volume in m³ inside closed triangles (T, 3) of points (N, 3)."""
    if not len(triangles):
        return 0.0
    a, b, c = (points[triangles] - points[triangles[0, 0]]).transpose(1, 0, 2)
    return float(np.vecdot(a, np.cross(b, c)).sum() / 6.0)


def _delaunay(cloud: Array) -> tuple[Indices, Indices]:
    """Tetrahedra (M, 4), positively oriented, and their neighbours (M, 4), −1 outside."""
    if len(cloud) < 4:
        raise GeometryError("points", f"{len(cloud)} points", "at least four")
    if not float(np.ptp(cloud, axis=0).max()) < WIDEST:  # Qhull's products overflow, which it doesn't survive
        raise GeometryError("points", "points over 1e75 m apart", f"points less than {WIDEST:g} m apart")
    try:
        mesh = Delaunay(cloud - cloud.mean(axis=0))
    except QhullError:
        raise GeometryError("points", f"{len(cloud)} points on a plane", "points that span a volume") from None
    tetrahedra, neighbours = mesh.simplices.astype(np.intp), mesh.neighbors.astype(np.intp)
    a, b, c, d = cloud[tetrahedra].transpose(1, 0, 2)
    inverted = np.vecdot(b - a, np.cross(c - a, d - a)) < 0.0
    for array in (tetrahedra, neighbours):
        array[inverted, :2] = array[inverted, 1::-1]
    return tetrahedra, neighbours


def _circumradii(corners: Array) -> Array:
    """Radii (M,) of the spheres through tetrahedra (M, 4, 3); infinite for flat ones."""
    u, v, w = (corners[:, i] - corners[:, 0] for i in (1, 2, 3))
    uu, vv, ww = (np.vecdot(e, e)[:, None] for e in (u, v, w))
    vw = np.cross(v, w)
    volume = np.abs(2.0 * np.vecdot(u, vw))
    centre = uu * vw + vv * np.cross(w, u) + ww * np.cross(u, v)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(volume > 0.0, norm(centre) / volume, np.inf))


def _reached(neighbours: Indices, passes: Mask) -> Mask:
    """Which tetrahedra (M,) the ball's centre comes to from outside, through the faces (M, 4) that let it pass.

    It goes along an edge of the Voronoi diagram, between the two spheres of a face that it doesn't rest on.
    """
    tetra, face = np.nonzero(passes)
    outside = len(neighbours)
    beyond = np.where(neighbours[tetra, face] < 0, outside, neighbours[tetra, face])
    ways = coo_array((np.ones(len(tetra), bool), (tetra, beyond)), shape=(outside + 1, outside + 1))
    part = connected_components(ways, directed=False)[1]
    return np.asarray(part[:outside] == part[outside])


def _resting(cloud: Array, tetrahedra: Indices, neighbours: Indices, faces: Mask, alpha: float) -> Mask:
    """Those of the faces (M, 4) whose own smallest sphere is within alpha, and has neither opposite vertex inside."""
    tetra, face = np.nonzero(faces)
    centre, radius = _circumcircles(cloud[_faces(tetrahedra, faces)])
    small = radius <= alpha
    tetra, face, centre, radius = tetra[small], face[small], centre[small], radius[small]
    empty = norm(cloud[tetrahedra[tetra, face]] - centre) >= radius
    beyond = neighbours[tetra, face]
    back = np.argmax(neighbours[beyond] == tetra[:, None], axis=1)
    empty &= (beyond < 0) | (norm(cloud[tetrahedra[beyond, back]] - centre) >= radius)
    resting = np.zeros_like(faces)
    resting[tetra[empty], face[empty]] = True
    return resting


def _circumcircles(corners: Array) -> tuple[Array, Array]:
    """Centres (T, 3) and radii (T,) of the circles through triangles (T, 3, 3)."""
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    w = np.cross(u, v)
    doubled = 2.0 * np.vecdot(w, w)[:, None]
    with np.errstate(all="ignore"):
        to_centre = np.cross(np.vecdot(u, u)[:, None] * v - np.vecdot(v, v)[:, None] * u, w) / doubled
    to_centre[~np.isfinite(to_centre).all(axis=1)] = np.inf
    return corners[:, 0] + to_centre, norm(to_centre)


def _faces(tetrahedra: Indices, faces: Mask) -> Indices:
    tetra, face = np.nonzero(faces)
    return np.asarray(tetrahedra[tetra[:, None], _FACES[face]])
