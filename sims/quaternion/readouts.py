"""Read-outs, and a sentence for people who listen."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from sims.kit.readout import Fold, Formula, Note, Readout, Table, figure, mathml, quantity, row, symbol
from sims.quaternion.params import BALL, COMPOSED, MATRIX, ORDER, PATH, SANDWICH, WHOLE, QuaternionParams
from sims.quaternion.scene import euler_in_words
from sims.quaternion.scene_ways import NAMES
from sims.quaternion.solution import QuaternionSolution

UNIT = 0.0005
"""An axis whose length differs from one by more is said to be put at length one."""
TIE = 1e-6
"""Degrees from half a turn within which neither way is the shorter one."""
Q, P, S, A, B = (symbol(name) for name in "qpsAB")
MINUS_Q = "<mrow><mo>−</mo><mi>q</mi></mrow>"
STAR = "<msup><mi>q</mi><mo>*</mo></msup>"
TIMES, DOT = "<mo>⊗</mo>", "<mo>·</mo>"


def caption(p: QuaternionParams, s: QuaternionSolution) -> str:
    """What to do, or what to see."""
    match p.topic:
        case "ball":
            return "Drag q: its direction is the axis n, its distance the angle. −q is opposite, and turns the same."
        case "point":
            return "Drag p, or move the angle: q p q* leads p to p′, on a circle about the axis."
        case "order":
            return "Play: the same two turns, A and B, but in the other order the object ends elsewhere."
        case "path" if p.long_way:
            return "q and −q end in one orientation, but the way to −q leads the other way round."
        case "path":
            return "Drag t, or play. At equal times SLERP’s marks are equally far apart; NLERP’s and Euler’s aren’t."
    if p.angle > WHOLE:
        return "Past a whole turn q is the −q of before. Go on to 720°: there it is q again."
    if p.angle == 0.0 and p.turns:
        return "The turn is made, and is the start now. Choose another axis and angle for the next one."
    return "Play, or pull θ round the axis twice: q goes half as far, so after one whole turn q has become −q."


def readouts(p: QuaternionParams, s: QuaternionSolution) -> Iterator[Readout]:
    """Numbers beside the scene."""
    yield from _key(p, s)
    yield Fold(BALL)
    yield from _ball(s)
    yield Fold(SANDWICH)
    yield from _sandwich(s)
    yield Fold(ORDER)
    yield from _order(s)
    yield Fold(PATH)
    yield from _way(p, s)
    yield Fold(COMPOSED)
    yield from _total(p, s)
    yield Fold(MATRIX)
    words = "Rotation matrix of the target, for q s and −q s alike"
    yield Formula(words, symbol("R"), mathml(s.R_total, roles=("x", "y", "z")))
    if p.show_euler:
        locked = " Gimbal lock: only one combination of yaw and roll matters." if s.euler_locked else ""
        yield Note(f"Euler angles of the target (ZYX): {euler_in_words(s)}.{locked}", "near" if locked else "info")


def _key(p: QuaternionParams, s: QuaternionSolution) -> Iterator[Readout]:
    if abs(s.length - 1.0) > UNIT and p.topic not in ("order", "path"):
        given, n = (", ".join(figure(v, 2) for v in axis) for axis in (p.axis, s.n.tolist()))
        yield Note(f"Your axis ({given}) has length {figure(s.length, 2)}. n = ({n}) has length 1.")
    name = Q if s.orders is None else A
    yield Formula("(cos θ/2, sin θ/2 · n) as (w, x, y, z)", name, row(s.q.tolist()), link="angle")
    if s.orders is not None:
        yield Formula("First A, then B", f"{B}{DOT}{A}", row(s.orders.a_first.tolist(), 2))
        yield Formula("First B, then A", f"{A}{DOT}{B}", row(s.orders.b_first.tolist(), 2))
    if p.topic == "point":
        yield Formula("Where p comes to, in m", f"{P}<mo>′</mo>", row(s.rotated_point.tolist()), link="point")
    if s.ways:
        yield Note(_ahead(p, s))
    if (words := _round(p)) and p.topic in ("turn", "ball"):
        yield Note(words)


def _round(p: QuaternionParams) -> str:
    """What is special about an angle."""
    match p.angle:
        case 0.0:
            return "No angle: q is 1, and the target is the start."
        case 360.0:
            return "A whole turn: q is −1, which turns like 1. The object stands where it started."
        case 720.0:
            return "Two whole turns: q is 1 again."
    if p.angle < WHOLE:
        return ""
    return f"θ is a whole turn and {quantity(p.angle - WHOLE, '°', 0)}: the same turn as that, with the opposite q."


def _ball(s: QuaternionSolution) -> Iterator[Readout]:
    yield Note("Each turn has its place: in the direction of its axis, at the distance tan θ/4 from the middle.")
    yield Note("On the way to 360° q runs away; it comes back from the other side, and is in the middle again at 720°.")
    yield Formula("Turns the same", MINUS_Q, row((-s.q).tolist()))
    yield Formula("Axis, at length one", symbol("n"), row(s.n.tolist()), link="axis")


def _order(s: QuaternionSolution) -> Iterator[Readout]:
    if s.orders is None:
        return
    yield Note("What stands on the right turns first, as in B(A(object)). Both axes stay in the world.")
    if s.orders.alike:
        yield Note("Here both orders end the same, as they do for turns about one axis.")
    else:
        yield Note(f"The two ends are {quantity(s.orders.apart, '°', 1)} apart: B·A isn’t A·B.")


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


def _ahead(p: QuaternionParams, s: QuaternionSolution) -> str:
    ahead = "ahead of" if s.lead >= 0.0 else "behind"
    return f"At t = {figure(p.t, 2)}, NLERP is {quantity(abs(s.lead), '°', 2)} {ahead} SLERP."


def _way(p: QuaternionParams, s: QuaternionSolution) -> Iterator[Readout]:
    if not s.ways:
        return
    which = "long" if p.long_way else "short"
    axis = ", ".join(figure(v, 2) for v in s.way_axis.tolist())
    yield Note(f"SLERP and NLERP go the {which} way: {quantity(s.way_angle, '°', 1)} about ({axis}).")
    if abs(s.way_angle - 180.0) < TIE:
        yield Note("Half a turn from start to target: both ways are equally long.", "near")
    turned = [(NAMES[name], quantity(way.turned, "°", 1)) for name, way in s.ways.items()]
    yield Table(f"Away from the start at t = {figure(p.t, 2)}", [("", "turned"), *turned])
    words = f"The object at t by {NAMES[p.interpolation]}"
    yield Formula(words, symbol("q", "t"), row(s.interpolated.q.tolist()))


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
