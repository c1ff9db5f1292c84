"""Image panes: SVG in pixel coordinates with handles."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sims.kit.palette import DARK, LIGHT
from sims.kit.pane import Pane, Picture, across, render
from tests.sims.markup import bad_attributes, mistakes, xml

HOSTILE = "<script>alert('&')</script>\"x\""


def full_picture(title: str = "Left image", words: str = "P", label: str = "Left point") -> Picture:
    picture = Picture("left", title)
    picture.line((0, 0), (10, 20), "x", dash="4 3")
    picture.homogeneous_line((1.0, 0.0, -5.0), "y")
    picture.arrow((1, 2), (3, 4), "z")
    picture.cross((5, 6), "warn")
    picture.dot((7, 8), "held", hollow=True)
    picture.text((9, 10), words)
    picture.handle("left_uv", (320.25, 240.5), label, "L")
    return picture


def test_a_picture_is_well_formed_and_as_large_as_its_pixels() -> None:
    pane = full_picture().pane()
    svg = next(iter(xml(pane.svg)))
    assert svg.get("viewBox") == "-0.5 -0.5 640 480"
    assert svg.get("data-pane") == "left"
    assert svg.get("aria-label") == "Left image"
    assert svg.get("role") in ("group", "img")
    assert not mistakes(pane.svg)
    assert not bad_attributes(pane.svg)


def handle_of(picture: Picture) -> ElementTree.Element:
    return next(e for e in xml(picture.pane().svg).iter() if e.get("data-handle"))


def test_a_handle_can_be_found_focused_and_named() -> None:
    handle = handle_of(full_picture())
    assert handle.get("data-handle") == "left_uv"
    assert (float(str(handle.get("data-x"))), float(str(handle.get("data-y")))) == (320.25, 240.5)
    assert handle.get("tabindex") == "0"
    assert str(handle.get("aria-label")).startswith("Left point: 320.2, 240.5 pixels.")
    assert handle.get("transform") == "translate(320.250 240.500)"


@given(st.floats(-1e5, 1e5), st.floats(-1e5, 1e5))
def test_a_handle_says_exactly_where_it_is(x: float, y: float) -> None:
    picture = Picture("p", "P")
    picture.handle("h", (x, y), "Point", "P")
    handle = handle_of(picture)
    assert (float(str(handle.get("data-x"))), float(str(handle.get("data-y")))) == (x, y)


def test_a_handle_takes_numpy_numbers() -> None:
    picture = Picture("p", "P")
    at = np.array([1.5, 2.5])
    picture.handle("h", at, "Point", "P")  # type: ignore[arg-type]
    handle = handle_of(picture)
    assert (handle.get("data-x"), handle.get("data-y")) == ("1.5", "2.5")


def test_handles_and_words_stand_above_lines_and_are_not_clipped() -> None:
    svg = full_picture().pane().svg
    clipped = svg[svg.index('<g clip-path="url(#left-clip)">') :]
    clipped = clipped[: clipped.index("</g>")]
    assert "<line" in clipped
    assert "data-handle" not in clipped
    assert "<text" not in clipped


def test_colours_are_roles_of_the_palette() -> None:
    roles = set(re.findall(r"var\(--([\w-]+)\)", full_picture().pane().svg))
    assert roles <= set(re.findall(r"--([\w-]+):", LIGHT.style()))
    assert re.findall(r"--([\w-]+):", LIGHT.style()) == re.findall(r"--([\w-]+):", DARK.style())


def test_names_inside_two_pictures_do_not_clash() -> None:
    panes = [Picture("left", "L").pane(), Picture("right", "R").pane()]
    html = render(panes, LIGHT.style())
    assert not mistakes(html)
    assert [e.text for e in xml(html).iter("figcaption")] == ["L", "R"]


def test_words_are_escaped() -> None:
    picture = full_picture(HOSTILE, HOSTILE, HOSTILE)
    html = render([picture.pane(), Pane("x", HOSTILE, "<svg/>")], LIGHT.style())
    assert "<script" not in html
    texts = " ".join(xml(html).itertext())
    assert texts.count(HOSTILE) == 3
    assert str(handle_of(picture).get("aria-label")).startswith(HOSTILE)


def test_no_panes_make_an_empty_place() -> None:
    assert len(next(iter(xml(render([], LIGHT.style()))))) == 0


# ---- lines across a picture


@given(st.floats(-np.pi, np.pi), st.floats(0, 639), st.floats(0, 479))
def test_a_line_runs_from_edge_to_edge(angle: float, x: float, y: float) -> None:
    a, b = np.cos(angle), np.sin(angle)
    c = -(a * x + b * y)
    ends = across((a, b, c), 640, 480)
    assert ends is not None
    for u, v in ends:
        assert abs(a * u + b * v + c) < 1e-6
        on_edge = min(abs(u + 0.5), abs(u - 639.5), abs(v + 0.5), abs(v - 479.5))
        assert on_edge < 1e-6


@pytest.mark.parametrize("line", [(1.0, 0.0, 5.0), (1.0, 0.0, -1e4), (0.0, 1.0, 1e9), (0.0, 0.0, 1.0)])
def test_a_line_that_misses_the_picture_is_left_out(line: tuple[float, float, float]) -> None:
    assert across(line, 640, 480) is None
    picture = Picture("p", "P")
    picture.homogeneous_line(line, "x")
    assert "<line" not in picture.pane().svg


@pytest.mark.parametrize("line", [(1.0, 0.0, -100.0), (0.0, 1.0, -100.0), (1.0, -1.0, 0.0), (1.0, 1.0, 1.0)])
def test_scale_and_sign_of_a_line_do_not_matter(line: tuple[float, float, float]) -> None:
    first = across(line, 640, 480)
    for scale in (-1.0, 1e3, -1e-3):
        again = across([scale * v for v in line], 640, 480)
        assert (first is None) == (again is None)
        if first is not None and again is not None:
            np.testing.assert_allclose(sorted(map(tuple, first)), sorted(map(tuple, again)), atol=1e-9)
