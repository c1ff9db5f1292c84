"""What a class is about."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from sims.kit.sim import Sim


@dataclass(frozen=True)
class Subject:
    """A sim or a lesson, the state in which everybody begins, and the challenge if there is one."""

    sim: Sim[Any, Any]
    page: str
    """The address of what learners get, below the path prefix."""
    query: str
    """The state, with the page's options."""
    challenge: str = ""
    """The id of a challenge; empty: all that the sim has."""
