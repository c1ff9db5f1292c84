"""Read-outs, and a sentence for people who listen."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from sims.kit.readout import THIN, Fold, Formula, Note, Readout, Table, figure, mathml, quantity, row, symbol
from sims.point_cloud.captions import ASTRAY
from sims.point_cloud.cloud import Cloud
from sims.point_cloud.files.meaning import IGNORED, ROLES
from sims.point_cloud.library import NO_FILES, Library
from sims.point_cloud.offers import guess
from sims.point_cloud.params import CHOSEN, MOST_COLUMNS, OWN, UPLOAD, CloudParams
from sims.point_cloud.registration import Registered
from sims.point_cloud.solution import CloudSolution

SENSORS = {
    "room": "a colour scanner at two places in a room",
    "street": "a rotating lidar with 64 rings on a car: shadows behind things, no colours",
    "statue": "a scanner at four places, with 2 mm of noise and one point in fifty thrown off",
    "two-scans": "a scanner at two places; the second scan isn't where it belongs",
}


def count(number: int) -> str:
    """A whole number in groups of three digits."""
    return f"{number:,}".replace(",", THIN)


BOX, RESULT, ORIGIN = "The box", "What the process found", "Where the points come from"


def readouts(p: CloudParams, s: CloudSolution) -> Iterator[Readout]:
    """Numbers beside the scene."""
    yield from _warnings(p, s)
    share = (
        ""
        if s.points_out == s.points_in or not s.points_in
        else f", {figure(100.0 * s.points_out / s.points_in, 1)}{THIN}%"
    )
    yield Formula("Points shown, of " + count(s.points_in) + share, symbol("n"), f"<mn>{count(s.points_out)}</mn>")
    if s.measured is not None:
        yield Formula("Distance of the two points", symbol("d"), mathml(s.measured.distance), "m")
    yield Fold(CHOSEN)
    yield from _selected(s)
    if s.measured is not None:
        yield Formula(f"To point {count(s.measured.other)}, at", symbol("q"), row(s.measured.position.tolist()), "m")
        yield Formula("Along x, y, z", symbol("q") + "<mo>−</mo>" + symbol("p"), row(s.measured.offset.tolist()), "m")
    yield Fold(RESULT)
    yield from _process(p, s)
    yield Fold(BOX)
    yield Formula("Dimensions of the box along x, y, z", symbol("d"), row(s.dimensions.tolist()), "m")
    yield Formula("Least coordinates", symbol("min"), row(s.minimum.tolist()), "m")
    yield Formula("Greatest coordinates", symbol("max"), row(s.maximum.tolist()), "m")
    yield Fold(ORIGIN)
    if p.dataset in SENSORS:
        yield Note(f"Simulated, not measured: {SENSORS[p.dataset]}.")
    else:
        yield from _file(p, s)


def _file(p: CloudParams, s: CloudSolution) -> Iterator[Readout]:
    """What became of a file."""
    cloud = s.drawn.cloud
    if not len(cloud):
        return
    yield Note(f"From the file “{cloud.name}”.")
    for caution in cloud.cautions:
        yield Note(caution, "near")
    yield Note(f"Columns taken for {_taken(cloud)}. Choose otherwise under “{OWN}”.")
    for note in cloud.notes:
        yield Note(note)
    if cloud.origin is not None:
        yield Formula("Far from its origin: add to the coordinates", symbol("o"), row(cloud.origin.tolist(), 0), "m")
    if p.file and p.file.startswith(UPLOAD):
        yield Note("A link can't carry your file: it works here, as long as somebody has the sim open.")


def _taken(cloud: Cloud) -> str:
    """What each column of a file was taken for, in their order."""
    names = [f"“{name}”" if name else f"column {k + 1}" for k, name in enumerate(cloud.columns)]
    used = [f"{ROLES[role]} ({name})" for name, role in zip(names, cloud.roles, strict=True) if role != IGNORED]
    rest = [name for name, role in zip(names, cloud.roles, strict=True) if role == IGNORED]
    return ", ".join(used) + (f"; not used: {', '.join(rest)}" if rest else "")


def preview(p: CloudParams, library: Library = NO_FILES) -> Table | None:
    """The first lines of a file, by its columns."""
    cloud = guess(p, library)
    if not cloud.preview:
        return None
    lines = len(cloud.preview[0])
    head = ["Column", *(f"Line {k + 1}" for k in range(lines))]
    rows = [
        [f"{k + 1} {name[:14]}".rstrip(), *(entry[:12] for entry in entries), *[""] * (lines - len(entries))]
        for k, (name, entries) in enumerate(zip(cloud.columns, cloud.preview, strict=True))
    ]
    return Table("The first lines of the file", [head, *rows[:MOST_COLUMNS]])


def _warnings(p: CloudParams, s: CloudSolution) -> Iterator[Note]:
    if s.trouble:
        yield Note(s.trouble, "warn")
        return
    if s.colored_by != p.color and s.clusters is None and s.registration is None:
        what = "colours" if p.color == "rgb" else "intensities"
        yield Note(f"This cloud has no {what}; height is shown instead.")
    for number, found in ((p.selected, s.selected), (p.other if p.measure and s.selected else None, s.measured)):
        if number is not None and found is None:
            yield Note(f"No point has the number {count(number)}: only {count(s.points_out)} are shown.", "warn")
    if p.process == "register" and s.registration is None:
        yield Note(ONE_FILE if p.dataset == "file" else "Nothing to register: this is one scan.", "warn")
    if p.process == "ground" and p.step > 0 and s.ground is None:
        yield Note("No ground: no plane within 20° of level.", "warn")
    if p.process == "surface" and p.step > 0 and (s.surface is None or not s.surface.triangles):
        yield Note("No surface: the ball falls through between the points. Choose a larger one.", "warn")


ONE_FILE = f"One scan so far: bring the second under “{OWN}”. While you register, a file that you bring is that one."
LAMBDAS = "<mo>+</mo>".join(symbol("λ", str(k)) for k in (1, 2, 3))


def _facing(cloud: Cloud) -> str:
    """Where normals point to, as far as that is known."""
    if cloud.normals is not None:
        return "as the file has it"
    return "towards the sensor" if cloud.sensor is not None else "upwards: nobody knows where the sensor was"


def _selected(s: CloudSolution) -> Iterator[Formula]:
    if (chosen := s.selected) is None:
        return
    yield Formula(f"Selected point, number {count(chosen.index)}", symbol("p"), row(chosen.position.tolist()), "m")
    if chosen.merged is not None:
        yield Formula("Measured points in its cell, whose mean it is", symbol("n"), f"<mn>{count(chosen.merged)}</mn>")
    if chosen.color is not None:
        yield Formula("Its colour: red, green, blue", symbol("c"), row(chosen.color.tolist(), 0))
    if chosen.normal is not None:
        yield Formula(f"Its normal, {_facing(s.drawn.cloud)}", symbol("n"), row(chosen.normal.tolist()))
    if chosen.intensity is not None:
        yield Formula("Its intensity", symbol("I"), mathml(chosen.intensity))
    yield Formula(
        f"Variances of its {len(chosen.neighbors)} nearest: across their plane, and along it",
        symbol("λ"),
        row((1e6 * chosen.eigenvalues).tolist(), 1),
        "mm²",
    )
    if chosen.variation is not None:
        share = f"{symbol('λ', '1')}<mo>/</mo><mrow><mo>(</mo>{LAMBDAS}<mo>)</mo></mrow><mo>=</mo>"
        note = "Its surface variation: 0 on a plane, at most 1/3"
        yield Formula(note, symbol("σ", "n"), share + mathml(chosen.variation, 4))


def _process(p: CloudParams, s: CloudSolution) -> Iterator[Readout]:
    if s.ground is not None:
        g = s.ground
        yield Formula("Normal of the ground", symbol("n"), row(g.normal.tolist(), 4))
        yield Formula("Height of the ground over the origin", symbol("h"), mathml(-g.offset / g.normal[2]), "m")
        yield Formula(
            f"Points within {quantity(100.0 * g.distance, 'cm', 1)} of it",
            symbol("n"),
            f"<mn>{count(g.inliers)}</mn>",
        )
        yield Formula("Their rms distance from it", symbol("σ"), mathml(1000.0 * g.rms, 1), "mm")
    if s.clusters is not None:
        c = s.clusters
        yield Note(
            f"{count(len(c.sizes))} clusters whose points are linked by gaps of at most {quantity(c.distance, 'm', 2)}"
            f"{', without the ground' if c.without_ground else ''};"
            f" {count(c.unclustered)} points are in groups too small."
        )
    if s.outliers is not None:
        o = s.outliers
        done = "marked" if p.step == 1 else "removed"
        yield Formula(f"Outliers {done}", symbol("n"), f"<mn>{count(o.removed)}</mn>")
        yield Formula(
            f"Most mean distance to {p.neighbors - 1} neighbours", symbol("d"), mathml(1000.0 * o.threshold, 1), "mm"
        )
    if s.registration is not None:
        yield from _registration(s.registration)
    if s.surface is not None and s.surface.triangles:
        f = s.surface
        cells = f"{count(f.points)} means of cells of {quantity(f.cell, 'm', 3)}"
        yield Formula(f"Triangles, on {cells}", symbol("n"), f"<mn>{count(f.triangles)}</mn>")
        yield Formula("Area", symbol("A"), mathml(f.area, 2), "m²")
        yield Formula(
            "Volume that the ball can’t get into; next to nothing where there is a gap",
            symbol("V"),
            mathml(f.volume),
            "m³",
        )
        yield Formula("Radius of the ball", symbol("α"), mathml(f.radius), "m")


def _registration(r: Registered) -> Iterator[Readout]:
    ended = ", converged" if r.converged else ", not yet converged"
    yield Note(f"Step {r.step} of {r.steps}{ended if r.step == r.steps else ''}.")
    yield Note(
        f"{count(r.source_points)} of the second scan’s {count(r.second_points)} points take part, which is enough."
        f" {_reaches(r)}"
    )
    if r.off is not None and r.off > ASTRAY and r.step == r.steps and r.pairs:
        yield Note("It ends in the wrong place. Begin nearer, or with a wider reach.", "near")
    yield Formula(f"Error of {count(r.pairs)} pairs, {SUM}", symbol("E"), mathml(r.error), "m²")
    yield Formula("Share of points with a pair (fitness)", symbol("f"), mathml(r.fitness))
    if r.rmse is not None:
        yield Formula("Root mean square distance of the pairs", symbol("rms"), mathml(1000.0 * r.rmse, 1), "mm")
    if r.off is not None:
        yield Formula("Farthest a corner is from where it truly belongs", symbol("e"), mathml(1000.0 * r.off, 1), "mm")
    yield Formula("Second scan onto the first", symbol("T"), mathml(r.T))
    if len(r.unobservable):
        open_ways = ", ".join(map(_motion, r.unobservable))
        yield Note(f"The pairs don't fix {len(r.unobservable)} of 6 directions of motion: {open_ways}.", "near")


def _reaches(r: Registered) -> str:
    """From coarse to fine."""
    wide, narrow = quantity(r.reaches[0], "m", 2), quantity(r.reaches[-1], "m", 2)
    if wide == narrow:
        return f"Pairs are at most {wide} apart."
    first = next(k for k, reach in enumerate(r.reaches) if reach < r.reaches[0])
    return f"From coarse to fine: pairs are at most {wide} apart, from step {first} on {narrow}."


SUM = "Σ‖R pᵢ + t − qᵢ‖²"


def _motion(direction: np.ndarray) -> str:
    turn, move = direction[:3], direction[3:]
    kind, axis = ("turning about", turn) if turn @ turn > move @ move else ("sliding along", move)
    return f"{kind} ({', '.join(figure(v, 1) for v in (axis / np.linalg.norm(axis)).tolist())})"


DONE = {
    "ground": "the ground", "clusters": "clusters", "outliers": "outliers", "register": "registration",
    "surface": "the surface",
}  # fmt: skip


def describe(p: CloudParams, s: CloudSolution) -> str:
    """One sentence."""
    if s.trouble:
        return s.trouble
    x, y, z = (figure(v, 2) for v in s.dimensions.tolist())
    paint = "scan" if s.registration else "cluster" if s.clusters else COLOURS[s.colored_by]
    words = f"{count(s.points_out)} of {count(s.points_in)} points, coloured by {paint}, of size"
    words += f" {figure(p.point_size, 1)}, {x} by {y} by {z} m"
    if s.selected is not None:
        a, b, c = (figure(v, 2) for v in s.selected.position.tolist())
        words += f"; point {count(s.selected.index)} at {a}, {b}, {c} m"
    if s.measured is not None:
        words += f", {quantity(s.measured.distance, 'm')} from point {count(s.measured.other)}"
    if s.registration is not None:
        words += f"; registration, step {s.registration.step} of {s.registration.steps}"
        if s.registration.rmse is not None:
            words += f", pairs {quantity(1000.0 * s.registration.rmse, 'mm', 1)} apart"
    elif s.clusters is not None:
        words += f"; {count(len(s.clusters.sizes))} clusters"
    elif s.outliers is not None:
        words += f"; {count(s.outliers.removed)} outliers"
    elif s.ground is not None:
        words += f"; ground with {count(s.ground.inliers)} points"
    elif s.surface is not None:
        words += f"; surface of {quantity(s.surface.area, 'm²', 2)}"
    return words + "."


COLOURS = {
    "height": "height", "intensity": "intensity", "rgb": "measured colour", "normals": "normals",
    "variation": "surface variation",
}  # fmt: skip
