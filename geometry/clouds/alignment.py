"""The rigid motion that brings points onto points, or onto planes, in one step."""

import math
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, cross, dot, norm
from ..errors import GeometryError
from ..rotations import SMALLEST, axis_angle_to_matrix
from ..se3 import transform
from .points import columns, squares

WEAK = 1e-3
"""Share of the best direction's information, below which the data hardly say anything about one."""


_LINE = 1e-9
"""Ratio of the points' extents, below which they are on a line."""


@dataclass(frozen=True, eq=False)
class Observability:
    """How well pairs of points fix each of six directions of motion.

    `information` (6,), rising, is the mean square change of the residuals, in m², for a motion of one metre: of
    all points, or of a typical one by a turn. `directions` (6, 6), by rows: rotation vector in radians times
    `lever`, the points' root mean square distance from `center` (3,), then translation in metres.
    """

    information: Array
    directions: Array
    center: Array
    lever: float

    def unobservable(self, share: float = WEAK) -> Array:
        """Return the directions (n, 6) that have less than a share of the most information."""
        return np.asarray(self.directions[self.information <= share * self.information[-1]])


def onto_points(p: Array, q: Array) -> Array:
    """Return the transform T (4, 4) with least Σ‖T pᵢ − qᵢ‖², for points p and q (N, 3).

    Of all that do so for points on a line, or in one place, the one that turns least.
    Raises GeometryError without points. Source: Kabsch 1976; Umeyama 1991, eq. 40–42, without scale.
    """
    if not len(p):
        raise GeometryError("p", "no points", "at least one")
    p_mean, from_p = _centred(p)
    q_mean, from_q = _centred(q)
    H = from_q @ from_p.T
    U, values, Vt = np.linalg.svd(H)
    if values[1] <= _LINE * values[0]:
        U, _, Vt = np.linalg.svd(H + (_LINE * values[0] or 1.0) * np.eye(3))
    U[:, 2] *= np.sign(np.linalg.det(U) * np.linalg.det(Vt))
    R = U @ Vt
    return transform(R, q_mean - R @ p_mean)


def onto_planes(p: Array, q: Array, normals: Array) -> Array:
    """Return T (4, 4), one Gauss–Newton step towards least Σ(nᵢ·(T pᵢ − qᵢ))², for points and normals (N, 3).

    It doesn't move along directions that the planes say nothing about.
    Raises GeometryError without points. Source: Chen and Medioni 1992; Low 2004, "Linear least-squares ICP".
    """
    if not len(p):
        raise GeometryError("p", "no points", "at least one")
    center, lever, J = _jacobian(p, normals)
    values, vectors = np.linalg.eigh(J @ J.T)
    kept = values > 1e-10 * values[-1]
    gradient = vectors[:, kept].T @ (J @ dot(list(J[3:]), list(columns(q - p))))
    turn_and_move = vectors[:, kept] @ (gradient / values[kept])
    turn, move = turn_and_move[:3] / lever, turn_and_move[3:]
    angle = float(norm(turn))
    R = axis_angle_to_matrix(turn, angle) if angle > SMALLEST else np.eye(3)
    return transform(R, center + move - R @ center)


def observability(p: Array, normals: Array | None = None) -> Observability:
    """Return what pairs at points p (N, 3) say about a motion: of points, or of planes with the normals (N, 3).

    Raises GeometryError without points. Source: Gelfand et al. 2003, "Geometrically stable sampling", sec. 3.
    """
    if not len(p):
        raise GeometryError("p", "no points", "at least one")
    if normals is not None:
        center, lever, J = _jacobian(p, normals)
        information = J @ J.T / len(p)
    else:
        center, offsets = _centred(p)
        lever = _lever(offsets)
        scatter = offsets @ offsets.T / (len(p) * lever * lever)
        inertia = np.trace(scatter) * np.eye(3) - scatter
        information = np.block([[inertia, np.zeros((3, 3))], [np.zeros((3, 3)), np.eye(3)]])
    values, vectors = np.linalg.eigh(information)
    return Observability(np.maximum(values, 0.0), vectors.T, center, lever)


def _jacobian(p: Array, normals: Array) -> tuple[Array, float, Array]:
    """Center (3,), lever, and each point's six derivatives of its distance from the plane, in columns (6, N)."""
    center, offsets = _centred(p)
    lever, n = _lever(offsets), columns(normals)
    return center, lever, np.concatenate([cross(list(offsets / lever), list(n)), n])


def _centred(p: Array) -> tuple[Array, Array]:
    """The points' mean (3,), and their columns (3, N) from there."""
    xyz = columns(p)
    center = xyz.mean(axis=1)
    xyz -= center[:, None]
    return center, xyz


def _lever(offsets: Array) -> float:
    return math.sqrt(float(squares(offsets).mean())) or 1.0
