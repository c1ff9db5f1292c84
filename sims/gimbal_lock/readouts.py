"""Read-outs, a sentence for people who listen, and the plot."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from sims.gimbal_lock import digits
from sims.gimbal_lock.params import LOCK, GimbalParams
from sims.gimbal_lock.solution import Ghost, GimbalSolution, Reduced
from sims.kit.readout import Fold, Formula, Lamps, Note, Readout, figure, mathml, quantity, row, symbol

SAME = 0.005
"""Degrees between two orientations that count as one."""
STILL = 1e-9
"""Ring rates, for 1°/s, that count as none."""
ROTATION = "The rotation"
"""A fold."""


def caption(p: GimbalParams, s: GimbalSolution) -> str:
    """What to do, or what to see."""
    if s.lost_axis is not None:
        return (
            "One lamp is out: outer and inner ring do the same. Pull the aircraft about the marked arrow: it won’t go."
        )
    if s.near:
        times = figure(s.effort, 0)
        return (
            f"A lamp goes dim: for a turn about the dashed line, the rings must turn {times}× as fast as the aircraft."
        )
    return "Three rings, three ways to turn. Drag the knob of the middle one towards 90°, and watch the lamps."


def readouts(p: GimbalParams, s: GimbalSolution) -> Iterator[Readout]:
    """Numbers beside the scene."""
    yield Lamps(f"{s.dof} ways to turn", s.glow)
    yield from _status(s)
    if s.ghost is not None:
        yield _beside_ghost(p, s, s.ghost)
    yield Formula("Fastest ring, per 1°/s about the hardest axis", symbol("q̇", "max"), _times(s), "°/s")
    if s.reduced is not None:
        yield _combined(s.reduced)
    yield Fold(LOCK)
    yield Formula("Degrees of freedom: singular values that aren't zero", symbol("dof"), mathml(s.dof, 0))
    links = (("yaw", "pitch", "roll"),) * 3
    yield Formula(
        "Ring axes in the world: outer, middle, inner", symbol("J"),
        mathml(s.axes, roles=("z", "y", "x"), links=links),
    )  # fmt: skip
    yield Formula("Singular values of J: how brightly each lamp is lit", symbol("σ"), _row(s.singular_values.tolist()))
    yield Formula("Conditioning: |det J| = |cos θ|", symbol("c"), f"<mn>{digits.small(s.conditioning)}</mn>")
    yield _effort(s)
    yield Fold(ROTATION)
    yield Formula("Rotation: Rz(ψ) Ry(θ) Rx(φ)", symbol("R"), mathml(s.R, roles=("x", "y", "z")))
    if s.reduced is not None:
        yield _pattern_of(s.reduced)


def _status(s: GimbalSolution) -> Iterator[Note]:
    if s.lost_axis is not None:
        yield Note("Gimbal lock: outer and inner ring turn about one line.", "warn")
    elif s.near:
        least = digits.small(s.singular_values.item(2))
        yield Note(f"Near gimbal lock: still 3 degrees of freedom, but the third is down to {least}.", "near")


def _times(s: GimbalSolution) -> str:
    """How fast the fastest ring turns; no speed is enough where an axis is lost."""
    return f"<mn>{figure(s.effort, 1)}</mn>" if s.lost_axis is None else "<mi>∞</mi>"


def _row(values: Sequence[float]) -> str:
    """A tuple of numbers from 0 on, in MathML."""
    inner = "<mo>,</mo>".join(f"<mn>{digits.small(v)}</mn>" for v in values)
    return f"<mrow><mo>(</mo>{inner}<mo>)</mo></mrow>"


def _beside_ghost(p: GimbalParams, s: GimbalSolution, ghost: Ghost) -> Note:
    if ghost.angle <= SAME:
        if all(abs(math.remainder(a - b, 360.0)) < SAME for a, b in zip(p.angles, p.ghost, strict=True)):
            return Note("The aircraft is where its ghost is.")
        names = zip(("yaw", "pitch", "roll"), p.ghost, strict=True)
        marked = ", ".join(f"{name} {digits.angle(a)}" for name, a in names)
        return Note(f"Same orientation as the ghost, which has other ring angles: {marked}.")
    away = f"The ghost is {quantity(ghost.angle, '°', 1)} away"
    if max(map(abs, ghost.rates.tolist())) < STILL:
        return Note(f"{away}, about the lost axis. No ring rates turn the aircraft towards it.", "warn")
    return Note(f"{away}. Best ring rates towards it, for 1°/s: {_rates(ghost.rates.tolist())}.")


def _effort(s: GimbalSolution) -> Formula:
    words = "Ring rates for 1°/s about the weakest axis: outer, middle, inner"
    if s.lost_axis is not None:
        words = "Best ring rates for 1°/s about the lost axis: no rates help, so all stand still"
    return Formula(words, symbol("q̇"), row(s.rates.tolist(), 2), "°/s")


def _rates(rates: Sequence[float]) -> str:
    return ", ".join(f"{name} {figure(v, 2)}" for name, v in zip(("outer", "middle", "inner"), rates, strict=True))


def _combined(lock: Reduced) -> Formula:
    combined = f"<mi>ψ</mi><mo>{_sign(lock)}</mo><mi>φ</mi>"
    word = "difference" if lock.end > 0 else "sum"
    return Formula(f"Of yaw and roll only the {word} is left in R", combined, mathml(lock.angle, 1), "°")


def _pattern_of(lock: Reduced) -> Formula:
    both = f"<mo>(</mo><mi>ψ</mi><mo>{_sign(lock)}</mo><mi>φ</mi><mo>)</mo>"
    return Formula(f"R at this lock, with ψ {_sign(lock)} φ alone", symbol("R"), _pattern(lock.end, both))


def _sign(lock: Reduced) -> str:
    return "−" if lock.end > 0 else "+"


def _pattern(end: int, both: str) -> str:
    """R in its reduced form, in symbols."""
    cos, sin = f"<mi>cos</mi>{both}", f"<mi>sin</mi>{both}"
    minus, zero = "<mo>−</mo>", "<mn>0</mn>"
    turn, other = ("", minus) if end > 0 else (minus, "")
    rows = ((zero, minus + sin, turn + cos), (zero, cos, turn + sin), (other + "<mn>1</mn>", zero, zero))
    cells = "".join("<mtr>" + "".join(f"<mtd>{cell}</mtd>" for cell in line) + "</mtr>" for line in rows)
    return f'<mtable class="s3-matrix">{cells}</mtable>'


def describe(p: GimbalParams, s: GimbalSolution) -> str:
    """One sentence."""
    angles = ", ".join(f"{n} {digits.angle(a)}" for n, a in zip(("yaw", "pitch", "roll"), p.angles, strict=True))
    if s.lost_axis is not None:
        lost = ", ".join(figure(v, 2) for v in s.lost_axis.tolist())
        state = f"gimbal lock, {s.dof} degrees of freedom; no ring turns about {lost}"
    else:
        near = "near gimbal lock, " if s.near else ""
        state = f"{near}{s.dof} degrees of freedom, smallest singular value {digits.small(s.singular_values.item(2))}"
    ghost = f"; ghost {quantity(s.ghost.angle, '°', 1)} away" if s.ghost is not None else ""
    return f"Rings at {angles}: {state}{ghost}."
