"""Read-outs, a sentence for people who listen, and the plot."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from sims.gimbal_lock.params import GimbalParams
from sims.gimbal_lock.solution import Ghost, GimbalSolution, Reduced
from sims.kit.readout import Fold, Formula, Note, Readout, figure, mathml, quantity, row, symbol

SAME = 0.005
"""Degrees between two orientations that count as one."""
STILL = 1e-9
"""Ring rates, for 1°/s, that count as none."""


RINGS, ROTATION = "How far from lock", "The rotation"


def caption(p: GimbalParams, s: GimbalSolution) -> str:
    """What to do, or what to see."""
    if s.lost_axis is not None:
        return "Two rings now turn about one line. Move yaw, then roll: they do the same, and one way to turn is gone."
    if s.near:
        return "Bring the middle ring to 90°, and see the ellipsoid flatten: what the rings can do shrinks to a disc."
    return "Three rings, three ways to turn. Move the middle one towards 90° and watch the axes of the other two."


def readouts(p: GimbalParams, s: GimbalSolution) -> Iterator[Readout]:
    """Numbers beside the scene."""
    yield _status(s)
    if s.ghost is not None:
        yield _beside_ghost(p, s, s.ghost)
    yield Formula("Degrees of freedom: singular values that aren't zero", symbol("dof"), mathml(s.dof, 0))
    links = (("yaw", "pitch", "roll"),) * 3
    yield Formula(
        "Ring axes in the world: outer, middle, inner", symbol("J"),
        mathml(s.axes, roles=("z", "y", "x"), links=links),
    )  # fmt: skip
    if s.reduced is not None:
        yield from _reduced(s.reduced)
    yield Fold(RINGS)
    yield Formula("Singular values of J", symbol("σ"), row(s.singular_values.tolist()))
    yield Formula("Conditioning: |det J| = |cos θ|", symbol("c"), mathml(s.conditioning))
    yield _effort(s)
    yield Fold(ROTATION)
    yield Formula("Rotation: Rz(ψ) Ry(θ) Rx(φ)", symbol("R"), mathml(s.R, roles=("x", "y", "z")))


def _status(s: GimbalSolution) -> Note:
    least = figure(s.singular_values.item(2))
    if s.lost_axis is not None:
        return Note("Gimbal lock: outer and inner ring turn about one line. One degree of freedom is lost.", "warn")
    if s.near:
        rate = quantity(s.effort, "°/s", 1)
        return Note(f"Near gimbal lock: for 1°/s about the weakest axis, two rings must turn at {rate}.", "near")
    return Note(f"The smallest singular value of J is {least}: far from 0, and far from lock.")


def _beside_ghost(p: GimbalParams, s: GimbalSolution, ghost: Ghost) -> Note:
    if ghost.angle <= SAME:
        if all(abs(math.remainder(a - b, 360.0)) < SAME for a, b in zip(p.angles, p.ghost, strict=True)):
            return Note("The aircraft is where its ghost is.")
        names = zip(("yaw", "pitch", "roll"), p.ghost, strict=True)
        marked = ", ".join(f"{name} {quantity(a, '°', 0)}" for name, a in names)
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


def _reduced(lock: Reduced) -> Iterator[Readout]:
    sign = "−" if lock.end > 0 else "+"
    both = f"<mo>(</mo><mi>ψ</mi><mo>{sign}</mo><mi>φ</mi><mo>)</mo>"
    combined = f"<mi>ψ</mi><mo>{sign}</mo><mi>φ</mi>"
    word = "difference" if lock.end > 0 else "sum"
    yield Formula(f"Of yaw and roll only the {word} is left in R", combined, mathml(lock.angle, 1), "°")
    yield Formula(f"R at this lock, with ψ {sign} φ alone", symbol("R"), _pattern(lock.end, both))


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
    angles = ", ".join(f"{n} {quantity(a, '°', 0)}" for n, a in zip(("yaw", "pitch", "roll"), p.angles, strict=True))
    if s.lost_axis is not None:
        lost = ", ".join(figure(v, 2) for v in s.lost_axis.tolist())
        state = f"gimbal lock, {s.dof} degrees of freedom; no ring turns about {lost}"
    else:
        near = "near gimbal lock, " if s.near else ""
        state = f"{near}{s.dof} degrees of freedom, smallest singular value {figure(s.singular_values.item(2))}"
    ghost = f"; ghost {quantity(s.ghost.angle, '°', 1)} away" if s.ghost is not None else ""
    return f"Rings at {angles}: {state}{ghost}."
