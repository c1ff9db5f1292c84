"""What the pages of a class may say on their websockets."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec

Given = Annotated[dict[str, Any], msgspec.Meta(max_length=100)]
"""Parameters."""


class Join(msgspec.Struct, tag="join", tag_field="type", forbid_unknown_fields=True):
    """A learner's first message: by what they are known again, and their animal if they have one already."""

    me: Annotated[str, msgspec.Meta(pattern="^[a-z0-9]{16,40}$")]
    animal: Annotated[str, msgspec.Meta(max_length=30)] = ""


class At(msgspec.Struct, tag="at", tag_field="type", forbid_unknown_fields=True):
    """A learner's sim is in a state."""

    params: Given


class Guess(msgspec.Struct, tag="guess", tag_field="type", forbid_unknown_fields=True):
    """A learner has committed to a prediction: which box of the lesson, and the place of the choice or the number."""

    box: Annotated[int, msgspec.Meta(ge=0, le=1000)]
    value: Annotated[float, msgspec.Meta(ge=-1e9, le=1e9)]


class Answer(msgspec.Struct, tag="answer", tag_field="type", forbid_unknown_fields=True):
    """A learner lets a state be shown, or, without one, doesn't."""

    params: Given | None = None


class Open(msgspec.Struct, tag="open", tag_field="type", forbid_unknown_fields=True):
    """A teacher's first message: what the class is about, and how it stands where a server has known it before."""

    page: Annotated[str, msgspec.Meta(max_length=100)]
    query: Annotated[str, msgspec.Meta(max_length=4000)] = ""
    ends: float | None = None
    eyes: bool = False
    params: Given | None = None


class Show(msgspec.Struct, tag="show", tag_field="type", forbid_unknown_fields=True):
    """The teacher's sim is in a state."""

    params: Given


class Look(msgspec.Struct, tag="look", tag_field="type", forbid_unknown_fields=True):
    """All eyes here, or go on."""

    eyes: bool


class Ask(msgspec.Struct, tag="ask", tag_field="type", forbid_unknown_fields=True):
    """Asks a learner whether their state may be shown."""

    animal: Annotated[str, msgspec.Meta(max_length=30)]


class End(msgspec.Struct, tag="end", tag_field="type", forbid_unknown_fields=True):
    """Ends the class."""


learner_decoder = msgspec.json.Decoder(Join | At | Guess | Answer)
teacher_decoder = msgspec.json.Decoder(Open | Show | Look | Ask | End)
