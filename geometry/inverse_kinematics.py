"""Inverse kinematics of a serial arm: joint angles that bring its end effector to a point, or as near as it gets."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .arrays import Array, cross
from .errors import GeometryError, as_finite_array, as_number
from .kinematics import Chain, Joint, walk

_ITERATIONS = 40
_LONGEST_STEP = 0.5  # radians or metres, of any joint in one iteration
_SETTLED = 1e-8  # radians or metres
_DAMPING = 0.01  # of the most by which the distance bends
_KICK = 0.2  # radians, off a saddle
_TINY = float(np.finfo(np.float64).tiny)  # makes 0 / 0 no step


class InverseKinematics(NamedTuple):
    """Joint `angles` (n,) in radians (metres for joints that slide), the `residual` distance to the target in metres,
    and if that is `reached`."""

    angles: Array
    residual: float
    reached: bool


def inverse_kinematics(
    chain: Chain, target: npt.ArrayLike, start: npt.ArrayLike, *, tolerance: float = 1e-5
) -> InverseKinematics:
    """Return joint angles that bring the end effector within a tolerance, in metres, of a target (3,).

    start (n,) are the angles, in radians (metres for joints that slide), that the search sets out from: it ends near
    them, and doesn't wrap to ±π. Singular postures are safe, each iteration turns a joint by half a radian (half a
    metre) at most, and the same input gives the same angles. Out of reach, the angles are those of a nearest point, and
    `reached` is False. So it is, rarely, for a target within reach: where the way to it leads over a greater distance,
    or is longer than 40 iterations.
    Raises GeometryError for numbers that aren't finite or a tolerance that isn't above zero.
    Source: damped least squares, Wampler 1986, "Manipulator inverse kinematic solutions based on vector formulations
    and damped least-squares methods". Where they no longer halve the distance, as out of reach, the error's exact
    curvature is added, by its absolute value, which leads away from saddles: Dauphin et al. 2014, "Identifying and
    attacking the saddle point problem in high-dimensional non-convex optimization".
    """
    goal, angles = _vector("target", target, 3), _vector("start", start, len(chain.axes))
    tolerance = as_number("tolerance", tolerance, above=0.0)
    angles, residual = _descend(chain, goal, angles, tolerance, curved=False)
    if residual > tolerance:
        angles, residual = _descend(chain, goal, angles, tolerance, curved=True)
    return InverseKinematics(np.array(angles), residual, residual <= tolerance)


def _vector(argument: str, value: npt.ArrayLike, size: int) -> list[float]:
    vector = as_finite_array(argument, value, size)
    if vector.ndim != 1:
        raise GeometryError(argument, f"an array of shape {vector.shape}", f"shape ({size},)")
    numbers: list[float] = vector.tolist()
    return numbers


def _descend(
    chain: Chain, goal: list[float], angles: list[float], enough: float, *, curved: bool
) -> tuple[list[float], float]:
    """Return the nearest angles on the way down, and their distance: without curvature, while steps halve it."""
    size = sum(link.extent for link in chain.links) or 1.0
    nearest, least = angles, math.inf
    for _ in range(_ITERATIONS):
        joints = walk(chain.links, angles)
        error = [g - e for g, e in zip(goal, joints[-1].end, strict=True)]
        residual = math.hypot(*error)
        going = curved or residual <= 0.5 * least
        if residual < least:
            nearest, least = angles, residual
        step = _step(joints, error, residual * size, curved) if going and residual > enough else [0.0]
        longest = max(map(abs, step))
        if longest <= _SETTLED:
            break
        scale = min(1.0, _LONGEST_STEP / longest)
        angles = [angle + scale * change for angle, change in zip(angles, step, strict=True)]
    return nearest, least


def _step(joints: list[Joint], error: list[float], bound: float, curved: bool) -> list[float]:
    """A damped step down half the squared distance. `bound`, distance × size of the arm, is the most it bends."""
    Jt = np.array([joint.velocity(joints[-1].end) for joint in joints])
    hessian = Jt @ Jt.T
    if curved:
        # ∂²p / ∂q_i ∂q_j = a_i × J_j for i ≤ j, none where i slides: the upper triangle, which is all that eigh reads
        hessian -= np.array([cross(error, joint.spin) for joint in joints]) @ Jt.T
    curvature, directions = np.linalg.eigh(hessian, UPLO="U")
    slope = (Jt @ error) @ directions
    along = slope / (np.abs(curvature) + (_DAMPING * bound + _TINY))
    if curvature[0] < -1e-3 * bound and np.abs(slope).max() <= 1e-2 * bound and abs(slope[0]) < -0.1 * curvature[0]:
        along[0] = _KICK * _downhill(slope[0] / bound, directions[:, 0])
    step: list[float] = (directions @ along).tolist()
    return step


def _downhill(slope: float, direction: Array) -> float:
    """The side on which the distance falls; on a ridge, that on which the joint that moves most turns upwards."""
    return math.copysign(1.0, slope if abs(slope) > 1e-9 else direction[np.argmax(np.abs(direction).round(6))])
