"""What a person means who types into a control, or chooses."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sims import by_slug
from sims.kit.entered import NotMeant, entered, number
from sims.kit.offers import Offers
from sims.kit.spelling import shown_number, typed, typed_row


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("47.5", "°", 47.5),
        ("70.5", "°", 70.5),
        ("−0.6", "", -0.6),
        ("-0.6", "", -0.6),
        ("+3", "", 3.0),
        ("45,5", "°", 45.5),
        (".5", "", 0.5),
        ("5.", "", 5.0),
        ("1e2", "", 100.0),
        ("1E-3", "m", 0.001),
        (" 1 000 ", "", 1000.0),
        ("3/4", "", 0.75),
        ("π/3", "°", 60.0),
        ("-pi/2", "°", -90.0),
        ("2π", "°", 360.0),
        ("2*pi/3", "°", 120.0),
        ("π", "", math.pi),
        ("90°", "°", 90.0),
        ("90 deg", "°", 90.0),
        ("1.5 rad", "°", math.degrees(1.5)),
        ("30 cm", "m", 0.3),
        ("12mm", "m", 0.012),
        ("1.2 m", "m", 1.2),
        ("600 px", "px", 600.0),
        ("-0", "", 0.0),
    ],
)
def test_a_number_is_taken_as_it_is_meant(text: str, unit: str, value: float) -> None:
    assert typed(text, unit) == pytest.approx(value, abs=1e-12)
    assert math.copysign(1.0, typed(text, unit)) == math.copysign(1.0, value)


@pytest.mark.parametrize(
    ("text", "unit"),
    [
        ("", ""), ("-", ""), ("many", ""), ("--5", ""), ("+-5", ""), ("1,2,3", ""), ("1.2.3", ""), ("1e", ""),
        ("e5", ""),
        ("1e999", ""), ("nan", ""), ("inf", ""), ("1/0", ""), ("π/0", "°"), ("30 cm", "°"), ("90°", "m"), ("5 px", "m"),
        ("0x10", ""), ("1_000", ""), ("\u0663", ""), ("5 5 x", ""), ("9" * 400, ""),
    ],
)  # fmt: skip
def test_what_is_no_number_is_none(text: str, unit: str) -> None:
    with pytest.raises(ValueError):  # noqa: PT011 — the message is the text
        typed(text, unit)


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("1, 0.5, 2", ["1", "0.5", "2"]),
        ("1,0.5,2", ["1", "0.5", "2"]),
        ("(1; 0,5; 2)", ["1", "0,5", "2"]),
        ("[1 0.5 2]", ["1", "0.5", "2"]),
        ("1\t0.5\t2", ["1", "0.5", "2"]),
        ("0,5", ["0", "5"]),
        ("7", ["7"]),
    ],
)
def test_several_numbers_come_in_one_text(text: str, parts: list[str]) -> None:
    assert typed_row(text) == parts


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (47.5, "47.5"), (-0.6, "−0.6"), (-0.0, "0"), (30.0, "30"), (1 / 3, "0.333333"), (1234567.0, "1.23457e6"),
        (1e-9, "1e−9"), (-18.36, "−18.36"), (0.0001, "0.0001"),
    ],
)  # fmt: skip
def test_a_box_shows_the_number_itself_up_to_six_digits(value: float, text: str) -> None:
    assert shown_number(value) == text
    assert typed(text) == pytest.approx(value, rel=1e-5)


def means(slug: str, name: str, text: str, **state: Any) -> dict[str, Any]:
    sim = by_slug(slug)
    assert sim is not None
    return entered(Offers(sim.params().changed(state)), name, text)


def test_every_kind_of_control_is_understood() -> None:
    assert means("euler-angles", "yaw", "π/6") == {"yaw": pytest.approx(30.0)}
    assert means("euler-angles", "order", "zxz") == {"order": "zxz"}
    assert means("camera", "linked", "0") == {"linked": False}
    assert means("camera", "position", "1, −2, 3.5") == {"position": (1.0, -2.0, 3.5)}
    assert means("camera", "position.1", "−2,5") == {"position.1": -2.5}
    assert means("quaternion", "axis:preset", "x") == {"axis": (1.0, 0.0, 0.0)}
    assert means("quaternion", "axis:preset", "") == {}
    assert means("transform-chain", "angles.2", "90") == {"angles.2": 90.0}
    assert means("transform-chain", "axes.0", "x") == {"axes.0": "x"}
    assert means("transform-chain", "swap", "2") == {"swap": 2}
    assert means("transform-chain", "swap", "", swap=1) == {"swap": None}
    assert means("epipolar", "points", "7") == {"points": 7}
    assert means("point-cloud", "selected", "12") == {"selected": 12}
    assert means("point-cloud", "selected", "none") == {"selected": None}


@pytest.mark.parametrize(
    ("slug", "name", "text", "words"),
    [
        ("euler-angles", "yaw", "400", "This needs a number from −180 to 180°; 400 isn’t."),
        ("euler-angles", "yaw", "abc", "This needs a number from −180 to 180°; “abc” isn’t one."),
        ("epipolar", "points", "2.5", "This needs a whole number from 1 to 12; 2.5 isn’t."),
        ("camera", "position", "1, 2", "Here go 3 numbers; these are 2."),
        ("camera", "position.2", "-1", "This needs a number from 0 to "),
        ("euler-angles", "yaw", "", "This needs a number from −180 to 180°; “” isn’t one."),
    ],
)
def test_what_cannot_be_taken_is_said_in_words(slug: str, name: str, text: str, words: str) -> None:
    with pytest.raises(NotMeant) as refusal:
        means(slug, name, text)
    assert str(refusal.value).startswith(words)


@pytest.mark.parametrize(
    ("slug", "name", "text"),
    [
        ("euler-angles", "nothing", "1"), ("euler-angles", "yaw.1", "1"), ("euler-angles", "order", "ZYX"),
        ("euler-angles", "order.1", "zyx"), ("camera", "linked", "yes"), ("camera", "position.3", "1"),
        ("camera", "position.-1", "1"), ("camera", "position.x", "1"), ("transform-chain", "axes.0", "w"),
        ("transform-chain", "axes.9", "x"), ("quaternion", "axis:preset", "(9, 9, 9)"),
        ("quaternion", "start", "1,0,0,0"),
    ],
)  # fmt: skip
def test_inputs_that_there_are_not_are_no_inputs(slug: str, name: str, text: str) -> None:
    with pytest.raises(LookupError):
        means(slug, name, text)


def test_bounds_are_inclusive_and_exact() -> None:
    assert number("90", (-90.0, 90.0), "°") == 90.0
    assert number("-90", (-90.0, 90.0), "°") == -90.0
    with pytest.raises(NotMeant):
        number("90.0000001", (-90.0, 90.0), "°")
