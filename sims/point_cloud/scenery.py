"""What the simulated sensors look at: simple bodies with a colour and a reflectivity."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from geometry import rotations, se3
from geometry.ray_casting import Body

Place = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class Thing:
    """A body, its colour (RGB 0–255), and the share of the light that it sends back."""

    body: Body
    color: Place
    reflects: float


def thing(
    shape: str, half: Place, center: Place, color: Place, reflects: float = 0.5, yaw: float = 0.0, lean: float = 0.0
) -> Thing:
    """A body about a place; it leans over to its own +x by an angle, then is turned about Z, both in degrees."""
    R = rotations.axis_rotation("z", math.radians(yaw)) @ rotations.axis_rotation("y", math.radians(lean))
    return Thing(Body(shape, np.array(half), se3.transform(R, np.array(center))), color, reflects)


def box(low: Place, high: Place, color: Place, reflects: float = 0.5) -> Thing:
    """A box between two corners."""
    a, b = np.array(low), np.array(high)
    return thing("box", tuple((b - a) / 2.0), tuple((a + b) / 2.0), color, reflects)


def post(x: float, y: float, radius: float, low: float, high: float, color: Place, reflects: float = 0.5) -> Thing:
    """An upright cylinder."""
    return thing("cylinder", (radius, radius, (high - low) / 2.0), (x, y, (low + high) / 2.0), color, reflects)


def ball(center: Place, radii: Place, color: Place, reflects: float = 0.5) -> Thing:
    """An ellipsoid with level axes."""
    return thing("ellipsoid", radii, center, color, reflects)


WOOD, DARK, WHITE, GREEN, STONE = (176, 122, 70), (70, 62, 58), (232, 228, 220), (86, 140, 72), (186, 182, 172)


def room() -> list[Thing]:
    """A living room of 5 m by 4 m, open towards the viewer: two walls, so that one sees in."""
    return [
        box((-2.6, -2.1, -0.1), (2.6, 2.1, 0.0), WOOD),
        box((-2.6, 2.0, 0.0), (2.6, 2.1, 0.9), WHITE),
        box((-2.6, 2.0, 0.9), (0.2, 2.1, 2.5), WHITE),
        box((1.7, 2.0, 0.9), (2.6, 2.1, 2.5), WHITE),
        box((0.2, 2.0, 2.1), (1.7, 2.1, 2.5), WHITE),
        box((-2.6, -2.1, 0.0), (-2.5, 2.1, 2.5), (210, 190, 160)),
        box((-2.5, -1.6, 0.0), (-2.46, -0.7, 2.05), (120, 84, 52)),
        box((-1.3, -1.3, 0.0), (0.9, 0.6, 0.012), (150, 52, 48)),
        *table(-0.2, -0.35),
        *chair(-0.2, -1.15, 0.0),
        *chair(0.75, -0.35, 90.0),
        *sofa(-1.5, 1.45),
        *shelf(),
        *lamp(2.2, -1.5),
        *plant(2.15, 1.55),
        ball((-0.35, -0.3, 0.83), (0.09, 0.09, 0.09), (226, 140, 30)),
        post(0.1, -0.45, 0.045, 0.74, 0.98, (40, 96, 150)),
    ]


def table(x: float, y: float) -> Iterator[Thing]:
    yield box((x - 0.6, y - 0.4, 0.70), (x + 0.6, y + 0.4, 0.74), (140, 92, 50))
    for dx in (-0.54, 0.54):
        for dy in (-0.34, 0.34):
            yield post(x + dx, y + dy, 0.03, 0.0, 0.70, DARK)


def chair(x: float, y: float, yaw: float) -> Iterator[Thing]:
    c, s = math.cos(math.radians(yaw)), math.sin(math.radians(yaw))
    yield thing("box", (0.22, 0.22, 0.02), (x, y, 0.45), (196, 160, 96), yaw=yaw)
    yield thing("box", (0.22, 0.02, 0.22), (x + 0.2 * s, y - 0.2 * c, 0.72), (196, 160, 96), yaw=yaw)
    for dx in (-0.19, 0.19):
        for dy in (-0.19, 0.19):
            yield post(x + dx * c - dy * s, y + dx * s + dy * c, 0.02, 0.0, 0.43, DARK)


def sofa(x: float, y: float) -> Iterator[Thing]:
    blue = (62, 88, 128)
    yield box((x - 0.9, y - 0.4, 0.08), (x + 0.9, y + 0.45, 0.42), blue)
    yield box((x - 0.9, y + 0.25, 0.42), (x + 0.9, y + 0.45, 0.85), blue)
    for side in (-0.82, 0.82):
        yield box((x + side - 0.09, y - 0.4, 0.42), (x + side + 0.09, y + 0.45, 0.6), blue)
    yield ball((x - 0.4, y + 0.15, 0.56), (0.22, 0.12, 0.17), (222, 180, 60))


def shelf() -> Iterator[Thing]:
    rng = np.random.default_rng(11)
    for z in (0.05, 0.45, 0.85, 1.25, 1.65):
        yield box((-2.5, 0.2, z), (-2.2, 1.0, z + 0.03), DARK)
        start = 0.22
        while z < 1.6 and start < 0.92:
            wide, tall = rng.uniform(0.03, 0.07), rng.uniform(0.2, 0.33)
            color = tuple(rng.uniform(50.0, 220.0, 3).tolist())
            yield box((-2.48, start, z + 0.03), (-2.26, start + wide - 0.004, z + 0.03 + tall), color)
            start += wide


def lamp(x: float, y: float) -> Iterator[Thing]:
    yield post(x, y, 0.15, 0.0, 0.03, DARK)
    yield post(x, y, 0.015, 0.03, 1.45, DARK)
    yield post(x, y, 0.2, 1.45, 1.75, (250, 236, 190), 0.9)


def plant(x: float, y: float) -> Iterator[Thing]:
    yield post(x, y, 0.16, 0.0, 0.35, (170, 88, 56))
    for dx, dy, z in ((0.0, 0.0, 0.75), (0.14, -0.1, 0.6), (-0.15, 0.05, 0.62), (0.02, 0.16, 0.9)):
        yield ball((x + dx, y + dy, z), (0.16, 0.16, 0.22), GREEN)


def street() -> list[Thing]:
    """A street along Y with pavements, houses, parked cars, trees, people, and two posts that stand close together."""
    road, pavement = (90, 90, 92), (150, 148, 144)
    houses = (
        ((-18.0, -40.0), (-8.5, -12.0), 9.0),
        ((-20.0, -11.0), (-8.0, 8.0), 12.0),
        ((-18.0, 9.5), (-9.0, 40.0), 7.0),
        ((8.5, -40.0), (20.0, -4.0), 8.0),
        ((9.5, -2.0), (20.0, 20.0), 14.0),
        ((8.0, 23.0), (20.0, 40.0), 10.0),
    )
    return [
        box((-60.0, -60.0, -0.3), (60.0, 60.0, 0.0), road, 0.2),
        box((-8.0, -60.0, 0.0), (-4.5, 60.0, 0.14), pavement, 0.35),
        box((4.5, -60.0, 0.0), (8.0, 60.0, 0.14), pavement, 0.35),
        *(box((-0.08, y, 0.0), (0.08, y + 2.0, 0.004), WHITE, 0.95) for y in range(-36, 36, 5)),
        *(box((*low, 0.0), (*high, top), STONE, 0.55) for low, high, top in houses),
        *(part for x, y in ((-3.4, 7.0), (-3.4, 13.5), (3.5, -6.0), (3.4, 9.5), (-3.5, -12.0)) for part in car(x, y)),
        *(part for x, y in ((-6.2, 3.5), (-6.0, 16.0), (6.3, 4.0), (6.2, -11.0), (6.2, 15.5)) for part in tree(x, y)),
        *(part for x, y in ((5.4, 7.2), (-5.3, -4.0), (2.0, 14.0)) for part in person(x, y)),
        post(5.0, 1.6, 0.06, 0.0, 3.2, DARK, 0.6),
        post(5.0, 2.1, 0.06, 0.0, 3.2, DARK, 0.6),
        thing("box", (0.3, 0.02, 0.3), (5.0, 1.53, 2.85), (200, 40, 40), 0.98),
        post(-4.9, 9.8, 0.09, 0.0, 6.0, DARK, 0.6),
        thing("cylinder", (0.12, 0.12, 0.9), (-4.1, 9.8, 6.0), DARK, 0.6, lean=90.0),
    ]


def car(x: float, y: float) -> Iterator[Thing]:
    paint = (170, 30, 36) if x > 0.0 else (40, 80, 150)
    yield box((x - 0.88, y - 2.1, 0.25), (x + 0.88, y + 2.1, 0.85), paint, 0.7)
    yield box((x - 0.75, y - 1.3, 0.85), (x + 0.75, y + 1.0, 1.45), (50, 56, 62), 0.1)
    for dx in (-0.8, 0.8):
        for dy in (-1.35, 1.35):
            yield thing("cylinder", (0.31, 0.31, 0.1), (x + dx, y + dy, 0.31), (30, 30, 30), 0.08, lean=90.0)


def tree(x: float, y: float) -> Iterator[Thing]:
    yield post(x, y, 0.14, 0.0, 2.6, (96, 70, 50), 0.4)
    rng = np.random.default_rng(int(1000.0 + 10.0 * x + y))
    for _ in range(7):
        dx, dy, dz = rng.uniform(-0.8, 0.8, 3).tolist()
        size = float(rng.uniform(0.5, 0.9))
        yield ball((x + dx, y + dy, 3.4 + dz), (size, size, 0.8 * size), GREEN, 0.65)


def person(x: float, y: float) -> Iterator[Thing]:
    for side in (-0.1, 0.1):
        yield post(x + side, y, 0.08, 0.0, 0.85, (50, 60, 90), 0.3)
    yield ball((x, y, 1.15), (0.24, 0.16, 0.36), (200, 90, 60), 0.6)
    yield ball((x, y, 1.63), (0.11, 0.12, 0.14), (220, 180, 150), 0.6)


def statue() -> list[Thing]:
    """A stone figure, 2.2 m tall with its plinth, that holds up a ball."""
    return [
        box((-0.5, -0.5, 0.0), (0.5, 0.5, 0.18), STONE),
        post(0.0, 0.0, 0.4, 0.18, 0.42, STONE),
        thing("cylinder", (0.09, 0.09, 0.38), (-0.12, 0.0, 0.78), STONE, lean=6.0),
        thing("cylinder", (0.09, 0.09, 0.38), (0.13, 0.03, 0.78), STONE, lean=-6.0),
        thing("box", (0.07, 0.13, 0.05), (-0.15, -0.05, 0.46), STONE),
        thing("box", (0.07, 0.13, 0.05), (0.17, -0.02, 0.46), STONE, yaw=15.0),
        ball((0.0, 0.0, 1.42), (0.23, 0.15, 0.36), STONE),
        ball((0.0, 0.0, 1.16), (0.21, 0.16, 0.17), STONE),
        post(0.0, 0.0, 0.07, 1.7, 1.84, STONE),
        ball((0.0, -0.02, 1.92), (0.12, 0.14, 0.16), STONE),
        ball((0.0, -0.16, 1.91), (0.025, 0.04, 0.035), STONE),
        thing("cylinder", (0.06, 0.06, 0.24), (-0.31, 0.0, 1.45), STONE, lean=28.0),
        thing("cylinder", (0.05, 0.05, 0.2), (-0.42, -0.06, 1.10), STONE, yaw=-100.0, lean=18.0),
        thing("cylinder", (0.06, 0.06, 0.2), (0.34, 0.0, 1.68), STONE, lean=62.0),
        thing("cylinder", (0.05, 0.05, 0.2), (0.52, -0.02, 1.93), STONE, lean=2.0),
        ball((0.53, -0.02, 2.18), (0.13, 0.13, 0.13), STONE),
    ]


def court() -> list[Thing]:
    """The statue before a corner of two walls, with a bench: what two scans overlap on."""
    return [
        box((-2.2, -2.0, -0.1), (2.2, 1.6, 0.0), (150, 140, 126)),
        box((-2.2, 1.5, 0.0), (2.2, 1.6, 2.0), (190, 170, 140)),
        box((-2.3, -0.8, 0.0), (-2.2, 1.6, 2.0), (176, 150, 128)),
        box((0.9, 1.0, 0.38), (2.0, 1.4, 0.45), WOOD),
        box((1.0, 1.05, 0.0), (1.1, 1.35, 0.38), DARK),
        box((1.8, 1.05, 0.0), (1.9, 1.35, 0.38), DARK),
        post(-1.7, 1.0, 0.22, 0.0, 0.5, (170, 88, 56)),
        ball((-1.7, 1.0, 0.75), (0.32, 0.32, 0.34), GREEN),
        *statue(),
    ]
