"""Read-outs: figures for people, MathML, notes."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sims.kit.readout import (
    Chain,
    Copied,
    Formula,
    Lamps,
    Link,
    Note,
    Readout,
    Table,
    figure,
    math,
    mathml,
    quantity,
    render,
    row,
    significant,
    symbol,
    under,
)
from tests.sims.markup import bad_numbers, mistakes, words, xml

HOSTILE = "<script>alert('&')</script>\"x\""


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (0.0, 3, "0.000"),
        (-0.0, 3, "0.000"),
        (-0.0004, 3, "0.000"),
        (-0.0006, 3, "−0.001"),
        (0.9996, 3, "1.000"),
        (-1.5, 1, "−1.5"),
        (-0.4, 0, "0"),
        (-0.6, 0, "−1"),
        (-10.0, 0, "−10"),
        (-100.0, 2, "−100.00"),
        (1234567.891, 2, "1234567.89"),
    ],
)
def test_figures_have_a_true_minus_and_no_negative_zero(value: float, digits: int, text: str) -> None:
    assert figure(value, digits) == text


@given(st.floats(-1e12, 1e12), st.integers(0, 6))
def test_a_figure_reads_back_rounded(value: float, digits: int) -> None:
    text = figure(value, digits)
    assert not bad_numbers(text)
    assert float(text.replace("−", "-")) == float(f"{value:.{digits}f}")
    assert len(text.partition(".")[2]) == digits


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (30.0, "°", "30.0°"),
        (0.6, "m", "0.6\u2009m"),
        (-2.0, "px", "−2.0\u2009px"),
        (5.0, "", "5.0"),
        (50.0, "%", "50.0%"),
    ],
)
def test_a_unit_stands_after_a_thin_space(value: float, unit: str, text: str) -> None:
    assert quantity(value, unit, 1) == text


def figures(html: str) -> list[float]:
    return [float(str(n.text).replace("−", "-")) for n in xml(html).iter("mn")]


@pytest.mark.parametrize("shape", [(), (3,), (4,), (2, 2), (3, 3), (3, 4), (4, 4), (1, 3)])
def test_a_matrix_is_written_by_rows(shape: tuple[int, ...]) -> None:
    value = np.arange(np.prod(shape), dtype=float).reshape(shape) - 2.0
    html = mathml(value)
    assert figures(html) == value.ravel().tolist()
    table = [[len(list(r)) for r in t.iter("mtr")] for t in xml(html).iter("mtable")]
    rows, columns = (*shape, 1)[:2] if shape else (0, 0)
    assert table == ([[columns] * rows] if shape else [])


def test_each_column_of_a_matrix_may_have_its_own_digits() -> None:
    numbers = [e.text for e in xml(mathml([[1.0, -0.25], [0.0, 2.0]], (0, 2))).iter("mn")]
    assert numbers == ["1", "−0.25", "0", "2.00"]


def test_words_stand_under_a_vector() -> None:
    (node,) = xml(under(mathml([1.0, 2.0]), "a & b"))
    assert node.tag == "munder"
    assert [child.tag for child in node] == ["mtable", "mtext"]
    assert node[1].text == "a & b"


def test_a_percent_sign_does_no_harm_beside_a_matrix() -> None:
    assert "%" not in mathml(np.eye(2))


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"), (1.0, "1.0000"), (-0.25, "−2.5000·10−1"), (1.2345678e-7, "1.2346·10−7"), (1e-15, "0"),
        (-65432100.0, "−6.5432·107"),
    ],
)  # fmt: skip
def test_entries_with_powers_of_ten_have_as_many_digits_each(value: float, text: str) -> None:
    matrix = np.full((2, 2), 1.0)
    matrix[0, 1] = value
    entries = ["".join(entry.itertext()) for entry in xml(significant(matrix)).iter("mtd")]
    assert entries == ["1.0000", text, "1.0000", "1.0000"]


def test_what_a_button_copies_stands_in_it() -> None:
    html = Formula("Matrix & more", "M", mathml(np.eye(2)), copy='[["<1>"]]').html()
    (button,) = xml(html).iter("button")
    assert (button.get("value"), button.get("aria-label")) == ('[["<1>"]]', "Copy: Matrix & more")
    assert not list(xml(Formula("Matrix", "M", mathml(np.eye(2))).html()).iter("button"))


def test_rows_can_be_those_of_cameras_and_have_their_letters() -> None:
    html = mathml([[1.0, 2.0], [3.0, 4.0]], 1, rows=("left", "right"))
    letters, matrix = re.findall(r"<mtable.*?</mtable>", html)
    assert re.findall(r'class="s3-(left|right)"><mi>(.)</mi>', letters) == [("left", "L"), ("right", "R")]
    entries = re.findall(r'<mtd class="(.*?)"><mn>(.*?)</mn>', matrix)
    assert entries == [("s3-left", "1.0"), ("s3-left", "2.0"), ("s3-right", "3.0"), ("s3-right", "4.0")]


def test_a_tuple_is_written_in_a_row() -> None:
    assert words(row((1.0, -2.0, 0.5), 1)) == "( 1.0 , −2.0 , 0.5 )"


def test_symbols_may_have_an_index() -> None:
    assert words(math(symbol("R", "now"))) == "R now"
    assert [e.tag for e in xml(symbol("R", "now"))] == ["msub"]
    assert [e.tag for e in xml(symbol("R"))] == ["mi"]


ALL: list[Readout] = [
    Formula("A turn", symbol("R"), mathml(np.eye(3))),
    Formula("An angle", symbol("θ"), mathml(30.0), "°"),
    Formula("Without a name", "", mathml(1.0), "m"),
    Table("Methods", [("method", "depth"), ("dlt", "4.00"), ("optimal", "4.01")]),
    Note("All is well."),
    Note("Near the edge.", "near"),
    Note("Parallel rays: no finite point.", "warn"),
]


@pytest.mark.parametrize("readout", ALL, ids=lambda r: type(r).__name__)
def test_each_kind_is_well_formed(readout: Readout) -> None:
    xml(readout.html())
    assert not mistakes(readout.html())


def test_render_holds_all_in_order() -> None:
    html = render(ALL)
    assert len(xml(html)) == len(ALL)
    assert words(html).index("A turn") < words(html).index("Methods") < words(html).index("Parallel rays")


def test_a_table_names_its_rows_and_columns() -> None:
    root = xml(Table("Methods", [("method", "depth"), ("dlt", "4.00")]).html())
    assert [(h.get("scope"), h.text) for h in root.iter("th")] == [
        ("col", "method"),
        ("col", "depth"),
        ("row", "dlt"),
    ]
    assert [d.text for d in root.iter("td")] == ["4.00"]
    assert [c.text for c in root.iter("caption")] == ["Methods"]


@pytest.mark.parametrize(("level", "icon"), [("info", False), ("near", True), ("warn", True)])
def test_a_warning_has_an_icon_that_screen_readers_skip(level: str, icon: bool) -> None:
    root = xml(Note("Words", level).html())
    hidden = [e.text for e in root.iter() if e.get("aria-hidden") == "true"]
    assert hidden == (["⚠"] if icon else [])
    assert "Words" in words(Note("Words", level).html())


@pytest.mark.parametrize(
    "html",
    [
        Formula(HOSTILE, symbol(HOSTILE, HOSTILE), mathml(1.0), HOSTILE).html(),
        Table(HOSTILE, [(HOSTILE, HOSTILE), (HOSTILE, HOSTILE)]).html(),
        Note(HOSTILE, "warn").html(),
        Chain(HOSTILE, [Link(HOSTILE, HOSTILE, HOSTILE, HOSTILE)]).html(),
    ],
    ids=["formula", "table", "note", "chain"],
)
def test_words_are_escaped(html: str) -> None:
    assert "<script" not in html
    assert HOSTILE in re.sub(r"\s+", " ", " ".join(xml(html).itertext()))


def test_rows_of_a_table_are_linked_and_the_selected_one_says_so() -> None:
    table = Table("Points", [("point", "u"), ("Roof", "1.0"), ("Gate & co", "2.0")], ("roof", "gate"), "gate")
    rows = [e for e in xml(table.html()).iter("tr") if e.get("data-link")]
    assert [e.get("data-link") for e in rows] == ["roof", "gate"]
    buttons = [next(e.iter("button")) for e in rows]
    assert [(b.text, b.get("aria-pressed")) for b in buttons] == [("Roof", "false"), ("Gate & co", "true")]
    assert [e.get("class") for e in rows] == [None, "s3-selected"]
    assert not mistakes(table.html())


def test_rows_after_those_that_can_be_selected_may_light_up_and_are_no_buttons() -> None:
    table = Table(
        "Points", [("point", "u"), ("Roof", "1"), ("True & fair", "2"), ("Rest", "3")], ("roof",), "roof", ("t",)
    )
    rows = list(xml(table.html()).iter("tr"))[1:]
    assert [e.get("data-link") for e in rows] == ["roof", "t", None]
    assert [len(list(e.iter("button"))) for e in rows] == [1, 0, 0]
    assert [e.get("class") for e in rows] == ["s3-selected", None, None]
    assert "True &amp; fair" in table.html()


def test_a_chain_has_each_step_with_what_leads_to_it() -> None:
    chain = Chain("The way", [Link("", "world", "(1, 2)"), Link("K", "pixel", "(3, 4)", "fx fy")])
    assert not mistakes(chain.html())
    steps = list(xml(chain.html()).iter("li"))
    assert [[part.text for part in step] for step in steps] == [["world", "(1, 2)"], ["K", "pixel", "(3, 4)"]]
    assert [step.get("data-link") for step in steps] == [None, "fx fy"]


def test_lamps_say_how_many_are_lit_and_mark_those_that_are_out() -> None:
    html = Lamps("2 ways & more", (1.0, 0.25, 0.0)).html()
    assert not mistakes(html)
    assert 'aria-label="2 of 3 lamps lit"' in html
    assert html.count("--glow:0.250") == 1
    assert html.count("s3-out") == html.count("×") == 1
    assert words(html).endswith("2 ways & more")


def test_a_text_to_copy_is_in_its_button_unchanged() -> None:
    text = 'from_euler("ZYX", [1, -2, 3]) <&>'
    html = Copied("Euler & co", text).html()
    assert not mistakes(html)
    button = next(xml(html).iter("button"))
    assert button.get("value") == next(xml(html).iter("code")).text == text
    assert button.get("aria-label") == "Copy: Euler & co"
