"""Parameters: links, bounds, complaints."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Any, Literal
from urllib.parse import parse_qsl

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import Field, ValidationError

from sims.kit.entered import NotMeant, entered
from sims.kit.fields import Choice, Letters, Numbers, OptionalNumber, Slider, Switch, Text, Vector
from sims.kit.offers import Offers
from sims.kit.params import Params
from sims.kit.refusals import BadParams
from sims.kit.spelling import clipped, plain, spell


class Toy(Params):
    """One field of each kind; the bounds of `turn` depend on `half`, and `size` was once called `scale`."""

    turn: Annotated[float, Slider(-180, 180, step=1, unit="°", symbol="τ", title="Turn")] = 10
    """An angle"""
    count: Annotated[int, Slider(1, 12, step=1, title="Count")] = 3
    """A whole number"""
    kind: Annotated[Literal["one", "two"], Choice(title="Kind", labels={"one": "The one", "two": "The two"})] = "one"
    """A word"""
    half: Annotated[bool, Switch(title="Half")] = False
    """A switch"""
    place: Annotated[tuple[float, float, float], Vector(-5, 5, step=0.1, unit="m", title="Place")] = (0.0, 1.0, 0.5)
    """Three numbers"""
    size: Annotated[float, Slider(0, 2, step=0.1, title="Size")] = Field(1.0, alias="scale")
    """Renamed"""

    def bounds(self, name: str) -> tuple[float, float]:
        return (-90.0, 90.0) if name == "turn" and self.half else super().bounds(name)


class Framed(Params):
    """A place whose bounds depend on the size of a frame."""

    width: Annotated[int, Slider(10, 100, step=1, title="Width")] = 50
    """A whole number"""
    place: Annotated[tuple[float, float], Vector((0.0, 0.0), (100.0, 20.0), step=1, title="Place")] = (10.0, 10.0)
    """In the frame"""

    def ranges(self, name: str) -> Sequence[tuple[float, float]]:
        return ((0.0, float(self.width)), (0.0, 20.0)) if name == "place" else super().ranges(name)


def test_bounds_of_a_vectors_entries_can_depend_on_the_state() -> None:
    start = Framed()
    assert start.moved({"place": (70.0, 30.0)}).place == (50.0, 20.0)
    assert start.moved({"width": 100}).moved({"place.0": 70.0}).place == (70.0, 10.0)
    assert start.moved({"place": (40.0, 10.0)}).moved({"width": 20}).place == (20.0, 10.0)
    with pytest.raises(ValidationError, match="from 0 to 50"):
        start.changed({"place": (70.0, 10.0)})
    with pytest.raises(NotMeant, match="from 0 to 50"):
        entered(Offers(start), "place.0", "70")
    assert entered(Offers(start.moved({"width": 100})), "place.0", "70") == {"place.0": 70.0}


def read(query: str) -> Toy:
    return Toy.from_query(parse_qsl(query, keep_blank_values=True))


def refused(query: str) -> BadParams:
    with pytest.raises(BadParams) as caught:
        read(query)
    return caught.value


toys = st.builds(
    Toy,
    turn=st.floats(-90, 90),
    count=st.integers(1, 12),
    kind=st.sampled_from(["one", "two"]),
    half=st.booleans(),
    place=st.tuples(*[st.floats(-5, 5)] * 3),
    size=st.floats(0, 2),
)


@given(toys)
def test_link_holds_the_state_exactly(toy: Toy) -> None:
    assert read(toy.query()) == toy


@given(toys)
def test_json_holds_the_state_exactly(toy: Toy) -> None:
    assert Toy.model_validate(toy.model_dump(mode="json")) == toy


@given(toys)
def test_link_can_be_read_by_people(toy: Toy) -> None:
    assert "%" not in toy.query().replace("%2B", "")
    assert "+" not in toy.query()


def test_link_leaves_defaults_out_and_spells_as_the_contract_says() -> None:
    assert Toy().query() == ""
    toy = Toy(turn=-30.5, half=True, place=(1, 0.5, -2), kind="two")
    assert toy.query() == "turn=-30.5&kind=two&half=1&place=1,0.5,-2"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (30.0, "30"),
        (0.5, "0.5"),
        (-0.0, "0"),
        (1e-9, "1e-09"),
        (1e22, "1e+22"),
        (True, "1"),
        (False, "0"),
        ((1.0, -0.0, 2.5), "1,0,2.5"),
        ("left:1,2", "left:1,2"),
    ],
)
def test_values_are_spelled_short(value: Any, text: str) -> None:
    assert spell(value) == text


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_plain_numbers_read_back(value: float) -> None:
    assert float(plain(value)) == value


def test_old_name_still_works() -> None:
    assert read("scale=1.5").size == 1.5
    assert read("size=1.5").size == 1.5
    assert read(read("scale=1.5").query()).size == 1.5


def test_state_cannot_be_assigned_to() -> None:
    with pytest.raises(ValidationError):
        setattr(Toy(), "turn", 3.0)  # noqa: B010 — mypy knows that it's frozen


@pytest.mark.parametrize(
    "text",
    [
        "",
        "abc",
        "nan",
        "inf",
        "-Infinity",
        "1e999",
        "181",
        "-180.0001",
        "1,2",
        "0x10",
        "30°",
        "30;",
        "\x00",
        "−−30",
        "−",
    ],
)
def test_bad_number_is_named_with_what_is_allowed(text: str) -> None:
    with pytest.raises(BadParams) as caught:
        Toy.from_query([("turn", text), ("kind", "two")])
    ((name, received, allowed),) = caught.value.complaints
    assert (name, received, allowed) == ("turn", text, "a number from -180 to 180")
    assert caught.value.good == {"kind": "two"}


@pytest.mark.parametrize(
    ("query", "allowed"),
    [
        ("count=2.5", "a whole number from 1 to 12"),
        ("count=0", "a whole number from 1 to 12"),
        ("kind=three", "one of: one, two"),
        ("kind=One", "one of: one, two"),
        ("kind=", "one of: one, two"),
        ("half=yes", "1 or 0"),
        ("half=", "1 or 0"),
        ("half=true", "1 or 0"),
        ("place=1,2", "3 numbers from -5 to 5, separated by commas"),
        ("place=1,2,3,4", "3 numbers from -5 to 5, separated by commas"),
        ("place=1,,2", "3 numbers from -5 to 5, separated by commas"),
        ("place=1,nan,2", "3 numbers from -5 to 5, separated by commas"),
        ("place=1 2 3", "3 numbers from -5 to 5, separated by commas"),
        ("turn=" + "1" * 401, "at most 400 characters"),
    ],
)
def test_each_kind_says_what_it_allows(query: str, allowed: str) -> None:
    ((name, received, said),) = refused(query).complaints
    assert name == query.partition("=")[0]
    assert said == allowed
    assert len(received) <= 80


@pytest.mark.parametrize("query", ["place=1,2,6", "half=1&turn=100"])
def test_bounds_that_only_the_model_knows(query: str) -> None:
    ((name, _, allowed),) = refused(query).complaints
    assert name in query
    assert "must be from" in allowed


def test_unknown_parameter_lists_those_that_are() -> None:
    error = refused("colour=red&turn=5")
    assert error.complaints == [("colour", "red", "one of: turn, count, kind, half, place, size")]
    assert error.good == {"turn": "5"}


def test_every_complaint_is_told_at_once() -> None:
    error = refused("turn=x&count=99&kind=two&place=0,0,0&colour=red")
    assert {c[0] for c in error.complaints} == {"turn", "count", "colour"}
    assert error.good == {"kind": "two", "place": "0,0,0"}
    assert all(part in str(error) for part in ("turn", "count", "colour"))


def test_the_good_parameters_make_a_good_link() -> None:
    error = refused("turn=x&place=1,2,3&half=1")
    assert Toy.from_query(error.good.items()) == Toy(place=(1, 2, 3), half=True)


def test_however_much_is_wrong_the_complaint_stays_short() -> None:
    error = refused("&".join(f"a{k}={'x' * 50}" for k in range(2000)))
    assert 1 <= len(error.complaints) <= 50


def test_no_internal_name_is_a_parameter() -> None:
    for name in ("model_config", "model_fields", "__class__", "bounds", "_clamped"):
        assert refused(f"{name}=1").complaints[0][0] == name


# ---- changes


@pytest.mark.parametrize(
    "changes", [{"turn": 181}, {"turn": math.nan}, {"turn": "x"}, {"colour": 1}, {"half": True, "turn": 91}]
)
def test_changes_from_a_message_are_refused_beyond_bounds(changes: dict[str, Any]) -> None:
    with pytest.raises(ValidationError):
        Toy().changed(changes)


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"turn": 181}, {"turn": 180.0}),
        ({"turn": -1e9}, {"turn": -180.0}),
        ({"count": 40}, {"count": 12}),
        ({"place": (9, 0, -9)}, {"place": (5.0, 0.0, -5.0)}),
        ({"turn": 91, "half": True}, {"turn": 90.0, "half": True}),
    ],
)
def test_changes_from_a_control_are_kept_within_bounds(changes: dict[str, Any], expected: dict[str, Any]) -> None:
    toy = Toy().moved(changes)
    assert toy.model_dump(include=set(expected)) == expected


def test_bounds_that_become_narrower_take_the_value_along() -> None:
    assert Toy(turn=150).moved({"half": True}).turn == 90.0


@pytest.mark.parametrize(
    "changes",
    [{"turn": math.nan}, {"place": (1.0, math.nan, 0.0)}, {"place": (1.0, 2.0)}, {"kind": "three"}, {"colour": 1}],
)
def test_a_control_cannot_say_what_is_no_value(changes: dict[str, Any]) -> None:
    with pytest.raises(ValidationError):
        Toy().moved(changes)


@given(toys, st.floats(allow_nan=False), st.booleans())
def test_whatever_a_control_says_the_state_is_valid(toy: Toy, turn: float, half: bool) -> None:
    moved = toy.moved({"turn": turn, "half": half})
    assert Toy.model_validate(moved.model_dump(by_alias=False)) == moved


# ---- words


def test_labels_and_units() -> None:
    assert Toy().label("turn") == "Turn τ"
    assert Toy().label("place") == "Place"


def test_numeric_fields_are_those_with_bounds() -> None:
    assert tuple(Toy.numeric) == ("turn", "count", "place", "size")


def test_long_text_is_cut_where_it_is_shown() -> None:
    assert clipped("x" * 80) == "x" * 80
    assert clipped("x" * 81) == "x" * 79 + "…"


# ---- vectors whose entries have bounds of their own


class Pixel(Params):
    """A place in a picture."""

    uv: Annotated[tuple[float, float], Vector((0.0, 0.0), (639.0, 479.0), step=1, title="Pixel")] = (320.0, 240.0)
    """Column and row"""


def test_entries_of_a_vector_are_kept_within_their_own_bounds() -> None:
    assert Pixel().moved({"uv": (1000, 1000)}).uv == (639, 479)
    assert Pixel().moved({"uv": (-1, 500)}).uv == (0, 479)
    assert Pixel().changed({"uv": (639, 479)}).uv == (639, 479)
    with pytest.raises(ValidationError, match="from 0 to 639, then from 0 to 479"):
        Pixel().changed({"uv": (0, 480)})


def test_entries_of_a_vector_say_what_they_allow() -> None:
    with pytest.raises(BadParams) as caught:
        Pixel.from_query([("uv", "x,1")])
    ((_, _, allowed),) = caught.value.complaints
    assert allowed == "2 numbers from 0 to 639, then from 0 to 479, separated by commas"
    assert Pixel().bounds("uv") == (0, 639)


# ---- a choice that may be absent


class Glove(Params):
    """Which hand, if that matters."""

    hand: Annotated[
        Literal["right", "left"] | None,
        Choice(title="Hand", labels={"right": "Right", "left": "Left"}, absent="Either"),
    ] = None
    """Which"""


def test_absent_choice_is_an_option_and_left_out_of_the_link() -> None:
    assert Glove.kinds["hand"].allowed == "one of: right, left"
    assert Glove().options("hand") == {None: "Either", "right": "Right", "left": "Left"}
    assert Toy().options("kind") == {"one": "The one", "two": "The two"}
    assert Glove().query() == ""
    assert Glove(hand="left").query() == "hand=left"
    assert Glove(hand="left").moved({"hand": None}) == Glove()


@pytest.mark.parametrize("text", ["", "both", "none", "null", "None"])
def test_absence_of_a_choice_has_no_word(text: str) -> None:
    with pytest.raises(BadParams) as caught:
        Glove.from_query([("hand", text)])
    assert caught.value.complaints == [("hand", text, "one of: right, left")]


# ---- lists, letters and numbers that may be absent


class Row(Params):
    """A list of numbers with a letter for each, and which of them is meant."""

    sizes: Annotated[tuple[float, ...], Numbers(0, 5, step=0.1, unit="m", title="Sizes", entry="Size {}", most=3)] = (
        1.0,
        2.0,
    )
    """How large each is"""
    marks: Annotated[str, Letters(title="Marks", labels={"a": "An a", "b": "A b"}, entry="Mark {}", most=3)] = "ab"
    """What each is"""
    chosen: Annotated[int | None, OptionalNumber(1, 3, title="Chosen", words="{0} before {1}")] = None
    """Which is meant"""
    spot: Annotated[tuple[float, float] | None, Vector((-1.0, -2.0), (1.0, 2.0), step=0.1, title="Spot")] = None
    """A place, or none"""

    def bounds(self, name: str) -> tuple[float, float]:
        return (1, len(self.sizes) - 1) if name == "chosen" else super().bounds(name)


def test_lists_are_read_and_spelled() -> None:
    row = Row.from_query([("sizes", "1,2.5,3"), ("marks", "abb"), ("chosen", "2"), ("spot", "0.5,-2")])
    assert (row.sizes, row.marks, row.chosen, row.spot) == ((1, 2.5, 3), "abb", 2, (0.5, -2))
    assert row.query() == "sizes=1,2.5,3&marks=abb&chosen=2&spot=0.5,-2"
    assert Row().query() == ""


@pytest.mark.parametrize(
    ("name", "text", "allowed"),
    [
        ("sizes", "", "1 to 3 numbers from 0 to 5, separated by commas"),
        ("sizes", "1,2,3,4", "1 to 3 numbers from 0 to 5, separated by commas"),
        ("sizes", "1,6", "sizes must be from 0 to 5, got 1,6"),
        ("marks", "abc", "1 to 3 letters, each one of: a, b"),
        ("marks", "aaaa", "1 to 3 letters, each one of: a, b"),
        ("chosen", "4", "a whole number from 1 to 3"),
        ("chosen", "2", "chosen must be from 1 to 1, got 2"),
        ("spot", "0,3", "spot must be from -1 to 1, then from -2 to 2, got 0,3"),
        ("spot", "0", "2 numbers from -1 to 1, then from -2 to 2, separated by commas"),
    ],
)
def test_lists_say_what_they_allow(name: str, text: str, allowed: str) -> None:
    with pytest.raises(BadParams) as caught:
        Row.from_query([(name, text)])
    assert caught.value.complaints == [(name, text, allowed)]


def test_a_control_of_one_entry_leaves_the_others_alone() -> None:
    row = Row().moved({"sizes.1": 9.0})
    assert row == Row(sizes=(1.0, 5.0))
    assert row.moved({"marks.0": "b"}).marks == "bb"
    assert row.moved({"sizes.2": 1.0}) == row, "an entry that was taken away meanwhile"
    assert row.moved({"sizes.0": 2.0, "sizes.1": 3.0}).sizes == (2.0, 3.0)
    with pytest.raises(ValidationError):
        row.moved({"marks.0": "c"})


def test_dropdown_of_a_number_that_may_be_absent_offers_what_there_is() -> None:
    assert dict(Row().options("chosen")) == {None: "Off", 1: "1 before 2"}
    assert dict(Row(sizes=(1, 2, 3)).options("chosen")) == {None: "Off", 1: "1 before 2", 2: "2 before 3"}
    assert dict(Toy().options("kind")) == {"one": "The one", "two": "The two"}
    assert Row().entry_label("sizes", 1) == "Size 2"
    with pytest.raises(ValidationError, match="chosen must be absent, got 1"):
        Row(sizes=(1,), chosen=1)


# ---- text in a format of its own


class Route(Params):
    """Somewhere, or nowhere."""

    to: Annotated[
        str | None, Text(title="To", pattern=r"^[a-z]{1,9}:[0-9]{1,4}$", format="street:number", hidden=True)
    ] = None
    """A place"""


def test_text_is_kept_as_it_is_or_is_absent() -> None:
    assert Route().query() == ""
    assert Route(to="elm:12").query() == "to=elm:12"
    assert Route.from_query([("to", "elm:12")]) == Route(to="elm:12")
    assert Route(to="elm:12").changed({"to": None}) == Route()
    assert Route(to="elm:12").moved({"to": "oak:3"}).to == "oak:3"
    assert Route.model_validate_json('{"to": null}') == Route()


@pytest.mark.parametrize("wrong", ["", "elm", "elm:", "Elm:12", "elm:12 ", "elm:12\n", "x" * 9 + ":12345"])
def test_text_in_another_format_is_refused_with_the_format_in_words(wrong: str) -> None:
    with pytest.raises(BadParams) as caught:
        Route.from_query([("to", wrong)])
    assert caught.value.complaints == [("to", wrong, "street:number")]
    with pytest.raises(ValidationError):
        Route().changed({"to": wrong})


class Turns(Params):
    """A list that may be empty."""

    made: Annotated[tuple[float, ...], Numbers(-180, 180, step=1, title="Made", most=3, least=0, hidden=True)] = ()
    """Turns so far"""


@given(st.lists(st.floats(-180, 180), max_size=3))
def test_a_list_that_may_be_empty_comes_back_from_its_link(made: list[float]) -> None:
    turns = Turns(made=tuple(made))
    assert Turns.from_query(parse_qsl(turns.query())) == turns
    assert Turns.model_validate_json(turns.model_dump_json()) == turns
    assert Turns.from_query([("made", "")]) == Turns()


@pytest.mark.parametrize("text", ["1,2,3,4", "181", "a", "1,,2", "nan"])
def test_a_list_that_may_be_empty_says_what_it_allows(text: str) -> None:
    with pytest.raises(BadParams) as caught:
        Turns.from_query([("made", text)])
    ((name, _, allowed),) = caught.value.complaints
    assert name == "made"
    assert "from -180 to 180" in allowed
    assert text == "181" or allowed == "0 to 3 numbers from -180 to 180, separated by commas"
