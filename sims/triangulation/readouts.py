"""Read-outs, and a sentence for people who listen."""

from __future__ import annotations

import math
from collections.abc import Iterator

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
from sims.kit.stereo import turned
from sims.triangulation.calibration import unit
from sims.triangulation.params import IMAGES, NAMES, RIG, SURENESS, TriangulationParams
from sims.triangulation.solution import SAMPLES, SIGMAS, TriangulationSolution

VERY_FAR = 1e4
"""Metres of depth from which on coordinates say nothing."""
TROUBLE = {
    "parallel": "Parallel rays: no finite point. {zero}, as for something infinitely far away.",
    "behind": "No point in front of both cameras: the rays diverge, and their lines meet behind {behind}.",
    "undefined": "The pixels are too far away to mean anything.",
}


METHODS, EQUATIONS = "The three methods", "The equations of DLT"
BY_PICTURE = ("left", "left", "right", "right")


RECTIFIED = "Not rectified: Z = f b / d doesn’t hold here. The point follows from both rays alone."


def readouts(p: TriangulationParams, s: TriangulationSolution) -> Iterator[Readout]:
    """Numbers beside the scene."""
    yield from _status(p, s)
    if p.pair is not None:
        yield Note(RECTIFIED)
    if s.depth_from_disparity is not None and s.disparity is not None:
        words = f"Depth from a disparity of {quantity(s.disparity, 'px', 2)}"
        law = f"{symbol('Z')}<mo>=</mo>{fb_over(p.doffs)}"
        yield Formula(words, law, mathml(s.depth_from_disparity), "m", link="baseline focal")
    if s.point is not None and s.depth is not None and s.depth < VERY_FAR:
        yield Formula(_point_in_words(p, s), symbol("X"), row(s.point.tolist()), "m")
        if p.pair is not None:
            yield Formula("Depth before the left camera", symbol("Z"), mathml(s.depth), "m")
    if s.depth_sigma is not None and not s.vague:
        yield _depth_sigma(s)
    yield Fold(IMAGES)
    yield _images(p, s)
    if s.disparity is not None:
        yield Formula("Disparity: left u minus right u", symbol("d"), mathml(s.disparity, 2), "px")
    yield Fold(METHODS)
    yield _methods(p, s)
    yield Formula("Gap between the rays", symbol("g"), mathml(100.0 * s.ray_gap, 2), "cm")
    yield Formula("Angle between the two rays", symbol("α"), mathml(s.ray_angle, 2), "°")
    if s.point_angle is not None:
        words = "Angle at the point, between the lines to both cameras (parallax)"
        yield Formula(words, symbol("β"), mathml(s.point_angle, 2), "°")
    yield Fold(EQUATIONS)
    yield from _equations(s)
    yield Fold(SURENESS)
    yield from _uncertainty(p, s)
    if p.noise > 0.0:
        yield _noise(p, s)
    yield Fold(RIG)
    yield from _own(p, s)


def _own(p: TriangulationParams, s: TriangulationSolution) -> Iterator[Readout]:
    """Numbers of somebody's pair, and what doesn't hold for it."""
    if p.pair is None:
        return
    yield Note(
        f"The right camera is turned by {quantity(turned(p.pair), '°', 2)} against the left one. {unit(p)} In the scene"
        " each is turned by half of that, to opposite sides. Pixels are your pictures’, once free of distortion."
    )
    if s.point_left is not None and s.depth is not None and s.depth < VERY_FAR:
        yield Formula("The point in the left camera’s axes", symbol("X", "L"), row(s.point_left.tolist()), "m")
    for side, K in (("left", s.K_left), ("right", s.K_right)):
        yield Formula(
            f"Camera matrix of the {side} camera", symbol("K", side[0].upper()), mathml(K, 2), copy=spelled(K)
        )
    yield Formula("Fundamental matrix, of norm 1", symbol("F"), significant(s.F), copy=spelled(s.F))


def _point_in_words(p: TriangulationParams, s: TriangulationSolution) -> str:
    """Short: a line more would move the pictures while a hand is in them."""
    if s.matched is None:
        return f"Point by the {NAMES[p.method]} method"
    name = NAMES[p.method]
    return f"{name[0].upper()}{name[1:]}: {length(s.matched.apart)} off a corner"


def fb_over(doffs: float) -> str:
    """f b / d, or f b / (d + doffs) where the principal points differ."""
    below = f"<mrow><mi>d</mi><mo>+</mo>{symbol('doffs')}</mrow>" if doffs else "<mi>d</mi>"
    return f'<mstyle displaystyle="true"><mfrac><mrow><mi>f</mi><mi>b</mi></mrow>{below}</mfrac></mstyle>'


def _status(p: TriangulationParams, s: TriangulationSolution) -> Iterator[Note]:
    if s.status != "found":
        yield Note(TROUBLE[s.status].format(behind=_behind(p, s), zero=_zero(p, s)), "warn")
    elif s.vague:
        yield Note("Almost parallel rays: a standard deviation of the depth is larger than the depth itself.", "warn")
    elif s.ellipsoid_axes is not None and s.drawn_part < 1.0:
        long = quantity(2.0 * SIGMAS * s.ellipsoid_axes.item(0), "m", 0)
        cut = "; the scene shows it up to half the depth from the point" if p.show_ellipsoid else ""
        yield Note(f"Very unsure: the ellipsoid of 3σ is {long} long{cut}.", "near")
    others = [NAMES[m] for m in NAMES if m != p.method and s.by_method[m].status != s.status]
    if others:
        yield Note(f"The methods disagree on whether there is a point: see {' and '.join(others)} below.", "near")


def _behind(p: TriangulationParams, s: TriangulationSolution) -> str:
    if p.pair is not None:
        return "a camera"
    away = "far" if s.closest_points is None else quantity(-s.closest_points.item(0, 1), "m", 2)
    return f"the cameras, {away} away"


def _zero(p: TriangulationParams, s: TriangulationSolution) -> str:
    """What says that rays are parallel."""
    if s.disparity is None:
        return "The angle between them is zero"
    return (
        f"The disparity of {quantity(s.disparity, 'px', 2)} with doffs added is zero"
        if p.doffs
        else "The disparity is zero"
    )


def _equations(s: TriangulationSolution) -> Iterator[Formula]:
    words = "Two equations for each picture, L and R: A X = 0 for a point X = (x, y, z, 1) on both rays"
    yield Formula(words, symbol("A"), mathml(s.equations, rows=BY_PICTURE))
    words = "Singular values of A: the last is 0 where the rays meet"
    yield Formula(words, symbol("s"), row(s.singular_values.tolist(), 4))
    *place, last = s.least_vector.tolist()
    words = "Singular vector of the last: the X of length 1 for which A X is least"
    yield Formula(words, symbol("v"), row([*place, last]))
    if abs(last) > 1.0 / VERY_FAR:
        words = "Divided by its last entry: the DLT point"
        yield Formula(words, symbol("X"), row([v / last for v in place]), "m")


def _methods(p: TriangulationParams, s: TriangulationSolution) -> Table:
    rows = [("method", "left", "right", "rms", "apart")]
    for name, words in NAMES.items():
        found = s.by_method[name]
        errors = (found.reprojection_left, found.reprojection_right, found.reprojection_rms)
        apart = found.status if found.point is None else "–"
        if found.point is not None and s.point is not None:
            apart = length(math.dist(found.point, s.point))
        cells = [figure(e, 3) if e is not None else "–" for e in errors]
        rows.append((words, cells[0], cells[1], cells[2], apart))
    true = () if s.true_point is None else ("true",)
    if s.true_point is not None:
        a, b = math.dist(s.measured_left, p.left_uv), math.dist(s.measured_right, p.right_uv)
        cells = [figure(e, 3) for e in (a, b, math.hypot(a, b) / math.sqrt(2.0))]
        apart = "–" if s.point is None else length(math.dist(s.true_point, s.point))
        rows.append(("true point", cells[0], cells[1], cells[2], apart))
    words = "Reprojection error in pixels, and distance from the result"
    return Table(words, rows, tuple(NAMES), p.method, lights=true)


def _images(p: TriangulationParams, s: TriangulationSolution) -> Table:
    rows = [("point", "u", "v")]
    for name, (u, v) in (("L, left", s.measured_left), ("R, right", s.measured_right)):
        rows.append((name, figure(u, 2), figure(v, 2)))
    words = "Image points in pixels, with their noise" if p.noise > 0.0 else "Image points in pixels"
    return Table(words, rows, lights=("left", "right"))


def length(metres: float) -> str:
    """In millimetres where that says something."""
    return quantity(1000.0 * metres, "mm", 1) if metres < 10.0 else quantity(metres, "m", 0)


def _uncertainty(p: TriangulationParams, s: TriangulationSolution) -> Iterator[Readout]:
    if s.covariance is None or s.ellipsoid_axes is None or s.depth_sigma is None or s.vague:
        return
    yield _depth_sigma(s)
    yield Formula("Covariance of X", symbol("C"), mathml(1e4 * s.covariance, 2), "cm²")
    yield Formula("Half-axes of the 1σ ellipsoid", symbol("a"), row((100.0 * s.ellipsoid_axes).tolist(), 2), "cm")
    long = mathml(2.0 * SIGMAS * s.ellipsoid_axes.item(0), 2)
    yield Formula("Length of the ellipsoid that is drawn, of 3σ", f"<mn>6</mn>{symbol('a', '1')}", long, "m")


def _depth_sigma(s: TriangulationSolution) -> Formula:
    words = f"Standard deviation of Z at {quantity(s.sigma_px, 'px', 2)}"
    return Formula(words, symbol("σ", "Z"), mathml(s.depth_sigma), "m", link="noise")


def _noise(p: TriangulationParams, s: TriangulationSolution) -> Note:
    pairs = ((s.measured_left, p.left_uv), (s.measured_right, p.right_uv))
    words = [f"({figure(m[0] - h[0], 2)}, {figure(m[1] - h[1], 2)})" for m, h in pairs]
    lost = (
        ""
        if len(s.cloud) == SAMPLES or s.point is None
        else f" {SAMPLES - len(s.cloud)} of {SAMPLES} samples have no point."
    )
    return Note(f"Sample {p.seed}: noise left {words[0]}, right {words[1]} px.{lost}")


def describe(p: TriangulationParams, s: TriangulationSolution) -> str:
    """One sentence."""
    base = f"{'a stereo pair of your own, ' if p.pair else ''}baseline {quantity(p.baseline, 'm', 2)}"
    if s.point is None:
        disparity = "" if s.disparity is None else f"disparity {quantity(s.disparity, 'px', 1)}, "
        return f"{TROUBLE[s.status].split(':')[0]}; {disparity}{base}."
    if s.depth is None or s.depth >= VERY_FAR or s.depth_sigma is None:
        return f"Almost parallel rays: the point is kilometres away, its depth unknown; {base}."
    x, y, z = (figure(v, 2) for v in s.point.tolist())
    depth = f"depth before the left camera {quantity(s.depth, 'm', 2)}," if p.pair else "depth"
    noise = f"sample {p.seed} of {quantity(p.noise, 'px', 2)} noise; " if p.noise else ""
    name = NAMES[p.method][0].upper() + NAMES[p.method][1:]
    return (
        f"{name} point {x}, {y}, {z} m; {depth} plus or minus {quantity(s.depth_sigma, 'm')};"
        f" rays miss by {quantity(100.0 * s.ray_gap, 'cm', 1)}; {noise}{base}."
    )
