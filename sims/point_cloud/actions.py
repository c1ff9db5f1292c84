"""What buttons and handles do to a state."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count
from typing import Any

from geometry import clouds
from sims.kit.sim import Step
from sims.point_cloud.library import NO_FILES, Library
from sims.point_cloud.offers import CloudOffers
from sims.point_cloud.params import CloudParams
from sims.point_cloud.solution import last_step, shown_points


def play(p: CloudParams, library: Library = NO_FILES) -> Iterator[Step]:
    """The process from its start; without one, the cells grow."""
    if p.process == "none":
        yield Step({"voxel_size": 0.0}, 0.0)
        yield Step({"voxel_size": 0.25 * CloudOffers(p, None, library).bounds("voxel_size")[1]}, 4.0)
        return
    for step in count():
        yield Step({"step": step}, 0.0)
        yield Step({"step": step}, 0.25 if p.process == "register" else 1.0)
        if step >= last_step(p, library):
            return


def next_step(p: CloudParams, library: Library = NO_FILES) -> dict[str, Any]:
    """One step on; from the last one back to the start."""
    return {"step": p.step + 1 if p.step < last_step(p, library) else 0}


def pick(p: CloudParams, ray: tuple[float, ...], library: Library = NO_FILES) -> dict[str, int | None]:
    """Select the shown point that a ray (origin, direction) points at, or none."""
    points = shown_points(p, library).points
    found = clouds.pick(points, ray[:3], ray[3:]) if len(points) else None
    return {"selected": None if found is None else found.index}
