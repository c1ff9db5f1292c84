"""What is to be reached with two cameras and a point."""

from __future__ import annotations

import math

import numpy as np

from geometry.epipolar import epipolar_line_left, epipolar_line_right
from sims.epipolar.actions import PRESETS
from sims.epipolar.eye import eyes
from sims.epipolar.params import POINT, EpipolarParams, Pixel
from sims.epipolar.rig import pair
from sims.epipolar.solution import EpipolarSolution
from sims.kit.challenge import Challenge, Progress, nearer
from sims.kit.readout import quantity
from sims.kit.stereo import Eye

HIGHER = 0.2
"""Metres between the heights of two cameras whose lines aren't level."""
MOVED, STILL = 40.0, 2.0
"""Pixels that a point must move to have moved, and that a line may be off to have stayed."""
FAR = 640.0
"""Pixels outside a picture from which on nearness counts."""
NO_BASELINE = Progress(0.0, "Both cameras are at one place: pull them apart first.")


def _at_infinity(p: EpipolarParams, s: EpipolarSolution) -> Progress:
    if s.F is None:
        return NO_BASELINE
    rig = eyes(p)
    along = np.subtract(rig[1].center, rig[0].center)
    high = min(abs(along[2]) / HIGHER, 1.0)
    if s.epipole_left_pixel is None and s.epipole_right_pixel is None:
        if high < 1.0:
            words = (
                f"Both are at infinity: now put one camera at least {quantity(HIGHER, 'm', 1)} higher than the other"
            )
            return Progress(0.5 + 0.49 * high, words)
        return Progress(1.0, "Both epipoles are at infinity, and no line is level")
    both = pair(*rig)
    left, right = (_off(camera.R[2] @ along / s.baseline) for camera in (both.left, both.right))
    words = f"{quantity(left, '°', 2)} to go in the left picture, {quantity(right, '°', 2)} in the right one"
    return Progress(min(0.5 * high + 0.5 * (1.0 - max(left, right) / 90.0), 0.99), words)


def _off(sine: float) -> float:
    """Degrees between the baseline and a picture, for people: what isn't zero isn't shown as zero."""
    angle = math.degrees(math.asin(min(abs(float(sine)), 1.0)))
    return angle if angle < 1e-9 else max(angle, 0.01)


def _both_inside(p: EpipolarParams, s: EpipolarSolution) -> Progress:
    if s.F is None:
        return NO_BASELINE
    epipoles = (s.epipole_left_pixel, s.epipole_right_pixel)
    left, right = (_outside(pixel, eye) for pixel, eye in zip(epipoles, eyes(p), strict=True))
    fraction = 0.5 * sum(1.0 - min(each / FAR, 1.0) for each in (left, right))
    if fraction == 1.0:
        return Progress(1.0, "Both epipoles are inside their pictures")
    words = ", ".join(f"{name} is {_where(each)}" for name, each in (("e", left), ("e′", right)))
    return Progress(min(fraction, 0.99), words)


def _outside(pixel: Pixel | None, eye: Eye) -> float:
    """Pixels from an epipole to its picture."""
    if pixel is None:
        return math.inf
    return math.hypot(*(max(-at, at - last, 0.0) for at, last in zip(pixel, eye.last, strict=True)))


def _where(outside: float) -> str:
    if outside == 0.0:
        return "inside"
    return f"{quantity(max(outside, 1.0), 'px', 0)} outside" if outside < 1e5 else "far away or at infinity"


def _lines_stay(p: EpipolarParams, s: EpipolarSolution) -> Progress:
    both = pair(*eyes(p))
    began = [camera.project(POINT)[0] for camera in (both.left, both.right)]
    if both.F is None or s.pixel_left is None or s.pixel_right is None or not np.isfinite(began).all():
        return Progress(0.0, "There must be two lines: both cameras must see P, where it is now and where it began.")
    moved = [math.dist(pixel, start) for pixel, start in zip((s.pixel_left, s.pixel_right), began, strict=True)]
    lines = epipolar_line_left(both.F, s.pixel_right), epipolar_line_right(both.F, s.pixel_left)
    off = max(abs(float(line @ (*start, 1.0))) for line, start in zip(lines, began, strict=True))
    if not math.isfinite(off):
        return Progress(0.0, "P is seen in an epipole, which has no line: move it away from the baseline.")
    words = (
        f"p has moved by {quantity(moved[0], 'px', 0)}, p′ by {quantity(moved[1], 'px', 0)};"
        f" the lines are {quantity(off, 'px', 1)} off"
    )
    if min(moved) < MOVED:
        return Progress(0.5 * min(moved) / MOVED, words)
    done = "Both points have moved, and both lines are where they were"
    left = nearer(off, 100.0, STILL, words, done)
    return Progress(0.5 + 0.5 * left.fraction, left.words)


CHALLENGES: tuple[Challenge[EpipolarParams, EpipolarSolution], ...] = (
    Challenge(
        id="epipoles-at-infinity", title="Both epipoles to infinity",
        goal="Put one camera higher than the other, and send both epipoles to infinity all the same.",
        near=_at_infinity, solves={"left": (-1.2, 0.4, 1.0), "right": (1.2, 0.4, 1.5)},
        misses=(
            {"left": (-1.2, 0.4, 1.0), "right": (1.2, 0.4, 1.5), "left_pan": 1.0},
            {"left": (-1.2, 0.4, 1.0), "right": (1.2, 0.4, 1.1)},
        ),
    ),
    Challenge(
        id="both-epipoles-inside", title="Each picture has its epipole",
        goal="Bring both epipoles inside their pictures at the same time.",
        near=_both_inside, solves=PRESETS["forward"],
        misses=({**PRESETS["forward"], "left_pan": 30.0}, {**PRESETS["forward"], "right": (0.8, 0.9, 1.0)}),
    ),
    Challenge(
        id="lines-stay", title="Points move, lines stay",
        goal="Move P from where it begins so that p and p′ both move by 40 px or more, but both lines stay.",
        near=_lines_stay, solves={"point": (1.0, 4.0, 1.2)},
        misses=({"point": (1.0, 4.0, 1.25)}, {"point": (0.3, 6.0, 1.3)}),
    ),
)  # fmt: skip
