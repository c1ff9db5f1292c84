"""What buttons and handles do to a state."""

from __future__ import annotations

from collections.abc import Iterator

from sims.euler_angles.params import EulerParams
from sims.kit.sim import Step


def animate(p: EulerParams) -> Iterator[Step]:
    """The three turns one after another."""
    yield Step({"progress": 0.0}, 0.0)
    for k in (1.0, 2.0, 3.0):
        yield Step({"progress": k}, 1.1)
        yield Step({"progress": k}, 0.35)
