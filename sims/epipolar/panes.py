"""The left and the right picture: points, epipolar lines, epipoles, and the pixel that is picked."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from geometry.arrays import Array
from sims.epipolar.drawing import in_picture
from sims.epipolar.params import LAST, EpipolarParams, Pixel, Side, title
from sims.epipolar.plan import plan
from sims.epipolar.readouts import epipole_in_words
from sims.epipolar.solution import EpipolarSolution
from sims.kit.frame import HEIGHT, WIDTH
from sims.kit.pane import Pane, Picture
from sims.kit.readout import figure

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
    picture = _others(side, pixels[1:].tobytes(), p.selected).copy()
    _lines(picture, p, s, side, line, lines)
    if p.noise > 0.0:
        _measured(picture, s.estimate.measured_left if left else s.estimate.measured_right)
    if epipole is not None:
        _epipole(picture, epipole, at, f"e{mark}")
    if pixel is not None:
        _held(picture, pixel, side, f"p{mark}")
    if s.picked is not None and s.picked.side == side:
        picture.handle(f"pick_{side}", s.picked.pixel, "Picked pixel", "")
    return picture.pane(_note(s, pixel, at, mark))


def _note(s: EpipolarSolution, pixel: Pixel | None, epipole: Pixel | None, mark: str) -> str:
    """Short: small panes have room for a few words."""
    point = f"no p{mark}" if pixel is None else f"p{mark} {figure(pixel[0], 0)}, {figure(pixel[1], 0)}"
    pole = "∞" if epipole is None else epipole_in_words(epipole).removeprefix("at ")
    return f"{point}; no e{mark}" if s.F is None else f"{point}; e{mark} {pole}"


@lru_cache(maxsize=2)
def _frame(side: Side) -> Picture:
    """A picture with its coordinates alone: columns run to the right and rows down, from the top left."""
    picture = Picture(side, f"{side.capitalize()} picture", WIDTH, HEIGHT)
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


@lru_cache(maxsize=64)
def _others(side: Side, pixels: bytes, selected: int) -> Picture:
    """A picture with the points that stay where they are while the 3D point is moved."""
    picture = _frame(side).copy()
    for k, (u, v) in enumerate(np.frombuffer(pixels).reshape(-1, 2).tolist(), start=2):
        chosen = k == selected
        if in_picture(u, v):
            picture.point(f"{k}", (u, v), title(k), side, chosen=chosen, label=f"{k}" if chosen else "")
            if not chosen:
                picture.text((u + 9, v - 7), f"{k}", side, size=20, fine=True)
        elif u == u:
            role, words = ("held", f"{k}") if chosen else ("ghost", "")
            picture.outside((u, v, 1.0), role, words, link=f"{k}", title=title(k), chosen=chosen)
    return picture


def _measured(picture: Picture, pixels: Array) -> None:
    """Pixels with their noise."""
    for u, v in pixels.tolist():
        if in_picture(u, v):
            picture.cross((u, v), "ink", 7)


def _held(picture: Picture, pixel: Pixel, side: Side, letter: str) -> None:
    """The point that can be moved in its picture, or in which direction it is outside."""
    if in_picture(*pixel):
        picture.handle(f"{side}_pixel", pixel, f"3D point in the {side} picture", letter, link=FIRST)
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
