"""Read-outs, and a sentence for people who listen."""

from __future__ import annotations

from collections.abc import Iterator

from sims.euler_angles.params import NEAR_LOCK, EulerParams
from sims.euler_angles.solution import EulerSolution
from sims.kit.readout import Fold, Formula, Note, Readout, figure, mathml, quantity, row, symbol

FACTORS, FORMS = "The three turns", "The same rotation, otherwise"
AXES = ("x", "y", "z")


def caption(p: EulerParams, s: EulerSolution) -> str:
    """What to do, or what to see."""
    if s.locked:
        return "Gimbal lock: the first and the third turn are about one line. Move both: one combination is left."
    if p.progress < 3.0:
        whose = "its own" if p.frame == "intrinsic" else "the fixed"
        return f"Turn {min(int(p.progress) + 1, 3)} of 3, about {whose} axis."
    own = "the axis that the aircraft has by then" if p.frame == "intrinsic" else "a fixed axis of the world"
    return f"Move one angle and see which axis the aircraft turns about: {own}."


def readouts(p: EulerParams, s: EulerSolution) -> Iterator[Readout]:
    """Numbers beside the scene."""
    if s.locked:
        yield Note(f"Gimbal lock: the first and third axes coincide. Only {_sum(p)} matters.", "warn")
    elif s.lock_distance < NEAR_LOCK:
        yield Note(
            f"{quantity(s.lock_distance, '°', 1)} from gimbal lock: first and third axes almost coincide.",
            "near",
        )
    else:
        yield Note(f"{quantity(s.lock_distance, '°', 1)} from gimbal lock.")
    names = " ".join(f"R{f['axis']}({quantity(f['angle'], '°', 0)})" for f in s.factors)
    yield Formula(f"Rotation: {names}", symbol("R"), mathml(s.R, roles=AXES))
    if p.progress < 3.0:
        yield Formula(f"Aircraft now, after {figure(p.progress, 2)} turns", symbol("R", "now"), mathml(s.R_progress))
    yield Fold(FACTORS)
    turns = p.names if p.frame == "intrinsic" else p.names[::-1]
    for factor, turn in zip(s.factors, turns, strict=True):
        yield Formula(
            f"Turn about {factor['axis']} by {quantity(factor['angle'], '°', 1)}",
            symbol("R", factor["axis"]),
            mathml(factor["R"]),
            link=turn,
        )
    yield Fold(FORMS)
    yield Formula("Quaternion (w, x, y, z)", symbol("q"), row(s.quaternion.tolist()))
    yield Formula("Axis", symbol("n"), row(s.axis_angle["axis"].tolist()))
    yield Formula("Angle about it", symbol("θ"), mathml(s.axis_angle["angle"], 2), "°")
    got = ", ".join(f"{n} {quantity(a, '°', 2)}" for n, a in s.recovered.items())
    zero = " (at lock the third is set to zero)" if s.locked else ""
    yield Note(f"Angles read back from R: {got}{zero}.")


def _sum(p: EulerParams) -> str:
    first, _, third = p.names
    return f"one combination of {first} and {third}"


def describe(p: EulerParams, s: EulerSolution) -> str:
    """One sentence for people who listen."""
    angles = ", ".join(f"{n} {quantity(a, '°', 0)}" for n, a in zip(p.names, p.angles, strict=True))
    lock = "at gimbal lock" if s.locked else f"{quantity(s.lock_distance, '°', 0)} from gimbal lock"
    return f"{p.order.upper()} {p.frame}: {angles}; {lock}."
