"""The words in the scene: each at its place in the world, and none over another.

A browser draws a label where its own position says at once, and follows the node that it hangs on a frame later: so
these hang on nothing that moves. Where two would overlap as the arm is looked at first, the less important gives way.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from geometry.arrays import dot
from sims.kit.readout import quantity
from sims.kit.types import ORIGIN, Place
from sims.transform_chain.meshes import AXLE, END
from sims.transform_chain.params import ChainParams
from sims.transform_chain.solution import ENOUGH, ChainSolution, Swapped
from sims.transform_chain.strip import sub
from sims.transform_chain.views import VIEW, view_of

WIDTH, EDGE, HEIGHT = 0.036, 0.03, 0.092
"""Room that a letter takes, that round a word, and a line, in radii of the view, in a page of 700×600 pixels."""
LONG = 7
"""Labels at once at most that aren't a single letter."""
NAMED = 4
"""Transforms that are named at most."""
FORWARD = np.subtract(VIEW.look_at, VIEW.position) / math.dist(VIEW.look_at, VIEW.position)
RIGHT = np.cross(FORWARD, (0.0, 0.0, 1.0)) / math.hypot(FORWARD[0], FORWARD[1])
PLANE: list[list[float]] = [RIGHT.tolist(), np.cross(RIGHT, FORWARD).tolist()]
"""From places to where they are seen, to the right and upwards, from the first viewpoint."""

UNITS = np.eye(3).tolist()


class Word(NamedTuple):
    """What is said, under which name, and where."""

    name: str
    text: str
    place: Place


def transform_name(show: str, i: int) -> str:
    """The i-th transform, from 1: T₁₂, or T₀₂ where they are composed."""
    return f"T{sub(i - 1 if show == 'individual' else 0)}{sub(i)}"


def outcome(swapped: Swapped) -> str:
    """Where the swapped product leads, beside the other."""
    same_way = swapped.angle < 1e-6
    if swapped.distance < 1e-9 and same_way:
        return "the same pose"
    turned = "turned the same way" if same_way else f"turned by {quantity(swapped.angle, '°', 1)}"
    return f"{quantity(swapped.distance, 'm', 2)} away, {turned}"


def said(p: ChainParams, s: ChainSolution) -> list[Word]:
    """The words of a state, those left out that would stand over more important ones, or are too many."""
    radius = view_of(p).radius
    kept: list[Word] = []
    boxes: list[tuple[float, float, float]] = []
    long = 0
    high = HEIGHT * radius
    for word in _wanted(p, s):
        wide = 0.5 * (EDGE + WIDTH * len(word.text)) * radius
        x, y = (dot(axis, word.place) for axis in PLANE)
        more = long + (len(word.text) > 1)
        if more > LONG or any(abs(x - u) < wide + w and abs(y - v) < high for u, v, w in boxes):
            continue
        long = more
        kept.append(word)
        boxes.append((x, y, wide))
    return kept


def _wanted(p: ChainParams, s: ChainSolution) -> Iterator[Word]:
    """All that there is to say, the most important first."""
    yield from _events(p, s)
    for axis, column in zip("xyz", s.end_effector[:3, :3].T.tolist(), strict=True):
        yield Word(axis, axis, _along(s.end, column, 1.12 * END * s.size))
    for axis, column in zip("XYZ", UNITS, strict=True):
        yield Word(f"world_{axis}", axis, _along(ORIGIN, column, 1.08 * world(s)))
    places = s.positions.tolist()
    for i in _named(p):
        above = 0.26 * s.size
        x, y, z = places[i]
        a, b, c = places[i - 1] if p.show == "individual" else places[i]
        middle = _along((0.45 * a + 0.55 * x, 0.45 * b + 0.55 * y, 0.45 * c + 0.55 * z), UNITS[2], above)
        yield Word(f"T{i}", transform_name(p.show, i), middle)
    yield Word("p", "p", _along(s.through[-1, :3].tolist(), UNITS[2], -0.14))
    for k, axis in enumerate(p.axes):
        if p.kind(k) == "f":
            continue
        column = s.composed[k - 1][:3, "xyz".index(axis)].tolist() if k else UNITS["xyz".index(axis)]
        yield Word(f"axis{k + 1}", axis, _along(places[k], column, (AXLE + 0.09) * s.size))


def _events(p: ChainParams, s: ChainSolution) -> Iterator[Word]:
    if s.short is not None:
        why = "out of reach" if s.pull_outside else "not reached"
        yield Word("status", f"⚠ {why}: {quantity(s.short, 'm', 2)} short", _along(s.end, UNITS[2], 0.3 * s.size))
    elif s.singular:
        yield Word("status", "⚠ singular pose", _along(s.end, UNITS[2], 0.3 * s.size))
    if p.target is not None and s.target_distance is not None:
        reached = s.target_distance <= ENOUGH
        text = "✓ target reached" if reached else f"target {quantity(s.target_distance, 'm', 2)} away"
        yield Word("target", text, _along(p.target, UNITS[2], 0.18))
    if p.swap is not None and s.swapped is not None:
        pair = f"T{sub(p.swap - 1)}{sub(p.swap)} and T{sub(p.swap)}{sub(p.swap + 1)} swapped"
        below = -0.2 * s.size
        yield Word("swapped", pair, _along(s.swapped.end, UNITS[2], below))
        next_line = below - 1.5 * HEIGHT * view_of(p).radius
        yield Word("outcome", outcome(s.swapped), _along(s.swapped.end, UNITS[2], next_line))


def _named(p: ChainParams) -> list[int]:
    """The transforms that are named: one that is shown alone; all of a short arm; of a long one both ends."""
    if p.stage is not None:
        return [p.stage]
    n = p.count
    return list(range(n, 0, -1)) if n <= NAMED else [n, 1, n - 1, 2]


def world(s: ChainSolution) -> float:
    """Length of the world's axes."""
    return 0.55 * min(s.size, 1.0)


def _along(place: Sequence[float], direction: Sequence[float], amount: float) -> Place:
    x, y, z = (v + amount * d for v, d in zip(place, direction, strict=True))
    return x, y, z
