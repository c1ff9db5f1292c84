"""The left and the right picture: points, epipolar lines, epipoles, and the pixel that is picked."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from geometry.arrays import Array
from sims.epipolar import numbers
from sims.epipolar.candidate import Candidate
from sims.epipolar.eye import eyes
from sims.epipolar.params import WORLD, EpipolarParams, Pixel, Side, title
from sims.epipolar.plan import plan
from sims.epipolar.ray import Trail
from sims.epipolar.solution import EpipolarSolution
from sims.kit.pane import Pane, Picture
from sims.kit.readout import figure
from sims.kit.scale import Scale
from sims.kit.stereo import Eye, camera
from sims.kit.world_drawing import draw_in_picture

FIRST = "1"
"""What the 3D point is linked as; the others are by their numbers too."""


def panes(p: EpipolarParams, s: EpipolarSolution) -> Sequence[Pane]:
    """Both pictures, and the plan."""
    pictures = _picture(p, s, "left"), _picture(p, s, "right")
    return (*pictures, plan(p, s)) if p.show_top else pictures


def _picture(p: EpipolarParams, s: EpipolarSolution, side: Side) -> Pane:
    left = side == "left"
    mark = "" if left else "′"
    eye = eyes(p)[not left]
    scale = Scale.of(*eye.size)
    line, lines = (s.line_left, s.lines_left) if left else (s.line_right, s.lines_right)
    pixel, pixels = (s.pixel_left, s.pixels_left) if left else (s.pixel_right, s.pixels_right)
    epipole, at = (s.epipole_left, s.epipole_left_pixel) if left else (s.epipole_right, s.epipole_right_pixel)
    still = scale.lines(lines[1:]).tobytes() if p.show_all_lines and lines is not None else b""
    others = _others(side, eye, scale.pixels(pixels[1:]).tobytes(), still, p.selected)
    picture = others.picture.copy()
    _lines(picture, p, s, side, scale)
    if p.noise > 0.0:
        _measured(picture, scale.pixels(s.estimate.measured_left if left else s.estimate.measured_right))
    if s.own is not None and p.typed:
        _own(picture, scale, p.own_left if left else p.own_right, side)
    if s.trail is not None and not left:
        _trail(picture, s.trail, scale)
    if epipole is not None:
        _epipole(picture, scale.homogeneous(epipole), None if at is None else scale.at(at), f"e{mark}")
    tried = None if left else s.candidate
    drawn = None if line is None else scale.lines(line)
    if pixel is not None:
        corner = _corner(scale.at(pixel), drawn, others)
        _held(picture, pixel, scale, side, f"p{mark}", corner, fixed=tried is not None)
    if tried is not None:
        _candidate(picture, tried, scale, _corner(scale.at(tried.pixel), drawn, others))
    if s.picked is not None and s.picked.side == side:
        picture.handle(f"pick_{side}", scale.at(s.picked.pixel), "Picked pixel", "", where=_where(s.picked.pixel))
    return picture.pane(_note(s, pixel, at, mark) if tried is None else _place("q′", tried.pixel))


def _where(pixel: Pixel) -> str:
    return f"{pixel[0]:.1f}, {pixel[1]:.1f} pixels"


def _own(picture: Picture, scale: Scale, pixel: Pixel, side: Side) -> None:
    """A pixel of the match that was typed."""
    at = scale.at(pixel)
    if picture.shows(at):
        picture.cross(at, side)
        picture.text((at[0] + 12.0, at[1] + 30.0), "yours", side, fine=True)
    else:
        picture.outside((*at, 1.0), side, "yours", title=f"Your {side} pixel")


def _trail(picture: Picture, trail: Trail, scale: Scale) -> None:
    """Where p′ has been, with a dot for each metre of depth."""
    if trail.pixels is not None:
        a, b = map(scale.at, trail.pixels)
        picture.line(a, b, "held", width=6, css=' stroke-opacity="0.35"')
    for u, v in scale.pixels(trail.step_pixels).tolist():
        if picture.shows((u, v)):
            picture.dot((u, v), "held", 4)


def _corner(at: Pixel, line: Array | None, others: Others) -> numbers.Way:
    size = others.picture.width, others.picture.height
    return numbers.way(at, others.spots, others.boxes, () if line is None else (line.tolist(),), size)


def _candidate(picture: Picture, c: Candidate, scale: Scale, corner: numbers.Way) -> None:
    """The free pixel, and how far it is from the line."""
    at = scale.at(c.pixel)
    if c.foot is not None and c.verdict == "off the line":
        picture.line(at, scale.at(c.foot), "held", width=2, dash="3 3")
    words, where = "Free pixel q′ in the right picture", _where(c.pixel)
    picture.handle("candidate", at, words, "q′", where=where, corner=corner)


def _place(letter: str, pixel: Pixel) -> str:
    return f"{letter} {figure(pixel[0], 0)}, {figure(pixel[1], 0)}"


def _note(s: EpipolarSolution, pixel: Pixel | None, epipole: Pixel | None, mark: str) -> str:
    """Short: small panes have room for a few words."""
    point = f"no p{mark}" if pixel is None else _place(f"p{mark}", pixel)
    if s.F is None:
        return f"{point}; no e{mark}"
    return f"{point}; e{mark} ∞" if epipole is None else point


@lru_cache(maxsize=64)
def _world(side: Side, eye: Eye) -> Picture:
    """What a camera sees, with its coordinates: columns run to the right and rows down, from the top left."""
    scale = Scale.of(*eye.size)
    picture = Picture(side, f"{side.capitalize()} picture", scale.width, scale.height)
    draw_in_picture(picture, scale.camera(camera(eye)), WORLD)
    picture.pickable(f"pick_{side}", f"{side.capitalize()} picture")
    u, v = eye.last
    picture.text((8, 26), "0, 0", "ghost", size=22, fine=True)
    picture.text((scale.width - 10, 26), f"u {u:.0f}", "ghost", anchor="end", size=22, fine=True)
    picture.text((8, scale.height - 12), f"v {v:.0f}", "ghost", size=22, fine=True)
    return picture


def _lines(picture: Picture, p: EpipolarParams, s: EpipolarSolution, side: Side, scale: Scale) -> None:
    left = side == "left"
    other = "right" if left else "left"
    line, lines = (s.line_left, s.lines_left) if left else (s.line_right, s.lines_right)

    def draw(each: Array | None, role: str, width: float, dash: str = "", link: str = "") -> None:
        if each is not None:
            picture.homogeneous_line(scale.lines(each).tolist(), role, width=width, dash=dash, link=link)

    if p.show_all_lines and lines is not None:
        for k, each in enumerate(lines[1:], start=2):
            draw(each, other, 1, link=f"{k}")
    draw(line, other, 2.5, "7 5", FIRST)
    if p.noise > 0.0:
        draw(s.estimate.line_left if left else s.estimate.line_right, "ink", 1.5, "2 4")
    if s.picked is not None and s.picked.side != side:
        draw(s.picked.line, "held", 3.5)
    if s.own is not None and p.typed and not left:
        draw(s.own.line_right, "left", 2, "2 6")


class Others(NamedTuple):
    """A picture with the points that stay, and what a letter mustn't cover there: they, and their numbers."""

    picture: Picture
    spots: Sequence[Pixel]
    boxes: Sequence[numbers.Box]


@lru_cache(maxsize=64)
def _others(side: Side, eye: Eye, pixels: bytes, lines: bytes, selected: int) -> Others:
    """A picture with the points that stay where they are while the 3D point is moved; `lines` are those shown.

    Pixels and lines are as they are drawn.
    """
    picture = _world(side, eye).copy()
    seen = list(enumerate(np.frombuffer(pixels).reshape(-1, 2).tolist(), start=2))
    inside = [(f"{k}", (u, v)) for k, (u, v) in seen if picture.shows((u, v))]
    size = picture.width, picture.height
    boxes = numbers.placed(inside, np.frombuffer(lines).reshape(-1, 3).tolist(), size)
    for (text, _), box in zip(inside, boxes, strict=True):
        if text != f"{selected}":
            at = box.u, box.v + 0.5 * numbers.HIGH
            picture.text(at, text, side, anchor="middle", size=numbers.SIZE, fine=True)
    for k, (u, v) in seen:
        chosen = k == selected
        if picture.shows((u, v)):
            picture.point(f"{k}", (u, v), title(k), side, chosen=chosen, label=f"{k}" if chosen else "")
        elif u == u:
            role, words = ("held", f"{k}") if chosen else ("ghost", "")
            picture.outside((u, v, 1.0), role, words, link=f"{k}", title=title(k), chosen=chosen)
    return Others(picture, [at for _, at in inside], boxes)


def _measured(picture: Picture, pixels: Array) -> None:
    """Pixels with their noise."""
    for u, v in pixels.tolist():
        if picture.shows((u, v)):
            picture.cross((u, v), "ink", 7)


def _held(
    picture: Picture, pixel: Pixel, scale: Scale, side: Side, letter: str, corner: numbers.Way, *, fixed: bool
) -> None:
    """The point that can be moved in its picture unless it is fixed, or in which direction it is outside."""
    at = scale.at(pixel)
    if picture.shows(at) and fixed:
        picture.point(FIRST, at, title(1), side, label=letter)
    elif picture.shows(at):
        words, where = f"3D point in the {side} picture", _where(pixel)
        picture.handle(f"{side}_pixel", at, words, letter, where=where, link=FIRST, corner=corner)
    else:
        picture.outside((*at, 1.0), "held", letter, link=FIRST, title=title(1))


def _epipole(picture: Picture, epipole: Array, at: Pixel | None, letter: str) -> None:
    words = f"Epipole {letter}"
    if at is None:  # parallel lines meet at both their ends
        u, v, _ = epipole.tolist()
        picture.outside((u, v, 0.0), "ink", letter, title=words)
        picture.outside((-u, -v, 0.0), "ink", "", title=words)
    elif picture.shows(at):
        picture.dot(at, "ink", 9, hollow=True)
        picture.dot(at, "ink", 3)
        picture.text((at[0] + 16, at[1] + 30), letter)
    else:
        picture.outside((*at, 1.0), "ink", letter, title=words)
