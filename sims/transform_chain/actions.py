"""What buttons and handles do to a state."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from geometry.inverse_kinematics import inverse_kinematics
from sims.kit.sim import Action, Step
from sims.transform_chain.drawing import held_angle, place_of
from sims.transform_chain.params import LISTS, MOST, ROWS, ChainParams, Place
from sims.transform_chain.presets import PRESETS, Preset
from sims.transform_chain.solution import ChainSolution

PLAIN: Mapping[str, Any] = {"twists": (), "offsets": (), "starts": (), "joints": ""}
"""What links have besides axis, angle and length, where they have none of it."""
NEW_LINK = ("y", 0.0, 0.4)
"""Axis, angle and length of a link that is added."""
CLOSE = 1e-8
"""Metres within which a drag's end is reached."""
FULL_TURN = 2.8
"""Seconds of a sweep."""


def hold_end(p: ChainParams, place: tuple[float, ...]) -> dict[str, Any]:
    """Angles that bring the end effector to a place, or as near as they get; an arm in a plane stays in it."""
    chain, start = p.arm, p.moves
    x, y, z = place
    if p.plane is not None:
        x, y, z = (sum(p.offsets) if axis == p.plane else v for axis, v in zip("xyz", place, strict=True))
    found = inverse_kinematics(chain, (x, y, z), start, tolerance=CLOSE)
    moves = found.angles.tolist()
    kinds = p.joints or "r" * p.count
    angles = tuple(
        wrapped(math.degrees(m)) if kind == "r" else a for a, m, kind in zip(p.angles, moves, kinds, strict=True)
    )
    offsets = tuple(m if kind == "p" else d for d, m, kind in zip(p.offsets, moves, kinds, strict=False))
    return {"angles": angles, "offsets": offsets, "pull": None if found.reached else (x, y, z), "trace": None}


def hold_joint(k: int) -> Callable[[ChainParams, tuple[float, ...]], dict[str, Any]]:
    """What dragging the grip of the k-th joint, from 0, does: it turns, or slides, to where the grip would be."""
    return lambda p, place: turned(p, k, place) if k < p.count else {}


def turned(p: ChainParams, k: int, place: tuple[float, ...]) -> dict[str, Any]:
    """A joint's angle, or its way, at which its grip is nearest to a place in the world."""
    before = p.arm.forward(p.moves).composed[k - 1] if k else np.eye(4)
    own = place_of(before[:3, :3].T @ (np.array(place) - before[:3, 3]))
    if p.kind(k) == "f":
        return {}
    if p.slides(k):
        return {f"offsets.{k}": own["xyz".index(p.axes[k])]}
    angle = held_angle(p.axes[k], own)
    if angle is None:
        return {}
    return {f"angles.{k}": wrapped(math.degrees(angle - p.arm.links[k].start))}


def wrapped(degrees: float) -> float:
    """The same direction within ±180°, without what rounding leaves of a zero."""
    return round(degrees if -180.0 <= degrees <= 180.0 else math.remainder(degrees, 360.0), 9) + 0.0


def end_place(p: ChainParams, s: ChainSolution) -> Place:
    """Where the end effector is."""
    return s.end


def with_arm(p: ChainParams, **arm: Any) -> dict[str, Any]:
    """Changes to another arm; what is said of joints that it hasn't goes."""
    n = len(arm["axes"])
    kept = {"swap": p.swap if p.swap and p.swap < n else None}
    kept |= {name: at if (at := getattr(p, name)) and at <= n else None for name in ("trace", "stage")}
    return {**PLAIN, "pull": None, **arm, **kept}


def add_link(p: ChainParams) -> dict[str, Any]:
    """One link more at the end."""
    if p.count == MOST:
        return {}
    more = {"twists": (0.0,), "offsets": (0.0,), "starts": (0.0,), "joints": "r"}
    rows = {name: value + more[name] for name in ROWS if (value := getattr(p, name))}
    axis, angle, length = NEW_LINK
    return with_arm(p, axes=p.axes + axis, lengths=(*p.lengths, length), angles=(*p.angles, angle), **rows)


def remove_link(p: ChainParams) -> dict[str, Any]:
    """Without the last link."""
    return with_arm(p, **{name: getattr(p, name)[:-1] for name in (*LISTS, *ROWS)}) if p.count > 1 else {}


def preset(chosen: Preset) -> Callable[[ChainParams], dict[str, Any]]:
    """The action that makes a known arm."""
    arm = {name: getattr(chosen, name) for name in (*LISTS, "twists", "offsets", "joints")}
    return lambda p: with_arm(p, **arm)


def sweep(p: ChainParams) -> Iterator[Step]:
    """A full turn of the joint whose trace is shown, or the first, and back to where it was."""
    turning = [k for k in range(p.count) if p.kind(k) == "r"]
    if not turning:
        return
    k = p.trace - 1 if p.trace is not None and p.trace - 1 in turning else turning[0]

    def at(angle: float) -> Mapping[str, Any]:
        return {"angles": (*p.angles[:k], angle, *p.angles[k + 1 :])}

    words = f"Joint {k + 1} turns once round, and takes the end effector round a circle about its axis."
    yield Step({"trace": k + 1, "pull": None}, 0.0, words=words)
    yield Step(at(180.0), FULL_TURN * (180.0 - p.angles[k]) / 360.0, words=words)
    yield Step(at(-180.0), 0.0, words=words)
    yield Step(at(p.angles[k]), FULL_TURN * (180.0 + p.angles[k]) / 360.0, words=words)


def new_target(p: ChainParams) -> dict[str, Any]:
    """A place that some posture reaches, well away from the end effector; each leads to the next one."""
    chain = p.arm
    now = chain.forward(p.moves).positions[-1].tolist()
    dice = random.Random(repr((p.axes, p.lengths, p.target)))
    places: list[Place] = []
    for _ in range(12):
        turns = [math.radians(dice.uniform(-100.0, 100.0)) for _ in p.axes]
        moves = [turn if p.kind(k) == "r" else move for k, (move, turn) in enumerate(zip(p.moves, turns, strict=True))]
        x, y, z = chain.forward(moves).positions[-1].round(3).tolist()
        places.append((x, y, z))
    away = (place for place in places if math.dist(place, now) > 0.25 * sum(map(abs, p.lengths)))
    return {"target": next(away, places[0])}


ACTIONS: tuple[Action, ...] = (
    Action("sweep", "Sweep joint", "A full turn of the joint whose trace is shown, or of the first", sweep),
    Action("add-link", "Add link", "One link more at the end, about y; the others stay as they are", add_link),
    Action("remove-link", "Remove link", "Takes the last link away; the others stay as they are", remove_link),
    Action("new-target", "New target", "A place within reach, to reach by hand", new_target),
    *(Action(each.name, each.label, each.says, preset(each), "Presets") for each in PRESETS),
)
