"""What every kind of field has."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Self

from pydantic import Field, GetCoreSchemaHandler
from pydantic_core import CoreSchema


@dataclass(frozen=True, kw_only=True)
class Kind(ABC):
    """What every field has: a title, and a control unless it is `hidden` (then something else sets it)."""

    title: str
    group: str = ""
    """Fold of the controls in which it stands; the few that matter most stand in none."""
    hidden: bool = False
    control: ClassVar[str]
    """What sets it on the page, as the JSON schema calls it."""
    hints: ClassVar[tuple[str, ...]] = ("group",)
    """What else the JSON schema tells."""

    def of(self, annotation: Any) -> Self:
        """The kind as a field of this type has it. Raises TypeError where the two don't fit."""
        return self

    @property
    @abstractmethod
    def allowed(self) -> str:
        """In words: what a link may say."""

    @property
    def allowed_in_json(self) -> str:
        return self.allowed

    @property
    def label(self) -> str:
        """Words beside the control."""
        return self.title

    def unspell(self, text: str) -> Any:
        """What a link's text stands for, as far as the kind says; pydantic judges the rest."""
        return text

    def meant(self, text: str) -> str:
        """What a link's text may mean that isn't allowed."""
        return ""

    def glides(self, start: Any, end: Any) -> bool:
        """Whether there is something between two values, for a motion to go through."""
        return False

    def _limits(self) -> Mapping[str, Any]:
        """What pydantic checks, as arguments of its `Field`."""
        return {}

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        hints = {name: value for name in self.hints if (value := getattr(self, name)) is not None}
        extra: dict[str, Any] = {**hints, "control": "none" if self.hidden else self.control}
        about = Field(title=self.title, json_schema_extra=extra, **self._limits())
        return handler.generate_schema(Annotated.__class_getitem__((source, about)))  # type: ignore[attr-defined]
