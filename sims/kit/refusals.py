"""Parameters that a sim can't take: the name of each, what was received, what is allowed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from pydantic_core import PydanticCustomError


class Complaint(tuple[str, str, str]):
    """What was wrong with one parameter: its name, what was received, what is allowed; and what may be meant."""

    meant: str

    def __new__(cls, name: str, received: str, allowed: str, meant: str = "") -> Complaint:
        made = super().__new__(cls, (name, received, allowed))
        made.meant = meant
        return made


class BadParams(ValueError):
    """A link with parameters that the sim can't take; `good` holds the rest, still spelled."""

    def __init__(self, complaints: list[Complaint], good: dict[str, str]) -> None:
        self.complaints = complaints
        self.good = good
        super().__init__(
            "; ".join(f"{name}: got {received!r}, allowed: {allowed}" for name, received, allowed in complaints)
        )


def refusal(names: Iterable[str], words: str) -> PydanticCustomError:
    """The error of a model's validator: which fields it is about, and in words what is wrong with them."""
    return PydanticCustomError("refusal", "{words}", {"words": words, "names": ",".join(names)})


def refused(item: Mapping[str, Any]) -> tuple[list[str], str]:
    """The fields that a model's validator complains of, and its words, from an item of pydantic's error."""
    return str(item.get("ctx", {}).get("names", "")).split(","), str(item["msg"])
