"""Lines of sight: their directions, the angle between two, and where one comes nearest to another."""

from typing import Any

import numpy as np

from ..arrays import Components, cross, dot, ratio, square_root
from ..camera import Camera


def direction(camera: Camera, u: Any, v: Any) -> Components:
    """Return the direction, in the world and at depth 1, of the ray of a pixel."""
    return [a * u + b * v + c for a, b, c in camera.back_projection.tolist()]


def parallax(a: Components, b: Components) -> Any:
    """Return the angle in radians between two directions, accurate however small."""
    normal = cross(a, b)
    return np.arctan2(square_root(dot(normal, normal)), dot(a, b))


def nearest_depth(between: Components, along: Components, other: Components) -> Any:
    """Return how far along its direction a line comes nearest to another that starts at `between` from it.

    NaN for parallel lines.
    """
    normal = cross(along, other)
    return ratio(dot(cross(between, other), normal), dot(normal, normal))


def advance(camera: Camera, depth: Any, along: Components) -> Components:
    """Return the point of a line of sight at a depth."""
    return [c + depth * d for c, d in zip(camera.center.tolist(), along, strict=True)]
