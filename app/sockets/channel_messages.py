"""What a page may say on its channel."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec

Number = Annotated[float, msgspec.Meta(ge=-1e9, le=1e9)]


class Hello(msgspec.Struct, tag="hello", tag_field="type", forbid_unknown_fields=True):
    """First message on the channel."""

    dark: bool
    reduced: bool
    query: Annotated[str, msgspec.Meta(max_length=4000)]
    opened: Annotated[str, msgspec.Meta(max_length=4000)] = ""
    """The query that the page was opened with, to which a reset returns."""
    ticket: Annotated[str, msgspec.Meta(max_length=60)] = ""
    """What the page was handed to steer with; from a page with the key, what it has handed over."""
    follows: bool = True
    """It lets its viewpoint be led."""


class Handle(msgspec.Struct, tag="handle", tag_field="type", forbid_unknown_fields=True):
    """A handle in an image pane was moved to a place, in pixels."""

    name: Annotated[str, msgspec.Meta(max_length=100)]
    x: Number
    y: Number


class Slide(msgspec.Struct, tag="slide", tag_field="type", forbid_unknown_fields=True):
    """A slider was moved."""

    name: Annotated[str, msgspec.Meta(max_length=100)]
    value: Number


class Enter(msgspec.Struct, tag="enter", tag_field="type", forbid_unknown_fields=True):
    """Something was typed into a box, or chosen."""

    name: Annotated[str, msgspec.Meta(max_length=100)]
    text: Annotated[str, msgspec.Meta(max_length=400)]


class Set(msgspec.Struct, tag="set", tag_field="type", forbid_unknown_fields=True):
    """The page around the sim sets parameters."""

    params: Annotated[dict[str, Any], msgspec.Meta(max_length=100)]
    seconds: float | None = None
    """To glide there in; None is at once."""


class Act(msgspec.Struct, tag="action", tag_field="type", forbid_unknown_fields=True):
    """A button by name."""

    name: Annotated[str, msgspec.Meta(max_length=100)]


class Hover(msgspec.Struct, tag="point", tag_field="type", forbid_unknown_fields=True):
    """The pointer is over something that is linked across pictures, tables and the scene; an empty name: nothing."""

    name: Annotated[str, msgspec.Meta(max_length=100)]


class Over(msgspec.Struct, tag="over", tag_field="type", forbid_unknown_fields=True):
    """The pointer passes over the scene: origin and direction of its ray, or nothing where it has left."""

    ray: tuple[Number, Number, Number, Number, Number, Number] | None


class Select(msgspec.Struct, tag="select", tag_field="type", forbid_unknown_fields=True):
    """A click on something that is linked."""

    name: Annotated[str, msgspec.Meta(max_length=100)]


class Cancel(msgspec.Struct, tag="cancel", tag_field="type", forbid_unknown_fields=True):
    """Gives up what is being worked on."""


class View(msgspec.Struct, tag="view", tag_field="type", forbid_unknown_fields=True):
    """The page looks from another place: viewpoint and looked-at place, x, y, z each."""

    view: Annotated[list[Number], msgspec.Meta(min_length=6, max_length=6)]


class Follow(msgspec.Struct, tag="follow", tag_field="type", forbid_unknown_fields=True):
    """The page lets its viewpoint be led, or goes its own way."""

    on: bool


class Lend(msgspec.Struct, tag="lend", tag_field="type", forbid_unknown_fields=True):
    """Hands the room over by a new ticket, or takes it back."""

    on: bool


class Get(msgspec.Struct, tag="get", tag_field="type", forbid_unknown_fields=True):
    """Asks for the state, and for its solution too."""

    solution: bool = False


decoder = msgspec.json.Decoder(
    Hello | Slide | Enter | Handle | Set | Act | Hover | Over | Select | Cancel | Follow | Lend | Get | View
)
