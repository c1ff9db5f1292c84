"""Read-outs, and a sentence for people who listen."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from sims.camera.params import CameraParams
from sims.camera.solution import CameraSolution, NamedPoint
from sims.kit.readout import Fold, Formula, Note, Readout, Table, figure, mathml, quantity, row, symbol
from sims.kit.world import NAMES, TITLES

SAME = 1.0
"""Pixels within which two points are said to share a pixel."""
NO_SCALE = "No picture: its scale comes from the mean depth of the points in front of the camera, and no point is."
WORKED, MATRIX, ALL = "The point, step by step", "P, and what it tells", "All points"
"""Titles of folds."""
IN_K = (("fx", "skew", "cx"), ("", "fy", "cy"), ("", "", ""))
POSE = "pan tilt roll"
IN_POSE = ((POSE, POSE, POSE, "position"),) * 3


def caption(p: CameraParams, s: CameraSolution) -> str:
    """What to do, or what to see."""
    if s.frustum is None:
        return "There is nothing to take the picture’s scale from: move or turn the camera."
    if p.through:
        return "You look through the camera: the frame is what its picture shows."
    if s.distorted:
        return "The lens bends straight lines; dashed is what K alone would show."
    if s.scale is not None:
        metre = f"A metre is {quantity(s.scale, 'px', 0)}"
        mean = s.scale_depth and quantity(s.scale_depth, "m", 2)
        return f"{metre} everywhere: fx over the mean depth, {mean}." if mean else f"{metre}, near and far: move back."
    return "Pull the camera, turn it or zoom: see which numbers change."


def readouts(p: CameraParams, s: CameraSolution) -> Iterator[Readout]:
    """Numbers beside the scene."""
    yield from _status(p, s)
    yield Formula("Intrinsics", symbol("K"), mathml(s.K, 1, links=IN_K))
    yield Formula(
        "Pose",
        "<mrow><mo>[</mo><mi>R</mi><mo>|</mo><mi>t</mi><mo>]</mo></mrow>",
        mathml(np.column_stack([s.R, s.t]), links=IN_POSE),
    )
    yield Fold(WORKED)
    yield from _worked(p, s)
    yield Fold(MATRIX)
    if s.P is not None:
        what = "K [R | t]" if s.scale is None else "affine, its last row has no R"
        yield Formula(f"Projection: {what}", symbol("P"), mathml(s.P, 2))
    yield Formula("Centre −Rᵀt", symbol("C"), row(s.center.tolist()), "m")
    if s.scale is None:
        yield Formula("Field of view, across", symbol("α", "x"), mathml(s.fov_x, 2), "°")
        yield Formula("Field of view, down", symbol("α", "y"), mathml(s.fov_y, 2), "°")
    yield from _taken_apart(s)
    if s.subject.height is not None:
        yield Formula("Height of the house in the picture", symbol("h"), mathml(s.subject.height, 1), "px")
    yield Fold(ALL)
    if hidden := sum(point.depth <= 0.0 for point in s.points):
        ending = "point is behind the camera and has" if hidden == 1 else "points are behind the camera and have"
        yield Note(f"{hidden} {ending} no pixel.")
    yield _table(p, s)


def _status(p: CameraParams, s: CameraSolution) -> Iterator[Note]:
    if s.frustum is None:
        yield Note(NO_SCALE, "warn")
    if all(point.depth <= 0.0 for point in s.points):
        yield Note("All points are behind the camera: there are no pixels.", "warn")
    yield from _together(p, s)


def _together(p: CameraParams, s: CameraSolution) -> Iterator[Note]:
    """Points that the picture can't tell from the chosen one."""
    chosen = s.point(p.selected)
    if chosen.pixel is None:
        return
    u, v = chosen.pixel
    for point in s.points:
        other = point.pixel
        if other and point is not chosen and abs(other[0] - u) < SAME and abs(other[1] - v) < SAME:
            yield Note(f"{TITLES[point.name]} has the same pixel: both lie on one line of sight.")


def _worked(p: CameraParams, s: CameraSolution) -> Iterator[Readout]:
    """The chosen point, from the world to its pixel."""
    point = s.point(p.selected)
    yield Formula(f"{TITLES[p.selected]}, in the world", symbol("X", "w"), row(point.world), "m")
    yield Formula("In the camera's axes: R X + t", symbol("X", "c"), row(point.camera), "m")
    if point.pixel is None:
        if s.frustum is not None:
            depth = quantity(point.depth, "m")
            yield Note(f"Depth {depth}: not in front of the camera, so there is no pixel.", "warn")
        return
    x, y, z = point.camera
    outside = "" if point.in_image else ", outside the picture"
    if p.projection == "orthographic":
        yield Formula(f"Pixel: x and y times the scale, from c{outside}", symbol("p"), row(point.pixel, 2), "px")
        return
    divisor = s.scale_depth or z
    words = "its depth" if s.scale_depth is None else "the mean depth"
    flat = x / divisor, y / divisor
    yield Formula(f"Normalised: divided by {words}, {quantity(divisor, 'm')}", symbol("x"), row(flat))
    if s.distorted and point.straight is not None:
        yield Formula("Without distortion: K x", symbol("p", "0"), row(point.straight, 2), "px")
    how = "bent by the lens" if s.distorted else "K x"
    yield Formula(f"Pixel: {how}{outside}", symbol("p"), row(point.pixel, 2), "px")


def _taken_apart(s: CameraSolution) -> Iterator[Readout]:
    """Check: what P alone tells."""
    if s.decomposed is None:
        if s.P is not None:
            yield Note("This P has no centre to find: all its lines of sight are parallel to the optical axis.")
        return
    off = max(
        float(np.abs(getattr(s.decomposed, name) - value).max())
        for name, value in (("K", s.K), ("R", s.R), ("center", s.center))
    )
    verdict = "the same as above" if off < 1e-6 else f"off by {off:.1e}".replace("-", "−")
    yield Note(f"Check: P taken apart again (RQ) gives K, R and C, {verdict}.")
    yield Formula("K from P", symbol("K", "P"), mathml(s.decomposed.K, 1))
    yield Formula("C from P", symbol("C", "P"), row(s.decomposed.center.tolist()), "m")


def _table(p: CameraParams, s: CameraSolution) -> Table:
    rows: list[tuple[str, ...]] = [("point", "depth", "u", "v")]
    for point in s.points:
        rows.append((TITLES[point.name], figure(point.depth, 2), *_pixel(point)))
    return Table("Points: depth in metres, pixel; in brackets what is outside the picture", rows, NAMES, p.selected)


def _pixel(point: NamedPoint) -> tuple[str, str]:
    if point.pixel is None:
        return ("behind", "–") if point.depth <= 0.0 else ("–", "–")
    u, v = (figure(value, 1) for value in point.pixel)
    return (u, v) if point.in_image else (f"({u})", f"({v})")


def describe(p: CameraParams, s: CameraSolution) -> str:
    """One sentence."""
    x, y, z = (figure(v, 2) for v in p.position)
    angles = ", ".join(f"{n} {quantity(getattr(p, n), '°', 0)}" for n in ("pan", "tilt", "roll"))
    point = s.point(p.selected)
    if s.frustum is None:
        seen = "no picture, as nothing in front gives it a scale"
    elif point.pixel is None:
        seen = "behind the camera, no pixel" if point.depth <= 0.0 else "farther out than the lens shows, no pixel"
    else:
        u, v = (figure(value, 0) for value in point.pixel)
        seen = f"at pixel {u}, {v}{'' if point.in_image else ', outside the picture'}"
    kind = "weak perspective" if p.projection == "weak" else p.projection
    return (
        f"{kind.capitalize()} camera at {x}, {y}, {z} m, {angles}; focal length {quantity(p.fx, 'px', 0)};"
        f" {TITLES[p.selected].lower()}: {seen}."
    )
