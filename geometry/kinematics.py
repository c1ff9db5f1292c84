"""Serial arms of revolute joints: postures, the Jacobian and how near it is to singular, reach, swapped links."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .arrays import Array, Components, Mask, components, cos_sin, cross, stack
from .errors import GeometryError, as_angle, as_array, as_choice, as_finite_array, as_number
from .gimbal import RANK, degrees_of_freedom
from .rotations import AXES

_TURNS = {"x": (0, 1, 2), "y": (1, 2, 0), "z": (2, 0, 1)}  # an axis, and the two that it turns, first to second
_GENERAL = ((0.4, 1.1, -0.7, 1.9, 0.9, -1.3, 2.3, 0.6), (-1.0, 0.8, 1.7, -0.5, 1.4, 2.1, -1.8, 0.3))


class Posture(NamedTuple):
    """An arm of n joints at given angles, in the frame of its base; metres and radians.

    `individual` (..., n, 4, 4) are T_{i−1,i}; `composed` (..., n, 4, 4) are T_{0,i}, the end effector's last;
    `positions` (..., n + 1, 3) the base and the end of each link; `jacobian` (..., 6, n), for rates of the joints,
    the end effector's velocity in its first three rows and angular velocity in the others.
    """

    individual: Array
    composed: Array
    positions: Array
    jacobian: Array


class Dexterity(NamedTuple):
    """How freely an arm moves: `singular_values` (..., k) of its Jacobian, descending; `manipulability` (...), the
    product of as many of them as its mobility; and a mask (...), `singular`, of the postures that lost mobility."""

    singular_values: Array
    manipulability: Array
    singular: Mask


class Reach(NamedTuple):
    """Bounds of the end effector's distance from the base, in metres.

    Some posture has the `greatest` distance. Some has the `least` one if `tight`; else the true one may be greater.
    """

    least: float
    greatest: float
    tight: bool


class Joint(NamedTuple):
    """Components of a joint's `axis` and `origin`, and of its link's frame: axes `x`, `y`, `z` and its `end`."""

    axis: Components
    origin: Components
    x: Components
    y: Components
    z: Components
    end: Components

    @property
    def transform(self) -> tuple[Any, ...]:
        """The sixteen entries, by rows, of the link's frame."""
        (a, b, c), (d, e, f), (g, h, i), (x, y, z) = self.x, self.y, self.z, self.end
        return a, d, g, x, b, e, h, y, c, f, i, z, 0.0, 0.0, 0.0, 1.0

    def velocity(self, point: Components) -> tuple[Any, Any, Any]:
        """How a point beyond the joint moves as the joint turns."""
        return cross(self.axis, [p - o for p, o in zip(point, self.origin, strict=True)])


@dataclass(frozen=True)
class Chain:
    """An arm whose link i is T_{i−1,i} = Rot(axis_i, angle_i) · Trans(length_i, 0, 0).

    axes: "x", "y" or "z" for each joint, as in "zyy". lengths: of each link in metres; a negative one points back.
    Raises GeometryError for no joint, another letter, another number of lengths, or one that isn't finite.
    """

    axes: str
    lengths: tuple[float, ...]

    def __post_init__(self) -> None:
        for axis in self.axes or ("",):
            as_choice("axes", axis, AXES)
        lengths = tuple(as_number("lengths", length) for length in self.lengths)
        if len(lengths) != len(self.axes):
            raise GeometryError("lengths", lengths, f"{len(self.axes)} of them, one for each axis")
        object.__setattr__(self, "lengths", lengths)

    def forward(self, angles: npt.ArrayLike) -> Posture:
        """Return the posture at joint angles (..., n) in radians.

        Raises GeometryError for an angle that isn't finite; in a batch it gives NaN.
        Source: Siciliano et al. 2009, "Robotics", sec. 2.7; for the geometric Jacobian, sec. 3.1.3.
        """
        array = as_array("angles", angles, len(self.axes))
        turns, batch = components(array), array.shape[:-1]
        links = list(zip(self.axes, self.lengths, turns, strict=True))
        joints, alone = walk(links), [walk([link])[0] for link in links]
        end = joints[-1].end
        return Posture(
            individual=_stack(batch, [joint.transform for joint in alone], 4, 4),
            composed=_stack(batch, [joint.transform for joint in joints], 4, 4),
            positions=_stack(batch, [joints[0].origin, *(joint.end for joint in joints)], 3),
            jacobian=_stack(batch, [(*joint.velocity(end), *joint.axis) for joint in joints], 6).swapaxes(-1, -2),
        )

    @property
    def mobility(self) -> int:
        """In how many directions, 0 to 3, the end effector can move from a general posture: two for a planar arm."""
        return _mobility(self.axes, self.lengths)

    @property
    def reach(self) -> Reach:
        """How near to the base and how far from it the end effector can be.

        Turning about x bends nothing, so such a link prolongs the one before it. The bounds are the polygon
        inequality of what is left, which a plane arm meets; bends about both y and z may keep it from closing.
        """
        straight = [self.lengths[0]]
        for axis, length in zip(self.axes[1:], self.lengths[1:], strict=True):
            if axis == "x":
                straight[-1] += length
            else:
                straight.append(length)
        greatest = sum(map(abs, straight))
        least = max(2.0 * max(map(abs, straight)) - greatest, 0.0)
        return Reach(least, greatest, tight=least > 0.0 or not {"y", "z"} <= set(self.axes[1:]))

    def swap(self, index: int, angles: npt.ArrayLike) -> tuple["Chain", Array]:
        """Return the arm, and its angles (..., n), with links `index` and `index` + 1, counted from 0, exchanged.

        Raises GeometryError if there aren't two such links.
        """
        n = len(self.axes)
        if not 0 <= index < n - 1:
            raise GeometryError("index", index, f"0 to {n - 2}" if n > 1 else "none: one link has no neighbour")
        order = [*range(index), index + 1, index, *range(index + 2, n)]
        swapped = Chain("".join(self.axes[i] for i in order), tuple(self.lengths[i] for i in order))
        return swapped, as_array("angles", angles, n)[..., order]


def walk(links: Iterable[tuple[str, float, Any]]) -> list[Joint]:
    """Return the joints of links, each an axis letter, a length and an angle: a float, or an array for a batch."""
    joints = []
    frame: list[Components] = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]
    end: Components = (0.0, 0.0, 0.0)
    for axis, length, angle in links:
        i, j, k = _TURNS[axis]
        cos, sin = cos_sin(as_angle("angles", angle))
        (a, b, c), (d, e, f), origin = frame[j], frame[k], end
        frame[j] = a * cos + d * sin, b * cos + e * sin, c * cos + f * sin
        frame[k] = d * cos - a * sin, e * cos - b * sin, f * cos - c * sin
        x, y, z = frame
        end = origin[0] + length * x[0], origin[1] + length * x[1], origin[2] + length * x[2]
        joints.append(Joint(frame[i], origin, x, y, z, end))
    return joints


def _stack(batch: tuple[int, ...], items: Sequence[Components], *shape: int) -> Array:
    flat = stack(*chain.from_iterable(items))
    if flat.shape[:-1] != batch:  # nothing of it depends on the angles
        flat = np.broadcast_to(flat, (*batch, flat.size)).copy()
    return flat.reshape(*batch, len(items), *shape)


def dexterity(jacobian: npt.ArrayLike, mobility: int) -> Dexterity:
    """Return how freely an arm moves by its Jacobian (..., m, n): of velocity alone, its first three rows.

    mobility is what the arm has in general, `Chain.mobility`: a planar arm's third singular value, always zero,
    says nothing. A singular value counts as zero unless it is above 1e-6 of the largest.
    Raises GeometryError for entries that aren't finite.
    Source: Yoshikawa 1985, "Manipulability of robotic mechanisms".
    """
    values: Array = np.asarray(np.linalg.svd(as_finite_array("jacobian", jacobian), compute_uv=False))
    product = values[..., : max(mobility, 1)].prod(axis=-1)
    return Dexterity(values, np.asarray(product), np.asarray(degrees_of_freedom(values) < mobility))


@lru_cache(maxsize=256)
def _mobility(axes: str, lengths: tuple[float, ...]) -> int:
    n = len(axes)
    postures = Chain(axes, lengths).forward([(general * n)[:n] for general in _GENERAL])
    return int(np.linalg.matrix_rank(postures.jacobian[:, :3], rtol=RANK).max())
