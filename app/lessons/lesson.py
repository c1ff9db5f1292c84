"""A lesson: what a page needs of one file."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import partial
from itertools import count, islice
from pathlib import Path
from threading import Lock
from typing import Any, Self
from urllib.parse import urlsplit

from app.lessons import dialect
from app.lessons.concepts import CONCEPTS
from app.lessons.errors import LessonError, Mistake
from app.lessons.html import Section, Step, Writer, queries
from app.lessons.state import AnySim, State, named, read, setting
from sims.kit.sim import Library

LARGEST = 400_000
"""Bytes of a file: the longest novel chapters have a tenth of that."""
STRANGE = re.compile(r"[\x00-\x08\x0e-\x1f]")
MINUTES = re.compile(r"[1-9][0-9]{0,2}")
HEAD = {"title": True, "summary": True, "sim": False, "minutes": False}
"""What may stand at a file's head, and whether it must."""


class Lesson:
    """One file, as it is checked and made into HTML: each section when it is first asked for, for that takes long.

    What a state gives must be worked out, and for some that takes seconds; what is read first needn't wait for the
    rest. Whoever comes to the end of the sections is told, by LessonError, what is wrong with the file.
    """

    def __init__(self, path: Path, name: str, written: dialect.Written, writer: Writer) -> None:
        head = written.head
        self.name = name
        self.sim = writer.sim
        self.title = head.get("title", "")
        self.summary = head.get("summary", "")
        self.minutes = int(head["minutes"]) if MINUTES.fullmatch(head.get("minutes", "")) else None
        self.queries = queries(written.tokens)
        """What names the states of its steps."""
        self._file = path.name
        self._writer = writer
        self._writing = writer.sections(written.tokens)
        self._written: list[Section] = []
        self._turn = Lock()  # of several who read it at once, one writes
        self._failed: Exception | None = None  # a fault of ours, on which the writing ended

    def each(self) -> Iterator[Section]:
        """Its sections in order, as soon as each is written."""
        for k in count():
            with self._turn:
                if self._failed is not None:
                    raise self._failed
                if k == len(self._written):
                    self._write_one()
            if k == len(self._written):
                break
            yield self._written[k]
        if self._writer.mistakes:
            raise LessonError(self._file, self._writer.mistakes)

    def _write_one(self) -> None:
        try:
            self._written += islice(self._writing, 1)
        except Exception as error:
            self._failed = error
            raise

    def finished(self) -> Self:
        """The lesson itself, all of it written. Raises LessonError with all that is wrong with it."""
        for _ in self.each():
            pass
        return self

    @property
    def begins(self) -> State:
        """The state of its first step, or else the one in which the sim opens."""
        return named(self.sim, next(iter(self.queries), ""))

    @property
    def sections(self) -> tuple[Section, ...]:
        """All of them."""
        return tuple(self.each())

    @property
    def steps(self) -> list[Step]:
        """Its steps, in order."""
        return [section.step for section in self.each() if section.step is not None]

    @property
    def teacher(self) -> str:
        """The teacher's part, as HTML."""
        return self.finished()._writer.teacher

    @property
    def concepts(self) -> tuple[str, ...]:
        """Slugs of the concepts that are learnt in it."""
        return tuple(self.finished()._writer.concepts)

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
    """The lesson of a file, all of it written. Raises LessonError with all that is wrong with it."""
    return begun(path, name, sims, given).finished()


def begun(path: Path, name: str, sims: tuple[AnySim, ...], given: Callable[[AnySim], tuple[Library, ...]]) -> Lesson:
    """The same, read and not written yet. Raises LessonError where there is nothing to write."""
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
    return Lesson(path, name, written, writer)


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
