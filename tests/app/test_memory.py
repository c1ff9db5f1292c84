"""Solutions that take long share a server's memory: what they hold, and what happens when there is no more."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from app.rooms.memory import Memory, NoRoom, held
from tests.app.conftest import Local
from tests.app.page import Page


@dataclass(frozen=True)
class Found:
    """A solution."""

    points: Any
    more: Any = None
    count: int = 3


def test_what_a_solution_holds_is_found_and_counted_once() -> None:
    points = np.zeros((100, 3))
    found = Found(points[:10], {"a": (points, [np.ones(5, dtype=np.uint8), 1.0])}, 7)
    assert sorted(held(found).values()) == [5, 2400]
    assert held(Found(1.0, "text")) == {}


def test_the_newest_that_does_not_fit_is_refused_and_the_others_stay() -> None:
    memory = Memory(1000)
    mine, theirs, shared = (Found(np.zeros(size, dtype=np.uint8)) for size in (400, 500, 600))
    memory.take("me", mine)
    memory.take("them", theirs)
    with pytest.raises(NoRoom, match="no room"):
        memory.take("me", shared)
    assert memory.bytes == 900, "what was there before stays"
    memory.free("them")
    memory.take("me", shared)
    memory.take("other", Found(shared.points[:5]))
    assert memory.bytes == 600, "what is shared counts once"
    memory.free("nobody")


def test_a_cloud_for_which_there_is_no_room_is_refused_in_words() -> None:
    with Local(max_memory=50) as local, Page(local.url, slug="point-cloud") as page:
        local.services.sessions._solver.memory._most = local.services.sessions.solved_bytes()
        before = page.params
        page.tell({"type": "set", "params": {"show_normals": True}})
        page.until(lambda: page.errors, "a refusal")
        assert "no room for this" in page.errors[-1]
        page.settle()
        assert page.params == before
