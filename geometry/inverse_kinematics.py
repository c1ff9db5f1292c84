"""Inverse kinematics of a serial arm: joint angles that bring its end effector to a point, or as near as it gets."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .arrays import Array, cross
from .errors import GeometryError, as_finite_array, as_number
from .kinematics import Chain, Joint, walk

_ITERATIONS = 40
_LONGEST_STEP = 0.5  # radians, of any joint in one iteration
_SETTLED = 1e-8  # radians
_DAMPING = 0.01  # of residual × size of the arm, which bounds the curvature
_KICK = 0.2  # radians


class InverseKinematics(NamedTuple):
    """Joint `angles` (n,) in radians, the `residual` distance to the target in metres, and if that is `reached`."""

    angles: Array
    residual: float
    reached: bool


def inverse_kinematics(
    chain: Chain, target: npt.ArrayLike, start: npt.ArrayLike, *, tolerance: float = 1e-5
) -> InverseKinematics:
    """Return joint angles that bring the end effector within a tolerance, in metres, of a target (3,).

    start (n,) are the angles, in radians, that the search sets out from: it ends near them, and doesn't wrap to ±π.
    Singular postures are safe, each iteration turns a joint by half a radian at most, and the same input gives the
    same angles. Out of reach, the angles are those of a nearest point and `reached` is False. So it is, rarely, for
    a target within reach: where the way to it leads over a greater distance, or is longer than 40 iterations.
    Raises GeometryError for numbers that aren't finite or a tolerance that isn't above zero.
    Source: damped least squares, Wampler 1986, "Manipulator inverse kinematic solutions based on vector formulations
    and damped least-squares methods", with two additions for targets out of reach: the exact curvature, and its
    absolute value, which leads away from saddles (Dauphin et al. 2014, "Identifying and attacking the saddle point").
    """
    goal = _vector("target", target, 3)
    angles = nearest = _vector("start", start, len(chain.axes))
    tolerance = as_number("tolerance", tolerance, above=0.0)
    size = sum(map(abs, chain.lengths)) or 1.0
    least = math.inf
    for _ in range(_ITERATIONS):
        joints = walk(zip(chain.axes, chain.lengths, angles, strict=True))
        error = [g - e for g, e in zip(goal, joints[-1].end, strict=True)]
        residual = math.hypot(*error)
        if residual < least:
            nearest, least = angles, residual
        if residual <= tolerance:
            break
        step = _step(joints, error, residual, size)
        longest = max(map(abs, step))
        if longest <= _SETTLED:
            break
        scale = min(1.0, _LONGEST_STEP / longest)
        angles = [angle + scale * change for angle, change in zip(angles, step, strict=True)]
    return InverseKinematics(np.array(nearest), least, least <= tolerance)


def _vector(argument: str, value: npt.ArrayLike, size: int) -> list[float]:
    vector = as_finite_array(argument, value, size)
    if vector.ndim != 1:
        raise GeometryError(argument, f"an array of shape {vector.shape}", f"shape ({size},)")
    return vector.tolist()


def _step(joints: list[Joint], error: list[float], residual: float, size: float) -> list[float]:
    """A damped Newton step down ½ residual²; with the error it becomes one of Gauss and Newton."""
    Jt = np.array([joint.velocity(joints[-1].end) for joint in joints])
    # ∂²p / ∂q_i ∂q_j = a_i × J_j for i ≤ j: the upper triangle, which is all that eigh reads
    bend = np.array([cross(error, joint.axis) for joint in joints])
    curvature, directions = np.linalg.eigh((Jt - bend) @ Jt.T, UPLO="U")
    slope = (Jt @ error) @ directions
    steepness = np.abs(curvature) + (_DAMPING * residual * size + 1e-12 * size * size)
    along = slope / steepness
    if _is_stuck(curvature[0], slope, residual * size):
        # As far as the curvature alone takes to the target, away from where the slope vanishes.
        along[0] = min(_KICK, residual / math.sqrt(-curvature[0])) * _side(slope[0], directions[:, 0])
    return (directions @ along).tolist()  # type: ignore[no-any-return]


def _is_stuck(curvature: float, slope: Array, scale: float) -> bool:
    falls_away = curvature < -1e-3 * scale and abs(slope[0]) < -0.1 * curvature
    return falls_away and bool(np.abs(slope).max() <= 1e-2 * scale)


def _side(slope: float, direction: Array) -> float:
    """Downhill; on a level ridge, the side on which the joint that moves most turns upwards."""
    return math.copysign(1.0, slope if abs(slope) > 1e-9 else direction[np.argmax(np.abs(direction).round(6))])
