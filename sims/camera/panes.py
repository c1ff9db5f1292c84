"""The picture that the camera takes, in pixels."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from sims.camera.params import CameraParams
from sims.camera.solution import CameraSolution, NamedPoint, VanishingPoint
from sims.camera.world import ROLES, TITLES
from sims.kit.frame import HEIGHT, WIDTH
from sims.kit.pane import Pane, Picture
from sims.kit.readout import THIN, figure

WIDTHS = {"ink": 1.6, "x": 1.6, "y": 2.0, "z": 2.4}
ROLE: Any = np.array([list(WIDTHS).index(role) for role in ROLES])
ARROW = 70.0
TOWARDS = {"across": ("eave-near-left", "wall-near-left"), "along": ("roof-far", "wall-far-right"),
           "up": ("eave-near-left", "eave-far-right")}  # fmt: skip
"""Ends of edges that are drawn on to where they meet."""


def panes(p: CameraParams, s: CameraSolution) -> Sequence[Pane]:
    """One picture."""
    picture = Picture("picture", "Picture", WIDTH, HEIGHT)
    roles = ROLE[s.shown]
    for k, (role, width) in enumerate(WIDTHS.items()):
        picture.strokes(map(tuple, s.wires[roles == k].reshape(-1, 4).tolist()), role, width=width)
    _pixel_axes(picture)
    if p.show_vanishing:
        for meet in s.vanishing:
            _vanishing(picture, s, meet)
    for point in s.points:
        _point(picture, point, chosen=point.name == p.selected)
    if s.frustum is not None:
        picture.handle("principal", (p.cx, p.cy), "Principal point", "c")
    return (picture.pane(_note(p, s)),)


def _pixel_axes(picture: Picture) -> None:
    for tip, at, letter in (((ARROW, 6.0), (ARROW + 10.0, 20.0), "u"), ((6.0, ARROW), (6.0, ARROW + 28.0), "v")):
        picture.arrow((6.0, 6.0), tip, "ink", width=2)
        picture.text(at, letter)


def _vanishing(picture: Picture, s: CameraSolution, meet: VanishingPoint) -> None:
    """A cross where parallels meet, with two edges drawn on to it, or a mark at the border."""
    if meet.pixel is not None and meet.in_image:
        u, v = meet.pixel
        ends = [s.point(name).pixel for name in TOWARDS[meet.name]]
        picture.strokes([(*end, u, v) for end in ends if end], meet.role, width=1, dash="3 5")
        picture.cross(meet.pixel, meet.role)
        picture.text((u, v - 18.0), meet.name, meet.role, anchor="middle", size=24)
    elif meet.homogeneous is not None:
        picture.outside(meet.homogeneous, meet.role, meet.name, title=f"Vanishing point of what runs {meet.name}")


def _point(picture: Picture, point: NamedPoint, *, chosen: bool) -> None:
    name, pixel = point.name, point.pixel
    if pixel is None:
        return
    title = TITLES[name]
    if point.in_image:
        picture.point(name, pixel, title, chosen=chosen, label=title.lower() if chosen else "")
    else:
        words = title.lower() if chosen else ""
        picture.outside((*pixel, 1.0), "held" if chosen else "ghost", words, link=name, title=title, chosen=chosen)


def _note(p: CameraParams, s: CameraSolution) -> str:
    """Words on the chosen point; short, so that the picture below keeps its place."""
    point = s.point(p.selected)
    if s.frustum is None:
        return "⚠ no scale, no picture"
    if point.pixel is None:
        return f"⚠ {TITLES[p.selected].lower()} is behind"
    u, v = point.pixel
    where = "" if point.in_image else ", outside"
    return f"({figure(u, 1)}, {figure(v, 1)}){THIN}px{where}"
