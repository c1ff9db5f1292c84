"""What the buttons do: each shows a cause before its effect.

While a motion is compared with a ghost, the ellipsoid is out of the way.
"""

from __future__ import annotations

import math
from collections.abc import Generator, Iterator, Mapping
from typing import Any

from sims.gimbal_lock.params import GimbalParams
from sims.kit.sim import Step

Angles = dict[str, float]
SWING, TRY = 40.0, 30.0
"""Degrees of the turns that are shown."""


def go_to_lock(p: GimbalParams) -> Iterator[Step]:
    """The middle ring turns to 90°."""
    yield Step({"show_ghost": False}, 0.0)
    yield Step({"pitch": 90.0}, 1.2)


def same_motion(p: GimbalParams) -> Iterator[Step]:
    """At lock: the outer ring turns the aircraft away from its ghost, and the inner ring alone turns it back."""
    at = yield from _to_lock(p)
    yield _mark(at["yaw"], at["pitch"], at["roll"])
    yield from _turn(at, {"yaw": SWING}, 1.0)
    yield Step({}, 0.5)
    yield from _turn(at, {"roll": math.copysign(SWING, at["pitch"])}, 1.0)
    yield Step({"show_reach": p.show_reach}, 0.0)


def try_lost_axis(p: GimbalParams) -> Iterator[Step]:
    """At lock: a ghost turns about the lost axis, and no ring rates follow it; then, what it takes to get there.

    A quarter turn of the outer ring, and one of the inner ring, leave the aircraft where it is, but bring the middle
    ring's axis to where the lost one was.
    """
    at = yield from _to_lock(p)
    quarter = {"yaw": 90.0, "roll": math.copysign(90.0, at["pitch"])}
    yaw, roll = (_wrapped(at[name] + by) for name, by in quarter.items())
    aim = at["pitch"] - math.copysign(TRY, at["pitch"])
    yield _mark(yaw, at["pitch"], roll)
    yield Step({"ghost": (yaw, aim, roll)}, 1.2)
    yield Step({}, 1.6)
    yield from _turn(at, quarter, 1.2)
    yield Step({}, 0.6)
    yield Step({"pitch": aim}, 1.0)
    yield Step({"show_reach": p.show_reach}, 0.0)


def mark(p: GimbalParams) -> Mapping[str, Any]:
    """A ghost stays where the aircraft is now."""
    return {"ghost": p.angles, "show_ghost": True}


def _mark(*ghost: float) -> Step:
    return Step({"ghost": ghost, "show_ghost": True, "show_reach": False}, 0.0)


def _to_lock(p: GimbalParams) -> Generator[Step, None, Angles]:
    """Turn the middle ring to the lock on its side, if it isn't at one; the angles there."""
    lock = math.copysign(90.0, p.pitch)
    if p.pitch != lock:
        yield Step({"show_ghost": False}, 0.0)
        yield Step({"pitch": lock}, 1.0)
        yield Step({}, 0.4)
    return {"yaw": p.yaw, "pitch": lock, "roll": p.roll}


def _turn(at: Angles, by: Mapping[str, float], seconds: float) -> Iterator[Step]:
    """Turn some rings together; one that comes to ±180° goes on from the other end of its slider."""
    left = 1.0
    while left > 0.0:
        over = [name for name, turn in by.items() if at[name] == math.copysign(180.0, turn)]
        at.update({name: -at[name] for name in over})
        if over:
            yield Step({name: at[name] for name in over}, 0.0)
        part = min(left, *((math.copysign(180.0, turn) - at[name]) / turn for name, turn in by.items()))
        at.update({name: round(at[name] + part * turn, 9) for name, turn in by.items()})
        yield Step({name: at[name] for name in by}, seconds * part)
        left = round(left - part, 12)


def _wrapped(degrees: float) -> float:
    """The same angle within ±180°."""
    return degrees if abs(degrees) <= 180.0 else math.remainder(degrees, 360.0)
