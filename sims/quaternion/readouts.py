"""Read-outs, and a sentence for people who listen."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sims.kit.readout import Fold, Formula, Note, Readout, Table, figure, mathml, quantity, row, symbol
from sims.quaternion.params import COMPOSED, MATRIX, PATH, SANDWICH, QuaternionParams
from sims.quaternion.scene import NAMES, euler_in_words
from sims.quaternion.solution import QuaternionSolution

UNIT = 0.0005
"""An axis whose length differs from one by more is said to be put at length one."""
TIE = 1e-6
"""Degrees from half a turn within which neither way is the shorter one."""
Q, P, S = symbol("q"), symbol("p"), symbol("s")
MINUS_Q = "<mrow><mo>−</mo><mi>q</mi></mrow>"
STAR = "<msup><mi>q</mi><mo>*</mo></msup>"
TIMES = "<mo>⊗</mo>"


def caption(p: QuaternionParams, s: QuaternionSolution) -> str:
    """What to do, or what to see."""
    if p.angle == 0.0:
        return "Turn the angle up and watch w fall: a quaternion holds half of the angle."
    if p.long_way:
        return "q and −q end in one orientation, but the way to −q leads the other way round."
    if p.turns:
        return "The start is what the turns before made. Another order of the same turns may end elsewhere."
    return "Move the angle, or drag the axis’s tip n: w is cos θ/2, and x, y, z are the axis times sin θ/2."


def readouts(p: QuaternionParams, s: QuaternionSolution) -> Iterator[Readout]:
    """Numbers beside the scene."""
    if abs(s.length - 1.0) > UNIT:
        given = ", ".join(figure(v, 2) for v in p.axis)
        yield Note(f"Your axis ({given}) has length {figure(s.length, 2)}. Its direction n has length 1.")
    yield Formula("Quaternion (cos θ/2, sin θ/2 · n) as (w, x, y, z)", Q, row(s.q.tolist()), link="angle")
    yield Formula("Turns the same", MINUS_Q, row((-s.q).tolist()))
    yield Formula("Axis, at length one", symbol("n"), row(s.n.tolist()), link="axis")
    yield from _status(p, s)
    yield Fold(PATH)
    yield from _way(p, s)
    yield Fold(COMPOSED)
    yield from _total(p, s)
    yield Fold(SANDWICH)
    yield from _sandwich(s)
    yield Fold(MATRIX)
    words = "Rotation matrix of the target, for q s and −q s alike"
    yield Formula(words, symbol("R"), mathml(s.R_total, roles=("x", "y", "z")))
    if p.show_euler:
        locked = " Gimbal lock: only one combination of yaw and roll matters." if s.euler_locked else ""
        yield Note(f"Euler angles of the target (ZYX): {euler_in_words(s)}.{locked}", "near" if locked else "info")


def _status(p: QuaternionParams, s: QuaternionSolution) -> Iterator[Readout]:
    if p.angle == 0.0:
        yield Note("No angle: q is 1, and the target is the start.")
    elif p.angle == 360.0:
        yield Note("A whole turn: q is −1, which turns like 1. The target is the start.", "near")
    if abs(s.way_angle - 180.0) < TIE:
        yield Note("Half a turn from start to target: both ways are equally long.", "near")


def _total(p: QuaternionParams, s: QuaternionSolution) -> Iterator[Readout]:
    yield Formula("Start", S, row(s.start.tolist()))
    yield Formula("Target: first s, then q", f"{Q}{TIMES}{S}", row(s.q_total.tolist()))
    rows: list[Sequence[str]] = [("q ⊗ s", "w", "x", "y", "z", "sum")]
    for name, terms, total in zip("wxyz", s.terms.tolist(), s.q_total.tolist(), strict=True):
        rows.append((name, *(figure(v, 2) for v in terms), figure(total, 2)))
    yield Table("Each term of the product: columns by q’s part", rows)
    if p.turns:
        yield Table("Turns made", [("", "axis", "angle"), *(_turn(k, t) for k, t in enumerate(p.turns, 1))])


def _turn(k: int, turn: Sequence[float]) -> tuple[str, str, str]:
    *axis, angle = turn
    return f"{k}.", f"({', '.join(_short(v) for v in axis)})", quantity(angle, "°", 0)


def _short(value: float) -> str:
    return figure(value, 0 if value == round(value) else 2)


def _way(p: QuaternionParams, s: QuaternionSolution) -> Iterator[Readout]:
    if p.interpolation == "euler":
        yield Note("Euler angles: yaw, pitch and roll each go their own way. The object does not turn about one axis.")
    else:
        which = "long" if p.long_way else "short"
        axis = ", ".join(figure(v, 2) for v in s.way_axis.tolist())
        yield Note(f"The {which} way: {quantity(s.way_angle, '°', 1)} about ({axis}).")
    yield Formula(
        f"Object at t = {figure(p.t, 2)} by {NAMES[p.interpolation]}",
        symbol("q", "t"),
        row(s.interpolated.q.tolist()),
    )
    ahead = "ahead of" if s.lead >= 0.0 else "behind"
    yield Note(f"At this t, NLERP is {quantity(abs(s.lead), '°', 2)} {ahead} SLERP.")


def _sandwich(s: QuaternionSolution) -> Iterator[Readout]:
    steps = {name: row(q.tolist()) for name, q in s.sandwich.items()}
    yield Formula("Point p as a quaternion", P, steps["p"])
    yield Formula("From the left by q", f"{Q}{P}", steps["q_p"])
    yield Formula("From the right by q’s conjugate (w, −x, −y, −z)", f"{Q}{P}{STAR}", steps["rotated"])


def describe(p: QuaternionParams, s: QuaternionSolution) -> str:
    """One sentence."""
    n = ", ".join(figure(v, 2) for v in s.n.tolist())
    q = ", ".join(figure(v, 2) for v in s.q.tolist())
    made = f"after {len(p.turns)} turn{'s' if len(p.turns) > 1 else ''}, " if p.turns else ""
    euler = f"; {euler_in_words(s)}" if p.show_euler else ""
    way = f"{NAMES[p.interpolation]}{', long way' if p.long_way else ''} at t {figure(p.t, 2)}"
    sentence = f"{made}{quantity(p.angle, '°', 0)} about ({n}): q is {q}{euler}; {way}."
    return sentence[0].upper() + sentence[1:]
