"""Inverse kinematics of a serial arm: joint angles that bring its end effector to a point, or as near as it gets."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .arrays import Array, Components, components, dot
from .errors import GeometryError, as_finite_array, as_number
from .kinematics import Chain, Joint, walk

_ITERATIONS = 50
_LONGEST_STEP = 0.5  # radians, of any joint in one iteration
_SETTLED = 1e-7  # radians
_FLAT = 1e-3  # of residual × size: a gradient that small may be that of a saddle or a maximum
_KICK = 0.2  # radians


class Inverse(NamedTuple):
    """`angles` (n,) in radians, the `residual` distance from the target in metres, and whether that was `reached`."""

    angles: Array
    residual: float
    reached: bool


def inverse(chain: Chain, target: npt.ArrayLike, start: npt.ArrayLike, *, tolerance: float = 1e-5) -> Inverse:
    """Return joint angles that bring the end effector within a tolerance, in metres, of the target (3,).

    start (n,): the joint angles in radians from which the search goes; it ends near them, by shortest steps, and
    isn't wrapped to ±π. Steps are finite and at most half a radian at singular postures too. Where the target is
    out of reach, or needs more than 50 steps, the angles are those found nearest to it, and `reached` is False.
    Raises GeometryError for numbers that aren't finite or a tolerance that isn't positive.
    Source: damped least squares, Wampler 1986; the damping is |residual| × length of the arm, which outweighs the
    curvature that least squares leave out, so that out of reach too the steps settle. At a posture that is
    stationary but not nearest, as a straight arm and a target along it, it leaves where the curvature is least.
    """
    x, y, z = _vector("target", target, 3)
    turns = _vector("start", start, len(chain.axes))
    tolerance = as_number("tolerance", tolerance, above=0.0)
    size = sum(map(abs, chain.lengths)) or 1.0
    best, nearest, kicks = turns, math.inf, 1
    for _ in range(_ITERATIONS):
        joints = walk(zip(chain.axes, chain.lengths, turns, strict=True))
        end = joints[-1].end
        error = x - end[0], y - end[1], z - end[2]
        residual = math.hypot(*error)
        if residual < nearest:
            best, nearest = turns, residual
        if residual <= tolerance:
            break
        columns = [joint.velocity(end) for joint in joints]
        gradient = [dot(column, error) for column in columns]
        if kicks and max(map(abs, gradient)) <= _FLAT * residual * size:
            kicks -= 1
            step = _downhill(joints, columns, error)
        else:
            step = _damped(columns, error, residual * size)
        longest = max(map(abs, step))
        if longest <= _SETTLED:
            break
        scale = min(1.0, _LONGEST_STEP / longest)
        turns = [turn + scale * change for turn, change in zip(turns, step, strict=True)]
    return Inverse(np.array(best), nearest, nearest <= tolerance)
