"""What buttons and handles do: each button shows a cause before its effect, and says what is to be seen.

While a motion is compared with a ghost, the ellipsoid is out of the way.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Iterator, Mapping
from typing import Any

import numpy as np

from geometry import euler, gimbal
from geometry.arrays import Array
from sims.gimbal_lock.params import GimbalParams
from sims.gimbal_lock.rings import RINGS, Ring
from sims.kit.sim import Step
from sims.kit.types import Vector

Angles = dict[str, float]
Handle = Callable[[GimbalParams, tuple[float, ...]], Mapping[str, Any]]
AIRCRAFT = "/aircraft"
"""The aircraft, wherever it is taken."""
SWING, TRY = 40.0, 30.0
"""Degrees of the turns that are shown."""
READ = 1.8
"""Seconds in which a sentence is read."""
ON_AXIS = 1e-6
"""Metres from its axis within which a place doesn't say how a ring is turned."""
STIFF, ROUNDS = 0.1, 8
"""Below which effect on the held spot, in parts of its lever, a ring is left where it is; and steps to the place."""
LINED_UP = "At lock, the outer and the inner ring turn about one and the same line."


def turning(ring: Ring) -> Handle:
    """The ring turns about its axis until its grip points to a place in the world."""
    rest, rest_across = _about(ring, ring.held)

    def turn(p: GimbalParams, place: tuple[float, ...]) -> Mapping[str, Any]:
        along, across = _about(ring, _holder(ring, p).T @ place)
        if math.hypot(along, across) < ON_AXIS:
            return {}
        turned = math.degrees(math.atan2(across, along) - math.atan2(rest_across, rest))
        return {ring.angle: _wrapped(turned)}

    return turn


def _holder(ring: Ring, p: GimbalParams) -> Array:
    """Orientation in the world of what holds a ring."""
    outside = RINGS[: RINGS.index(ring)]
    turns = [math.radians(angle) if k < len(outside) else 0.0 for k, angle in enumerate(p.angles)]
    return euler.euler_to_matrix(turns, "zyx", "intrinsic")


def _about(ring: Ring, place: Vector) -> tuple[float, float]:
    """The two coordinates of a place across a ring's axis, of which the second is a quarter turn ahead."""
    axis = "xyz".index(ring.letter)
    return float(place[(axis + 1) % 3]), float(place[(axis + 2) % 3])


def pull(p: GimbalParams, held: tuple[float, ...]) -> Mapping[str, Any]:
    """A spot of the aircraft, in its own frame, was pulled to a place in the world: the rings turn it there.

    They turn as little as they need, and bring it as near as they can: at lock a pull about the lost axis turns none.
    """
    spot, place = np.reshape(held, (2, 3))
    turns = np.radians(p.angles)
    give = (STIFF**2) * float(spot @ spot) + ON_AXIS**2
    for _ in range(ROUNDS):
        at = euler.euler_to_matrix(turns, "zyx", "intrinsic") @ spot
        moves = np.cross(gimbal.ring_axes(turns[0], turns[1]).T, at).T  # columns: how each ring would move the spot
        turns += moves.T @ np.linalg.solve(moves @ moves.T + give * np.eye(3), place - at)
    return {ring.angle: _wrapped(angle) for ring, angle in zip(RINGS, np.degrees(turns).tolist(), strict=True)}


def set_size_of_pitch(p: GimbalParams, values: tuple[float, ...]) -> Mapping[str, Any]:
    """The mark of the plot was moved: how far the middle ring is turned, to the side on which it is."""
    return {"pitch": math.copysign(min(max(values[0], 0.0), 180.0), p.pitch)}


HANDLES: Mapping[str, Handle] = {
    **{ring.grip: turning(ring) for ring in RINGS},
    AIRCRAFT: pull,
    "effort": set_size_of_pitch,
}


def go_to_lock(p: GimbalParams) -> Iterator[Step]:
    """The middle ring turns to 90°."""
    words = "The middle ring turns, and carries the inner ring’s axis towards the outer one’s."
    yield Step({"show_ghost": False}, 0.0, words=words)
    yield Step({"pitch": 90.0}, 1.6, words=words)


def same_motion(p: GimbalParams) -> Iterator[Step]:
    """At lock: the outer ring turns the aircraft away from its ghost, and the inner ring alone turns it back."""
    at = yield from _to_lock(p)
    away = "The outer ring turns by 40°: the aircraft leaves its ghost."
    yield _mark(away, at["yaw"], at["pitch"], at["roll"])
    yield from _turn(at, {"yaw": SWING}, 1.2, away)
    yield Step({}, 0.8, words=away)
    back = "Now the inner ring alone turns by 40°, and the aircraft is back where it was."
    yield from _turn(at, {"roll": math.copysign(SWING, at["pitch"])}, 1.2, back)
    yield Step({}, READ, words="Other ring angles, same orientation: two rings make one and the same motion.")
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
    wish = "The ghost turns by 30° about the lost axis. No ring can follow it."
    yield _mark(wish, yaw, at["pitch"], roll)
    yield Step({"ghost": (yaw, aim, roll)}, 1.4, words=wish)
    yield Step({}, READ, words=wish)
    detour = "The detour: two rings make a quarter turn, and the aircraft does not move at all."
    yield from _turn(at, quarter, 1.6, detour)
    yield Step({}, 1.2, words=detour)
    there = "Only now does the middle ring’s axis lie where the lost one was: it turns, and the aircraft follows."
    yield Step({"pitch": aim}, 1.4, words=there)
    yield Step({}, READ, words=there)
    yield Step({"show_reach": p.show_reach}, 0.0)


def mark(p: GimbalParams) -> Mapping[str, Any]:
    """A ghost stays where the aircraft is now."""
    return {"ghost": p.angles, "show_ghost": True}


def _mark(words: str, *ghost: float) -> Step:
    return Step({"ghost": ghost, "show_ghost": True, "show_reach": False}, 0.0, words=words)


def _to_lock(p: GimbalParams) -> Generator[Step, None, Angles]:
    """Turn the middle ring to the lock on its side, if it isn't at one; the angles there."""
    lock = math.copysign(90.0, p.pitch)
    if p.pitch != lock:
        yield Step({"show_ghost": False}, 0.0, words=LINED_UP)
        yield Step({"pitch": lock}, 1.2, words=LINED_UP)
        yield Step({}, 1.0, words=LINED_UP)
    return {"yaw": p.yaw, "pitch": lock, "roll": p.roll}


def _turn(at: Angles, by: Mapping[str, float], seconds: float, words: str) -> Iterator[Step]:
    """Turn some rings together; one that comes to ±180° goes on from the other end of its slider."""
    left = 1.0
    while left > 0.0:
        over = [name for name, turn in by.items() if at[name] == math.copysign(180.0, turn)]
        at.update({name: -at[name] for name in over})
        if over:
            yield Step({name: at[name] for name in over}, 0.0, words=words)
        part = min(left, *((math.copysign(180.0, turn) - at[name]) / turn for name, turn in by.items()))
        at.update({name: round(at[name] + part * turn, 9) for name, turn in by.items()})
        yield Step({name: at[name] for name in by}, seconds * part, words=words)
        left = round(left - part, 12)


def _wrapped(degrees: float) -> float:
    """The same angle within ±180°."""
    return degrees if abs(degrees) <= 180.0 else math.remainder(degrees, 360.0)
