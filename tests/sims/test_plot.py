"""Plots: axes that people can read, and curves where the numbers are."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sims.kit.pane import content, figure
from sims.kit.plot import END, FLOOR, LEFT, TOP, Plot, room, step, ticks
from tests.sims.markup import bad_attributes, mistakes, words, xml


def plot() -> Plot:
    made = Plot("sigma", "Depth", x="depth (m)", y="σ (m)", x_max=10.0, y_max=0.2)
    made.curve([(0.0, 0.0), (5.0, 0.1), (10.0, 0.4)], "b")
    made.curve([(0.0, 0.0), (10.0, 0.1)], "2 b", ghost=True)
    return made


@given(st.floats(1e-6, 1e9), st.integers(2, 10))
def test_ticks_are_round_few_and_reach_almost_to_the_end(greatest: float, most: int) -> None:
    gap = step(greatest, most)
    digits = f"{gap:e}".split("e")[0].rstrip("0").rstrip(".")
    assert digits in ("1", "2", "5")
    values = [value for value, _ in ticks(greatest, most)]
    assert values[0] == 0.0
    assert len(values) <= most + 1
    assert greatest - gap < values[-1] * (1 + 1e-6)
    assert values[-1] <= greatest * (1 + 1e-6)


@pytest.mark.parametrize(
    ("greatest", "expected"),
    [
        (10.0, ["0", "2", "4", "6", "8", "10"]),
        (0.2, ["0.00", "0.05", "0.10", "0.15", "0.20"]),
        (2.0, ["0.0", "0.5", "1.0", "1.5", "2.0"]),
    ],
)
def test_ticks_have_as_many_decimals_as_they_need(greatest: float, expected: list[str]) -> None:
    assert [text for _, text in ticks(greatest)] == expected


def test_ticks_of_angles_stand_where_they_are_asked_for() -> None:
    assert [text for _, text in ticks(180.0, gap=45.0)] == ["0", "45", "90", "135", "180"]
    made = Plot("p", "P", x="θ (°)", y="σ", x_max=180.0, y_max=1.0, x_step=45.0)
    assert {"45", "90", "135"} <= set(words(content(made.pane())).split())


@given(st.floats(1e-6, 1e6), st.floats(1.1, 3))
def test_axes_leave_room(value: float, spare: float) -> None:
    assert value * spare <= room(value, spare) * (1 + 1e-9) <= 10.0 * value * spare


def test_values_are_where_the_axes_say() -> None:
    made = plot()
    assert made.at(0.0, 0.0) == (LEFT, FLOOR)
    assert made.at(10.0, 0.2) == (END, TOP)
    svg = made.pane("4 m", (4.0, 0.05)).svg
    u, v = made.at(4.0, 0.05)
    assert f'cx="{u:.1f}" cy="{v:.1f}"' in svg
    assert re.search(rf'M{LEFT}.0 {FLOOR}.0L[^"]+" class="s3-curve"', svg)


def test_a_plot_is_well_formed_named_and_alone_in_its_row() -> None:
    pane = plot().pane("4.00 m", (4.0, 0.05))
    html = content(pane)
    assert not mistakes(html)
    assert not bad_attributes(html)
    svg = next(e for e in xml(html).iter() if e.tag.endswith("svg"))
    assert svg.get("aria-label") == "Depth: 4.00 m"
    assert svg.get("role") == "img"
    assert "s3-wide" in figure(pane)
    assert {"depth (m)", "σ (m)", "b", "2 b"} <= {(e.text or "") for e in svg.iter() if e.tag.endswith("text")}
    assert words(html).startswith("Depth 4.00 m")


def test_without_a_point_only_the_curves_are_there() -> None:
    assert "<circle" not in plot().pane().svg


def test_a_mark_that_can_be_held_says_its_values() -> None:
    svg = plot().pane("4.00 m", (4.0, 0.05), handle="depth", label="The point").svg
    assert not bad_attributes(svg)
    frame = next(e for e in xml(svg).iter() if e.tag.endswith("svg"))
    grip = next(e for e in frame.iter() if e.get("data-handle") == "depth")
    x0, dx, y0, dy = map(float, frame.attrib["data-axes"].split())
    u, v = (float(grip.attrib[name]) for name in ("data-x", "data-y"))
    assert (x0 + dx * u, y0 + dy * v) == pytest.approx((4.0, 0.05))
    assert grip.get("aria-label") == "The point: 4.00 m. Arrow keys move it."
    assert frame.get("role") == "group", "an image has nothing in it that can be held"
