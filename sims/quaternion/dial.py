"""The picture of the half angle: the object's angle θ on one dial, and θ/2, which is what q holds, on the other.

One round of the second dial is two of the first: after one whole turn of the object q is on the opposite side, −q.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from sims.kit.pane import Pane, Picture
from sims.kit.readout import figure, quantity
from sims.quaternion.params import TWICE, WHOLE, QuaternionParams

WIDTH, HEIGHT = 480, 276
RADIUS = 78.0
"""Pixels of each dial."""
Pixel = tuple[float, float]
TURN: Pixel = 118.0, 116.0
HALF: Pixel = 356.0, 116.0
"""Middles of the dials of θ and of θ/2."""
SPIRAL = 22.0, 11.0
"""Radius in pixels at which the angle's arc begins, and by how much it grows with each round."""


def dial(p: QuaternionParams) -> Pane:
    """Both dials, with a hand on each that can be held."""
    picture = FACES.copy()
    half = math.radians(0.5 * p.angle)
    whole, tip, other = at(TURN, 2.0 * half), at(HALF, half), at(HALF, half + math.pi)
    if p.angle > 0.0:
        picture.curve(_spiral(TURN, 2.0 * half), "held", width=3)
        picture.curve(_spiral(HALF, half), "held", width=3)
    picture.line(TURN, whole, "held", width=3)
    picture.line(HALF, other, "ghost", width=1.5, dash="5 4")
    picture.line(HALF, tip, "held", width=3)
    _sides(picture, tip)
    picture.dot(other, "held", 7, hollow=True)
    _beside(picture, HALF, other, "−q")
    picture.handle("theta", whole, "θ on its dial", "", where=quantity(p.angle, "°", 1), link="angle")
    picture.handle("half", tip, "q at θ/2 on its dial", "", where=quantity(0.5 * p.angle, "°", 1), link="angle")
    _beside(picture, TURN, whole, "θ")
    _beside(picture, HALF, tip, "q")
    return picture.pane(f"{quantity(p.angle, '°', 0)} turned, {quantity(0.5 * p.angle, '°', 1)} in q")


def at(middle: Pixel, radians: float, radius: float = RADIUS) -> Pixel:
    """Where an angle is on a dial: counter-clockwise from the right."""
    return middle[0] + radius * math.cos(radians), middle[1] - radius * math.sin(radians)


def _spiral(middle: Pixel, radians: float) -> list[Pixel]:
    first, more = SPIRAL
    angles = np.linspace(0.0, radians, max(2, int(16 * radians)))
    return [at(middle, a, first + more * a / (2.0 * math.pi)) for a in angles.tolist()]


def _sides(picture: Picture, tip: Pixel) -> None:
    """The cosine and the sine of θ/2, as sides of a triangle."""
    x, y = tip
    w, s = (x - HALF[0]) / RADIUS, (HALF[1] - y) / RADIUS
    picture.line(HALF, (x, HALF[1]), "ink", width=4)
    picture.line((x, HALF[1]), tip, "ink", width=2.5, dash="7 4")
    picture.text((HALF[0], HEIGHT - 28), f"cos θ/2 = {figure(w, 2)} = w", "ink", anchor="middle", size=18)
    picture.text((HALF[0], HEIGHT - 6), f"sin θ/2 = {figure(s, 2)}", "ink", anchor="middle", size=18)


def _beside(picture: Picture, middle: Pixel, place: Pixel, words: str) -> None:
    """Words beyond a place on a dial, as seen from its middle."""
    x, y = (m + (1.0 + 23.0 / RADIUS) * (v - m) for v, m in zip(place, middle, strict=True))
    picture.text((x, y + 7), words, "held", anchor="middle", size=22)


def _faces() -> Picture:
    """What is the same in every state."""
    picture = Picture("dial", "Half the angle", WIDTH, HEIGHT)
    for middle in (TURN, HALF):
        picture.dot(middle, "ghost", RADIUS, hollow=True)
        for k in range(12):
            inner = RADIUS - (14.0 if k % 3 == 0 else 7.0)
            picture.line(at(middle, k * math.pi / 6, inner), at(middle, k * math.pi / 6), "ghost", width=1)
        picture.line(middle, at(middle, 0.0), "ghost", width=1.5)
    picture.text((TURN[0], HEIGHT - 28), "θ: the object", "ink", anchor="middle", size=18)
    return picture


FACES = _faces()


def hold_theta(p: QuaternionParams, pixel: tuple[float, float]) -> dict[str, Any]:
    """The angle that a hand on the first dial leads to, from the present one the shorter way round."""
    return _turned(p, TURN, pixel, WHOLE)


def hold_half(p: QuaternionParams, pixel: tuple[float, float]) -> dict[str, Any]:
    """The same on the second dial, whose round is two of the object's."""
    return _turned(p, HALF, pixel, TWICE)


def _turned(p: QuaternionParams, middle: Pixel, pixel: tuple[float, float], round_: float) -> dict[str, Any]:
    x, y = pixel[0] - middle[0], middle[1] - pixel[1]
    return {} if math.hypot(x, y) < 1.0 else turned_to(p, x, y, round_)


def turned_to(p: QuaternionParams, x: float, y: float, round_: float = WHOLE) -> dict[str, Any]:
    """The angle of a direction (x, y), from the present one the shorter way; so many degrees are once round."""
    ahead = math.remainder(math.atan2(y, x) / (2.0 * math.pi) * round_ - p.angle, round_)
    return {"angle": float(round(min(max(p.angle + ahead, 0.0), TWICE)))}
