"""What the camera looks at: a wire house, cubes, posts and two rails, all standing on the ground.

House, posts and rails keep to one street, whose directions across, along and up each have a colour and a vanishing
point; the cubes are turned otherwise.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Literal

import numpy as np

from geometry.arrays import Array

Role = Literal["x", "y", "z", "ink"]
Place = tuple[float, float, float]
Piece = tuple[Place, Place]
Name = Literal[
    "near-post", "near-foot", "far-post", "far-foot", "back-post",
    "roof-near", "roof-far", "eave-near-left", "eave-near-right", "eave-far-right", "eave-far-left",
    "wall-near-left", "wall-near-right", "wall-far-right", "wall-far-left",
    "cube-left", "cube-right", "cube-far",
]  # fmt: skip
TURN = math.radians(15.0)
ORIGIN = (-0.5, -1.5)
ACROSS = (math.cos(TURN), -math.sin(TURN), 0.0)
ALONG = (math.sin(TURN), math.cos(TURN), 0.0)
UP = (0.0, 0.0, 1.0)
DIRECTIONS: dict[str, tuple[Role, Place]] = {
    "across": ("x", (-ACROSS[0], -ACROSS[1], 0.0)),
    "along": ("y", ALONG),
    "up": ("z", UP),
}
LEFT, RIGHT, FRONT, BACK, WALL, ROOF = -2.4, -1.05, 1.8, 3.6, 1.1, 1.7
"""The house: metres across, along and up in the street."""
GAUGE, RAILS = 0.25, (-3.8, 5.8)
POSTS, BESIDE, TALL = (-3.3, 0.9, 2.1, 3.3, 4.5), 0.7, 1.0
CUBES = {"left": (-1.5, -0.6, 0.5, 0.5), "right": (1.4, 0.0, 0.55, 0.3), "far": (2.2, 2.2, 0.7, 0.9)}
"""Middle x and y in the world, size, turn in radians."""


def street(across: float, along: float, up: float) -> Place:
    """A place in the world from metres in the street."""
    return (
        ORIGIN[0] + across * ACROSS[0] + along * ALONG[0],
        ORIGIN[1] + across * ACROSS[1] + along * ALONG[1],
        up,
    )


def _cube(x: float, y: float, size: float, turn: float) -> tuple[list[Place], list[Place]]:
    """Corners of the foot and of the top, in the same order; the third is that which the first camera sees best."""
    reach = size / math.sqrt(2.0)
    spots = [
        (x + reach * math.cos(turn + k * math.pi / 2), y + reach * math.sin(turn + k * math.pi / 2)) for k in range(4)
    ]
    return [(a, b, 0.0) for a, b in spots], [(a, b, size) for a, b in spots]


_RING = ((LEFT, FRONT), (RIGHT, FRONT), (RIGHT, BACK), (LEFT, BACK))
_WALLS = [street(a, b, 0.0) for a, b in _RING]
_EAVES = [street(a, b, WALL) for a, b in _RING]
_RIDGE = [street(0.5 * (LEFT + RIGHT), b, ROOF) for b in (FRONT, BACK)]
_CUBES = {name: _cube(*cube) for name, cube in CUBES.items()}
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
    **{f"cube-{name}": top[3] for name, (_, top) in _CUBES.items()},
}
"""Points with names, in the world."""
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
SUBJECT: Piece = (
    street(0.5 * (LEFT + RIGHT), 0.5 * (FRONT + BACK), 0.0),
    street(0.5 * (LEFT + RIGHT), 0.5 * (FRONT + BACK), ROOF),
)
"""The house's upright through its middle, from the ground to the ridge."""
MIDDLE: Place = (SUBJECT[0][0], SUBJECT[0][1], 0.5 * ROOF)


def _pieces() -> Iterator[tuple[Role, Piece]]:
    for ring in (_WALLS, _EAVES):
        for k, edge in enumerate(pairwise([*ring, ring[0]])):
            yield ("y" if k % 2 else "x"), edge
    yield from (("z", edge) for edge in zip(_WALLS, _EAVES, strict=True))
    yield "y", (_RIDGE[0], _RIDGE[1])
    for end, (a, b) in zip(_RIDGE, ((0, 1), (3, 2)), strict=True):
        yield "ink", (_EAVES[a], end)
        yield "ink", (_EAVES[b], end)
    for side in (-GAUGE, GAUGE):
        yield "y", (street(side, RAILS[0], 0.0), street(side, RAILS[1], 0.0))
    for k in range(17):
        along = RAILS[0] + 0.6 * k
        yield "x", (street(-1.6 * GAUGE, along, 0.0), street(1.6 * GAUGE, along, 0.0))
    yield from (("z", (street(BESIDE, along, 0.0), street(BESIDE, along, TALL))) for along in POSTS)
    for foot, top in _CUBES.values():
        for corners in (foot, top):
            yield from (("ink", edge) for edge in pairwise([*corners, corners[0]]))
        yield from (("ink", edge) for edge in zip(foot, top, strict=True))


_ALL = list(_pieces())
ROLES: tuple[Role, ...] = tuple(role for role, _ in _ALL)
WIRES: Array = np.array([piece for _, piece in _ALL])
"""All edges (n, 2, 3) in the world; `ROLES` gives the colour of each."""
BY_ROLE: dict[Role, list[int]] = {r: [k for k, role in enumerate(ROLES) if role == r] for r in ("ink", "x", "y", "z")}
