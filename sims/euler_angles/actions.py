"""What buttons, handles and a pasted rotation do to a state."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from sims.euler_angles.names import PLACES
from sims.euler_angles.params import EulerParams
from sims.euler_angles.solution import arc_frames, solve, triple_of
from sims.kit.pull import LEAST, pulled
from sims.kit.sim import Step
from sims.kit.types import Place

Handle = Callable[[EulerParams, tuple[float, ...]], Mapping[str, Any]]
ARCS = ("/held_first", "/held_second", "/held_third")
BODY = {"/held_nose": (1.0, 0.0, 0.0), "/held_wing": (0.0, 1.0, 0.0)}
"""Where nose and left wing are on the aircraft."""
WHOLE = "/aircraft"
"""The aircraft, wherever it is taken."""


def animate(p: EulerParams) -> Iterator[Step]:
    """The three turns one after another."""
    words = [turn_words(p, k) for k in range(3)]
    yield Step({"progress": 0.0}, 0.0, words=words[0])
    for k, said in enumerate(words, start=1):
        yield Step({"progress": float(k)}, 1.2, words=said)
        yield Step({"progress": float(k)}, 0.6, words=said)


def turn_words(p: EulerParams, k: int) -> str:
    """Which turn the k-th is, in a sentence."""
    whose = "the aircraft’s own" if p.frame == "intrinsic" else "the world’s fixed"
    return f"{PLACES[k]} turn: {p.turns[k].said}, about {whose} {p.turns[k].axis}."


def arc(k: int) -> Handle:
    """The end of the k-th arc was led to a place in the world: the turn goes as far, at most half round at once."""

    def pull(p: EulerParams, place: tuple[float, ...]) -> Mapping[str, Any]:
        along, across, _ = arc_frames(p)[k].T @ place
        if math.hypot(along, across) < LEAST:
            return {}
        name, now = p.names[k], p.angles[k]
        angle = now + math.remainder(math.degrees(math.atan2(across, along)) - now, 360.0)
        low, high = p.bounds(name)
        return {name: math.remainder(angle, 360.0) if high - low == 360.0 else min(max(angle, low), high)}

    return pull


def body(spot: Place) -> Handle:
    """A spot of the aircraft was pulled towards a place in the world: the shortest turn brings it there."""
    return lambda p, place: hold(p, (*spot, *place))


def hold(p: EulerParams, held: tuple[float, ...]) -> Mapping[str, Any]:
    """The same of any spot: where it is on the aircraft, then where in the world it goes."""
    R = pulled(solve(p).R_progress, held)
    return {} if R is None else {"progress": 3.0, **triple_of(p, R)}


HANDLES: Mapping[str, Handle] = {
    **{name: arc(k) for k, name in enumerate(ARCS)},
    **{name: body(spot) for name, spot in BODY.items()},
    WHOLE: hold,
}


def take(p: EulerParams, found: Mapping[str, Any]) -> Mapping[str, Any]:
    """A rotation that was recognised: in its own order, where it has one, with the angles that were given."""
    whole = p.changed({"progress": 3.0})
    if "order" not in found:
        return {"progress": 3.0, **triple_of(whole, np.array(found["R"]))}
    own = whole.moved({"order": found["order"], "frame": found["frame"]})
    angles = dict(zip(own.names, found["angles"], strict=True))
    within = all(own.bounds(name)[0] <= angle <= own.bounds(name)[1] for name, angle in angles.items())
    if not within:
        angles = triple_of(own, np.array(found["R"]))
    return {"progress": 3.0, "order": own.order, "frame": own.frame, **angles}
