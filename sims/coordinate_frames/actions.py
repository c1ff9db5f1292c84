"""What buttons and handles do to a state, and how chosen axes come about."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from geometry import frames
from sims.coordinate_frames.conventions import Drawn, triple
from sims.coordinate_frames.params import FramesParams, Turn
from sims.coordinate_frames.readouts import directions, title
from sims.kit.sim import Step

SECONDS = 0.8
"""That axes take to turn."""


def hold_point(p: FramesParams, place: tuple[float, ...]) -> dict[str, Any]:
    """(x, y, z) of a point in the world, to the millimetre, times w; a direction keeps the length of its numbers."""
    reading = np.round(frames.coordinates(place, p.axes.basis), 3) + 0.0
    if p.w > 0.0:
        return {"point": triple(reading * p.w)}
    length, pulled = math.hypot(*p.point) or 1.0, math.hypot(*reading.tolist())
    return {"point": triple(np.round(reading * (length / pulled), 3) + 0.0) if pulled else p.point}


def hold_origin(p: FramesParams, place: tuple[float, ...]) -> dict[str, Any]:
    """Where the second frame begins, to the millimetre, in the first one's coordinates."""
    return {"origin": triple(np.round(frames.coordinates(place, p.axes.basis), 3) + 0.0)}


def shift(p: FramesParams) -> Iterator[Step]:
    """The second frame goes aside along X, and comes back."""
    x, y, z = p.origin
    aside = (x - math.copysign(0.8, x), y, z)
    yield Step({"origin": aside}, 1.2, words="The second frame moves, and the point’s numbers in it change …")
    yield Step({}, 2.0, words="… but the direction’s do not: its w = 0 switches off the last column of T.")
    yield Step({"origin": p.origin}, 1.2, words="A point is a place. A direction has none: no origin moves it.")
    yield Step({}, 1.6, words="A point is a place. A direction has none: no origin moves it.")


def sweep(p: FramesParams) -> Iterator[Step]:
    """The hand: fingers along X, then over to Y, and the thumb along Z."""
    hand = p.axes.handedness
    yield Step({"show_rule": True, "rule": 0.0, "lit": "x"}, 0.0)
    yield Step({"lit": "x"}, 1.6, words=f"Point the fingers of your {hand} hand along X.")
    yield Step({"lit": "y", "rule": 1.0}, 1.2, words="Curl them towards Y.")
    yield Step({"lit": "y"}, 0.8, words="Curl them towards Y.")
    thumb = f"Your thumb points along Z: these axes are {hand}-handed."
    yield Step({"lit": "z"}, 2.0, words=thumb)
    yield Step({"lit": None}, 0.0)


def run_away(p: FramesParams) -> Iterator[Step]:
    """From w = 1 to a direction."""
    yield Step({"w": 1.0}, 0.0)
    yield Step({"w": 1.0}, 1.2, words="The point is (x/w, y/w, z/w). Now w goes to 0 …")
    yield Step({"w": 0.0}, 1.2, words="… it runs away along the arrow …")
    yield Step({}, 2.0, words="… and a direction is left: the last column of T counts 0 times.")


def turn(before: FramesParams, after: FramesParams) -> Iterator[Step]:
    """Axes that were chosen turn from where others were; one that is mirrored shrinks, and grows the other way."""
    pairs = {"turn": (before.drawn, after.drawn), "turn_to": (before.drawn_to, after.drawn_to)}
    moving = {name: (_entries(a), _entries(b)) for name, (a, b) in pairs.items() if a != b}
    if moving:
        words = f"{title(after)}: {directions(after.axes)}. Car and point stay: only the axes turn."
        yield Step({name: start for name, (start, _) in moving.items()}, 0.0, words=words)
        yield Step({name: _near(end, start) for name, (start, end) in moving.items()}, SECONDS, words=words)
        yield Step(dict.fromkeys(moving), 0.0)


def _entries(drawn: Drawn) -> Turn:
    return *drawn.wxyz, drawn.side


def _near(end: Turn, start: Turn) -> Turn:
    """The same turn, by the quaternion on the side of another's: the shorter way."""
    w, x, y, z, side = end
    if sum(a * b for a, b in zip(end[:4], start[:4], strict=True)) >= 0.0:
        return end
    return -w, -x, -y, -z, side
