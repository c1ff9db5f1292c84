"""A lesson: what a page needs of one file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from app.lessons import dialect
from app.lessons.errors import LessonError, Mistake
from app.lessons.html import Section, Step, Writer
from app.lessons.state import AnySim, setting
from sims.kit.sim import Library

HEAD = {"title": True, "summary": True, "sim": False, "minutes": False}
"""What may stand at a file's head, and whether it must."""


@dataclass(frozen=True)
class Lesson:
    """One file, checked and made into HTML."""

    name: str
    sim: AnySim
    title: str
    summary: str
    minutes: int | None
    sections: tuple[Section, ...]
    teacher: str
    """The teacher's part, as HTML."""
    concepts: tuple[str, ...]
    """Slugs of the concepts that are learnt in it."""

    @property
    def steps(self) -> list[Step]:
        """Its steps, in order."""
        return [section.step for section in self.sections if section.step is not None]

    def data(self) -> list[dict[str, Any]]:
        """Its steps for the page: what the sim is set to at each."""
        return [{"id": step.id, "title": step.title, "words": step.words, **setting(step.state)} for step in self.steps]


def load(path: Path, name: str, sims: tuple[AnySim, ...], given: Callable[[AnySim], tuple[Library, ...]]) -> Lesson:
    """The lesson of a file. Raises LessonError with all that is wrong with it."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise LessonError(
            path.name, [Mistake(1, f"the file can't be read ({error})", "a text file in UTF-8")]
        ) from None
    md = dialect.parser()
    written = dialect.written(md, text)
    known = {sim.slug: sim for sim in sims}
    wrong = written.mistakes + _wrong_head(written.head, known)
    slug = written.head.get("sim", name)
    if slug not in known:
        raise LessonError(path.name, wrong or [Mistake(1, "no sim at the head", "sim: one of " + ", ".join(known))])
    sim = known[slug]
    writer = Writer(md, sim, given(sim), wrong)
    sections = tuple(writer.sections(written.tokens))
    if wrong:
        raise LessonError(path.name, wrong)
    head = written.head
    minutes = int(head["minutes"]) if "minutes" in head else None
    concepts = tuple(writer.concepts)
    return Lesson(name, sim, head["title"], head["summary"], minutes, sections, writer.teacher, concepts)


def _wrong_head(head: dict[str, str], sims: dict[str, AnySim]) -> list[Mistake]:
    allowed = ", ".join(HEAD)
    found = [Mistake(1, f"{name} at the head", f"of {allowed} each at most once") for name in head.keys() - HEAD.keys()]
    found += [
        Mistake(1, f"no {name} at the head", f"between two lines of ---: {allowed}")
        for name, must in HEAD.items() if must and not head.get(name)
    ]  # fmt: skip
    if "sim" in head and head["sim"] not in sims:
        found.append(Mistake(1, f"sim: {head['sim']}", "one of " + ", ".join(sims)))
    if "minutes" in head and not head["minutes"].isdecimal():
        found.append(Mistake(1, f"minutes: {head['minutes']}", "a whole number"))
    return found
