"""One class: who is in it, how far each is, and what the teacher has them look at."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from typing import Any

from app.classes.animals import animal
from app.classes.subject import Subject
from app.rooms.places import Full
from app.rooms.telling import Listener, Message, Shared
from sims.kit.challenge import checked
from sims.kit.params import Params
from sims.kit.sim import Sim

MOST_LEARNERS = 60
MOST_BOXES = 60
"""Predictions that one learner may commit to."""
GRID_INTERVAL = 0.25
"""Seconds between two grids to the teacher, while learners work."""
Find = Callable[[str, Sim[Any, Any], Params], Awaitable[Any]]
"""Finds the solution of a state for somebody, who waits for their turn where that takes long."""


@dataclass(eq=False)
class Learner:
    """Somebody without a name, as long as the class lasts."""

    animal: str
    tell: Listener | None = None
    """Says something to their page; None while it is away."""
    away_since: float = 0.0
    params: Params | None = None
    """The state that they have reached, and the one before whose progress is known."""
    before: tuple[Params, Any] | None = None
    near: dict[str, Any] = field(default_factory=dict)
    """How near that is to each challenge."""
    solved: set[str] = field(default_factory=set)
    guesses: dict[int, float] = field(default_factory=dict)
    """What they have predicted in each box of the lesson: the place of a choice, or a number."""
    asked: str = ""
    """Whether their state may be shown: "" (never asked), "asked", "yes" or "no"."""
    checking: asyncio.Task[None] | None = None


class Class:
    """The learners of one code, and the pages of their teacher."""

    def __init__(self, code: str, key: str, subject: Subject, ends: float, opener: str, find: Find) -> None:
        self.code = code
        self.key = key
        self.subject = subject
        self.ends = ends
        """When it ends by itself, in seconds since 1970: the teacher's page keeps it over a restart."""
        self.opener = opener
        self.learners: dict[str, Learner] = {}
        """By a name that only the learner's page knows."""
        self.teachers: set[Listener] = set()
        self.eyes = False
        """Everybody sees the teacher's state."""
        self.shown: dict[str, Any] | None = None
        """That state."""
        self.over = False
        self._find = find
        self._telling: asyncio.TimerHandle | None = None

    @property
    def occupied(self) -> bool:
        """Somebody is there."""
        return bool(self.teachers) or any(learner.tell for learner in self.learners.values())

    # ---- who comes and goes

    def listen(self, teacher: Listener) -> None:
        """Add a page of the teacher's."""
        self.teachers.add(teacher)
        teacher({"type": "class", "ends": self.ends, "eyes": self.eyes, "params": self.shown})
        teacher(self.grid())

    def enter(self, name: str, wanted: str, tell: Listener) -> Learner:
        """Add a learner, or have one back, whose animal may have been another server's. Raises `Full`."""
        learner = self.learners.get(name)
        if learner is None:
            if len(self.learners) >= MOST_LEARNERS:
                self._forget_one()
            taken = {each.animal for each in self.learners.values()}
            learner = self.learners[name] = Learner(animal(taken, wanted))
        learner.tell = tell
        tell({
            "type": "class", "address": self.subject.address, "animal": learner.animal,
            "eyes": self.eyes, "params": self.shown,
        })  # fmt: skip
        self._changed()
        return learner

    def _forget_one(self) -> None:
        away = [(each.away_since, name) for name, each in self.learners.items() if each.tell is None]
        if not away:
            raise Full(f"This class has {MOST_LEARNERS} learners, as many as one may.")
        del self.learners[min(away)[1]]

    def leave(self, learner: Learner, tell: Listener) -> None:
        """A learner's page is gone, unless another has come in its place."""
        if learner.tell is tell:
            learner.tell = None
            learner.away_since = time.monotonic()
            learner.asked = ""
            self._changed()

    # ---- what learners do

    def reached(self, learner: Learner, params: Params) -> None:
        """A learner's sim is in a state."""
        learner.params = params
        if self.subject.sim.challenges and (learner.checking is None or learner.checking.done()):
            learner.checking = asyncio.create_task(self._check(learner))

    async def _check(self, learner: Learner) -> None:
        """Find how near the newest state is to each challenge."""
        known = None
        while (params := learner.params) is not None and params is not known:
            known = params
            try:
                solution = await self._find(self.code, self.subject.sim, params)
            except Exception:  # a state without a solution, or too much to do: what was known stays
                continue
            learner.near = checked(self.subject.sim.challenges, params, solution, learner.before)
            learner.solved |= {name for name, found in learner.near.items() if found["solved"]}
            learner.before = params, solution
            self._changed()

    def guess(self, learner: Learner, box: int, value: float) -> None:
        """A learner commits to a prediction; the first one counts."""
        if box < MOST_BOXES:
            learner.guesses.setdefault(box, value)
            self._changed()

    def answer(self, learner: Learner, params: Params | None) -> None:
        """A learner lets their state be shown, or doesn't."""
        if learner.asked != "asked":
            return
        learner.asked = "no" if params is None else "yes"
        if params is not None:
            self._tell_teachers({"type": "lent", "animal": learner.animal, "params": plain(params)})
        self._changed()

    # ---- what the teacher does

    def show(self, params: Params) -> None:
        """The teacher's sim is in a state."""
        self.shown = plain(params)
        if self.eyes:
            self._tell_learners(self._looking())

    def look(self, eyes: bool) -> None:
        """All eyes here, or go on."""
        self.eyes = eyes
        self._tell_learners(self._looking())
        self._changed()

    def _looking(self) -> Message:
        return {"type": "eyes", "on": self.eyes, "params": self.shown}

    def ask(self, name: str) -> None:
        """Ask the learner with an animal's name whether their state may be shown."""
        for learner in self.learners.values():
            if learner.animal == name and learner.tell is not None:
                learner.asked = "asked"
                learner.tell({"type": "ask"})
                self._changed()

    def end(self) -> None:
        """The class is over; nothing of it is kept."""
        self._tell_learners({"type": "end"})
        self._tell_teachers({"type": "end"})
        self.close()

    def close(self) -> None:
        """Do nothing more, whoever still talks to it."""
        self.over = True
        for learner in self.learners.values():
            if learner.checking is not None:
                learner.checking.cancel()
        if self._telling is not None:
            self._telling.cancel()

    # ---- what is told

    def _tell_learners(self, message: Message) -> None:
        shared = Shared(message)
        for learner in self.learners.values():
            if learner.tell is not None:
                learner.tell(shared)

    def _tell_teachers(self, message: Message) -> None:
        for teacher in self.teachers:
            teacher(message)

    def _changed(self) -> None:
        """Tell the teacher soon how things stand."""
        if self._telling is None:
            self._telling = asyncio.get_running_loop().call_later(GRID_INTERVAL, self._tell_grid)

    def _tell_grid(self) -> None:
        self._telling = None
        if self.teachers:
            self._tell_teachers(self.grid())

    def grid(self) -> Message:
        """How far each is, and what was predicted, by box and without the animals."""
        guesses: dict[int, list[float]] = {}
        for learner in self.learners.values():
            for box, value in learner.guesses.items():
                guesses.setdefault(box, []).append(value)
        learners = sorted(self.learners.values(), key=lambda each: each.animal)
        return {"type": "grid", "eyes": self.eyes, "learners": [*map(self._row, learners)], "guesses": guesses}

    def _row(self, learner: Learner) -> Message:
        known, one = [each.id for each in self.subject.sim.challenges], self.subject.challenge
        asked = [one] if one else known
        solved = [name for name in asked if name in learner.solved]
        near = learner.near.get(one, {"progress": len(solved) / max(len(asked), 1), "words": ""})
        return {
            "animal": learner.animal, "here": learner.tell is not None, "asked": learner.asked,
            "solved": len(solved), "of": len(asked),
            "progress": 1.0 if len(solved) == len(asked) > 0 else near["progress"], "words": near["words"],
        }  # fmt: skip


def plain(params: Params) -> dict[str, Any]:
    """A state as it goes to a page."""
    return params.model_dump(mode="json")
