"""Read-outs, the words beside the point, and a sentence for people who listen."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from sims.coordinate_frames.conventions import NAMES, axes
from sims.coordinate_frames.params import FramesParams
from sims.coordinate_frames.solution import FramesSolution
from sims.kit.readout import MINUS, THIN, Fold, Formula, Note, Readout, Table, figure, mathml, quantity, row, symbol

FAR = 1e5
"""Numbers from here on are told by their power of ten."""
NOTHING = "(0, 0, 0, 0) is neither a point nor a direction: set one of the numbers."


HOMOGENEOUS, ALL, AXES = "The fourth coordinate w", "All seven conventions", "Axes as a matrix"


def caption(p: FramesParams, s: FramesSolution) -> str:
    """What to do, or what to see."""
    if s.axes_to is s.axes:
        return "Choose a second convention: the same point gets other numbers, and T says how."
    if s.cartesian is None:
        return "With w = 0 this is a direction: T turns it, and nothing can move it."
    return "One point, two sets of axes: drag it, and read it in both. T takes the first numbers to the second."


def readouts(p: FramesParams, s: FramesSolution) -> Iterator[Readout]:
    """Numbers beside the scene."""
    yield Note(f"{title(p, s)}: {directions(s)}. {_rule(s)}")
    there = "direction" if s.cartesian is None else "point"
    for name, words in {p.convention: title(p, s), p.to: NAMES[p.to]}.items():
        own = s.homogeneous[:3] if s.cartesian is None else s.cartesian
        read = own if name == p.convention else s.coordinates[name]
        yield Note(f"The {there} in {words}: {_triple(read.tolist())}")
    T = mathml(s.matrix, 0, roles=("x", "y", "z"))
    yield Formula(f"{NAMES[p.to]} from {title(p, s)}", symbol("T", f"{p.to} {p.convention}"), T, link="to")
    yield Formula(f"Its determinant: {_meaning(s)}", "<mi>det</mi><mi>T</mi>", mathml(s.determinant, 0))
    yield Fold(HOMOGENEOUS)
    yield from _homogeneous(p, s)
    yield Fold(ALL)
    yield _table(p, s)
    yield Fold(AXES)
    B = mathml(s.basis, 0, roles=("x", "y", "z"))
    yield Formula("Axes x, y, z as columns, in right, forward, up", symbol("B"), B, link="convention")
    yield Formula(f"Its determinant: {s.handedness}-handed", "<mi>det</mi><mi>B</mi>", mathml(s.axes.sign, 0))


def title(p: FramesParams, s: FramesSolution) -> str:
    """The convention, and the handedness where it isn't the convention's own."""
    return NAMES[p.convention] + (f", {s.handedness}-handed" if s.axes is not axes(p.convention) else "")


def directions(s: FramesSolution) -> str:
    """Where the axes point."""
    x, y, z = s.axes.directions
    return f"X {x}, Y {y}, Z {z}"


def _rule(s: FramesSolution) -> str:
    return f"{s.handedness.capitalize()}-handed: fingers of the {s.handedness} hand from X to Y, thumb along Z."


def _meaning(s: FramesSolution) -> str:
    return "a rotation" if s.determinant > 0.0 else "improper (a reflection), as one is left-handed"


def _homogeneous(p: FramesParams, s: FramesSolution) -> Iterator[Readout]:
    yield Formula("Homogeneous coordinates (x, y, z, w)", symbol("h"), row(s.homogeneous.tolist(), 2))
    if s.cartesian is not None and s.distance is not None and s.distance < FAR:
        yield Formula("Point (x/w, y/w, z/w)", symbol("p"), row(s.cartesian.tolist()), "m")
    if s.direction is None and s.cartesian is None:
        yield Note(NOTHING, "warn")
    elif s.cartesian is None:
        yield Note("w = 0: no point, but a direction. Points run away along it as w goes to 0.", "near")
    elif s.tip is not None and s.distance is not None:
        yield Note(f"Out of view: the point is {distance_in_words(s.distance)}, where the arrow leads.", "near")


def _table(p: FramesParams, s: FramesSolution) -> Table:
    rows: list[tuple[str, ...]] = [("convention", "hand", "x", "y", "z")]
    if s.axes is not axes(p.convention):
        own = s.homogeneous[:3] if s.cartesian is None else s.cartesian
        rows.append((f"{NAMES[p.convention]} ✓", s.handedness, *map(_cell, own.tolist())))
    for name, words in NAMES.items():
        mark = " ✓" if s.axes is axes(name) else ""
        rows.append((words + mark, axes(name).handedness, *map(_cell, s.coordinates[name].tolist())))
    what = "direction" if s.cartesian is None else "point"
    return Table(f"The same {what} in all seven conventions{'' if s.cartesian is None else ', in metres'}", rows)


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
        other = s.coordinates[p.to].tolist()
        place += f"; in {NAMES[p.to]} {_triple(other)}" if s.axes_to is not s.axes else ""
    kind = "a rotation" if s.determinant > 0.0 else "a reflection"
    return f"{NAMES[p.convention]}, {s.handedness}-handed: {directions(s)}; {place}; the matrix is {kind}."
