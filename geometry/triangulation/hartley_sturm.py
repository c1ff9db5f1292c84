"""The least correction of a pair of pixels by the polynomial of Hartley and Sturm."""

import numpy as np

from ..arrays import Array


def least_correction(F: Array, pair: Array) -> Array:
    """Return the shortest move (4,) of a pair (4,) of points, left and right, to right^T F left = 0.

    F (3, 3) has rank 2, and its epipoles and the points are of the order of one.
    Source: Hartley and Sturm 1997, "Triangulation", sec. 4.2; Hartley and Zisserman 2004, algorithm 12.1.
    """
    centred = _shift(pair[2:]).T @ F @ _shift(pair[:2])
    U, _, Vt = np.linalg.svd(centred)
    if not (Vt[2, :2].any() and U[:2, 2].any()):
        return np.zeros(4)  # every line passes through an epipole
    (turn_left, f), (turn_right, g) = _epipole_on_x(Vt[2]), _epipole_on_x(U[:, 2])
    (a, b), (c, d) = (turn_right @ centred @ turn_left.T)[1:, 1:].tolist()
    t, s = _stationary(a, b, c, d, f, g)
    p, q = a * t + b * s, c * t + d * s
    with np.errstate(divide="ignore", invalid="ignore"):
        best = np.nanargmin(t**2 / (s**2 + f**2 * t**2) + q**2 / (p**2 + g**2 * q**2))
    line_left = np.array([f * t[best], s[best], -t[best]])
    line_right = np.array([-g * q[best], p[best], q[best]])
    return np.concatenate([_foot(line_left @ turn_left), _foot(line_right @ turn_right)])


def _stationary(a: float, b: float, c: float, d: float, f: float, g: float) -> tuple[Array, Array]:
    """Return the lines t : s of the pencil at which the distance may be least: all roots, and 1 : 0."""
    p, q, left = [a, b], [c, d], [f**2, 0.0, 1.0]
    right = np.convolve(p, p) + g**2 * np.convolve(q, q)
    rise = np.convolve([0.0, 1.0, 0.0], np.convolve(right, right))
    fall = (a * d - b * c) * np.convolve(np.convolve(left, left), np.convolve(p, q))
    roots = np.roots(rise - fall).real
    return np.append(roots, 1.0), np.append(np.ones_like(roots), 0.0)


def _shift(point: Array) -> Array:
    T = np.eye(3)
    T[:2, 2] = point
    return T


def _epipole_on_x(epipole: Array) -> tuple[Array, float]:
    """Return the rotation (3, 3) of the image that takes the epipole to (1, 0, f), and f."""
    x, y, w = epipole / np.hypot(epipole[0], epipole[1])
    return np.array([[x, y, 0.0], [-y, x, 0.0], [0.0, 0.0, 1.0]]), float(w)


def _foot(line: Array) -> Array:
    """Return the point (2,) of a line (3,) nearest to the origin."""
    return np.asarray(-line[2] * line[:2] / (line[0] ** 2 + line[1] ** 2))
