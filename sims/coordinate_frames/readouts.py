"""Read-outs, the words beside the point, and a sentence for people who listen."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from geometry.arrays import Array
from sims.coordinate_frames.conventions import NAMES, Axes, axes
from sims.coordinate_frames.params import FramesParams
from sims.coordinate_frames.solution import FramesSolution
from sims.kit.readout import (
    MINUS,
    THIN,
    Fold,
    Formula,
    Note,
    Readout,
    Table,
    figure,
    mathml,
    quantity,
    row,
    symbol,
    under,
)

FAR = 1e5
"""Numbers from here on are told by their power of ten."""
NOTHING = "(0, 0, 0, 0) is neither a point nor a direction: set one of the numbers."
HOMOGENEOUS, ALL, AXES = "The fourth coordinate w", "All seven conventions", "Axes and handedness"
LINKS_T = (("convention", "convention", "convention", "origin"),) * 4
LINKS_P = (("point",),) * 3 + (("w",),)


def caption(p: FramesParams, s: FramesSolution) -> str:
    """What to do, or what to see."""
    if s.direction is None and s.cartesian is None:
        return "With all four numbers zero there is nothing to see: set one of them."
    if p.w == 0.0:
        return "With w = 0 the point has become a direction: T turns it, and no origin moves it."
    if p.w != 1.0:
        return "The point is (x/w, y/w, z/w): the smaller w, the farther away, and at 0 a direction is left."
    if s.apart:
        return "Pull X′ Y′ Z′ by their ring: the point’s numbers in these axes change, the direction’s do not."
    if s.axes_to is s.axes:
        return "Choose a second convention: the same point gets other numbers, and T says how."
    return "One point, two sets of axes: T turns the first numbers into the second. Pull X′ Y′ Z′ off by the ring."


def readouts(p: FramesParams, s: FramesSolution) -> Iterator[Readout]:
    """Numbers beside the scene."""
    yield Note(f"{title(p)}: {directions(s.axes)}. {s.handedness.capitalize()}-handed.")
    if s.apart or s.axes_to is not s.axes:
        yield Note(f"{NAMES[p.to]}: {directions(s.axes_to, '′')}. {s.axes_to.handedness.capitalize()}-handed.")
    yield from _product(p, s)
    yield Formula(f"Its determinant: {_meaning(s)}", "<mi>det</mi><mi>T</mi>", mathml(s.determinant, 0))
    yield Fold(HOMOGENEOUS)
    yield from _homogeneous(p, s)
    yield Fold(ALL)
    yield _table(p, s)
    yield Fold(AXES)
    yield Note(_rule(s))
    B = mathml(s.basis, 0, roles=("x", "y", "z"))
    yield Formula("Axes x, y, z as columns, in right, forward, up", symbol("B"), B, link="convention")
    yield Formula(f"Its determinant: {s.handedness}-handed", "<mi>det</mi><mi>B</mi>", mathml(s.axes.drawn.side, 0))


def _product(p: FramesParams, s: FramesSolution) -> Iterator[Readout]:
    """T times a point and times a direction, side by side."""
    kinds = "point" if p.w else "direction", "direction"
    moved = ("moves" if p.w else "stays", "stays") if s.apart else kinds
    name = symbol("T", f"{p.to} {p.convention}")
    T = mathml(s.matrix, (0, 0, 0, 2 if s.apart else 0), roles=("x", "y", "z"), links=LINKS_T)
    left = _columns(kinds, s.homogeneous, np.array([*p.point, 0.0]))
    right = _columns(moved, s.homogeneous_to, s.direction_to)
    note = f"{NAMES[p.to]} from {title(p)}"
    yield Formula(note, "", f"<munder>{T}<mrow>{name}</mrow></munder>{left}<mo>=</mo>{right}", link="to")


def _columns(words: tuple[str, str], *vectors: Array) -> str:
    return "".join(under(mathml(v, 2, links=LINKS_P), each) for v, each in zip(vectors, words, strict=True))


def title(p: FramesParams) -> str:
    """The convention, and the handedness where it isn't the convention's own."""
    return NAMES[p.convention] + (f", {p.axes.handedness}-handed" if p.axes is not axes(p.convention) else "")


def directions(found: Axes, mark: str = "") -> str:
    """Where axes point."""
    x, y, z = found.directions
    return f"X{mark} {x}, Y{mark} {y}, Z{mark} {z}"


def _rule(s: FramesSolution) -> str:
    return f"{s.handedness.capitalize()}-handed: fingers of the {s.handedness} hand from X to Y, thumb along Z."


def _meaning(s: FramesSolution) -> str:
    return "a rotation" if s.determinant > 0.0 else "improper (a reflection)"


def _homogeneous(p: FramesParams, s: FramesSolution) -> Iterator[Readout]:
    yield Formula("Homogeneous coordinates (x, y, z, w)", symbol("h"), row(s.homogeneous.tolist(), 2))
    if s.cartesian is not None and s.cartesian_to is not None and s.distance is not None and s.distance < FAR:
        yield Formula("Point (x/w, y/w, z/w)", symbol("p"), row(s.cartesian.tolist()), "m")
        yield Formula("The same in the second frame", symbol("p′"), row(s.cartesian_to.tolist()), "m")
    if s.direction is None and s.cartesian is None:
        yield Note(NOTHING, "warn")
    elif s.cartesian is None:
        yield Note("w = 0: no point, but a direction. Points run away along it as w goes to 0.")
    elif s.tip is not None and s.distance is not None:
        yield Note(f"Out of view: the point is {distance_in_words(s.distance)}, where the arrow leads.")


def _table(p: FramesParams, s: FramesSolution) -> Table:
    rows: list[tuple[str, ...]] = [("convention", "hand", "x", "y", "z")]
    if s.axes is not axes(p.convention):
        own = s.homogeneous[:3] if s.cartesian is None else s.cartesian
        rows.append((f"{NAMES[p.convention]} ✓", s.handedness, *map(_cell, own.tolist())))
    for name, words in NAMES.items():
        mark = " ✓" if s.axes is axes(name) else ""
        rows.append((words + mark, axes(name).handedness, *map(_cell, s.coordinates[name].tolist())))
    if s.cartesian is None:
        return Table("The same direction in all seven conventions", rows)
    return Table("The same point in all seven conventions, from the first origin, in metres", rows)


def _cell(value: float) -> str:
    return figure(value, 2) if abs(value) < FAR else f"{value:.0e}".replace("-", MINUS).replace("+", "")


def distance_in_words(metres: float) -> str:
    """How far away the point is."""
    if metres < 1000.0:
        return f"{quantity(metres, 'm', 1)} away"
    return f"{quantity(metres / 1000.0, 'km', 1)} away" if metres < FAR else f"{_cell(metres)}{THIN}m away"


def in_brackets(p: FramesParams, s: FramesSolution) -> str:
    """The words beside what the learner holds."""
    if s.cartesian is None:
        return f"direction {_triple(p.point)}"
    return f"{_triple(s.cartesian.tolist())}{THIN}m"


def _triple(values: Iterable[float]) -> str:
    return f"({', '.join(map(_cell, values))})"


def describe(p: FramesParams, s: FramesSolution) -> str:
    """One sentence."""
    if s.direction is None and s.cartesian is None:
        place = "neither a point nor a direction"
    else:
        place = in_brackets(p, s) if s.cartesian is None else f"point {in_brackets(p, s)}"
        other = s.direction_to[:3] if s.cartesian_to is None else s.cartesian_to
        begins = f", which begins at {_triple(p.origin)}" if s.apart else ""
        place += f"; in {NAMES[p.to]}{begins}: {_triple(other.tolist())}" if s.apart or s.axes_to is not s.axes else ""
    kind = "a rotation" if s.determinant > 0.0 else "a reflection"
    return f"{NAMES[p.convention]}, {s.handedness}-handed: {directions(s.axes)}; {place}; the matrix is {kind}."
