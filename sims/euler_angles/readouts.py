"""Read-outs, and a sentence for people who listen."""

from __future__ import annotations

from collections.abc import Iterator

from sims.euler_angles.actions import turn_words
from sims.euler_angles.forms import forms
from sims.euler_angles.names import POSITIVE
from sims.euler_angles.params import NEAR_LOCK, EulerParams
from sims.euler_angles.solution import EulerSolution
from sims.kit.readout import Fold, Formula, Note, Readout, figure, mathml, quantity, row, symbol

FACTORS, FORMS = "The three turns", "The same rotation, in all forms"
AXES = ("x", "y", "z")


def caption(p: EulerParams, s: EulerSolution) -> str:
    """What to do, or what to see."""
    if s.locked:
        first, third = p.turns[0].word, p.turns[2].word
        return f"Gimbal lock: {first} and {third} turn about one line. Move both: one combination is left."
    if p.progress < 3.0:
        return turn_words(p, min(int(p.progress), 2))
    own = "the axis it has by then" if p.frame == "intrinsic" else "a fixed axis of the world"
    return f"Pull the aircraft, or the end of an arc. Each turn is about {own}."


def readouts(p: EulerParams, s: EulerSolution) -> Iterator[Readout]:
    """Numbers beside the scene."""
    yield from _lock(p, s)
    if s.target is not None:
        yield Note(f"The target is {quantity(s.target.angle, '°', 1)} away.")
    yield Formula("The factors, in the order of the product", "", _factors(p, s))
    if p.progress < 3.0:
        yield Formula("What they make so far", _so_far(p), mathml(s.R_progress, roles=AXES))
    else:
        yield Formula("The rotation that they make", symbol("R"), mathml(s.R, roles=AXES))
    if p.progress >= 3.0 and s.set_otherwise(p):
        yield Note(f"Read back from R: {_angles(p, s)}. Another triple, one rotation: two triples give each.")
    if not p.proper and p.progress >= 3.0 and p.pitch > 0.0 and not s.locked:
        yield Note(f"Positive pitch {POSITIVE['y']}.")
    yield Fold(FACTORS)
    turns = p.names if p.frame == "intrinsic" else p.names[::-1]
    for factor, turn in zip(s.factors, turns, strict=True):
        yield Formula(
            f"Turn about {factor['axis'].upper()} by {quantity(factor['angle'], '°', 1)}",
            symbol("R", factor["axis"]),
            mathml(factor["R"]),
            link=turn,
        )
    yield Fold(FORMS)
    if p.progress < 3.0:
        yield Formula("The whole rotation, when all turns are made", symbol("R"), mathml(s.R, roles=AXES))
    yield Formula("Quaternion (w, x, y, z)", symbol("q"), row(s.quaternion.tolist()))
    yield Formula("Axis", symbol("n"), row(s.axis_angle["axis"].tolist()))
    yield Formula("Angle about it", symbol("θ"), mathml(s.axis_angle["angle"], 2), "°")
    yield Note(f"Angles read back from R: {_angles(p, s)}{' (at lock the third is set to zero)' if s.locked else ''}.")
    yield from forms(p, s)


def _lock(p: EulerParams, s: EulerSolution) -> Iterator[Note]:
    away = quantity(s.lock_distance, "°", 1)
    if s.left is not None:
        first, _, third = p.turns
        both = f"{first.symbol} {'+' if s.left.sign > 0 else '−'} {third.symbol}"
        kind = "sum" if s.left.sign > 0 else "difference"
        left = f"Only the {kind} {both} = {quantity(s.left.angle, '°', 1)} counts."
        yield Note(f"Gimbal lock: the first and third axes coincide. {left}", "warn")
    elif s.lock_distance < NEAR_LOCK:
        yield Note(f"{away} from gimbal lock: first and third axes almost coincide.", "near")


def _factors(p: EulerParams, s: EulerSolution) -> str:
    """R_z(30°) R_y(20°) R_x(10°): by how much each is made by now; the one at work stands out, later ones are faint."""
    shown = []
    for k, turn in enumerate(s.turns):
        kind = "s3-now" if turn.current else "s3-later" if p.progress <= k else "s3-made"
        sub = f"<msub><mi>R</mi><mi>{p.order[k]}</mi></msub>"
        angle = f"<mo>(</mo><mn>{quantity(turn.applied, '°', 0)}</mn><mo>)</mo>"
        shown.append(f'<mrow class="{kind}" data-link="{p.names[k]}">{sub}{angle}</mrow>')
    return "".join(shown if p.frame == "intrinsic" else shown[::-1])


def _so_far(p: EulerParams) -> str:
    """The product of the turns that are made or being made."""
    made = [symbol("R", axis) for k, axis in enumerate(p.order) if p.progress > k]
    return "".join(made if p.frame == "intrinsic" else made[::-1]) or symbol("I")


def _angles(p: EulerParams, s: EulerSolution) -> str:
    return ", ".join(f"{turn.said} {quantity(s.recovered[turn.parameter], '°', 2)}" for turn in p.turns)


def describe(p: EulerParams, s: EulerSolution) -> str:
    """One sentence for people who listen."""
    angles = ", ".join(f"{turn.word} {quantity(a, '°', 0)}" for turn, a in zip(p.turns, p.angles, strict=True))
    lock = "at gimbal lock" if s.locked else f"{quantity(s.lock_distance, '°', 0)} from gimbal lock"
    made = f"; {figure(p.progress, 2)} of 3 turns are made" if p.progress < 3.0 else ""
    return f"{p.order.upper()} {p.frame}: {angles}; {lock}{made}."
