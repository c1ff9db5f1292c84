"""The left and the right picture: points, epipolar lines, epipoles, and the pixel that is picked."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from geometry.arrays import Array
from sims.epipolar import numbers
from sims.epipolar.candidate import Candidate
from sims.epipolar.drawing import in_picture
from sims.epipolar.params import LAST, WORLD, EpipolarParams, Pixel, Place, Side, title
from sims.epipolar.plan import plan
from sims.epipolar.ray import Trail
from sims.epipolar.rig import camera
from sims.epipolar.solution import EpipolarSolution
from sims.kit.frame import HEIGHT, WIDTH
from sims.kit.pane import Pane, Picture
from sims.kit.readout import figure
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
    line, lines = (s.line_left, s.lines_left) if left else (s.line_right, s.lines_right)
    pixel, pixels = (s.pixel_left, s.pixels_left) if left else (s.pixel_right, s.pixels_right)
    epipole, at = (s.epipole_left, s.epipole_left_pixel) if left else (s.epipole_right, s.epipole_right_pixel)
    still = lines[1:].tobytes() if p.show_all_lines and lines is not None else b""
    rig = (p.left, p.left_pan, p.focal) if left else (p.right, p.right_pan, p.focal)
    others = _others(side, rig, pixels[1:].tobytes(), still, p.selected)
    picture = others.picture.copy()
    _lines(picture, p, s, side, line, lines)
    if p.noise > 0.0:
        _measured(picture, s.estimate.measured_left if left else s.estimate.measured_right)
    if s.trail is not None and not left:
        _trail(picture, s.trail)
    if epipole is not None:
        _epipole(picture, epipole, at, f"e{mark}")
    tried = None if left else s.candidate
    if pixel is not None:
        _held(picture, pixel, side, f"p{mark}", _corner(pixel, line, others), fixed=tried is not None)
    if tried is not None:
        _candidate(picture, tried, _corner(tried.pixel, line, others))
    if s.picked is not None and s.picked.side == side:
        picture.handle(f"pick_{side}", s.picked.pixel, "Picked pixel", "")
    return picture.pane(_note(s, pixel, at, mark) if tried is None else _place("q′", tried.pixel))


def _trail(picture: Picture, trail: Trail) -> None:
    """Where p′ has been, with a dot for each metre of depth."""
    if trail.pixels is not None:
        picture.line(*trail.pixels, "held", width=6, css=' stroke-opacity="0.35"')
    for u, v in trail.step_pixels.tolist():
        if in_picture(u, v):
            picture.dot((u, v), "held", 4)


def _corner(pixel: Pixel, line: Array | None, others: Others) -> numbers.Way:
    return numbers.way(pixel, others.spots, others.boxes, () if line is None else (line.tolist(),))


def _candidate(picture: Picture, c: Candidate, corner: numbers.Way) -> None:
    """The free pixel, and how far it is from the line."""
    if c.foot is not None and c.verdict == "off the line":
        picture.line(c.pixel, c.foot, "held", width=2, dash="3 3")
    picture.handle("candidate", c.pixel, "Free pixel q′ in the right picture", "q′", corner=corner)


def _place(letter: str, pixel: Pixel) -> str:
    return f"{letter} {figure(pixel[0], 0)}, {figure(pixel[1], 0)}"


def _note(s: EpipolarSolution, pixel: Pixel | None, epipole: Pixel | None, mark: str) -> str:
    """Short: small panes have room for a few words."""
    point = f"no p{mark}" if pixel is None else _place(f"p{mark}", pixel)
    if s.F is None:
        return f"{point}; no e{mark}"
    return f"{point}; e{mark} ∞" if epipole is None else point


Rig = tuple[Place, float, float]
"""Centre, pan and focal length of a camera."""


@lru_cache(maxsize=64)
def _world(side: Side, rig: Rig) -> Picture:
    """What a camera sees, with its coordinates: columns run to the right and rows down, from the top left."""
    picture = Picture(side, f"{side.capitalize()} picture", WIDTH, HEIGHT)
    draw_in_picture(picture, camera(*rig), WORLD)
    picture.pickable(f"pick_{side}", f"{side.capitalize()} picture")
    picture.text((8, 26), "0, 0", "ghost", size=22, fine=True)
    picture.text((WIDTH - 10, 26), f"u {LAST[0]:.0f}", "ghost", anchor="end", size=22, fine=True)
    picture.text((8, HEIGHT - 12), f"v {LAST[1]:.0f}", "ghost", size=22, fine=True)
    return picture


def _lines(
    picture: Picture, p: EpipolarParams, s: EpipolarSolution, side: Side, line: Array | None, lines: Array | None
) -> None:
    other = "right" if side == "left" else "left"
    if p.show_all_lines and lines is not None:
        for k, each in enumerate(lines[1:].tolist(), start=2):
            picture.homogeneous_line(each, other, width=1, link=f"{k}")
    if line is not None:
        picture.homogeneous_line(line.tolist(), other, width=2.5, dash="7 5", link=FIRST)
    estimated = s.estimate.line_left if side == "left" else s.estimate.line_right
    if p.noise > 0.0 and estimated is not None:
        picture.homogeneous_line(estimated.tolist(), "ink", width=1.5, dash="2 4")
    if s.picked is not None and s.picked.side != side and s.picked.line is not None:
        picture.homogeneous_line(s.picked.line.tolist(), "held", width=3.5)


class Others(NamedTuple):
    """A picture with the points that stay, and what a letter mustn't cover there: they, and their numbers."""

    picture: Picture
    spots: Sequence[Pixel]
    boxes: Sequence[numbers.Box]


@lru_cache(maxsize=64)
def _others(side: Side, rig: Rig, pixels: bytes, lines: bytes, selected: int) -> Others:
    """A picture with the points that stay where they are while the 3D point is moved; `lines` are those shown."""
    picture = _world(side, rig).copy()
    seen = list(enumerate(np.frombuffer(pixels).reshape(-1, 2).tolist(), start=2))
    inside = [(f"{k}", (u, v)) for k, (u, v) in seen if in_picture(u, v)]
    boxes = numbers.placed(inside, np.frombuffer(lines).reshape(-1, 3).tolist())
    for (text, _), box in zip(inside, boxes, strict=True):
        if text != f"{selected}":
            at = box.u, box.v + 0.5 * numbers.HIGH
            picture.text(at, text, side, anchor="middle", size=numbers.SIZE, fine=True)
    for k, (u, v) in seen:
        chosen = k == selected
        if in_picture(u, v):
            picture.point(f"{k}", (u, v), title(k), side, chosen=chosen, label=f"{k}" if chosen else "")
        elif u == u:
            role, words = ("held", f"{k}") if chosen else ("ghost", "")
            picture.outside((u, v, 1.0), role, words, link=f"{k}", title=title(k), chosen=chosen)
    return Others(picture, [at for _, at in inside], boxes)


def _measured(picture: Picture, pixels: Array) -> None:
    """Pixels with their noise."""
    for u, v in pixels.tolist():
        if in_picture(u, v):
            picture.cross((u, v), "ink", 7)


def _held(picture: Picture, pixel: Pixel, side: Side, letter: str, corner: numbers.Way, *, fixed: bool) -> None:
    """The point that can be moved in its picture unless it is fixed, or in which direction it is outside."""
    if in_picture(*pixel) and fixed:
        picture.point(FIRST, pixel, title(1), side, label=letter)
    elif in_picture(*pixel):
        picture.handle(f"{side}_pixel", pixel, f"3D point in the {side} picture", letter, link=FIRST, corner=corner)
    else:
        picture.outside((*pixel, 1.0), "held", letter, link=FIRST, title=title(1))


def _epipole(picture: Picture, epipole: Array, at: Pixel | None, letter: str) -> None:
    words = f"Epipole {letter}"
    if at is None:  # parallel lines meet at both their ends
        u, v, _ = epipole.tolist()
        picture.outside((u, v, 0.0), "ink", letter, title=words)
        picture.outside((-u, -v, 0.0), "ink", "", title=words)
    elif in_picture(*at):
        picture.dot(at, "ink", 9, hollow=True)
        picture.dot(at, "ink", 3)
        picture.text((at[0] + 16, at[1] + 30), letter)
    else:
        picture.outside((*at, 1.0), "ink", letter, title=words)
