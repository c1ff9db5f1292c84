"""Registration of two overlapping clouds by iterative closest points (ICP), from coarse to fine."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from ..arrays import Array
from ..errors import GeometryError, as_choice, as_finite_array, as_number
from ..se3 import apply
from .alignment import Observability, observability, onto_planes, onto_points
from .neighbours import Neighbours, spatial_order
from .normals import normals as estimate_normals
from .points import THREADS, Indices, Progress, as_cloud, columns, silent, squares

METHODS = ("point", "plane")
SETTLED = 1e-6
"""Change of rmse in metres and of fitness, up to which ICP has converged: Open3D's default."""
_FEWEST = 500  # points, with which a coarse level is worth it


@dataclass(frozen=True, eq=False)
class Step:
    """A pose that ICP has come to, T_target_source (4, 4), and how well it fits.

    `error` is E = Σ‖R pᵢ + t − qᵢ‖² in m² over the pairs of a source point and its nearest target point, `fitness`
    the share of the source's points that have one within reach, `rmse` the root of the pairs' mean square
    distance in metres, NaN without pairs. `target` (N,) is each source point's partner, or −1.
    """

    T_target_source: Array
    error: float
    fitness: float
    rmse: float
    target: Indices


@dataclass(frozen=True, eq=False)
class Registration:
    """Where ICP came to, T_target_source (4, 4): its last step, all of them, whether it converged, what is unsure."""

    T_target_source: Array
    steps: tuple[Step, ...]
    converged: bool
    observability: Observability | None

    @property
    def last(self) -> Step:
        """The step that the pose comes from: its error, rmse and fitness."""
        return self.steps[-1]


class Target:
    """A cloud (N, 3) to register others to, with normals for the planes; the work that is done once."""

    def __init__(self, points: npt.ArrayLike, normals: npt.ArrayLike | None = None, neighbors: int = 16) -> None:
        self.near = Neighbours(points)
        self._neighbors = neighbors
        self._normals = None if normals is None else as_finite_array("normals", normals, 3)

    @cached_property
    def points(self) -> Array:
        """The cloud as it was given, (N, 3)."""
        return self.near.unordered(self.near.ordered)

    @cached_property
    def normals(self) -> Array:
        """Unit normals (N, 3): the given ones, or estimated; zero, which says nothing, where there is none."""
        if self._normals is None:
            return np.nan_to_num(estimate_normals(self.near, self._neighbors).normals, nan=0.0)
        return self._normals

    @cached_property
    def facing(self) -> Array:
        """The normals of `near.ordered`, in columns (3, N)."""
        return columns(self.normals.take(self.near.order, axis=0))


class _Pairs:
    """Each moved source point's nearest target point, looked for again only where it may have changed.

    A point that has moved less than half of what its second nearest is farther away than its nearest still has
    that one: in the small steps near the end hardly any point needs the tree.
    """

    def __init__(self, goal: Target, xyz: Array, reach: float) -> None:
        self.goal, self.reach = goal, reach
        self.asked = xyz.copy()
        self.near = np.full(xyz.shape[1], -1, np.intp)
        self.slack = np.zeros(xyz.shape[1])
        self.distance = np.empty(xyz.shape[1])

    def update(self, xyz: Array) -> None:
        """Find the partners of points that have moved to columns (3, N)."""
        self._ask(xyz, np.flatnonzero(~(_lengths(xyz - self.asked) < self.slack)))
        offsets = xyz - self.goal.near.xyz.take(self.near, axis=1)
        self.distance = np.where(self.near >= 0, _lengths(offsets), np.inf)

    def _ask(self, xyz: Array, rows: Indices) -> None:
        farthest, points = 1.25 * self.reach, xyz.take(rows, axis=1)
        distance, place = self.goal.near.query(points.T, 2, distance_upper_bound=farthest, workers=THREADS)
        first, second = np.minimum(distance, farthest).T
        found = place[:, 0] < len(self.goal.near)
        self.near[rows] = np.where(found, place[:, 0], -1)
        self.slack[rows] = np.where(found, 0.5 * (second - first), farthest - self.reach) * (1.0 - 1e-9)
        self.asked[:, rows] = points

    @property
    def partner(self) -> Indices:
        """Place in `near.ordered` of the target point within reach, or −1."""
        return np.where(self.distance <= self.reach, self.near, -1)


def _lengths(xyz: Array) -> Array:
    return np.asarray(np.sqrt(squares(xyz)))


def icp(
    source: npt.ArrayLike,
    target: npt.ArrayLike | Target,
    reach: float,
    *,
    method: str = "point",
    start: npt.ArrayLike | None = None,
    most: int = 50,
    settled: float = SETTLED,
) -> Iterator[Step]:
    """Yield the start, T_target_source (4, 4), then each step of ICP of source (N, 3) to target (M, 3).

    Pairs are at most `reach` metres apart. It ends when rmse and fitness change by `settled` at most, after
    `most` steps, or when there are too few pairs: three, six for planes.
    Raises GeometryError at the first step if an argument is wrong.
    Source: Besl and McKay 1992 ("point"); Chen and Medioni 1992 ("plane").
    """
    p = as_cloud("source", source)
    goal = target if isinstance(target, Target) else Target(target)
    as_choice("method", method, METHODS), as_number("reach", reach, above=0.0)
    if not len(p) or not len(goal.near):
        raise GeometryError("target" if len(p) else "source", "no points", "at least one")
    order = spatial_order(p)  # near points take near ways through the tree
    xyz = columns(p.take(order, axis=0))
    T = np.eye(4) if start is None else as_finite_array("start", start, 4, 4)
    moved = _moved(T, xyz)
    pairs = _Pairs(goal, moved, reach)
    now, partner = _seen(pairs, moved, T, order)
    yield now
    for _ in range(most):
        paired = np.flatnonzero(partner >= 0)
        if len(paired) < (3 if method == "point" else 6):
            return
        T = _better(goal, moved.take(paired, axis=1), partner.take(paired), method) @ T
        moved = _moved(T, xyz)
        before, (now, partner) = now, _seen(pairs, moved, T, order)
        yield now
        if _same(before, now, settled):
            return


def register(
    source: npt.ArrayLike,
    target: npt.ArrayLike | Target,
    reach: float,
    *,
    method: str = "plane",
    start: npt.ArrayLike | None = None,
    thin: Sequence[int] = (64, 8),
    most: int = 50,
    settled: float = SETTLED,
    progress: Progress = silent,
) -> Registration:
    """Register source (N, 3) to target (M, 3) by ICP, from coarse to fine.

    First every 64th of the source's points, in spatial order, is used, then every 8th, then all: most of the way is
    gone with few. `thin` gives other numbers, () none. `reach` is for all of it, in metres, as in `icp`.
    Raises GeometryError if an argument is wrong.
    """
    p = as_cloud("source", source)
    goal = target if isinstance(target, Target) else Target(target)
    ordered = p.take(spatial_order(p), axis=0)
    counts = [int(as_number("thin", every, least=1)) for every in thin]
    levels = [ordered[::every] for every in counts if len(p) >= _FEWEST * every] + [p]
    T = np.eye(4) if start is None else as_finite_array("start", start, 4, 4)
    steps: list[Step] = []
    for level, points in enumerate(levels):
        first = len(steps)
        for step in icp(points, goal, reach, method=method, start=T, most=most, settled=settled):
            steps.append(step)
            progress((level + (len(steps) - first) / (most + 1)) / len(levels))
        T = steps[-1].T_target_source
    progress(1.0)
    converged = len(steps) - first > 1 and _same(steps[-2], steps[-1], settled)
    return Registration(T, tuple(steps), converged, certainty(goal, p, steps[-1], method))


def certainty(goal: Target, p: Array, last: Step, method: str) -> Observability | None:
    """Return how well the pairs of a step of `icp` fix the motion of source points p (N, 3); None without pairs."""
    paired = np.flatnonzero(last.target >= 0)
    if not len(paired):
        return None
    normals = goal.normals.take(last.target[paired], axis=0) if method == "plane" else None
    return observability(apply(last.T_target_source, p.take(paired, axis=0)), normals)


def _moved(T: Array, xyz: Array) -> Array:
    return np.asarray(T[:3, :3] @ xyz + T[:3, 3:])


def _seen(pairs: _Pairs, moved: Array, T: Array, order: Indices) -> tuple[Step, Indices]:
    pairs.update(moved)
    partner = pairs.partner
    near = pairs.distance[partner >= 0]
    error = float(near @ near)
    rmse = math.sqrt(error / len(near)) if len(near) else math.nan
    target = np.empty_like(partner)
    target[order] = np.where(partner >= 0, pairs.goal.near.order.take(partner), -1)
    return Step(T, error, len(near) / len(partner), rmse, target), partner


def _better(goal: Target, p: Array, partner: Indices, method: str) -> Array:
    q = goal.near.xyz.take(partner, axis=1).T
    if method == "point":
        return onto_points(p.T, q)
    return onto_planes(p.T, q, goal.facing.take(partner, axis=1).T)


def _same(before: Step, now: Step, settled: float) -> bool:
    return abs(now.rmse - before.rmse) <= settled and abs(now.fitness - before.fitness) <= settled
