"""The lessons of a server: one for each sim, and those of the administrator's folder."""

from __future__ import annotations

import asyncio
import logging
import re
from collections.abc import Callable
from functools import cached_property, partial
from pathlib import Path
from threading import Lock
from typing import NamedTuple

from app.lessons.errors import LessonError, Mistake
from app.lessons.lesson import Lesson, begun, load
from app.lessons.state import AnySim
from app.settings import ROOT
from sims.kit.sim import Library

log = logging.getLogger("sim3")
NAME = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
LEARNT = re.compile(r"\{concept:([a-z0-9-]+)")
TITLE = re.compile(r"^title:\s*(.+?)\s*$", re.MULTILINE)
MINUTES = re.compile(r"^minutes:\s*(\d+)\s*$", re.MULTILINE)


class Outline(NamedTuple):
    """What the course says of a sim's lesson, which needn't be loaded for it."""

    title: str
    minutes: int | None
    concepts: tuple[str, ...]
    """Slugs of those that are learnt in it."""


class Shelf:
    """All lessons, each loaded once: those of the sims when they are first asked for."""

    def __init__(
        self, sims: tuple[AnySim, ...], given: Callable[[AnySim], tuple[Library, ...]], folder: Path | None = None
    ) -> None:
        self._sims = sims
        self._given = given
        self._of_sims: dict[str, Lesson | None] = {}
        self._turns = {sim.slug: Lock() for sim in sims}  # a page may ask while all are loaded ahead
        self._closed = False
        self.own: dict[str, Lesson] = {}
        """Those of the folder, by their names."""
        self.broken: dict[str, LessonError] = {}
        """What is wrong with those of its files that are no lessons, by the files' names."""
        for path in sorted(folder.glob("*.md")) if folder is not None else ():
            self._add(path)

    async def soon(self, sim: AnySim) -> Lesson | None:
        """The lesson of a sim, if it has one, without keeping others waiting. Raises LessonError."""
        return await asyncio.to_thread(self.of_sim, sim)

    def of_sim(self, sim: AnySim) -> Lesson | None:
        """The same, in this thread: where states take long to solve, it takes seconds."""
        lesson = self.begun(sim)
        return lesson and lesson.finished()

    def begun(self, sim: AnySim) -> Lesson | None:
        """The same, whose sections are written as they are asked for."""
        with self._turns[sim.slug]:
            if sim.slug not in self._of_sims:
                path = place(sim)
                self._of_sims[sim.slug] = begun(path, sim.slug, self._sims, self._given) if path.is_file() else None
            return self._of_sims[sim.slug]

    def loading(self) -> list[Callable[[], object]]:
        """What loads the lessons of all sims, one by one, so that nobody waits for one."""
        return [partial(self._load, sim) for sim in self._sims]

    def close(self) -> None:
        """The server ends: what is loaded ahead is left as it is after the section that is being written."""
        self._closed = True

    def _load(self, sim: AnySim) -> None:
        lesson = None if self._closed else self.begun(sim)
        for _ in lesson.each() if lesson else ():
            if self._closed:
                break

    @cached_property
    def outlines(self) -> dict[str, Outline]:
        """The lessons of the sims, by their slugs, as far as there are any."""
        return {sim.slug: _outline(place(sim).read_text("utf-8")) for sim in self._sims if place(sim).is_file()}

    @cached_property
    def concepts(self) -> dict[str, str]:
        """In which sim's lesson, by its slug, each concept is learnt."""
        return {concept: slug for slug, outline in self.outlines.items() for concept in outline.concepts}

    def _add(self, path: Path) -> None:
        try:
            if not NAME.fullmatch(path.stem):
                allowed = "small letters, digits and hyphens, as in our-robot.md"
                raise LessonError(path.name, [Mistake(1, f"the name {path.name}", allowed)])
            self.own[path.stem] = load(path, path.stem, self._sims, self._given)
        except LessonError as error:
            self.broken[path.name] = error
            log.warning("not a lesson:\n%s", error)
        except Exception as error:  # whatever is in the file: the server starts without it
            wrong = Mistake(1, f"the file can't be made into a lesson ({type(error).__name__})", "docs/lessons.md")
            self.broken[path.name] = LessonError(path.name, [wrong])
            log.exception("not a lesson: %s", path.name)


def _outline(text: str) -> Outline:
    title, minutes = TITLE.search(text), MINUTES.search(text)
    return Outline(title[1] if title else "", int(minutes[1]) if minutes else None, tuple(LEARNT.findall(text)))


def place(sim: AnySim) -> Path:
    """Where the lesson of a sim is written."""
    return ROOT / "sims" / sim.slug.replace("-", "_") / "lesson.md"
