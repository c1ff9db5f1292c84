"""A stereo pair of one's own, from its calibration: F, E and epipoles in its pixels, and a match that is tried."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from geometry.arrays import Array
from geometry.epipolar import epipolar_line_right, epipolar_residual
from sims.epipolar.eye import BASELINE
from sims.epipolar.params import EpipolarParams, Pixel
from sims.epipolar.rig import Pair, existing_line
from sims.kit.readout import THIN, Formula, Note, Readout, figure, mathml, quantity, row, significant, spelled, symbol
from sims.kit.stereo import length, turned


@dataclass(frozen=True, eq=False)
class OwnPair:
    """What follows from both calibrations, in the pixels of those pictures; and the match that is tried."""

    F: Array
    E: Array
    epipole_left: Pixel | None
    epipole_right: Pixel | None
    """Pixels, or None at infinity."""
    baseline: float
    """As long as the calibration says, in its unit."""
    angle: float
    """Degrees by which the right camera is turned against the left one."""
    line_right: Array | None
    """The line of the left pixel: None where that is the epipole."""
    residual: float
    distance: float | None
    """Pixels of the right pixel from the line."""


def own(p: EpipolarParams, both: Pair) -> OwnPair | None:
    """The pair, if it is the one that is shown."""
    if p.pair is None or both.F is None or both.E is None:
        return None
    left, right = np.array(p.own_left), np.array(p.own_right)
    line = existing_line(epipolar_line_right(both.F, left))
    return OwnPair(
        both.F, both.E, both.epipole_left_pixel, both.epipole_right_pixel,
        length(p.pair), turned(p.pair), line,
        float(epipolar_residual(both.F, left, right)),
        None if line is None else float(line @ [*right, 1.0]),
    )  # fmt: skip


def readouts(pair: OwnPair | None) -> Iterator[Readout]:
    """Numbers of the pair."""
    if pair is None:
        yield Note(
            "Paste a calibration of two cameras: F, E and epipoles follow of what has focal lengths and a baseline."
        )
        return
    yield Note(
        f"The right camera is turned by {quantity(pair.angle, '°', 2)}, and {figure(pair.baseline)} away, in T’s unit."
        f" In the scene that is {quantity(BASELINE, 'm', 1)}: F, lines and epipoles are the same for any length."
        " Pixels are those of your pictures, once free of distortion."
    )
    yield Formula("Fundamental matrix of your pair", symbol("F"), significant(pair.F), copy=spelled(pair.F))
    yield Formula("Essential matrix of your pair", symbol("E"), significant(pair.E), copy=spelled(pair.E))
    for side, pixel in (("Left", pair.epipole_left), ("Right", pair.epipole_right)):
        where = "at infinity" if pixel is None else f"at {figure(pixel[0], 1)}, {figure(pixel[1], 1)}{THIN}px"
        yield Note(f"{side} epipole {where}.")
    if pair.line_right is None or pair.distance is None:
        yield Note("Your left pixel is the epipole: every pixel may be its partner.", "near")
        return
    yield Formula("Line of your left pixel: a, b, c", symbol("l"), row(pair.line_right.tolist()))
    yield Formula("Your right pixel off that line", symbol("d"), mathml(abs(pair.distance), 2), "px")
