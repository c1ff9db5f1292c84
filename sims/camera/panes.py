"""The picture that the camera takes, with the chosen point's way into it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sims.camera.lens import shown, size
from sims.camera.params import CameraParams
from sims.camera.solution import CameraSolution, NamedPoint, VanishingPoint
from sims.kit.pane import Pane, Picture
from sims.kit.readout import Chain, Link, figure
from sims.kit.world import TITLES
from sims.kit.world_drawing import draw_sight

ARROW = 70.0
TOWARDS = {"across": ("eave-near-left", "wall-near-left"), "along": ("roof-far", "wall-far-right"),
           "up": ("eave-near-left", "eave-far-right")}  # fmt: skip
"""Ends of edges that are drawn on to where they meet."""
TWIN = "5 4"
"""Dashes of what would be seen without distortion."""


def panes(p: CameraParams, s: CameraSolution) -> Sequence[Pane]:
    """One picture."""
    picture = Picture("picture", "Picture", *size(p))
    if s.seen is not None:
        draw_sight(picture, s.seen)
    if s.straight is not None:
        edges = s.straight.outlines().reshape(-1, 4).tolist()
        picture.strokes([(a, b, c, d) for a, b, c, d in edges], "ghost", width=1.2, dash=TWIN)
    _pixel_axes(picture)
    if p.show_vanishing:
        for meet in s.vanishing:
            _vanishing(picture, p, s, meet)
    for point in s.points:
        _point(picture, p, point, chosen=point.name == p.selected)
    if s.frustum is not None:
        where = f"{p.cx:.1f}, {p.cy:.1f} pixels"
        picture.handle("principal", shown(p, (p.cx, p.cy)), "Principal point", "c", where=where)
    return (picture.pane(_note(p, s), large=True, line=Chain(TITLES[p.selected], list(_chain(p, s))).html()),)


def _pixel_axes(picture: Picture) -> None:
    for tip, at, letter in (((ARROW, 6.0), (ARROW + 10.0, 20.0), "u"), ((6.0, ARROW), (6.0, ARROW + 28.0), "v")):
        picture.arrow((6.0, 6.0), tip, "ink", width=2)
        picture.text(at, letter)


def _vanishing(picture: Picture, p: CameraParams, s: CameraSolution, meet: VanishingPoint) -> None:
    """A cross where parallels meet, with two edges drawn on to it, or a mark at the border."""
    if meet.pixel is not None and meet.in_image:
        u, v = shown(p, meet.pixel)
        if not s.distorted:  # else the edges aren't straight
            ends = [s.point(name).pixel for name in TOWARDS[meet.name]]
            picture.strokes([(*shown(p, end), u, v) for end in ends if end], meet.role, width=1, dash="3 5")
        picture.cross((u, v), meet.role)
        picture.text((u, v - 18.0), meet.name, meet.role, anchor="middle", size=20)
    elif meet.homogeneous is not None:
        x, y, w = meet.homogeneous
        k = size(p)[0] / p.width
        place = (k * x + 0.5 * (k - 1.0) * w, k * y + 0.5 * (k - 1.0) * w, w)
        picture.outside(place, meet.role, meet.name, title=f"Vanishing point of what runs {meet.name}")


def _point(picture: Picture, p: CameraParams, point: NamedPoint, *, chosen: bool) -> None:
    name = point.name
    if point.pixel is None:
        return
    title, place = TITLES[name], shown(p, point.pixel)
    if point.in_image:
        picture.point(name, place, title, chosen=chosen, label=title.lower() if chosen else "")
    else:
        words = title.lower() if chosen else ""
        picture.outside((*place, 1.0), "held" if chosen else "ghost", words, link=name, title=title, chosen=chosen)


def _note(p: CameraParams, s: CameraSolution) -> str:
    """Words on the chosen point; short, so that the picture below keeps its place."""
    point = s.point(p.selected)
    if s.frustum is None:
        return "⚠ no scale, no picture"
    name = TITLES[p.selected].lower()
    if point.pixel is None:
        return f"⚠ {name} is {'behind' if point.depth <= 0.0 else 'beyond the lens'}"
    where = "" if point.in_image else " is outside"
    return f"{name}{where}{'; dashed: without distortion' if s.distorted else ''}"


def _row(values: Sequence[float], digits: int) -> str:
    return f"({', '.join([figure(value, digits) for value in values])})"


def _chain(p: CameraParams, s: CameraSolution) -> Iterator[Link]:
    """The chosen point from the world to its pixel, each step with what leads to it."""
    point = s.point(p.selected)
    x, y, z = point.camera
    yield Link("", "world, m", _row(point.world, 2))
    yield Link("R, t", "camera, m", _row(point.camera, 2), "position pan tilt roll")
    if point.pixel is None:
        yield Link("", "pixel", "⚠ behind" if z <= 0.0 else "⚠ not seen")
        return
    if p.projection == "orthographic":
        yield Link("no z", "x, y in m", _row((x, y), 2))
        yield Link("×", "pixel", _row(point.pixel, 1), "ortho_scale cx cy")
    else:
        divisor = s.scale_depth or z
        yield Link("÷ mean z" if s.scale_depth else "÷ z", "normalised", _row((x / divisor, y / divisor), 2))
        yield Link("lens" if s.distorted else "K", "pixel", _row(point.pixel, 1), "fx fy cx cy skew")
