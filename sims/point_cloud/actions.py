"""What buttons and handles do to a state."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from geometry import clouds
from sims.kit.sim import Step
from sims.point_cloud.params import CloudParams
from sims.point_cloud.processes import MOST_STEPS
from sims.point_cloud.solution import shown_points


def play(p: CloudParams) -> Iterator[Step]:
    """The process from its start; without one, the cells grow."""
    if p.process == "none":
        yield Step({"voxel_size": 0.0}, 0.0)
        yield Step({"voxel_size": 0.25 * p.bounds("voxel_size")[1]}, 4.0)
        return
    for step in range(MOST_STEPS + 1):
        if step > p.last_step:  # which may be known only after the first
            return
        yield Step({"step": step}, 0.0)
        yield Step({"step": step}, 0.25 if p.process == "register" else 1.0)


def next_step(p: CloudParams) -> dict[str, Any]:
    """One step on; from the last one back to the start."""
    low, high = p.bounds("step")
    return {"step": p.step + 1 if p.step < high else low}


def pick(p: CloudParams, ray: tuple[float, ...]) -> dict[str, int | None]:
    """Select the shown point that a ray (origin, direction) points at, or none."""
    points = shown_points(p).points
    found = clouds.pick(points, ray[:3], ray[3:]) if len(points) else None
    return {"selected": None if found is None else found.index}
