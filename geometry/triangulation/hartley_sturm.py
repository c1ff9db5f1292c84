"""The least correction of a pair of pixels by the polynomial of Hartley and Sturm."""

import numpy as np

from ..arrays import Array


def least_correction(F: Array, pair: Array) -> Array:
    """Return the shortest move (4,) of a pair (4,) of points, left and right, to right^T F left = 0.

    F (3, 3) has rank 2, and its entries and the points are of the order of one.
    Source: Hartley and Zisserman 2004, algorithm 12.1, but with epipoles of unit length as three-vectors,
    which keeps the polynomial balanced for points near an epipole.
    """
    centred = _shift(pair[2:]).T @ F @ _shift(pair[:2])
    U, _, Vt = np.linalg.svd(centred)
    (turn_left, e, f), (turn_right, h, g) = _epipole_on_x(Vt[2]), _epipole_on_x(U[:, 2])
    if min(e, h) == 0.0:
        return np.zeros(4)  # every line passes through an epipole
    # The left lines are (f t, s, −e t), and theirs on the right (−g q, p, h q).
    to_right = (turn_right @ centred @ turn_left.T)[1:, 1:] * [[e, 1.0], [e / h, 1.0 / h]]
    t, s = _stationary(to_right, e, f, g, h)
    p, q = to_right @ [t, s]
    with np.errstate(divide="ignore", invalid="ignore"):
        best = np.nanargmin((e * t) ** 2 / (s**2 + (f * t) ** 2) + (h * q) ** 2 / (p**2 + (g * q) ** 2))
    line_left = np.array([f * t[best], s[best], -e * t[best]])
    line_right = np.array([-g * q[best], p[best], h * q[best]])
    return np.concatenate([_foot(line_left @ turn_left), _foot(line_right @ turn_right)])


def _stationary(to_right: Array, e: float, f: float, g: float, h: float) -> tuple[Array, Array]:
    """Return the lines t : s of the pencil at which the distance may be least: all roots, and 1 : 0."""
    p, q = to_right
    left, right = np.array([f**2, 0.0, 1.0]), np.convolve(p, p) + g**2 * np.convolve(q, q)
    rise = e**2 * np.convolve([0.0, 1.0, 0.0], np.convolve(right, right))
    fall = h**2 * np.linalg.det(to_right) * np.convolve(np.convolve(left, left), np.convolve(p, q))
    roots = np.roots(rise - fall).real
    return np.append(roots, 1.0), np.append(np.ones_like(roots), 0.0)


def _shift(point: Array) -> Array:
    T = np.eye(3)
    T[:2, 2] = point
    return T


def _epipole_on_x(epipole: Array) -> tuple[Array, float, float]:
    """Return the rotation (3, 3) of the image that takes a unit epipole to (e, 0, f), with e and f."""
    x, y, f = epipole.tolist()
    e = np.hypot(x, y)
    cos, sin = (x / e, y / e) if e else (1.0, 0.0)
    return np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]), float(e), f


def _foot(line: Array) -> Array:
    """Return the point (2,) of a line (3,) nearest to the origin."""
    return np.asarray(-line[2] * line[:2] / (line[0] ** 2 + line[1] ** 2))
