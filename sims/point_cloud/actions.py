"""What buttons and handles do to a state."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count
from typing import Any

from geometry import clouds
from sims.kit.sim import Step
from sims.kit.types import Place
from sims.point_cloud import layers, registration
from sims.point_cloud.library import NO_FILES, Library
from sims.point_cloud.offers import CloudOffers
from sims.point_cloud.params import CloudParams
from sims.point_cloud.solution import last_step, processed, shown_points, source


def play(p: CloudParams, library: Library = NO_FILES) -> Iterator[Step]:
    """The process from its start; without one, the cells grow."""
    if p.process == "none":
        yield from grow(p, library)
        return
    for step in count():
        yield Step({"step": step}, 0.0)
        yield Step({"step": step}, 0.25 if p.process == "register" else 1.0)
        if step >= last_step(p, library):
            return


def next_step(p: CloudParams, library: Library = NO_FILES) -> dict[str, Any]:
    """One step on; from the last one back to the start."""
    return {"step": p.step + 1 if p.step < last_step(p, library) else 0}


def grow(p: CloudParams, library: Library = NO_FILES) -> Iterator[Step]:
    """The cells grow from nothing."""
    yield Step({"voxel_size": 0.0}, 0.0)
    yield Step({"voxel_size": 0.25 * CloudOffers(p, None, library).bounds("voxel_size")[1]}, 4.0)


def pick(p: CloudParams, ray: tuple[float, ...], library: Library = NO_FILES) -> dict[str, int | None]:
    """Select the shown point that a ray (origin, direction) points at, or none; or measure to it."""
    points = shown_points(p, library).points
    found = clouds.pick(points, ray[:3], ray[3:]) if len(points) else None
    which = "other" if p.measure and p.selected is not None else "selected"
    return {which: None if found is None else found.index}


def under(p: CloudParams, ray: tuple[float, ...], library: Library = NO_FILES) -> layers.Cells | None:
    """The cells about the thinned point that a ray (origin, direction) points at; none where a process goes on."""
    if p.voxel_size == 0.0 or p.process != "none":
        return None
    cloud, thin, _ = processed(p, library)
    found = clouds.pick(thin.points, ray[:3], ray[3:]) if len(thin) else None
    return None if found is None else layers.cells(cloud, thin, found.index, p.voxel_size)


def hold(p: CloudParams, place: Place, library: Library = NO_FILES) -> dict[str, Any]:
    """The second scan begins where it is dragged to."""
    held = registration.hold(source(p, library)).tolist()
    return {"shift": tuple(round(a - b, 4) for a, b in zip(place, held, strict=True))}
