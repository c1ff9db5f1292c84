"""A lesson: what a page needs of one file."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from app.lessons import dialect
from app.lessons.concepts import CONCEPTS
from app.lessons.errors import LessonError, Mistake
from app.lessons.html import Section, Step, Writer
from app.lessons.state import AnySim, read, setting
from sims.kit.sim import Library

LARGEST = 400_000
"""Bytes of a file: the longest novel chapters have a tenth of that."""
STRANGE = re.compile(r"[\x00-\x08\x0e-\x1f]")
MINUTES = re.compile(r"[1-9][0-9]{0,2}")
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
        return [
            {
                "id": step.id, "title": step.title, "words": step.words, "challenges": step.challenges,
                **setting(step.state),
            }
            for step in self.steps
        ]  # fmt: skip


def load(path: Path, name: str, sims: tuple[AnySim, ...], given: Callable[[AnySim], tuple[Library, ...]]) -> Lesson:
    """The lesson of a file. Raises LessonError with all that is wrong with it."""
    text = _text(path)
    md = dialect.parser()
    try:
        written = dialect.written(md, text)
    except RecursionError:
        raise LessonError(path.name, [Mistake(1, "boxes or lists nested too deeply", "a few levels")]) from None
    known = {sim.slug: sim for sim in sims}
    wrong = written.mistakes + _wrong_head(written, known)
    slug = written.head.get("sim", name)
    if slug not in known:
        raise LessonError(path.name, wrong or [Mistake(1, "no sim at the head", "sim: one of " + ", ".join(known))])
    sim = known[slug]
    writer = Writer(md, sim, given(sim), wrong, partial(_leads_somewhere, known, given))
    sections = tuple(writer.sections(written.tokens))
    if wrong:
        raise LessonError(path.name, wrong)
    head = written.head
    minutes = int(head["minutes"]) if "minutes" in head else None
    concepts = tuple(writer.concepts)
    return Lesson(name, sim, head["title"], head["summary"], minutes, sections, writer.teacher, concepts)


def _text(path: Path) -> str:
    try:
        if path.stat().st_size > LARGEST:
            raise ValueError(f"it has {path.stat().st_size} bytes")
        text = path.read_text(encoding="utf-8-sig")
        if strange := STRANGE.search(text):
            raise ValueError(f"it holds the character {strange[0]!r}")
    except (OSError, ValueError) as error:  # a UnicodeDecodeError is a ValueError
        allowed = f"a text file in UTF-8 of at most {LARGEST} bytes"
        raise LessonError(path.name, [Mistake(1, f"the file can't be read: {error}", allowed)]) from None
    return text


def _leads_somewhere(sims: dict[str, AnySim], given: Callable[[AnySim], tuple[Library, ...]], href: str) -> None:
    """Raises LookupError in words where a link to this server leads nowhere."""
    parts = urlsplit(href)
    _, first, *rest = parts.path.split("/")
    if first == "concepts" and rest and rest[0] not in CONCEPTS:
        raise LookupError("/concepts/ and one of " + ", ".join(CONCEPTS))
    if first == "sims":
        if not rest or rest[0] not in sims:
            raise LookupError("/sims/ and one of " + ", ".join(sims))
        read(sims[rest[0]], parts.query, given(sims[rest[0]]))
    elif first not in ("", "concepts", "lessons"):
        raise LookupError("/, /sims/…, /concepts/… or /lessons/…")


def _wrong_head(written: dialect.Written, sims: dict[str, AnySim]) -> list[Mistake]:
    allowed, head, at = ", ".join(HEAD), written.head, written.lines
    found = [Mistake(at[name], f"{name} at the head", f"only {allowed}") for name in head.keys() - HEAD.keys()]
    found += [
        Mistake(at.get(name, 1), f"no {name} at the head", f"between two lines of ---: {allowed}")
        for name, must in HEAD.items() if must and not head.get(name)
    ]  # fmt: skip
    if "sim" in head and head["sim"] not in sims:
        found.append(Mistake(at["sim"], f"sim: {head['sim']}", "one of " + ", ".join(sims)))
    if "minutes" in head and not MINUTES.fullmatch(head["minutes"]):
        found.append(Mistake(at["minutes"], f"minutes: {head['minutes']}", "a whole number from 1 to 999"))
    return found
