"""Read-outs, and a sentence for people who listen."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

from sims.epipolar.candidate import Candidate
from sims.epipolar.estimate import readouts as estimate_readouts
from sims.epipolar.own import readouts as own_readouts
from sims.epipolar.params import ESTIMATE, OTHERS, OWN, EpipolarParams, Pixel
from sims.epipolar.solution import EpipolarSolution
from sims.kit.frame import inside
from sims.kit.readout import (
    Fold,
    Formula,
    Note,
    Readout,
    Table,
    figure,
    mathml,
    quantity,
    row,
    significant,
    spelled,
    symbol,
)
from sims.kit.stereo import Size

MATRICES, LINES, POINTS = "F and E", "Pixels, lines and epipoles", "All points"
RIGHT_PIXEL = "<msup><mi>p</mi><mo>′</mo></msup>"
RIGHT_LINE = "<msup><mi>l</mi><mo>′</mo></msup>"
RIGHT_EPIPOLE = "<msup><mi>e</mi><mo>′</mo></msup>"
TRANSPOSED = "<msup>{}<mi>T</mi></msup>"
CANDIDATE = "<msup><mi>q</mi><mo>′</mo></msup>"
NUMBERS = tuple(f"{k}" for k in range(1, len(OTHERS) + 2))
THOUSANDTHS = "×10⁻³"
FARTHEST = 1e6
"""Pixels from which on an epipole's place is only said to be far."""


def unseen(s: EpipolarSolution) -> str:
    """By which cameras the point can't be seen, as it isn't in front of them: '' if in front of both."""
    sides = [side for side, depth in (("left", s.depth_left), ("right", s.depth_right)) if depth <= 0.0]
    return "either camera" if len(sides) == 2 else f"the {sides[0]} camera" if sides else ""


def baseline(s: EpipolarSolution) -> str:
    """How far the cameras are apart; those of somebody's pair in the unit of their T."""
    return f"baseline {quantity(s.baseline, 'm', 2) if s.own is None else f'{figure(s.own.baseline)} in T’s unit'}"


def short_trouble(s: EpipolarSolution) -> str | None:
    """What doesn't exist, in a few words."""
    if s.F is None:
        return "no baseline: no epipolar plane"
    if where := unseen(s):
        return f"P isn’t in front of {where}"
    return "P is on the baseline: no one plane" if s.on_baseline else None


def caption(p: EpipolarParams, s: EpipolarSolution) -> str:
    """What to do, or what to see."""
    if s.F is None:
        return "Both cameras are at one place: pull them apart, and there is an epipolar plane again."
    if s.candidate is not None:
        return judged(s.candidate)
    if s.picked is not None:
        return f"The pixel that you picked in the {s.picked.side} picture lies on a ray, which is a line in the other."
    if s.epipole_left_pixel is not None and inside(*s.epipole_left_pixel, *s.size_left):
        return "All lines run through the epipole: there each camera would see the other one."
    if s.trail is not None:
        return "P slid along one ray: p stayed where it is, and p′ ran along its line."
    if s.epipole_left_pixel is None and s.epipole_right_pixel is None:
        return "Both epipoles are at infinity, so all lines are parallel: slide P, and p′ runs along one of them."
    return "Slide P along the left ray: p stays where it is, and p′ runs along one line."


def judged(c: Candidate) -> str:
    """Whether q′ can be the partner of p, in one sentence."""
    match c.verdict:
        case "off the line":
            away = quantity(abs(c.distance or 0.0), "px", 1)
            return f"No point in space gives this pair: q′ is {away} off the line of p."
        case "a point":
            return "On the line of p: the two rays meet, so one point in space gives the pair of p and q′."
        case "at infinity":
            return "On the line of p, but the two rays are parallel: they meet at infinity."
        case "behind a camera":
            return "On the line of p, but the two rays part: they would meet behind a camera."
    return "There is no line of p in the right picture, so nothing can be said of q′."


def readouts(p: EpipolarParams, s: EpipolarSolution) -> Iterator[Readout]:
    """Numbers beside the scene."""
    yield from _status(s)
    yield from _constraint(s)
    yield Fold(MATRICES)
    yield from _matrices(s)
    yield Fold(LINES)
    yield from _pixels(s)
    yield from _lines(p, s)
    yield from _epipoles(s)
    yield Fold(POINTS)
    yield _points(p, s)
    yield Fold(ESTIMATE)
    yield from estimate_readouts(p, s.estimate)
    yield Fold(OWN)
    yield from own_readouts(s.own)


def _constraint(s: EpipolarSolution) -> Iterator[Formula]:
    """How q′, or where there is none p′, keeps the constraint."""
    c = s.candidate
    name, letter = (RIGHT_PIXEL, "p′") if c is None else (CANDIDATE, "q′")
    residual = s.residual if c is None else c.residual
    distance = None if residual is None else 0.0 if c is None else c.distance
    if residual is not None:
        constraint = f"{TRANSPOSED.format(name)}{symbol('F')}{symbol('p')}"
        yield Formula("Epipolar constraint", constraint, mathml(residual))
    if distance is not None:
        yield Formula(f"{letter} off the line of p", symbol("d"), mathml(abs(distance), 1), "px")
    if c is not None and c.gap is not None:
        yield Formula("Gap between the two rays", symbol("g"), mathml(c.gap), "m")


def _pixels(s: EpipolarSolution) -> Iterator[Formula]:
    for side, name, pixel in (("left", symbol("p"), s.pixel_left), ("right", RIGHT_PIXEL, s.pixel_right)):
        if pixel is not None:
            yield Formula(f"Pixel of P in the {side} picture", name, row(pixel, 2), "px")
    if s.sampson is not None:
        yield Formula("Sampson distance of p and p′", symbol("d", "S"), mathml(s.sampson), "px")


def _points(p: EpipolarParams, s: EpipolarSolution) -> Table:
    """Pixels of all points that are shown."""
    rows: list[tuple[str, ...]] = [("point", "u", "v", "u′", "v′")]
    for name, left, right in zip(("P", *NUMBERS[1:]), s.pixels_left.tolist(), s.pixels_right.tolist(), strict=False):
        rows.append((name, *_cells(*left, s.size_left), *_cells(*right, s.size_right)))
    words = "Points: left and right pixel; in brackets what is outside the picture"
    return Table(words, rows, NUMBERS, f"{p.selected}")


@lru_cache(maxsize=256)
def _cells(u: float, v: float, size: Size) -> tuple[str, str]:
    if u != u:
        return "–", "–"
    across, down = figure(u, 1), figure(v, 1)
    return (across, down) if inside(u, v, *size) else (f"({across})", f"({down})")


def _status(s: EpipolarSolution) -> Iterator[Note]:
    if s.F is None:
        yield Note(
            "Both cameras are at one place: without a baseline there is no epipolar plane, and F and E don’t exist.",
            "warn",
        )
    if where := unseen(s):
        yield Note(f"P isn’t in front of {where}, and has no pixel there.", "warn")
    if s.on_baseline:
        yield Note("P is on the line through both centres: every plane through it would do, so P has no line.", "warn")
    for side, pixel, size in (("left", s.pixel_left, s.size_left), ("right", s.pixel_right, s.size_right)):
        if pixel is not None and not inside(*pixel, *size):
            yield Note(f"P is outside the {side} picture.", "near")


def _matrices(s: EpipolarSolution) -> Iterator[Readout]:
    if s.F is None or s.E is None or s.singular_values is None:
        return
    yield Formula("Fundamental matrix, of norm 1", symbol("F"), significant(s.F), copy=spelled(s.F))
    yield Formula(
        f"Singular values of F: rank {s.rank}", symbol("σ"), row((1e3 * s.singular_values).tolist()), THOUSANDTHS
    )
    yield Formula("Essential matrix, of norm 1", symbol("E"), mathml(s.E), copy=spelled(s.E))


def _lines(p: EpipolarParams, s: EpipolarSolution) -> Iterator[Readout]:
    if s.line_left is not None:
        yield Formula("Line of p′ in the left picture: a, b, c", symbol("l"), row(s.line_left.tolist()))
    if s.line_right is not None:
        yield Formula("Line of p in the right picture: a, b, c", RIGHT_LINE, row(s.line_right.tolist()))
    if s.picked is None:
        return
    u, v = s.picked.pixel
    other = "right" if s.picked.side == "left" else "left"
    words = f"Pixel {figure(u, 1)}, {figure(v, 1)}, picked in the {s.picked.side} picture"
    if s.picked.line is None:
        why = "there is no baseline" if s.F is None else "it is the epipole"
        yield Note(f"{words}: no line in the other, for {why}.", "near")
    else:
        yield Formula(f"{words}: its line in the {other}", symbol("l", "pick"), row(s.picked.line.tolist()))


def _epipoles(s: EpipolarSolution) -> Iterator[Readout]:
    for side, name, pole, pixel in (
        ("left", symbol("e"), s.epipole_left, s.epipole_left_pixel),
        ("right", RIGHT_EPIPOLE, s.epipole_right, s.epipole_right_pixel),
    ):
        if pole is None:
            continue
        if pixel is None:
            yield Formula(f"{side.capitalize()} epipole, homogeneous: at infinity", name, row(pole.tolist()))
        elif far_away(pixel):
            yield Note(f"{side.capitalize()} epipole: more than a million pixels away.")
        else:
            yield Formula(f"{side.capitalize()} epipole", name, row(pixel, 1), "px")


def far_away(pixel: Pixel) -> bool:
    """Whether a pixel's place says nothing but that it is far."""
    return max(map(abs, pixel)) > FARTHEST


def describe(p: EpipolarParams, s: EpipolarSolution) -> str:
    """One sentence."""
    place = ", ".join(figure(v, 2) for v in p.point)
    if s.F is None:
        return f"Both cameras are at one place: no epipolar plane, and no F; point {place} m."
    parts = [f"Point {place} m"]
    if where := unseen(s):
        parts.append(f"not in front of {where}")
    parts += [
        f"{side} pixel {figure(pixel[0], 0)}, {figure(pixel[1], 0)}"
        for side, pixel in (("left", s.pixel_left), ("right", s.pixel_right))
        if pixel is not None
    ]
    parts += [
        f"{side} epipole {epipole_in_words(pixel)}"
        for side, pixel in (("left", s.epipole_left_pixel), ("right", s.epipole_right_pixel))
    ]
    if s.candidate is not None:
        parts.append(judged(s.candidate).rstrip("."))
    shown = "1 point" if p.points == 1 else f"{p.points} points"
    return "; ".join([*parts, baseline(s), shown]) + "."


def epipole_in_words(pixel: Pixel | None) -> str:
    """Where an epipole is."""
    if pixel is None:
        return "at infinity"
    return "far away" if far_away(pixel) else f"at {figure(pixel[0], 0)}, {figure(pixel[1], 0)}"
