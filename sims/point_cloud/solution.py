"""From a state to its solution: every piece is looked up, or made if nobody has asked for it lately."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import lru_cache

import numpy as np

from geometry import clouds, se3
from geometry.arrays import Array
from sims.kit.progress import begins
from sims.kit.sim import DRAWN
from sims.point_cloud import layers, processes, registration
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.datasets import dataset
from sims.point_cloud.derived import LOCAL, SHADED, Look, colored_by, tally, thinned
from sims.point_cloud.layers import NO_ARROWS, Drawn, Layer, layer
from sims.point_cloud.library import NO_FILES, NOTHING, Library
from sims.point_cloud.params import VIEWS, CloudParams
from sims.point_cloud.processes import Clusters, Ground, Outliers
from sims.point_cloud.registration import Registered
from sims.point_cloud.result import Result
from sims.point_cloud.selected import Measured, Selected, measured, place, selected
from sims.point_cloud.surface import Surface, surface


@dataclass(frozen=True, eq=False)
class Source:
    """How a file was read: its columns' names, what each was taken for, and its unit; and how many points it lost.

    Its points in metres are `origin` away from where they are shown. `notes` say the rest in words.
    """

    name: str
    columns: list[str]
    taken_for: list[str]
    unit: str
    origin: Array | None
    dropped: int
    strays: int
    left_out: int
    notes: list[str]


@dataclass(frozen=True, eq=False)
class CloudSolution:
    """What the sim knows of the shown points."""

    points_in: int
    points_out: int
    minimum: Array
    maximum: Array
    dimensions: Array
    selected: Selected | None
    measured: Measured | None
    colored_by: str
    """What the colours say: the dataset may not have what was asked for."""
    source: Source | None
    """What a file was taken for; null of a built-in dataset."""
    ground: Ground | None
    clusters: Clusters | None
    outliers: Outliers | None
    registration: Registered | None
    surface: Surface | None
    trouble: str
    """In words, why there is no cloud."""
    drawn: Drawn = field(metadata=DRAWN)


MOST_LABELS = 7


def source(p: CloudParams, library: Library) -> Cloud:
    """The cloud of a state: of two files, one after the other."""
    if p.dataset != "file":
        return dataset(p.dataset)
    first = library.find(p.file, p.choice)
    second = library.find(p.second) if p.second else NOTHING
    return _both(first, second) if len(first) and len(second) else first


@lru_cache(maxsize=4)
def _both(first: Cloud, second: Cloud) -> Cloud:
    return first.with_second(second)


def trouble(p: CloudParams, library: Library) -> str:
    """In words, why a file isn't shown; empty if it is."""
    if p.dataset != "file":
        return ""
    return library.trouble(p.file, p.choice) or (library.trouble(p.second) if p.second else "")


def solve(p: CloudParams, library: Library = NO_FILES) -> CloudSolution:
    """All that is shown of a state, on a server with those files."""
    begins("Fetching the cloud")
    cloud, thin, result = processed(p, library)
    low, high = _extent(result)
    chosen = selected(p, thin, result)
    return CloudSolution(
        points_in=len(cloud), points_out=len(result.base.rows) + len(result.marked.rows),
        minimum=low, maximum=high, dimensions=high - low, selected=chosen,
        measured=measured(p, thin, result, chosen),
        colored_by=colored_by(cloud, p.color),
        source=_source(cloud) if p.dataset == "file" and len(cloud) else None,
        ground=result.ground, clusters=result.clusters,
        outliers=result.outliers, registration=result.registration, surface=result.surface,
        trouble=trouble(p, library),
        drawn=_drawn(p, cloud, thin, result, low, high),
    )  # fmt: skip


def processed(p: CloudParams, library: Library) -> tuple[Cloud, Cloud, Result]:
    """The cloud of a state, its thinned points, and what the process makes of these."""
    cloud = source(p, library)
    thin = thinned(cloud, p.voxel_size)
    return cloud, thin, PROCESSES[p.process](p, cloud, thin)


def _source(cloud: Cloud) -> Source:
    return Source(
        cloud.name, list(cloud.columns), list(cloud.roles), cloud.unit, cloud.origin, cloud.dropped, cloud.strays,
        cloud.left_out, [*cloud.notes, *cloud.cautions],
    )  # fmt: skip


def plain(p: CloudParams, cloud: Cloud, thin: Cloud, kind: str = "all", result: object = None) -> Layer:
    """Points in the colours of the state."""
    shaded = p.shading and p.color in SHADED
    return layer(cloud, thin, Look(p.color, _neighbors(p), shaded, p.voxel_size if shaded else 0.0), kind, "", result)


def _neighbors(p: CloudParams) -> int:
    """What the colours depend on: 0 where that isn't the neighbours."""
    return p.neighbors if p.color in LOCAL else 0


def marked(cloud: Cloud, thin: Cloud, kind: str, mark: str, result: object) -> Layer:
    """Points in a colour of their own, whatever that of the state is."""
    return layer(cloud, thin, Look(), kind, mark, result)


def _none(p: CloudParams, cloud: Cloud, thin: Cloud) -> Result:
    return Result(plain(p, cloud, thin), layers.nothing(cloud, thin))


def _ground(p: CloudParams, cloud: Cloud, thin: Cloud) -> Result:
    found = processes.ground(cloud, thin, p.distance)
    result = _none(p, cloud, thin)
    if found is None or p.step == 0:
        return result
    result.ground = found
    result.base = plain(p, cloud, thin, "rest", found)
    if p.step == 1:
        result.marked = marked(cloud, thin, "marked", "ground", found)
    return result


def _clusters(p: CloudParams, cloud: Cloud, thin: Cloud) -> Result:
    result = _none(p, cloud, thin)
    if p.step == 0:
        return result
    found = processes.clusters(cloud, thin, p.distance, p.voxel_size)
    if p.step == 1:
        result.base = plain(p, cloud, thin, "above", found)
        return result
    result.clusters = found
    result.base = marked(cloud, thin, "rest", "grey", found)
    result.marked = marked(cloud, thin, "marked", "clusters", found)
    result.names = layers.cluster_names(found, thin, MOST_LABELS - 4)
    return result


def _outliers(p: CloudParams, cloud: Cloud, thin: Cloud) -> Result:
    result = _none(p, cloud, thin)
    if p.step == 0 or len(thin) < 2:
        return result
    result.outliers = found = processes.outliers(thin, p.neighbors, p.deviations)
    result.base = plain(p, cloud, thin, "rest", found)
    if p.step == 1:
        result.marked = marked(cloud, thin, "marked", "outliers", found)
    return result


def _register(p: CloudParams, cloud: Cloud, thin: Cloud) -> Result:
    course = _course(p, cloud, thin)
    if course is None:
        return _none(p, cloud, thin)
    first, second = (marked(cloud, thin, kind, mark, None) for kind, mark in (("first", "fixed"), ("second", "moves")))
    found = registration.registered(cloud, course, p.step)
    return Result(first, second, found.T, registration=found)


def _course(p: CloudParams, cloud: Cloud, thin: Cloud) -> registration.Course | None:
    return registration.course(cloud, thin, p.method, p.facing, p.distance, p.shift, p.turn)


def last_step(p: CloudParams, library: Library) -> int:
    """The last step of a state's process; how many a registration has must be worked out."""
    if p.process != "register":
        return processes.LAST
    cloud = source(p, library)
    course = _course(p, cloud, thinned(cloud, p.voxel_size))
    return 0 if course is None else len(course.steps) - 1


def _surface(p: CloudParams, cloud: Cloud, thin: Cloud) -> Result:
    result = _none(p, cloud, thin)
    if p.step > 0:
        result.surface = surface(thin, p.voxel_size, p.distance)
    return result


PROCESSES = {
    "none": _none, "ground": _ground, "clusters": _clusters, "outliers": _outliers, "register": _register,
    "surface": _surface,
}  # fmt: skip


def _extent(result: Result) -> tuple[Array, Array]:
    """Least and greatest coordinates of all points that are shown; where none is left, the origin twice."""
    ends = [layers.extent(result.base)] if len(result.base.rows) else []
    if len(result.marked.rows) and result.registration is None:
        ends.append(layers.extent(result.marked))
    elif len(result.marked.rows):
        ends.append(clouds.bounds(se3.apply(result.T, result.marked.points)))
    if not ends:
        return np.zeros(3), np.zeros(3)
    return np.minimum(*_two([e[0] for e in ends])), np.maximum(*_two([e[1] for e in ends]))


def _two(values: list[Array]) -> tuple[Array, Array]:
    return values[0], values[-1]


def _drawn(p: CloudParams, cloud: Cloud, thin: Cloud, result: Result, low: Array, high: Array) -> Drawn:
    base, over, length = NO_ARROWS, NO_ARROWS, 1.0
    if p.show_normals:
        length = layers.arrow_length(thin, p.voxel_size)
        base, over = (layers.arrows(thin, p.neighbors, p.voxel_size, one) for one in (result.base, result.marked))
    ground = None if result.ground is None else layers.patch(result.ground, low, high)
    return Drawn(
        result.base, result.marked, result.T, base, over, length, ground, result.surface, result.names,
        VIEWS[p.dataset] if p.dataset in VIEWS else layers.whole(cloud), cloud,
        tally(cloud, thin, colored_by(cloud, p.color), _neighbors(p)),
        layers.ghost(cloud) if p.voxel_size > 0.0 and p.show_original and p.process == "none" else None,
        _cells(p, cloud, thin, result),
        _grip(p, cloud, result),
    )  # fmt: skip


def _cells(p: CloudParams, cloud: Cloud, thin: Cloud, result: Result) -> layers.Cells | None:
    """Those about the selected point, where it is drawn where it was measured."""
    found = place(result, p.selected)
    if found is None or p.voxel_size == 0.0 or p.process != "none":
        return None
    return layers.cells(cloud, thin, found[0], p.voxel_size)


def _grip(p: CloudParams, cloud: Cloud, result: Result) -> Array | None:
    """The second scan can be moved as long as ICP hasn't."""
    if result.registration is None or result.registration.step > 0:
        return None
    return np.asarray(registration.hold(cloud) + p.shift)


def shown_points(p: CloudParams, library: Library = NO_FILES) -> Cloud:
    """The points that a state shows, in the order of their numbers, where they are shown."""
    _, thin, result = processed(p, library)
    return shown(thin, result)


def shown(thin: Cloud, result: Result) -> Cloud:
    """The thinned points that a process shows."""
    kept = thin.only(np.concatenate([result.base.rows, result.marked.rows]))
    if result.registration is None:
        return kept
    first, T = len(result.base.rows), result.T
    points, turned = kept.points.copy(), kept.normals
    points[first:] = se3.apply(T, points[first:])
    if turned is not None:
        turned = np.concatenate([turned[:first], turned[first:] @ T[:3, :3].T])
    return replace(kept, points=points, normals=turned)
