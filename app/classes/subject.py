"""What a class is about."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any
from urllib.parse import parse_qsl, urlencode

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

    @property
    def address(self) -> str:
        """What a frame loads, below the path prefix. A lesson has its challenges in its text."""
        given = parse_qsl(self.query, keep_blank_values=True)
        kept = [(name, text) for name, text in given if name != "challenge" or self.page.endswith("/embed")]
        return self.page + ("?" + urlencode(kept, safe=",-.:") if kept else "")
