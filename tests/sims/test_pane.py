"""Image panes: SVG in pixel coordinates with handles."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from sims.kit.frame import INSET, across, border, inside
from sims.kit.palette import LIGHT
from sims.kit.pane import Pane, Picture, content, figure, still
from sims.kit.readout import Chain, Link
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
    picture.strokes([(0.0, 1.0, 2.0, 3.0), (4.0, 5.0, 6.0, 7.0)], "ink", dash="2 2")
    picture.point("roof", (50, 60), label, chosen=True, label=words)
    picture.outside((1e4, 0.0, 1.0), "x", words)
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
    assert roles <= set(vars(LIGHT))


def test_names_inside_two_pictures_do_not_clash() -> None:
    panes = [Picture("left", "L").pane(), Picture("right", "R").pane()]
    html = "".join(map(content, panes))
    assert not mistakes(html)
    assert [e.text for e in xml(html).iter("b")] == ["L", "R"]


def test_words_are_escaped() -> None:
    picture = full_picture(HOSTILE, HOSTILE, HOSTILE)
    html = content(picture.pane()) + content(Pane("x", HOSTILE, "<svg/>"))
    assert "<script" not in html
    texts = " ".join(xml(html).itertext())
    assert texts.count(HOSTILE) == 7
    assert str(handle_of(picture).get("aria-label")).startswith(HOSTILE)


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


# ---- linked points, and what lies outside


def test_named_points_carry_their_link_and_stand_where_they_are() -> None:
    picture = Picture("p", "P")
    picture.point("roof", (12.5, 30.0), "Roof", chosen=True, label="roof")
    picture.point("gate", (1.0, 2.0), "Gate")
    roof, gate = (e for e in xml(picture.pane().svg).iter() if e.get("data-link"))
    assert (roof.get("data-link"), roof.get("transform")) == ("roof", "translate(12.50 30.00)")
    assert "s3-selected" in str(roof.get("class"))
    assert "s3-selected" not in str(gate.get("class"))
    assert [e.text for e in roof.iter("title")] == ["Roof"]


def test_many_strokes_are_one_path() -> None:
    picture = Picture("p", "P")
    picture.strokes([(0.0, 1.0, 2.0, 3.0), (4.0, 5.0, 6.0, 7.0)], "ink")
    picture.strokes([], "x")
    drawn = [e.get("d") for e in xml(picture.pane().svg).iter("path") if e.get("stroke")]
    assert drawn == ["M0.00 1.00L2.00 3.00M4.00 5.00L6.00 7.00"]


def test_the_frame_takes_in_half_a_pixel_round_the_outermost_centres() -> None:
    picture = Picture("p", "P")
    assert picture.shows((-0.5, 479.5))
    assert not picture.shows((-0.51, 100.0))
    assert not picture.shows((100.0, 479.51))


@given(st.floats(-1e4, 1e4), st.floats(-1e4, 1e4), st.sampled_from([1.0, -1.0, 1e-3, 250.0, 0.0]))
def test_what_is_outside_is_marked_on_the_way_to_it(x: float, y: float, w: float) -> None:
    middle = np.array([319.5, 239.5])
    direction = np.array([x, y]) - middle * w if w else np.array([x, y])
    direction = direction if w >= 0 else -direction
    assume(not direction.any() or np.hypot(*direction) > 1e-9)
    found = border((x, y, w), 640, 480)
    if not direction.any():
        assert found is None
        return
    assert found is not None
    place, unit = np.array(found[0]), np.array(found[1])
    np.testing.assert_allclose(unit, direction / np.linalg.norm(direction), rtol=0, atol=1e-9)
    offset = np.abs(place - middle)
    assert np.isclose(offset[0], 320 - INSET) or np.isclose(offset[1], 240 - INSET)
    assert (offset <= (320 - INSET + 1e-9, 240 - INSET + 1e-9)).all()
    np.testing.assert_allclose(place - middle, np.linalg.norm(place - middle) * unit, rtol=0, atol=1e-9)


def test_a_mark_at_infinity_says_so_and_has_two_heads() -> None:
    far, near = Picture("p", "P"), Picture("p", "P")
    far.outside((0.0, -1.0, 0.0), "z", "up", link="up")
    near.outside((320.0, -900.0, 1.0), "z", "up", link="up")
    for picture, infinite in ((far, True), (near, False)):
        mark = next(e for e in xml(picture.pane().svg).iter() if e.get("data-link") == "up")
        words = "".join(mark.itertext())
        assert ("∞" in words) == infinite
        heads = [str(e.get("d")).count("z") for e in mark.iter("path")]
        assert heads == [2 if infinite else 1]
    empty = Picture("p", "P")
    empty.outside((319.5, 239.5, 1.0), "x", "nowhere")
    assert "nowhere" not in empty.pane().svg


# ---- pictures in which a place can be chosen


def test_a_picture_can_be_picked_in_by_pointer_and_key() -> None:
    picture = full_picture()
    assert "data-pick" not in picture.pane().svg
    picture.pickable("pick_left", 'Left "picture"')
    svg = picture.pane().svg
    assert not mistakes(svg)
    (ground,) = (e for e in xml(svg).iter() if e.get("data-pick"))
    assert ground.get("data-pick") == "pick_left"
    assert ground.get("tabindex") == "0"
    assert ground.get("role") == "button"
    assert str(ground.get("aria-label")).startswith('Left "picture":')
    assert not list(ground), "what can be pressed holds nothing else that can be"
    assert svg.index("data-pick") < svg.index("data-handle"), "handles stand above it"


def test_a_handle_says_its_place_in_other_words_than_pixels() -> None:
    picture = Picture("plan", "From above")
    picture.handle("h", (10, 20), "Camera", "L", where="X 1.00, Y 2.00 metres")
    assert str(handle_of(picture).get("aria-label")).startswith("Camera: X 1.00, Y 2.00 metres. Arrow")


def test_fine_words_are_marked_as_such() -> None:
    picture = Picture("p", "P")
    picture.text((1, 2), "coarse")
    picture.text((1, 2), "fine", fine=True)
    kinds = {e.text: str(e.get("class")).split() for e in xml(picture.pane().svg).iter() if e.text}
    assert "s3-fine" in kinds["fine"]
    assert "s3-fine" not in kinds["coarse"]


def test_a_copy_begins_with_the_same_and_goes_its_own_way() -> None:
    first = full_picture()
    first.pickable("pick", "Picture")
    second = first.copy()
    assert second.pane() == first.pane()
    second.dot((1, 1), "x")
    second.text((1, 1), "more")
    assert first.pane() == full_and_pickable().pane()
    assert second.pane() != first.pane()


def full_and_pickable() -> Picture:
    picture = full_picture()
    picture.pickable("pick", "Picture")
    return picture


def test_a_curve_runs_through_its_points() -> None:
    picture = Picture("p", "P")
    picture.curve([(1, 2), (3, 4), (5, 6.25)], "ghost")
    assert 'd="M1.0 2.0L3.0 4.0L5.0 6.2"' in picture.pane().svg


def test_a_picture_takes_the_whole_width_where_told() -> None:
    assert not Picture("p", "P").pane().wide
    assert Picture("p", "P").pane("note", wide=True).wide


def test_a_large_picture_says_so_and_has_its_line_over_it() -> None:
    line = Chain("Steps", [Link("", "first", "1"), Link("× 2", "second", "2", "factor")]).html()
    large = Picture("p", "P").pane("note", large=True, line=line)
    assert "s3-large" in figure(large)
    assert "s3-large" not in figure(Picture("p", "P").pane())
    assert content(large).endswith(line + large.svg)
    assert still(large).startswith(line)


def test_areas_have_their_colour_and_cover_those_before_them() -> None:
    picture = Picture("p", "P")
    picture.areas(
        [("red", [[(0, 0), (1, 0), (1, 1)], [(2, 2), (3, 2), (3.25, 3)]]), ("blue", [[(0, 0), (5, 0), (5, 5)]])]
    )
    picture.areas([("grey", [[(0, 0), (1, 0), (1, 1)]])], edges=False)
    picture.areas([])
    groups = [e for e in xml(picture.pane().svg).iter("g") if list(e.iter("path"))]
    drawn = [[(e.get("fill"), e.get("d")) for e in group.iter("path")] for group in groups[1:]]
    assert drawn == [
        [("red", "M0.0 0.0L1.0 0.0L1.0 1.0zM2.0 2.0L3.0 2.0L3.2 3.0z"), ("blue", "M0.0 0.0L5.0 0.0L5.0 5.0z")],
        [("grey", "M0.0 0.0L1.0 0.0L1.0 1.0z")],
    ]
    assert [group.get("class") for group in groups[1:]] == ["s3-faces", None]


# ---- links


def test_a_handle_covers_points_that_are_nearer_than_its_reach_and_no_others() -> None:
    picture = Picture("p", "P")
    picture.handle("h", (100, 100), "Handle", "H")
    picture.point("far", (146, 100), "Far")
    picture.point("near", (130, 100), "Near")
    order = [e.get("data-link") or e.get("data-handle") for e in xml(picture.copy().pane().svg).iter("g")]
    assert [name for name in order if name] == ["near", "h", "far"]


def test_strokes_and_handles_light_up_with_what_else_is_linked() -> None:
    picture = Picture("p", "P")
    picture.line((0, 0), (1, 1), "x", link="roof")
    picture.homogeneous_line((1.0, 0.0, -5.0), "x", link="roof")
    picture.cross((5, 5), "x", link="roof")
    picture.handle("h", (5, 5), "Roof", "R", link="roof")
    picture.outside((1e4, 0.0, 1.0), "x", "roof", link="roof")
    picture.line((0, 0), (1, 1), "x")
    picture.handle("g", (5, 5), "Gate", "G")
    linked = [e.tag.split("}")[-1] for e in xml(picture.pane().svg).iter() if e.get("data-link") == "roof"]
    assert linked == ["line"] * 4 + ["g"] * 2
    assert picture.pane().svg.count("data-link") == 6


def test_a_quiet_point_is_marked_as_such_and_a_chosen_one_never_is() -> None:
    picture = Picture("p", "P")
    picture.point("a", (1, 2), "A", quiet=True)
    picture.point("b", (1, 2), "B", chosen=True, quiet=True)
    kinds = {e.get("data-link"): str(e.get("class")).split() for e in xml(picture.pane().svg).iter("g")}
    assert "s3-quiet" in kinds["a"]
    assert "s3-quiet" not in kinds["b"]


@given(st.floats(-700, 700, allow_subnormal=False), st.floats(-700, 700))
def test_a_place_is_inside_a_picture_or_outside_and_nan_is_not_inside(x: float, y: float) -> None:
    assert inside(x, y, 640, 480) == (abs(x - 319.5) <= 320.0 and abs(y - 239.5) <= 240.0)
    assert not inside(np.nan, y, 640, 480)
    assert not inside(x, np.nan, 640, 480)
