"""Kinds of fields that are words, letters, or on and off."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Self, get_args

from sims.kit.fields.kind import Kind
from sims.kit.spelling import meant


@dataclass(frozen=True, kw_only=True)
class Switch(Kind):
    """On or off; 1 or 0 in a link."""

    control: ClassVar[str] = "switch"
    _words: ClassVar[Mapping[str, str]] = {"true": "1", "yes": "1", "on": "1", "false": "0", "no": "0", "off": "0"}

    @property
    def allowed(self) -> str:
        return "1 or 0"

    @property
    def allowed_in_json(self) -> str:
        return "true or false"

    def unspell(self, text: str) -> Any:
        return {"1": True, "0": False}.get(text)

    def meant(self, text: str) -> str:
        return self._words.get(text.strip().lower(), "")


@dataclass(frozen=True, kw_only=True)
class Choice(Kind):
    """One of the words of the field's Literal type; `labels` says how each is shown.

    A field that may be None says in `absent` how that is shown; in a link it is left out.
    """

    labels: Mapping[str, str]
    absent: str = ""
    control: ClassVar[str] = "choice"
    hints: ClassVar[tuple[str, ...]] = ("labels", "group", "absent")

    def of(self, annotation: Any) -> Self:
        literals = (annotation, *get_args(annotation))
        words = [word for literal in literals for word in get_args(literal) if isinstance(word, str)]
        if set(words) != set(self.labels):
            raise TypeError(f"labels must be one for each of {', '.join(words)}, got {', '.join(self.labels)}")
        return self

    @property
    def words(self) -> tuple[str, ...]:
        """What it may be."""
        return tuple(self.labels)

    @property
    def options(self) -> dict[str | None, str]:
        """How each value is shown; None first, where the field may be absent."""
        absent: dict[str | None, str] = {None: self.absent} if self.absent else {}
        return absent | dict(self.labels)

    @property
    def allowed(self) -> str:
        return "one of: " + ", ".join(self.words)

    def meant(self, text: str) -> str:
        return meant(text, self.words)


@dataclass(frozen=True, kw_only=True)
class Opened(Choice):
    """A choice that is made by opening a fold: to close it goes back to `closed`.

    `folds` are the titles of the folds by their words; each of the sim's pictures, read-outs and nodes comes with its
    own. On a page without folds it is a dropdown as any other.
    """

    folds: Mapping[str, str]
    closed: str


@dataclass(frozen=True, kw_only=True)
class Text(Kind):
    """A few characters in a format of their own, or None, the default; `allowed` says the format to people.

    With a control, the state's `options` say what there is to choose from.
    """

    pattern: str
    format: str
    """In words."""
    control: ClassVar[str] = "choice"
    hints: ClassVar[tuple[str, ...]] = ("allowed", "group")

    @property
    def allowed(self) -> str:
        return self.format

    def _limits(self) -> Mapping[str, Any]:
        return {"pattern": self.pattern}


@dataclass(frozen=True, kw_only=True)
class Letters(Kind):
    """`fewest` to `most` letters, together as in `zyy`, with a dropdown each, called as in `entry`: "Joint {} axis"."""

    labels: Mapping[str, str]
    entry: str
    most: int
    fewest: int = 1
    control: ClassVar[str] = "letters"
    hints: ClassVar[tuple[str, ...]] = ("group", "labels", "most", "entry", "fewest")

    @property
    def allowed(self) -> str:
        return f"{self.fewest} to {self.most} letters, each one of: {', '.join(self.labels)}"

    def _limits(self) -> Mapping[str, Any]:
        return {"pattern": f"^[{''.join(self.labels)}]{{{self.fewest},{self.most}}}$"}
