"""A little world on the ground, which the cameras of several sims look at: a house, cubes, posts, and a track.

House, posts and track keep to one street, whose directions across, along and up each have a colour and a vanishing
point; the cubes are turned otherwise. Corners of things have names. Everything stands in front of a camera at
(0, -4, 1.2) that looks along +Y; `sims.kit.world_drawing` draws it, also with an offset.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from geometry.arrays import Array
from sims.kit.types import Place

Role = Literal["x", "y", "z"]
Name = Literal[
    "near-post", "near-foot", "far-post", "far-foot", "back-post",
    "roof-near", "roof-far", "eave-near-left", "eave-near-right", "eave-far-right", "eave-far-left",
    "wall-near-left", "wall-near-right", "wall-far-right", "wall-far-left",
    "cube-left", "cube-right", "cube-far",
]  # fmt: skip
Paint = Literal["wall", "roof", "cube-left", "cube-right", "cube-far", "post", "bed", "sleeper", "rail"]
Face = Sequence[Place]
TURN = math.radians(15.0)
CENTER = (-0.5, -1.5)
ACROSS = (math.cos(TURN), -math.sin(TURN), 0.0)
ALONG = (math.sin(TURN), math.cos(TURN), 0.0)
DIRECTIONS: dict[str, tuple[Role, Place]] = {
    "across": ("x", (-ACROSS[0], -ACROSS[1], 0.0)),
    "along": ("y", ALONG),
    "up": ("z", (0.0, 0.0, 1.0)),
}
LEFT, RIGHT, FRONT, BACK, WALL, ROOF = -2.4, -1.05, 1.8, 3.6, 1.1, 1.7
"""The house: metres across, along and up in the street."""
POSTS, BESIDE, TALL, THICK = (-3.3, 0.9, 2.1, 3.3, 4.5), 0.7, 1.0, 0.12
"""Near sides of the posts along the street, their right ones across it, and how tall and thick they are."""
CUBES = {"left": (-1.5, -0.6, 0.5, 0.5), "right": (1.4, 0.0, 0.55, 0.3), "far": (2.2, 2.2, 0.7, 0.9)}
"""Middle x and y in the world, size, turn in radians."""
GAUGE, TRACK, BED, SLEEPER, RAIL = 0.25, (-3.8, 5.8), 0.025, 0.03, 0.09
"""Half the gauge, the ends along the street, and how high bed, sleepers and rails reach."""


@dataclass(frozen=True)
class Body:
    """A convex or flat thing of one colour: its faces, with corners counter-clockwise as seen from outside."""

    paint: Paint
    faces: Sequence[Face]


def street(across: float, along: float, up: float) -> Place:
    """A place in the world from metres in the street."""
    return (
        CENTER[0] + across * ACROSS[0] + along * ALONG[0],
        CENTER[1] + across * ACROSS[1] + along * ALONG[1],
        up,
    )


def _ring(left: float, right: float, front: float, back: float, up: float) -> list[Place]:
    """Corners of a level rectangle in the street: near left, near right, far right, far left."""
    return [street(a, b, up) for a, b in ((left, front), (right, front), (right, back), (left, back))]


def _cube(x: float, y: float, size: float, turn: float, up: float) -> list[Place]:
    """Corners of the foot or the top of a cube; the fourth is that which the first camera sees best."""
    reach = size / math.sqrt(2.0)
    spots = [turn + k * math.pi / 2 for k in range(4)]
    return [(x + reach * math.cos(spot), y + reach * math.sin(spot), up) for spot in spots]


_WALLS, _EAVES = (_ring(LEFT, RIGHT, FRONT, BACK, up) for up in (0.0, WALL))
_RIDGE = [street(0.5 * (LEFT + RIGHT), b, ROOF) for b in (FRONT, BACK)]
_CORNERS = ("near-left", "near-right", "far-right", "far-left")
PLACES: dict[str, Place] = {
    "near-post": street(BESIDE, POSTS[1], TALL),
    "near-foot": street(BESIDE, POSTS[1], 0.0),
    "far-post": street(BESIDE, POSTS[-1], TALL),
    "far-foot": street(BESIDE, POSTS[-1], 0.0),
    "back-post": street(BESIDE, POSTS[0], TALL),
    "roof-near": _RIDGE[0],
    "roof-far": _RIDGE[1],
    **{f"eave-{corner}": place for corner, place in zip(_CORNERS, _EAVES, strict=True)},
    **{f"wall-{corner}": place for corner, place in zip(_CORNERS, _WALLS, strict=True)},
    **{f"cube-{name}": _cube(*cube, cube[2])[3] for name, cube in CUBES.items()},
}
"""Points with names, in the world: each is a corner of a thing."""
TITLES: dict[str, str] = {
    "near-post": "Near post, top", "near-foot": "Near post, foot", "far-post": "Far post, top",
    "far-foot": "Far post, foot", "back-post": "Back post, top", "roof-near": "Roof, near end",
    "roof-far": "Roof, far end",
    **{f"eave-{corner}": f"Eave, {corner.replace('-', ' ')}" for corner in _CORNERS},
    **{f"wall-{corner}": f"Wall, {corner.replace('-', ' ')}" for corner in _CORNERS},
    "cube-left": "Left cube, corner", "cube-right": "Right cube, corner", "cube-far": "Far cube, corner",
}  # fmt: skip
NAMES = tuple(PLACES)
POINTS: Array = np.array(list(PLACES.values()))
SUBJECT: tuple[Place, Place] = (
    street(0.5 * (LEFT + RIGHT), 0.5 * (FRONT + BACK), 0.0),
    street(0.5 * (LEFT + RIGHT), 0.5 * (FRONT + BACK), ROOF),
)
"""The house's upright through its middle, from the ground to the ridge."""
MIDDLE: Place = (SUBJECT[0][0], SUBJECT[0][1], 0.5 * ROOF)


def _prism(foot: Sequence[Place], top: Sequence[Place]) -> list[Face]:
    """Faces of a body between a polygon, counter-clockwise from above, and the one above it."""
    around = range(len(foot))
    sides = [(foot[k - 1], foot[k], top[k], top[k - 1]) for k in around]
    return [tuple(reversed(foot)), *sides, tuple(top)]


def _box(left: float, right: float, front: float, back: float, low: float, high: float) -> list[Face]:
    return _prism(_ring(left, right, front, back, low), _ring(left, right, front, back, high))


def _roof() -> list[Face]:
    (a, b, c, d), (near, far) = _EAVES, _RIDGE
    return [(d, c, b, a), (a, b, near), (b, c, far, near), (c, d, far), (d, a, near, far)]


def _sleepers() -> Iterator[Face]:
    for k in range(17):
        along = TRACK[0] + 0.6 * k
        yield _ring(-1.6 * GAUGE, 1.6 * GAUGE, along - 0.08, along + 0.08, SLEEPER)


def _bodies() -> Iterator[Body]:
    yield Body("bed", _box(-2.0 * GAUGE, 2.0 * GAUGE, TRACK[0] - 0.2, TRACK[1] + 0.2, 0.0, BED))
    yield Body("sleeper", list(_sleepers()))
    for side in (-GAUGE, GAUGE):
        yield Body("rail", _box(side - 0.025, side + 0.025, *TRACK, SLEEPER, RAIL))
    yield Body("wall", _prism(_WALLS, _EAVES))
    yield Body("roof", _roof())
    for along in POSTS:
        yield Body("post", _box(BESIDE - THICK, BESIDE, along, along + THICK, 0.0, TALL))
    names: Iterable[tuple[Literal["left", "right", "far"], Paint]] = (
        ("left", "cube-left"), ("right", "cube-right"), ("far", "cube-far"),
    )  # fmt: skip
    for name, paint in names:
        yield Body(paint, _prism(*(_cube(*CUBES[name], up) for up in (0.0, CUBES[name][2]))))


BODIES: tuple[Body, ...] = tuple(_bodies())
