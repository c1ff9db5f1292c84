"""Serial arms of joints that turn or slide: postures, the Jacobian and how near it is to singular, reach, swaps."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
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

    No posture is nearer than `least` or farther than `greatest`. Some posture has the `greatest` distance where links
    have neither twist nor offset; some has the `least` one if `tight`.
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
    kind: str

    @property
    def transform(self) -> tuple[Any, ...]:
        """The sixteen entries, by rows, of the link's frame."""
        (a, b, c), (d, e, f), (g, h, i), (x, y, z) = self.x, self.y, self.z, self.end
        return a, d, g, x, b, e, h, y, c, f, i, z, 0.0, 0.0, 0.0, 1.0

    @property
    def spin(self) -> Components:
        """Angular velocity of what is beyond the joint, for a rate of one."""
        return self.axis if self.kind == "r" else (0.0, 0.0, 0.0)

    def velocity(self, point: Components) -> Components:
        """How a point beyond the joint moves as the joint does."""
        if self.kind != "r":
            return self.axis if self.kind == "p" else (0.0, 0.0, 0.0)
        return cross(self.axis, [p - o for p, o in zip(point, self.origin, strict=True)])


class Link(NamedTuple):
    """A joint's letter, and what is constant between its frame and the one before."""

    axis: str
    length: float
    twist: float
    offset: float
    start: float
    kind: str

    @property
    def extent(self) -> float:
        """Metres from the joint's origin to the end of its link; of one that slides, before it does."""
        along, across = (self.length + self.offset, 0.0) if self.axis == "x" else (self.length, self.offset)
        return math.hypot(along, across)


@dataclass(frozen=True)
class Chain:
    """An arm whose link i is T_{i−1,i} = Rot(axis_i, θ_i) · Trans(axis_i, d_i) · Trans(x, length_i) · Rot(x, twist_i).

    axes: "x", "y" or "z" for each joint, as in "zyy"; all "z" are the rows of Denavit and Hartenberg (a, α, d, θ).
    lengths: of each link in metres; a negative one points back. What isn't given is zero: twists (radians), offsets
    (metres), starts (radians). joints: "r", "p" or "f" for each, as in "rrpr"; all turn where none are given. One that
    turns has d = offset and θ = start + its angle, one that slides θ = start and d = offset + its way; one that is
    fixed has both as they are, whatever its angle.
    Raises GeometryError for no joint, another letter, another number of any of them, or one that isn't finite.
    Source: Denavit and Hartenberg 1955; Siciliano et al. 2009, "Robotics", sec. 2.8.2.
    """

    axes: str
    lengths: tuple[float, ...]
    twists: tuple[float, ...] = ()
    offsets: tuple[float, ...] = ()
    starts: tuple[float, ...] = ()
    joints: str = ""

    def __post_init__(self) -> None:
        n = len(self.axes)
        for axis in self.axes or ("",):
            as_choice("axes", axis, AXES)
        for name in ("lengths", "twists", "offsets", "starts"):
            given = tuple(as_number(name, number) for number in getattr(self, name))
            numbers = given if given or name == "lengths" else (0.0,) * n
            if len(numbers) != n:
                raise GeometryError(name, given, f"{n} of them, one for each axis")
            object.__setattr__(self, name, numbers)
        object.__setattr__(self, "joints", self.joints or "r" * n)
        if len(self.joints) != n or {*self.joints} - {*"rpf"}:
            raise GeometryError("joints", self.joints, f"{n} letters r, p or f, one for each axis")

    @cached_property
    def links(self) -> tuple[Link, ...]:
        """All that is constant, joint by joint."""
        rows = zip(self.axes, self.lengths, self.twists, self.offsets, self.starts, self.joints, strict=True)
        return tuple(Link(*row) for row in rows)

    @cached_property
    def bare(self) -> bool:
        """Whether all joints turn, and no link has a twist or an offset."""
        return not any((*self.twists, *self.offsets)) and {*self.joints} == {"r"}

    def forward(self, angles: npt.ArrayLike) -> Posture:
        """Return the posture at joint angles (..., n) in radians; for joints that slide, metres.

        Raises GeometryError for one that isn't finite; in a batch it gives NaN.
        Source: Siciliano et al. 2009, "Robotics", sec. 2.7; for the geometric Jacobian, sec. 3.1.3.
        """
        array = as_array("angles", angles, len(self.axes))
        moved, batch = components(array), array.shape[:-1]
        joints = walk(self.links, moved)
        alone = [walk([link], [value])[0] for link, value in zip(self.links, moved, strict=True)]
        end = joints[-1].end
        return Posture(
            individual=_stack(batch, [joint.transform for joint in alone], 4, 4),
            composed=_stack(batch, [joint.transform for joint in joints], 4, 4),
            positions=_stack(batch, [joints[0].origin, *(joint.end for joint in joints)], 3),
            jacobian=_stack(batch, [(*joint.velocity(end), *joint.spin) for joint in joints], 6).swapaxes(-1, -2),
        )

    @property
    def mobility(self) -> int:
        """In how many directions, 0 to 3, the end effector can move from a general posture: two for a planar arm."""
        return _mobility(self)

    @property
    def reach(self) -> Reach:
        """How near to the base and how far from it the end effector can be.

        Turning about x bends nothing, so such a link prolongs the one before it. The bounds are the polygon
        inequality of what is left, which a plane arm meets; bends about both y and z may keep it from closing. A twist
        or an offset may too; and a joint that slides has no end here.
        """
        if not self.bare:
            return self._bound
        straight = [self.lengths[0]]
        for axis, length in zip(self.axes[1:], self.lengths[1:], strict=True):
            if axis == "x":
                straight[-1] += length
            else:
                straight.append(length)
        greatest = sum(map(abs, straight))
        least = max(2.0 * max(map(abs, straight)) - greatest, 0.0)
        return Reach(least, greatest, tight=least > 0.0 or not {"y", "z"} <= set(self.axes[1:]))

    @property
    def _bound(self) -> Reach:
        if "p" in self.joints:
            return Reach(0.0, math.inf, tight=False)
        straight = [link.extent for link in self.links]
        greatest = sum(straight)
        return Reach(max(2.0 * max(straight) - greatest, 0.0), greatest, tight=False)

    def swap(self, index: int, angles: npt.ArrayLike) -> tuple["Chain", Array]:
        """Return the arm, and its angles (..., n), with links `index` and `index` + 1, counted from 0, exchanged.

        Raises GeometryError if there aren't two such links.
        """
        n = len(self.axes)
        if not 0 <= index < n - 1:
            raise GeometryError("index", index, f"0 to {n - 2}" if n > 1 else "none: one link has no neighbour")
        order = [*range(index), index + 1, index, *range(index + 2, n)]
        return self.ordered(order), as_array("angles", angles, n)[..., order]

    def ordered(self, order: Sequence[int]) -> "Chain":
        """Return the arm of these links, counted from 0, in this order."""

        def put(numbers: tuple[float, ...]) -> tuple[float, ...]:
            return tuple(numbers[i] for i in order)

        axes, joints = ("".join(letters[i] for i in order) for letters in (self.axes, self.joints))
        return Chain(axes, put(self.lengths), put(self.twists), put(self.offsets), put(self.starts), joints)


def walk(links: Iterable[Link], angles: Iterable[Any]) -> list[Joint]:
    """Return the joints of links at their angles (for joints that slide, metres): floats, or arrays for a batch."""
    joints = []
    frame: list[Components] = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]
    end: Components = (0.0, 0.0, 0.0)
    for (axis, length, twist, offset, start, kind), angle in zip(links, angles, strict=True):
        i, j, k = _TURNS[axis]
        along, origin = frame[i], end
        moved: Any = as_angle("angles", angle)
        way = offset + moved if kind == "p" else offset
        _turn(frame, j, k, start + moved if kind == "r" else start)
        x = frame[0]
        end = origin[0] + length * x[0], origin[1] + length * x[1], origin[2] + length * x[2]
        if kind == "p" or offset:
            end = end[0] + way * along[0], end[1] + way * along[1], end[2] + way * along[2]
        if twist:
            _turn(frame, 1, 2, twist)
        joints.append(Joint(along, origin, x, frame[1], frame[2], end, kind))
    return joints


def _turn(frame: list[Components], j: int, k: int, angle: Any) -> None:
    """Turn a frame about one of its axes: the two others, of which the first turns towards the second."""
    cos, sin = cos_sin(angle)
    (a, b, c), (d, e, f) = frame[j], frame[k]
    frame[j] = a * cos + d * sin, b * cos + e * sin, c * cos + f * sin
    frame[k] = d * cos - a * sin, e * cos - b * sin, f * cos - c * sin


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
def _mobility(arm: Chain) -> int:
    n = len(arm.axes)
    postures = arm.forward([(general * n)[:n] for general in _GENERAL])
    return int(np.linalg.matrix_rank(postures.jacobian[:, :3], rtol=RANK).max())
