"""What is wrong with a lesson: where, what was found, and what is allowed."""

from __future__ import annotations

from typing import NamedTuple


class Mistake(NamedTuple):
    """Something in a lesson's file that can't be."""

    line: int
    found: str
    allowed: str

    def words(self, file: str) -> str:
        """In one line."""
        return f"{file}:{self.line}: {self.found}; allowed: {self.allowed}"


class LessonError(ValueError):
    """All that is wrong with one file."""

    def __init__(self, file: str, mistakes: list[Mistake]) -> None:
        super().__init__("\n".join(mistake.words(file) for mistake in mistakes))
        self.file = file
        self.mistakes = sorted(mistakes)
