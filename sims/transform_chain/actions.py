"""What buttons and handles do to a state."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from geometry.inverse_kinematics import inverse_kinematics
from geometry.kinematics import Chain
from sims.kit.sim import Action, Step
from sims.transform_chain.params import MOST, ChainParams, Place
from sims.transform_chain.solution import ChainSolution

NEW_LINK = ("y", 0.0, 0.4)
"""Axis, angle and length of a link that is added."""
CLOSE = 1e-8
"""Metres within which a drag's end is reached."""
FULL_TURN = 2.8
"""Seconds of a sweep."""


@dataclass(frozen=True)
class Preset:
    """A known arm, as near as links Rot(axis, angle) · Trans(length, 0, 0) come to it, and what they leave out."""

    name: str
    label: str
    axes: str
    lengths: tuple[float, ...]
    angles: tuple[float, ...]
    says: str
    slides: int | None = None
    """Index of the link whose length stands for a sliding joint."""

    def is_that(self, p: ChainParams) -> bool:
        """Whether an arm is this one, in any posture."""
        return p.axes == self.axes and all(
            a == b or k == self.slides for k, (a, b) in enumerate(zip(p.lengths, self.lengths, strict=True))
        )


# The published lengths, in metres, of an Adept Cobra s800 (both links, and its stroke) and an ABB IRB 1600-6/1.45.
PRESETS = (
    Preset(
        "planar-2r", "Planar 2R arm", "zz", (1.0, 0.8), (30.0, 60.0),
        "Planar 2R arm: both joints turn about z, so the arm stays in the plane z = 0.",
    ),
    Preset(
        "planar-3r", "Planar 3R arm", "zzz", (1.0, 0.8, 0.5), (20.0, 50.0, 40.0),
        "Planar 3R arm: the third joint leaves the end effector a choice of direction at every place.",
    ),
    Preset(
        "scara", "SCARA arm", "zzyx", (0.425, 0.375, 0.15, 0.0), (-20.0, 70.0, 90.0, 0.0),
        "SCARA arm with the link lengths of an Adept Cobra s800. Its third joint slides; here joint 3 stays at 90°, and"
        " link 3’s length (0 to 0.21 m) is the slide. No turn moves the end effector up or down, so every pose is"
        " singular. The height of its column is left out.",
        slides=2,
    ),
    Preset(
        "six-axis", "Six-axis arm", "zyyxyx",
        (0.15, 0.7, 0.6, 0.0, 0.0, 0.065), (30.0, -60.0, 80.0, 0.0, 40.0, 0.0),
        "Six-axis arm with the link lengths of an ABB IRB 1600-6/1.45: shoulder 0.15, upper arm 0.7, forearm 0.6,"
        " flange 0.065 m; the last three axes meet. Left out: the height of its column, which isn’t along x.",
    ),
)  # fmt: skip


def known(p: ChainParams) -> Preset | None:
    """The preset that an arm is."""
    return next((preset for preset in PRESETS if preset.is_that(p)), None)


def hold_end(p: ChainParams, place: tuple[float, ...]) -> dict[str, Any]:
    """Angles that bring the end effector to a place, or as near as they get; an arm in a plane stays in it."""
    x, y, z = (0.0 if {axis} == {*p.axes} else v for axis, v in zip("xyz", place, strict=True))
    start = [math.radians(a) for a in p.angles]
    found = inverse_kinematics(Chain(p.axes, p.lengths), (x, y, z), start, tolerance=CLOSE)
    angles = tuple(wrapped(math.degrees(a)) for a in found.angles.tolist())
    return {"angles": angles, "pull": None if found.reached else (x, y, z), "trace": None}


def wrapped(degrees: float) -> float:
    """The same direction within ±180°."""
    return degrees if -180.0 <= degrees <= 180.0 else math.remainder(degrees, 360.0)


def end_place(p: ChainParams, s: ChainSolution) -> Place:
    """Where the end effector is."""
    return s.end


def with_arm(p: ChainParams, axes: str, lengths: tuple[float, ...], angles: tuple[float, ...]) -> dict[str, Any]:
    """Changes to another arm; a swap or trace of joints that it hasn't goes."""
    n = len(axes)
    kept = {"swap": p.swap if p.swap and p.swap < n else None, "trace": p.trace if p.trace and p.trace <= n else None}
    return {"axes": axes, "lengths": lengths, "angles": angles, "pull": None, **kept}


def add_link(p: ChainParams) -> dict[str, Any]:
    """One link more at the end."""
    if p.count == MOST:
        return {}
    axis, angle, length = NEW_LINK
    return with_arm(p, p.axes + axis, (*p.lengths, length), (*p.angles, angle))


def remove_link(p: ChainParams) -> dict[str, Any]:
    """Without the last link."""
    return with_arm(p, p.axes[:-1], p.lengths[:-1], p.angles[:-1]) if p.count > 1 else {}


def preset(chosen: Preset) -> Callable[[ChainParams], dict[str, Any]]:
    """The action that makes a known arm."""
    return lambda p: with_arm(p, chosen.axes, chosen.lengths, chosen.angles)


def sweep(p: ChainParams) -> Iterator[Step]:
    """A full turn of the joint whose trace is shown, or the first, and back to where it was."""
    k = (p.trace or 1) - 1

    def at(angle: float) -> Mapping[str, Any]:
        return {"angles": (*p.angles[:k], angle, *p.angles[k + 1 :])}

    yield Step({"trace": k + 1, "pull": None}, 0.0)
    yield Step(at(180.0), FULL_TURN * (180.0 - p.angles[k]) / 360.0)
    yield Step(at(-180.0), 0.0)
    yield Step(at(p.angles[k]), FULL_TURN * (180.0 + p.angles[k]) / 360.0)


def new_target(p: ChainParams) -> dict[str, Any]:
    """A place that some posture reaches, well away from the end effector; each leads to the next one."""
    chain = Chain(p.axes, p.lengths)
    now = chain.forward([math.radians(a) for a in p.angles]).positions[-1].tolist()
    dice = random.Random(repr((p.axes, p.lengths, p.target)))
    places: list[Place] = []
    for _ in range(12):
        posture = chain.forward([math.radians(dice.uniform(-100.0, 100.0)) for _ in p.axes])
        x, y, z = posture.positions[-1].round(3).tolist()
        places.append((x, y, z))
    away = (place for place in places if math.dist(place, now) > 0.25 * sum(p.lengths))
    return {"target": next(away, places[0])}


ACTIONS: tuple[Action, ...] = (
    Action("sweep", "Sweep joint", "A full turn of the joint whose trace is shown, or of the first", sweep),
    Action("add-link", "Add link", "One link more at the end, about y; the others stay as they are", add_link),
    Action("remove-link", "Remove link", "Takes the last link away; the others stay as they are", remove_link),
    Action("new-target", "New target", "A place within reach, to reach by hand", new_target),
    *(Action(each.name, each.label, each.says, preset(each), "Presets") for each in PRESETS),
)
