"""Registration of two overlapping clouds by iterative closest points (ICP), from coarse to fine."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ..arrays import Array, norm
from ..errors import GeometryError, as_choice, as_finite_array, as_number
from ..se3 import apply
from .alignment import Observability, observability, onto_planes, onto_points
from .neighbours import Neighbours, spatial_order
from .normals import normals as estimate_normals
from .points import THREADS, Indices, Progress, as_cloud, silent

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
        self.points = np.empty_like(self.near.ordered)
        self.points[self.near.order] = self.near.ordered
        self._neighbors = neighbors
        self._normals = None if normals is None else as_finite_array("normals", normals, 3)

    @property
    def normals(self) -> Array:
        """Unit normals (N, 3): the given ones, or estimated; zero, which says nothing, where there is none."""
        if self._normals is None:
            self._normals = np.nan_to_num(estimate_normals(self.points, self._neighbors).normals, nan=0.0)
        return self._normals


class _Pairs:
    """Each moved source point's nearest target point, looked for again only where it may have changed.

    A point that has moved less than half of what its second nearest is farther away than its nearest still has
    that one: in the small steps near the end hardly any point needs the tree.
    """

    def __init__(self, goal: Target, points: Array, reach: float) -> None:
        self.goal, self.reach = goal, reach
        self.asked = points.copy()
        self.near = np.full(len(points), -1, np.intp)
        self.slack = np.zeros(len(points))
        self.distance = np.empty(len(points))

    def update(self, points: Array) -> None:
        moved = points - self.asked
        self._ask(points, np.flatnonzero(~(norm(moved) < self.slack)))
        offsets = points - self.goal.points[self.near]
        self.distance = np.where(self.near >= 0, norm(offsets), np.inf)

    def _ask(self, points: Array, rows: Indices) -> None:
        farthest = 1.25 * self.reach
        tree = self.goal.near.tree
        distance, place = tree.query(points[rows], 2, distance_upper_bound=farthest, workers=THREADS)
        first, second = np.minimum(distance, farthest).T
        found = place[:, 0] < len(self.goal.points)
        self.near[rows] = np.where(found, self.goal.near.order[np.where(found, place[:, 0], 0)], -1)
        self.slack[rows] = np.where(found, 0.5 * (second - first), farthest - self.reach) * (1.0 - 1e-9)
        self.asked[rows] = points[rows]

    @property
    def partner(self) -> Indices:
        """Index of the target point within reach, or −1."""
        return np.where(self.distance <= self.reach, self.near, -1)


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
    if not len(p) or not len(goal.points):
        raise GeometryError("target" if len(p) else "source", "no points", "at least one")
    order = spatial_order(p)  # near points take near ways through the tree
    p = p[order]
    T = np.eye(4) if start is None else as_finite_array("start", start, 4, 4)
    moved = apply(T, p)
    pairs = _Pairs(goal, moved, reach)
    now, partner = _seen(pairs, moved, T, order)
    yield now
    for _ in range(most):
        paired = partner >= 0
        if np.count_nonzero(paired) < (3 if method == "point" else 6):
            return
        T = _better(goal, moved[paired], partner[paired], method) @ T
        moved = apply(T, p)
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
    ordered = p[spatial_order(p)]
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
    return Registration(T, tuple(steps), converged, _certainty(goal, apply(T, p), steps[-1].target, method))


def _certainty(goal: Target, moved: Array, target: Indices, method: str) -> Observability | None:
    paired = target >= 0
    if not paired.any():
        return None
    return observability(moved[paired], goal.normals[target[paired]] if method == "plane" else None)


def _seen(pairs: _Pairs, moved: Array, T: Array, order: Indices) -> tuple[Step, Indices]:
    pairs.update(moved)
    partner = pairs.partner
    near = pairs.distance[partner >= 0]
    error = float(near @ near)
    rmse = math.sqrt(error / len(near)) if len(near) else math.nan
    target = np.empty_like(partner)
    target[order] = partner
    return Step(T, error, len(near) / len(moved), rmse, target), partner


def _better(goal: Target, p: Array, partner: Indices, method: str) -> Array:
    if method == "point":
        return onto_points(p, goal.points[partner])
    return onto_planes(p, goal.points[partner], goal.normals[partner])


def _same(before: Step, now: Step, settled: float) -> bool:
    return abs(now.rmse - before.rmse) <= settled and abs(now.fitness - before.fitness) <= settled
